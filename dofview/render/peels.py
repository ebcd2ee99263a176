"""Surfaces behind those already peeled, found by the depth test alone: how a software rasteriser peels.

Depth peeling (Everitt 2001) rejects in the shader what is not behind the former surface. A software rasteriser goes on
shading what it rejects, so here the shader has nothing to reject: with the depth test turned round only what lies
behind the former surface passes, blending keeps the nearest of it, and a second pass shades where it is. What the first
pass drew without a single sample behind the former surface is not in this peel nor in any later one, and is left out.
"""

from __future__ import annotations

from collections.abc import Sequence

import moderngl

from dofview.gl.context import Gpu
from dofview.gl.passes import bind
from dofview.gl.targets import Image
from dofview.render.lights import Lights
from dofview.render.raster import Projection, Runs, by_material
from dofview.render.upload import PIECE_TRIANGLES, GpuScene

MOST_PARTS = 512
"""The scene is asked for in at most about that many parts; larger scenes in larger ones."""

DEPTH = "surfaces"
"""The depth buffer that surfaces to be peeled are drawn with, and the peels are found with."""

NOWHERE = (0.0, -1.0, 0.0, 0.0)
"""Nothing found: inverse depth 0 and, negated, the depth of the far plane."""


def find_behind(
    gpu: Gpu, scene: GpuScene, view: Projection, found: Image, *, lights: Lights, draws: Runs
) -> Runs:  # fmt: skip
    """Draw into `found` the nearest surfaces behind those in the depth buffer, which is left as it is: inverse depth,
    and the depth tested, negated. Returns those of `draws` that have anything behind it at all."""
    target = gpu.targets.framebuffer((found,), depth=DEPTH)
    target.depth_mask = False
    gpu.targets.framebuffer((found,)).clear(color=NOWHERE)
    _begin(gpu, target, ">", moderngl.DEPTH_TEST | moderngl.BLEND)
    gpu.ctx.blend_func = (moderngl.ONE, moderngl.ONE)
    gpu.ctx.blend_equation = moderngl.MAX  # type: ignore[assignment]
    size = max(3 * PIECE_TRIANGLES, sum(count for _, _, count in draws.ranges) // MOST_PARTS // 3 * 3)
    parts = [part for run in draws.ranges for part in _parts(run, size)]
    queries = gpu.queries(len(parts))
    asked = iter(queries)
    defines = {"DEPTH_ONLY": 1, "WINDOW_DEPTH": 1}
    cut = Runs(parts, draws.culled)
    for array, ranges in by_material(gpu, scene, view, cut, lights, values={"lod_bias": 0.0}, defines=defines):
        for first, count in ranges:
            with next(asked):
                array.render(moderngl.TRIANGLES, vertices=count, first=first)
    target.depth_mask = True
    kept = [part for part, query in zip(parts, queries, strict=True) if query.samples]
    if gpu.profile.may_skip("peel parts skipped"):
        gpu.profile.count("peel parts skipped", len(parts) - len(kept))
    return Runs(_joined(kept), draws.culled)


def settle(gpu: Gpu, found: Image, inverse_depth: Image) -> None:
    """Make what was `found` the depths of the peel, and the depth buffer that of it."""
    program = gpu.shaders.program("pass/fullscreen.vert", "render/peeled.frag")
    _begin(gpu, gpu.targets.framebuffer((inverse_depth,), depth=DEPTH), "1", moderngl.DEPTH_TEST)
    bind(gpu, program, {"found": found}, {}, {})
    if 0 not in program.arrays:
        program.arrays[0] = gpu.ctx.vertex_array(program.gl, [])
    program.arrays[0].render(moderngl.TRIANGLES, vertices=3)
    gpu.profile.count("passes")
    gpu.profile.count("fragments", found.size[0] * found.size[1])


def shade(gpu: Gpu, scene: GpuScene, view: Projection, color: Image, *, lights: Lights, draws: Runs) -> None:
    """Draw into `color` the surfaces whose depths are in the depth buffer; alpha 0 where there are none."""
    target = gpu.targets.framebuffer((color,), depth=DEPTH)
    gpu.targets.framebuffer((color,)).clear(0.0, 0.0, 0.0, 0.0)
    _begin(gpu, target, "==", moderngl.DEPTH_TEST)
    for array, ranges in by_material(gpu, scene, view, draws, lights, values={"lod_bias": 0.0}, defines={}):
        for first, count in ranges:
            array.render(moderngl.TRIANGLES, vertices=count, first=first)


def _begin(gpu: Gpu, target: moderngl.Framebuffer, depth_func: str, enable: int) -> None:
    target.use()
    gpu.ctx.viewport = (0, 0, *target.size)
    gpu.ctx.enable_only(enable)
    gpu.ctx.depth_func = depth_func


def _parts(run: tuple[int, int, int], size: int) -> list[tuple[int, int, int]]:
    """`run`, a material and a range of indices, cut into ranges of at most `size`."""
    material, first, count = run
    return [(material, first + start, min(size, count - start)) for start in range(0, count, size)]


def _joined(parts: Sequence[tuple[int, int, int]]) -> list[tuple[int, int, int]]:
    """Parts that follow one another with the same material as one."""
    found: list[tuple[int, int, int]] = []
    for material, first, count in parts:
        if found and found[-1][0] == material and found[-1][1] + found[-1][2] == first:
            found[-1] = material, found[-1][1], found[-1][2] + count
        else:
            found.append((material, first, count))
    return found
