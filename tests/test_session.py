"""A whole session in the real window under a virtual screen."""

from __future__ import annotations

from pathlib import Path

import pytest
from real_window import Window, screen, tools_missing
from session import Session

from dofview.gl.context import Gpu
from dofview.viewer.store import Store

SIZE = (640, 440)


@pytest.mark.window
def test_a_session_by_mouse_and_keyboard(session_gpu: Gpu, tmp_path: Path):
    """Open, focus, gaze, switch, wipe, error map, measure all, save, record, reopen, quit."""
    if tools_missing():
        pytest.skip(f"no {tools_missing()} on this machine")
    home, folder = tmp_path / "home", tmp_path / "work"
    home.mkdir()
    folder.mkdir()
    with screen(home) as environment:
        window = Window(environment, folder, SIZE, "demo:rail", "--method", "mipmap")
        try:
            session = Session(window, session_gpu, "demo:crossing", (0.15, 0.35), (0.45, 0.75))
            session.run()
            session.pipeline.release()
            assert window.quit() == 0
            assert window.complaints() == ""
        finally:
            window.close()
    (state,) = home.rglob("viewer.json")
    assert Store(state).saved.recent == ("demo:crossing", "demo:rail")
