"""Cutting polygons into triangles: fans where convex, the right diagonal for quads, ears where concave.

A plain fan covers a concave face wrongly (an arrowhead of area 10 comes out as 14); ear clipping (Meisters 1975) does
not.
"""

from __future__ import annotations

import numpy as np

from dofview.scene.normals import unit
from dofview.scene.notes import Notes

MOST_TESTS = 8_000_000  # point-in-ear tests in one file, some seconds; ear clipping is quadratic in the corners

BATCH_CORNERS = 500_000  # polygons are looked at together, in batches that keep the temporary arrays small


def triangulate(
    positions: np.ndarray, place: np.ndarray, counts: np.ndarray, notes: Notes
) -> tuple[np.ndarray, np.ndarray]:
    """Cut faces into triangles: `place` (c,) are the positions of all their corners in order, `counts` (f,) how many.

    Returns triangles (t, 3) int32 as numbers of corners, and the face (t,) int32 each belongs to, faces in order.
    """
    starts = np.cumsum(counts) - counts
    firsts = np.cumsum(counts - 2) - (counts - 2)
    triangles = np.empty((int((counts - 2).sum()), 3), np.int32)
    effort = _Effort(notes)
    for corners in np.unique(counts).tolist():
        faces = np.flatnonzero(counts == corners)
        fan = _fan(corners)
        for some in np.array_split(faces, len(faces) * corners // BATCH_CORNERS + 1):
            cut = np.broadcast_to(fan, (len(some), *fan.shape))
            if corners > 3:
                cut = _cut(positions[place[starts[some, None] + np.arange(corners)]], cut, effort)
            triangles[firsts[some, None] + np.arange(corners - 2)] = cut + starts[some, None, None]
    return triangles, np.repeat(np.arange(len(counts), dtype=np.int32), counts - 2)


def _fan(corners: int) -> np.ndarray:
    return np.stack([np.zeros(corners - 2, int), np.arange(1, corners - 1), np.arange(2, corners)], axis=1)


def _cut(points: np.ndarray, cut: np.ndarray, effort: _Effort) -> np.ndarray:
    """(m, k - 2, 3) local corner numbers of the triangles of m polygons `points` (m, k, 3); `cut` are their fans."""
    reflex = _reflex(points)
    if not reflex.any():
        return cut
    cut = cut.copy()
    if points.shape[1] == 4:
        # A quad is cut right along the diagonal through its reflex corner.
        cut[reflex[:, 1] | reflex[:, 3]] = [[1, 2, 3], [1, 3, 0]]
        return cut
    for face in np.flatnonzero(reflex.any(axis=1)).tolist():
        ears = clip_ears(_flattened(points[face]), effort)
        if ears is not None:
            cut[face] = ears
    return cut


def _reflex(points: np.ndarray) -> np.ndarray:
    """(m, k) where a corner turns the wrong way, seen along the polygon's own normal (Newell)."""
    scaled = points - points[:, :1]
    largest = np.abs(scaled).max(axis=(1, 2), keepdims=True)
    scaled = np.divide(scaled, largest, out=np.zeros_like(scaled), where=largest > 0)
    ahead = np.roll(scaled, -1, axis=1) - scaled
    normal = unit(np.cross(scaled, np.roll(scaled, -1, axis=1)).sum(axis=1))
    turns = np.cross(np.roll(ahead, 1, axis=1), ahead)
    return (turns * normal[:, None]).sum(axis=-1) < -1e-12


def _flattened(points: np.ndarray) -> list[tuple[float, float]]:
    """A polygon (k, 3) seen along the largest axis of its normal, counter-clockwise, scaled to about 1."""
    centred = points - points[0]
    centred = centred / (np.abs(centred).max() or 1.0)
    normal = np.cross(centred, np.roll(centred, -1, axis=0)).sum(axis=0)
    axis = int(np.argmax(np.abs(normal)))
    first, second = (axis + 1) % 3, (axis + 2) % 3
    flat = centred[:, [first, second]] * ((1.0, 1.0) if normal[axis] >= 0 else (-1.0, 1.0))
    return [(x, y) for x, y in flat.tolist()]


class _Effort:
    """Counts the work of ear clipping in one file, so that a hostile one cannot take hours."""

    def __init__(self, notes: Notes) -> None:
        self.left, self._notes = MOST_TESTS, notes

    def spend(self, tests: int) -> bool:
        """Take from what is left; False, with a note, when nothing is."""
        self.left -= tests
        if self.left < 0:
            self._notes.say("too many concave faces of many corners; some cut as if convex")
        return self.left >= 0


def clip_ears(points: list[tuple[float, float]], effort: _Effort) -> list[tuple[int, int, int]] | None:
    """Cut a simple counter-clockwise polygon into triangles of corner numbers; None when it costs too much.

    One that crosses itself has a point where no ear is left; then the next corner is cut off as it is.
    """
    remaining = list(range(len(points)))
    triangles: list[tuple[int, int, int]] = []
    at, misses = 0, 0
    while len(remaining) > 3:
        size = len(remaining)
        before, here, after = remaining[at - 1], remaining[at], remaining[(at + 1) % size]
        if not effort.spend(size):
            return None
        if misses > size or _is_ear(points, before, here, after, remaining):
            triangles.append((before, here, after))
            del remaining[at]
            at, misses = (at - 1) % (size - 1), 0
        else:
            at, misses = (at + 1) % size, misses + 1
    return [*triangles, (remaining[0], remaining[1], remaining[2])]


def _is_ear(points: list[tuple[float, float]], a: int, b: int, c: int, remaining: list[int]) -> bool:
    (ax, ay), (bx, by), (cx, cy) = points[a], points[b], points[c]
    if (bx - ax) * (cy - ay) - (by - ay) * (cx - ax) <= 0:
        return False
    corners = ((ax, ay), (bx, by), (cx, cy))
    for index in remaining:
        x, y = point = points[index]
        if (
            (bx - ax) * (y - ay) - (by - ay) * (x - ax) >= 0
            and (cx - bx) * (y - by) - (cy - by) * (x - bx) >= 0
            and (ax - cx) * (y - cy) - (ay - cy) * (x - cx) >= 0
            and point not in corners  # holes bridged by a double edge repeat points
        ):
            return False
    return True
