"""Every pixel is splatted as its circle of confusion onto three layers of each pixel that it reaches.

Sungkil Lee, Gerard Jounghyun Kim, Seungmoon Choi: Real-Time Depth-of-Field Rendering Using Point Splatting on Per-Pixel
Layers. Computer Graphics Forum 27(7), Pacific Graphics 2008.
"""

from __future__ import annotations

from enum import StrEnum

import numpy as np
from pydantic import Field

from dofview.gl.targets import Image
from dofview.lens import Distribution
from dofview.methods.method import Params as BaseParams
from dofview.methods.method import Recipe
from dofview.methods.splatting_aperture import SHARP_PX
from dofview.methods.splatting_choice import Computation, faster
from dofview.methods.splatting_points import Points, Reduction, draw_highlights, make_points, search_map
from dofview.render.frame import Frame

TITLE = "Point splatting on per-pixel layers"
CITATION = (
    "S. Lee, G. J. Kim, S. Choi. Real-Time Depth-of-Field Rendering Using Point Splatting on Per-Pixel Layers. "
    "Computer Graphics Forum 27(7), 2008."
)
REQUIRES_GL = 330
GUARD_BAND = True
QUALITIES: tuple[dict[str, object], ...] = (
    {"hidden": False, "reduced_from": 3.0}, {"reduced_from": 3.0}, {}, {"reduced_from": 12.0},
)  # fmt: skip


SHARP_PX_OF_SHAPES = 0.01
"""What SHARP_PX is for a disc, for lenses that are none, whose sprites reach farther."""


MOST_TURNS = 50_000
"""Points that a pixel may look at on llvmpipe: it ends a shader after 65535 turns of its loops, and the picture is
black where unmerged sprites are hundreds of pixels wide."""


class HiddenTest(StrEnum):
    """In what the tests for the hidden image measure depth."""

    COC = "coc"
    DEPTH = "depth"


class Params(BaseParams):
    """δ, the tests of the hidden image, highlights, and what makes it fast.

    The paper's own: delta=0.4, hidden_test=depth, epsilon=0.05, edge_depth=0.01, fill=False, reduction=paper,
    computation=scatter.
    """

    delta: float = Field(
        default=0.5, ge=0.0, le=2.0, description="How far apart two blurs may be and still share a layer, of the CoC.",
        json_schema_extra={"symbol": "δ"},
    )  # fmt: skip
    hidden: bool = Field(default=True, description="Render what blurred foreground hides (image H).")
    hidden_test: HiddenTest = Field(
        default=HiddenTest.COC, description="Measure the tests of the hidden image in CoC radius or in scene depth."
    )
    gap: float = Field(
        default=0.5, ge=0.0, le=4.0, description="Hidden surfaces lie this much CoC behind the visible one, of its CoC."
    )
    edge: float = Field(
        default=0.3, ge=0.0, le=4.0, description="Rise of CoC within reach by which something hidden shows, of the CoC."
    )
    epsilon: float = Field(
        default=0.05, ge=0.0, le=1.0,
        description="With depth: hidden surfaces lie this much behind the visible one, of the scene's depth.",
        json_schema_extra={"symbol": "ε"},
    )  # fmt: skip
    edge_depth: float = Field(
        default=0.01, ge=0.0, le=1.0, description="With depth: mean rise of depth within the CoC, of the scene's depth."
    )
    fill: bool = Field(
        default=True, description="Hidden surfaces only fill what visible ones leave open; the paper adds them."
    )
    extrapolate: bool = Field(default=False, description="Extend highlights that were cut off at white (LDR sources).")
    highlight_from: float = Field(
        default=0.8, ge=0.0, le=0.99, description="Luminance from which highlights are extended.",
        json_schema_extra={"symbol": "λ0"},
    )  # fmt: skip
    highlight_falloff: float = Field(
        default=3.0, ge=0.1, le=16.0, description="Exponent of the extension.", json_schema_extra={"symbol": "β"}
    )
    highlight_gain: float = Field(
        default=2.0, ge=1.0, le=64.0, description="Gain of the extension at white.", json_schema_extra={"symbol": "γ"}
    )
    reduction: Reduction = Field(
        default=Reduction.LEVELS,
        description="Merge blurred points: none; paper: 2×2 where nothing is hidden; levels: up to 8×8, by blur.",
    )  # fmt: skip
    reduced_from: float = Field(
        default=6.0, ge=3.0, le=64.0, description="CoC diameter from which points are merged; the paper: 4.",
        json_schema_extra={"unit": "px"},
    )  # fmt: skip
    computation: Computation = Field(
        default=Computation.AUTO,
        description="gather: each pixel looks for its sprites; scatter: sprites are drawn; auto: the faster one here.",
    )
    skip: bool = Field(default=True, description="Leave out work that cannot change the picture.")
    inspect: bool = Field(
        default=False, description="Keep the three layers, and how many points each pixel looks at, as images."
    )


