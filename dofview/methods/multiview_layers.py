"""The layered picture that multiview synthesis traces rays in: the scene cut into slabs of equal CoC growth.

CoC is affine in 1/z, so slabs of equal CoC growth are slabs of equal steps of 1/z, whatever the lens: moving focus or
aperture draws no triangle.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from pydantic import BaseModel, ConfigDict

from dofview.gl.layered import DepthArray
from dofview.gl.passes import draw
from dofview.gl.targets import Image
from dofview.methods.method import Recipe
from dofview.render.frame import Frame
from dofview.render.raster import depth_range, draw_scene

MOST_LAYERS = 32
"""One bit each in the masks."""

# A geometry shader may write 1024 floats; a vertex of the scene has 20 of them with its position and layer.
PER_INVOCATION = 17


class Slabs(BaseModel):
    """Where the layers lie in 1/z, 1 / scene unit, as shaders read it (slabs.glsl)."""

    model_config = ConfigDict(frozen=True)

    nearest: float
    step: float
    farthest: float
    overlap: float
    count: int


class Layers(NamedTuple):
    """Arrays of the canvas size: colour with coverage in alpha, inverse depth (0: empty); and one bit per layer."""

    slabs: Slabs
    color: Image
    inverse_depth: Image
    occupied: Image


def fit(frame: Frame, count: int, overlap: float) -> Slabs:
    """Return `count` slabs from the nearest to the farthest surface in view, and one more if hidden ones lie beyond.

    What is nearest on the canvas is always visible. What is farthest may not be; it is bounded by the scene's box,
    which can be far larger than anything a ray meets, so it does not get a share of the steps.
    """
    view = frame.depth_range()
    if view.nearest == 0.0:
        return Slabs(nearest=1.0, step=1.0, farthest=0.0, overlap=overlap, count=0)
    step = max((view.nearest - view.farthest_surface) / count, view.nearest * 1e-5)
    end = min(1.0 / depth_range(frame.scene, frame.camera)[1], view.farthest_surface)
    hidden = (view.farthest_surface - end) / step > 0.25
    farthest = end if hidden else min(end, view.nearest - count * step)
    return Slabs(
        nearest=view.nearest, step=step, farthest=max(farthest, 0.0), overlap=overlap, count=count + int(hidden)
    )


def count_for_growth(frame: Frame, growth_px: float) -> int:
    """Layers needed for a CoC growth of at most `growth_px` each; the growth is larger where that would be too many."""
    view = frame.depth_range()
    growth = abs(frame.coc.scale) * (view.nearest - view.farthest_surface)
    return min(max(math.ceil(growth / growth_px), 1), MOST_LAYERS - 1)


def build(recipe: Recipe, slabs: Slabs, way: str) -> Layers:
    """Draw the scene into the layers of `slabs`, unless they are there from the last frame.

    `way` is "exact": once, each triangle sent to every layer it overlaps, fragments outside left out; "passes": once
    per layer, for drivers without layered rendering.
    """
    frame, gpu = recipe.frame, recipe.gpu
    count = max(slabs.count, 1)
    images = recipe.image("layers", layers=count), recipe.image("layers inverse depth", components=1, layers=count)
    occupied = recipe.image("occupied layers", components=1, dtype="u4")
    way = way if _can_layer(frame, count) else "passes"
    key = (frame.geometry_key, slabs, way)
    kept = [frame.cache.holds(key, image) for image in (*images, occupied)]
    if not all(kept):
        if slabs.count:
            with gpu.profile.section("multiview/layers"):
                {"exact": _draw_exact, "passes": _draw_passes}[way](recipe, slabs, images)
        recipe.draw("occupied.frag", occupied, blocks={"Slabs": slabs}, layer_inverse_depth=images[1])
    return Layers(slabs, *images, occupied)


def _draw_exact(recipe: Recipe, slabs: Slabs, images: tuple[Image, Image]) -> None:
    frame, gpu = recipe.frame, recipe.gpu
    # Two sizes only, so that one layer more or less while the camera moves compiles nothing.
    most = PER_INVOCATION // 2 + 1 if slabs.count <= PER_INVOCATION // 2 + 1 else PER_INVOCATION
    draw_scene(
        gpu, frame.scene, frame.projection(), images, lights=frame.lights, framebuffer=_layered(recipe, images),
        geometry="methods/multiview/layers.geom", reject="methods/multiview/reject_slab.glsl", blocks={"Slabs": slabs},
        defines={"INVOCATIONS": -(-slabs.count // most), "MOST_LAYERS": most, "MOST_VERTICES": 3 * most},
    )  # fmt: skip


def _draw_passes(recipe: Recipe, slabs: Slabs, images: tuple[Image, Image]) -> None:
    frame, gpu = recipe.frame, recipe.gpu
    one = recipe.image("one layer"), recipe.image("one layer inverse depth", components=1)
    for k in range(slabs.count):
        draw_scene(
            gpu, frame.scene, frame.projection(), one, lights=frame.lights, values={"slab": k},
            reject="methods/multiview/reject_slab.glsl", blocks={"Slabs": slabs}, defines={"ONE_LAYER": 1},
        )  # fmt: skip
        for image, layer in zip(one, images, strict=True):
            draw(
                gpu, "pass/copy.frag", layer, textures={"source": image}, geometry="pass/to_layer.geom",
                values={"layer": k},
            )  # fmt: skip


def _layered(recipe: Recipe, images: tuple[Image, Image]):
    return recipe.gpu.targets.framebuffer(images, depth=True)


def _can_layer(frame: Frame, count: int) -> bool:
    """Whether one pass can write `count` layers, each with its own depth."""
    gpu = frame.gpu
    return DepthArray.available(gpu.ctx) and (count <= PER_INVOCATION or gpu.version_code >= 400)
