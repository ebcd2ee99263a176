"""The surfaces demo scenes are made of, each a map of the unit square that can be cut as finely as asked.

A shape is a tuple of patches. How many triangles a scene has is decided when its patches are cut, not when they
are described, so that the same picture can be had with ten thousand triangles or with a million.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

Surface = Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]
Point = tuple[float, float, float]


@dataclass(frozen=True)
class Patch:
    """A surface over (u, v) in the unit square.

    `surface(u, v)` gives positions and unit normals (…, 3); `cells` is how it is cut by default along u and v;
    `repeat` is how often the texture goes over it; `poles` are the ends of v that shrink to a point; `bevel` is the
    share of u and of v, at either end, that a rounded edge takes and that a quarter of the cells go to; `texture(u, v)`
    replaces `repeat` where texture coordinates are not in proportion to u and v.
    """

    surface: Surface
    cells: tuple[int, int]
    repeat: tuple[float, float] = (1.0, 1.0)
    poles: tuple[bool, bool] = (False, False)
    least: tuple[int, int] = (1, 1)
    bevel: tuple[float, float] | None = None
    texture: Callable[[np.ndarray, np.ndarray], np.ndarray] | None = None

    def cut(self, scale: float) -> tuple[int, int]:
        """Cells along u and v when the default is made `scale` times as fine."""
        nu, nv = (max(least, round(n * scale)) for n, least in zip(self.cells, self.least, strict=True))
        return nu, nv

    def count(self, scale: float) -> int:
        """Triangles after `cut(scale)`."""
        nu, nv = self.cut(scale)
        return nu * (2 * nv - sum(self.poles))

    def mesh(self, scale: float) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Positions, normals (n, 3), texture coordinates (n, 2), float64, and counter-clockwise triangles (m, 3)."""
        nu, nv = self.cut(scale)
        bevel = self.bevel or (None, None)
        u, v = (a.ravel() for a in np.meshgrid(_steps(nu, bevel[0]), _steps(nv, bevel[1])))
        positions, normals = self.surface(u, v)
        corner = (np.arange(nv)[:, None] * (nu + 1) + np.arange(nu)).ravel()
        lower = np.stack([corner, corner + 1, corner + nu + 2], axis=-1)
        upper = np.stack([corner, corner + nu + 2, corner + nu + 1], axis=-1)
        triangles = np.concatenate([lower[nu if self.poles[0] else 0 :], upper[: -nu if self.poles[1] else None]])
        a, b, c = (positions[triangles[:, k]] for k in range(3))
        if np.sum(np.cross(b - a, c - a) * normals[triangles[:, 0]]) < 0:
            triangles = triangles[:, ::-1]
        texcoords = self.texture(u, v) if self.texture else np.stack([u, v], axis=-1) * self.repeat
        return positions, normals, texcoords, triangles


