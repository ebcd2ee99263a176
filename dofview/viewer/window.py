"""The real window: moderngl-window's glfw window, imgui's own C++ backends, and a loop that sleeps.

`imgui_bundle` is imported before `glfw` so that both use one libglfw.
"""

from __future__ import annotations

import contextlib
import ctypes
import threading
import time
import warnings
from functools import partial
from pathlib import Path
from typing import Any

# isort: off
import imgui_bundle
from imgui_bundle import imgui
import glfw

# isort: on
import numpy as np
from moderngl_window.context.glfw import Window

from dofview.errors import GLError
from dofview.gl.context import REMEDY, REQUIRED, Gpu
from dofview.scene.model import Scene
from dofview.settings import Settings
from dofview.viewer.app import App
from dofview.viewer.opening import restore_view
from dofview.viewer.store import Store

SIZE = (1280, 800)
FONT_PX = 15.0
IDLE_WAIT_S = 1.0
SETTLE_S = 0.6
SETTLE_FRAMES = 8
"""After an event the interface is drawn for this long and this often: tooltips wait, scroll bars glide, and imgui takes
a key pressed and released at once over several frames."""


def run(
    scene: Scene, settings: Settings, spec: str = "", *, restore: bool = False, store: Store | None = None,
    size: tuple[int, int] | None = None,
) -> None:  # fmt: skip
    """Open a window on `scene`, which was loaded from `spec`, and return when it is closed.

    With `restore` the scene is shown as it was last seen, if it was.
    """
    window = _create(size or SIZE, f"dofview — {spec}" if spec else "dofview")
    handle = window._window
    gpu = Gpu(window.ctx)
    _create_interface(handle)
    woken = threading.Event()

    def wake() -> None:
        woken.set()
        glfw.post_empty_event()

    app = App(gpu, scene, settings, wake=wake, spec=spec, store=store)
    if restore:
        restore_view(app)
    glfw.set_drop_callback(handle, partial(_drop, app))
    try:
        _loop(window, app, woken)
    finally:
        app.release()
        gpu.release()
        imgui.backends.opengl3_shutdown()
        imgui.backends.glfw_shutdown()
        imgui.destroy_context()
        window.destroy()


def _drop(app: App, _: object, paths: list[str]) -> None:
    for path in paths:
        app.open_any(path)


def _create(size: tuple[int, int], title: str) -> Window:
    with warnings.catch_warnings():
        # What the library warns of is raised below, in one line.
        warnings.simplefilter("ignore", glfw.GLFWError)
        ready = glfw.init()
    if not ready:
        raise GLError("cannot open a window: no display; use `dofview render` where there is no screen")
    version = (4, 1)
    for version in ((4, 1), (REQUIRED // 100, REQUIRED % 100 // 10)):
        with contextlib.suppress(ValueError), warnings.catch_warnings():
            warnings.simplefilter("ignore", glfw.GLFWError)
            return Window(
                title=title, size=size, gl_version=version, vsync=True, resizable=True, samples=0, exit_key=None,
            )  # fmt: skip
    raise GLError(f"cannot open a window with OpenGL {version[0]}.{version[1]} core; {REMEDY}")


def _create_interface(handle: Any) -> None:
    imgui.create_context()
    io = imgui.get_io()
    io.config_flags |= imgui.ConfigFlags_.nav_enable_keyboard.value
    io.set_ini_filename("")
    # imgui's built-in font has no Greek, which the papers' symbols need.
    font = Path(imgui_bundle.__file__).parent / "assets" / "fonts" / "DroidSans.ttf"
    if font.is_file():
        io.fonts.add_font_from_file_ttf(str(font), FONT_PX)
        imgui.get_style().font_size_base = FONT_PX
    # imgui's callback, which follows, calls this one first.
    glfw.set_key_callback(handle, _part_chords)
    imgui.backends.glfw_init_for_opengl(ctypes.cast(handle, ctypes.c_void_p).value or 0, True)
    imgui.backends.opengl3_init("#version 150")


def _part_chords(_: object, key: int, scancode: int, action: int, mods: int) -> None:
    """Let a frame end before a modifier goes up: a chord pressed and let go within one slow frame would lose it.

    imgui ends a frame's input where one key would change twice; no keyboard has this one.
    """
    if action == glfw.RELEASE and glfw.KEY_LEFT_SHIFT <= key <= glfw.KEY_RIGHT_SUPER:
        imgui.get_io().add_key_event(imgui.Key.f24, True)
        imgui.get_io().add_key_event(imgui.Key.f24, False)


def _loop(window: Window, app: App, woken: threading.Event) -> None:
    awake_until, frames_left = time.monotonic() + SETTLE_S, SETTLE_FRAMES
    while not window.is_closing and not app.quitting:
        if app.busy or frames_left > 0 or time.monotonic() < awake_until:
            glfw.poll_events()
        else:
            before = time.monotonic()
            glfw.wait_events_timeout(IDLE_WAIT_S)
            # An event may come in the very moment the wait ends: then imgui has it, and nobody would draw.
            quiet = time.monotonic() - before >= IDLE_WAIT_S and not woken.is_set() and not _input_waits()
            if quiet and not app.reload_shaders():
                continue
            woken.clear()
            awake_until, frames_left = time.monotonic() + SETTLE_S, SETTLE_FRAMES
        _draw(window, app)
        frames_left -= 1


def _input_waits() -> bool:
    return len(imgui.get_current_context().input_events_queue) > 0


def _draw(window: Window, app: App) -> None:
    app.content_scale = max(glfw.get_window_content_scale(window._window)[0], 0.5)
    app.window_size = width, height = glfw.get_framebuffer_size(window._window)
    imgui.backends.opengl3_new_frame()
    imgui.backends.glfw_new_frame()
    imgui.new_frame()
    app.gui()
    imgui.render()
    ctx = app.gpu.ctx
    ctx.screen.use()
    ctx.viewport = (0, 0, width, height)
    ctx.clear(0.06, 0.06, 0.07)
    imgui.backends.opengl3_render_draw_data(imgui.get_draw_data())
    if app.when_drawn:
        _hand_over(app, (width, height))
    glfw.swap_buffers(window._window)


def _hand_over(app: App, size: tuple[int, int]) -> None:
    """Give what the window shows to whom it was promised."""
    promised, app.when_drawn = app.when_drawn, []
    width, height = size
    data = app.gpu.ctx.screen.read((0, 0, width, height), components=4)
    # The screen is no image of the pool, which would turn it the right way up.
    pixels = np.frombuffer(data, np.uint8).reshape(height, width, 4)[::-1]
    for take in promised:
        take(pixels)
