"""Images that passes write and read, kept by name: same name and shape is the same image, another shape replaces it.

Nothing else creates a texture whose size depends on the window, so resizing or switching methods leaves nothing behind:
`collect()` releases what has not been asked for lately.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import moderngl
import numpy as np

from dofview.errors import GLError
from dofview.gl.layered import DepthArray

DepthKey = tuple[int, int, int, str]
"""Width, height, layers (0: not an array) and name of a depth buffer."""

# moderngl calls normalised bytes "f1"; numpy knows them as bytes.
_NUMPY = {"f1": "u1"}


@dataclass(frozen=True)
class Shape:
    """What an image is made of: size in pixels, 1–4 components, moderngl dtype, layers (0: not an array)."""

    size: tuple[int, int]
    components: int = 4
    dtype: str = "f4"
    layers: int = 0
    linear: bool = False


class Image:
    """A named texture in linear light or data; `texture` is the moderngl object."""

    def __init__(self, ctx: moderngl.Context, name: str, shape: Shape):
        self.name = name
        self.shape = shape
        self.texture: moderngl.Texture | moderngl.TextureArray = (
            ctx.texture_array((*shape.size, shape.layers), shape.components, dtype=shape.dtype)
            if shape.layers
            else ctx.texture(shape.size, shape.components, dtype=shape.dtype)
        )
        integer = shape.dtype[0] in "iu"
        mode = moderngl.LINEAR if shape.linear and not integer else moderngl.NEAREST
        self.texture.filter = (mode, mode)
        self.texture.repeat_x = self.texture.repeat_y = False

    @property
    def size(self) -> tuple[int, int]:
        """(width, height) in pixels."""
        return self.shape.size

    def pixels(self) -> np.ndarray:
        """Read back (height, width, components), or (layers, …) for an array, row 0 on top. Nobody else flips."""
        width, height = self.size
        data = np.frombuffer(self.texture.read(alignment=1), dtype=_NUMPY.get(self.shape.dtype, self.shape.dtype))
        data = data.reshape(max(self.shape.layers, 1), height, width, self.shape.components)[:, ::-1]
        return np.ascontiguousarray(data if self.shape.layers else data[0])

    def write(self, pixels: np.ndarray) -> None:
        """Upload (height, width, components), row 0 on top."""
        self.texture.write(
            np.ascontiguousarray(pixels[::-1], dtype=_NUMPY.get(self.shape.dtype, self.shape.dtype)).tobytes(),
            alignment=1,
        )

    def release(self) -> None:
        self.texture.release()


class TargetPool:
    """Every image and framebuffer of one context, by name."""

    def __init__(self, ctx: moderngl.Context):
        self._ctx = ctx
        self._images: dict[str, Image] = {}
        self._depths: dict[DepthKey, moderngl.Renderbuffer | DepthArray] = {}
        self._framebuffers: dict[tuple, moderngl.Framebuffer] = {}
        self._used: dict[str, int] = {}
        self._depth_used: dict[DepthKey, int] = {}
        self._depth_holds: dict[DepthKey, object] = {}
        self._clock = 0
        self.keep_frames = 2
        self._resting = ctx.framebuffer([ctx.renderbuffer((1, 1))])

    def image(
        self, name: str, size: tuple[int, int], components: int = 4, dtype: str = "f4", layers: int = 0,
        linear: bool = False,
    ) -> Image:  # fmt: skip
        """Return the image called `name`, made anew only when its shape changed. Contents persist between frames."""
        shape = Shape((int(size[0]), int(size[1])), components, dtype, layers, linear)
        image = self._images.get(name)
        if image is None or image.shape != shape:
            if image is not None:
                self._release(name)
            image = self._images[name] = Image(self._ctx, name, shape)
        self._used[name] = self._clock
        return image

    def framebuffer(self, images: Sequence[Image], depth: bool | str = False) -> moderngl.Framebuffer:
        """Return the framebuffer with these colour attachments, and a depth buffer of their size if asked: the one that
        all share, or one called `depth` that holds what it held.

        Arrays are attached with all their layers, of which a geometry shader chooses; each layer has its own depth then
        (GLError where the driver cannot: ask `layered.DepthArray.available` first).
        """
        shape = images[0].shape
        depth_key = (*shape.size, shape.layers, depth if isinstance(depth, str) else "") if depth else None
        key = (tuple(image.texture.glo for image in images), depth_key)
        if key not in self._framebuffers:
            try:
                self._framebuffers[key] = self._make(images, depth_key)
            except moderngl.Error as error:
                # Textures are made without a complaint where there is no memory for them; this is where it shows.
                size = "x".join(map(str, shape.size))
                raise GLError(
                    f"no memory for images of {size} pixels ({error}); accepted: a smaller picture"
                ) from error
        if depth_key is not None:
            self._depth_used[depth_key] = self._clock
            self._depth_holds.pop(depth_key, None)
        return self._framebuffers[key]

    def keep_depth(self, size: tuple[int, int], depth: str, what: object) -> None:
        """Remember that the depth buffer called `depth` holds `what`, until a framebuffer with it is asked for."""
        self._depth_holds[(*size, 0, depth)] = what

    def depth_holds(self, size: tuple[int, int], depth: str, what: object) -> bool:
        """Whether the depth buffer called `depth` still holds `what`."""
        return self._depth_holds.get((*size, 0, depth)) == what

    def named(self, prefix: str = "") -> list[Image]:
        """All living images whose name starts with `prefix`, by name: what a pass browser lists."""
        return [self._images[name] for name in sorted(self._images) if name.startswith(prefix)]

    def __contains__(self, image: Image) -> bool:
        """Whether `image` lives: it was neither released nor replaced by one of another shape."""
        return self._images.get(image.name) is image

    def touch(self, image: Image) -> None:
        """Count `image` as asked for, so that its contents live through a frame that does not draw it."""
        if image in self:
            self._used[image.name] = self._clock

    def collect(self, keep_frames: int | None = None) -> None:
        """End a frame: release what was not asked for in the last `keep_frames` frames, by default the pool's own."""
        self._clock += 1
        keep_frames = self.keep_frames if keep_frames is None else keep_frames
        for name in [n for n, used in self._used.items() if used < self._clock - keep_frames]:
            self._release(name)
        for depth in [d for d, used in self._depth_used.items() if used < self._clock - keep_frames]:
            self._drop_framebuffers([key for key in self._framebuffers if key[1] == depth])
            self._depths.pop(depth).release()
            del self._depth_used[depth]
            self._depth_holds.pop(depth, None)

    def release(self) -> None:
        """Release everything."""
        self.collect(keep_frames=-1)
        if self._ctx.fbo is self._resting:
            self._ctx.detect_framebuffer(0).use()  # what is bound is bound again after making another
        self._resting.color_attachments[0].release()
        self._resting.release()

    def _make(self, images: Sequence[Image], depth_key: DepthKey | None) -> moderngl.Framebuffer:
        textures = [image.texture for image in images]
        depth = self._depth(depth_key) if depth_key else None
        if not isinstance(depth, DepthArray):
            return self._ctx.framebuffer(textures, depth)
        framebuffer = self._ctx.framebuffer(textures)
        depth.attach(framebuffer)
        return framebuffer

    def _depth(self, key: DepthKey) -> moderngl.Renderbuffer | DepthArray:
        if key not in self._depths:
            width, height, layers, _ = key
            self._depths[key] = (
                DepthArray(self._ctx, (width, height), layers)
                if layers
                else self._ctx.depth_renderbuffer((width, height))
            )
        return self._depths[key]

    def _release(self, name: str) -> None:
        image = self._images.pop(name)
        self._used.pop(name, None)
        glo = image.texture.glo
        self._drop_framebuffers([key for key in self._framebuffers if glo in key[0]])
        image.release()

    def _drop_framebuffers(self, keys: list[tuple]) -> None:
        for key in keys:
            framebuffer = self._framebuffers.pop(key)
            if self._ctx.fbo is framebuffer:
                # moderngl binds the last framebuffer again after making another, also when it is gone by then.
                self._resting.use()
            framebuffer.release()
