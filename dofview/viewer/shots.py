"""Pictures and presets out of the window, and back in: a dropped picture restores the settings it was made with."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from imgui_bundle import imgui

from dofview import export
from dofview.errors import DofviewError, InputError
from dofview.remember import Remembered, note, read_note, read_preset, write_preset
from dofview.scene.load import DEMO
from dofview.viewer import files, screen
from dofview.viewer.actions import ALT, CTRL, SHIFT, Action
from dofview.viewer.matte import Matte
from dofview.viewer.tool import Tool, Work
from dofview.viewer.truth import REFERENCE

if TYPE_CHECKING:
    from collections.abc import Iterable

    from dofview.viewer.app import App


class Shots(Tool):
    """Saves what is shown with the settings inside, and takes them from there."""

    title = "Save"

    def __init__(self) -> None:
        self.transparent = False
        self._matte: Matte | None = None
        self._pending: Remembered | None = None

    def actions(self) -> tuple[Action, ...]:
        s = int(imgui.Key.s)
        return (
            Action("Save picture", CTRL | s, "Ctrl+S", "Save the picture as PNG, without the interface.",
                   self.save_picture, "File"),
            Action("Save what is seen", CTRL | ALT | s, "Ctrl+Alt+S",
                   "Save the comparison, error map, overlay and zoom as they are seen, without the panels, as PNG.",
                   save_seen, "File"),
            Action("Save window", int(imgui.Key.f12), "F12",
                   "Save what the window shows as PNG, the interface included.", save_window, "File"),
            Action("Save EXR", CTRL | int(imgui.Key.e), "Ctrl+E",
                   "Save colour, depth, CoC and the reference so far as one EXR in linear light.", save_exr, "File"),
            Action("Save preset", CTRL | SHIFT | s, "Ctrl+Shift+S",
                   "Save lens, method and parameters as a TOML preset.", save_preset, "File"),
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
        self._pending = remembered
        if remembered.spec == app.spec:
            self.scene_changed(app)
        else:
            app.open(_found(remembered.spec, path.parent))
        return True

    def scene_changed(self, app: App) -> None:
        if self._pending is None:
            return
        settings, seen, self._pending = self._pending.settings, self._pending.seen, None
        image = settings.image.model_copy(update={"size": app.settings.image.size})
        app.settings = settings.with_(image=image)
        if seen is not None:
            screen.take(app, seen)

    def update(self, app: App) -> None:
        if self._pending is not None and not app.loader.spec:
            self._pending = None  # its scene could not be read
        if self._matte is None:
            return
        try:
            if self._matte.advance(app):
                path, self._matte = self._matte.save(app), None
                app.report(f"saved {path}")
        except DofviewError as error:
            self._matte = None
            app.report(str(error))

    def work(self, app: App) -> Iterable[Work]:
        if self._matte is not None:
            yield Work("transparency", self._matte.progress, self._forget_matte)

    def busy(self, app: App) -> bool:
        return self._matte is not None

    def panel(self, app: App) -> None:
        if imgui.button("PNG##save"):
            self.save_picture(app)
        _hint("Ctrl+S: the picture with its settings inside; dropping it on the window brings them back.")
        imgui.same_line()
        if imgui.button("Seen##save"):
            save_seen(app)
        _hint("Ctrl+Alt+S: wipe, grid, error map, overlay and zoom as they are seen; dropping it brings them back.")
        imgui.same_line()
        if imgui.button("Window##save"):
            save_window(app)
        _hint("F12: all that the window shows, interface included.")
        imgui.same_line()
        if imgui.button("EXR##save"):
            save_exr(app)
        _hint("Ctrl+E: colour, depth, CoC and the reference so far, linear light.")
        imgui.same_line()
        if imgui.button("Preset##save"):
            save_preset(app)
        _hint("Ctrl+Shift+S: lens, method and parameters as TOML.")
        self.transparent = imgui.checkbox("PNG with transparent background##save", self.transparent)[1]
        _hint("Where nothing is, the PNG is clear; blurred edges are as clear as they let the background through.")

    def save_picture(self, app: App, path: Path | None = None) -> None:
        """Save the picture shown as PNG under `path`, or under a new name in the working folder."""
        if app.shown is None or app.result is None:
            return
        try:
            if self.transparent:
                if app.settings.method == REFERENCE:
                    # What is shown is what is saved: no view more.
                    views = max(app.accumulated.quality.views, 1)
                    app.accumulated = replace(app.accumulated, most_views=views)
                self._matte = Matte(app, path)
            else:
                remark = note(app.spec, app.settings)
                app.report(f"saved {files.save_png(app.shown.pixels()[..., :3], path, remark)}")
        except DofviewError as error:
            app.report(str(error))

    def _forget_matte(self) -> None:
        self._matte = None


def save_seen(app: App) -> None:
    """Save what is seen without the interface under a new name, with the settings and the comparison inside."""
    image = app.screen.image(app)
    if image is None:
        return
    try:
        remark = note(app.spec, app.settings, screen.seen_of(app))
        path = files.save_png(image.pixels()[..., :3], files.unused_name(".png", "dofview-seen"), remark)
        app.report(f"saved {path}")
    except DofviewError as error:
        app.report(str(error))


def save_window(app: App) -> None:
    """Save the whole window under a new name once this frame is drawn, without the message of the last picture."""
    app.said_at = -math.inf
    app.when_drawn.append(partial(_save_drawn, app, note(app.spec, app.settings, screen.seen_of(app))))


def _save_drawn(app: App, remark: str, pixels: np.ndarray) -> None:
    try:
        path = files.save_png(pixels[..., :3], files.unused_name(".png", "dofview-window"), remark)
        app.report(f"saved {path}")
    except DofviewError as error:
        app.report(str(error))


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
        path = files.unused_name(".exr")
        export.save_parts(path, parts, note(app.spec, app.settings))
        app.report(f"saved {path}")
    except DofviewError as error:
        app.report(str(error))


def save_preset(app: App) -> None:
    """Save lens, method, parameters and display under a new name in the working folder."""
    try:
        path = files.unused_name(".toml", "preset")
        write_preset(path, app.settings)
        app.report(f"saved {path}")
    except DofviewError as error:
        app.report(str(error))


def _found(spec: str, folder: Path) -> str:
    """The scene's file, or one of its name beside the picture where it is not any more."""
    beside = folder / Path(spec).name
    if spec.startswith(DEMO) or Path(spec).is_file() or not beside.is_file():
        return spec
    return str(beside)


def _hint(text: str) -> None:
    if imgui.is_item_hovered(imgui.HoveredFlags_.for_tooltip):
        imgui.set_tooltip(text)
