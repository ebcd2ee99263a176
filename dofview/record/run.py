"""Renders the frames of a path and writes them, encoding beside rendering through a short queue."""

from __future__ import annotations

import queue
import threading
from collections.abc import Callable
from pathlib import Path

import numpy as np

from dofview.errors import SettingsError
from dofview.pipeline import Pipeline
from dofview.record.paths import Path_
from dofview.record.writers import Writer, writer
from dofview.seen import headless
from dofview.seen.model import Seen
from dofview.settings import Settings

QUEUE_FRAMES = 8
"""Frames that may wait for the encoder; a slow one then slows the renderer, not the memory."""


class Encoder:
    """A writer in a thread of its own. What it raises comes out of `add` or `close`."""

    def __init__(self, target: Writer):
        self._target = target
        self._frames: queue.Queue[np.ndarray | None] = queue.Queue(QUEUE_FRAMES)
        self._error: BaseException | None = None
        self._thread = threading.Thread(target=self._work, name="encoder", daemon=True)
        self._thread.start()

    def add(self, pixels: np.ndarray) -> None:
        """Hand over a frame; waits while the queue is full."""
        self._raise()
        self._frames.put(pixels)

    def close(self) -> None:
        """Wait for the last frame and finish the file."""
        self._frames.put(None)
        self._thread.join()
        self._raise()
        self._target.close()

    def abandon(self) -> None:
        """Stop; what was written stays as it is."""
        self._frames.put(None)
        self._thread.join()
        self._target.abandon()

    def _work(self) -> None:
        while (pixels := self._frames.get()) is not None:
            if self._error is None:
                try:
                    self._target.add(pixels)
                except BaseException as error:
                    self._error = error

    def _raise(self) -> None:
        if self._error is not None:
            raise self._error


def frame_count(seconds: float, fps: float) -> int:
    """Frames of a film, exactly round(duration × fps)."""
    if not 0.0 < fps <= 1000.0:
        raise SettingsError(f"fps is {fps:g}; accepted: a number above 0, up to 1000")
    count = round(seconds * fps) if 0.0 < seconds < 1e6 else 0
    if count < 1:
        raise SettingsError(f"{seconds:g} seconds at {fps:g} frames a second is no film; accepted: a frame or more")
    return count


def record(
    pipeline: Pipeline, path: Path_, frames: int, output: Path, fps: float,
    on_frame: Callable[[int], None] = lambda frame: None, seen: Seen | None = None,
) -> None:  # fmt: skip
    """Render `frames` frames of `path` into the film `output`: pictures, or what is `seen` of them.

    Broken off, what was written stays playable.

    A film shows what the screen does, exposure and tone curve included; EXR pictures are linear light.
    """
    size = path(0).image.size
    linear = output.suffix.lower() == ".exr"
    encoder = Encoder(writer(output, size, fps))
    try:
        for frame in range(frames):
            settings = path(frame)
            encoder.add(_pixels(pipeline, settings, seen, linear))
            on_frame(frame + 1)
    except BaseException:
        encoder.abandon()
        raise
    encoder.close()


def _pixels(pipeline: Pipeline, settings: Settings, seen: Seen | None, linear: bool) -> np.ndarray:
    if seen is not None:
        return np.ascontiguousarray(headless.picture(pipeline, settings, seen, linear=linear).pixels()[..., :3])
    result = pipeline.render(settings)
    return result.pixels() if linear else pipeline.shown(result, settings)
