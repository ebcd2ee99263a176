"""Depth of field by interpolating anisotropically filtered mipmaps of one pinhole picture.

Sungkil Lee, Gerard Jounghyun Kim, Seungmoon Choi: Real-Time Depth-of-Field Rendering Using Anisotropically Filtered
Mipmap Interpolation. IEEE TVCG 15(3), 2009. Fast and independent of the size of the blur: a preview, with one surface
per pixel and a Gaussian lens.
"""

from __future__ import annotations

import math
from enum import StrEnum
from typing import NamedTuple

from pydantic import Field

from dofview.gl.pyramids import Atlas, level_size, most_levels
from dofview.gl.targets import Image
from dofview.methods.method import Params as BaseParams
from dofview.methods.method import Recipe
from dofview.render.frame import Frame

TITLE = "Mipmap interpolation"
CITATION = (
    "S. Lee, G. J. Kim, S. Choi. Real-Time Depth-of-Field Rendering Using Anisotropically Filtered Mipmap "
    "Interpolation. IEEE Transactions on Visualization and Computer Graphics 15(3), 2009."
)
REQUIRES_GL = 330
GUARD_BAND = True
QUALITIES: tuple[dict[str, object], ...] = (
    {"constants": "paper"}, {"anisotropic": False, "smooth_foreground": False}, {},
)  # fmt: skip


SHARP_PX = 0.003
"""CoC radius up to which the picture is the pinhole's to 1e-5, px; it grows as the square beyond."""


class Constants(StrEnum):
    """Which constants and filters."""

    MATCHED = "matched"
    PAPER = "paper"


class Params(BaseParams):
    """What the paper leaves to choose, and its own choices."""

    constants: Constants = Field(
        default=Constants.MATCHED,
        description="Filters and blur calibrated by their measured response, or as printed in the paper.",
    )
    delta: float = Field(
        default=0.4, ge=0.0, le=8.0,
        description="How much sharper, in px of σ, a neighbour of a blurred background pixel may be and still mix in.",
        json_schema_extra={"unit": "px", "symbol": "δ"},
    )  # fmt: skip
    anisotropic: bool = Field(default=True, description="Keep what is sharp from leaking into the blurred background.")
    smooth_foreground: bool = Field(
        default=True, description="Let blur in front of the focus fade out across silhouettes."
    )
    skip: bool = Field(default=True, description="Leave out work that cannot change the picture.")


def render(frame: Frame, params: Params) -> Image:
    """Return the picture with depth of field. Steps are numbered as in the paper's figure 10."""
    if params.skip and frame.in_focus(SHARP_PX):
        return frame.pinhole().color
    paper = params.constants == Constants.PAPER
    sigma = frame.lens.radius_as_sigma_fraction if paper else frame.lens.matched_sigma_fraction
    recipe = Recipe(frame, "mipmap", params, sigma=sigma)
    nearest, farthest = frame.coc_range()
    top = _level(sigma * max(abs(nearest), abs(farthest)))
    most = most_levels(frame.size)
    may_skip = frame.gpu.profile.may_skip
    levels = min(math.ceil(top), most) if params.skip and may_skip("mipmap levels skipped") else most
    frame.gpu.profile.count("mipmap levels skipped", most - levels)
    atlas = Atlas(frame.size, max(levels, 1))
    defines = {"LAST_LEVEL": atlas.levels}
    defines |= {"PAPER": 1} if paper else {}
    defines |= {"ANISOTROPIC": 1} if params.anisotropic else {}

    # 1–3. The pinhole picture with its degree of blurring (DoB), and all that is coarser.
    even, odd = _pyramids(recipe, atlas, defines)

    # 4. Without it the blurred foreground would stop at its silhouette as if cut out.
    foreground: dict[str, Image] = {}
    if params.smooth_foreground and (nearest < 0.0 or not (params.skip and may_skip("mipmap smoothings skipped"))):
        don = recipe.image("DoN", level_size(frame.size, 1), components=1, linear=True)
        recipe.draw(
            "neighbours.frag", don, values={**atlas.values(), "top": top}, defines=defines, even_levels=even.zbn,
            odd_levels=odd.zbn,
        )  # fmt: skip
        foreground = {"don": don, "even_zbn": even.zbn, "odd_zbn": odd.zbn}
        defines["SMOOTHED"] = 1
    elif params.smooth_foreground:
        frame.gpu.profile.count("mipmap smoothings skipped")

    # 5. Between the two levels that give each pixel its blur.
    result = recipe.image("result")
    recipe.draw(
        "blend.frag", result, values=atlas.values(), defines=defines, inverse_depth=frame.pinhole().inverse_depth,
        even_levels=even.colors, odd_levels=odd.colors, images=foreground,
    )  # fmt: skip
    return result


class Levels(NamedTuple):
    """The even or the odd levels of both pyramids."""

    colors: Image
    zbn: Image


def _pyramids(recipe: Recipe, atlas: Atlas, defines: dict[str, int]) -> tuple[Levels, Levels]:
    """Steps 1 to 3: both pyramids, a level a pass. What is in focus is kept out of the background from here on."""
    held = []
    for parity, name in enumerate(("even", "odd")):
        size = atlas.image_size(parity)
        images = (recipe.image(f"{kind} {name} levels", size, linear=True) for kind in ("colour", "ZBN"))
        held.append(Levels(*images))
    surfaces = recipe.frame.pinhole()
    recipe.draw(
        "prepare.frag", held[0], viewport=atlas.viewport(0), pinhole=surfaces.color,
        inverse_depth=surfaces.inverse_depth,
    )  # fmt: skip
    for level in range(1, atlas.levels + 1):
        colors, zbns = held[(level - 1) % 2]
        values = {
            "corner": atlas.corner(level), "source_corner": atlas.corner(level - 1),
            "source_size": level_size(atlas.size, level - 1),
        }  # fmt: skip
        recipe.draw(
            "reduce.frag", held[level % 2], defines=defines, viewport=atlas.viewport(level), values=values,
            colors=colors, zbns=zbns,
        )  # fmt: skip
    return held[0], held[1]


def _level(sigma: float) -> float:
    """The level that has a blur of `sigma`, px, so that no level beyond the next whole one is ever read (eq 6)."""
    return max(1.0 + math.log2(max(2.0 / 3.0 * sigma, 0.5)), 0.0)
