"""A film on its way: its frames out of the window or along a path, its time, its file."""

from __future__ import annotations

import logging
import time
from enum import StrEnum
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from dofview.errors import DofviewError
from dofview.gl.compose import fitted
from dofview.gl.targets import Image
from dofview.metrics import srgb_decode
from dofview.record.paths import Path_
from dofview.record.run import Encoder
from dofview.record.writers import writer
from dofview.seen import headless
from dofview.viewer.screen import seen_of

if TYPE_CHECKING:
    from dofview.viewer.app import App

log = logging.getLogger("dofview.viewer")


class Shows(StrEnum):
    """What a film shows."""

    SEEN = "what is seen, without panels"
    PICTURE = "the picture alone"
    WINDOW = "the whole window"


class Filming:
    """Frames of one size into one file. A window that changes its size is fitted in; a path keeps the size.

    Time is frame / fps: `clock` stands while a frame is made, however long that takes, and no frame comes sooner than
    1 / fps after the one before, so that a fast machine's film is not slower than what was lived.
    """

    def __init__(self, app: App, film: Path, shows: Shows, fps: int, plan: Path_ | None = None, planned: int = 0):
        self.film, self.frames, self.planned, self.fps = film, 0, planned, fps
        self._shows, self._plan = shows, plan
        self._linear = film.suffix.lower() == ".exr"
        self._image, self._seen = app.settings.image, seen_of(app)
        self._size = app.window_size if shows is Shows.WINDOW and plan is None else self._image.size
        self._began = self._due = time.monotonic()
        self._ended = False
        self._failed: DofviewError | None = None
        self._encoder = Encoder(writer(film, self._size, fps))

    @property
    def seconds(self) -> float:
        """How long the film is by now."""
        return self.frames / self.fps

    @property
    def done(self) -> bool:
        """Whether a path was gone to its end."""
        return self._plan is not None and self.frames >= self.planned

    def clock(self) -> float:
        """The time that counts while what is seen is filmed, seconds."""
        return self._began + self.seconds

    def along(self, app: App) -> None:
        """Render the next frame of the path; nothing without one."""
        if self._plan is None:
            return
        for image in (app.shown, app.result.image if app.result else None):
            if image is not None:
                app.gpu.targets.touch(image)
        settings = self._plan(self.frames).with_(image=self._image)
        if self._shows is Shows.PICTURE:
            result = app.pipeline.render(settings, "film")
            self._add(result.pixels() if self._linear else app.pipeline.shown(result, settings))
        else:
            self._add(headless.picture(app.pipeline, settings, self._seen, linear=self._linear).pixels())

    def live(self, app: App, image: Image) -> None:
        """Take `image`, what is seen in this frame, when it is time for it; nothing along a path."""
        if self._failed is not None:
            raise self._failed
        now = time.monotonic()
        if self._plan is not None or now < self._due or app.result is None or app.shown is None:
            return
        self._due = max(self._due, now - 1.0) + 1.0 / self.fps
        match self._shows:
            case Shows.WINDOW:
                app.when_drawn.append(partial(self._add_window, app))
            case Shows.PICTURE:
                self._add(self._fitted(app, app.result.image if self._linear else app.shown))
            case _:
                self._add(self._fitted(app, app.screen.linear(app) if self._linear else image))
        if self.frames % self.fps == 0:
            log.info("film: %d s", self.frames // self.fps)

    def close(self) -> None:
        """Finish the file; OutputError when it cannot be."""
        self._ended = True
        self._encoder.close()

    def abandon(self) -> None:
        """Stop; what was written of a film stays under the name of a part."""
        self._ended = True
        self._encoder.abandon()

    def _fitted(self, app: App, image: Image) -> np.ndarray:
        if image.size != self._size:
            image = fitted(app.gpu, image, self._size, "film fitted", linear=self._linear)
        return image.pixels()

    def _add_window(self, app: App, pixels: np.ndarray) -> None:
        if self._ended:
            return
        if (pixels.shape[1], pixels.shape[0]) != self._size:
            image = app.gpu.targets.image("film window", pixels.shape[1::-1], dtype="f1", linear=True)
            opaque = np.array(pixels)
            opaque[..., 3] = 255
            image.write(opaque)
            pixels = fitted(app.gpu, image, self._size, "film fitted").pixels()
        try:
            self._add(srgb_decode(pixels / np.float32(255.0)) if self._linear else pixels)
        except DofviewError as error:
            self._failed = error  # said in the next frame: nobody listens after this one is drawn

    def _add(self, pixels: np.ndarray) -> None:
        self._encoder.add(np.ascontiguousarray(pixels[..., :3]))
        self.frames += 1
