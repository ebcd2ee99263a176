"""The contract of a depth-of-field method, and the recipe it writes its passes in.

A method is a module with a title, a citation, a `Params` model and `render(frame, params) -> Image`: from the images a
frame offers to one linear image of the frame's canvas size. Slider, flag, preset key, GLSL block and docs row all come
from the fields of `Params`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Protocol

from moderngl import Query, Sampler
from pydantic import BaseModel, ConfigDict

from dofview.gl.passes import Color, Textures, draw
from dofview.gl.targets import Image
from dofview.gl.tiles import Tiles
from dofview.render.frame import Frame


class Params(BaseModel):
    """Base of every method's parameters: frozen, unknown names refused, each field with default, range and words.

    A field says its unit and the paper's symbol in `json_schema_extra={"unit": "px", "symbol": "δ"}`.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


class Method(Protocol):
    """What a module in `dofview.methods` offers."""

    TITLE: str
    CITATION: str
    REQUIRES_GL: int
    """Lowest OpenGL version code, 330 or more."""
    GUARD_BAND: bool
    """Whether what lies just outside the picture must be on the canvas to blur in."""
    Params: type[Params]

    # Optional: QUALITIES, tuples of parameters from cheap to good, by which the benchmark measures the method.

    def render(self, frame: Frame, params: Any) -> Image: ...


class Recipe:
    """Passes of one method over one frame: shaders from its own folder, images under its own name.

    The blocks Lens (`include/lens.glsl`) and Params are there for every shader that includes them. `sigma` is the
    Gaussian's σ over the CoC radius where a method takes another than the one that matches the lens.
    """

    def __init__(self, frame: Frame, name: str, params: Params, sigma: float | None = None):
        self.frame = frame
        self.gpu = frame.gpu
        self.name = name
        lens = frame.lens_block if sigma is None else frame.lens_block.model_copy(update={"sigma": sigma})
        self.blocks: dict[str, BaseModel] = {"Lens": lens, "Params": params}

    def image(
        self, name: str, size: tuple[int, int] | None = None, components: int = 4, dtype: str = "f4",
        linear: bool = False, layers: int = 0,
    ) -> Image:  # fmt: skip
        """Return the method's image `name`, of the canvas size when none is given."""
        return self.gpu.targets.image(f"{self.name}/{name}", size or self.frame.size, components, dtype, layers, linear)

    def draw(
        self, shader: str, into: Image | Sequence[Image], *, values: Mapping[str, object] | None = None,
        defines: Mapping[str, object] | None = None, blocks: Mapping[str, BaseModel] | None = None,
        blend: tuple | None = None, clear: bool | Color = False,
        viewport: tuple[int, int, int, int] | None = None, within: Tiles | None = None, sprites: int | None = None,
        when: Query | None = None, samplers: Mapping[str, Sampler] | None = None, images: Textures | None = None,
        **textures: Image,
    ) -> None:  # fmt: skip
        """Run `shader` of the method's folder (or of shaders/ when it has a folder of its own) into `into`. It reads
        `textures`, and `images` where their names are not known beforehand. `sprites` many are placed by the vertex
        shader of the same name; the rest is as in `gl.passes.draw`."""
        path = shader if "/" in shader else f"methods/{self.name}/{shader}"
        vertex = "pass/fullscreen.vert" if sprites is None else path.removesuffix(".frag") + ".vert"
        with self.gpu.profile.section(f"{self.name}/{path.rsplit('/', 1)[-1].removesuffix('.frag')}"):
            draw(
                self.gpu, path, into, textures={**textures, **(images or {})},
                blocks={**self.blocks, **(blocks or {})}, values=values, defines=defines, blend=blend, clear=clear,
                viewport=viewport, within=within, vertex=vertex, sprites=sprites, when=when,
                samplers=samplers,
            )  # fmt: skip
