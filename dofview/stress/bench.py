"""Renders the many small pictures that a row asks for."""

from __future__ import annotations

from typing import Any

import numpy as np

from dofview.gl.context import Gpu
from dofview.lens import Distribution, Lens
from dofview.pipeline import Pipeline
from dofview.scene.camera import Camera
from dofview.scene.model import Scene
from dofview.settings import ImageSettings, Settings

CAMERA = Camera(position=(0.0, 0.0, 5.0), target=(0.0, 0.0, 0.0), vfov_deg=40.0)
GAUSSIAN = ("layered", "pyramid", "mipmap")
"""Methods whose blur is a Gaussian by nature; their sizes are measured under a Gaussian lens."""


class Bench:
    """One context, one size of picture, one scene at a time."""

    def __init__(self, gpu: Gpu, size: int = 256, views: int = 64):
        self.gpu = gpu
        self.size = size
        self.views = views
        self._pipeline: Pipeline | None = None
        self._scene: Scene | None = None

    def settings(
        self, method: str, lens: Lens, camera: Camera = CAMERA, size: tuple[int, int] | None = None,
        background: float = 0.0, views: int | None = None, **image: Any,
    ) -> Settings:  # fmt: skip
        """Settings for a square picture of the bench's size; the reference gets `views`, or the bench's number."""
        settings = Settings(
            camera=camera, lens=lens, method=method, background_linear=(background,) * 3,
            image=ImageSettings(size=size or (self.size, self.size), **image),
        )  # fmt: skip
        return settings.with_params(views=views or self.views) if method == "accumulation" else settings

    def picture(self, scene: Scene, settings: Settings) -> np.ndarray:
        """(h, w, 3) linear; the scene is uploaded once while it is the same object."""
        return self.pipeline(scene).render(settings).pixels()

    def pipeline(self, scene: Scene) -> Pipeline:
        """The pipeline holding `scene`."""
        if self._pipeline is None:
            self._pipeline, self._scene = Pipeline(self.gpu, scene), scene
        elif self._scene is not scene:
            self._pipeline.load(scene)
            self._scene = scene
        return self._pipeline

    def release(self) -> None:
        if self._pipeline is not None:
            self._pipeline.release()
            self._pipeline = None


def lens_for(method: str, radius: float, focus: float) -> Lens:
    """A disc for methods that draw discs, the Gaussian of the same RMS width for those that draw Gaussians."""
    kind = Distribution.GAUSSIAN if method in GAUSSIAN else Distribution.UNIFORM_DISC
    return Lens(radius=radius, focus_distance=focus, distribution=kind)
