"""Plots that follow the work: time of each pass and frame, what it did and what it saved, error against time."""

from __future__ import annotations

import math
from collections import deque
from typing import TYPE_CHECKING

import numpy as np
from imgui_bundle import imgui, implot

from dofview.bench.pareto import front
from dofview.methods import METHODS
from dofview.pipeline import Result
from dofview.viewer.actions import Action
from dofview.viewer.measurement import Measurement
from dofview.viewer.survey import Point, Survey
from dofview.viewer.tool import Tool

if TYPE_CHECKING:
    from dofview.viewer.app import App

HISTORY = 120
WIDTH_EM, HEIGHT_EM = 36.0, 12.0
QUIET = implot.Flags_.no_mouse_text | implot.Flags_.no_menus
FIT = implot.AxisFlags_.auto_fit


class Plots(Tool):
    """A window of its own with three plots; passes are timed, and all that can be counted is, only while it is open."""

    def __init__(self) -> None:
        self.shown = False
        self.history: deque[dict[str, float]] = deque(maxlen=HISTORY)
        self._of: object = None
        self._seen = -1
        self._context: implot.internal.Context | None = None

    def actions(self) -> tuple[Action, ...]:
        return (
            Action("Plots", int(imgui.Key.t), "T", "Show the time of passes and frames, and error against time.",
                   lambda app: self._toggle(), "Compare"),
        )  # fmt: skip

    def update(self, app: App) -> None:
        app.timing = self.shown
        method = app.settings.method
        if method != self._of:
            self._of = method
            self.history.clear()
        # Every render makes a new dictionary: the same one is the same frame.
        if self.shown and app.passes and id(app.passes) != self._seen:
            self._seen = id(app.passes)
            self.history.append(app.passes)

    def windows(self, app: App) -> None:
        if not self.shown:
            return
        if implot.get_current_context() is None:
            self._context = implot.create_context()
        size, area = imgui.get_font_size(), imgui.get_main_viewport()
        place = (area.work_pos.x + size, area.work_pos.y + 5 * size)
        imgui.set_next_window_pos(place, imgui.Cond_.first_use_ever)
        imgui.set_next_window_size_constraints((0.0, 0.0), (area.work_size.x, area.work_size.y - 6 * size))
        opened, still = imgui.begin("Plots", True, imgui.WindowFlags_.always_auto_resize)
        self.shown = bool(still)
        if opened:
            self._passes(app)
            self._frames(app)
            self._work(app)
            self._errors(app)
        imgui.end()

    def release(self) -> None:
        if self._context is not None:
            implot.destroy_context(self._context)
            self._context = None

    def _toggle(self) -> None:
        self.shown = not self.shown

    def _passes(self, app: App) -> None:
        """Milliseconds of each pass, one upon another, over the last renderings."""
        if not self.history:
            imgui.text_disabled("Passes are timed from the next rendering on.")
            return
        clock = "wall clock around each pass" if app.gpu.profile.clock == "wall" else "timer queries"
        title = f"Passes of {app.settings.method}, ms ({clock})##passes"
        if not implot.begin_plot(title, _size(1.0), QUIET):
            return
        _setup_history(len(self.history))
        implot.setup_legend(implot.Location_.east, implot.LegendFlags_.outside)
        # One rendering alone is drawn as two: an area needs a width.
        history = [self.history[0], *self.history] if len(self.history) == 1 else list(self.history)
        count = len(history)
        base = np.zeros(count)
        number = np.arange(count, dtype=float) - count + 1.0
        for name in dict.fromkeys(name for frame in history for name in frame):
            top = base + np.array([frame.get(name, 0.0) for frame in history])
            implot.plot_shaded(f"{name}##pass", number, base, top)
            base = top
        implot.end_plot()

    def _frames(self, app: App) -> None:
        """Milliseconds of whole renderings."""
        if len(app.milliseconds) < 2:
            return
        if not implot.begin_plot("Frames, ms##frames", _size(0.7), QUIET | implot.Flags_.no_legend):
            return
        _setup_history(len(app.milliseconds))
        times = np.array(app.milliseconds[-HISTORY:], dtype=float)
        implot.plot_line("frame##frame", np.arange(len(times), dtype=float) - len(times) + 1.0, times)
        implot.end_plot()

    def _work(self, app: App) -> None:
        """The canvas with its guard band, and the counters of the last rendering: work done, work left out."""
        if app.result is None or not imgui.collapsing_header("Work done and left out##work"):
            return
        for line in work(app.result):
            imgui.text_disabled(line)

    def _errors(self, app: App) -> None:
        """One point for each method, and those that no other beats in time and error."""
        survey = app.tool(Survey)
        if survey.running:
            imgui.progress_bar(survey.progress(app), (20.0 * imgui.get_font_size(), 0.0), "measuring all")
            imgui.same_line()
            if imgui.button("cancel##survey"):
                survey.cancel()
        elif imgui.button("measure all##survey"):
            survey.start(app)
        if not survey.points:
            return
        finite = [point for point in survey.points if math.isfinite(point.psnr)]
        outdated = survey.outdated(app)
        imgui.text_disabled(Measurement(0.0, survey.points[0].quality).reference_text())
        if outdated:
            imgui.text_disabled("of another view")
        if implot.begin_plot("Error against time##errors", _size(1.4), QUIET | implot.Flags_.no_legend):
            _scatter(finite, survey.points, outdated)
            implot.end_plot()


