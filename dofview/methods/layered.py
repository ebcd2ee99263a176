"""Layers from depth peeling, matted softly, blurred recursively and blended.

David C. Schedl, Michael Wimmer: A layered depth-of-field method for solving partial occlusion. Journal of WSCG 20(3),
2012; also: Simulating partial occlusion in post-processing depth-of-field methods, GPU Pro 4, 2013.

Peeling gives what lies behind the visible surfaces; slicing all of it by blur gives layers that are each blurred by one
Gaussian; blending them back to front shows the background through blurred edges. The blur is recursive: a layer joins a
buffer, the buffer is blurred a little, the next layer joins. The outermost layer is so blurred by every filter, at the
cost of a small one per layer, and neighbouring layers hardly come apart at their seams.
"""

from __future__ import annotations

from collections.abc import Sequence
from enum import StrEnum

from pydantic import Field

from dofview.gl.gaussian import blur_axis
from dofview.gl.passes import OVER, UNDER
from dofview.gl.pyramids import expand, level_size
from dofview.gl.targets import Image
from dofview.methods.layered_plan import Layer, Plan, cascade, plan, recursive, spaced, step_for
from dofview.methods.method import Params as BaseParams
from dofview.methods.method import Recipe
from dofview.render.frame import Frame, Surfaces

TITLE = "Layered depth of field by depth peeling"
CITATION = (
    "D. C. Schedl, M. Wimmer. A layered depth-of-field method for solving partial occlusion. J. WSCG 20(3), 2012."
)
REQUIRES_GL = 330
GUARD_BAND = True

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
        default=1.0, ge=1.0, le=2.0,
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
        default=4.0, ge=0.0, le=64.0,
        description="Blur at half size from this σ on, at a quarter from twice it, and so on; 0: always at full size.",
        json_schema_extra={"unit": "px"},
    )  # fmt: skip
    keep: bool = Field(default=False, description="Keep every layer and every step's buffer as an image to look at.")


def render(frame: Frame, params: Params) -> Image:
    """Return the picture of `frame` through its lens."""
    recipe = Recipe(frame, "layered", params)
    peels = [surfaces for surfaces in (frame.peel(m) for m in range(params.peels)) if surfaces is not None]
    frame.gpu.profile.count("layered peels", len(peels))
    known = len(peels) < params.peels
    start = (*frame.background, 1.0) if known else (0.0, 0.0, 0.0, 0.0)
    slices = layout(frame, params)
    frame.gpu.profile.count("layered layers", len(slices))
    work = Work(recipe, params, peels, start)
    buffers = {}
    if slices.front:
        buffers["front"] = work.buffer("front", slices.front)
    if slices.back:
        buffers["back"] = work.buffer("back", slices.back)
    return work.final(slices.focus, buffers)


def layout(frame: Frame, params: Params) -> Plan:
    """The layers that the CoC range of `frame` calls for."""
    nearest, farthest = frame.coc_range()
    widest = float(max(frame.size))
    near, far = min(max(-nearest, 0.0), widest), min(max(farthest, 0.0), widest)
    least = params.coarse_sigma
    between = params.matting == Matting.PAPER
    if params.constants == Constants.PAPER:
        return plan(frame.coc, recursive(near), recursive(far), sigma=PAPER_SIGMA, between=between, least_sigma=least)
    step = step_for(params.layers, near, far, params.power) if params.layers else params.step
    radii = spaced(near, step, params.power), spaced(far, step, params.power)
    return plan(frame.coc, *radii, sigma=frame.lens_block.sigma, between=between, least_sigma=least)


