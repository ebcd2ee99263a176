"""A picture with transparency: how much of the background comes through each pixel, found by changing the background.

With the background B the picture is C = F + B (1 − α); with B + 1 it is C + (1 − α). One rendering more gives α and the
colour F of what is there, of any method and of the reference, blurred edges included (difference matting: Smith, Blinn,
Blue Screen Matting, 1996).
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from dofview.errors import InputError
from dofview.remember import note
from dofview.render.display import show
from dofview.viewer import files
from dofview.viewer.measurement import add_views
from dofview.viewer.truth import REFERENCE

if TYPE_CHECKING:
    from dofview.viewer.app import App

CLEAR = 1.0 / 512.0
"""Of what covers less than this nothing is seen in 8 bits."""


class Matte:
    """The picture shown when it was made, on its way to a PNG with transparency."""

    def __init__(self, app: App, path: Path | None):
        assert app.result is not None
        self._settings, self._path = app.settings, path
        self._spec, self._generation = app.spec, app.generation
        self._picture = app.result.pixels()
        other = tuple(value + 1.0 for value in app.settings.background_linear)
        if max(other) > 1e4:
            raise InputError("the background is too bright for a transparent picture; accepted: up to 9999")
        self._other = app.settings.with_(background_linear=other)
        self._views = app.accumulated.quality.views if app.settings.method == REFERENCE else 0
        self.progress = 0.0
        self._brighter: np.ndarray | None = None

    def advance(self, app: App) -> bool:
        """Work for a part of a frame; True when it is done. InputError when the scene has gone."""
        if app.generation != self._generation:
            raise InputError("another scene was opened: the transparent picture was not saved")
        if not self._views:
            self._brighter = app.pipeline.render(self._other, "matte", ends_frame=False).pixels()
            return True
        antialias = self._other.params.accumulation.antialias
        reference = app.pipeline.reference(self._other, antialias=antialias)
        add_views(app, reference, self._views - reference.views)
        self.progress = reference.views / self._views
        if reference.views < self._views:
            return False
        image = app.pipeline.reference_picture(self._other, antialias=antialias, name="matte")
        self._brighter = np.ascontiguousarray(image.pixels()[..., :3])
        return True

    def save(self, app: App) -> Path:
        """Write the PNG and return its name."""
        assert self._brighter is not None
        through = np.clip((self._brighter - self._picture).mean(axis=-1, keepdims=True), 0.0, 1.0)
        alpha = 1.0 - through
        colour = self._picture - np.asarray(self._settings.background_linear, np.float32) * through
        colour = np.where(alpha > CLEAR, np.maximum(colour, 0.0) / np.maximum(alpha, CLEAR), 0.0)
        image = app.gpu.targets.image("matte", (alpha.shape[1], alpha.shape[0]))
        image.write(np.concatenate([colour, alpha], axis=-1).astype(np.float32))
        shown = show(app.gpu, image, self._settings.display, "matte shown").pixels()[..., :3]
        pixels = np.concatenate([shown, np.rint(alpha * 255.0).astype(np.uint8)], axis=-1)
        return files.save_png(pixels, self._path, note(self._spec, self._settings))
