"""What is under a point of the picture: a few texels are read back, not the image."""

from __future__ import annotations

import numpy as np

from dofview.render.frame import Frame

MOST_PX = 64
"""Largest radius looked at; a wider one would wait for more texels than an answer is worth."""


def inverse_depth_at(frame: Frame, x: float, y: float, radius: float = 0.0) -> float:
    """Median of 1/z within `radius` of a point in the pinhole picture, 1 / scene unit; 0 when nothing is there.

    `x` and `y` are shares of the picture's width and height from its upper left, `radius` is a share of its height.
    """
    width, height = frame.inner_size
    column = int(np.clip(np.floor(x * width), 0, width - 1))
    row = int(np.clip(np.floor((1.0 - y) * height), 0, height - 1))
    reach = min(round(radius * height), MOST_PX)
    left, low = max(column - reach, 0), max(row - reach, 0)
    right, high = min(column + reach, width - 1), min(row + reach, height - 1)
    values = _read(frame, (left, low, right - left + 1, high - low + 1))
    across = np.arange(left, right + 1) - column
    up = np.arange(low, high + 1)[:, None] - row
    near = np.sort(values[across * across + up * up <= reach * reach])
    # The middle one, not a mean of two: between two surfaces there is nothing.
    return float(near[len(near) // 2])


def _read(frame: Frame, window: tuple[int, int, int, int]) -> np.ndarray:
    """(h, w) float32 of the inverse depth inside `window` (left, low, width, height) of the inner picture."""
    left, low, width, height = window
    image = frame.pinhole().inverse_depth
    target = frame.gpu.targets.framebuffer((image,))
    area = (left + frame.guard, low + frame.guard, width, height)
    data = target.read(viewport=area, components=1, dtype="f4", alignment=1)
    return np.frombuffer(data, np.float32).reshape(height, width)
