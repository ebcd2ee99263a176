"""Runs the viewer's interface inside imgui's test engine, in a process of its own."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

sys.path[:0] = [str(Path(__file__).parents[2]), str(Path(__file__).parents[1])]

from imgui_bundle import imgui  # noqa: E402, I001
from imgui_bundle.immapp import testing  # noqa: E402
import moderngl  # noqa: E402
from scenes import three_planes  # noqa: E402

from dofview.framing import opening  # noqa: E402
from dofview.gl.context import Gpu  # noqa: E402
from dofview.settings import ImageSettings, Settings  # noqa: E402
from dofview.viewer.app import App  # noqa: E402

Context = imgui.test_engine.TestContext


def drive(test: Callable[[Context, App], None], size: tuple[int, int] = (560, 480)) -> None:
    """Show the viewer on a small scene and let `test` use it; an assertion or engine error ends with status 1."""
    app: list[App] = []

    def gui() -> None:
        if not app:
            scene = three_planes()
            settings = opening(scene, "", Settings(method="pinhole", image=ImageSettings(size=(64, 48))))
            app.append(App(Gpu(moderngl.create_context()), scene, settings))
        app[0].gui()
        app[0].gpu.ctx.screen.use()
        assert app[0].gpu.ctx.error == "GL_NO_ERROR"

    testing.run(gui, lambda context: test(context, app[0]), window_size=size, fps_idle=0.0)
