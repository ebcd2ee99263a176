"""Multiview synthesis: views through the lens made from one layered picture, by tracing lens rays through its layers.

Sungkil Lee, Elmar Eisemann and Hans-Peter Seidel: Depth-of-Field Rendering with Multiview Synthesis. ACM Transactions
on Graphics 28(5), SIGGRAPH Asia 2009.
"""

from __future__ import annotations

import math
from enum import StrEnum

import numpy as np
from pydantic import Field

from dofview.gl.passes import AnyTexture
from dofview.gl.targets import Image
from dofview.methods.method import Params as BaseParams
from dofview.methods.method import Recipe
from dofview.methods.multiview_cones import NO_CONES, Cones, average
from dofview.methods.multiview_culling import Culling, Mask, mask
from dofview.methods.multiview_layers import (
    MOST_LAYERS,
    TILE,
    Kind,
    Layering,
    Layers,
    affordable,
    build,
    count_for_growth,
    fit,
)  # fmt: skip
from dofview.methods.multiview_shading import grid, shading
from dofview.render.frame import Frame
from dofview.sampling import halton, lens_samples, on_lens

TITLE = "Multiview synthesis"
CITATION = "S. Lee, E. Eisemann, H.-P. Seidel. Depth-of-Field Rendering with Multiview Synthesis. ACM TOG 28(5), 2009."
REQUIRES_GL = 330
GUARD_BAND = True
QUALITIES: tuple[dict[str, object], ...] = (
    {"samples": 8, "layers": 8, "probes": 1}, {"samples": 16}, {}, {"samples": 64, "layers": 24},
)  # fmt: skip
NOISE_SIZE = 64
SHARP_PX = 5e-6
"""CoC radius up to which the picture is the pinhole's to 1e-5, px: beyond, cones take in what is beside a pixel."""


class Spacing(StrEnum):
    """What the layers are counted by."""

    BUDGET = "budget"
    GROWTH = "growth"


class Jitter(StrEnum):
    """How the lens samples differ from pixel to pixel."""

    OFF = "off"
    NOISE = "noise"
    HALTON = "halton"


class Show(StrEnum):
    """What is shown: the picture, or what it is made from."""

    PICTURE = "picture"
    COLOR = "color"
    COVERAGE = "coverage"
    LAYERS = "layers"
    PROBES = "probes"


class Params(BaseParams):
    """Layers, rays and what is saved on them."""

    samples: int = Field(
        default=32, ge=1, le=256, description="Rays per pixel.", json_schema_extra={"symbol": "N"}
    )  # fmt: skip
    spacing: Spacing = Field(default=Spacing.BUDGET, description="Layers by number, or by how much blur each spans.")
    layers: int = Field(
        default=16, ge=1, le=MOST_LAYERS - 1, json_schema_extra={"symbol": "M"},
        description="Layers over the depths in view; hidden surfaces behind them get one more.",
    )  # fmt: skip
    growth: float = Field(
        default=3.0, ge=0.25, le=64.0, json_schema_extra={"unit": "px", "symbol": "δ"},
        description="CoC growth of a layer when they are spaced by it; more where 31 layers are not enough.",
    )  # fmt: skip
    overlap: float = Field(default=0.1, ge=0.0, le=0.5, description="How far layers reach into each other, in layers.")
    layering: Layering = Field(
        default=Layering.EXACT, description="Each triangle in all its layers, or the paper's one, or a pass per layer."
    )
    detail: int = Field(default=1, ge=1, le=3, description="Texels of a layer along each side of a pixel.")
    memory: int = Field(
        default=3072, ge=16, le=65536, json_schema_extra={"unit": "MiB"},
        description="What the layers may take; beyond it they get less detail, then fewer.",
    )  # fmt: skip
    probes: int = Field(default=3, ge=1, le=5, description="Depths looked at to find where a ray meets a layer.")
    cones: bool = Field(default=True, description="Widen rays to cones that meet with the ones beside them.")
    cone_width: float = Field(
        default=1.0, ge=0.0, le=4.0, json_schema_extra={"symbol": "λ√N"},
        description="Width of a cone times the square root of the rays, in CoC radii; the paper's is 0.775.",
    )  # fmt: skip
    jitter: Jitter = Field(default=Jitter.OFF, description="Lens samples that differ from pixel to pixel.")
    view_dependent: bool = Field(
        default=False, description="Light surfaces for the point of the lens that sees them, not for its centre."
    )
    skip: bool = Field(default=True, description="Leave out work that cannot change the picture.")
    culling: Culling = Field(default=Culling.TILES, description="How layers without anything in reach are left out.")
    show: Show = Field(default=Show.PICTURE, description="The picture, one layer, layers walked, or probes per ray.")
    shown_layer: int = Field(default=0, ge=0, le=MOST_LAYERS - 1, description="The layer that is shown.")


