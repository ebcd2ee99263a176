"""Full-screen passes: a shader, the images it writes, the images it reads; state is set anew for each."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import nullcontext

import moderngl
from pydantic import BaseModel

from dofview.gl.context import Gpu
from dofview.gl.shaders import Defines, Program
from dofview.gl.targets import Image
from dofview.gl.tiles import Tiles
from dofview.gl.uniforms import block_bytes, block_glsl

ADD = (moderngl.ONE, moderngl.ONE)
OVER = (moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA)
UNDER = (moderngl.ONE_MINUS_DST_ALPHA, moderngl.ONE)

Color = tuple[float, float, float, float]
Blocks = Mapping[str, BaseModel]
AnyTexture = Image | moderngl.Texture | moderngl.TextureArray
Textures = Mapping[str, AnyTexture]


def bind(gpu: Gpu, program: Program, textures: Textures, blocks: Blocks, values: Mapping[str, object]) -> None:
    """Bind what a program reads. A name its source does not declare is a bug; one the compiler removed is not."""
    for unit, (name, image) in enumerate(textures.items()):
        if name not in program.samplers:
            raise KeyError(f"no sampler {name!r}; the shader declares {sorted(program.samplers)}")
        texture = image.texture if isinstance(image, Image) else image
        texture.use(unit)
        if name in program.members:
            program.members[name].value = unit
    missing = {name for name in program.samplers - textures.keys() if name in program.members}
    if missing:
        raise KeyError(f"samplers without an image: {sorted(missing)}")
    for name, value in values.items():
        if name not in program.values:
            raise KeyError(f"no uniform {name!r}; the shader declares {sorted(program.values)}")
        if name not in program.members:
            continue
        if isinstance(value, bytes):
            program.members[name].write(value)
        else:
            program.members[name].value = value
    for binding, (name, block) in enumerate(blocks.items()):
        if name in program.members:
            program.members[name].binding = binding
            gpu.block(block_bytes(block)).bind_to_uniform_block(binding)


def block_texts(blocks: Blocks) -> dict[str, str]:
    """GLSL of each block, for `#include <Name>`."""
    return {name: block_glsl(type(block), name) for name, block in blocks.items()}


def draw(
    gpu: Gpu, shader: str, into: Image | Sequence[Image], *, textures: Textures | None = None,
    blocks: Blocks | None = None, values: Mapping[str, object] | None = None, defines: Defines | None = None,
    blend: tuple | None = None, clear: bool | Color = False,
    viewport: tuple[int, int, int, int] | None = None, within: Tiles | None = None,
    vertex: str = "pass/fullscreen.vert", geometry: str | None = None, sprites: int | None = None,
    when: moderngl.Query | None = None, samplers: Mapping[str, moderngl.Sampler] | None = None,
) -> None:  # fmt: skip
    """Run the fragment shader `shader` over every pixel of `into` (one image, or several of one size), or over the
    part of them that `viewport` (left, bottom, width, height) or `within` name; `clear`, to 0 or to a colour, is of the
    whole.

    `geometry` names a geometry shader that chooses the layer when `into` are arrays (pass/to_layer.geom). `sprites`
    draws that many pairs of triangles instead, six corners each, which the shader `vertex` places by gl_VertexID
    (instances of four corners cost several times as much). `when` leaves it to the GPU not to draw if that query
    passed no sample. `samplers` are for textures that are not to be fetched by their images' own filter.
    """
    images = (into,) if isinstance(into, Image) else tuple(into)
    blocks = blocks or {}
    width, height = viewport[2:] if viewport else images[0].size
    vertices, fragments = 3, width * height
    if within is not None:
        vertex, vertices, fragments = "pass/tiles.vert", 6 * within.count, within.area >> 2 * within.level
        extent = width << within.level, height << within.level
        textures = {**(textures or {}), "tile_list": within.image}
        values = {**(values or {}), "tile_row": within.row, "tile_extent": extent}
    elif sprites is not None:
        vertices = 6 * sprites
    stages = (vertex, geometry, shader) if geometry else (vertex, shader)
    program = gpu.shaders.program(*stages, defines=defines, blocks=block_texts(blocks))
    framebuffer = gpu.targets.framebuffer(images)
    framebuffer.use()
    ctx = gpu.ctx
    ctx.viewport = viewport or (0, 0, *images[0].size)
    ctx.enable_only(moderngl.BLEND if blend else moderngl.NOTHING)
    if blend:
        ctx.blend_func = blend
        ctx.blend_equation = moderngl.FUNC_ADD  # type: ignore[assignment]
    if clear:
        framebuffer.clear(color=clear if isinstance(clear, tuple) else (0.0, 0.0, 0.0, 0.0))
    if vertices == 0:
        return
    bind(gpu, program, textures or {}, blocks, values or {})
    used = [(unit, samplers[name]) for unit, name in enumerate(textures or {}) if name in samplers] if samplers else []
    for unit, sampler in used:
        sampler.use(unit)
    if 0 not in program.arrays:
        program.arrays[0] = ctx.vertex_array(program.gl, [])
    with (when and when.crender) or nullcontext():
        program.arrays[0].render(moderngl.TRIANGLES, vertices=vertices)
    for unit, sampler in used:
        sampler.clear(unit)
    gpu.profile.count("passes")
    gpu.profile.count("sprites" if sprites else "fragments", sprites or fragments)
    gpu.profile.count("blended fragments", fragments if blend and not sprites else 0)
