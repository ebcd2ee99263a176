"""Surfaces that are seen through: their triangles in order, the farthest first, so that each is laid over the others.

Depth along the view axis is the same from every point of the lens, so one order serves all views of the reference.
"""

from __future__ import annotations

import moderngl
import numpy as np

from dofview.gl.context import Gpu
from dofview.scene.model import Material

MOST_RUNS = 2000
"""Runs of one material after another, each a draw call; where there would be more, materials are kept together."""

Runs = list[tuple[int, int, int]]


class Blended:
    """The blended triangles of a scene; `materials` (n,) of each, `triangles` (n, 3) into `positions` (v, 3), local."""

    def __init__(self, gpu: Gpu, materials: np.ndarray, triangles: np.ndarray, positions: np.ndarray):
        self.materials = materials
        self._triangles = triangles
        self._centres = positions[triangles].mean(axis=1, dtype=np.float64) if len(triangles) else np.zeros((0, 3))
        self.indices: moderngl.Buffer | None = gpu.ctx.buffer(triangles.tobytes()) if len(triangles) else None
        self._axis: bytes = b""
        self._runs: Runs = []

    def __bool__(self) -> bool:
        return self.indices is not None

    def farthest_first(self, clip_from_local: np.ndarray) -> Runs:
        """Sort for a view; material, first index and count of each run, in the order to draw them."""
        axis = np.ascontiguousarray(clip_from_local[3, :3])
        if self.indices is None or axis.tobytes() == self._axis:
            return self._runs
        depth = self._centres @ axis
        order = np.argsort(-depth, kind="stable")
        if np.count_nonzero(np.diff(self.materials[order])) >= MOST_RUNS:
            _, member = np.unique(self.materials, return_inverse=True)
            mean = np.bincount(member, depth) / np.bincount(member)
            order = order[np.argsort(-mean[member[order]], kind="stable")]
        self.indices.orphan()
        self.indices.write(self._triangles[order].tobytes())
        materials = self.materials[order]
        starts = np.flatnonzero(np.r_[True, np.diff(materials) != 0])
        counts = np.diff(np.r_[starts, len(materials)])
        self._runs = [(int(materials[s]), 3 * int(s), 3 * int(n)) for s, n in zip(starts, counts, strict=True)]
        self._axis = axis.tobytes()
        return self._runs

    def release(self) -> None:
        if self.indices is not None:
            self.indices.release()


def is_translucent(material: Material, colors: bool) -> bool:
    """Whether any point of `material` lets light through; `colors` says that of its vertex colours."""
    if material.alpha_mode != "BLEND":
        return False
    texture = material.base_color_texture
    return material.base_color[3] < 1.0 or colors or (
        texture is not None and bool((texture.picture.pixels[..., 3] < 255).any())
    )  # fmt: skip
