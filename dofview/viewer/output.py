"""Pictures, films and presets out of the window, and back in."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from imgui_bundle import imgui

from dofview import export
from dofview.errors import DofviewError, InputError
from dofview.record.paths import Path_, gaze, rack_focus, turntable
from dofview.record.run import Encoder, frame_count
from dofview.record.writers import check, writer
from dofview.remember import note, read_note, read_preset, write_preset
from dofview.settings import Settings
from dofview.viewer.actions import CTRL, SHIFT, Action
from dofview.viewer.files import unused_name
from dofview.viewer.gaze import Gaze
from dofview.viewer.tool import Rect, Tool

if TYPE_CHECKING:
    from dofview.viewer.app import App

KINDS = (".mp4", ".webm", ".gif")
SEEN, TURNTABLE, RACK, GAZE = range(4)
PATHS = ("what is seen", "turntable", "rack focus", "recorded gaze")


class Output(Tool):
    """Saves what is shown with the settings inside, records films, keeps presets."""

    title = "Output"

    def __init__(self) -> None:
        self.path = SEEN
        self.kind = 0
        self.seconds = 4.0
        self.fps = 30
        self.film: Path | None = None
        self._encoder: Encoder | None = None
        self._frames = 0
        self._plan: Path_ | None = None
        self._planned = 0
        self._before: Settings | None = None
        self._pending: Settings | None = None

    def actions(self) -> tuple[Action, ...]:
        return (
            Action("Save EXR", CTRL | int(imgui.Key.e), "Ctrl+E",
                   "Save colour, depth, CoC and the reference so far as one EXR in linear light.", save_exr, "File"),
            Action("Save preset", CTRL | SHIFT | int(imgui.Key.s), "Ctrl+Shift+S",
                   "Save lens, method and parameters as a TOML preset.", save_preset, "File"),
            Action("Record", CTRL | int(imgui.Key.m), "Ctrl+M", "Start or finish recording a film.",
                   lambda app: self.toggle(app), "File"),
        )  # fmt: skip

    def takes_file(self, app: App, path: Path) -> bool:
        if path.suffix.lower() == ".toml":
            app.settings, complaints = read_preset(path, app.settings)
            app.report("; ".join(complaints) or f"{path.name}: taken")
            return True
        if path.suffix.lower() not in (".png", ".exr"):
            return False
        try:
            remembered = read_note(path)
        except InputError:
            return False
        self._pending = remembered.settings
        if remembered.spec == app.spec:
            self.scene_changed(app)
        else:
            app.open(remembered.spec)
        return True

    def scene_changed(self, app: App) -> None:
        if self._pending is not None:
            image = self._pending.image.model_copy(update={"size": app.settings.image.size})
            app.settings, self._pending = self._pending.with_(image=image), None

    @property
    def recording(self) -> bool:
        """Whether a film is being made."""
        return self._encoder is not None

    def toggle(self, app: App) -> None:
        """Start a film, or finish the one that is being made."""
        if self.recording:
            self._finish(app)
            return
        try:
            film = unused_name(KINDS[self.kind])
            check(film)
            self._planned = 0 if self.path == SEEN else frame_count(self.seconds, self.fps)
            self._plan = self._gaze(app) if self.path == GAZE else _plan(self.path, app.settings, self._planned)
            self._encoder = Encoder(writer(film, app.settings.image.size, self.fps))
        except DofviewError as error:
            app.report(str(error))
            return
        self.film, self._frames, self._before = film, 0, app.settings

    def update(self, app: App) -> None:
        """Hand over the picture of this frame; along a path, set up the next one."""
        if self._encoder is None:
            return
        try:
            if self._plan is None:
                self._add(app)
            else:
                for image in filter(None, (app.shown, app.result and app.result.image)):
                    app.gpu.targets.touch(image)
                settings = self._plan(self._frames).with_(image=app.settings.image)
                self._encoder.add(app.pipeline.shown(app.pipeline.render(settings, "film"), settings))
                self._frames += 1
                if self._frames >= self._planned:
                    self._finish(app)
        except DofviewError as error:
            self._encoder.abandon()
            self._encoder = None
            app.report(str(error))

    def _gaze(self, app: App) -> Path_:
        """The last gaze trace, as long as it is."""
        trace = app.tool(Gaze).trace
        if trace is None:
            raise InputError("no gaze trace yet; record one, or drop a CSV file with time_s, x, y on the window")
        how = app.tool(Gaze).settings.model_copy(update={"rate_hz": float(self.fps)})
        self._planned = trace.ticks(how)
        return gaze(app.settings, trace, partial(app.pipeline.inverse_depth, radius=how.depth_radius), how)

    def _add(self, app: App) -> None:
        assert self._encoder is not None and self._before is not None
        if app.settings.image.size != self._before.image.size:
            app.report("the window changed its size: the film ends here")
            self._finish(app)
        elif app.result is not None:
            self._encoder.add(app.pipeline.shown(app.result, app.settings))
            self._frames += 1

    def _finish(self, app: App) -> None:
        assert self._encoder is not None
        encoder, self._encoder, self._plan = self._encoder, None, None
        try:
            encoder.close()
            app.report(f"saved {self.film}: {self._frames} frames")
        except DofviewError as error:
            app.report(str(error))

    def busy(self, app: App) -> bool:
        return self.recording or self._pending is not None

    def over_picture(self, app: App, rect: Rect, hovered: bool) -> bool:
        if self.recording:
            of = f" of {self._planned}" if self._planned else ""
            app.figure(f"recording: frame {self._frames}{of}, {self._frames / self.fps:.1f} s")
        return False

    def panel(self, app: App) -> None:
        if imgui.button("Save PNG##output"):
            app.save_picture()
        imgui.same_line()
        if imgui.button("Save EXR##output"):
            save_exr(app)
        imgui.same_line()
        if imgui.button("Save preset##output"):
            save_preset(app)
        imgui.begin_disabled(self.recording)
        self.path = imgui.combo("film of##film", self.path, list(PATHS))[1]
        self.kind = imgui.combo("kind##film", self.kind, list(KINDS))[1]
        self.fps = imgui.slider_int("frames a second##film", self.fps, 1, 60, "%d", imgui.SliderFlags_.always_clamp)[1]
        if self.path in (TURNTABLE, RACK):
            flags = imgui.SliderFlags_.always_clamp
            self.seconds = imgui.slider_float("seconds##film", self.seconds, 0.5, 60.0, "%.1f", flags)[1]
        imgui.end_disabled()
        if imgui.button("Finish the film##film" if self.recording else "Record##film"):
            self.toggle(app)

    def release(self) -> None:
        if self._encoder is not None:
            self._encoder.close()
            self._encoder = None


def save_exr(app: App) -> None:
    """Save the picture, its inverse depth and CoC, and the reference so far, linear light."""
    if app.result is None:
        return
    frame, guard = app.result.frame, app.result.frame.guard
    inner = (slice(guard, guard + frame.inner_size[1]), slice(guard, guard + frame.inner_size[0]))
    inverse_depth = frame.pinhole().inverse_depth.pixels()[inner][..., 0]
    with np.errstate(divide="ignore"):
        parts = {"color": app.result.pixels(), "depth": 1.0 / inverse_depth,
                 "coc": np.asarray(frame.coc.radius_px(inverse_depth))}  # fmt: skip
    reference = app.pipeline.reference(app.settings)
    if reference.views:
        picture = app.pipeline.reference_picture(app.settings, name="reference once")
        parts["reference"] = picture.pixels()[..., :3]
    try:
        path = unused_name(".exr")
        export.save_parts(path, parts, note(app.spec, app.settings))
        app.report(f"saved {path}")
    except DofviewError as error:
        app.report(str(error))


def save_preset(app: App) -> None:
    """Save lens, method, parameters and display under a new name in the working folder."""
    try:
        path = unused_name(".toml", "preset")
        write_preset(path, app.settings)
        app.report(f"saved {path}")
    except DofviewError as error:
        app.report(str(error))


def _plan(path: int, settings: Settings, frames: int) -> Path_ | None:
    match path:
        case 1:
            return turntable(settings, frames)
        case 2:
            here = settings.lens.focus_distance
            return rack_focus(settings, frames, here, 3.0 * here)
    return None
