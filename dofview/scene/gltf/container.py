"""The outer shell of glTF 2.0: a .glb container (§4) or plain JSON, parsed into a checked `Document`."""

from __future__ import annotations

import json
import struct
from dataclasses import dataclass, field
from typing import Any, NoReturn

from dofview.errors import ModelError
from dofview.scene.gltf.fields import Fields, as_integer
from dofview.scene.notes import one_line

MAGIC = b"glTF"
_JSON_CHUNK, _BIN_CHUNK = 0x4E4F534A, 0x004E4942
MOST_JSON_OBJECTS = 6_000_000  # each costs about 70 bytes in Python for 3 in the file


@dataclass(eq=False)
class Document:
    """The JSON root, and the binary chunk of a .glb (None when there is none)."""

    root: Fields
    binary: memoryview | None = None
    _lists: dict[str, list[Any]] = field(default_factory=dict)

    def entries(self, key: str) -> list[Any]:
        """One of the top-level arrays, as it stands."""
        if key not in self._lists:
            self._lists[key] = self.root.array(key)
        return self._lists[key]

    def entry(self, key: str, index: int) -> Fields:
        """Object `index` (already checked) of the top-level array `key`."""
        return Fields(self.entries(key)[index], f"{key}[{index}]")

    def reference(self, owner: Fields, key: str, target: str, required: bool = False) -> int | None:
        """The index under `key` of `owner`, checked against the top-level array `target`; None when there is none."""
        if owner.data.get(key) is None and not required:
            return None
        count = len(self.entries(target))
        if count == 0:
            raise ModelError(f"{owner.where}.{key} refers to {target}, and the file has none")
        return owner.integer(key, low=0, high=count - 1)

    def references(self, owner: Fields, key: str, target: str) -> list[int]:
        """An array of indices into the top-level array `target`."""
        values, count = owner.array(key), len(self.entries(target))
        indices = [index for index in map(as_integer, values) if index is not None and 0 <= index < count]
        if len(indices) != len(values):
            raise ModelError(f"{owner.where}.{key} is not a list of indices of the {count} {target}")
        return indices


def parse(data: bytes) -> Document:
    """Parse the bytes of a .glb or .gltf file."""
    if not data:
        raise ModelError("is empty")
    text, binary = _split_glb(memoryview(data)) if data[:4] == MAGIC else (data, None)
    document = Document(Fields(_parse_json(bytes(text)), ""), binary)
    _check_version(document.root)
    return document


def _split_glb(data: memoryview) -> tuple[memoryview, memoryview | None]:
    if len(data) < 20:
        raise ModelError(f"is cut off: {len(data)} bytes, a .glb has at least 20")
    _, version, length = struct.unpack_from("<4sII", data)
    if version != 2:
        raise ModelError(f"is a .glb of version {version}; accepted: 2")
    if length > len(data):
        raise ModelError(f"is cut off: the header says {length} bytes, the file has {len(data)}")
    text, position = _chunk(data, 12, _JSON_CHUNK)
    if text is None:
        raise ModelError("does not start with a JSON chunk")
    binary, _ = _chunk(data, position, _BIN_CHUNK) if position + 8 <= length else (None, position)
    return text, binary


def _chunk(data: memoryview, position: int, kind: int) -> tuple[memoryview | None, int]:
    length, found = struct.unpack_from("<II", data, position)
    start, end = position + 8, position + 8 + length
    if end > len(data):
        raise ModelError(f"is cut off: a chunk says {length} bytes, the file has {len(data) - start} left")
    return (data[start:end] if found == kind else None), end + (-end % 4)


def _parse_json(text: bytes) -> Any:
    if text.count(b"{") + text.count(b"[") > MOST_JSON_OBJECTS:
        raise ModelError(f"has more than {MOST_JSON_OBJECTS} JSON objects")
    try:
        return json.loads(text.decode("utf-8-sig"), parse_constant=_refuse_constant)
    except json.JSONDecodeError as error:
        if error.pos == 0:
            raise ModelError("is neither a .glb, which starts with 'glTF', nor JSON") from error
        raise ModelError(f"is not valid JSON: {error.msg.lower()} in line {error.lineno}") from error
    except UnicodeDecodeError as error:
        raise ModelError(f"is not valid JSON: no UTF-8 at byte {error.start}") from error
    except RecursionError as error:
        raise ModelError("is nested too deeply") from error
    except ValueError as error:  # an integer of more digits than Python converts
        raise ModelError("holds a number with too many digits") from error


def _refuse_constant(name: str) -> NoReturn:
    raise ModelError(f"holds {name}, which is not JSON")


def _check_version(root: Fields) -> None:
    asset = root.inside("asset")
    version = asset.text("version", "") if asset else ""
    if not version:
        raise ModelError("has no asset.version; accepted: glTF 2.0")
    least = asset.text("minVersion", version) if asset else version
    if version.split(".")[0] != "2" or least not in ("2.0", version):
        raise ModelError(f"is glTF {one_line(max(version, least), 20)}; accepted: 2.0")
