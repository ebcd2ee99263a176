"""Mesh primitives (glTF 2.0 §3.7.2): every mode that makes triangles, into the indexed triangles of the scene model."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from dofview.errors import ModelError
from dofview.scene.gltf import draco
from dofview.scene.gltf.accessors import Accessors, to_float
from dofview.scene.gltf.container import Document
from dofview.scene.gltf.fields import Fields
from dofview.scene.limits import Account
from dofview.scene.model import Primitive
from dofview.scene.normals import face_normals, smooth_normals, unit
from dofview.scene.notes import Notes
from dofview.scene.repair import LARGEST, repaired_colors, repaired_texcoords, used_rows

LINES_AND_POINTS = {0: "point", 1: "line", 2: "line loop", 3: "line strip"}
TRIANGLES, STRIP, FAN = 4, 5, 6
Rows = slice | np.ndarray


@dataclass(frozen=True)
class Geometry:
    """Reads primitives of one document."""

    document: Document
    accessors: Accessors
    account: Account
    notes: Notes

    def triangle_count(self, fields: Fields) -> int:
        """Triangles that the primitive declares, without decoding it; 0 for lines and points."""
        mode = fields.integer("mode", TRIANGLES, high=6)
        attributes = fields.inside("attributes")
        if mode in LINES_AND_POINTS or attributes is None:
            return 0
        if fields.data.get("indices") is not None:
            corners = self.accessors.count(fields, "indices")
        else:
            # Without positions there is nothing to show; the validator counts what the other attributes say.
            names = ["POSITION"] if has_positions(fields) else list(attributes.data)[:1]
            corners = self.accessors.count(attributes, names[0]) if names else 0
        return corners // 3 if mode == TRIANGLES else max(corners - 2, 0)

    def read(self, fields: Fields, weights: tuple[float, ...], material: int, unlit: bool) -> Primitive | None:
        """Decode a primitive; None when no triangle is left."""
        source = self._source(fields)
        corners = source.corners()
        if len(corners) and int(corners.max()) >= source.count:
            raise ModelError(
                f"{fields.where}.indices goes up to {int(corners.max())}; there are {source.count} vertices"
            )
        # Draco data is a list of triangles whatever the mode says.
        mode = TRIANGLES if source.compressed else fields.integer("mode", TRIANGLES, high=6)
        triangles = assemble(corners, mode)
        if source.compressed:
            self.account.charge_triangles(max(len(triangles) - self.triangle_count(fields), 0))
        rows, local = used_rows(triangles)
        positions = self._positions(fields, source, rows, weights)
        lost = ~(np.abs(positions) <= LARGEST).all(axis=1)
        if lost.any():
            kept = ~lost[local].any(axis=1)
            self.notes.count("triangle", "triangles", "with NaN or infinite positions left out", int((~kept).sum()))
            rows, local = used_rows(triangles[kept])
            positions = self._positions(fields, source, rows, weights)
        if len(local) == 0:
            return None
        normals = self._normals(fields, source, rows, weights, positions, local)
        made = Primitive(
            positions=positions,
            triangles=local,
            normals=positions if normals is None else normals,
            texcoords=(self._texcoords(source, 0, rows), self._texcoords(source, 1, rows)),
            colors=self._colors(source, rows),
            material=material,
        )
        if normals is not None:
            return made
        if unlit:
            return replace(made, normals=smooth_normals(positions, local))
        return self._flat(made)

    def _source(self, fields: Fields) -> Source:
        attributes = fields.inside("attributes")
        assert attributes is not None
        compressed = fields.extension(draco.EXTENSION)
        source = Source(self.accessors, fields, attributes)
        if compressed is not None and draco.available():
            index = self.document.reference(compressed, "bufferView", "bufferViews", required=True)
            assert index is not None
            source.compressed = draco.decode(self.accessors.view_bytes(index), compressed, self.account)
        count = len(source.elements("POSITION", (3,))[0])
        source.count = count
        return source

    def _positions(self, fields: Fields, source: Source, rows: Rows, weights: tuple[float, ...]) -> np.ndarray:
        positions = self._floats(source, "POSITION", (3,), rows)
        return self._morphed(positions, "POSITION", fields, rows, weights, source.count)

    def _morphed(
        self, base: np.ndarray, name: str, fields: Fields, rows: Rows, weights: tuple[float, ...], count: int
    ) -> np.ndarray:
        """Add the morph targets at the default `weights` (§3.7.2.2)."""
        for target, weight in zip(fields.objects("targets"), weights, strict=False):
            if weight == 0 or target.data.get(name) is None:
                continue
            values, normalized = self.accessors.elements(target, name, (3,))
            if len(values) != count:
                raise ModelError(f"{target.where}.{name} has {len(values)} elements; there are {count} vertices")
            self.account.charge_geometry(base.nbytes)
            with np.errstate(over="ignore", invalid="ignore"):
                base = (base + weight * to_float(values[rows], normalized)).astype(np.float32)
        return base

    def _normals(self, fields, source, rows, weights, positions, local) -> np.ndarray | None:
        if not source.has("NORMAL"):
            return None
        normals = self._morphed(
            self._floats(source, "NORMAL", (3,), rows), "NORMAL", fields, rows, weights, source.count
        )
        usable = (np.abs(normals) <= LARGEST).all(axis=1)
        normals = unit(np.where(usable[:, None], normals, np.float32(0))).astype(np.float32)
        missing = ~normals.any(axis=1)
        if missing.any():
            self.notes.count("normal", "normals", "without a direction replaced", int(missing.sum()))
            normals[missing] = smooth_normals(positions, local)[missing]
        return normals

    def _texcoords(self, source: Source, which: int, rows: Rows) -> np.ndarray | None:
        name = f"TEXCOORD_{which}"
        return repaired_texcoords(self._floats(source, name, (2,), rows), self.notes) if source.has(name) else None

    def _colors(self, source: Source, rows: Rows) -> np.ndarray | None:
        if not source.has("COLOR_0"):
            return None
        colors = self._floats(source, "COLOR_0", (3, 4), rows, integers_are_fractions=True)
        if colors.shape[1] == 3:
            colors = np.concatenate([colors, np.ones((len(colors), 1), np.float32)], axis=1)
        return repaired_colors(colors, self.notes)

    def _floats(
        self, source: Source, name: str, widths: tuple[int, ...], rows: Rows, integers_are_fractions: bool = False
    ) -> np.ndarray:
        values, normalized = source.elements(name, widths)
        if len(values) != source.count:
            raise ModelError(f"{source.where}.{name} has {len(values)} elements; there are {source.count} vertices")
        used = values[rows]
        self.account.charge_geometry(used.size * 4)
        return to_float(used, normalized or (integers_are_fractions and values.dtype.kind != "f"))

    def _flat(self, made: Primitive) -> Primitive:
        """Give every triangle its own corners and face normal, as §3.7.2.1 asks when a file has no normals."""
        order = made.triangles.ravel()
        self.account.charge_geometry(len(order) * 40)
        return replace(
            made,
            positions=made.positions[order],
            triangles=np.arange(len(order), dtype=np.uint32).reshape(-1, 3),
            normals=np.repeat(face_normals(made.positions, made.triangles), 3, axis=0),
            texcoords=(_reordered(made.texcoords[0], order), _reordered(made.texcoords[1], order)),
            colors=_reordered(made.colors, order),
        )


def has_positions(fields: Fields) -> bool:
    """Tell whether a primitive has positions; without them it is legal, and nothing to draw."""
    attributes = fields.inside("attributes")
    return attributes is not None and attributes.data.get("POSITION") is not None


def _reordered(values: np.ndarray | None, order: np.ndarray) -> np.ndarray | None:
    return None if values is None else values[order]


class Source:
    """The attributes and indices of one primitive, from accessors or from a Draco mesh."""

    def __init__(self, accessors: Accessors, fields: Fields, attributes: Fields) -> None:
        self.where = attributes.where
        self.count = 0
        self.compressed: draco.Mesh | None = None
        self._accessors, self._fields, self._attributes = accessors, fields, attributes

    def has(self, name: str) -> bool:
        """Tell whether the primitive has the attribute."""
        return self._attributes.data.get(name) is not None

    def elements(self, name: str, widths: tuple[int, ...]) -> tuple[np.ndarray, bool]:
        """(count, width) values and whether they are normalised integers."""
        if self.compressed is not None and name in self.compressed.attributes:
            values = self.compressed.attributes[name]
            if values.shape[1] not in widths:
                raise ModelError(f"{self.where}.{name} has {values.shape[1]} components in its Draco data")
            _, accessor = self._accessors.fields(self._attributes, name)
            return values, accessor.flag("normalized") and values.dtype.kind != "f"
        return self._accessors.elements(self._attributes, name, widths)

    def corners(self) -> np.ndarray:
        """One vertex index for each corner, unsigned."""
        if self.compressed is not None:
            return self.compressed.corners
        if self._fields.data.get("indices") is None:
            return np.arange(self.count, dtype=np.uint32)
        values, _ = self._accessors.elements(self._fields, "indices", (1,))
        if values.dtype.kind != "u":
            raise ModelError(f"{self._fields.where}.indices are not unsigned integers")
        return values[:, 0]


def assemble(corners: np.ndarray, mode: int) -> np.ndarray:
    """(m, 3) uint32 triangles of a list, strip or fan of `corners`, counter-clockwise (§3.7.2.1)."""
    corners = corners.astype(np.uint32)
    if mode == TRIANGLES:
        return corners[: len(corners) // 3 * 3].reshape(-1, 3)
    if len(corners) < 3:
        return np.zeros((0, 3), np.uint32)
    if mode == FAN:
        return np.stack([corners[1:-1], corners[2:], np.broadcast_to(corners[0], len(corners) - 2)], axis=1)
    triangles = np.stack([corners[:-2], corners[1:-1], corners[2:]], axis=1)
    triangles[1::2, 1:] = triangles[1::2, :0:-1]
    return triangles
