"""Counting living GL objects, by asking the driver about every name: names are not a watermark, nor is memory."""

from __future__ import annotations

import ctypes
import sys

import moderngl

KINDS = ("Texture", "Buffer", "Renderbuffer", "Framebuffer", "VertexArray", "Program", "Sampler", "Query")
HIGHEST_NAME = 32768


def live_objects(ctx: moderngl.Context) -> dict[str, int] | None:
    """Objects of each kind alive in `ctx`; None where the driver's functions cannot be reached from here."""
    if not sys.platform.startswith("linux"):
        return None
    try:
        get_address = ctypes.CDLL("libEGL.so.1").eglGetProcAddress
    except OSError:
        return None
    get_address.restype = ctypes.c_void_p
    get_address.argtypes = [ctypes.c_char_p]
    ctx.gc()
    ctx.finish()
    found = {}
    for kind in KINDS:
        is_kind = ctypes.CFUNCTYPE(ctypes.c_ubyte, ctypes.c_uint)(get_address(f"glIs{kind}".encode()))
        found[kind] = sum(is_kind(name) for name in range(1, HIGHEST_NAME))
    return found
