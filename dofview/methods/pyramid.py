"""Depth of field by cutting one pinhole picture into sub-images of like blur, each filled and blurred by pyramids.

Martin Kraus, Magnus Strengert: Depth-of-Field Rendering by Pyramidal Image Processing. Computer Graphics Forum 26(3)
(Eurographics), 2007. What a blurred foreground hides is made up from its surroundings; the lens is Gaussian.
"""

from __future__ import annotations

from enum import StrEnum

from pydantic import Field

from dofview.gl.pull_push import Part, pull_push
from dofview.gl.pyramids import Analysis, blur, most_levels, pyramid
from dofview.gl.targets import Image
from dofview.methods.method import Params as BaseParams
from dofview.methods.method import Recipe
from dofview.methods.pyramid_plan import Matting, SubImage, plan
from dofview.render.frame import Frame
from dofview.render.occupancy import occupancy

TITLE = "Pyramidal image processing"
CITATION = (
    "M. Kraus, M. Strengert. Depth-of-Field Rendering by Pyramidal Image Processing. Computer Graphics Forum 26(3) "
    "(Eurographics), 2007."
)
REQUIRES_GL = 330
GUARD_BAND = True
QUALITIES: tuple[dict[str, object], ...] = (
    {"analysis": "box2"}, {"analysis": "box4", "blur": "paper", "matting": "paper"}, {},
)  # fmt: skip

PAPER_RADIUS = 1.7
SHARP_PX = 1e-5
"""CoC radius up to which the picture is the pinhole's to 1e-5, px: beyond, the first blurred sub-image mixes in."""

CULLED = "methods/pyramid/culled.glsl"
STEPS = (("culled", False, False), ("filled", True, False), ("matte", True, True))
"""What `inspect` keeps before the blur: name, holes filled, weighted."""


class Blur(StrEnum):
    """How the blur of a sub-image is stated."""

    CALIBRATED = "calibrated"
    PAPER = "paper"


class Params(BaseParams):
    """The filters, and the paper's constants beside calibrated ones."""

    analysis: Analysis = Field(
        default=Analysis.SPLINE, description="Filter that makes coarser levels: B-spline, 4×4 box (the paper's) or 2×2."
    )
    blur: Blur = Field(
        default=Blur.CALIBRATED,
        description="Blur of sub-image i: as measured of its filter, or the paper's 1.7·2^(|i|−1).",
        json_schema_extra={"symbol": "r⁽ⁱ⁾"},
    )
    matting: Matting = Field(
        default=Matting.PARTITION,
        description="Weights of a pixel in its sub-images: two that sum to 1, or the paper's three that sum to 2.",
        json_schema_extra={"symbol": "ω"},
    )
    limit: int = Field(
        default=12, ge=1, le=16,
        description="Sub-images on either side of the focus at most; what is blurred more goes into the last.",
        json_schema_extra={"symbol": "i_max"},
    )  # fmt: skip
    skip: bool = Field(default=True, description="Leave out work that cannot change the picture.")
    inspect: bool = Field(default=False, description="Keep every step of every sub-image, to look at.")


def render(frame: Frame, params: Params) -> Image:
    """Return the picture with depth of field, its sub-images blended from front to back."""
    if params.skip and not params.inspect and frame.in_focus(SHARP_PX):
        return frame.pinhole().color
    paper = params.blur is Blur.PAPER
    sigma = frame.lens.radius_as_sigma_fraction if paper else frame.lens.matched_sigma_fraction
    recipe = Recipe(frame, "pyramid", params, sigma=sigma)
    subs = _plan(frame, params, sigma)
    blended: Image | None = None
    for number, sub in enumerate(subs):
        matted = _matted(recipe, params, sub)
        levels = abs(sub.index)
        # The last enlargement, to the size of the picture, is left to the blending.
        blurred = _blurred(recipe, params.analysis, matted, levels) if levels else matted
        if params.inspect:
            image = recipe.image(f"sub-image {sub.index:+d} blurred")
            if levels:
                recipe.draw("pass/expand.frag", image, coarse=blurred)
            else:
                recipe.draw("pass/copy.frag", image, source=blurred)
        defines = {"SCALE": 0.5 if levels else 1.0, params.matting.name: 1}
        defines |= {"FIRST": 1} if blended is None else {}
        defines |= {"LAST": 1} if number == len(subs) - 1 else {}
        in_front = {} if blended is None else {"in_front": blended}
        blended = recipe.image(f"blended {number % 2}")
        recipe.draw("blend.frag", blended, defines=defines, sub_image=blurred, images=in_front)
    frame.gpu.profile.count("pyramid sub-images", len(subs))
    assert blended is not None, "every picture has pixels, so one sub-image has weight"
    return blended


