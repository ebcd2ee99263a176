"""From OBJ statements to primitives: one for each material, corners welded, normals worked out where there are none."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from dofview.scene.limits import Account
from dofview.scene.model import Primitive
from dofview.scene.normals import smooth_normals, unit
from dofview.scene.notes import Notes
from dofview.scene.obj.polygons import triangulate
from dofview.scene.obj.statements import MISSING, Statements
from dofview.scene.repair import LARGEST, repaired_colors, repaired_texcoords, used_rows


@dataclass(frozen=True, eq=False)
class Triangles:
    """All triangles of a file: `corners` (t, 3, 3) of position, texcoord and normal indices, checked; `faces` (t,)."""

    corners: np.ndarray
    faces: np.ndarray


def triangles_of(made: Statements, account: Account, notes: Notes) -> Triangles:
    """Drop the faces that cannot be drawn, with notes, and cut the others into triangles."""
    corners, counts = made.corners, made.counts
    account.charge_triangles(int(np.maximum(counts - 2, 0).sum()))
    for column, table in ((1, made.texcoords), (2, made.normals)):
        wrong = corners[:, column] >= len(table)
        notes.count("corner", "corners", "with a texture or normal index out of range", int(wrong.sum()))
        corners[wrong, column] = MISSING
    kept = _drawable(made, notes)
    corners = corners[np.repeat(kept, counts)]
    rows, owners = triangulate(made.positions[corners[:, 0]], counts[kept], notes)
    return Triangles(corners[rows], np.flatnonzero(kept)[owners])


def _drawable(made: Statements, notes: Notes) -> np.ndarray:
    """(f,) bool: faces of at least three corners, all of them at finite positions that exist."""
    place, counts = made.corners[:, 0], made.counts
    outside = (place < 0) | (place >= len(made.positions))
    lost = ~(np.abs(made.positions) <= LARGEST).all(axis=1)
    nowhere = np.zeros(len(place), bool)
    nowhere[~outside] = lost[place[~outside]]
    face_of = np.repeat(np.arange(len(counts)), counts)
    kept = np.ones(len(counts), bool)
    for bad, reason in (
        (np.bincount(face_of[outside], minlength=len(counts)) > 0, "with a vertex index out of range left out"),
        (np.bincount(face_of[nowhere], minlength=len(counts)) > 0, "with NaN or infinite positions left out"),
        (counts < 3, "of fewer than three corners left out"),
    ):
        notes.count("face", "faces", reason, int((kept & bad).sum()))
        kept &= ~bad
    return kept


def slots_of(made: Statements, triangles: Triangles, slot: Callable[[str | None], int]) -> np.ndarray:
    """(f,) the material slot of each face; `slot(name)` is asked for the materials in use, and only those."""
    names = dict.fromkeys([None, *(name for _, name in made.materials)])
    numbers = {name: number for number, name in enumerate(names)}
    which = _spread([(face, numbers[name]) for face, name in made.materials], len(made.counts), 0)
    slots = np.zeros(len(names), np.int64)
    used = set(np.unique(which[triangles.faces]).tolist())
    for name, number in numbers.items():
        if number in used:
            slots[number] = slot(name)
    return slots[which]


def primitives(
    made: Statements, triangles: Triangles, slots: np.ndarray, origin: np.ndarray, notes: Notes
) -> Iterator[Primitive]:
    """Yield a Primitive for each material slot in use; `slots` (f,) is the slot of each face.

    `origin` (3,) is subtracted from the float64 positions before they become float32.
    """
    if len(triangles.faces) == 0:
        return
    shading, computed = _shading_normals(made, triangles)
    vertices, ids = _weld(np.concatenate([triangles.corners.reshape(-1, 3), shading.reshape(-1, 1)], axis=1))
    ids = ids.reshape(-1, 3)
    slot_of = slots[triangles.faces]
    order = np.argsort(slot_of, kind="stable")
    used, firsts = np.unique(slot_of[order], return_index=True)
    for slot, rows in zip(used.tolist(), np.split(order, firsts[1:]), strict=True):
        selected, local = used_rows(ids[rows])
        place, texcoord, normal, shade = vertices[selected].T
        with np.errstate(over="ignore", invalid="ignore"):
            yield Primitive(
                positions=(made.positions[place] - origin).astype(np.float32),
                triangles=local,
                normals=_normals(made.normals, normal, computed, shade),
                texcoords=(_texcoords(made.texcoords, texcoord, notes), None),
                colors=_colors(made.colors, place, notes),
                material=slot,
            )


def _shading_normals(made: Statements, triangles: Triangles) -> tuple[np.ndarray, np.ndarray]:
    """Work out normals where the file has no usable one.

    Returns for each corner (t, 3) the row of its computed normal, MISSING where the file's own is used; and those
    normals.
    """
    given = triangles.corners[..., 2]
    usable = np.append((np.abs(made.normals) <= LARGEST).all(axis=1) & made.normals.any(axis=1), False)
    wanted = ~usable[given]  # MISSING is the last row
    if not wanted.any():
        return np.full(given.shape, MISSING), np.zeros((0, 3), np.float32)
    keys = triangles.corners[..., 0].astype(np.int64)
    if made.smoothing:
        group = _spread(made.smoothing, len(made.counts), 1)[triangles.faces]
        keys = keys * (int(group.max(initial=0)) + 1) + group[:, None]
        flat = group == 0
        keys[flat] = int(keys.max(initial=0)) + 1 + triangles.faces[flat, None]
        keys = np.unique(keys, return_inverse=True)[1].reshape(-1, 3)
    computed = smooth_normals(made.positions, triangles.corners[..., 0], keys)
    return np.where(wanted, keys, MISSING), computed


def _spread(switches: list[tuple[int, int]], count: int, before: int) -> np.ndarray:
    """(count,) values from a list of (first face, value); `before` applies to faces ahead of the first."""
    starts = np.array([0, *(start for start, _ in switches), count])
    return np.repeat(np.array([before, *(value for _, value in switches)], np.int64), np.diff(starts))


def _weld(columns: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Find the distinct rows of (c, 4) index columns: the rows (n, 4), and the number of its row for each corner (c,).

    Column by column: one that the position already determines (the usual case) costs no sort.
    """
    ids, count = columns[:, 0], int(columns[:, 0].max(initial=-1)) + 1
    for column in columns.T[1:]:
        known = np.zeros(count, columns.dtype)
        known[ids] = column
        if (known[ids] != column).any():
            keys = ids.astype(np.int64) * (int(column.max()) + 2) + column + 1
            distinct, ids = np.unique(keys, return_inverse=True)
            count = len(distinct)
    rows = np.zeros((count, 4), columns.dtype)
    rows[ids] = columns
    return rows, ids


