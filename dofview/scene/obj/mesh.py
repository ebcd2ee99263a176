"""From OBJ statements to primitives: one for each material, corners welded, normals worked out where there are none."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from dofview.scene.model import Primitive
from dofview.scene.normals import smooth_normals, unit
from dofview.scene.notes import Notes
from dofview.scene.obj.lines import MISSING
from dofview.scene.obj.polygons import triangulate
from dofview.scene.obj.statements import Statements
from dofview.scene.repair import LARGEST, repaired_colors, repaired_texcoords, used_rows


@dataclass(frozen=True, eq=False)
class Triangles:
    """All triangles of a file: indices (t, 3) of their corners, checked, MISSING where there is none; the face (t,)."""

    place: np.ndarray
    texcoord: np.ndarray
    normal: np.ndarray
    faces: np.ndarray


def triangles_of(made: Statements, notes: Notes) -> Triangles:
    """Drop the faces that cannot be drawn, with notes, and cut the others into triangles."""
    place, texcoord, normal = made.corners
    texcoord = _in_range(texcoord, len(made.texcoords), notes)
    normal = _in_range(normal, len(made.normals), notes)
    kept, counts = _drawable(made, notes), made.counts
    if not kept.all():
        corners = np.repeat(kept, counts)
        place, texcoord, normal, counts = place[corners], texcoord[corners], normal[corners], counts[kept]
    rows, owners = triangulate(made.positions, place, counts, notes)
    if not kept.all():
        owners = np.flatnonzero(kept)[owners]
    return Triangles(place[rows], _picked(texcoord, rows), _picked(normal, rows), owners)


def _picked(column: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """`column[rows]`, taking no memory for a column in which nothing is given."""
    return column[rows] if len(rows) == 0 or column.strides[0] else np.broadcast_to(column[:1], rows.shape)


def _in_range(indices: np.ndarray, count: int, notes: Notes) -> np.ndarray:
    wrong = indices >= count
    if not wrong.any():
        return indices
    notes.count("corner", "corners", "with a texture or normal index out of range", int(wrong.sum()))
    return np.where(wrong, np.int32(MISSING), indices)


def _drawable(made: Statements, notes: Notes) -> np.ndarray:
    """(f,) bool: faces of at least three corners, all of them at finite positions that exist."""
    place, ends = made.corners[0], np.cumsum(made.counts)
    outside = (place < 0) | (place >= len(made.positions))
    lost = np.append(~(np.abs(made.positions) <= LARGEST).all(axis=1), False)
    nowhere = lost[np.where(outside, len(lost) - 1, place)] if lost.any() else np.zeros(0, bool)
    kept = np.ones(len(made.counts), bool)
    for corners, reason in (
        (outside, "with a vertex index out of range left out"),
        (nowhere, "with NaN or infinite positions left out"),
    ):
        faces = np.unique(np.searchsorted(ends, np.flatnonzero(corners), side="right"))
        notes.count("face", "faces", reason, int(kept[faces].sum()))
        kept[faces] = False
    few = kept & (made.counts < 3)
    notes.count("face", "faces", "of fewer than three corners left out", int(few.sum()))
    return kept & ~few


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
    vertices, ids = _weld(*(c.ravel() for c in (triangles.place, triangles.texcoord, triangles.normal, shading)))
    ids = ids.reshape(-1, 3)
    for slot, rows in _by_value(slots[triangles.faces]):
        selected, local = used_rows(ids[rows])
        place, texcoord, normal, shade = (column[selected] for column in vertices)
        with np.errstate(over="ignore", invalid="ignore"):
            yield Primitive(
                positions=(made.positions[place] - origin).astype(np.float32),
                triangles=local,
                normals=_normals(made.normals, normal, computed, shade),
                texcoords=(_texcoords(made.texcoords, texcoord, notes), None),
                colors=_colors(made.colors, place, notes),
                material=slot,
            )


def _by_value(values: np.ndarray) -> Iterator[tuple[int, slice | np.ndarray]]:
    """Each distinct value with the rows that have it."""
    if (values == values[0]).all():
        yield int(values[0]), slice(None)
        return
    order = np.argsort(values, kind="stable")
    distinct, firsts = np.unique(values[order], return_index=True)
    yield from zip(distinct.tolist(), np.split(order, firsts[1:]), strict=True)


def _shading_normals(made: Statements, triangles: Triangles) -> tuple[np.ndarray, np.ndarray]:
    """Work out normals where the file has no usable one.

    Returns for each corner (t, 3) the row of its computed normal, MISSING where the file's own is used; and those
    normals.
    """
    usable = np.append((np.abs(made.normals) <= LARGEST).all(axis=1) & made.normals.any(axis=1), False)
    wanted = ~usable[triangles.normal]  # MISSING is the last row
    if not wanted.any():
        return np.broadcast_to(np.int32(MISSING), wanted.shape), np.zeros((0, 3), np.float32)
    keys = triangles.place
    if made.smoothing:
        group = _spread(made.smoothing, len(made.counts), 1)[triangles.faces]
        keys = keys.astype(np.int64) * (int(group.max()) + 1) + group[:, None]
        flat = group == 0
        keys[flat] = int(keys.max()) + 1 + triangles.faces[flat, None]
        keys = np.unique(keys, return_inverse=True)[1].reshape(-1, 3).astype(np.int32)
    computed = smooth_normals(made.positions, triangles.place, keys)
    return (keys if wanted.all() else np.where(wanted, keys, np.int32(MISSING))), computed


def _spread(switches: list[tuple[int, int]], count: int, before: int) -> np.ndarray:
    """(count,) values from a list of (first face, value); `before` applies to faces ahead of the first."""
    starts = np.array([0, *(start for start, _ in switches), count])
    return np.repeat(np.array([before, *(value for _, value in switches)], np.int64), np.diff(starts))


def _weld(first: np.ndarray, *others: np.ndarray) -> tuple[list[np.ndarray], np.ndarray]:
    """Find the distinct combinations of index columns (c,): as columns (n,), and for each corner which it is (c,).

    Column by column: one that the columns before already determine (the usual case) costs no sort.
    """
    ids, count = first, int(first.max()) + 1
    for column in others:
        known = np.zeros(count, column.dtype)
        known[ids] = column
        if (known[ids] != column).any():
            keys = ids.astype(np.int64) * (int(column.max()) + 2) + column + 1
            distinct, ids = np.unique(keys, return_inverse=True)
            count = len(distinct)
    columns = [np.zeros(count, np.int32) for _ in range(1 + len(others))]
    for result, column in zip(columns, (first, *others), strict=True):
        result[ids] = column
    return columns, ids


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


def _colors(table: np.ndarray | None, place: np.ndarray, notes: Notes) -> np.ndarray | None:
    """(n, 4) float32, taken as linear like the colours of glTF; None when no vertex has one."""
    if table is None:
        return None
    colors = table[place]
    present = ~np.isnan(colors).all(axis=1)
    if not present.any():
        return None
    colors[~present] = 1.0
    return repaired_colors(np.concatenate([colors, np.ones((len(place), 1))], axis=1).astype(np.float32), notes)
