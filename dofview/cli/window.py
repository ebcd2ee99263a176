"""`dofview [SCENE]`: everything that can be refused without a window is, then the viewer opens."""

from __future__ import annotations

import logging
from pathlib import Path

from dofview.cli.chosen import applied, settings_for
from dofview.cli.facts import screen
from dofview.cli.flags import Given
from dofview.errors import GLError, OutputError
from dofview.gl.context import REMEDY
from dofview.scene.load import load
from dofview.settings import Settings


def open_window(
    spec: str, given: Given, *, view: Path | None, method: str | None, camera: str | None, safe: bool = False,
    log: Path | None = None,
) -> None:  # fmt: skip
    """Open the viewer on a scene; GLError where there is no screen to open it on.

    It is shown as it was last seen, unless something was asked for that would be lost by that. A size that was asked
    for is the window's.
    """
    if screen() is None:
        raise GLError(
            "no screen for a window (neither DISPLAY nor WAYLAND_DISPLAY is set); "
            "without one: dofview render SCENE -o picture.png, dofview compare SCENE, or xvfb-run dofview"
        )
    applied(Settings(), given, view=view, method=method)
    scene = load(spec)
    settings = settings_for(scene, spec, given, view=view, method=method, camera=camera)
    if log is not None:
        _write_log(log)
    from dofview import viewer

    try:
        size = settings.image.size if "size" in given.get("image", {}) else None
        asked = view is not None or camera is not None or bool(given.keys() & {"lens", "photo", "light"})
        viewer.run(scene, settings, spec, restore=not asked, safe=safe, size=size)
    except ModuleNotFoundError:
        raise
    except ImportError as error:
        # The window's libraries are there but not what they are linked with: a machine without libGL or libX11.
        raise GLError(f"cannot open a window ({error}); {REMEDY}") from error


def _write_log(path: Path) -> None:
    """Let what the viewer says go to `path`, too: a line each with the seconds since the start."""
    try:
        handler = logging.FileHandler(path, mode="w", encoding="utf-8")
    except OSError as error:
        raise OutputError(f"cannot write {path}: {(error.strerror or str(error)).lower()}") from error
    handler.setFormatter(_Line())
    log = logging.getLogger("dofview.viewer")
    log.setLevel(logging.INFO)
    log.propagate = False
    log.addHandler(handler)


class _Line(logging.Formatter):
    """Seconds since the start and the message, in one line whatever it holds."""

    def format(self, record: logging.LogRecord) -> str:
        return f"{record.relativeCreated / 1e3:9.3f}  " + record.getMessage().replace("\n", " ")
