"""Films out of the window: of what is seen, or along a path; encoded beside it."""

from __future__ import annotations

import logging
from collections.abc import Iterable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from imgui_bundle import imgui

from dofview.errors import DofviewError, InputError
from dofview.record.paths import Path_, gaze, keyframes, rack_focus, turntable
from dofview.record.run import Encoder, frame_count
from dofview.record.writers import check, writer
from dofview.settings import Settings
from dofview.viewer.actions import CTRL, SHIFT, Action
from dofview.viewer.files import unused_name
from dofview.viewer.gaze import Gaze
from dofview.viewer.tool import Rect, Tool, Work

if TYPE_CHECKING:
    from dofview.viewer.app import App

log = logging.getLogger("dofview.viewer")
KINDS = (".mp4", ".webm", ".gif", "/%05d.png", "/%05d.exr")
KIND_WORDS = ("MP4", "WebM", "GIF", "PNG pictures", "EXR pictures, linear light")
SEEN, TURNTABLE, RACK, KEYFRAMES, GAZE = range(5)
PATHS = ("what is seen", "turntable", "rack focus", "keyframes", "recorded gaze")


class Output(Tool):
    """Records films."""

    title = "Film"

    def __init__(self) -> None:
        self.path = SEEN
        self.kind = 0
        self.seconds = 4.0
        self.fps = 30
        self.keys: list[Settings] = []
        self.film: Path | None = None
        self._linear = False
        self._encoder: Encoder | None = None
        self._frames = 0
        self._plan: Path_ | None = None
        self._planned = 0
        self._before: Settings | None = None

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
        return self._encoder is not None

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
            self._planned = 0 if self.path == SEEN else frame_count(self.seconds, self.fps)
            self._plan = self._planning(app)
            check(film)
            self._encoder = Encoder(writer(film, app.settings.image.size, self.fps))
        except DofviewError as error:
            app.report(str(error))
            return
        self._linear = suffix.endswith(".exr")
        self.film, self._frames, self._before = film, 0, app.settings

    def update(self, app: App) -> None:
        """Hand over the picture of this frame; along a path, render and hand over the next one."""
        if self._encoder is None:
            return
        try:
            if self._plan is None:
                self._add_seen(app)
            else:
                self._add_planned(app, self._plan)
        except DofviewError as error:
            self._encoder.abandon()
            self._encoder = self._plan = None
            app.report(str(error))

    def work(self, app: App) -> Iterable[Work]:
        if self._encoder is None:
            return
        if self._planned:
            yield Work("film", self._frames / self._planned, partial(self._cancel, app))
        else:
            yield Work(f"film, {self._frames / self.fps:.1f} s", None, partial(self._finish, app), "Finish")

    def busy(self, app: App) -> bool:
        return self.recording

    def over_picture(self, app: App, rect: Rect, hovered: bool) -> bool:
        if self.recording:
            of = f" of {self._planned}" if self._planned else ""
            app.figure(f"recording: frame {self._frames}{of}, {self._frames / self.fps:.1f} s")
        return False

    def panel(self, app: App) -> None:
        imgui.begin_disabled(self.recording)
        self.path = imgui.combo("film of##film", self.path, list(PATHS))[1]
        self.kind = imgui.combo("kind##film", self.kind, list(KIND_WORDS))[1]
        flags = imgui.SliderFlags_.always_clamp
        self.fps = imgui.slider_int("frames a second##film", self.fps, 1, 60, "%d", flags)[1]
        if self.path in (TURNTABLE, RACK, KEYFRAMES):
            self.seconds = imgui.slider_float("length##film", self.seconds, 0.5, 60.0, "%.1f s", flags)[1]
        if self.path == KEYFRAMES:
            self._keys_panel(app)
        imgui.end_disabled()
        if imgui.button("Finish the film##film" if self.recording else "Record##film"):
            self.toggle(app)

    def release(self) -> None:
        if self._encoder is not None:
            self._encoder.close()
            self._encoder = None

    def _keys_panel(self, app: App) -> None:
        imgui.text_disabled(f"{len(self.keys)} keyframes, passed at equal times; two or more make a film")
        if imgui.button("Add this view##film"):
            self.add_key(app)
        imgui.same_line()
        imgui.begin_disabled(not self.keys)
        if imgui.button("Take back##film"):
            self.keys.pop()
        imgui.end_disabled()

    def _planning(self, app: App) -> Path_ | None:
        """The path that is chosen; None follows what is seen."""
        settings, frames = app.settings, self._planned
        match self.path:
            case 1:
                return turntable(settings, frames)
            case 2:
                here = settings.lens.focus_distance
                return rack_focus(settings, frames, here, 3.0 * here)
            case 3:
                return keyframes(settings, frames, self.keys)
            case 4:
                return self._gaze(app)
        return None

    def _gaze(self, app: App) -> Path_:
        """The last gaze trace, as long as it is."""
        trace = app.tool(Gaze).trace
        if trace is None:
            raise InputError("no gaze trace yet; record one, or drop a CSV file with time_s, x, y on the window")
        how = app.tool(Gaze).settings.model_copy(update={"rate_hz": float(self.fps)})
        self._planned = trace.ticks(how)
        return gaze(app.settings, trace, partial(app.pipeline.inverse_depth, radius=how.depth_radius), how)

    def _add_planned(self, app: App, plan: Path_) -> None:
        assert self._encoder is not None
        for image in (app.shown, app.result.image if app.result else None):
            if image is not None:
                app.gpu.targets.touch(image)
        settings = plan(self._frames).with_(image=app.settings.image)
        result = app.pipeline.render(settings, "film")
        self._encoder.add(result.pixels() if self._linear else app.pipeline.shown(result, settings))
        self._frames += 1
        if self._frames >= self._planned:
            self._finish(app)

    def _add_seen(self, app: App) -> None:
        assert self._encoder is not None and self._before is not None
        if app.settings.image.size != self._before.image.size:
            app.report("the window changed its size: the film ends here")
            self._finish(app)
        elif app.result is not None:
            self._encoder.add(app.result.pixels() if self._linear else app.pipeline.shown(app.result, app.settings))
            self._frames += 1
            if self._frames % self.fps == 0:
                log.info("film: %d s", self._frames // self.fps)

    def _finish(self, app: App) -> None:
        assert self._encoder is not None
        encoder, self._encoder, self._plan = self._encoder, None, None
        try:
            encoder.close()
            app.report(f"saved {self.film}: {self._frames} frames")
        except DofviewError as error:
            app.report(str(error))

    def _cancel(self, app: App) -> None:
        """Stop; what was written of a film stays under the name of a part."""
        assert self._encoder is not None
        encoder, self._encoder, self._plan = self._encoder, None, None
        encoder.abandon()
        app.report(f"stopped after {self._frames} frames of {self._planned}")
