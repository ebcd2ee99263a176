"""The live comparison with the reference: PSNR as it accumulates, never without the reference's own confidence."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass
from typing import TYPE_CHECKING

from imgui_bundle import imgui

from dofview.render.reference import Quality, Reference
from dofview.viewer.actions import Action
from dofview.viewer.tool import Rect, Tool

if TYPE_CHECKING:
    from dofview.viewer.app import App

MARGIN_DB = 6.0
"""A method's PSNR within this of the reference's own estimate says more of the reference than of the method."""

FRAME_BUDGET_S = 0.03


@dataclass(frozen=True)
class Measurement:
    """PSNR in dB of the picture shown against the reference so far."""

    psnr: float = 0.0
    quality: Quality = Quality(0, 0.0)
    target_db: float = 50.0
    most_views: int = 4096

    @property
    def done(self) -> bool:
        """Whether more views would not change what is shown."""
        return self.quality.views >= self.most_views or self.quality.self_psnr >= self.target_db

    @property
    def trustworthy(self) -> bool:
        """Whether the reference supports the number: its own error is well below the difference."""
        return self.quality.self_psnr >= self.psnr + MARGIN_DB or (math.isinf(self.psnr) and self.done)

    @property
    def progress(self) -> float:
        """0 to 1 on the way to the target quality, dB over dB."""
        return min(max(self.quality.self_psnr / self.target_db, self.quality.views / self.most_views), 1.0)

    def psnr_text(self) -> str:
        """The number as it is shown."""
        return f"PSNR {self.psnr:.2f} dB" if math.isfinite(self.psnr) else "PSNR: equal"

    def reference_text(self) -> str:
        """What stands beside every number."""
        return f"reference: {self.quality.views} views, vouches for {self.quality.self_psnr:.1f} dB"


def add_views(app: App, reference: Reference) -> None:
    """Render views into the reference for a part of a frame's time, at least one."""
    start = time.perf_counter()
    while True:
        reference.add(1)
        app.scene_renders += 1
        app.gpu.ctx.finish()
        if time.perf_counter() - start >= FRAME_BUDGET_S:
            return


class Measure(Tool):
    """Compares the picture with the progressive reference until that vouches for its target."""

    title = "Measurement"
    opened = True

    def __init__(self) -> None:
        self.on = False
        self.antialias = False
        self.measurement = Measurement()
        self._of: object = None

    def actions(self) -> tuple[Action, ...]:
        return (
            Action("Compare with the reference", int(imgui.Key.r), "R",
                   "Measure PSNR against the reference as it accumulates.", lambda app: self.toggle()),
        )  # fmt: skip

    def toggle(self) -> None:
        """Switch the comparison."""
        self.on = not self.on

    def update(self, app: App) -> None:
        if not self._active(app):
            return
        of = (app.picture_key, self.antialias)
        if of != self._of:
            self._of, self.measurement = of, Measurement()
        if self.measurement.done or app.result is None:
            return
        reference = app.pipeline.reference(app.settings, antialias=self.antialias)
        add_views(app, reference)
        if reference.quality().views != self.measurement.quality.views:
            psnr, quality = app.pipeline.compare(app.result, app.settings, antialias=self.antialias)
            self.measurement = Measurement(psnr, quality)

    def busy(self, app: App) -> bool:
        return self._active(app) and not self.measurement.done

    def over_picture(self, app: App, rect: Rect, hovered: bool) -> bool:
        if self._active(app):
            app.figure(self.measurement.psnr_text(), faint=not self.measurement.trustworthy)
            app.figure(self.measurement.reference_text(), faint=True)
        return False

    def panel(self, app: App) -> None:
        self.on = imgui.checkbox("compare with the reference##measuring", self.on)[1]
        self.antialias = imgui.checkbox("antialiased reference##antialias", self.antialias)[1]
        if imgui.is_item_hovered(imgui.HoveredFlags_.for_tooltip):
            imgui.set_tooltip("Methods are not antialiased by themselves: compare with render scale 2.")
        if not self._active(app):
            return
        if self.measurement.trustworthy:
            imgui.text(self.measurement.psnr_text())
        else:
            imgui.text_disabled(self.measurement.psnr_text())
        imgui.text_disabled(self.measurement.reference_text())
        imgui.progress_bar(self.measurement.progress, (-1.0, 0.0), "")

    def _active(self, app: App) -> bool:
        return self.on and app.settings.method != "accumulation"
