"""The layered picture that multiview synthesis traces rays in: the scene cut into slabs of equal CoC growth.

CoC is affine in 1/z, so slabs of equal CoC growth are slabs of equal steps of 1/z, whatever the lens: moving focus or
aperture draws no triangle.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from enum import StrEnum
from typing import NamedTuple

import numpy as np
from pydantic import BaseModel, ConfigDict

from dofview.gl.layered import DepthArray, NoLayersError
from dofview.gl.passes import draw
from dofview.gl.targets import Image
from dofview.methods.method import Recipe
from dofview.render.frame import Frame
from dofview.render.raster import Projection, depth_range, draw_scene, projection

MOST_LAYERS = 32
"""One bit each in the masks."""

# A geometry shader may write 1024 floats; a vertex of the scene has 20 of them with its position and layer.
PER_INVOCATION = 17
TILE = 4
LEAST_BLUR_PX = 1.0 / 16.0


class Layering(StrEnum):
    """How the scene is put into the layers."""

    EXACT = "exact"
    PAPER = "paper"
    PASSES = "passes"


class Slabs(BaseModel):
    """Where the layers lie in 1/z, 1 / scene unit, as shaders read it (slabs.glsl)."""

    model_config = ConfigDict(frozen=True)

    nearest: float
    step: float
    farthest: float
    overlap: float
    count: int

    def bounds(self) -> tuple[np.ndarray, np.ndarray]:
        """Greatest and least 1/z of each layer, without the overlap, (count,) each."""
        edges = self.nearest - self.step * np.arange(self.count + 1)
        edges[self.count :] = self.farthest
        return edges[:-1], edges[1:]


class Kind(NamedTuple):
    """What is put into the layers, and how; `exact` colours are kept in 32 bits instead of 16."""

    slabs: Slabs
    layering: Layering
    detail: int
    surfaces: bool
    cones: bool
    exact: bool = False

    def formats(self) -> dict[str, tuple[int, str]]:
        """Components and type of each array by sampler name, in the order of scene.frag's outputs."""
        formats = {"layer_color": (4, "f4" if self.exact else "f2"), "layer_inverse_depth": (1, "f4")}
        if self.surfaces:
            # Normals decide where a polished surface reflects, so they are kept in full.
            formats |= {"layer_normal": (4, "f4"), "layer_emissive": (4, "f2"), "layer_occlusion": (1, "f1")}
        return formats

    def cone_formats(self) -> dict[str, tuple[int, str]]:
        """The same of what cones read, in the order of cones.frag's outputs."""
        formats = {"layer_color": self.formats()["layer_color"]}
        if self.surfaces:
            # Where a highlight moves away, much is taken from the light and little left: it is kept in full.
            formats |= {"layer_normal": (4, "f4"), "layer_light": (4, "f4"), "layer_occlusion": (1, "f1")}
        return formats

    def texel_bytes(self) -> float:
        """Bytes per texel of a layer, what cones read and depth buffer included."""
        formats = [*self.formats().values(), *(self.cone_formats().values() if self.cones else ())]
        return 4.0 + sum(components * int(dtype[1]) for components, dtype in formats)


class Layers(NamedTuple):
    """Arrays of `detail` times the canvas size by sampler name: layer_color with coverage in alpha, layer_inverse_depth
    (0: empty), and the properties of surfaces where asked for; and an image with one bit per layer for tiles of
    `TILE` by `TILE` pixels that says which layers hold anything there."""

    slabs: Slabs
    images: Mapping[str, Image]
    tiles: Image
    kind: Kind

    @property
    def detail(self) -> int:
        return self.kind.detail


def fit(frame: Frame, count: int, overlap: float) -> Slabs:
    """Return `count` slabs from the nearest to the farthest surface in view, and one more if hidden ones lie beyond.

    What is nearest on the canvas is always visible. What is farthest may not be; it is bounded by the scene's box,
    which can be far larger than anything a ray meets, so it does not get a share of the steps.
    """
    view = frame.depth_range(picture=False)
    if view.nearest == 0.0:
        return Slabs(nearest=1.0, step=1.0, farthest=0.0, overlap=overlap, count=0)
    step = max((view.nearest - view.farthest_surface) / count, view.nearest * 1e-5)
    end = min(1.0 / depth_range(frame.scene, frame.camera)[1], view.farthest_surface)
    hidden = (view.farthest_surface - end) / step > 0.25
    farthest = end if hidden else min(end, view.nearest - count * step)
    return Slabs(
        nearest=view.nearest, step=step, farthest=max(farthest, 0.0), overlap=overlap, count=count + int(hidden)
    )


