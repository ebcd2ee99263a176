"""Face and vertex normals in numpy, in float64: the squares of anything from 1e-38 to 1e18 fit in there."""

from __future__ import annotations

import numpy as np

BATCH = 100_000  # triangles at a time, so that the float64 temporaries of a large model stay small


def unit(vectors: np.ndarray) -> np.ndarray:
    """(…, 3) float64 of unit length, zero where `vectors` have none."""
    vectors = vectors.astype(np.float64, copy=False)
    length = np.sqrt(np.einsum("...i,...i->...", vectors, vectors))[..., None]
    return np.divide(vectors, length, out=np.zeros(vectors.shape), where=length > 0)


def cross(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """(…, 3) cross product; for the thousands of tiny arrays of some files, numpy's own is ten times slower."""
    ahead, behind = [1, 2, 0], [2, 0, 1]
    return first[..., ahead] * second[..., behind] - first[..., behind] * second[..., ahead]


def face_normals(positions: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """(m, 3) float32 unit normals of the (m, 3) `triangles`, counter-clockwise; +z for triangles without area."""
    normals = np.empty((len(triangles), 3), np.float32)
    for start in range(0, len(triangles), BATCH):
        corners = np.asarray(positions[triangles[start : start + BATCH]], np.float64)
        normals[start : start + BATCH] = _or_z(_normals_of(corners))
    return normals


def smooth_normals(positions: np.ndarray, triangles: np.ndarray, keys: np.ndarray | None = None) -> np.ndarray:
    """(n, 3) float32 unit normals: face normals weighted by the corner's angle (Thürmer and Wüthrich 1998).

    Angles make the result independent of how a polygon was cut into triangles. `keys` (m, 3) says which corners share a
    normal (default: those with the same position index); then the result has one row for each key.
    """
    keys = triangles if keys is None else keys
    count = len(positions) if keys is triangles else int(keys.max()) + 1 if keys.size else 0
    sums = np.zeros((count, 3))
    batch = max(BATCH, len(triangles) // 16)  # each batch costs a pass over all sums
    for start in range(0, len(triangles), batch):
        corners = np.asarray(positions[triangles[start : start + batch]], np.float64)
        edges = unit(np.roll(corners, -1, axis=1) - corners)  # (m, 3, 3): edge i runs from corner i to corner i + 1
        cosines = -(edges * np.roll(edges, 1, axis=1)).sum(axis=-1)
        weighted = np.arccos(np.clip(cosines, -1.0, 1.0))[..., None] * _normals_of(corners)[:, None]
        places = keys[start : start + batch].ravel()
        for axis in range(3):
            sums[:, axis] += np.bincount(places, weighted[..., axis].ravel(), minlength=count)
    return _or_z(unit(sums)).astype(np.float32)


def _normals_of(corners: np.ndarray) -> np.ndarray:
    """(m, 3) unit normals of triangles given as (m, 3, 3) corners, zero for those without area."""
    return unit(cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))


def _or_z(normals: np.ndarray) -> np.ndarray:
    normals[~normals.any(axis=-1)] = (0.0, 0.0, 1.0)
    return normals
