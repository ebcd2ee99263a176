"""The guard band: how much of the scene outside the picture must be drawn because its blur reaches in."""

from __future__ import annotations

import math

import numpy as np

from dofview.gl.context import Gpu
from dofview.gl.filters import reduce_blocks
from dofview.lens import Lens, focal_px
from dofview.render.frame import FrameCache
from dofview.render.lights import Lights
from dofview.render.raster import Projection, Runs, depth_range, draw_scene, projection
from dofview.render.upload import GpuScene
from dofview.scene.camera import Camera

MOST_PX = 128
STEP_PX = 8
"""Widths are multiples of this, so that a small change of the lens does not draw the scene anew."""

LOOK_FROM_PX = 24
REDUCTION = 8
MARGIN = 1.1


def guard_band(
    gpu: Gpu, scene: GpuScene, camera: Camera, lens: Lens, size: tuple[int, int], cache: FrameCache
) -> int:  # fmt: skip
    """Width in pixels of the band around a picture of `size`: its largest CoC radius, up to `MOST_PX`.

    The scene's bounds give a first answer. Where that is wide, as it always is with the camera inside the bounds, a
    picture of an eighth of the size shows what is really near; it is drawn once for a camera, not for a lens.
    """
    if not scene.draws or lens.radius == 0.0:
        return 0
    law = lens.coc(focal_px(size[1], camera.vfov_deg))
    near, far = depth_range(scene, camera)
    nearest, farthest = 1.0 / near, 1.0 / far
    if _largest(law, nearest, farthest) > LOOK_FROM_PX:
        look = _Look(gpu, scene, camera, size, cache)
        nearest, farthest = look.nearest(), farthest / MARGIN
        if _largest(law, farthest, farthest) > _largest(law, nearest, nearest):
            # Behind the focus what counts is the farthest surface, which others may hide.
            nearest, farthest = look.nearest_and_farthest()
    width = math.ceil(min(_largest(law, nearest, farthest), MOST_PX) / STEP_PX) * STEP_PX
    return min(width, MOST_PX)


def _largest(law, nearest: float, farthest: float) -> float:
    return max(abs(float(law.radius_px(nearest))), abs(float(law.radius_px(farthest))))


class _Look:
    """What is seen in the picture and the widest band around it, at an eighth of the size."""

    def __init__(self, gpu: Gpu, scene: GpuScene, camera: Camera, size: tuple[int, int], cache: FrameCache):
        self.gpu, self.scene, self.camera, self.cache = gpu, scene, camera, cache
        self.size = (-(-size[0] // REDUCTION), -(-size[1] // REDUCTION))
        self.key = ("seen depths", id(scene), camera, size)

    def nearest(self) -> float:
        """Greatest 1/z, with a margin. Only what may hold it is drawn: nothing hides the nearest surface."""
        key = (*self.key, "nearest")
        if key not in self.cache.values:
            view = self._view()
            seen = self.scene.visible(view.clip_from_local)
            nearest, farthest, inside = self.scene.depths(seen, view.clip_from_local)
            # What lies inside as a whole can be seen if nothing nearer is; what is farther than it need not be drawn.
            known = float((1.0 / farthest[inside]).max(initial=0.0))
            near = seen[nearest * known <= 1.0] if self.scene.culling else seen
            found = self._drawn(near)[0]
            self.cache.values[key] = (found if found >= known else self._drawn(seen)[0]) * MARGIN
        return self.cache.values[key]  # type: ignore[return-value]

    def nearest_and_farthest(self) -> tuple[float, float]:
        """Greatest and least 1/z, with a margin."""
        if self.key not in self.cache.values:
            greatest, least = self._drawn(self.scene.visible(self._view().clip_from_local))
            self.cache.values[self.key] = (greatest * MARGIN, min(least, greatest) / MARGIN)
        return self.cache.values[self.key]  # type: ignore[return-value]

    def _view(self) -> Projection:
        return projection(self.scene, self.camera, self.size, MOST_PX // REDUCTION)

    def _drawn(self, numbers: np.ndarray) -> tuple[float, float]:
        """Greatest and least 1/z of the draws `numbers`."""
        band, scene = MOST_PX // REDUCTION, self.scene
        beyond = len(scene.draws) - len(scene.visible(self._view().clip_from_local))
        canvas = (self.size[0] + 2 * band, self.size[1] + 2 * band)
        depths = self.gpu.targets.image("guard/inverse depth", canvas, components=1)
        with self.gpu.profile.section("scene/guard band"):
            draw_scene(
                self.gpu, scene, self._view(), (depths,), lights=Lights.of(self.camera, None),
                defines={"DEPTH_ONLY": 1}, draws=Runs(scene.runs(numbers), beyond),
            )  # fmt: skip
        least, greatest, _, _ = reduce_blocks(self.gpu, depths, "render/depth_range.frag", "guard/range")
        return float(greatest), float(least)
