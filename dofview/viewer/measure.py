"""The live comparison with the reference: PSNR as it accumulates, never without the reference's own confidence."""

from __future__ import annotations

from typing import TYPE_CHECKING

from imgui_bundle import imgui

from dofview.render.compare import psnr
from dofview.viewer.actions import Action
from dofview.viewer.measurement import Measurement
from dofview.viewer.tool import Rect, Tool
from dofview.viewer.truth import REFERENCE, Truth, match_panel

if TYPE_CHECKING:
    from dofview.viewer.app import App


class Measure(Tool):
    """Compares the picture with the progressive reference until that vouches for its target."""

    title = "Measurement"
    opened = True

    def __init__(self) -> None:
        self.on = False
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
        truth = app.tool(Truth)
        if app.result is None:
            return
        of = (app.picture_key, truth.key(app))
        if of != self._of:
            self._of, self.measurement = of, Measurement()
        quality = truth.advance(app)
        if quality.views != self.measurement.quality.views:
            self.measurement = Measurement(psnr(app.gpu, app.result.image, truth.picture(app)), quality)

    def busy(self, app: App) -> bool:
        return self._active(app) and not app.tool(Truth).done(app)

    def over_picture(self, app: App, rect: Rect, hovered: bool) -> bool:
        if self._active(app):
            app.figure(self.measurement.psnr_text(), faint=not self.measurement.trustworthy)
            app.figure(self.measurement.reference_text(), faint=True)
        return False

    def panel(self, app: App) -> None:
        self.on = imgui.checkbox("compare with the reference##measuring", self.on)[1]
        match_panel(app, app.tool(Truth))
        if not self._active(app):
            return
        if self.measurement.trustworthy:
            imgui.text(self.measurement.psnr_text())
        else:
            imgui.text_disabled(self.measurement.psnr_text())
        imgui.text_disabled(self.measurement.reference_text())
        imgui.progress_bar(self.measurement.progress, (-1.0, 0.0), "")

    def _active(self, app: App) -> bool:
        return self.on and app.settings.method != REFERENCE
