"""Depth buffers for layered targets: one depth image per layer of an array, which moderngl has no wrapper for.

Five functions are called directly, found through the loader that moderngl itself was made with, so that it works with
every window system. Where they cannot be found, `DepthArray.available` says so and passes draw one layer at a time.
"""

from __future__ import annotations

import ctypes
from typing import Any

import moderngl

from dofview.errors import GLError

_TEXTURE_2D_ARRAY = 0x8C1A
_DEPTH_COMPONENT = 0x1902
_DEPTH_COMPONENT32F = 0x8CAC
_FLOAT = 0x1406
_FRAMEBUFFER = 0x8D40
_DEPTH_ATTACHMENT = 0x8D00
_COMPLETE = 0x8CD5
_INT, _UINT, _POINTER = ctypes.c_int, ctypes.c_uint, ctypes.c_void_p
_FUNCTIONS: dict[str, tuple[Any, ...]] = {
    "glGenTextures": (None, _INT, _POINTER),
    "glDeleteTextures": (None, _INT, _POINTER),
    "glBindTexture": (None, _UINT, _UINT),
    "glTexImage3D": (None, _UINT, _INT, _INT, _INT, _INT, _INT, _INT, _UINT, _UINT, _POINTER),
    "glBindFramebuffer": (None, _UINT, _UINT),
    "glFramebufferTexture": (None, _UINT, _UINT, _UINT, _INT),
    "glCheckFramebufferStatus": (_UINT, _UINT),
}


class NoLayersError(GLError):
    """The driver has no framebuffer whose layers have a depth buffer each."""


class DepthArray:
    """A 32-bit float depth buffer of `layers` images of `size`, for layered rendering."""

    def __init__(self, ctx: moderngl.Context, size: tuple[int, int], layers: int):
        self._gl = _functions(ctx)
        if not self._gl:
            raise GLError("layered depth needs OpenGL functions that this context does not hand out")
        name = _UINT()
        self._gl["glGenTextures"](1, ctypes.byref(name))
        self.glo = name.value
        self._gl["glBindTexture"](_TEXTURE_2D_ARRAY, self.glo)
        self._gl["glTexImage3D"](
            _TEXTURE_2D_ARRAY, 0, _DEPTH_COMPONENT32F, *size, layers, 0, _DEPTH_COMPONENT, _FLOAT, None
        )
        self._gl["glBindTexture"](_TEXTURE_2D_ARRAY, 0)

    @staticmethod
    def available(ctx: moderngl.Context) -> bool:
        """Whether `ctx` hands out the functions this needs."""
        return bool(_functions(ctx))

    def attach(self, framebuffer: moderngl.Framebuffer) -> None:
        """Make this the depth buffer of `framebuffer`, whose colour images are arrays of as many layers."""
        framebuffer.use()
        self._gl["glBindFramebuffer"](_FRAMEBUFFER, framebuffer.glo)
        self._gl["glFramebufferTexture"](_FRAMEBUFFER, _DEPTH_ATTACHMENT, self.glo, 0)
        if self._gl["glCheckFramebufferStatus"](_FRAMEBUFFER) != _COMPLETE:
            raise NoLayersError("this driver has no framebuffers with a depth buffer per layer")
        # moderngl takes a framebuffer made without depth for one that cannot be written, and would never clear it.
        framebuffer.depth_mask = True

    def release(self) -> None:
        name = _UINT(self.glo)
        self._gl["glDeleteTextures"](1, ctypes.byref(name))


def _functions(ctx: moderngl.Context) -> dict[str, Any]:
    """The functions by name; empty when one is missing."""
    load = getattr(getattr(ctx.mglo, "_context", None), "load", None)
    addresses = {name: load(name) for name in _FUNCTIONS} if load else {}
    if not all(addresses.values()):
        return {}
    return {name: ctypes.CFUNCTYPE(*_FUNCTIONS[name])(address) for name, address in addresses.items()}
