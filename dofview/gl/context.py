"""Getting OpenGL, with or without a screen, and everything that belongs to one context."""

from __future__ import annotations

import sys
from typing import Any

import moderngl

from dofview.errors import GLError
from dofview.gl.shaders import ShaderLibrary
from dofview.gl.targets import TargetPool
from dofview.gl.timing import SOFTWARE_RENDERERS, Profile

REQUIRED = 330
"""What the viewer and most methods need; a method may ask for more (`REQUIRES_GL`). macOS stops at 410."""

MOST_BLOCKS, KEPT_FRAMES = 256, 2
"""Uniform buffers kept within a frame, and for how many frames after that in which they were last used."""

REMEDY = "install a graphics driver, or Mesa's software OpenGL (Debian: apt install libgl1-mesa-dri libegl1 libgl1)"


class Gpu:
    """One OpenGL context with its shaders, images and profile. Passed along; never global."""

    def __init__(self, ctx: moderngl.Context):
        if ctx.version_code < REQUIRED:
            found, need = divmod(ctx.version_code, 100), divmod(REQUIRED, 100)
            raise GLError(
                f"OpenGL {need[0]}.{need[1] // 10} core is needed, this machine offers "
                f"{found[0]}.{found[1] // 10} ({ctx.info['GL_RENDERER']}); {REMEDY}"
            )
        self.ctx = ctx
        self.renderer: str = ctx.info["GL_RENDERER"]
        self.version_code: int = ctx.version_code
        self.software = any(name in self.renderer for name in SOFTWARE_RENDERERS)
        self.max_size: int = ctx.info["GL_MAX_TEXTURE_SIZE"]
        self.max_layers: int = ctx.info["GL_MAX_ARRAY_TEXTURE_LAYERS"]
        self.shaders = ShaderLibrary(ctx)
        self.targets = TargetPool(ctx)
        self.profile = Profile(ctx, self.software)
        self.samples_passed = ctx.query(samples=True)
        """The one occlusion query: moderngl cannot release queries, so they are made once and used again."""
        self.nearest, self.linear = (
            ctx.sampler(repeat_x=False, repeat_y=False, filter=(filtered, filtered))
            for filtered in (moderngl.NEAREST, moderngl.LINEAR)
        )
        """For passes that fetch an image by another filter than its own."""
        self._queries: list[moderngl.Query] = []
        self.facts: dict[str, object] = {}
        self._blocks: dict[bytes, tuple[moderngl.Buffer, int]] = {}
        self._frame = 0

    def queries(self, count: int) -> list[moderngl.Query]:
        """`count` occlusion queries for one pass, the same ones every time."""
        while len(self._queries) < count:
            self._queries.append(self.ctx.query(samples=True))
        return self._queries[:count]

    def block(self, data: bytes) -> moderngl.Buffer:
        """Return a uniform buffer holding `data`. None is ever rewritten, so no draw in flight is disturbed."""
        kept = self._blocks.pop(data, None)
        buffer = kept[0] if kept else self.ctx.buffer(data)
        self._blocks[data] = buffer, self._frame
        if len(self._blocks) > MOST_BLOCKS:
            self._blocks.pop(next(iter(self._blocks)))[0].release()
        return buffer

    def end_frame(self) -> None:
        """Release images and uniform buffers that were not used lately."""
        self.targets.collect()
        self._frame += 1
        # The one used longest ago comes first.
        while self._blocks and next(iter(self._blocks.values()))[1] < self._frame - KEPT_FRAMES:
            self._blocks.pop(next(iter(self._blocks)))[0].release()

    def release(self) -> None:
        """Release every object; the context itself stays with whoever made it."""
        self.nearest.release()
        self.linear.release()
        self.targets.release()
        self.shaders.release()
        for buffer, _ in self._blocks.values():
            buffer.release()
        self._blocks.clear()


def create_headless() -> Gpu:
    """Make a context without a window: through EGL on Linux, the system's own way elsewhere."""
    settings: dict[str, Any] = {"backend": "egl"} if sys.platform.startswith("linux") else {}
    # moderngl raises bare Exception for a missing library, device, driver or version: all mean no usable OpenGL.
    try:
        ctx = moderngl.create_context(standalone=True, require=REQUIRED, **settings)
    except Exception as error:
        reason = _older(settings) or str(error).strip().partition("\n")[0] or type(error).__name__
        need = f"{REQUIRED // 100}.{REQUIRED % 100 // 10}"
        raise GLError(f"no usable OpenGL {need} without a screen ({reason}); {REMEDY}") from error
    return Gpu(ctx)


def _older(settings: dict[str, Any]) -> str:
    """What there is where what is needed is not; empty when there is nothing."""
    try:
        ctx = moderngl.create_context(standalone=True, require=210, **settings)
        found = f"this machine offers {ctx.version_code // 100}.{ctx.version_code % 100 // 10}"
        ctx.release()
        return found
    except Exception:
        return ""