def _normals(given: np.ndarray, normal: np.ndarray, computed: np.ndarray, shade: np.ndarray) -> np.ndarray:
    result = np.zeros((len(normal), 3), np.float32)
    result[shade == MISSING] = unit(given[normal[shade == MISSING]])
    result[shade != MISSING] = computed[shade[shade != MISSING]]
    return result


def _texcoords(table: np.ndarray, index: np.ndarray, notes: Notes) -> np.ndarray | None:
    """(n, 2) float32 with v downwards; (0, 0) of the file for corners without one; None when no corner has one."""
    present = index != MISSING
    if not present.any():
        return None
    notes.count(
        "vertex", "vertices", "of a partly textured material without texture coordinates", int((~present).sum())
    )
    texcoords = np.zeros((len(index), 2))
    texcoords[present] = table[index[present]]
    texcoords[np.isnan(texcoords[:, 1]) & np.isfinite(texcoords[:, 0]), 1] = 0.0  # `vt u` alone is legal
    texcoords[:, 1] = 1.0 - texcoords[:, 1]
    return repaired_texcoords(texcoords.astype(np.float32), notes)


def _colors(table: np.ndarray, place: np.ndarray, notes: Notes) -> np.ndarray | None:
    """(n, 4) float32, taken as linear like the colours of glTF; None when no vertex has one."""
    colors = table[place]
    present = ~np.isnan(colors).all(axis=1)
    if not present.any():
        return None
    colors[~present] = 1.0
    return repaired_colors(np.concatenate([colors, np.ones((len(place), 1))], axis=1).astype(np.float32), notes)
