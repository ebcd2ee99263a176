"""A frame whose surfaces are given as arrays instead of drawn: exact input for tests of what a method does to them."""

from __future__ import annotations

import numpy as np

from dofview.gl.context import Gpu
from dofview.lens import CocLaw, Distribution, Lens
from dofview.render.frame import DepthRange, Frame, FrameCache, LensBlock, Surfaces


class ImageFrame(Frame):
    """Colour (height, width, 3) linear, and signed CoC radii (height, width) in pixels, under a Gaussian lens whose σ
    is `sigma` of its radius. With the law c = 1000 (1 − 1/z) depths stay clear of 0."""

    def __init__(self, gpu: Gpu, color: np.ndarray, coc: np.ndarray, sigma: float = 0.5):
        self.gpu = gpu
        self.lens = Lens(radius=1.0, focus_distance=1.0, distribution=Distribution.GAUSSIAN, gaussian_sigma=sigma)
        self.coc = CocLaw(scale=1000.0, inverse_focus=1.0)
        self.lens_block = LensBlock(scale=1000.0, inverse_focus=1.0, sigma=sigma)
        self.inner_size = self.size = (color.shape[1], color.shape[0])
        self.guard = 0
        self.background = (0.0, 0.0, 0.0)
        self.cache = FrameCache()
        self.geometry_key = (id(self),)
        self._inverse_depth = np.asarray(self.coc.inverse_depth(np.broadcast_to(coc, color.shape[:2])), np.float32)
        self._surfaces_given = Surfaces(
            gpu.targets.image("test/colour", self.size), gpu.targets.image("test/inverse depth", self.size, 1)
        )
        alpha = np.ones((*color.shape[:2], 1))
        self._surfaces_given.color.write(np.concatenate([color, alpha], axis=2))
        self._surfaces_given.inverse_depth.write(self._inverse_depth[..., None])

    def pinhole(self) -> Surfaces:
        return self._surfaces_given

    def depth_range(self, picture: bool = True) -> DepthRange:
        least = float(self._inverse_depth.min())
        return DepthRange(float(self._inverse_depth.max()), least, False, least)


def point(size: tuple[int, int], at: tuple[int, int]) -> np.ndarray:
    """A picture (height, width, 3) black but for one pixel of 1 at column, row `at`."""
    color = np.zeros((size[1], size[0], 3))
    color[at[1], at[0]] = 1.0
    return color


def moments(picture: np.ndarray) -> tuple[float, np.ndarray, np.ndarray]:
    """Sum, centroid (column, row) in pixel indices, and variance per axis of one channel (height, width)."""
    total = picture.sum()
    y, x = np.mgrid[: picture.shape[0], : picture.shape[1]]
    center = np.array([(x * picture).sum(), (y * picture).sum()]) / total
    variance = np.array([((x - center[0]) ** 2 * picture).sum(), ((y - center[1]) ** 2 * picture).sum()]) / total
    return float(total), center, variance
