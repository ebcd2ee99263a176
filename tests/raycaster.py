"""Ground truth: a thin-lens ray caster over textured rectangles, in float64 and from first principles.

It shares no line with dofview on purpose. A ray starts at a point of the lens and goes through the point where the
chief ray of its place in the pixel meets the plane of focus; the nearest rectangle it hits gives the colour. Pixels
and lens are integrated by brute force: a jittered grid over the pixel, and over the square around the lens one that is
weighted with the transmission there.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

Transmission = Callable[[np.ndarray, np.ndarray], np.ndarray]


@dataclass(frozen=True)
class Rectangle:
    """The points `origin + u·across + v·down` for u, v in 0…1; `color(u, v)` is linear light, (n,), (n,) to (n, 3)."""

    origin: tuple[float, float, float]
    across: tuple[float, float, float]
    down: tuple[float, float, float]
    color: Callable[[np.ndarray, np.ndarray], np.ndarray]


@dataclass(frozen=True)
class ThinLensCamera:
    """Where the lens stands and what it is; `transmission(x, y)` in lens radii, nothing beyond ±`extent`."""

    position: tuple[float, float, float]
    target: tuple[float, float, float]
    up: tuple[float, float, float]
    vfov_deg: float
    lens_radius: float
    focus_distance: float
    transmission: Transmission
    extent: float = 1.0


def disc(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    return (x * x + y * y < 1.0).astype(float)


def gaussian(sigma: float) -> Transmission:
    """σ in lens radii; use it with an extent of at least 4 σ."""
    return lambda x, y: np.exp(-0.5 * (x * x + y * y) / sigma**2)


def polygon(blades: int, first_corner_deg: float) -> Transmission:
    """A regular polygon with its corners on the rim of the lens."""

    def inside(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        result = np.ones_like(x)
        for k in range(blades):
            a = math.radians(first_corner_deg + 360.0 * k / blades)
            b = math.radians(first_corner_deg + 360.0 * (k + 1) / blades)
            left_of_edge = (math.cos(b) - math.cos(a)) * (y - math.sin(a)) - (math.sin(b) - math.sin(a)) * (
                x - math.cos(a)
            )
            result *= left_of_edge > 0.0
        return result

    return inside


def picture(values: np.ndarray) -> Transmission:
    """A square aperture picture, row 0 at the top, over ±1 lens radii."""
    size = len(values)

    def look_up(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        column = np.clip(((x + 1.0) / 2.0 * size).astype(int), 0, size - 1)
        row = np.clip(((1.0 - y) / 2.0 * size).astype(int), 0, size - 1)
        return values[row, column]

    return look_up


def bilinear(texels: np.ndarray) -> Callable[[np.ndarray, np.ndarray], np.ndarray]:
    """Look up `texels` (h, w, 3) as OpenGL does with LINEAR, REPEAT: centres at (i + ½)/n, v downwards from row 0."""
    height, width = texels.shape[:2]

    def color(u: np.ndarray, v: np.ndarray) -> np.ndarray:
        x, y = u * width - 0.5, v * height - 0.5
        left, top = np.floor(x), np.floor(y)
        fx, fy = (x - left)[:, None], (y - top)[:, None]
        x0, y0 = left.astype(int) % width, top.astype(int) % height
        x1, y1 = (x0 + 1) % width, (y0 + 1) % height
        upper = texels[y0, x0] * (1.0 - fx) + texels[y0, x1] * fx
        lower = texels[y1, x0] * (1.0 - fx) + texels[y1, x1] * fx
        return upper * (1.0 - fy) + lower * fy

    return color


def cast(
    camera: ThinLensCamera, rectangles: list[Rectangle], width: int, height: int, *,
    lens_grid: int = 32, antialias: bool = True, background: tuple[float, float, float] = (0.0, 0.0, 0.0),
    seed: int = 1,
) -> np.ndarray:  # fmt: skip
    """Render (height, width, 3) float64 with `lens_grid`² rays per pixel, row 0 on top."""
    rng = np.random.default_rng(seed)
    forward = _unit(np.subtract(camera.target, camera.position, dtype=float))
    right = _unit(np.cross(forward, camera.up))
    up = np.cross(right, forward)
    tangent = math.tan(math.radians(camera.vfov_deg) / 2.0)

    rows, columns = (a.ravel() for a in np.mgrid[0:height, 0:width])
    pixels = len(rows)
    cells = [(i, j) for i in range(lens_grid) for j in range(lens_grid)]
    pixel_cells = rng.permutation(len(cells))
    total, weights = np.zeros((pixels, 3)), np.zeros(pixels)
    for k, (i, j) in enumerate(cells):
        lens = (np.array([[i], [j]]) + rng.random((2, pixels))) / lens_grid
        lens_x, lens_y = (2.0 * lens - 1.0) * camera.extent
        weight = camera.transmission(lens_x, lens_y)
        if camera.lens_radius == 0.0:
            lens_x, lens_y, weight = np.zeros(pixels), np.zeros(pixels), np.ones(pixels)
        x = y = np.full(pixels, 0.5)
        if antialias:
            m, n = cells[pixel_cells[k]]
            x, y = (np.array([[m], [n]]) + rng.random((2, pixels))) / lens_grid
        # Chief ray at unit depth: pixels are square, the field of view is measured from bottom to top.
        slope_x = (2.0 * (columns + x) - width) / height * tangent
        slope_y = (height - 2.0 * (rows + y)) / height * tangent
        chief = forward + slope_x[:, None] * right + slope_y[:, None] * up
        start = camera.lens_radius * (lens_x[:, None] * right + lens_y[:, None] * up)
        lit = weight > 0.0
        direction = camera.focus_distance * chief[lit] - start[lit]
        seen = _nearest(rectangles, camera.position + start[lit], direction, background)
        total[lit] += weight[lit, None] * seen
        weights += weight
    return (total / weights[:, None]).reshape(height, width, 3)


def _nearest(rectangles: list[Rectangle], start: np.ndarray, direction: np.ndarray, background) -> np.ndarray:
    color = np.broadcast_to(np.asarray(background, dtype=float), start.shape).copy()
    nearest = np.full(len(start), np.inf)
    for rectangle in rectangles:
        across, down = np.asarray(rectangle.across, dtype=float), np.asarray(rectangle.down, dtype=float)
        normal = np.cross(across, down)
        with np.errstate(divide="ignore", invalid="ignore"):
            t = ((rectangle.origin - start) @ normal) / (direction @ normal)
            point = start + t[:, None] * direction - rectangle.origin
        # Coordinates in the rectangle by Cramer's rule, so that its sides need not be at right angles.
        u = np.cross(point, down) @ normal / (normal @ normal)
        v = np.cross(across, point) @ normal / (normal @ normal)
        hit = (t > 0.0) & (t < nearest) & (u >= 0.0) & (u <= 1.0) & (v >= 0.0) & (v <= 1.0)
        nearest[hit] = t[hit]
        color[hit] = rectangle.color(u[hit], v[hit])
    return color


def _unit(vector: np.ndarray) -> np.ndarray:
    return vector / np.linalg.norm(vector)
