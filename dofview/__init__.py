"""Depth of field side by side: five published real-time methods and the accumulation reference they are judged by.

    scene = dofview.load("demo:foreground")
    picture = dofview.render(scene, method="mipmap")    # (height, width, 3) float32, linear light

Nothing heavy is imported before it is used. For many pictures make one `dofview.pipeline.Pipeline`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

# The package of that name is imported first: importing it later would put it in the place of the function.
import dofview.render  # noqa: F401

if TYPE_CHECKING:
    from pathlib import Path

    import numpy as np

    from dofview.scene.model import Scene
    from dofview.settings import Settings

__all__ = ["METHODS", "load", "render"]
__version__ = "0.1.0"


def load(spec: str | Path) -> Scene:
    """Load a glTF, OBJ, PLY, STL or OFF file or a "demo:NAME"; ModelError says in one line why it cannot."""
    from dofview.scene.load import load as load_scene

    return load_scene(spec)


def render(scene: Scene | str | Path, settings: Settings | None = None, **changes: Any) -> np.ndarray:  # noqa: F811
    """Render one picture without a window: (height, width, 3) float32 linear RGB, row 0 on top.

    `settings` is the scene's opening view when not given; `changes` are fields of `Settings` to change, as `method`.
    """
    from dofview.framing import opening
    from dofview.gl.context import create_headless
    from dofview.pipeline import Pipeline
    from dofview.scene.model import Scene

    loaded = scene if isinstance(scene, Scene) else load(scene)
    chosen = (settings or opening(loaded, str(loaded.source or scene))).with_(**changes)
    gpu = create_headless()
    try:
        return Pipeline(gpu, loaded).render(chosen).pixels()
    finally:
        gpu.release()
        gpu.ctx.release()


def __getattr__(name: str) -> Any:
    if name == "METHODS":
        from dofview.methods import METHODS

        return METHODS
    raise AttributeError(f"module 'dofview' has no attribute {name!r}")
