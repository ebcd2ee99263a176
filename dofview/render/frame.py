"""What a method is given: a scene seen through one lens, from which it takes the images it needs.

Nothing is rendered that was not asked for, and nothing twice: images depend on the geometry key (scene, camera, canvas,
background), not on the lens, so moving the focus or switching methods draws no triangle.
"""

from __future__ import annotations

from typing import NamedTuple

from moderngl import Framebuffer
from pydantic import BaseModel, ConfigDict

from dofview.gl.context import Gpu
from dofview.gl.filters import reduce_blocks
from dofview.gl.targets import Image
from dofview.lens import CocLaw, Lens, focal_px
from dofview.render.environment import Environment
from dofview.render.lights import Lights
from dofview.render.peels import DEPTH, find_behind, settle, shade
from dofview.render.raster import Projection, Runs, draw_scene, in_view, projection
from dofview.render.upload import GpuScene
from dofview.scene.camera import Camera


class Surfaces(NamedTuple):
    """One surface per pixel: linear colour (alpha 1 where something is) and inverse depth 1/z (0 where nothing is)."""

    color: Image
    inverse_depth: Image


class DepthRange(NamedTuple):
    """Extremes of 1/z over an image; `farthest` is 0 where background shows, `farthest_surface` only without any."""

    nearest: float
    farthest: float
    empty: bool
    farthest_surface: float


class LensBlock(BaseModel):
    """The lens as shaders read it (`include/lens.glsl`); `sigma` is the matched Gaussian σ over the CoC radius."""

    model_config = ConfigDict(frozen=True)

    scale: float
    inverse_focus: float
    sigma: float


class Recent(dict):
    """A dictionary that forgets what was not used lately, so that a camera on the move leaves nothing behind."""

    MOST = 64

    def __getitem__(self, key: object) -> object:
        value = super().pop(key)
        super().__setitem__(key, value)
        return value

    def __setitem__(self, key: object, value: object) -> None:
        super().__setitem__(key, value)
        while len(self) > self.MOST:
            del self[next(iter(self))]


class FrameCache:
    """Images that outlive a frame, each with the key it was rendered for, and figures that were read back."""

    def __init__(self) -> None:
        self._held: dict[str, tuple[object, Image]] = {}
        self.values = Recent()

    def holds(self, key: object, image: Image) -> bool:
        """Whether `image` still is what `key` asks for; if not, the caller renders it now."""
        found = self._held.get(image.name)
        if found is not None and found[0] == key and found[1] is image:
            return True
        self._held[image.name] = (key, image)
        return False

    def held(self, key: object, name: str) -> Image | None:
        """The image called `name` if it was rendered for `key`; None otherwise. Nothing is asked of the caller."""
        found = self._held.get(name)
        return found[1] if found is not None and found[0] == key else None

    def clear(self) -> None:
        self._held.clear()
        self.values.clear()


