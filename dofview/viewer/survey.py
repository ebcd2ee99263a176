"""Measure all: time and error of every method for the view in use, one rendering in a frame: the window lives."""

from __future__ import annotations

import math
import statistics
import time
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from imgui_bundle import imgui

from dofview.errors import DofviewError
from dofview.methods import METHODS, method
from dofview.render.compare import psnr
from dofview.render.reference import Quality
from dofview.viewer.actions import Action
from dofview.viewer.measurement import Measurement
from dofview.viewer.tool import Tool, Work
from dofview.viewer.truth import REFERENCE, Truth

if TYPE_CHECKING:
    from dofview.viewer.app import App

FRAMES = 5
"""Timed frames of each method, after one that compiles and allocates."""


@dataclass(frozen=True)
class Point:
    """One method: median of whole frames, ms, and PSNR, dB."""

    method: str
    ms: float
    psnr: float
    quality: Quality

    @property
    def trustworthy(self) -> bool:
        """Whether the reference supports the number."""
        return Measurement(self.psnr, self.quality).trustworthy

    def record(self) -> dict:
        """As `bench.pareto` takes it."""
        return {"method": self.method, "ms": self.ms, "psnr": self.psnr if math.isfinite(self.psnr) else None}


class Survey(Tool):
    """Renders every method a few times, first the reference as far as it is wanted."""

    def __init__(self) -> None:
        self.points: list[Point] = []
        self.of: object = None
        self._left: list[str] = []
        self._times: list[float] = []
        self._key: object = None
        self._found: list[Point] = []

    def actions(self) -> tuple[Action, ...]:
        return (
            Action("Measure all", int(imgui.Key.f7), "F7",
                   "Time every method and compare it with the reference, for this view.", self.start, "Compare"),
        )  # fmt: skip

    @property
    def running(self) -> bool:
        """Whether there are methods left to measure."""
        return bool(self._left)

    def progress(self, app: App) -> float:
        """0 to 1: half of it is the reference."""
        total = len(self._left) + len(self._found)
        steps = len(self._found) * (FRAMES + 1) + len(self._times)
        return 0.5 * app.tool(Truth).progress + 0.5 * steps / max(total * (FRAMES + 1), 1)

    def start(self, app: App) -> None:
        """Begin with this view; what it depends on must stay as it is."""
        able = (name for name in METHODS if app.gpu.version_code >= method(name).REQUIRES_GL)
        self._left = [name for name in able if name != REFERENCE]
        self._times, self._found, self._key = [], [], view(app)

    def cancel(self) -> None:
        """Leave it; what was there before stays."""
        self._left, self._found = [], []

    def update(self, app: App) -> None:
        if not self.running:
            return
        if view(app) != self._key:
            self.cancel()
            app.report("the view has changed: measuring all was stopped")
            return
        truth = app.tool(Truth)
        quality = truth.advance(app)
        if truth.done(app):
            self._step(app, truth, quality)

    def work(self, app: App) -> Iterable[Work]:
        if self.running:
            yield Work("measuring all", self.progress(app), self.cancel)

    def busy(self, app: App) -> bool:
        return self.running

    def outdated(self, app: App) -> bool:
        """Whether the points are of another view."""
        return self.of != view(app)

    def _step(self, app: App, truth: Truth, quality: Quality) -> None:
        """Render one method once, whole: nothing is kept from the frame before."""
        name, ctx = self._left[0], app.gpu.ctx
        app.pipeline.forget(reference=False)
        ctx.finish()
        start = time.perf_counter()
        try:
            result = app.pipeline.render(app.settings.with_(method=name), name="measured", ends_frame=False)
        except DofviewError as error:
            app.report(f"{name}: {error}")
            self._left, self._times = self._left[1:], []
            return
        ctx.finish()
        self._times.append((time.perf_counter() - start) * 1e3)
        app.scene_renders += 1
        if len(self._times) <= FRAMES:
            return
        decibels = psnr(app.gpu, result.image, truth.picture(app))
        self._found.append(Point(name, statistics.median(self._times[1:]), decibels, quality))
        self._left, self._times = self._left[1:], []
        if not self._left:
            self.points, self.of, self._found = self._found, self._key, []
            best = ", ".join(f"{point.method} {point.ms:.1f} ms {point.psnr:.1f} dB" for point in self.points)
            app.report(f"measured all: {best}")


def view(app: App) -> object:
    """What the points depend on: everything but the method in use and how it is displayed."""
    settings = app.settings
    # With the reference in use its own antialiasing counts, which `key` knows.
    return app.tool(Truth).key(app), settings.camera, settings.lens, settings.image, settings.params
