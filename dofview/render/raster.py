"""Drawing the scene through the lens centre or any point of the lens, into any set of images."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import nullcontext
from dataclasses import dataclass
from itertools import groupby
from operator import itemgetter
from typing import Any, NamedTuple

import moderngl
import numpy as np

from dofview.gl.context import Gpu
from dofview.gl.passes import AnyTexture, Blocks, Color, Textures, bind, block_texts
from dofview.gl.targets import Image
from dofview.render.lights import Lights
from dofview.render.upload import GpuScene
from dofview.scene.camera import Camera

FLAT = 20000.0
"""24 bits of depth over this ratio of far to near separate surfaces a part in a thousand apart out to the far plane.
Beyond it depth is stored by its logarithm, which separates a part in 100,000 everywhere, but keeps the driver from
testing depth before it shades."""
DEEPEST = 1e10


@dataclass(frozen=True)
class Projection:
    """Where the scene is drawn from: `clip_from_local` (4, 4) float64, the eye in local space, near and far plane."""

    clip_from_local: np.ndarray
    eye: np.ndarray
    near_far: tuple[float, float]


def depth_range(scene: GpuScene, camera: Camera) -> tuple[float, float]:
    """Near and far plane fitted to the scene, scene units: as tight as its bounds allow, never a hint's."""
    view = camera.view_matrix(scene.origin)
    low, high = scene.local_bounds
    corners = np.array([[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])])
    depths = -(corners @ view[2, :3] + view[2, 3])
    far = max(float(depths.max()) * 1.0001, camera.distance * 1e-3)
    near = max(float(depths.min()) * 0.9999, far / DEEPEST)
    return near, max(far, near * 1.001)


def projection(
    scene: GpuScene, camera: Camera, size: tuple[int, int], guard: int = 0, *, lens_point: tuple[float, float] = (0, 0),
    focus_distance: float = np.inf, jitter_px: tuple[float, float] = (0, 0),
    near_far: tuple[float, float] | None = None,
) -> Projection:  # fmt: skip
    """Off-axis projection from a point of the lens (Haeberli and Akeley 1990): the plane in focus stays in place.

    `size` is the picture without its `guard` band, pixels; `lens_point` is in scene units right and up of the centre,
    `jitter_px` moves the sample point inside the pixel.
    """
    near, far = near_far or depth_range(scene, camera)
    width, height = size
    p11 = 1.0 / np.tan(np.radians(camera.vfov_deg) / 2.0) * height / (height + 2 * guard)
    p00 = 1.0 / np.tan(np.radians(camera.vfov_deg) / 2.0) * height / (width + 2 * guard)
    right, up = lens_point
    matrix = np.zeros((4, 4))
    # Depth is −z in view space, so what is added per unit of depth stands negated in the z column.
    matrix[0, 0], matrix[0, 2] = p00, -p00 * right / focus_distance + 2.0 * jitter_px[0] / (width + 2 * guard)
    matrix[1, 1], matrix[1, 2] = p11, -p11 * up / focus_distance + 2.0 * jitter_px[1] / (height + 2 * guard)
    matrix[2, 2], matrix[2, 3] = -(far + near) / (far - near), -2.0 * far * near / (far - near)
    matrix[3, 2] = -1.0
    view = camera.view_matrix(scene.origin)
    view[0, 3] -= right
    view[1, 3] -= up
    eye = np.asarray(camera.position) - scene.origin + np.array([right, up, 0.0]) @ camera.axes()
    return Projection(matrix @ view, eye, (near, far))


class Runs(NamedTuple):
    """What to draw: (material, first index, count) each, and how many pieces of the scene are not among it."""

    ranges: list[tuple[int, int, int]]
    culled: int


def in_view(scene: GpuScene, *views: Projection) -> Runs:
    """What of `scene` the views can reach, or any view between them."""
    seen = scene.visible(*(view.clip_from_local for view in views))
    return Runs(scene.runs(seen), len(scene.draws) - len(seen))


