"""Buffers, buffer views and accessors (glTF 2.0 §3.6): bounds are checked in integers before any array is made.

`elements` gives a strided view straight onto the file's bytes, so that many primitives may share one large accessor and
each pays only for the rows it uses.
"""

from __future__ import annotations

import numpy as np

from dofview.errors import ModelError
from dofview.scene.files import Folder
from dofview.scene.gltf.container import Document
from dofview.scene.gltf.fields import Fields
from dofview.scene.notes import Notes

COMPONENTS: dict[int, np.dtype] = {
    5120: np.dtype("<i1"),
    5121: np.dtype("<u1"),
    5122: np.dtype("<i2"),
    5123: np.dtype("<u2"),
    5125: np.dtype("<u4"),
    5126: np.dtype("<f4"),
}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}


class Accessors:
    """Reads the accessors of one document, each buffer loaded once and only when something asks for it."""

    def __init__(self, document: Document, folder: Folder, notes: Notes) -> None:
        self._document, self._folder, self._notes = document, folder, notes
        self._buffers: dict[int, memoryview] = {}
        self._decoded: dict[int, tuple[np.ndarray, bool]] = {}

    def fields(self, owner: Fields, key: str) -> tuple[int, Fields]:
        """The accessor that `owner` refers to under `key`."""
        index = self._document.reference(owner, key, "accessors", required=True)
        assert index is not None
        return index, self._document.entry("accessors", index)

    def count(self, owner: Fields, key: str) -> int:
        """How many elements the accessor declares."""
        return self.fields(owner, key)[1].integer("count")

    def elements(self, owner: Fields, key: str, widths: tuple[int, ...]) -> tuple[np.ndarray, bool]:
        """(count, width) array in the file's own component type, and whether integers are normalised."""
        index, accessor = self.fields(owner, key)
        if index not in self._decoded:
            self._decoded[index] = self._decode(accessor)
        values, normalized = self._decoded[index]
        if values.shape[1] not in widths:
            raise accessor.fail("type", " or ".join(name for name, width in WIDTHS.items() if width in widths))
        return values, normalized

    def _decode(self, accessor: Fields) -> tuple[np.ndarray, bool]:
        dtype = COMPONENTS.get(accessor.integer("componentType"))
        if dtype is None:
            raise accessor.fail("componentType", ", ".join(map(str, COMPONENTS)))
        width = WIDTHS.get(accessor.text("type"))
        if width is None:
            raise accessor.fail("type", " or ".join(WIDTHS))
        normalized = accessor.flag("normalized") and dtype.kind != "f"
        if accessor.data.get("sparse") is None:
            return self._dense(accessor, accessor.integer("count"), dtype, width), normalized
        return self._substituted(accessor, dtype, width), normalized

    def view_bytes(self, index: int) -> memoryview:
        """The bytes of a buffer view."""
        view = self._document.entry("bufferViews", index)
        start, length = view.integer("byteOffset", 0), view.integer("byteLength")
        buffer_index = self._document.reference(view, "buffer", "buffers", required=True)
        assert buffer_index is not None
        buffer = self._buffer(buffer_index)
        if start + length > len(buffer):
            raise ModelError(
                f"{view.where} ends at byte {start + length}; buffers[{buffer_index}] has {len(buffer)} bytes"
            )
        return buffer[start : start + length]

    def _buffer(self, index: int) -> memoryview:
        if index in self._buffers:
            return self._buffers[index]
        fields = self._document.entry("buffers", index)
        length, uri = fields.integer("byteLength"), fields.text("uri", None)
        if uri is not None:
            data = memoryview(self._read(fields, uri))
        elif index == 0 and self._document.binary is not None:
            data = self._document.binary
        else:
            data = self._undefined(fields, length)
        if length > len(data):
            raise ModelError(f"{fields.where} should have {length} bytes and has {len(data)}")
        self._buffers[index] = data[:length]
        return self._buffers[index]

    def _undefined(self, fields: Fields, length: int) -> memoryview:
        """A buffer without uri is legal and its content undefined: zeros, unless an extension was to fill it."""
        if fields.data.get("extensions"):
            raise ModelError(f"{fields.where} has no data: an extension that dofview does not read was to fill it")
        self._notes.say(f"{fields.where} has neither a uri nor a binary chunk; taken as zeros")
        self._folder.account.charge_geometry(length)
        return memoryview(bytes(length))

    def _read(self, fields: Fields, uri: str) -> bytes:
        try:
            return self._folder.read_uri(uri)
        except ModelError as error:
            raise ModelError(f"{fields.where}: {error}") from error

    def _dense(self, owner: Fields, count: int, dtype: np.dtype, width: int) -> np.ndarray:
        size = dtype.itemsize * width
        index = self._document.reference(owner, "bufferView", "bufferViews")
        if index is None:
            # Zeros by definition; they have no bytes in the file that would bound their count.
            self._folder.account.charge_geometry(count * size)
            return np.broadcast_to(np.zeros((), dtype), (count, width))
        data, offset = self.view_bytes(index), owner.integer("byteOffset", 0)
        stride = self._document.entry("bufferViews", index).integer("byteStride", size, low=1, high=2**31)
        if stride < size:
            raise ModelError(
                f"bufferViews[{index}].byteStride is {stride}, less than the {size} bytes of {owner.where}"
            )
        end = offset + stride * (count - 1) + size if count else offset
        if end > len(data):
            raise ModelError(f"{owner.where} ends at byte {end}; bufferViews[{index}] has {len(data)} bytes")
        return np.ndarray((count, width), dtype, data, offset, (stride, dtype.itemsize))

    def _substituted(self, accessor: Fields, dtype: np.dtype, width: int) -> np.ndarray:
        """Copy the base values and put the sparse ones in their places (§3.6.2.3)."""
        count, sparse = accessor.integer("count"), accessor.inside("sparse")
        assert sparse is not None
        indices, values = sparse.inside("indices"), sparse.inside("values")
        if indices is None or values is None:
            raise ModelError(f"{sparse.where} needs indices and values")
        kind = COMPONENTS.get(indices.integer("componentType"))
        if kind is None or kind.kind != "u":
            raise indices.fail("componentType", "5121, 5123 or 5125")
        for part in (indices, values):
            self._document.reference(part, "bufferView", "bufferViews", required=True)
        places = self._dense(indices, sparse.integer("count"), kind, 1)[:, 0]
        if len(places) and int(places.max()) >= count:
            raise ModelError(f"{indices.where} goes up to {int(places.max())}; {accessor.where} has {count} elements")
        replacements = self._dense(values, len(places), dtype, width)
        base = self._dense(accessor, count, dtype, width)
        self._folder.account.charge_geometry(base.nbytes)
        result = base.copy()
        result[places] = replacements
        return result


def to_float(values: np.ndarray, normalized: bool) -> np.ndarray:
    """float32 copy of accessor elements; normalised integers become [0, 1] or [−1, 1] (§3.6.2.2)."""
    if not normalized:
        return values.astype(np.float32)
    scaled = values.astype(np.float32) / np.float32(np.iinfo(values.dtype).max)
    return np.maximum(scaled, np.float32(-1.0))