class Work:
    """The passes of one picture."""

    def __init__(self, recipe: Recipe, params: Params, peels: Sequence[Surfaces], start: tuple[float, ...]):
        self.recipe = recipe
        self.params = params
        self.start = start
        self.defines: dict[str, object] = {"PEELS": len(peels)}
        if params.matting == Matting.PAPER:
            self.defines["PAPER"] = 1
        self.textures = {f"color{m}": surfaces.color for m, surfaces in enumerate(peels)} | self._depths(peels)

    def buffer(self, side: str, layers: Sequence[Layer]) -> Image:
        """All layers of one side, nearest to the focus last, blurred and blended at full size."""
        return self._cascaded(side, layers) if self.params.cascaded else self._separate(side, layers)

    def final(self, focus: Layer, buffers: dict[str, Image]) -> Image:
        """Front over focus over back, normalised."""
        picture = self.recipe.image("picture")
        defines = {f"HAS_{side.upper()}": 1 for side in buffers}
        self._draw("final.frag", picture, focus, defines=defines, start=self.start, **buffers)
        return picture

    def _cascaded(self, side: str, layers: Sequence[Layer]) -> Image:
        """A layer joins, the buffer is blurred, the next one joins (GPU Pro 4, p. 204)."""
        buffer: Image | None = None
        level = layers[0].level
        for number, (layer, sigma) in enumerate(zip(layers, cascade(layers), strict=True)):
            buffer = self._expand(side, buffer, level, layer.level + 1)
            joined = self._image(side, "joined", layer.level, number)
            defines = {"CASCADE": 1, "EXPAND": int(level > layer.level)} if buffer else {}
            start = (0.0,) * 4 if side == "front" else self.start
            self._join(side, joined, layer, defines, start, **({"buffered": buffer} if buffer else {}))
            buffer, level = self._blur(side, joined, layer.level, sigma, number), layer.level
        return self._expand(side, buffer, level, 0)

    def _separate(self, side: str, layers: Sequence[Layer]) -> Image:
        """Each layer is blurred by itself with the whole of its σ, then all are blended."""
        total = self.recipe.image(f"{side} sum")
        self.recipe.gpu.targets.framebuffer((total,)).clear(*((0.0,) * 4 if side == "front" else self.start))
        for number, layer in enumerate(layers):
            alone = self._image(side, "layer", layer.level, number)
            self._join(side, alone, layer, {}, (0.0,) * 4)
            blurred = self._blur(side, alone, layer.level, cascade([layer])[0], number)
            blurred = self._expand(side, blurred, layer.level, 0)
            self.recipe.draw("pass/copy.frag", total, source=blurred, blend=UNDER if side == "front" else OVER)
        return total

    def _join(
        self, side: str, into: Image, layer: Layer, defines: dict[str, object], start: tuple[float, ...],
        **textures: Image,
    ) -> None:  # fmt: skip
        if side == "front" and self.params.cascaded:
            defines = defines | {"FRONT": 1}
        self._draw("join.frag", into, layer, defines=defines | {"LEVEL": 2**layer.level}, start=start, **textures)

    def _blur(self, side: str, source: Image, level: int, sigma: float, number: int) -> Image:
        """One filter of the recursion; `sigma` in texels of the level."""
        if sigma <= 0.0:
            return source
        across = self.recipe.image(f"level {level} across", source.size)
        blurred = self._image(side, "blurred", level, number)
        with self.recipe.gpu.profile.section("layered/blur"):
            blur_axis(self.recipe.gpu, source, across, sigma, (1, 0))
            blur_axis(self.recipe.gpu, across, blurred, sigma, (0, 1))
        return blurred

    def _expand(self, side: str, buffer: Image | None, level: int, to: int) -> Image | None:
        """Bring `buffer` from `level` to the finer level `to`, one doubling at a time."""
        while buffer is not None and level > to:
            level -= 1
            finer = self.recipe.image(
                f"{side} level {level} expanded", level_size(self.recipe.frame.size, level), linear=True
            )
            expand(self.recipe.gpu, buffer, finer)
            buffer = finer
        return buffer

    def _draw(
        self, shader: str, into: Image, layer: Layer, *, defines: dict[str, object], start: tuple[float, ...],
        **textures: Image,
    ) -> None:  # fmt: skip
        values = {"anchors": layer.anchors, "background": self.recipe.frame.background, "start": start}
        self.recipe.draw(shader, into, values=values, defines=self.defines | defines, **self.textures, **textures)

    def _image(self, side: str, what: str, level: int, number: int) -> Image:
        """A buffer of one side and level; with `keep`, one of its own for every layer."""
        name = f"{side} {number:02d} {what}" if self.params.keep else f"{side} level {level} {what}"
        return self.recipe.image(name, level_size(self.recipe.frame.size, level), linear=True)

    def _depths(self, peels: Sequence[Surfaces]) -> dict[str, Image]:
        names = ["depths_first", "depths_last"][: 1 + (len(peels) > 4)]
        images = {name: self.recipe.image(name) for name in names}
        last = peels[-1].inverse_depth
        sources = {f"depth{m}": peels[m].inverse_depth if m < len(peels) else last for m in range(4 * len(names))}
        self.recipe.draw("depths.frag", list(images.values()), defines={"PEELS": len(peels)}, **sources)
        return images
