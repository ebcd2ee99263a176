"""Films out of the window: of what is seen, or along a path; encoded beside it."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterable
from functools import partial
from typing import TYPE_CHECKING

from imgui_bundle import imgui

from dofview.errors import DofviewError, InputError
from dofview.gl.targets import Image
from dofview.record.paths import Path_, gaze, keyframes, rack_focus, turntable
from dofview.record.run import frame_count
from dofview.record.writers import check
from dofview.settings import Settings
from dofview.viewer.actions import CTRL, SHIFT, Action
from dofview.viewer.files import unused_name
from dofview.viewer.filming import Filming, Shows
from dofview.viewer.gaze import Gaze
from dofview.viewer.tool import Rect, Tool, Work

if TYPE_CHECKING:
    from dofview.viewer.app import App

KINDS = (".mp4", ".webm", ".gif", "/%05d.png", "/%05d.exr")
KIND_WORDS = ("MP4", "WebM", "GIF", "PNG pictures", "EXR pictures, linear light")
LIVE, TURNTABLE, RACK, KEYFRAMES, GAZE = range(5)
PATHS = ("live, as it is used", "turntable", "rack focus", "keyframes", "recorded gaze")


class Output(Tool):
    """Records films."""

    title = "Film"

    def __init__(self) -> None:
        self.path = LIVE
        self.shows = Shows.SEEN
        self.kind = 0
        self.seconds = 4.0
        self.fps = 30
        self.keys: list[Settings] = []
        self.rack_to: float | None = None
        """Where the focus goes, scene units; None for three times as far as it is."""
        self._filming: Filming | None = None

    def actions(self) -> tuple[Action, ...]:
        m = int(imgui.Key.m)
        return (
            Action("Record", CTRL | m, "Ctrl+M", "Start or finish recording a film.", self.toggle, "File"),
            Action("Add keyframe", CTRL | SHIFT | m, "Ctrl+Shift+M",
                   "Add this view to the path of keyframes that a film can follow.", self.add_key, "File"),
        )  # fmt: skip

    @property
    def recording(self) -> bool:
        """Whether a film is being made."""
        return self._filming is not None

    def add_key(self, app: App) -> None:
        """Let the path go on to this view."""
        self.keys.append(app.settings)
        app.report(f"keyframe {len(self.keys)}; the film of keyframes is in the panel Film")

    def toggle(self, app: App) -> None:
        """Start a film, or finish the one that is being made."""
        if self.recording:
            self._finish(app)
            return
        suffix = KINDS[self.kind]
        try:
            film = unused_name("", "dofview-film") / suffix[1:] if suffix.startswith("/") else unused_name(suffix)
            plan, planned = self._planning(app)
            check(film)
            self._filming = Filming(app, film, self.shows, self.fps, plan, planned)
        except DofviewError as error:
            app.report(str(error))
            return
        if plan is None:
            app.clock = self._filming.clock

    def update(self, app: App) -> None:
        """Along a path, render and hand over the next picture."""
        if self._filming is not None:
            self._go_on(app, self._filming.along)

    def seen(self, app: App, image: Image) -> None:
        """Hand over what is seen in this frame."""
        if self._filming is not None:
            self._go_on(app, partial(self._filming.live, image=image))

    def work(self, app: App) -> Iterable[Work]:
        filming = self._filming
        if filming is None:
            return
        if filming.planned:
            yield Work("film", filming.frames / filming.planned, partial(self._cancel, app))
        else:
            yield Work(f"film, {filming.seconds:.1f} s", None, partial(self._finish, app), "Finish")

    def busy(self, app: App) -> bool:
        return self.recording

    def over_picture(self, app: App, rect: Rect, hovered: bool) -> bool:
        filming = self._filming
        if filming is not None:
            of = f" of {filming.planned}" if filming.planned else ""
            app.figure(f"recording: frame {filming.frames}{of}, {filming.seconds:.1f} s")
        return False

    def panel(self, app: App) -> None:
        imgui.begin_disabled(self.recording)
        self.path = imgui.combo("path##film", self.path, list(PATHS))[1]
        choices = list(Shows)[: 3 if self.path == LIVE else 2]
        self.shows = self.shows if self.shows in choices else Shows.SEEN
        self.shows = choices[imgui.combo("shows##film", choices.index(self.shows), [c.value for c in choices])[1]]
        if imgui.is_item_hovered(imgui.HoveredFlags_.for_tooltip):
            imgui.set_tooltip("What is seen has the wipe, the grid, error maps, the band in focus and the zoom in it.")
        self.kind = imgui.combo("kind##film", self.kind, list(KIND_WORDS))[1]
        flags = imgui.SliderFlags_.always_clamp
        self.fps = imgui.slider_int("frames a second##film", self.fps, 1, 60, "%d", flags)[1]
        if self.path in (TURNTABLE, RACK, KEYFRAMES):
            self.seconds = imgui.slider_float("length##film", self.seconds, 0.5, 60.0, "%.1f s", flags)[1]
        if self.path == KEYFRAMES:
            self._keys_panel(app)
        if self.path == RACK:
            self._rack_panel(app)
        imgui.end_disabled()
        if imgui.button("Finish the film##film" if self.recording else "Record##film"):
            self.toggle(app)

    def release(self) -> None:
        if self._filming is not None:
            self._filming.close()
            self._filming = None

    def _rack_panel(self, app: App) -> None:
        here = app.settings.lens.focus_distance
        imgui.text_disabled(f"the focus goes from {here:.4g}, where it is")
        farthest = 4.0 * max(app.settings.camera.distance, math.dist(*app.scene.bounds), 1e-3)
        flags = imgui.SliderFlags_.logarithmic | imgui.SliderFlags_.always_clamp
        changed, to = imgui.slider_float("to##film", self._rack_end(app), farthest / 1000.0, farthest, "%.4g", flags)
        self.rack_to = to if changed else self.rack_to

    def _rack_end(self, app: App) -> float:
        return self.rack_to if self.rack_to is not None else 3.0 * app.settings.lens.focus_distance

    def _keys_panel(self, app: App) -> None:
        imgui.text_disabled(f"{len(self.keys)} keyframes, passed at equal times; two or more make a film")
        if imgui.button("Add this view##film"):
            self.add_key(app)
        imgui.same_line()
        imgui.begin_disabled(not self.keys)
        if imgui.button("Take back##film"):
            self.keys.pop()
        imgui.end_disabled()

    def _planning(self, app: App) -> tuple[Path_ | None, int]:
        """The path that is chosen and its frames; None follows what is done in the window."""
        if self.path == LIVE:
            return None, 0
        if self.path == GAZE:
            return self._gaze(app)
        settings, frames = app.settings, frame_count(self.seconds, self.fps)
        if self.path == KEYFRAMES:
            return keyframes(settings, frames, self.keys), frames
        if self.path == TURNTABLE:
            return turntable(settings, frames), frames
        return rack_focus(settings, frames, settings.lens.focus_distance, self._rack_end(app)), frames

    def _gaze(self, app: App) -> tuple[Path_, int]:
        """The last gaze trace, as long as it is."""
        trace = app.tool(Gaze).trace
        if trace is None:
            raise InputError("no gaze trace yet; record one, or drop a CSV file with time_s, x, y on the window")
        how = app.tool(Gaze).settings.model_copy(update={"rate_hz": float(self.fps)})
        depth = partial(app.pipeline.inverse_depth, radius=how.depth_radius)
        return gaze(app.settings, trace, depth, how), trace.ticks(how)

    def _go_on(self, app: App, step: Callable[[App], None]) -> None:
        """Take a step; a file that cannot be written ends the film and is reported, and the window lives on."""
        assert self._filming is not None
        try:
            step(app)
        except DofviewError as error:
            self._end(app).abandon()
            app.report(str(error))
            return
        if self._filming.done:
            self._finish(app)

    def _end(self, app: App) -> Filming:
        assert self._filming is not None
        filming, self._filming, app.clock = self._filming, None, time.monotonic
        return filming

    def _finish(self, app: App) -> None:
        filming = self._end(app)
        try:
            filming.close()
            app.report(f"saved {filming.film}: {filming.frames} frames")
        except DofviewError as error:
            app.report(str(error))

    def _cancel(self, app: App) -> None:
        """Stop; what was written of a film stays under the name of a part."""
        filming = self._end(app)
        filming.abandon()
        app.report(f"stopped after {filming.frames} frames of {filming.planned}")
