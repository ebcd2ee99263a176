"""Gaze mode: the focus follows the mouse, or a recorded trace, as it would follow an eye."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING

from imgui_bundle import imgui

from dofview.errors import DofviewError
from dofview.export import write_whole
from dofview.focus import GazeSettings, Look, Pull, Row, Trace, read_trace, step
from dofview.viewer import files
from dofview.viewer.actions import CTRL, SHIFT, Action
from dofview.viewer.focusing import set_focus
from dofview.viewer.tool import Rect, Tool
from dofview.viewer.widgets import edit

if TYPE_CHECKING:
    from dofview.viewer.app import App

MOST_TICKS = 60
"""A frame that took longer than this many steps is not made up for."""

AT_ONCE = {"speed": 1000.0, "dwell_s": 0.0}


class Mouse:
    """A gaze source: the pointer, while it is over the picture."""

    def __init__(self) -> None:
        self.look = Look(None)

    def at(self, time_s: float) -> Look:
        return self.look


class Gaze(Tool):
    """Drives the focus from a gaze source, and records what it was driven by."""

    title = "Gaze"

    def __init__(self) -> None:
        self.on = False
        self.frozen = False
        self.settings = GazeSettings()
        self.trace: Trace | None = None
        self.pulls: list[Pull] = []
        """The focus at every step of the replay so far."""
        self._mouse = Mouse()
        self._replaying = False
        self._rows: list[Row] | None = None
        self._pull = Pull(0.0, 0.0)
        self._tick = 0
        self._last = 0.0
        self._seen: object = None

    def actions(self) -> tuple[Action, ...]:
        g = int(imgui.Key.g)
        return (
            Action("Gaze mode", g, "G", "Let the focus follow the mouse as it would follow an eye.",
                   lambda app: self.switch(app, not self.on), "Gaze"),
            Action("Freeze gaze", SHIFT | g, "Shift+G", "Hold the focus where it is, or let it go.",
                   lambda app: self._freeze(), "Gaze"),
            Action("Record gaze", CTRL | g, "Ctrl+G", "Record the gaze into a CSV file, or end the recording.",
                   lambda app: self.record(app, self._rows is None), "Gaze"),
            Action("Replay gaze", CTRL | SHIFT | g, "Ctrl+Shift+G", "Play the last gaze trace, step by step.",
                   self.replay, "Gaze"),
        )  # fmt: skip

    @property
    def replaying(self) -> bool:
        """Whether a trace drives the focus."""
        return self._replaying

    def switch(self, app: App, on: bool) -> None:
        """Begin or end gaze mode."""
        if not on and self._rows is not None:
            self.record(app, False)
        self.on, self._replaying, self._seen = on, False, None
        self._begin(app, Pull.at(app.settings.lens.focus_distance))

    def record(self, app: App, on: bool, path: Path | None = None) -> None:
        """Begin to record, or end and write the trace to `path` or a new file in the working folder."""
        if on:
            self.switch(app, True)
            self._rows = []
            return
        rows, self._rows = self._rows or [], None
        if not rows:
            return
        self.trace = Trace(rows)
        text = self.trace.text()
        try:
            path = path or files.unused_name(".csv", "dofview-gaze")
            write_whole(path, lambda part: part.write_text(text, encoding="utf-8"))
            app.report(f"saved {path}: {len(rows)} steps")
        except DofviewError as error:
            app.report(str(error))

    def replay(self, app: App) -> None:
        """Play the trace from its beginning, one step a frame."""
        if self.trace is None or not self.trace.rows:
            app.report("no gaze trace yet; record one, or drop a CSV file with time_s, x, y on the window")
            return
        self.switch(app, True)
        self._replaying, self.frozen, self.pulls = True, False, []
        self._begin(app, self.trace.start or Pull.at(app.settings.lens.focus_distance))

    def takes_file(self, app: App, path: Path) -> bool:
        if path.suffix.lower() != ".csv":
            return False
        self.trace = read_trace(path)
        self.replay(app)
        return True

    def update(self, app: App) -> None:
        if not self.on or (self.frozen and self._rows is None):
            return
        if self._pull.distance != app.settings.lens.focus_distance:
            self._pull = Pull.at(app.settings.lens.focus_distance)
        if self._replaying:
            self._play(app)
        elif self._rows is not None or self._key(app) != self._seen or not self._pull.settled:
            self._follow(app)
        else:
            self._last = app.clock()

    def over_picture(self, app: App, rect: Rect, hovered: bool) -> bool:
        point = rect.share(imgui.get_mouse_pos())
        # While a button is held the hand moves the camera, not the eye.
        looking = hovered and not any(imgui.is_mouse_down(button) for button in range(3))
        self._mouse.look = Look(point if looking else None, self.frozen)
        if self.on:
            self._show(app, rect)
        return False

    def panel(self, app: App) -> None:
        on = imgui.checkbox("focus follows the gaze##gaze", self.on)[1]
        if on != self.on:
            self.switch(app, on)
        self.frozen = imgui.checkbox("frozen##gaze", self.frozen)[1]
        self.settings = edit(self.settings, ranges={
            "speed": (0.5, 50.0), "dwell_s": (0.0, 1.0), "rate_hz": (10.0, 240.0),
        })  # fmt: skip
        if imgui.button("End and save##gaze" if self._rows is not None else "Record##gaze"):
            self.record(app, self._rows is None)
        imgui.same_line()
        if imgui.button("Replay##gaze"):
            self.replay(app)
        if self.trace is not None:
            imgui.text_disabled(f"trace of {self.trace.duration_s:.2f} s")
        if self._replaying and self.trace is not None:
            imgui.progress_bar(self._tick / self.trace.ticks(self.settings), (-1.0, 0.0), "")

    def busy(self, app: App) -> bool:
        if not self.on:
            return False
        waiting = not self.frozen and (not self._pull.settled or self._key(app) != self._seen)
        return waiting or self._replaying or self._rows is not None

    def scene_changed(self, app: App) -> None:
        self.switch(app, False)

    def _begin(self, app: App, pull: Pull) -> None:
        self._pull, self._tick, self._last = pull, 0, app.clock()
        set_focus(app, pull.distance)

    def _freeze(self) -> None:
        self.frozen = not self.frozen
        self._mouse.look = Look(self._mouse.look.point, self.frozen)

    def _key(self, app: App) -> tuple[object, ...]:
        """What the depth under the gaze depends on."""
        return self._mouse.look, app.settings.camera, app.settings.image, self.settings

    def _follow(self, app: App) -> None:
        """As many steps as time has passed for."""
        now, rate = app.clock(), self.settings.rate_hz
        due = int((now - self._last) * rate + 1e-6)
        if due == 0:
            return
        self._seen = self._key(app)
        self._last = now if due > MOST_TICKS else self._last + due / rate
        jump = app.interface.reduced_motion and self._rows is None
        how = self.settings.model_copy(update=AT_ONCE) if jump else self.settings
        for _ in range(min(due, MOST_TICKS)):
            self._step(app, self._mouse.look, how)

    def _play(self, app: App) -> None:
        """One step, when it is time for it, which a slow machine shows later; all that are due, when a film has its own
        time."""
        assert self.trace is not None
        period, ticks = 1.0 / self.settings.rate_hz, self.trace.ticks(self.settings)
        filmed = app.clock != time.monotonic
        while self._tick < ticks and app.clock() >= self._last - 1e-9:
            self._last += period
            self._step(app, self.trace.at(self._tick / self.settings.rate_hz), self.settings)
            self.pulls.append(self._pull)
            if not filmed:
                self._last = max(self._last, app.clock() - period)
                return
        if self._tick >= ticks:
            self.on = self._replaying = False
            app.report(f"replayed {self._tick} steps of gaze")

    def _step(self, app: App, look: Look, how: GazeSettings) -> None:
        if self._rows is not None:
            self._rows.append(Row(self._tick / how.rate_hz, look, self._pull.distance))
        width, height = app.settings.image.size
        self._pull = step(self._pull, look, self._tick, lambda x, y: self._depth(app, x, y), how, width / height)
        self._tick += 1
        set_focus(app, self._pull.distance)

    def _depth(self, app: App, x: float, y: float) -> float:
        return app.pipeline.inverse_depth(app.settings, x, y, self.settings.depth_radius)

    def _show(self, app: App, rect: Rect) -> None:
        """A ring where the eye rests, and in words what the gaze does."""
        state = "replaying" if self._replaying else "recording" if self._rows is not None else "following"
        app.figure(f"gaze: {'frozen' if self.frozen else state}, focus {self._pull.distance:.4g}", faint=True)
        if self._pull.anchor is not None:
            x, y = self._pull.anchor
            centre = rect.place((x, y))
            radius = max(self.settings.fixation_radius * rect.height / rect.part.height, 2.0)
            color = 0xFFFFFFFF if self._pull.fixated else 0x80FFFFFF
            imgui.get_window_draw_list().add_circle(centre, radius, color)
