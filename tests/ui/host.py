"""Runs the viewer's interface inside imgui's test engine, in a process of its own."""

from __future__ import annotations

import sys
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
from dofview.viewer.store import Interface  # noqa: E402

Context = imgui.test_engine.TestContext


class Host:
    """The viewer on a small scene. The engine runs a test in a thread without OpenGL, so pictures are read for it."""

    def __init__(self) -> None:
        self.app: App | None = None
        self._wanted = False
        self._pixels = np.zeros(0)

    def frame(self) -> None:
        """One frame of the interface."""
        if self.app is None:
            settings = Settings(method="pinhole", image=ImageSettings(size=(64, 48)))
            scene = three_planes()
            self.app = App(Gpu(moderngl.create_context()), scene, opening(scene, "", settings))
            self.app.interface = Interface(reduced_motion=True)
        self.app.gui()
        if self._wanted and self.app.shown is not None:
            self._pixels, self._wanted = self.app.shown.pixels()[..., :3].astype(float), False
        self.app.gpu.ctx.screen.use()
        assert self.app.gpu.ctx.error == "GL_NO_ERROR"

    def pixels(self, context: Context) -> np.ndarray:
        """The picture shown after a few frames, (h, w, 3)."""
        context.yield_(3)
        self._wanted = True
        while self._wanted:
            context.yield_()
        return self._pixels


def drive(test: Callable[[Context, App, Host], None], size: tuple[int, int] = (560, 480)) -> None:
    """Show the viewer and let `test` use it; a failed assertion or engine error is raised."""
    host = Host()
    params = hello_imgui.RunnerParams()
    params.callbacks.show_gui = host.frame
    params.app_window_params.window_geometry.size = size
    params.imgui_window_params.default_imgui_window_type = hello_imgui.DefaultImGuiWindowType.no_default_window
    params.fps_idling.enable_idling = False
    params.ini_disable = True
    testing.run(test_function=lambda context: test(context, host.app, host), runner_params=params)
