"""Every pixel is splatted as its circle of confusion onto three layers of each pixel that it reaches.

Sungkil Lee, Gerard Jounghyun Kim, Seungmoon Choi: Real-Time Depth-of-Field Rendering Using Point Splatting on Per-Pixel
Layers. Computer Graphics Forum 27(7), Pacific Graphics 2008.
"""

from __future__ import annotations

from enum import StrEnum

from pydantic import Field

from dofview.gl.targets import Image
from dofview.methods.method import Params as BaseParams
from dofview.methods.method import Recipe
from dofview.render.frame import Frame, Surfaces
from dofview.render.raster import depth_range, draw_scene

TITLE = "Point splatting on per-pixel layers"
CITATION = (
    "S. Lee, G. J. Kim, S. Choi. Real-Time Depth-of-Field Rendering Using Point Splatting on Per-Pixel Layers. "
    "Computer Graphics Forum 27(7), 2008."
)
REQUIRES_GL = 330
GUARD_BAND = True

TILE = 16
MOST_RADIUS = 256.0
K_N_STEPS, K_N_COUNT = 16, 256
POINTS = {"MOST_RADIUS": MOST_RADIUS, "K_N_STEPS": float(K_N_STEPS), "K_N_COUNT": K_N_COUNT, "TILE": TILE}


class HiddenTest(StrEnum):
    """In what the tests for the hidden image measure depth."""

    COC = "coc"
    DEPTH = "depth"


class Params(BaseParams):
    """δ, the tests of the hidden image, highlights, and what may be skipped.

    The paper's own: delta=0.4, hidden_test=depth, epsilon=0.05, edge_depth=0.01, fill=False.
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
    skip: bool = Field(default=True, description="Leave out work that cannot change the picture.")
    debug: bool = Field(default=False, description="Also keep the three layers as images.")


def render(frame: Frame, params: Params) -> Image:
    """Return the picture on the canvas; the guard band itself is not blurred."""
    recipe = Recipe(frame, "splatting", params)
    hidden = _hidden_image(recipe, params)
    near, far = frame.coc_range()
    widest = min(max(-near, far, frame.coc.at_infinity if hidden else 0.0), MOST_RADIUS)
    flags = {**POINTS, "SKIP": params.skip, **({"HIDDEN": 1} if hidden else {})}

    visible_points, hidden_points = recipe.image("points"), recipe.image("hidden points")
    surfaces = frame.pinhole()
    textures = {"color": surfaces.color, "inverse_depth": surfaces.inverse_depth, "k_n": _k_n(recipe, flags)}
    if hidden:
        textures |= {
            "hidden_color": hidden.color, "hidden_inverse_depth": hidden.inverse_depth,
            "hidden_limit": recipe.image("hidden limit", components=1),
        }  # fmt: skip
    recipe.draw(
        "points.frag", (visible_points, hidden_points), defines=flags, **textures,
        values={"background": frame.background} if hidden else {},
    )  # fmt: skip
    points = {"visible_points": visible_points, "hidden_points": hidden_points}

    # One map at a sixteenth of the size bounds every pixel's search.
    tiles = (-(-frame.size[0] // TILE), -(-frame.size[1] // TILE))
    largest, reach = recipe.image("largest", tiles), recipe.image("reach", tiles)
    recipe.draw("tiles.frag", largest, defines=flags, **points)
    recipe.draw("reach.frag", reach, defines=flags, largest=largest, values={"farthest": int(widest) // TILE + 1})

    picture = recipe.image("picture")
    layers = [recipe.image(f"L{i}") for i in range(3)] if params.debug else []
    if params.debug:
        flags["DEBUG"] = 1
    recipe.draw("gather.frag", [picture, *layers], defines=flags, reach=reach, values={"guard": frame.guard}, **points)
    return picture


def _hidden_image(recipe: Recipe, params: Params) -> Surfaces | None:
    """The nearest surfaces that pass the three tests of section 3.2; None when nothing is in front of the focus."""
    frame = recipe.frame
    if not params.hidden:
        return None
    if params.skip and frame.coc_range()[0] > -0.5:
        recipe.gpu.profile.count("splatting hidden passes skipped")
        return None
    surfaces = frame.pinhole()
    limit = recipe.image("hidden limit", components=1)
    recipe.draw(
        "hidden_limit.frag", limit, inverse_depth=surfaces.inverse_depth,
        values={"depth_range": depth_range(frame.scene, frame.camera)},
    )  # fmt: skip
    hidden = Surfaces(recipe.image("hidden"), recipe.image("hidden inverse depth", components=1))
    with recipe.gpu.profile.section("splatting/hidden"):
        # Behind the limit is the same question that depth peeling asks of the surface before.
        draw_scene(
            recipe.gpu, frame.scene, frame.projection(), hidden, lights=frame.lights,
            reject="render/reject_peel.glsl", textures={"peeled_inverse_depth": limit},
        )  # fmt: skip
    return hidden


def _k_n(recipe: Recipe, flags: dict[str, object]) -> Image:
    table = recipe.image("k_n", (K_N_COUNT, 1), components=1)
    if not recipe.frame.cache.holds("disc", table):
        recipe.draw("k_n.frag", table, defines=flags)
    return table
