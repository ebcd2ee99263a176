"""The window: the only part that knows imgui and moderngl-window."""

from __future__ import annotations

from dofview.scene.model import Scene
from dofview.settings import Settings


def run(scene: Scene, settings: Settings, spec: str) -> None:
    """Open a window on `scene`, which was loaded from `spec`, with `settings` and return when it is closed."""
    from dofview.viewer.window import run as run_window

    run_window(scene, settings, title=f"dofview — {spec}")
