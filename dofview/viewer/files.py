"""Files in and out of the viewer: dialogs, scenes with their views, pictures."""

from __future__ import annotations

import shutil
import sys
import time
from datetime import datetime
from pathlib import Path

import numpy as np

from dofview.errors import OutputError
from dofview.export import write_png8, write_whole
from dofview.framing import opening
from dofview.scene.load import load
from dofview.scene.model import Scene
from dofview.settings import Settings

POLL_S = 0.05


def has_dialog() -> bool:
    """Whether the desktop offers a file dialog; without one portable_file_dialogs answers like Cancel."""
    return not sys.platform.startswith("linux") or any(shutil.which(name) for name in ("zenity", "kdialog"))


def ask() -> str | None:
    """Return a file the person chose, or None. Waits, so it is called from a thread."""
    from imgui_bundle import portable_file_dialogs

    kinds = ["Scenes", "*.glb *.gltf *.obj *.ply *.stl *.off", "All files", "*"]
    dialog = portable_file_dialogs.open_file("Open", "", kinds)
    # Its own way of waiting would hold up every other thread.
    while not dialog.ready(0):
        time.sleep(POLL_S)
    chosen = dialog.result()
    return chosen[0] if chosen else None


def scene_and_view(spec: str, settings: Settings) -> tuple[Scene, Settings]:
    """Load a scene and the view it opens with."""
    scene = load(spec)
    return scene, opening(scene, spec, settings)


def save_png(pixels: np.ndarray, path: Path | None = None, note: str = "") -> Path:
    """Save (h, w, 3 or 4) 8-bit `pixels` as PNG, whole or not at all, never over a file nobody named."""
    path = path or unused_name(".png")
    write_whole(path, lambda part: write_png8(part, np.ascontiguousarray(pixels), note))
    return path


def unused_name(suffix: str, what: str = "dofview") -> Path:
    """A new name in the working folder that says when it was made."""
    stamp = datetime.now().strftime("%Y-%m-%d-%H%M%S")
    for number in range(1000):
        path = Path.cwd() / f"{what}-{stamp}{f'-{number}' if number else ''}{suffix}"
        if not path.exists():
            return path
    raise OutputError(f"{Path.cwd()}: no unused name for a {suffix} file")
