"""The window: the only part that knows imgui and moderngl-window."""

from __future__ import annotations

from dofview.scene.model import Scene
from dofview.settings import Settings


def run(
    scene: Scene, settings: Settings, spec: str, *, restore: bool = False, safe: bool = False,
    size: tuple[int, int] | None = None,
) -> None:  # fmt: skip
    """Open a window on `scene`, which was loaded from `spec`, with `settings` and return when it is closed.

    With `restore` the last view of the scene takes the place of camera, lens and light; with `safe` nothing that was
    saved is read or changed. `size` is the window's.
    """
    from dofview.viewer.store import Store, default_path
    from dofview.viewer.window import run as run_window

    store = Store(None if safe else default_path())
    run_window(scene, settings, spec, restore=restore and not safe, store=store, size=size)