def draw_scene(
    gpu: Gpu, scene: GpuScene, view: Projection, into: Sequence[Image], *, lights: Lights,
    background: tuple[float, float, float] = (0.0, 0.0, 0.0), background_alpha: float = 0.0, lod_bias: float = 0.0,
    behind: Image | None = None, reject: str | None = None, geometry: str | None = None,
    textures: Textures | None = None, blocks: Blocks | None = None, values: Mapping[str, object] | None = None,
    defines: Mapping[str, object] | None = None, framebuffer: moderngl.Framebuffer | None = None,
    passed: moderngl.Query | None = None, draws: Runs | None = None, sparse: bool = False,
) -> None:  # fmt: skip
    """Draw the scene's nearest surfaces into `into`: colour, then inverse depth (0 where nothing is).

    `behind`, an image of inverse depths, leaves out what is not farther than it, and everything where it is 0. `reject`
    names the GLSL file of another test that leaves fragments out (shaders/render/scene.frag); `textures`, `blocks` and
    `values` are what it reads. `geometry` names a geometry shader and `framebuffer` its layered target. `passed` counts
    the samples that were drawn. `draws` are what to draw where that is known; else what the view can reach. `sparse`
    says that little of the picture is open to what lies `behind`.

    What is seen through is laid over what it covers, the farthest first (`_blend`). What another test leaves out, a
    layered target, and depths alone have it as it is: there where half opaque.
    """
    target = framebuffer or gpu.targets.framebuffer(into, depth=True)
    plain = geometry is None and reject is None
    _clear(gpu, target, into, (*background, background_alpha))
    if behind is not None:
        _close(gpu, behind)
        reject, textures = "render/reject_peel.glsl", {**(textures or {}), "peeled_inverse_depth": behind}

    def run(
        into: moderngl.Framebuffer, depth_func: str, defines: Mapping[str, object], through: bool = False
    ) -> None:  # fmt: skip
        into.use()
        gpu.ctx.viewport = (0, 0, *size)
        gpu.ctx.enable_only(moderngl.DEPTH_TEST | (moderngl.BLEND if through else 0))
        gpu.ctx.depth_func = depth_func
        _draw_all(
            gpu, scene, view, in_order if through else solid, lights, reject=reject, geometry=geometry,
            textures=textures or {}, blocks=blocks or {}, values={"lod_bias": lod_bias, **(values or {})},
            defines=defines, blended=through,
        )  # fmt: skip

    size, defines, seen = into[0].size, dict(defines or {}), in_view(scene, view) if draws is None else draws
    blends = bool(scene.blended) and plain and not defines.keys() & {"DEPTH_ONLY", "SURFACES"}
    items = scene.materials.items
    solid = Runs([r for r in seen.ranges if not items[r[0]].translucent], seen.culled) if blends else seen
    in_order = Runs(scene.blended.farthest_first(view.clip_from_local) if blends else [], 0)
    gpu.profile.count("pieces culled", seen.culled)
    nearest_first = reject is not None and framebuffer is None and gpu.software and not sparse
    if nearest_first:
        # It goes on shading fragments that it has discarded, and most are. Only a failed depth test stops it; a picture
        # that is mostly closed has that already.
        run(gpu.targets.framebuffer(into[1:2], depth=True), "<", {**defines, "DEPTH_ONLY": 1})
    with passed or nullcontext():
        run(target, "==" if nearest_first else "<", defines)
        if blends:
            _blend(gpu, target, len(into), lambda func, extra: run(target, func, {**defines, **extra}, through=True))


def _blend(
    gpu: Gpu, target: moderngl.Framebuffer, attachments: int, run: Callable[[str, Mapping[str, object]], None]
) -> None:  # fmt: skip
    """Lay what is seen through over `target`, then say where it is: at the nearest point that is half opaque, as long
    as something solid is behind it, and else wherever there is anything of it. `run(depth test, defines)` draws it."""
    gpu.ctx.blend_equation = moderngl.FUNC_ADD  # type: ignore[assignment]
    gpu.ctx.blend_func = moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA
    target.depth_mask = False
    target.color_mask = _masks(attachments, colors=True)
    run("<", {"BLENDED": 1})
    if attachments > 1:
        gpu.ctx.blend_func = moderngl.ONE, moderngl.ZERO
        target.color_mask = _masks(attachments, colors=False)
        target.depth_mask = True
        run("<", {})
        target.depth_mask = False
        run("==", {"AT_INFINITY": 1})
    target.depth_mask = True
    target.color_mask = _masks(attachments)


def _masks(attachments: int, colors: bool | None = None) -> Any:
    """What may be written: the colours alone, all else alone, or everything."""
    first = (colors is not False,) * 3 + (colors is not True,)
    rest = (colors is not True,) * 4
    return first if attachments == 1 else (first, *[rest] * (attachments - 1))