def render(frame: Frame, params: Params) -> Image:
    """Draw the layers, find which of them each pixel can see, trace."""
    if params.skip and params.show is Show.PICTURE and frame.in_focus(SHARP_PX, picture=False):
        return frame.pinhole().color
    recipe = Recipe(frame, "multiview", params)
    count = params.layers if params.spacing is Spacing.BUDGET else count_for_growth(frame, params.growth)
    kind = Kind(fit(frame, count, params.overlap), params.layering, params.detail, params.view_dependent, params.cones)
    kind = affordable(frame, kind, params.memory * 2.0**20)
    layers, points = build(recipe, kind), lens_points(frame, params)
    # Noise moves a sample within the square that is its share of the disc.
    noise = math.sqrt(math.pi / params.samples) if params.jitter is Jitter.NOISE else 0.0
    cones = average(recipe, layers, _cone_radius(params)) if params.cones else NO_CONES
    culling = params.culling if recipe.gpu.profile.may_skip("multiview layers skipped") else Culling.OFF
    reach = mask(recipe, culling, layers, float(np.abs(points).max()) + noise / 2, cones.footprint)
    result = recipe.image("result")
    values = {**grid(layers), "mask_shift": reach.shift}
    if params.show in (Show.PICTURE, Show.PROBES):
        _trace(recipe, params, layers, cones, reach, result, {**values, "noise_width": noise})
    else:
        recipe.draw(
            "show.frag", result, blocks={"Slabs": layers.slabs}, values=values, mask=reach.image,
            layer_color=layers.images["layer_color"],
        )  # fmt: skip
    return result


def lens_points(frame: Frame, params: Params) -> np.ndarray:
    """Lens samples, (n, 2) in lens radii: one per ray, or twice as many for the Halton jitter, where each pixel takes
    its rays from another place."""
    key = _points_key(frame, params)
    if key not in frame.cache.values:
        if params.jitter is Jitter.HALTON:
            points = on_lens(frame.lens, halton(2 * params.samples))
        else:
            points = lens_samples(frame.lens, params.samples, progressive=False, symmetric=True)
        frame.cache.values[key] = drawn_in(points, _cone_radius(params))
    return frame.cache.values[key]  # type: ignore[return-value]


def drawn_in(points: np.ndarray, cone_radius: float) -> np.ndarray:
    """Draw lens samples in until their cones spread light as far, in mean square, as the points alone did.

    A bilinear fetch of squares as wide as the cone's radius spreads by a quarter of its square along each axis.
    """
    # Rounded, so that what is symmetric stays so.
    middle = np.round(points.mean(axis=0), 9)
    spread = float(np.mean((points - middle) ** 2))
    kept = max(1.0 - 0.25 * cone_radius**2 / spread, 0.0) if spread > 0.0 else 0.0
    return middle + math.sqrt(kept) * (points - middle)


def _cone_radius(params: Params) -> float:
    """The paper's λ: the radius of a cone, CoC radii."""
    return params.cone_width / math.sqrt(params.samples) if params.cones else 0.0


def _points_key(frame: Frame, params: Params) -> tuple:
    return "multiview/lens points", frame.lens, params.samples, params.jitter is Jitter.HALTON, _cone_radius(params)


def _trace(
    recipe: Recipe, params: Params, layers: Layers, cones: Cones, reach: Mask, into: Image, values: dict[str, object]
) -> None:  # fmt: skip
    frame, light = recipe.frame, shading(recipe.frame, layers)
    textures: dict[str, AnyTexture] = {**layers.images, **cones.images, **light.textures}
    textures |= {
        "mask": reach.image,
        "tile_mask": reach.tiles,
        "noise": _noise(recipe),
        "lens_points": _points(recipe, params),
    }
    # What decides on code is compiled in: a software rasteriser runs both sides of every branch.
    options = {
        "PROBES": params.probes,
        "CONES": params.cones,
        "TILE": TILE,
        "JITTER": list(Jitter).index(params.jitter),
    }
    recipe.draw(
        "trace.frag", into, blocks={**light.blocks, "Slabs": layers.slabs}, images=textures,
        defines={**options, **light.defines},
        values={**values, "cone_width": cones.width, "background": frame.background, "guard": frame.guard},
    )  # fmt: skip


def _points(recipe: Recipe, params: Params) -> Image:
    """The lens samples as a row of texels."""
    points = lens_points(recipe.frame, params)
    image = recipe.image("lens points", (len(points), 1), components=2)
    if not recipe.frame.cache.holds(_points_key(recipe.frame, params), image):
        image.write(points[None])
    return image


def _noise(recipe: Recipe) -> Image:
    """Four independent values in [0, 1) per texel, the same on every run."""
    image = recipe.image("noise", (NOISE_SIZE, NOISE_SIZE))
    if not recipe.frame.cache.holds("noise", image):
        image.write(np.random.default_rng(2009).random((NOISE_SIZE, NOISE_SIZE, 4), np.float32))
    return image
