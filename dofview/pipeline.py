"""From settings to a picture: the one function that the window, the command line, the benchmark and the tests call.

file ──► Scene ──► GpuScene ──► Frame ──► Method ──► Image
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from dofview.errors import GLError, SettingsError
from dofview.gl.context import Gpu
from dofview.gl.passes import draw
from dofview.gl.targets import Image
from dofview.methods import method
from dofview.render.compare import psnr
from dofview.render.display import show
from dofview.render.environment import Environment, Lighting
from dofview.render.environment import load as load_environment
from dofview.render.frame import Frame, FrameCache
from dofview.render.guard import guard_band
from dofview.render.pick import inverse_depth_at
from dofview.render.reference import Quality, Reference
from dofview.render.upload import GpuScene
from dofview.scene.model import Scene
from dofview.settings import Settings

MAX_CANVAS_PIXELS = 1 << 27


@dataclass(frozen=True)
class Result:
    """A finished picture: `image` is linear RGB at the asked size, on the GPU until `pixels()` is called."""

    image: Image
    frame: Frame
    counts: dict[str, int] = field(default_factory=dict)

    def pixels(self) -> np.ndarray:
        """Read back (height, width, 3) float32 linear RGB, row 0 on top."""
        return np.ascontiguousarray(self.image.pixels()[..., :3])


class Pipeline:
    """Renders one scene under any settings; holds the scene's buffers and what may be kept between frames."""

    def __init__(self, gpu: Gpu, scene: Scene):
        self.gpu = gpu
        self.scene = GpuScene(gpu, scene)
        self._cache = FrameCache()
        self._reference: Reference | None = None
        self._reference_key: object = None
        self._environment: Environment | None = None
        self._environment_stamp = Lighting().stamp()

    def load(self, scene: Scene) -> None:
        """Show another scene. The former one stays when this one cannot be uploaded."""
        fresh = GpuScene(self.gpu, scene)
        self.scene.release()
        self.scene = fresh
        self.forget()

    def forget(self, *, reference: bool = True) -> None:
        """Drop all images kept from earlier frames, so that the next frame does its whole work; the `reference` too."""
        self._cache.clear()
        if reference:
            self._reference = self._reference_key = None

    def render(self, settings: Settings, name: str = "picture", *, ends_frame: bool = True) -> Result:
        """Render the picture that `settings` describe into the image called `name`.

        It ends a frame, after which images are released that were not used lately; one that `ends_frame` not stands
        beside another of the same frame.
        """
        self.gpu.profile.begin()
        chosen = method(settings.method)
        if self.gpu.version_code < chosen.REQUIRES_GL:
            raise GLError(f"{settings.method} needs OpenGL {_version(chosen.REQUIRES_GL)}, this is {self.gpu.renderer}")
        frame = self.frame(settings, guard=chosen.GUARD_BAND)
        canvas = chosen.render(frame, settings.method_params)
        picture = self._resolve(canvas, frame, settings.image.size, name)
        if self._reference is not None:
            self._reference.touch()
        if ends_frame:
            self.gpu.end_frame()
        return Result(picture, frame, dict(self.gpu.profile.counts))

    def shown(self, result: Result, settings: Settings) -> np.ndarray:
        """What a screen shows of `result`: (height, width, 3) uint8 after exposure, tone curve and sRGB."""
        return np.ascontiguousarray(show(self.gpu, result.image, settings.display, "shown once").pixels()[..., :3])

    def reference(self, settings: Settings, *, antialias: bool = False) -> Reference:
        """Return the progressive reference for `settings`, begun anew when anything it depends on has changed."""
        image = settings.image
        key = (id(self.scene), settings.camera, settings.lens, image.size, image.scale, settings.background_linear,
               settings.light.stamp(), antialias)  # fmt: skip
        if key != self._reference_key or self._reference is None:
            self._reference = Reference(self.frame(settings, guard=False), antialias=antialias)
            self._reference_key = key
        return self._reference

    def reference_picture(self, settings: Settings, *, antialias: bool = False, name: str = "reference") -> Image:
        """The progressive reference's mean so far, at the picture's size."""
        reference = self.reference(settings, antialias=antialias)
        return self._resolve(reference.mean(), reference.frame, settings.image.size, name)

    def compare(self, result: Result, settings: Settings, *, antialias: bool = False) -> tuple[float, Quality]:
        """PSNR of `result` against the reference so far, dB, and how far that reference can be trusted."""
        quality = self.reference(settings, antialias=antialias).quality()
        reference = self.reference_picture(settings, antialias=antialias)
        return psnr(self.gpu, result.image, reference), quality

    def inverse_depth(self, settings: Settings, x: float, y: float, radius: float = 0.0) -> float:
        """Median of 1/z near a point of the picture (`render.pick`); draws nothing that the method draws anyway."""
        return inverse_depth_at(self.frame(settings, guard=method(settings.method).GUARD_BAND), x, y, radius)

    def frame(self, settings: Settings, *, guard: bool) -> Frame:
        """The frame that a method renders from, with its guard band when it uses one."""
        image = settings.image
        size = (max(round(image.size[0] * image.scale), 1), max(round(image.size[1] * image.scale), 1))
        width = 0
        if guard:
            width = image.guard_px if image.guard_px is not None else guard_band(
                self.gpu, self.scene, settings.camera, settings.lens, size, self._cache
            )  # fmt: skip
        self._check_size((size[0] + 2 * width, size[1] + 2 * width))
        return Frame(
            self.gpu, self.scene, settings.camera, settings.lens, size, guard=width,
            background=settings.background_linear, environment=self._surroundings(settings.light), cache=self._cache,
        )  # fmt: skip

    def release(self) -> None:
        """Release the scene's buffers; images belong to the context."""
        self.scene.release()
        self.forget()
        if self._environment is not None:
            self._environment.release()
            self._environment, self._environment_stamp = None, Lighting().stamp()

    def _surroundings(self, lighting: Lighting) -> Environment | None:
        """The environment of `lighting`, loaded when it, or the content of its file, is another than last time."""
        stamp = lighting.stamp()
        if stamp != self._environment_stamp:
            fresh = load_environment(self.gpu, lighting)
            if self._environment is not None:
                self._environment.release()
            self._environment, self._environment_stamp = fresh, stamp
        return self._environment

    def _resolve(self, canvas: Image, frame: Frame, size: tuple[int, int], name: str) -> Image:
        picture = self.gpu.targets.image(name, size)
        scale = (frame.inner_size[0] / size[0], frame.inner_size[1] / size[1])
        draw(
            self.gpu, "render/resolve.frag", picture, textures={"canvas": canvas},
            values={"scale": scale, "guard": frame.guard}, defines={"SAME_SIZE": 1} if scale == (1.0, 1.0) else {},
        )  # fmt: skip
        return picture

    def _check_size(self, size: tuple[int, int]) -> None:
        limit = min(self.gpu.max_size, math.isqrt(MAX_CANVAS_PIXELS) * 4)
        if max(size) > limit or size[0] * size[1] > MAX_CANVAS_PIXELS:
            raise SettingsError(
                f"image of {size[0]}x{size[1]} pixels (scale and guard band included) is too large; accepted: sides up "
                f"to {limit} and {MAX_CANVAS_PIXELS >> 20} Mi pixels in all"
            )


def _version(code: int) -> str:
    return f"{code // 100}.{code % 100 // 10}"
