"""Where a picture errs: its difference from the reference as colours that people of all colour vision tell apart."""

from __future__ import annotations

from typing import TYPE_CHECKING

from imgui_bundle import imgui

from dofview.seen.model import HeatSettings
from dofview.viewer.actions import Action
from dofview.viewer.measurement import Measurement
from dofview.viewer.tool import Rect, Tool
from dofview.viewer.truth import REFERENCE, Truth
from dofview.viewer.widgets import edit

if TYPE_CHECKING:
    from dofview.viewer.app import App


class Heat(Tool):
    """Shows a map of the error against the reference in place of pictures."""

    title = "Error map"

    def __init__(self) -> None:
        self.on = False
        self.settings = HeatSettings()

    def actions(self) -> tuple[Action, ...]:
        return (
            Action("Error map", int(imgui.Key.e), "E", "Show where the picture differs from the reference.",
                   self._toggle, "Compare"),
        )  # fmt: skip

    def covers(self, name: str) -> bool:
        """Whether the picture of a method is shown as a map of its error."""
        return self.on and name != REFERENCE

    def over_picture(self, app: App, rect: Rect, hovered: bool) -> bool:
        if self.covers(app.settings.method):
            app.figure(Measurement(0.0, app.tool(Truth).quality).reference_text(), faint=True)
        return False

    def panel(self, app: App) -> None:
        self.on = imgui.checkbox("error against the reference##heat", self.on)[1]
        self.settings = edit(self.settings)

    def _toggle(self, app: App) -> None:
        self.on = not self.on
        app.sought = self.title if self.on else ""
