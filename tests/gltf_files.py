"""A small glTF writer, so that every test says in its own lines what its file holds."""

from __future__ import annotations

import base64
import io
import json
import struct
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

COMPONENT = {"int8": 5120, "uint8": 5121, "int16": 5122, "uint16": 5123, "uint32": 5125, "float32": 5126}
TYPE = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}
TRIANGLE = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)
SQUARE = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], np.float32)


class GltfFile:
    """A glTF file in the making: `json` is the document, `add_*` append to it and return indices."""

    def __init__(self) -> None:
        self.json: dict[str, Any] = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}]}
        self.binary = bytearray()

    def append(self, key: str, item: dict[str, Any]) -> int:
        """Append to a top-level array."""
        self.json.setdefault(key, []).append(item)
        return len(self.json[key]) - 1

    def add_view(self, data: bytes, **extra: Any) -> int:
        """Append bytes as a buffer view."""
        self.binary += bytes(-len(self.binary) % 4)
        view = {"buffer": 0, "byteOffset": len(self.binary), "byteLength": len(data), **extra}
        self.binary += data
        return self.append("bufferViews", view)

    def add_accessor(self, values: np.ndarray, **extra: Any) -> int:
        """Append an array (n,) or (n, width) as a tightly packed accessor."""
        values = np.asarray(values)
        width = 1 if values.ndim == 1 else values.shape[1]
        fields = {"componentType": COMPONENT[values.dtype.name], "count": len(values), "type": TYPE[width]}
        return self.append("accessors", {"bufferView": self.add_view(values.tobytes()), **fields, **extra})

    def add_primitive(self, indices: np.ndarray | None = None, **attributes: Any) -> dict[str, Any]:
        """Make a primitive of arrays or accessor indices by attribute name."""
        accessors = {
            name: self.add_accessor(value) if isinstance(value, np.ndarray) else value
            for name, value in attributes.items()
        }
        made: dict[str, Any] = {"attributes": accessors}
        if indices is not None:
            made["indices"] = self.add_accessor(indices)
        return made

    def add_mesh(self, *primitives: dict[str, Any], **node: Any) -> int:
        """Append a mesh and a node of the default scene that shows it; returns the node."""
        index = self.append("nodes", {"mesh": self.append("meshes", {"primitives": list(primitives)}), **node})
        self.json["scenes"][0]["nodes"].append(index)
        return index

    def add_texture(self, pixels: np.ndarray, sampler: dict[str, Any] | None = None) -> int:
        """Append a PNG texture held in the buffer."""
        image = self.append("images", {"bufferView": self.add_view(png(pixels)), "mimeType": "image/png"})
        texture = {"source": image}
        if sampler is not None:
            texture["sampler"] = self.append("samplers", sampler)
        return self.append("textures", texture)

    def document(self, uri: str | None) -> bytes:
        """The JSON with its one buffer, if there is anything in it."""
        buffer = {"byteLength": len(self.binary)} | ({"uri": uri} if uri is not None else {})
        return json.dumps(self.json | ({"buffers": [buffer]} if self.binary else {})).encode()

    def gltf(self) -> bytes:
        """The file as .gltf with embedded data."""
        return self.document("data:application/octet-stream;base64," + base64.b64encode(self.binary).decode())

    def glb(self) -> bytes:
        """The file as .glb."""
        text = self.document(None)
        return glb(text, bytes(self.binary))

    def write(self, path: Path) -> Path:
        """Write as .glb or as .gltf with an external .bin, by the suffix of `path`."""
        if path.suffix == ".glb":
            path.write_bytes(self.glb())
        else:
            path.with_suffix(".bin").write_bytes(self.binary)
            path.write_bytes(self.document(path.with_suffix(".bin").name.replace(" ", "%20")))
        return path


def glb(text: bytes, binary: bytes) -> bytes:
    """A .glb container of a JSON chunk and a binary chunk."""
    text += b" " * (-len(text) % 4)
    binary += bytes(-len(binary) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(binary), 0x004E4942) + binary
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def png(pixels: np.ndarray) -> bytes:
    """An array (height, width, channels) uint8 as the bytes of a PNG."""
    stream = io.BytesIO()
    Image.fromarray(pixels).save(stream, "PNG")
    return stream.getvalue()