def _plan(frame: Frame, params: Params, sigma: float) -> list[SubImage]:
    """The sub-images to make, front to back, without those in which no pixel has weight."""

    def blur_of(levels: int) -> float:
        if params.blur is Blur.PAPER:
            return PAPER_RADIUS * 2.0 ** (levels - 1) if levels else 0.0
        return params.analysis.blur_sigma(levels)

    front, back = (sigma * coc for coc in frame.coc_range())
    limit = min(params.limit, most_levels(frame.size))
    subs = plan(front, back, sigma * frame.coc.at_infinity, blur_of, limit, params.matting)
    if not params.skip or frame.coc.scale == 0.0 or not frame.gpu.profile.may_skip("pyramid sub-images skipped"):
        return subs
    found = occupancy(frame)

    def depth(blur: float) -> float:
        return float(frame.coc.inverse_depth(blur / sigma))

    needed = [sub for sub in subs if found.between(depth(sub.ramps[0]), depth(sub.ramps[3]))]
    frame.gpu.profile.count("pyramid sub-images skipped", len(subs) - len(needed))
    return needed


def _matted(recipe: Recipe, params: Params, sub: SubImage) -> Image:
    """One sub-image culled, filled and weighted (sections 3.1–3.3), colour times opacity."""
    surfaces, profile, inspect = recipe.frame.pinhole(), recipe.gpu.profile, params.inspect
    images = {"pinhole": surfaces.color, "inverse_depth": surfaces.inverse_depth}
    culling = {"nearest": sub.cull, "soft": sub.soft}
    filled: dict[str, Image] = {}
    if sub.fills or not params.skip or not profile.may_skip("pyramid fills skipped"):
        with profile.section("pyramid/fill"):
            pair = pull_push(
                recipe.gpu, "pyramid/fill", recipe.frame.size, CULLED, parts=[Part(None, images)],
                blocks=recipe.blocks, values=culling,
            )  # fmt: skip
        filled = dict(zip(("coarse_colors", "coarse_extras"), pair, strict=True))
    profile.count("pyramid fills" if filled else "pyramid fills skipped")

    def draw(into: Image, *, fill: bool, weigh: bool) -> None:
        defines = {params.matting.name: 1, **({"FILL": 1} if fill else {}), **({} if weigh else {"WHOLE": 1})}
        values = {**culling, "ramps": sub.ramps}
        recipe.draw(
            "sub_image.frag", into, values=values, defines=defines, images={**images, **(filled if fill else {})}
        )

    for name, fill, weigh in STEPS if inspect else ():
        draw(recipe.image(f"sub-image {sub.index:+d} {name}"), fill=fill and bool(filled), weigh=weigh)
    matted = recipe.image("sub-image", linear=True)
    draw(matted, fill=bool(filled), weigh=True)
    return matted


def _blurred(recipe: Recipe, analysis: Analysis, matted: Image, levels: int) -> Image:
    """The first level of `matted` blurred by `levels` reductions and expansions (section 3.4)."""
    with recipe.gpu.profile.section("pyramid/blur"):
        coarser = pyramid(recipe.gpu, "pyramid/level", recipe.frame.size, levels)
        return blur(recipe.gpu, [matted, *coarser], analysis)