class Frame:
    """One scene, camera and lens on one canvas; `size` is the canvas with its guard band, pixels."""

    def __init__(
        self, gpu: Gpu, scene: GpuScene, camera: Camera, lens: Lens, size: tuple[int, int], *, guard: int = 0,
        background: tuple[float, float, float] = (0.0, 0.0, 0.0), environment: Environment | None = None,
        cache: FrameCache | None = None,
    ):  # fmt: skip
        self.gpu = gpu
        self.scene = scene
        self.camera = camera
        self.lens = lens
        self.inner_size = size
        self.guard = guard
        self.size = (size[0] + 2 * guard, size[1] + 2 * guard)
        self.background = background
        self.coc: CocLaw = lens.coc(focal_px(size[1], camera.vfov_deg))
        self.lens_block = LensBlock(
            scale=self.coc.scale, inverse_focus=self.coc.inverse_focus, sigma=lens.matched_sigma_fraction
        )
        self.lights = Lights.of(camera, environment)
        self.cache = cache or FrameCache()
        self.geometry_key = (id(scene), camera, size, guard, background, environment)

    def projection(self) -> Projection:
        """The pinhole projection through the lens centre."""
        return projection(self.scene, self.camera, self.inner_size, self.guard)

    def pinhole(self) -> Surfaces:
        """The nearest surfaces, over the background: colour is defined everywhere."""
        return self._surfaces("pinhole")

    def peel(self, index: int) -> Surfaces | None:
        """The surfaces behind `index` others, alpha 0 where there are none; None when there are none at all.

        Peel 0 is the pinhole picture. Each costs one pass over the geometry, once.
        """
        if index == 0:
            return self.pinhole()
        before = self.peel(index - 1)
        if before is None:
            return None
        # The quick way finds depths, and what is seen through is more than those.
        quick = self.gpu.software and not self.scene.blended
        surfaces = self._peeled(index) if quick else self._surfaces(f"peel{index}", before.inverse_depth)
        ended = self.peel_is_empty(index) and self.gpu.profile.may_skip("layered peels skipped")
        return None if ended else surfaces

    def peel_is_empty(self, index: int) -> bool:
        """Whether no surface was found behind `index` others; told of a peel that was asked for."""
        return not self.cache.values.get((self.geometry_key, f"frame/peel{index}"), True)

    def depth_range(self, picture: bool = True) -> DepthRange:
        """Extremes of 1/z in the pinhole picture, guard band included. Read back once per geometry key.

        A method that does not read the `picture` itself says so; then only depths are drawn, in an eighth of the time.
        """
        key = (self.geometry_key, "depth range")
        if key not in self.cache.values:
            least, greatest, empty, _ = reduce_blocks(
                self.gpu, self.pinhole().inverse_depth if picture else self._depths(), "render/depth_range.frag",
                "depth range/",
            )  # fmt: skip
            surface = 0.0 if greatest == 0.0 else float(least)
            self.cache.values[key] = DepthRange(float(greatest), 0.0 if empty else surface, bool(empty), surface)
        return self.cache.values[key]  # type: ignore[return-value]

    def coc_range(self, picture: bool = True) -> tuple[float, float]:
        """Signed CoC radii of the nearest and the farthest visible surface, pixels."""
        depths = self.depth_range(picture)
        return float(self.coc.radius_px(depths.nearest)), float(self.coc.radius_px(depths.farthest))

    def in_focus(self, within_px: float, picture: bool = True) -> bool:
        """Whether no visible surface, guard band included, has a CoC radius above `within_px`; counted if so.

        A method whose picture is the pinhole's up to some radius has nothing to do then.
        """
        near, far = self.coc_range(picture)
        found = max(abs(near), abs(far)) <= within_px and self.gpu.profile.may_skip("frames in focus")
        self.gpu.profile.count("frames in focus", int(found))
        return found

    def _depths(self) -> Image:
        """Inverse depths of the nearest surfaces: the pinhole picture's where that is there, else drawn for one use."""
        drawn = self.cache.held((self.geometry_key, "pinhole"), "frame/pinhole inverse depth")
        if drawn is not None and drawn in self.gpu.targets:
            return drawn
        if self.scene.blended:
            return self.pinhole().inverse_depth  # what is seen through has a depth only before nothing
        depths = self.gpu.targets.image("frame/inverse depth", self.size, components=1)
        with self.gpu.profile.section("scene/depths"):
            draw_scene(
                self.gpu, self.scene, self.projection(), (depths,), lights=self.lights, defines={"DEPTH_ONLY": 1}
            )
        return depths

    def _surfaces(self, name: str, behind: Image | None = None) -> Surfaces:
        color, inverse_depth = self._images(name)
        if self._held(name, color, inverse_depth):
            return Surfaces(color, inverse_depth)
        passed = self.gpu.samples_passed
        # What is seen through needs to know what it is laid over, also where a peel has nothing.
        nothing = self.background if self.scene.blended else (0.0, 0.0, 0.0)
        own_depth = self._with_depth(color, inverse_depth) if self.gpu.software and not self.scene.blended else None
        with self.gpu.profile.section(f"scene/{name}"):
            draw_scene(
                self.gpu, self.scene, self.projection(), (color, inverse_depth), lights=self.lights, behind=behind,
                background=nothing if behind else self.background, passed=passed if behind else None,
                framebuffer=own_depth,
            )  # fmt: skip
        if behind:
            self.cache.values[(self.geometry_key, color.name)] = passed.samples > 0
        if own_depth:
            self.gpu.targets.keep_depth(self.size, DEPTH, (self.geometry_key, name))
        return Surfaces(color, inverse_depth)

    def _with_depth(self, *images: Image) -> Framebuffer:
        """The framebuffer of `images` with the depth buffer that peels are found with."""
        return self.gpu.targets.framebuffer(images, depth=DEPTH)

    def _images(self, name: str) -> tuple[Image, Image]:
        targets = self.gpu.targets
        return targets.image(f"frame/{name}", self.size), targets.image(f"frame/{name} inverse depth", self.size, 1)

    def _held(self, name: str, *images: Image) -> bool:
        # All of them are asked: each is then known to be drawn.
        held = [self.cache.holds((self.geometry_key, name), image) for image in images]
        return all(held)

    def _peeled(self, index: int) -> Surfaces:
        """Peel `index` without a test in the shader (`render.peels`)."""
        name = f"peel{index}"
        color, inverse_depth = self._images(name)
        if not self._held(name, color, inverse_depth):
            with self.gpu.profile.section(f"scene/{name}"):
                draws = self._find_peel(index)
                shade(self.gpu, self.scene, self.projection(), color, lights=self.lights, draws=draws)
                self.gpu.targets.keep_depth(self.size, DEPTH, (self.geometry_key, name))
        return Surfaces(color, inverse_depth)

    def _find_peel(self, index: int) -> Runs:
        """Draw the depths of peel `index`, and leave them in the depth buffer; returns what may be in it or behind."""
        key = (self.geometry_key, "peel")
        view, before = self.projection(), "pinhole" if index == 1 else f"peel{index - 1}"
        draws = in_view(self.scene, view)
        if not self.gpu.targets.depth_holds(self.size, DEPTH, (self.geometry_key, before)):
            # It was kept from another frame: its depths are drawn once more.
            if index == 1:
                scratch = self.gpu.targets.image("frame/inverse depth", self.size, components=1)
                draw_scene(
                    self.gpu, self.scene, view, (scratch,), lights=self.lights, defines={"DEPTH_ONLY": 1},
                    framebuffer=self._with_depth(scratch), draws=draws,
                )  # fmt: skip
            else:
                self._find_peel(index - 1)
        skips = self.gpu.profile.may_skip("peel parts skipped")
        if index > 1 and skips:
            draws = self.cache.values.get((*key, index - 1, "draws"), draws)
        found = self.gpu.targets.image("frame/found behind", self.size, components=2)
        behind = find_behind(self.gpu, self.scene, view, found, lights=self.lights, draws=draws)
        settle(self.gpu, found, self._images(f"peel{index}")[1])
        self.cache.values[(self.geometry_key, f"frame/peel{index}")] = bool(behind.ranges)
        draws = self.cache.values[(*key, index, "draws")] = behind if skips else draws
        return draws
