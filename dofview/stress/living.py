"""What is alive: OpenGL objects, memory, open files, threads and child processes of this process.

Objects are counted by asking the driver about every name: names are no watermark, since Mesa does not use them again,
nor is memory, since llvmpipe frees nothing before it has finished.
"""

from __future__ import annotations

import ctypes
import gc
import os
import sys
import threading
from pathlib import Path
from typing import NamedTuple

import moderngl

KINDS = ("Texture", "Buffer", "Renderbuffer", "Framebuffer", "VertexArray", "Program", "Sampler", "Query")
FEWEST_NAMES = 4096


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
    highest = _highest_name(ctx)
    for kind in KINDS:
        is_kind = ctypes.CFUNCTYPE(ctypes.c_ubyte, ctypes.c_uint)(get_address(f"glIs{kind}".encode()))
        found[kind] = sum(is_kind(name) for name in range(1, highest))
    return found


def _highest_name(ctx: moderngl.Context) -> int:
    """A number above every name in use: names are given in order, so above those of new objects."""
    buffer, texture = ctx.buffer(reserve=4), ctx.texture((1, 1), 4)
    framebuffer = ctx.framebuffer([texture])
    program = ctx.program("#version 330\nvoid main() { gl_Position = vec4(0.0); }")
    array = ctx.vertex_array(program, [])
    made = (array, program, framebuffer, texture, buffer)
    highest = max(thing.glo for thing in made)
    for thing in made:
        thing.release()
    return max(2 * highest, FEWEST_NAMES)


class Alive(NamedTuple):
    """A count of everything that must not grow."""

    objects: int
    memory_kb: float
    files: int
    threads: int
    children: int


def alive(ctx: moderngl.Context) -> Alive:
    """Count after the driver has finished and Python has collected; Linux only."""
    gc.collect()
    objects = live_objects(ctx)
    children = sum(len(path.read_text().split()) for path in Path("/proc/self/task").glob("*/children"))
    return Alive(
        sum(objects.values()) if objects else 0, memory_kb(), len(os.listdir("/proc/self/fd")),
        threading.active_count(), children,
    )  # fmt: skip


def memory_kb() -> float:
    """Resident memory of this process, kB, without what the C library keeps for later; Linux only."""
    trim = getattr(ctypes.CDLL(None), "malloc_trim", None)
    if trim is not None:
        trim(0)
    return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 1024.0
