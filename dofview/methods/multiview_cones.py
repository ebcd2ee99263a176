"""What cones read: each layer once more, averaged over squares as wide as a cone that passes its middle.

The paper reads a mipmap at the level of the cone's width. As layers are thin in CoC, one width a layer is as good: then
four texels of one image take the place of eight from two levels, and no mipmap of empty layers is built.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from dofview.gl.passes import draw
from dofview.gl.targets import Image
from dofview.lens import CocLaw
from dofview.methods.method import Recipe
from dofview.methods.multiview_layers import TILE, Layers, Slabs
from dofview.methods.multiview_shading import grid, shading

PATCH = 16
"""Side of what is averaged at once where a layer holds anything, pixels; a multiple of `TILE`."""


class Cones(NamedTuple):
    """Layers as cones read them, by the sampler names of the layers themselves; `width` is that of a cone, texels of a
    layer per pixel of CoC radius, and `footprint` how far from itself a cone reads each layer, pixels."""

    images: dict[str, Image]
    width: float
    footprint: np.ndarray


NO_CONES = Cones({}, 0.0, np.zeros(1))


def average(recipe: Recipe, layers: Layers, width: float) -> Cones:
    """Average `layers` for cones of `width` times the CoC radius, unless that is there from an earlier frame.

    Layer k becomes an image of 1/`square` of the size in the middle of its array (cones.glsl). Only patches in which a
    layer holds anything are drawn.
    """
    frame, slabs, width = recipe.frame, layers.slabs, width * layers.detail
    color = layers.images["layer_color"]
    images = {
        name: recipe.image(f"{name.replace('_', ' ')} in cones", color.size, *kind, True, color.shape.layers)
        for name, kind in layers.kind.cone_formats().items()
    }
    key = (frame.geometry_key, layers.kind, frame.lens_block, width)
    kept = [frame.cache.holds(key, image) for image in images.values()]
    if not all(kept) and slabs.count:
        across, down = (-(-side // PATCH) for side in frame.size)
        light = shading(frame, layers)
        with recipe.gpu.profile.section("multiview/cones"):
            draw(
                recipe.gpu, "methods/multiview/cones.frag", tuple(images.values()),
                textures={**layers.images, **light.textures, "tiles": layers.tiles},
                blocks={**recipe.blocks, **light.blocks, "Slabs": slabs}, clear=True,
                vertex="methods/multiview/cones.vert", geometry="methods/multiview/cones.geom",
                sprites=-(-across * down // 2), defines={**light.defines, "PATCH": PATCH, "TILE": TILE},
                values={**grid(layers), "cone_width": width},
            )  # fmt: skip
    # A bilinear fetch reads two squares along each axis: as far as one and a half of them.
    return Cones(images, width, 1.5 * squares(frame.coc, slabs, width) / layers.detail)


def squares(law: CocLaw, slabs: Slabs, width: float) -> np.ndarray:
    """Sides of the squares of each layer, texels (cones.glsl); `width` is that of a cone per pixel of CoC radius."""
    front, back = (law.radius_px(bound) for bound in slabs.bounds())
    middle, half = 0.5 * np.abs(front + back), 0.5 * np.abs(front - back)
    return np.maximum(width * np.clip(2.0 * (middle - half), 0.0, middle), 1.0)
