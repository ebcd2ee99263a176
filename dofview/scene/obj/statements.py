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
from dofview.scene.limits import Account
from dofview.scene.notes import Notes
from dofview.scene.obj.lines import MISSING, OUT_OF_RANGE, faces, smoothing_group, table

BLOCK_BYTES = 2_000_000
LONGEST_LINE = 4_000_000
TRIANGLE_BYTES = 120  # about what a triangle needs at the peak, vertices apart
NO_INDICES = np.zeros(0, np.int32)
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
    colors: np.ndarray | None = None  # (n, 3), NaN where a vertex has none; None when no vertex has one
    texcoords: np.ndarray = field(default_factory=lambda: np.zeros((0, 2)))
    normals: np.ndarray = field(default_factory=lambda: np.zeros((0, 3)))
    corners: tuple[np.ndarray, np.ndarray, np.ndarray] = (NO_INDICES,) * 3  # position, texcoord and normal of each
    counts: np.ndarray = field(default_factory=lambda: np.zeros(0, np.int32))  # of corners, for each face
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


def scan(data: bytes, account: Account, notes: Notes) -> Statements:
    """Parse the bytes of an OBJ file; ModelError when nothing in it looks like one."""
    scanner = _Scanner(account, notes)
    for block in _blocks(normalise(data)):
        scanner.scan_block(block)
    return scanner.finish()


def _blocks(data: bytes) -> Iterator[bytes]:
    start = 0
    while start < len(data):
        end = data.find(b"\n", start + BLOCK_BYTES)
        end = len(data) if end < 0 else end
        if end - start > LONGEST_LINE + BLOCK_BYTES:
            raise ModelError(f"has a line of {end - start - BLOCK_BYTES} bytes or more; accepted: up to {LONGEST_LINE}")
        yield data[start:end]
        start = end + 1


class _Scanner:
    def __init__(self, account: Account, notes: Notes) -> None:
        self._account, self._notes = account, notes
        self._made = Statements()
        self._tables: dict[bytes, list[np.ndarray]] = {b"v": [], b"vt": [], b"vn": []}
        self._colors: list[np.ndarray | None] = []
        self._seen = dict.fromkeys(self._tables, 0)
        self._corners: list[tuple[np.ndarray, ...]] = []
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
                values = table(kind, picked)
                tables.append(values[:, :3].copy())
                self._seen[kind] += len(picked)
                if kind == b"v":
                    self._colors.append(None if np.isnan(values[:, 3:]).all() else values[:, 3:])

    def _scan_faces(self, lines: list[bytes], is_kind: dict[bytes, np.ndarray]) -> None:
        picked = list(compress(lines, is_kind[b"f"].tolist()))
        if not picked:
            return
        corners, counts = faces(picked)
        triangles = int(np.maximum(counts - 2, 0).sum())
        self._account.charge_triangles(triangles)
        self._account.charge_geometry(triangles * TRIANGLE_BYTES)
        if (corners < 0).any():
            line_of = np.repeat(np.flatnonzero(is_kind[b"f"]), counts)
            for column, kind in enumerate(self._tables):
                relative = corners[:, column] < 0
                so_far = self._seen[kind] + np.cumsum(is_kind[kind])[line_of[relative]]
                absolute = corners[relative, column] + so_far + 1
                corners[relative, column] = np.where(absolute > 0, absolute, OUT_OF_RANGE)
        corners -= 1
        columns = corners.astype(np.int32).T
        # A column that nothing uses takes no memory.
        self._corners.append(tuple(c.copy() if (c != MISSING).any() else _nothing(len(c)) for c in columns))
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
            self._made.smoothing.append((face, smoothing_group(rest)))
        elif keyword in _LEFT_OUT:
            self._notes.count(*_LEFT_OUT[keyword], "not shown")
            self._left_out += 1
        elif keyword not in _WITHOUT_EFFECT and not keyword.startswith(b"#"):
            self._notes.count("line", "lines", "of no known kind ignored")

    def finish(self) -> Statements:
        """Join the blocks."""
        if not (self._seen[b"v"] or self._faces or self._left_out):
            raise ModelError("holds no vertex and no face; accepted: Wavefront OBJ text")
        made, tables = self._made, self._tables
        if any(colors is not None for colors in self._colors):
            pairs = zip(self._colors, tables[b"v"], strict=True)
            made.colors = np.concatenate([np.full_like(v, np.nan) if c is None else c for c, v in pairs])
        made.positions = np.concatenate([made.positions, *tables.pop(b"v")])
        made.texcoords = np.concatenate([made.texcoords, *tables.pop(b"vt")])
        made.normals = np.concatenate([made.normals, *tables.pop(b"vn")])
        if self._corners:
            columns = list(zip(*self._corners, strict=True))
            self._corners.clear()
            made.corners = _joined(columns[0]), _joined(columns[1]), _joined(columns[2])
            made.counts = np.concatenate(self._counts)
        return made


def _nothing(count: int) -> np.ndarray:
    return np.broadcast_to(np.int32(MISSING), count)


def _joined(parts: tuple[np.ndarray, ...]) -> np.ndarray:
    if any(part.strides[0] for part in parts):
        return np.concatenate(parts)
    return _nothing(sum(map(len, parts)))
