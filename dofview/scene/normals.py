"""Face and vertex normals in numpy, float64 inside so that neither tiny nor huge models under- or overflow."""

from __future__ import annotations

import numpy as np


def unit(vectors: np.ndarray) -> np.ndarray:
    """Scale (n, 3) vectors to unit length, zero where they have none."""
    largest = np.abs(vectors).max(axis=-1, keepdims=True, initial=0.0)
    scaled = np.divide(vectors, largest, out=np.zeros_like(vectors), where=largest > 0)
    length = np.linalg.norm(scaled, axis=-1, keepdims=True)
    return np.divide(scaled, length, out=np.zeros_like(scaled), where=length > 0)


def face_normals(positions: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """(m, 3) float64 unit normals of the (m, 3) `triangles`, counter-clockwise; +z for triangles without area."""
    corners = np.asarray(positions, np.float64)[triangles]
    first, second = unit(corners[:, 1] - corners[:, 0]), unit(corners[:, 2] - corners[:, 0])
    normals = unit(np.cross(first, second))
    normals[~normals.any(axis=1)] = (0.0, 0.0, 1.0)
    return normals


def smooth_normals(positions: np.ndarray, triangles: np.ndarray, keys: np.ndarray | None = None) -> np.ndarray:
    """(n, 3) float32 unit normals: face normals weighted by the corner's angle (Thürmer and Wüthrich 1998).

    Angles make the result independent of how a polygon was cut into triangles. `keys` (m, 3) says which corners share a
    normal (default: those with the same position index); then the result has one row for each key.
    """
    keys = triangles if keys is None else keys
    count = len(positions) if keys is triangles else int(keys.max(initial=-1)) + 1
    corners = np.asarray(positions, np.float64)[triangles]
    edges = unit(np.roll(corners, -1, axis=1) - corners)  # (m, 3, 3): edge i runs from corner i to corner i + 1
    angles = np.arccos(np.clip(-(edges * np.roll(edges, 1, axis=1)).sum(axis=-1), -1.0, 1.0))
    normals = face_normals(positions, triangles)
    flat_area = ~np.cross(edges[:, 0], edges[:, 1]).any(axis=-1)
    angles[flat_area] = 0.0
    sums = np.stack(
        [np.bincount(keys.ravel(), (angles * normals[:, axis, None]).ravel(), minlength=count) for axis in range(3)],
        axis=-1,
    )
    sums = unit(sums.reshape(count, 3))
    sums[~sums.any(axis=1)] = (0.0, 0.0, 1.0)
    return sums.astype(np.float32)
