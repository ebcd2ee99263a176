"""Reads a scene anew when one of its files changes: a thread waits on their folders and wakes the window."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from imgui_bundle import imgui

from dofview.viewer.actions import CTRL, SHIFT, Action
from dofview.viewer.tool import Tool

if TYPE_CHECKING:
    from dofview.viewer.app import App

QUIET_MS = 300
"""Files that change again within this are still being written."""

LONGEST_MS = 5000
NOTICE_STOP_MS = 500


class Watching(Tool):
    """Follows the files of the scene shown."""

    def __init__(self) -> None:
        self.on = True
        self._watch: Watch | None = None
        self._files: tuple[str, ...] = ()

    def actions(self) -> tuple[Action, ...]:
        return (
            Action("Follow changes of the file", CTRL | SHIFT | int(imgui.Key.r), "Ctrl+Shift+R",
                   "Read the scene again whenever its files change, or no longer.", self._toggle, "File"),
        )  # fmt: skip

    def update(self, app: App) -> None:
        files = app.scene.files if self.on else ()
        if files != self._files:
            self.release()
            self._files = files
            self._watch = Watch(files, app.wake) if files else None
        if self._watch is not None and self._watch.take():
            app.open(app.spec, keep_view=True)

    def busy(self, app: App) -> bool:
        return self._watch is not None and self._watch.changed.is_set()

    def release(self) -> None:
        if self._watch is not None:
            self._watch.stop.set()
            self._watch = None

    def _toggle(self, app: App) -> None:
        self.on = not self.on
        app.report("following changes of the file" if self.on else "no longer following changes of the file")


class Watch:
    """Sets `changed` and calls `wake` when one of `files` has changed and is written. Folders are watched, since most
    programs put a new file in the place of the old."""

    def __init__(self, files: Iterable[str], wake: Callable[[], None]):
        self.changed, self.stop = threading.Event(), threading.Event()
        self._files = {str(Path(file).absolute()) for file in files}
        self._wake = wake
        threading.Thread(target=self._run, name="watch", daemon=True).start()

    def take(self) -> bool:
        """Whether there was a change since the last call."""
        changed = self.changed.is_set()
        self.changed.clear()
        return changed

    def _run(self) -> None:
        import watchfiles

        folders = {str(Path(file).parent) for file in self._files}
        try:
            for changes in watchfiles.watch(
                *folders, recursive=False, stop_event=self.stop, step=QUIET_MS, debounce=LONGEST_MS,
                rust_timeout=NOTICE_STOP_MS, watch_filter=self._concerns, raise_interrupt=False,
            ):  # fmt: skip
                # A file that is away for a moment is being replaced.
                if any(Path(path).exists() for _, path in changes):
                    self.changed.set()
                    self._wake()
        except OSError:
            # A folder that cannot be watched, or is gone, is read again by hand.
            return

    def _concerns(self, change: object, path: str) -> bool:
        return path in self._files
