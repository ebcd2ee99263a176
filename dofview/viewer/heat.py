"""Where a picture errs: its difference from the reference as colours that people of all colour vision tell apart."""

from __future__ import annotations

from enum import StrEnum
from typing import TYPE_CHECKING

from imgui_bundle import imgui
from pydantic import BaseModel, ConfigDict, Field

from dofview.gl.passes import draw
from dofview.gl.targets import Image
from dofview.viewer.actions import Action
from dofview.viewer.measurement import Measurement
from dofview.viewer.tool import Part, Placed, Rect, Tool
from dofview.viewer.truth import REFERENCE, Truth
from dofview.viewer.widgets import edit

if TYPE_CHECKING:
    from dofview.viewer.app import App

LEGEND_PX = 256


class Difference(StrEnum):
    """Kinds of difference, of sRGB values 0…1 as they are measured; mean over the channels."""

    ABSOLUTE = "absolute"
    SQUARED = "squared"
    RELATIVE = "relative"
    SIGNED = "signed"


class HeatSettings(BaseModel):
    """How an error is shown."""

    model_config = ConfigDict(frozen=True, allow_inf_nan=False)

    difference: Difference = Field(
        default=Difference.ABSOLUTE, description="|a - b|, (a - b)², |a - b| / b, or a - b, of sRGB values 0 to 1."
    )
    gain: float = Field(default=4.0, ge=0.25, le=1024.0, description="The colour scale ends at 1 / gain.")


class Heat(Tool):
    """Shows a map of the error against the reference in place of pictures."""

    title = "Error map"

    def __init__(self) -> None:
        self.on = False
        self.settings = HeatSettings()
        self._legend: tuple[object, Image] | None = None

    def actions(self) -> tuple[Action, ...]:
        return (
            Action("Error map", int(imgui.Key.e), "E", "Show where the picture differs from the reference.",
                   lambda app: self._toggle(), "Compare"),
        )  # fmt: skip

    def covers(self, name: str) -> bool:
        """Whether the picture of a method is shown as a map of its error."""
        return self.on and name != REFERENCE

    def draw(self, app: App, image: Image, reference: Image, into: Image) -> None:
        """Draw the map of `image` into an 8-bit image of its size."""
        draw(
            app.gpu, "viewer/heat.frag", into, textures={"first": image, "second": reference},
            blocks={"Heat": self.settings},
        )  # fmt: skip

    def update(self, app: App) -> None:
        if not self.covers(app.settings.method):
            return
        legend = app.gpu.targets.image("heat legend", (LEGEND_PX, 1), dtype="f1", linear=True)
        if self._legend != (self.settings, legend):
            draw(app.gpu, "viewer/heat.frag", legend, blocks={"Heat": self.settings}, defines={"LEGEND": 1})
            self._legend = self.settings, legend

    def draw_picture(self, app: App, rect: Rect, draw_list: imgui.ImDrawList) -> bool:
        from dofview.viewer.pictures import Pictures

        if not self.covers(app.settings.method) or app.result is None:
            return False
        shown = app.tool(Pictures).shown(app, app.settings.method)
        if shown is None:
            return False
        rect.draw(draw_list, shown)
        app.placed += [
            Placed(app.settings.method, app.result.image, rect),
            Placed("reference", app.tool(Truth).picture(app), rect),
        ]
        return True

    def over_picture(self, app: App, rect: Rect, hovered: bool) -> bool:
        if self.covers(app.settings.method) and self._legend is not None:
            self._draw_legend(app)
        return False

    def panel(self, app: App) -> None:
        self.on = imgui.checkbox("error against the reference##heat", self.on)[1]
        self.settings = edit(self.settings)

    def _toggle(self) -> None:
        self.on = not self.on

    def _draw_legend(self, app: App) -> None:
        """The scale at the lower left of the window with its ends in words, and what the reference can support."""
        assert self._legend is not None
        size, draw_list = imgui.get_font_size(), imgui.get_window_draw_list()
        position, extent = imgui.get_window_pos(), imgui.get_window_size()
        left, bottom = position.x + 0.8 * size, position.y + extent.y - 2.6 * size
        width = min(20.0 * size, extent.x - 2 * size)
        quality = app.tool(Truth).quality
        lines = (
            f"{self.settings.difference.value} error against the reference",
            Measurement(0.0, quality).reference_text(),
        )
        draw_list.add_rect_filled(
            (left - 0.4 * size, bottom - 4.9 * size), (left + width + 0.4 * size, bottom + 0.3 * size), 0xC0101010
        )
        for number, line in enumerate(lines):
            draw_list.add_text(
                (left, bottom - (4.7 - 1.2 * number) * size), 0xFFFFFFFF if number == 0 else 0xFFA0A0A0, line
            )
        Rect(left, bottom - 2.2 * size, width, 0.9 * size, Part()).draw(draw_list, self._legend[1])
        end = 1.0 / self.settings.gain
        ends = (f"-{end:.3g}", f"+{end:.3g}") if self.settings.difference == Difference.SIGNED else ("0", f"{end:.3g}")
        draw_list.add_text((left, bottom - 1.1 * size), 0xFFFFFFFF, ends[0])
        draw_list.add_text((left + width - imgui.calc_text_size(ends[1]).x, bottom - 1.1 * size), 0xFFFFFFFF, ends[1])
