"""Making numbers from a file fit for the GPU: finite, in range, and nothing stored that no triangle uses."""

from __future__ import annotations

import math

import numpy as np

from dofview.scene.notes import Notes

LARGEST = 1e18  # scene units; the square of it still fits in float32
BRIGHTEST = 65504.0  # the largest half float, so that no colour overflows in a 16-bit target


def used_rows(triangles: np.ndarray) -> tuple[slice | np.ndarray, np.ndarray]:
    """Select the rows that `triangles` (m, 3) use: a selector for the attributes and the triangles renumbered to it."""
    if len(triangles) == 0:
        return slice(0, 0), np.zeros((0, 3), np.uint32)
    low, high = int(triangles.min()), int(triangles.max()) + 1
    if high - low > 4 * triangles.size:
        # A few triangles in a huge shared array: their cost must not depend on its size.
        rows, local = np.unique(triangles, return_inverse=True)
        return rows, local.reshape(-1, 3).astype(np.uint32)
    local = (triangles - np.uint32(low)).astype(np.uint32)
    used = np.zeros(high - low, bool)
    used[local] = True
    if used.all():
        return slice(low, high), local
    return np.flatnonzero(used) + low, (np.cumsum(used, dtype=np.uint32) - np.uint32(1))[local]


def repaired_texcoords(texcoords: np.ndarray, notes: Notes) -> np.ndarray:
    """Replace texture coordinates that are not finite by 0, with a note."""
    wrong = ~(np.abs(texcoords) <= LARGEST)
    notes.count("texture coordinate", "texture coordinates", "not finite, taken as 0", int(wrong.any(axis=1).sum()))
    return np.where(wrong, texcoords.dtype.type(0), texcoords)


def repaired_colors(colors: np.ndarray, notes: Notes) -> np.ndarray:
    """Clip colours to [0, 65504] and replace those that are not numbers by white, with a note."""
    wrong = np.isnan(colors)
    notes.count("vertex colour", "vertex colours", "not a number, taken as white", int(wrong.any(axis=1).sum()))
    return np.clip(np.where(wrong, colors.dtype.type(1), colors), 0.0, colors.dtype.type(BRIGHTEST))


def origin_for(positions: np.ndarray) -> np.ndarray:
    """(3,) float64 to subtract so that float32 keeps the decimals of a model far from the origin.

    The centre of the box rounded to a multiple of a power of two no smaller than the box: zero for a model that is not
    far away for its size.
    """
    if len(positions) == 0:
        return np.zeros(3)
    low, high = positions.min(axis=0), positions.max(axis=0)
    size = float((high - low).max())
    step = 2.0 ** math.ceil(math.log2(size)) if size > 0 else 2.0**-20
    return np.round((low + high) / 2 / step) * step
