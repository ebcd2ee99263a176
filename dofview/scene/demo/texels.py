"""What the textures of the demo scenes are painted with: periodic noise, cells, antialiased contours, colour ramps.

Colours are sRGB in 0..1 until `picture` stores them as 8 bit.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from dofview.scene.model import Picture

SIZE = 512


def rgb(code: str) -> np.ndarray:
    """(3,) sRGB in 0..1 of a colour written as rrggbb."""
    return np.array([int(code[i : i + 2], 16) for i in (0, 2, 4)]) / 255.0


@lru_cache(maxsize=32)
def noise(seed: int, exponent: float = 1.0, stretch: float = 1.0, size: int = SIZE) -> np.ndarray:
    """(size, size) periodic noise with amplitude 1/f^exponent, mean 0.5, deviation 0.17, clipped to 0..1.

    `stretch` > 1 draws it out along rows, as wood grain.
    """
    spectrum = np.fft.rfft2(np.random.default_rng(seed).random((size, size)) - 0.5)
    rows, columns = np.fft.fftfreq(size)[:, None], np.fft.rfftfreq(size)[None, :] * stretch
    frequency = np.hypot(rows, columns) * size
    spectrum *= np.where(frequency > 0, np.maximum(frequency, 1.0) ** -exponent, 0.0)
    field = np.fft.irfft2(spectrum, s=(size, size))
    return np.clip(0.5 + 0.17 * field / field.std(), 0.0, 1.0)


def grid(size: int = SIZE) -> tuple[np.ndarray, np.ndarray]:
    """x and y of the pixel centres in 0..1, y downwards."""
    axis = (np.arange(size) + 0.5) / size
    return np.meshgrid(axis, axis)


def inside(distance: np.ndarray, pixel: float = 1.0 / SIZE) -> np.ndarray:
    """Coverage, 1 where the signed `distance` to a contour is negative, with an edge one pixel wide."""
    return np.clip(0.5 - distance / pixel, 0.0, 1.0)


def mix(under: np.ndarray, over: np.ndarray, cover: np.ndarray) -> np.ndarray:
    """Lay colour `over` on colour `under` where `cover` (h, w) is 1."""
    return under + (over - under) * cover[..., None]


def ramp(field: np.ndarray, codes: Sequence[str]) -> np.ndarray:
    """Colour a field in 0..1 with evenly spaced colours."""
    stops = np.array([rgb(code) for code in codes])
    at = np.linspace(0.0, 1.0, len(stops))
    return np.stack([np.interp(field, at, stops[:, k]) for k in range(3)], axis=-1)


def cells(seed: int, count: int, size: int = SIZE) -> tuple[np.ndarray, np.ndarray]:
    """Periodic Voronoi cells on a jittered count×count lattice: index of the cell and half the gap to its neighbour."""
    jitter = np.random.default_rng(seed).random((count, count, 2))
    x, y = (axis * count for axis in grid(size))
    column, row = np.floor(x).astype(int), np.floor(y).astype(int)
    nearest, second = np.full(x.shape, 9.0), np.full(x.shape, 9.0)
    owner = np.zeros(x.shape, dtype=int)
    for dr in (-2, -1, 0, 1, 2):
        for dc in (-2, -1, 0, 1, 2):
            r, c = (row + dr) % count, (column + dc) % count
            site = jitter[r, c]
            distance = np.hypot(column + dc + site[..., 0] - x, row + dr + site[..., 1] - y)
            second = np.minimum(second, np.maximum(nearest, distance))
            owner = np.where(distance < nearest, r * count + c, owner)
            nearest = np.minimum(nearest, distance)
    return owner, (second - nearest) / 2 / count


def picture(name: str, color: np.ndarray) -> Picture:
    """Store sRGB colours (h, w, 3) in 0..1 as an opaque picture of 8 bit."""
    pixels = np.full((*color.shape[:2], 4), 255, dtype=np.uint8)
    pixels[..., :3] = np.round(np.clip(color, 0.0, 1.0) * 255)
    return Picture(name, pixels)
