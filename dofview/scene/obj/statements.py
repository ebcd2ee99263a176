"""The statements of an OBJ file as flat arrays, parsed in blocks; line by line only where a block is irregular.

Text is normalised first: byte-order marks, UTF-16, CR and CRLF ends, tabs, indentation, continued lines. Relative
indices count back from the vertices read so far, which is why no later stage could resolve them.
"""

from __future__ import annotations

import codecs
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import compress

import numpy as np

from dofview.errors import ModelError
from dofview.scene.notes import Notes

BLOCK_BYTES = 4_000_000
MISSING = -1
OUT_OF_RANGE = 2**31 - 1
_ODD_SPACES = b"\r\t\v\f\0"
_SPACES = bytes.maketrans(_ODD_SPACES, b"\n    ")
_LEFT_OUT = {
    b"l": ("line statement", "line statements"),
    b"p": ("point statement", "point statements"),
    **dict.fromkeys((b"curv", b"curv2", b"surf"), ("free-form curve or surface", "free-form curves or surfaces")),
}
_WITHOUT_EFFECT = set(
    b"o g mg lod bevel c_interp d_interp shadow_obj trace_obj vp deg bmat step cstype parm trim hole scrv sp con end "
    b"ctech stech".split()
)


@dataclass(eq=False)
class Statements:
    """What stands in the file; indices start at 0, MISSING where none was given, and may still be out of range."""

    positions: np.ndarray = field(default_factory=lambda: np.zeros((0, 3)))
    colors: np.ndarray = field(default_factory=lambda: np.zeros((0, 3)))  # NaN where a vertex has none
    texcoords: np.ndarray = field(default_factory=lambda: np.zeros((0, 2)))
    normals: np.ndarray = field(default_factory=lambda: np.zeros((0, 3)))
    corners: np.ndarray = field(default_factory=lambda: np.zeros((0, 3), np.int32))  # position, texcoord, normal
    counts: np.ndarray = field(default_factory=lambda: np.zeros(0, np.int32))  # corners of each face
    libraries: list[str] = field(default_factory=list)
    materials: list[tuple[int, str]] = field(default_factory=list)  # from this face on, this material
    smoothing: list[tuple[int, int]] = field(default_factory=list)  # from this face on, this group; 0 is flat


def normalise(data: bytes) -> bytes:
    """Bring text to single line feeds, single spaces for other white space, no indentation, no continued lines."""
    if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        data = data.decode("utf-16", "replace").encode("utf-8")
    data = data.removeprefix(codecs.BOM_UTF8)
    if b"\r\n" in data:
        data = data.replace(b"\r\n", b"\n")
    if any(bytes((code,)) in data for code in _ODD_SPACES):
        data = data.translate(_SPACES)
    if b"\\\n" in data:
        data = data.replace(b"\\\n", b" ")
    if b"\n " in data or data.startswith(b" "):
        data = re.sub(rb"(?m)^ +", b"", data)
    return data


def decode_name(raw: bytes) -> str:
    """A name as UTF-8, or as Latin-1 when it is not."""
    try:
        return raw.decode("utf-8")
    except UnicodeDecodeError:
        return raw.decode("latin-1")


def scan(data: bytes, notes: Notes) -> Statements:
    """Parse the bytes of an OBJ file; ModelError when nothing in it looks like one."""
    scanner = _Scanner(notes)
    for block in _blocks(normalise(data)):
        scanner.scan_block(block)
    return scanner.finish()


def _blocks(data: bytes) -> Iterator[bytes]:
    start = 0
    while start < len(data):
        end = data.find(b"\n", start + BLOCK_BYTES)
        end = len(data) if end < 0 else end
        yield data[start:end]
        start = end + 1