def _steps(count: int, bevel: float | None) -> np.ndarray:
    if bevel is None:
        return np.linspace(0, 1, count + 1)
    ends = max(1, count // 4)
    return np.interp(np.arange(count + 1), (0, ends, count - ends, count), (0, bevel, 1 - bevel, 1))


Shape = tuple[Patch, ...]


def place(shape: Shape, at: Point = (0, 0, 0), turn: Point = (0, 0, 0), scale: float = 1.0) -> Shape:
    """Scale, turn about x, then y, then z (degrees) and move a shape."""
    rotation = np.eye(3)
    for axis, degrees in enumerate(turn):
        i, j = (axis + 1) % 3, (axis + 2) % 3
        step = np.eye(3)
        step[[i, i, j, j], [i, j, i, j]] = np.array([1, -1, 1, 1]) * np.array(
            [np.cos(a := np.radians(degrees)), np.sin(a), np.sin(a), np.cos(a)]
        )
        rotation = step @ rotation

    def moved(surface: Surface) -> Surface:
        def at_uv(u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            positions, normals = surface(u, v)
            return positions @ rotation.T * scale + at, normals @ rotation.T

        return at_uv

    return tuple(replace(patch, surface=moved(patch.surface)) for patch in shape)


def sheet(origin: Point, across: Point, along: Point, cells: tuple[int, int], tile: float = 1.0) -> Shape:
    """A flat parallelogram from `origin`; its texture repeats every `tile` units. The normal is across × along."""
    o, a, b = (np.array(x, dtype=np.float64) for x in (origin, across, along))
    normal = np.cross(a, b) / np.linalg.norm(np.cross(a, b))

    def surface(u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return o + u[:, None] * a + v[:, None] * b, np.broadcast_to(normal, (len(u), 3))

    return (Patch(surface, cells, (float(np.linalg.norm(a)) / tile, float(np.linalg.norm(b)) / tile)),)


def ground(eye: float, near: float, far: float, cells: tuple[int, int], tile: float, height: float = 0.0) -> Shape:
    """A level floor between the distances `near` and `far` along −z from z = `eye`, as wide as the view and half more.

    Its cells grow with the distance, so that they are much the same size in the picture and carry shade well.
    """

    def spot(u: np.ndarray, v: np.ndarray) -> np.ndarray:
        distance = near * (far / near) ** v
        return np.stack([(2 * u - 1) * 0.75 * distance, eye - distance], axis=-1)

    def surface(u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        x, z = spot(u, v).T
        return np.stack([x, np.full_like(x, height), z], axis=-1), np.broadcast_to(np.eye(3)[1], (len(u), 3))

    return (Patch(surface, cells, texture=lambda u, v: spot(u, v) / tile),)


def lathe(
    profile: Sequence[tuple[float, float]], cells: tuple[int, int], repeat: tuple[float, float] = (2, 1)
) -> Shape:
    """Turn a smooth curve through (radius, height) points, from the bottom up, about the y axis."""
    points = np.array(profile, dtype=np.float64)
    closed = (bool(points[0, 0] == 0), bool(points[-1, 0] == 0))

    def surface(u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        at, slope = _curve(points, v)
        angle = 2 * np.pi * u
        ring = np.stack([np.cos(angle), np.zeros_like(u), -np.sin(angle)], axis=-1)
        up = np.array([0.0, 1.0, 0.0])
        normals = ring * slope[:, 1:] - up * slope[:, :1]
        return ring * np.maximum(at[:, :1], 0) + up * at[:, 1:], normals / np.linalg.norm(
            normals, axis=1, keepdims=True
        )

    return (Patch(surface, cells, repeat, closed, (3, 2)),)


def _curve(points: np.ndarray, t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Point and direction of the centripetal Catmull-Rom curve through `points` at t in 0..1, k/(n - 1) at point k.

    Centripetal, because it makes neither loops nor cusps where points lie at uneven distances.
    """
    step = np.linalg.norm(np.diff(points, axis=0), axis=1, keepdims=True) ** 0.5
    speed = np.diff(points, axis=0) / step
    tangent = np.concatenate(
        [speed[:1], (speed[:-1] * step[1:] + speed[1:] * step[:-1]) / (step[:-1] + step[1:]), speed[-1:]]
    )
    x = np.clip(t, 0, 1) * (len(points) - 1)
    k = np.minimum(x.astype(int), len(points) - 2)
    f, a, b = (x - k)[:, None], points[k], points[k + 1]
    m, n = tangent[k] * step[k], tangent[k + 1] * step[k]
    value = a + f * (m + f * (3 * (b - a) - 2 * m - n + f * (2 * (a - b) + m + n)))
    return value, m + f * (2 * (3 * (b - a) - 2 * m - n) + 3 * f * (2 * (a - b) + m + n))


def sphere(radius: float, cells: tuple[int, int] = (20, 12), repeat: tuple[float, float] = (2, 1)) -> Shape:
    """A ball about the origin with its poles on the y axis."""

    def surface(u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        a, b = 2 * np.pi * u, np.pi * v
        normals = np.stack([np.sin(b) * np.cos(a), -np.cos(b), -np.sin(b) * np.sin(a)], axis=-1)
        return normals * radius, normals

    return (Patch(surface, cells, repeat, (True, True), (3, 2)),)


def torus(major: float, minor: float, cells: tuple[int, int] = (36, 14), repeat: tuple[float, float] = (6, 1)) -> Shape:
    """A ring about the y axis."""

    def surface(u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        a, b = 2 * np.pi * u, 2 * np.pi * v
        ring = np.stack([np.cos(a), np.zeros_like(a), -np.sin(a)], axis=-1)
        normals = ring * np.cos(b)[:, None] + np.array([0.0, 1.0, 0.0]) * np.sin(b)[:, None]
        return ring * major + normals * minor, normals

    return (Patch(surface, cells, repeat, least=(3, 3)),)


def tube(path: Sequence[Point], radius: float, cells: tuple[int, int] = (10, 12), tile: float = 1.0) -> Shape:
    """A round bar of open ends along the smooth curve through `path`; the texture repeats along it every `tile`."""
    points = np.array(path, dtype=np.float64)
    if len(points) == 2:
        points = np.linspace(points[0], points[1], 3)
    length = float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())
    chord = points[-1] - points[0]
    side = np.cross(chord, np.eye(3)[np.argmin(np.abs(chord))])

    def surface(u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        at, along = _curve(points, v)
        along = along / np.linalg.norm(along, axis=1, keepdims=True)
        first = np.cross(along, np.cross(side, along))
        first /= np.linalg.norm(first, axis=1, keepdims=True)
        angle = 2 * np.pi * u[:, None]
        normals = first * np.cos(angle) + np.cross(along, first) * np.sin(angle)
        return at + radius * normals, normals

    return (Patch(surface, cells, (1.0, max(1.0, length / tile)), least=(3, 1)),)


def box(size: Point, bevel: float = 0.0, cells: int = 4, tile: float = 1.0) -> Shape:
    """A block about the origin with rounded edges; with `bevel` 0 the edges are sharp and `cells` may be 1."""
    half = np.array(size, dtype=np.float64) / 2
    return tuple(_face(half, bevel, axis, sign, cells, tile) for axis in range(3) for sign in (-1.0, 1.0))


def _face(half: np.ndarray, bevel: float, axis: int, sign: float, cells: int, tile: float) -> Patch:
    i, j = ((2, 1), (0, 2), (0, 1))[axis]

    def surface(u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        points = np.empty((len(u), 3))
        points[:, axis], points[:, i], points[:, j] = sign * half[axis], (2 * u - 1) * half[i], (2 * v - 1) * half[j]
        if not bevel:
            return points, np.broadcast_to(np.eye(3)[axis] * sign, points.shape)
        core = np.clip(points, bevel - half, half - bevel)
        normals = (points - core) / np.linalg.norm(points - core, axis=1, keepdims=True)
        return core + bevel * normals, normals

    repeat = (2 * half[i] / tile, 2 * half[j] / tile)
    if not bevel:
        return Patch(surface, (cells, cells), repeat)
    return Patch(surface, (cells, cells), repeat, least=(3, 3), bevel=(bevel / half[i] / 2, bevel / half[j] / 2))
