"""The guard band: how much of the scene outside the picture must be drawn because its blur reaches in."""

from __future__ import annotations

import math

from dofview.gl.context import Gpu
from dofview.gl.filters import reduce_blocks
from dofview.lens import Lens, focal_px
from dofview.render.frame import FrameCache
from dofview.render.lights import Lights
from dofview.render.raster import depth_range, draw_scene, projection
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
        nearest, farthest = _seen_depths(gpu, scene, camera, size, cache)
    width = math.ceil(min(_largest(law, nearest, farthest), MOST_PX) / STEP_PX) * STEP_PX
    return min(width, MOST_PX)


def _largest(law, nearest: float, farthest: float) -> float:
    return max(abs(float(law.radius_px(nearest))), abs(float(law.radius_px(farthest))))


def _seen_depths(
    gpu: Gpu, scene: GpuScene, camera: Camera, size: tuple[int, int], cache: FrameCache
) -> tuple[float, float]:  # fmt: skip
    """Greatest and least 1/z of what is seen in the picture and the widest band around it, with a margin."""
    key = ("seen depths", id(scene), camera, size)
    if key not in cache.values:
        small = (-(-size[0] // REDUCTION), -(-size[1] // REDUCTION))
        band = MOST_PX // REDUCTION
        canvas = (small[0] + 2 * band, small[1] + 2 * band)
        depths = gpu.targets.image("guard/inverse depth", canvas, components=1)
        with gpu.profile.section("scene/guard band"):
            view = projection(scene, camera, small, band)
            draw_scene(gpu, scene, view, (depths,), lights=Lights.of(camera, None), defines={"DEPTH_ONLY": 1})
        least, greatest, _, _ = reduce_blocks(gpu, depths, "render/depth_range.frag", "guard/range")
        cache.values[key] = (float(greatest) * MARGIN, min(float(least), float(greatest)) / MARGIN)
    return cache.values[key]  # type: ignore[return-value]
