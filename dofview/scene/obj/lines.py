"""Parsing many `v`, `vt`, `vn` or `f` lines at once, and one token at a time only where they are irregular."""

from __future__ import annotations

import numpy as np

MISSING = -1
OUT_OF_RANGE = 2**31 - 1


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


def smoothing_group(text: bytes) -> int:
    """The number after `s`; "off" and anything that is no number give 0, which is flat."""
    return abs(_index(text))
