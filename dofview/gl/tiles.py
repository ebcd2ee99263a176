"""Passes over a part of an image: lists of rectangles made of square tiles, drawn instead of the whole.

All lists of a frame lie in one image, a row each, so that they are uploaded at once, and only when they change.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from dofview.gl.targets import Image, TargetPool

TILE = 16
MOST_RECTANGLES = 1024


@dataclass(frozen=True)
class Tiles:
    """The rectangles of one pass: a row of `image`, which holds (left, bottom, right, top) of each in pixels.

    `area` is what they cover, px. A target with one texel for 2^`level` pixels is drawn by the same rectangles.
    """

    image: Image
    row: int
    count: int
    area: int
    level: int = 0

    def at(self, level: int) -> Tiles:
        """The same tiles of a smaller image."""
        return replace(self, level=level)


def coarser(cells: np.ndarray, by: int) -> np.ndarray:
    """(rows, columns) bool over cells, to tiles of `by` × `by` of them: whether any is set. Row 0 is the bottom one."""
    for axis in (1, 0):
        starts = np.arange(0, cells.shape[axis], by)
        cells = np.logical_or.reduceat(cells, starts, axis=axis)
    return cells


def grown(mask: np.ndarray, by: int) -> np.ndarray:
    """`mask` (rows, columns) bool with every element added that is at most `by` away from one of it along both axes."""
    mask = mask.copy()
    for view in (mask, mask.T):
        done = 0
        while done < by:
            # Runs are at least 2 · done + 1 long by now, so a shift by that much leaves no gap.
            step = min(2 * done + 1, by - done)
            before = view.copy()
            view[step:] |= before[:-step]
            view[:-step] |= before[step:]
            done += step
    return mask


def rectangles(masks: np.ndarray) -> list[np.ndarray]:
    """Cover the tiles of each of `masks` (n, rows, columns) by disjoint rectangles, (k, 4) float32 px: runs of a row,
    joined with the same ones of the rows after it, because a rasteriser takes longer over many small ones.

    The last ones may reach beyond the image."""
    edges = np.diff(masks.astype(np.int8), axis=2, prepend=0, append=0)
    which, row, start = np.nonzero(edges > 0)
    end = np.nonzero(edges < 0)[2]
    order = np.lexsort((row, end, start, which))
    which, row, start, end = which[order], row[order], start[order], end[order]
    same = (which[1:] == which[:-1]) & (start[1:] == start[:-1]) & (end[1:] == end[:-1]) & (row[1:] == row[:-1] + 1)
    first = np.flatnonzero(np.r_[True, ~same][: len(row)])
    last = np.flatnonzero(np.r_[~same, True][: len(row)])
    corners = np.stack([start[first], row[first], end[first], row[last] + 1], axis=1).astype(np.float32) * TILE
    return np.split(corners, np.searchsorted(which[first], np.arange(1, len(masks))))


def upload(targets: TargetPool, name: str, masks: Sequence[np.ndarray], size: tuple[int, int]) -> list[Tiles | None]:
    """One list of tiles for each of `masks`, kept in the image `name`; None, the whole, where it would be too long."""
    lists = rectangles(np.array(masks))
    image = targets.image(name, (MOST_RECTANGLES, -(-len(lists) // 16) * 16))
    texels = np.zeros((image.size[1], MOST_RECTANGLES, 4), np.float32)
    for row, found in enumerate(lists):
        texels[row, : len(found)] = found[:MOST_RECTANGLES]
    image.write(texels[::-1])
    whole = np.array([*size, *size], np.float32)
    inside = [np.minimum(found, whole) for found in lists]
    areas = [int(((i[:, 2] - i[:, 0]) * (i[:, 3] - i[:, 1])).sum()) for i in inside]
    return [
        Tiles(image, row, len(found), area) if len(found) <= MOST_RECTANGLES else None
        for row, (found, area) in enumerate(zip(lists, areas, strict=True))
    ]