class _Scanner:
    def __init__(self, notes: Notes) -> None:
        self._notes = notes
        self._made = Statements()
        self._tables: dict[bytes, list[np.ndarray]] = {b"v": [], b"vt": [], b"vn": []}
        self._seen = {b"v": 0, b"vt": 0, b"vn": 0}
        self._corners: list[np.ndarray] = []
        self._counts: list[np.ndarray] = []
        self._faces = self._left_out = 0

    def scan_block(self, block: bytes) -> None:
        """Sort the lines of a block by keyword and parse each kind at once."""
        lines = block.split(b"\n")
        heads = np.array([line[:2] for line in lines])
        is_kind = {kind: heads == kind.ljust(2) for kind in (*self._tables, b"f")}
        known = np.logical_or.reduce([*is_kind.values(), heads == b"", heads == b"# ", heads == b"#"])
        face_before = np.cumsum(is_kind[b"f"]) + self._faces
        for index in np.flatnonzero(~known).tolist():
            self._other(lines[index], int(face_before[index]))
        self._scan_faces(lines, is_kind)
        for kind, tables in self._tables.items():
            picked = list(compress(lines, is_kind[kind].tolist()))
            if picked:
                tables.append(table(kind, picked))
                self._seen[kind] += len(picked)

    def _scan_faces(self, lines: list[bytes], is_kind: dict[bytes, np.ndarray]) -> None:
        picked = list(compress(lines, is_kind[b"f"].tolist()))
        if not picked:
            return
        corners, counts = faces(picked)
        if (corners < 0).any():
            line_of = np.repeat(np.flatnonzero(is_kind[b"f"]), counts)
            for column, kind in enumerate(self._tables):
                relative = corners[:, column] < 0
                so_far = self._seen[kind] + np.cumsum(is_kind[kind])[line_of[relative]]
                absolute = corners[relative, column] + so_far + 1
                corners[relative, column] = np.where(absolute > 0, absolute, OUT_OF_RANGE)
        self._corners.append((corners - 1).astype(np.int32))
        self._counts.append(counts)
        self._faces += len(picked)

    def _other(self, line: bytes, face: int) -> None:
        keyword, _, rest = line.partition(b" ")
        rest = rest.strip()
        if keyword == b"usemtl":
            self._made.materials.append((face, decode_name(rest)))
        elif keyword == b"mtllib":
            self._made.libraries.append(decode_name(rest))
        elif keyword == b"s":
            self._made.smoothing.append((face, _smoothing_group(rest)))
        elif keyword in _LEFT_OUT:
            self._notes.count(*_LEFT_OUT[keyword], "not shown")
            self._left_out += 1
        elif keyword not in _WITHOUT_EFFECT and not keyword.startswith(b"#"):
            self._notes.count("line", "lines", "of no known kind ignored")

    def finish(self) -> Statements:
        """Join the blocks."""
        if not (self._seen[b"v"] or self._faces or self._left_out):
            raise ModelError("holds no vertex and no face; accepted: Wavefront OBJ text")
        made = self._made
        vertices = np.concatenate([np.zeros((0, 6)), *self._tables[b"v"]])
        made.positions, made.colors = vertices[:, :3], vertices[:, 3:]
        made.texcoords = np.concatenate([np.zeros((0, 2)), *self._tables[b"vt"]])
        made.normals = np.concatenate([np.zeros((0, 3)), *self._tables[b"vn"]])
        if self._corners:
            made.corners, made.counts = np.concatenate(self._corners), np.concatenate(self._counts)
        return made


def table(kind: bytes, lines: list[bytes]) -> np.ndarray:
    """(n, width) float64 of `v` (6: position, colour), `vt` (2) or `vn` (3) lines; NaN where there is no number."""
    width = {b"v": 6, b"vt": 2, b"vn": 3}[kind]
    tokens = b"\n".join(lines).split()
    each, rest = divmod(len(tokens), len(lines))
    if rest or each < 2 or tokens[::each].count(kind) != len(lines):
        rows = [line.split()[1 : width + 1] for line in lines]
        each = width + 1
        tokens = [token for row in rows for token in (kind, *row, *[b"nan"] * (width - len(row)))]
    del tokens[::each]
    try:
        values = np.fromiter(map(float, tokens), np.float64, len(tokens))
    except ValueError:
        values = np.array([_number(token) for token in tokens])
    values = values.reshape(len(lines), each - 1)
    result = np.full((len(lines), width), np.nan)
    # Four or five numbers after `v` are x y z w, and w means nothing for polygons.
    usable = 3 if kind == b"v" and each - 1 < 6 else width
    usable = min(usable, each - 1)
    result[:, :usable] = values[:, :usable]
    return result


def faces(lines: list[bytes]) -> tuple[np.ndarray, np.ndarray]:
    """Corners (c, 3) int64 of `f` lines, counted from 1 as written, 0 where not given; and how many each face has."""
    text = b"\n".join(lines)
    if b"#" in text:
        lines = [line.partition(b"#")[0] for line in lines]
        text = b"\n".join(lines)
    tokens = text.split()
    each, rest = divmod(len(tokens), len(lines))
    if rest or tokens[::each].count(b"f") != len(lines):
        rows = [line.split() for line in lines]
        counts = np.array([len(row) - 1 for row in rows], np.int32)
        tokens = [token for row in rows for token in row[1:]]
    else:
        counts = np.full(len(lines), each - 1, np.int32)
        del tokens[::each]
    corners = np.zeros((len(tokens), 3), np.int64)
    joined = b" ".join(tokens)
    slashes = {token.count(b"/") for token in tokens}
    double = joined.count(b"//")
    columns = {0: [0], 1: [0, 1], 2: [0, 1, 2] if not double else [0, 2]}.get(min(slashes, default=0), [0])
    numbers = joined.replace(b"/", b" ").split()
    regular = len(slashes) == 1 and double in (0, len(tokens)) and len(numbers) == len(tokens) * len(columns)
    try:
        if not regular:
            raise ValueError
        corners[:, columns] = np.fromiter(map(int, numbers), np.int64, len(numbers)).reshape(len(tokens), -1)
    except (ValueError, OverflowError):
        for row, token in enumerate(tokens):
            parts = token.split(b"/")[:3]
            corners[row, : len(parts)] = [_index(part) for part in parts]
    return np.clip(corners, -OUT_OF_RANGE, OUT_OF_RANGE), counts


def _number(token: bytes) -> float:
    try:
        return float(token)
    except ValueError:
        return np.nan


def _index(token: bytes) -> int:
    try:
        return max(-OUT_OF_RANGE, min(int(token), OUT_OF_RANGE))
    except ValueError:
        return 0


def _smoothing_group(text: bytes) -> int:
    return abs(_index(text)) % 2**31  # "off" and anything that is no number give 0: flat
