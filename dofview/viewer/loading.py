"""Scenes on their way: read in a thread, so that the window lives on; the last one asked for counts."""

from __future__ import annotations

import time
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from typing import NamedTuple

from dofview.scene.model import Scene
from dofview.settings import Settings
from dofview.viewer import files


class Loaded(NamedTuple):
    """A scene that was read from `spec`, and the settings it opens with; None where the view stays."""

    spec: str
    scene: Scene
    settings: Settings | None


class Loader:
    """Reads one scene at a time for whoever asks; `wake` is called when it is there."""

    def __init__(self, wake: Callable[[], None]):
        self._wake = wake
        # Two, since a reader that nobody waits for any more cannot be stopped.
        self._worker = ThreadPoolExecutor(max_workers=2, thread_name_prefix="load")
        self._wanted: Future[Loaded] | None = None
        self._began = 0.0
        self.spec = ""
        """What is being loaded; empty when nothing is."""

    def start(self, spec: str, settings: Settings, keep_view: bool) -> None:
        """Begin to read `spec`; what was being read is forgotten."""

        def read() -> Loaded:
            scene, opening = files.scene_and_view(spec, settings)
            return Loaded(spec, scene, None if keep_view else opening)

        self._began = time.monotonic()
        self.spec, self._wanted = spec, self._worker.submit(read)
        self._wanted.add_done_callback(lambda _: self._wake())

    def cancel(self) -> None:
        """Forget what is being read."""
        self.spec, self._wanted = "", None

    @property
    def seconds(self) -> float:
        """How long it has been reading."""
        return time.monotonic() - self._began

    @property
    def ready(self) -> bool:
        """Whether `take` has something to give or to raise."""
        return self._wanted is not None and self._wanted.done()

    def take(self) -> Loaded:
        """The scene that is ready; ModelError when it cannot be shown."""
        assert self._wanted is not None
        wanted = self._wanted
        self.cancel()
        return wanted.result()

    def release(self) -> None:
        """Stop waiting."""
        self.cancel()
        self._worker.shutdown(wait=False, cancel_futures=True)
