"""The method to take for a budget of time: the best of those on the Pareto front of this view, measured here.

What `measure all` finds decides. It is measured again when the view has changed much: another scene, a window of
another size, another parameter, or a blur, focus or distance that differs by half.
"""

from __future__ import annotations

import math
import time
from typing import TYPE_CHECKING, NamedTuple

from imgui_bundle import imgui
from pydantic import BaseModel, ConfigDict, Field

from dofview import fields
from dofview.bench.pareto import pick
from dofview.errors import InputError
from dofview.lens import focal_px
from dofview.methods import method
from dofview.viewer.actions import Action
from dofview.viewer.survey import Point, Survey
from dofview.viewer.tool import Tool
from dofview.viewer.widgets import edit

if TYPE_CHECKING:
    from dofview.viewer.app import App

MUCH = 1.5
"""A factor in blur, focus or distance from which on times and errors are others."""

REST_S = 1.0
"""The view must rest for this long before it is measured anew."""


class Budget(BaseModel):
    """What the picture may cost."""

    model_config = ConfigDict(frozen=True, allow_inf_nan=False)

    budget_ms: float = Field(
        default=33.0, ge=0.1, le=10000.0, json_schema_extra={"unit": "ms"},
        description="Longest time of a picture, milliseconds; the best method within it is taken.",
    )  # fmt: skip


class Scale(NamedTuple):
    """What times and errors depend on: values that must be equal, and sizes that may change a little."""

    equal: tuple[object, ...]
    sizes: tuple[float, ...]

    def far_from(self, other: Scale) -> bool:
        """Whether what was measured there says little here."""
        apart = (abs(math.log(max(a, 1e-9) / max(b, 1e-9))) for a, b in zip(self.sizes, other.sizes, strict=True))
        return self.equal != other.equal or max(apart) > math.log(MUCH)


class Auto(Tool):
    """Offers a method, or takes it by itself."""

    title = "Choice of method"

    def __init__(self) -> None:
        self.on = False
        self.budget = Budget()
        self.said = ""
        self._measured: Scale | None = None
        self._points: list[Point] = []
        self._asked: object = None
        self._rested: tuple[object, float] = (None, 0.0)
        self._taken: object = None

    def actions(self) -> tuple[Action, ...]:
        return (
            Action("Method by budget", int(imgui.Key.a), "A",
                   "Take the best method for the budget of time, measured for this view, or no longer.",
                   lambda app: self.switch(app, not self.on), "View"),
        )  # fmt: skip

    def switch(self, app: App, on: bool) -> None:
        """Choose by itself from now on, or no longer."""
        self.on, self._taken = on, None
        app.report("the method is chosen by the budget" if on else "the method is yours to choose")

    def update(self, app: App) -> None:
        survey = app.tool(Survey)
        if survey.points is not self._points and survey.points and not survey.outdated(app):
            self._points, self._measured = survey.points, scale_of(app)
        if not self.on or survey.running:
            return
        if self.stale(app):
            self._measure_when_at_rest(app, survey)
        elif self._taken != (wanted := (self.budget, id(self._points))):
            self._taken = wanted
            self._take(app)

    def busy(self, app: App) -> bool:
        return self.on and not app.tool(Survey).running and self.stale(app) and scale_of(app) != self._asked

    def stale(self, app: App) -> bool:
        """Whether there are no figures, or of another view."""
        return self._measured is None or scale_of(app).far_from(self._measured)

    def best(self) -> tuple[dict, str]:
        """The record to take and a sentence of it; InputError when nothing was measured."""
        if not self._points:
            raise InputError("nothing was measured yet")
        records = [point.record() for point in self._points]
        try:
            record, within = pick(records, budget_ms=self.budget.budget_ms), True
        except InputError:
            record, within = min(records, key=lambda r: r["ms"]), False
        decibels = "equal to the reference" if record["psnr"] is None else f"{record['psnr']:.1f} dB"
        words = f"{method(record['method']).TITLE}: {record['ms']:.1f} ms, {decibels}"
        return record, words if within else f"{words}; nothing is within {self.budget.budget_ms:g} ms"

    def panel(self, app: App) -> None:
        on = imgui.checkbox("choose by the budget##auto", self.on)[1]
        if on != self.on:
            self.switch(app, on)
        self.budget = edit(self.budget, ranges={"budget_ms": (1.0, 1000.0)})
        survey = app.tool(Survey)
        if survey.running:
            imgui.text_disabled("measuring the methods for this view")
        elif imgui.button("Measure all##auto"):
            survey.start(app)
        if self._points:
            record, words = self.best()
            imgui.text_wrapped(words)
            imgui.text_disabled(_parameters(app, record["method"]))
            if self.stale(app):
                imgui.text_disabled("of another view")
            elif app.settings.method != record["method"] and imgui.button("Take it##auto"):
                self._take(app)

    def _take(self, app: App) -> None:
        record, words = self.best()
        app.settings = app.settings.with_(method=record["method"])
        app.report(words)

    def _measure_when_at_rest(self, app: App, survey: Survey) -> None:
        here, now = scale_of(app), time.monotonic()
        if (app.settings, here) != self._rested[0] or imgui.is_any_mouse_down():
            self._rested = (app.settings, here), now
        elif now - self._rested[1] > REST_S and here != self._asked:
            self._asked = here
            survey.start(app)


def scale_of(app: App) -> Scale:
    """What times and errors of this view depend on."""
    settings, lens = app.settings, app.settings.lens
    blur = lens.radius * focal_px(settings.image.size[1], settings.camera.vfov_deg)
    equal = (app.generation, settings.image, settings.params, settings.light.stamp(), lens.distribution)
    return Scale(equal, (blur, 1.0 / lens.focus_distance, settings.camera.distance))


def _parameters(app: App, name: str) -> str:
    """The method's parameters in words."""
    values = getattr(app.settings.params, name).model_dump()
    return (
        ", ".join(f"{key.replace('_', ' ')} {fields.shown(value)}" for key, value in values.items()) or "no parameters"
    )