def count_for_growth(frame: Frame, growth_px: float) -> int:
    """Layers needed for a CoC growth of at most `growth_px` each; the growth is larger where that would be too many."""
    view = frame.depth_range(picture=False)
    growth = abs(frame.coc.scale) * (view.nearest - view.farthest_surface)
    return min(max(math.ceil(growth / growth_px), 1), MOST_LAYERS - 1)


def affordable(frame: Frame, kind: Kind, most_bytes: float) -> Kind:
    """Take detail, then layers away while `kind` needs more than `most_bytes`; and detail where nothing is blurred.

    With everything in focus finer layers have nothing to add, and the picture is the pinhole's to the last bit.
    """
    view = frame.depth_range(picture=False)
    widest = max(abs(float(frame.coc.radius_px(depth))) for depth in (view.nearest, view.farthest_surface))
    if widest < LEAST_BLUR_PX:
        kind = kind._replace(detail=1, exact=True)
    layer_bytes = frame.size[0] * frame.size[1] * kind.texel_bytes()
    detail = min(kind.detail, int(math.sqrt(most_bytes / (layer_bytes * max(kind.slabs.count, 1)))))
    kind = kind._replace(detail=max(min(detail, frame.gpu.max_size // max(frame.size)), 1))
    most = max(int(most_bytes / layer_bytes) - 1, 1)
    return kind if kind.slabs.count <= most + 1 else kind._replace(slabs=fit(frame, most, kind.slabs.overlap))


def build(recipe: Recipe, kind: Kind) -> Layers:
    """Draw the scene into layers as `kind` says, unless they are there from an earlier frame."""
    frame, slabs = recipe.frame, kind.slabs
    images = images_of(recipe, kind, "")
    across, down = (-(-side // TILE) for side in frame.size)
    tiles = recipe.image("tiles", (across, down), components=1, dtype="u4")
    kept = [frame.cache.holds((frame.geometry_key, kind), image) for image in (*images.values(), tiles)]
    if not all(kept):
        if slabs.count:
            once = kind.layering is not Layering.PASSES and _can_layer(frame, slabs.count, images)
            with recipe.gpu.profile.section("multiview/layers"):
                _DRAW[kind.layering if once else Layering.PASSES](recipe, kind, images)
            if frame.scene.blended and not kind.surfaces:
                _see_through(recipe, kind, images)
        occupied(recipe, slabs, images, tiles, TILE * kind.detail)
    return Layers(slabs, images, tiles, kind)


def occupied(recipe: Recipe, slabs: Slabs, images: Mapping[str, Image], into: Image, side: int) -> None:
    """Set a bit for each layer that holds a surface in the `side` by `side` texels of one of `into`."""
    depths = images["layer_inverse_depth"]
    recipe.draw("occupied.frag", into, blocks={"Slabs": slabs}, defines={"SIDE": side}, layer_inverse_depth=depths)


def detail_shift(detail: int) -> float:
    """Pixels by which the layers' finer grid is moved so that one in `detail` of its points is a pixel's centre."""
    return (detail - 1) / (2.0 * detail)


def images_of(recipe: Recipe, kind: Kind, prefix: str, layers: int | None = None) -> dict[str, Image]:
    """The arrays of `kind` (or plain images, for `layers` 0) by sampler name."""
    size, layers = _size(recipe.frame, kind), max(kind.slabs.count, 1) if layers is None else layers
    return {
        name: recipe.image(prefix + name.replace("_", " "), size, components, dtype, layers=layers)
        for name, (components, dtype) in kind.formats().items()
    }


def _draw_exact(recipe: Recipe, kind: Kind, images: dict[str, Image]) -> None:
    """Once, each triangle sent to every layer it overlaps; fragments outside are left out."""
    _draw_once(recipe, kind, images, {"HAS_REJECT": 1, "REJECT": "methods/multiview/reject_slab.glsl"})


def _draw_paper(recipe: Recipe, kind: Kind, images: dict[str, Image]) -> None:
    """Once, each triangle in the layer of its farthest corner alone; then every texel is moved to where it belongs."""
    raw = images_of(recipe, kind, "raw ")
    _draw_once(recipe, kind, raw, {"FARTHEST": 1})
    for k in range(kind.slabs.count):
        draw(
            recipe.gpu, "methods/multiview/settle.frag", tuple(images.values()), textures=raw, values={"layer": k},
            blocks={"Slabs": kind.slabs}, geometry="pass/to_layer.geom",
            defines={"SURFACES": 1} if kind.surfaces else {},
        )  # fmt: skip


def _draw_passes(recipe: Recipe, kind: Kind, images: dict[str, Image]) -> None:
    """Once per layer, for drivers that cannot write layers with a depth each."""
    one = images_of(recipe, kind, "one ", layers=0)
    for k in range(kind.slabs.count):
        draw_scene(
            recipe.gpu, recipe.frame.scene, _projection(recipe.frame, kind), tuple(one.values()),
            reject="methods/multiview/reject_slab.glsl", blocks={"Slabs": kind.slabs}, values={"slab": k},
            **_drawing(recipe, kind, {"ONE_LAYER": 1}),
        )  # fmt: skip
        for name, image in one.items():
            draw(
                recipe.gpu, "pass/copy.frag", images[name], textures={"source": image}, values={"layer": k},
                geometry="pass/to_layer.geom",
            )  # fmt: skip


_DRAW = {Layering.EXACT: _draw_exact, Layering.PAPER: _draw_paper, Layering.PASSES: _draw_passes}


def _draw_once(recipe: Recipe, kind: Kind, images: dict[str, Image], defines: dict[str, object]) -> None:
    # Two sizes only, so that one layer more or less while the camera moves compiles nothing.
    half = PER_INVOCATION // 2 + 1
    most = half if kind.slabs.count <= half else PER_INVOCATION
    into = tuple(images.values())
    defines = {
        **defines, "INVOCATIONS": -(-kind.slabs.count // most), "MOST_LAYERS": most, "MOST_VERTICES": 3 * most,
    }  # fmt: skip
    view, closest = _projection(recipe.frame, kind), 2.0 * kind.slabs.nearest
    if "FARTHEST" not in defines:
        # Each layer has a near and a far plane of its own, which need no logarithm of depth.
        view = replace(view, near_far=(1.0, 1.0))
    draw_scene(
        recipe.gpu, recipe.frame.scene, view, into, blocks={"Slabs": kind.slabs},
        framebuffer=recipe.gpu.targets.framebuffer(into, depth=True), geometry="methods/multiview/layers.geom",
        values={"closest": closest}, **_drawing(recipe, kind, defines),
    )  # fmt: skip


def _see_through(recipe: Recipe, kind: Kind, images: dict[str, Image]) -> None:
    """Lay blended surfaces, which have no layer of their own, over what the lens centre sees through them."""
    seen, (color, depth) = recipe.frame.pinhole(), (images["layer_color"], images["layer_inverse_depth"])
    steps: tuple[tuple[Image, dict[str, object], dict[str, Image]], ...] = (
        (depth, {"MISSING": 1}, {"layer_color": color}),
        (color, {}, {"layer_inverse_depth": depth, "pinhole": seen.color}),
    )
    for into, defines, textures in steps:
        for k in range(kind.slabs.count):
            draw(
                recipe.gpu, "methods/multiview/see_through.frag", into, defines=defines,
                textures={**textures, "inverse_depth": seen.inverse_depth}, blocks={"Slabs": kind.slabs},
                values={"layer": k, "detail": float(kind.detail)}, geometry="pass/to_layer.geom",
            )  # fmt: skip


def _drawing(recipe: Recipe, kind: Kind, defines: dict[str, object]) -> dict:
    """What every way of drawing hands to the scene; textures are as sharp on a finer grid as on the pixels'."""
    surfaces = {"SURFACES": 1} if kind.surfaces else {}
    return {"lights": recipe.frame.lights, "lod_bias": math.log2(kind.detail), "defines": {**defines, **surfaces}}


def _projection(frame: Frame, kind: Kind) -> Projection:
    shift = detail_shift(kind.detail)
    return projection(frame.scene, frame.camera, frame.inner_size, frame.guard, jitter_px=(shift, shift))


def _size(frame: Frame, kind: Kind) -> tuple[int, int]:
    return frame.size[0] * kind.detail, frame.size[1] * kind.detail


def _can_layer(frame: Frame, count: int, images: Mapping[str, Image]) -> bool:
    """Whether one pass can write the `count` layers of `images`, each with its own depth."""
    gpu = frame.gpu
    if not DepthArray.available(gpu.ctx) or (count > PER_INVOCATION and gpu.version_code < 400):
        return False
    try:
        gpu.targets.framebuffer(tuple(images.values()), depth=True)
    except NoLayersError:
        return False
    return True
