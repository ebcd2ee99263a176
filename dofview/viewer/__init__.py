"""The window: the only part that knows imgui and moderngl-window."""

from __future__ import annotations

from dofview.settings import Settings


def run(spec: str, settings: Settings) -> None:
    """Open a window on the scene `spec` with `settings` and return when it is closed."""
    from dofview.scene.load import load
    from dofview.viewer.window import run as run_window

    run_window(load(spec), settings, title=f"dofview — {spec}")