def render(frame: Frame, params: Params) -> Image:
    """Return the picture on the canvas; the guard band itself is not blurred."""
    disc = frame.lens.distribution is Distribution.UNIFORM_DISC
    plain = params.skip and not params.extrapolate and not params.inspect
    if plain and frame.in_focus(SHARP_PX if disc else SHARP_PX_OF_SHAPES):
        return frame.pinhole().color
    recipe = Recipe(frame, "splatting", params)
    points = make_points(recipe, params)
    ways = {Computation.GATHER: _gather, Computation.SCATTER: _scatter}
    way = faster(frame, ways, params) if params.computation is Computation.AUTO else params.computation
    if way is Computation.GATHER and frame.gpu.software and _turns(frame, points) > MOST_TURNS:
        way = Computation.SCATTER
    picture = recipe.image("picture")
    ways[way](recipe, points, picture, params)
    return picture


def _gather(recipe: Recipe, points: Points, picture: Image, params: Params) -> None:
    frame = recipe.frame
    # What is added without need, as the paper does, shows also where a pixel is opaque by itself.
    skip = params.skip and (params.fill or not points.hidden) and recipe.gpu.profile.may_skip("splatting tiles copied")
    reach, largest = search_map(recipe, points, skip)
    flags, textures = dict(points.flags), {"points": points.visible[0][0], "reach": reach, **points.sprite.textures}
    for level, hidden in enumerate(points.hidden):
        textures[f"hidden_points_{level}" if level else "hidden_points"] = hidden
    for level in range(1, points.levels + 1):
        textures[f"points_{level}"], textures[f"far_points_{level}"] = points.visible[level]

    if points.sprites is not None:
        # Highlights keep the rims of their sprites, which merging would soften.
        layers = [recipe.image(f"sprites {name}") for name in ("with", "behind", "in front")]
        if draw_highlights(recipe, points, largest, layers):
            textures |= {"sprites_with": layers[0], "sprites_behind": layers[1], "sprites_in_front": layers[2]}
            flags["SPRITES"] = 1
    into = [picture]
    if params.inspect:
        into += [*(recipe.image(f"L{i}") for i in range(3)), recipe.image("fetches", components=1)]
        flags["INSPECT"] = 1
    without = "splatting front layers skipped"
    if params.skip and recipe.gpu.profile.may_skip(without) and not _has_front(frame.coc_range(), params.delta):
        flags["NO_FRONT"] = 1
        recipe.gpu.profile.count(without)
    if params.inspect or recipe.gpu.profile.timing:
        _count_tiles(recipe, reach, points.levels)
    recipe.draw(
        "gather.frag", into, defines=flags, values={"merged_from": points.merged_from, **points.sprite.values},
        viewport=(frame.guard, frame.guard, *frame.inner_size), clear=params.inspect, images=textures,
    )  # fmt: skip


def _scatter(recipe: Recipe, points: Points, picture: Image, params: Params) -> None:
    """The paper's way: sprites by blending, V to L0–L2, H to M1 and M2 (section 3.4), then composition."""
    l1, l2, l0 = (recipe.image(f"L{i}") for i in (1, 2, 0))
    textures = {"layer_0": l0, "layer_1": l1, "layer_2": l2}
    clear = True
    for level, images in enumerate(points.visible):
        for image in images:
            points.draw_sprites(recipe, image, level, (l1, l2, l0), clear=clear)
            clear = False
    if points.sprites is not None:
        points.draw_sprites(recipe, points.sprites, 0, (l1, l2, l0), clear=False, last=True)
    if points.hidden:
        m1, m2 = recipe.image("M1"), recipe.image("M2")
        textures |= {"hidden_layer_1": m1, "hidden_layer_2": m2}
        for level, image in enumerate(points.hidden):
            points.draw_sprites(recipe, image, level, (m1, m2), clear=level == 0)
    recipe.draw("compose.frag", picture, defines=points.flags, images=textures)


def _turns(frame: Frame, points: Points) -> int:
    """How many single points a pixel may have to look at, at most; merged ones are few."""
    reach = 2 * int(points.finest * points.sprite.extent) + 3
    return min(reach, frame.size[0]) * min(reach, frame.size[1])


def _has_front(coc_range: tuple[float, float], delta: float) -> bool:
    """Whether any point can lie on layer 0 of any pixel: only then is something blurred that much less than another."""
    near, far = coc_range
    reached = [c for c in (near, far, 0.5 / max(delta, 1e-6)) if near <= c <= far]
    # CoC radii are kept in steps of 1/64 px.
    return near - 1.0 / 32.0 < max(c - max(delta * abs(c), 0.5) for c in reached)


def _count_tiles(recipe: Recipe, reach: Image, levels: int) -> None:
    """Count what the search map saves; it is read back for that, so only when someone looks."""
    parts = np.split(reach.pixels()[::-1, :, :3], levels + 1)
    profile = recipe.gpu.profile
    profile.count("splatting tiles", parts[0].shape[0] * parts[0].shape[1])
    profile.count("splatting tiles copied", int((np.max(parts, axis=(0, 3)) < 0.0).sum()))
    profile.count("splatting tiles without hidden points", int((np.max(parts, axis=0)[..., 1] < 0.0).sum()))
