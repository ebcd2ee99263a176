"""Layers from depth peeling, matted softly, blurred recursively and blended.

David C. Schedl, Michael Wimmer: A layered depth-of-field method for solving partial occlusion. Journal of WSCG 20(3),
2012; also: Simulating partial occlusion in post-processing depth-of-field methods, GPU Pro 4, 2013.

Peeling gives what lies behind the visible surfaces; slicing all of it by blur gives layers that are each blurred by one
Gaussian; blending them back to front shows the background through blurred edges. The blur is recursive: a layer joins a
buffer, the buffer is blurred a little, the next layer joins. The outermost layer is so blurred by every filter, at the
cost of a small one per layer, and neighbouring layers hardly come apart at their seams.
"""

from __future__ import annotations

from enum import StrEnum

from pydantic import Field

from dofview.gl.targets import Image
from dofview.methods.layered_final import final
from dofview.methods.layered_peels import Peels
from dofview.methods.layered_plan import LEAST_RADIUS, Plan, plan, recursive, spaced, step_for
from dofview.methods.layered_side import Side
from dofview.methods.method import Params as BaseParams
from dofview.methods.method import Recipe
from dofview.render.frame import Frame

TITLE = "Layered depth of field by depth peeling"
CITATION = (
    "D. C. Schedl, M. Wimmer. A layered depth-of-field method for solving partial occlusion. J. WSCG 20(3), 2012."
)
REQUIRES_GL = 330
GUARD_BAND = True
QUALITIES: tuple[dict[str, object], ...] = (
    {"step": 4.0, "peels": 1}, {"step": 2.0}, {}, {"step": 0.5, "peels": 3},
)  # fmt: skip

PAPER_SIGMA = 0.5
"""The paper's σ = d/4 (eq 10), as a fraction of the CoC radius."""


class Constants(StrEnum):
    MATCHED = "matched"
    PAPER = "paper"


class Matting(StrEnum):
    SHARED = "shared"
    PAPER = "paper"


class Params(BaseParams):
    """Depth peels, layers and their blur."""

    peels: int = Field(
        default=2, ge=1, le=8, description="Surfaces kept behind one another in a pixel, at most.",
        json_schema_extra={"symbol": "M"},
    )  # fmt: skip
    step: float = Field(
        default=1.0, ge=0.25, le=8.0, description="CoC radius of the layers next to the focus, px.",
        json_schema_extra={"unit": "px"},
    )  # fmt: skip
    power: float = Field(
        default=1.5, ge=1.0, le=2.0,
        description="The j-th layer from the focus has CoC radius step · j^power: above 1, fewer layers.",
    )  # fmt: skip
    layers: int = Field(
        default=0, ge=0, le=128, description="Layers in all, over the CoC range; 0: as many as the step asks for.",
        json_schema_extra={"symbol": "K"},
    )  # fmt: skip
    cascaded: bool = Field(default=True, description="Blur recursively; otherwise each layer by itself.")
    matting: Matting = Field(
        default=Matting.SHARED,
        description="shared: silhouettes keep their blur between two layers; paper: ω and ω̇ as printed.",
    )
    constants: Constants = Field(
        default=Constants.MATCHED,
        description="matched: σ measured for the lens, layers by step; paper: σ_k = |k|, d = 4σ.",
    )
    coarse_sigma: float = Field(
        default=2.5, ge=0.0, le=64.0,
        description="Blur at half size from this σ on, at a quarter from twice it; 0: always at full size.",
        json_schema_extra={"unit": "px"},
    )  # fmt: skip
    fill: bool = Field(
        default=True, description="Fill what no peel knows from the surfaces around it; otherwise divide by coverage."
    )
    skip: bool = Field(default=True, description="Leave out work that cannot change the picture.")
    inspect: bool = Field(default=False, description="Keep every layer and every step's buffer as an image to look at.")


def render(frame: Frame, params: Params) -> Image:
    """Return the picture of `frame` through its lens."""
    count = frame.gpu.profile.count
    if params.skip and not params.inspect and frame.in_focus(0.99 * LEAST_RADIUS):
        return frame.pinhole().color
    recipe = Recipe(frame, "layered", params)

    # What is visible, and what is behind it, until a peel finds nothing: then there is nothing unknown.
    found = [frame.peel(index) for index in range(params.peels)]
    peels = [surfaces for surfaces in found if surfaces is not None]
    exhausted = len(peels) < params.peels or frame.peel_is_empty(len(peels) - 1)
    count("layered peels", len(peels))
    count("layered peels skipped", params.peels - len(peels))

    known = Peels(recipe, peels, exhausted, paper=params.matting == Matting.PAPER)

    # Slices by blur; those without content are left out, and their blur is added to the next one's.
    slices = layout(frame, params)
    may_skip = frame.gpu.profile.may_skip
    filled = known.content.filled(slices) if may_skip("layered layers empty") else slices
    count("layered layers", len(filled))
    count("layered layers empty", len(slices) - len(filled))

    # Blurred and blended, farthest from the focus first, then put together.
    buffers, skip = {}, params.skip and may_skip("layered tiles skipped")
    for name, layers in (("front", filled.front), ("back", filled.back)):
        if layers:
            side = Side(known, name, layers, skip=skip, inspect=params.inspect)
            buffers[name] = side.cascaded() if params.cascaded else side.separate()
    return final(known, filled.focus, buffers, fill=params.fill and not known.complete, skip=skip)


def layout(frame: Frame, params: Params) -> Plan:
    """The layers that the CoC range of the surfaces in `frame` calls for."""
    # Up to the farthest surface: the background behind it has one colour, which no blur changes.
    depths, widest = frame.depth_range(), float(max(frame.size))
    near, far = (
        min(max(sign * float(frame.coc.radius_px(depth)), 0.0), widest)
        for sign, depth in ((-1.0, depths.nearest), (1.0, depths.farthest_surface))
    )
    sigma = frame.lens_block.sigma
    if params.constants == Constants.PAPER:
        sigma, front, back = PAPER_SIGMA, recursive(near), recursive(far)
    else:
        step = step_for(params.layers, near, far, params.power) if params.layers else params.step
        front, back = spaced(near, step, params.power), spaced(far, step, params.power)
    between = params.matting == Matting.PAPER
    return plan(frame.coc, front, back, sigma=sigma, between=between, least_sigma=params.coarse_sigma)