def work(result: Result) -> list[str]:
    """What a rendering did, a line for each figure."""
    width, height = result.frame.size
    return [
        f"canvas {width}x{height}, guard band of {result.frame.guard} px on each side",
        *(f"{count} {name}" for name, count in sorted(result.counts.items())),
    ]


def _size(height: float) -> tuple[float, float]:
    """Of a plot, in pixels."""
    size = imgui.get_font_size()
    return WIDTH_EM * size, height * HEIGHT_EM * size


def _setup_history(count: int) -> None:
    """The last renderings, the newest at the right end."""
    implot.setup_axes("renderings ago", "ms", 0, FIT)
    implot.setup_axis_format(implot.ImAxis_.x1, "%.0f")
    implot.setup_axis_limits(implot.ImAxis_.x1, -float(max(min(count, HISTORY), 10)), 0.0, implot.Cond_.always)


def _scatter(finite: list[Point], points: list[Point], outdated: bool) -> None:
    size = imgui.get_font_size()
    implot.setup_axes("ms", "PSNR, dB")
    implot.setup_axis_scale(implot.ImAxis_.x1, implot.Scale_.log10)
    if finite:
        # A logarithmic axis does not fit itself to its points in the first frame, after which the window may rest.
        times, decibels = [point.ms for point in finite], [point.psnr for point in finite]
        limits = min(times) / 2.0, max(times) * 2.0, min(decibels) - 4.0, max(decibels) + 4.0
        implot.setup_axes_limits(*limits, implot.Cond_.always)
    best = [record for record in front(point.record() for point in points) if record["psnr"] is not None]
    if best:
        line = implot.Spec()
        line.line_color = imgui.ImVec4(0.7, 0.7, 0.7, 0.8)
        xs, ys = (np.array([record[key] for record in best], dtype=float) for key in ("ms", "psnr"))
        implot.plot_line("none better##front", xs, ys, line)
    for point in finite:
        look = implot.Spec()
        look.marker, look.marker_size = implot.Marker_.circle, 6.0
        grey = outdated or not point.trustworthy
        colour = imgui.ImVec4(0.5, 0.5, 0.5, 1.0) if grey else implot.get_colormap_color(METHODS.index(point.method))
        look.marker_fill_color = look.marker_line_color = colour
        implot.plot_scatter(point.method, np.array([point.ms]), np.array([point.psnr]), look)
    for number, point in enumerate(sorted(finite, key=lambda point: point.ms)):
        # Names above and below in turn: points often stand close together.
        implot.plot_text(point.method, point.ms, point.psnr, (0.0, (1.0 if number % 2 else -1.0) * size))
