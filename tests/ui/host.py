"""Runs the viewer's interface inside imgui's test engine, in a process of its own."""

from __future__ import annotations

import sys
import time
import traceback
from collections.abc import Callable
from pathlib import Path

sys.path[:0] = [str(Path(__file__).parents[2]), str(Path(__file__).parents[1])]

from imgui_bundle import hello_imgui, imgui  # noqa: E402, I001
from imgui_bundle.immapp import testing  # noqa: E402
import moderngl  # noqa: E402
import numpy as np  # noqa: E402
from scenes import three_planes  # noqa: E402

from dofview.framing import opening  # noqa: E402
from dofview.gl.context import Gpu  # noqa: E402
from dofview.settings import ImageSettings, Settings  # noqa: E402
from dofview.viewer.app import App  # noqa: E402
from dofview.viewer.store import Interface, Store  # noqa: E402

Context = imgui.test_engine.TestContext


class Host:
    """The viewer on a small scene. The engine runs a test in a thread without OpenGL, so pictures are read for it.

    `after` is called at the end of each frame, where OpenGL is.
    """

    def __init__(self, store: Store | None = None, spec: str = "") -> None:
        self.app: App | None = None
        self.store, self.spec = store, spec
        self.after: Callable[[App], None] = lambda app: None
        self._wanted = False
        self._pixels = np.zeros(0)

    def frame(self) -> None:
        """One frame of the interface."""
        if self.app is None:
            settings = Settings(method="pinhole", image=ImageSettings(size=(64, 48)))
            scene = three_planes()
            gpu = Gpu(moderngl.create_context())
            self.app = App(gpu, scene, opening(scene, "", settings), spec=self.spec, store=self.store)
            self.app.interface = Interface(reduced_motion=True)
            imgui.get_io().config_flags |= imgui.ConfigFlags_.nav_enable_keyboard.value
            # A slow machine is not a hanging test; whoever runs this script limits its time.
            engine = imgui.test_engine.get_io(hello_imgui.get_imgui_test_engine())
            engine.config_watchdog_warning = engine.config_watchdog_kill_test = 1000.0
        try:
            self.app.gui()
        except Exception:
            # imgui would end the process over a missing End() before anyone could read why.
            traceback.print_exc()
            raise
        if self._wanted and self.app.shown is not None:
            self._pixels, self._wanted = self.app.shown.pixels()[..., :3].astype(float), False
        self.after(self.app)
        self.app.gpu.ctx.screen.use()
        assert self.app.gpu.ctx.error == "GL_NO_ERROR"

    def pixels(self, context: Context) -> np.ndarray:
        """The picture shown after a few frames, (h, w, 3)."""
        context.yield_(3)
        self._wanted = True
        while self._wanted:
            context.yield_()
        return self._pixels

    def inside(self, context: Context, work: Callable[[App], None]) -> None:
        """Do `work` where OpenGL is, once, and let two frames pass."""
        done = []
        before, self.after = self.after, lambda app: done.append(work(app)) if not done else None
        until(context, lambda: bool(done), "a frame is drawn")
        self.after = before
        context.yield_(2)


def drive(
    test: Callable[[Context, App, Host], None], size: tuple[int, int] = (560, 480), *,
    store: Store | None = None, spec: str = "",
) -> None:  # fmt: skip
    """Show the viewer and let `test` use it; a failed assertion or engine error is raised."""
    host = Host(store, spec)
    params = hello_imgui.RunnerParams()
    params.callbacks.show_gui = host.frame
    params.callbacks.before_exit = lambda: host.app and host.app.release()
    params.app_window_params.window_geometry.size = size
    params.imgui_window_params.default_imgui_window_type = hello_imgui.DefaultImGuiWindowType.no_default_window
    params.fps_idling.enable_idling = False
    params.ini_disable = True
    testing.run(test_function=lambda context: test(context, host.app, host), runner_params=params)


def until(context: Context, wanted: Callable[[], bool], what: str, seconds: float = 30.0) -> None:
    """Let frames pass until `wanted`."""
    deadline = time.monotonic() + seconds
    while not wanted():
        assert time.monotonic() < deadline, what
        context.yield_()


def press(context: Context, name: str, *modifiers: str) -> None:
    """Press a key by its name in imgui, with modifiers "ctrl", "shift", "alt", and let two frames pass."""
    chord = int(getattr(imgui.Key, name))
    for modifier in modifiers:
        chord |= int(getattr(imgui.Key, f"mod_{modifier}"))
    context.key_press(chord)
    context.yield_(2)
