"""Multiview synthesis: views through the lens made from one layered picture, by tracing lens rays through its layers.

Sungkil Lee, Elmar Eisemann and Hans-Peter Seidel: Depth-of-Field Rendering with Multiview Synthesis. ACM Transactions
on Graphics 28(5), SIGGRAPH Asia 2009.
"""

from __future__ import annotations

from enum import StrEnum

import numpy as np
from pydantic import Field

from dofview.gl.targets import Image
from dofview.methods.method import Params as BaseParams
from dofview.methods.method import Recipe
from dofview.methods.multiview_layers import MOST_LAYERS, Layers, build, count_for_growth, fit
from dofview.render.frame import Frame
from dofview.sampling import lens_samples

TITLE = "Multiview synthesis"
CITATION = "S. Lee, E. Eisemann, H.-P. Seidel. Depth-of-Field Rendering with Multiview Synthesis. ACM TOG 28(5), 2009."
REQUIRES_GL = 330
GUARD_BAND = True
TILE = 8


class Spacing(StrEnum):
    """What the layers are counted by."""

    BUDGET = "budget"
    GROWTH = "growth"


class Layering(StrEnum):
    """How the scene gets into the layers."""

    EXACT = "exact"
    PASSES = "passes"


class Culling(StrEnum):
    """How layers that a pixel's rays cannot meet are found."""

    TILES = "tiles"
    OFF = "off"


class Params(BaseParams):
    """Layers, rays and what is saved on them."""

    samples: int = Field(
        default=32, ge=1, le=256, description="Rays per pixel.", json_schema_extra={"symbol": "N"}
    )  # fmt: skip
    spacing: Spacing = Field(default=Spacing.BUDGET, description="Layers by number, or by how much blur each spans.")
    layers: int = Field(
        default=16, ge=1, le=MOST_LAYERS - 1,
        description="Layers over the depths in view; hidden surfaces behind them get one more.",
    )  # fmt: skip
    growth: float = Field(
        default=3.0, ge=0.25, le=64.0, json_schema_extra={"unit": "px", "symbol": "δ"},
        description="CoC growth of a layer when they are spaced by it; more where 31 layers are not enough.",
    )  # fmt: skip
    overlap: float = Field(default=0.1, ge=0.0, le=0.5, description="How far layers reach into each other, in layers.")
    layering: Layering = Field(default=Layering.EXACT, description="How the scene is put into the layers.")
    probes: int = Field(default=3, ge=1, le=5, description="Depths looked at to find where a ray meets a layer.")
    culling: Culling = Field(default=Culling.TILES, description="How layers without anything in reach are left out.")


def render(frame: Frame, params: Params) -> Image:
    """Draw the layers, find which of them each pixel can see, trace."""
    recipe = Recipe(frame, "multiview", params)
    count = params.layers if params.spacing is Spacing.BUDGET else count_for_growth(frame, params.growth)
    layers = build(recipe, fit(frame, count, params.overlap), params.layering)
    points = lens_points(recipe, params)
    mask, shift = tile_mask(recipe, layers, params, points)
    result = recipe.image("result")
    recipe.draw(
        "trace.frag", result, blocks={"Slabs": layers.slabs}, layer_color=layers.color,
        layer_inverse_depth=layers.inverse_depth, mask=mask, lens_points=points,
        values={"background": frame.background, "mask_shift": shift, "guard": frame.guard},
    )  # fmt: skip
    return result


def lens_points(recipe: Recipe, params: Params) -> Image:
    """The lens samples as a row of texels."""
    points = recipe.image("lens points", (params.samples, 1), components=2)
    if not recipe.frame.cache.holds((recipe.frame.lens, params.samples), points):
        points.write(lens_samples(recipe.frame.lens, params.samples, progressive=False).astype(np.float32)[None])
    return points


def tile_mask(recipe: Recipe, layers: Layers, params: Params, points: Image) -> tuple[Image, int]:
    """Per tile of 8 by 8 pixels, one bit for every layer that holds something within reach of the tile's rays."""
    if params.culling is Culling.OFF:
        mask = recipe.image("mask", (1, 1), components=1, dtype="u4")
        mask.write(np.full((1, 1, 1), (1 << layers.slabs.count) - 1, np.uint32))
        return mask, 31
    width, height = recipe.frame.size
    size = (-(-width // TILE), -(-height // TILE))
    held, across, spread = (recipe.image(name, size, 1, "u4") for name in ("tiles", "tiles across", "mask"))
    recipe.draw("tiles.frag", held, defines={"TILE": TILE}, occupied=layers.occupied)
    extent = float(np.abs(lens_samples(recipe.frame.lens, params.samples, progressive=False)).max())
    for source, into, axis in ((held, across, (1, 0)), (across, spread, (0, 1))):
        recipe.draw(
            "spread.frag", into, blocks={"Slabs": layers.slabs}, defines={"TILE": TILE}, tiles=source,
            values={"axis": axis, "lens_extent": extent, "footprint": 0.0},
        )  # fmt: skip
    return spread, 3