def _draw_all(
    gpu: Gpu, scene: GpuScene, view: Projection, draws: Runs, lights: Lights, *,
    reject: str | None, geometry: str | None, textures: Textures, blocks: Blocks, values: Mapping[str, object],
    defines: Mapping[str, object], blended: bool,
) -> None:  # fmt: skip
    """Draw `draws` of the scene's triangles, or of its `blended` ones, into what is bound."""
    if reject is not None:
        defines = {**defines, "HAS_REJECT": 1, "REJECT": reject}
    bound = by_material(
        gpu, scene, view, draws, lights, geometry=geometry, textures=textures, blocks=blocks, values=values,
        defines=defines, blended=blended,
    )  # fmt: skip
    for array, ranges in bound:
        for first, count in ranges:
            array.render(moderngl.TRIANGLES, vertices=count, first=first)


def by_material(
    gpu: Gpu, scene: GpuScene, view: Projection, draws: Runs, lights: Lights, *, values: Mapping[str, object],
    defines: Mapping[str, object], geometry: str | None = None, textures: Textures | None = None,
    blocks: Blocks | None = None, blended: bool = False,
) -> Iterator[tuple[moderngl.VertexArray, list[tuple[int, int]]]]:  # fmt: skip
    """Bind each material of `draws` in turn, and give what is to be drawn with it: an array, and (first, count) of the
    ranges of its indices."""
    values = {**values, "clip_from_local": _column_major(view.clip_from_local), "eye": tuple(view.eye)}
    near, far = view.near_far
    if far > FLAT * near:
        defines = {**defines, "LOG_DEPTH": 1}
        values["log_depth"] = (float(np.log2(near)), 1.0 / float(np.log2(far / near)))
    stages = ["render/scene.vert", *([geometry] if geometry else []), "render/scene.frag"]
    for number, runs in groupby(draws.ranges, key=itemgetter(0)):
        material = scene.materials.items[number]
        all_blocks = {"Material": material.block, "Lights": lights.block, **(blocks or {})}
        all_defines = {**material.features, **lights.defines, **defines}
        program = gpu.shaders.program(*stages, defines=all_defines, blocks=block_texts(all_blocks))
        _set_culling(gpu.ctx, material.double_sided)
        named: dict[str, AnyTexture] = {name: texture for name, (texture, _) in material.textures.items()}
        if "environment_map" in program.samplers:
            named |= lights.textures
        bind(gpu, program, {**named, **(textures or {})}, all_blocks, values)
        samplers = list(enumerate(sampler for _, sampler in material.textures.values()))
        for unit, sampler in samplers:
            sampler.use(unit)
        ranges = [(first, count) for _, first, count in runs]
        yield scene.array(program.gl, blended), ranges
        for unit, sampler in samplers:
            sampler.clear(unit)
        gpu.profile.count("draws", len(ranges))
        gpu.profile.count("triangles", sum(count for _, count in ranges) // 3)
    gpu.profile.count("geometry passes")


def _clear(gpu: Gpu, target: moderngl.Framebuffer, into: Sequence[Image], background: Color) -> None:
    """Begin a picture over `background`, RGBA, with nothing in it; `target` is left in use."""
    target.use()
    gpu.ctx.viewport = (0, 0, *into[0].size)
    # One clear gives all attachments the same colour, so the background follows on the colour image alone.
    target.clear(0.0, 0.0, 0.0, 0.0, depth=1.0)
    if any(background):
        gpu.targets.framebuffer(into[:1]).clear(color=background)
        target.use()
        gpu.ctx.viewport = (0, 0, *into[0].size)


def _close(gpu: Gpu, behind: Image) -> None:
    """Set the depth in use to the nearest where `behind` is 0: the depth test then leaves out what the shader would
    have to reject, which is most of it (half the time of a pass where 4 % of the picture is open)."""
    program = gpu.shaders.program("pass/fullscreen.vert", "render/close.frag")
    bind(gpu, program, {"behind": behind}, {}, {})
    gpu.ctx.enable_only(moderngl.DEPTH_TEST)
    gpu.ctx.depth_func = "1"
    if 0 not in program.arrays:
        program.arrays[0] = gpu.ctx.vertex_array(program.gl, [])
    program.arrays[0].render(moderngl.TRIANGLES, vertices=3)


def _set_culling(ctx: moderngl.Context, double_sided: bool) -> None:
    if double_sided:
        ctx.disable(moderngl.CULL_FACE)
    else:
        ctx.enable(moderngl.CULL_FACE)
        ctx.cull_face = "back"


def _column_major(matrix: np.ndarray) -> bytes:
    return np.ascontiguousarray(matrix.T, dtype=np.float32).tobytes()
