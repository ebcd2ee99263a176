"""Focus by hand: by click, by wheel, by keys; and the overlay that shows what is in focus."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from imgui_bundle import imgui

from dofview.gl.targets import Image
from dofview.lens import depth_of_field, focal_px, hyperfocal_distance
from dofview.methods import method
from dofview.seen import overlays
from dofview.seen.model import Band
from dofview.viewer.actions import Action, Gesture
from dofview.viewer.tool import Rect, Tool
from dofview.viewer.widgets import edit

if TYPE_CHECKING:
    from dofview.viewer.app import App

CLICK_RADIUS = 0.006
"""The depth under a click is the median within this share of the picture's height."""

STEP = 1.04
"""A step of wheel or key changes the distance in dioptres by this factor."""

APERTURE_STEP = 2.0 ** (1.0 / 6.0)
"""A third of a stop."""


class Focusing(Tool):
    """Moves the focus and shows where it is."""

    title = "Focus"

    def __init__(self) -> None:
        self.shown = False
        self.band = Band()
        self._overlay: Image | None = None
        self._drawn: object = None
        self._pressed = False

    def actions(self) -> tuple[Action, ...]:
        return (
            Action("Focus in the middle", int(imgui.Key.period), ".", "Focus on what is in the middle of the picture.",
                   lambda app: focus_at(app, (0.5, 0.5)), "Focus"),
            Action("Focus nearer", int(imgui.Key.left_bracket), "[", "Bring the focus nearer.",
                   lambda app: _refocus(app, 1.0), "Focus", repeat=True),
            Action("Focus farther", int(imgui.Key.right_bracket), "]", "Move the focus away.",
                   lambda app: _refocus(app, -1.0), "Focus", repeat=True),
            Action("Wider aperture", int(imgui.Key.equal), "=", "Open the lens by a third of a stop.",
                   lambda app: _open(app, APERTURE_STEP), "Focus", repeat=True),
            Action("Narrower aperture", int(imgui.Key.minus), "-", "Close the lens by a third of a stop.",
                   lambda app: _open(app, 1.0 / APERTURE_STEP), "Focus", repeat=True),
            Action("Show what is in focus", int(imgui.Key.b), "B",
                   "Tint what is in focus, with its near and far limit and the focal plane.",
                   lambda app: self._toggle(), "Focus"),
        )  # fmt: skip

    def gestures(self) -> tuple[Gesture, ...]:
        return (
            Gesture("Ctrl+click, F+click", "Focus on what is there; drag to go on focusing."),
            Gesture("Ctrl+wheel", "Move the focus nearer or farther."),
        )

    @property
    def overlay(self) -> Image | None:
        """What is laid over pictures while it is shown."""
        return self._overlay if self.shown else None

    def update(self, app: App) -> None:
        if not self.shown or app.result is None:
            return
        settings, wanted = app.settings, (app.picture_key, app.generation, self.band)
        if wanted != self._drawn or self._overlay is None or self._overlay not in app.gpu.targets:
            frame = app.pipeline.frame(settings, guard=method(settings.method).GUARD_BAND)
            self._overlay = overlays.in_focus(app.gpu, frame, settings.image.size, self.band, "focus band")
            self._drawn = wanted
        app.gpu.targets.touch(self._overlay)

    def over_picture(self, app: App, rect: Rect, hovered: bool) -> bool:
        io = imgui.get_io()
        if self.shown and self._overlay is not None:
            for line in limits(app, self.band.blur_px):
                app.figure(line)
        if hovered and imgui.is_mouse_clicked(imgui.MouseButton_.left):
            self._pressed = io.key_ctrl or imgui.is_key_down(imgui.Key.f)
            if self._pressed:
                focus_at(app, rect.share(io.mouse_pos))
        self._pressed &= imgui.is_mouse_down(imgui.MouseButton_.left)
        if self._pressed and (io.mouse_delta.x or io.mouse_delta.y):
            focus_at(app, rect.share(io.mouse_pos))
        if hovered and io.key_ctrl and io.mouse_wheel:
            _refocus(app, io.mouse_wheel)
            return True
        return self._pressed

    def panel(self, app: App) -> None:
        self.shown = imgui.checkbox("show what is in focus##band", self.shown)[1]
        self.band = edit(self.band)
        for line in limits(app, self.band.blur_px):
            imgui.text_disabled(line)

    def _toggle(self) -> None:
        self.shown = not self.shown


def focus_at(app: App, point: tuple[float, float]) -> None:
    """Focus on what is at `point` of the picture; where nothing is, the focus stays."""
    inverse = app.pipeline.inverse_depth(app.settings, *point, radius=CLICK_RADIUS)
    if inverse > 0.0:
        set_focus(app, 1.0 / inverse)
    else:
        app.report("nothing there to focus on")


def set_focus(app: App, distance: float) -> None:
    """Focus at `distance`, scene units."""
    lens = app.settings.lens.model_copy(update={"focus_distance": distance})
    if lens != app.settings.lens:
        app.settings = app.settings.with_(lens=lens)


def limits(app: App, blur_px: float) -> tuple[str, str]:
    """Near and far limit of what is in focus, and the hyperfocal distance, in words and scene units."""
    lens = app.settings.lens
    pixels = focal_px(app.settings.image.size[1], app.settings.camera.vfov_deg)
    near, far = (_text(distance) for distance in depth_of_field(lens, pixels, blur_px))
    hyperfocal = _text(hyperfocal_distance(lens, pixels, blur_px))
    return (
        f"in focus from {near} to {far}, focal plane {_text(lens.focus_distance)}",
        f"hyperfocal distance {hyperfocal}",
    )


def _text(distance: float) -> str:
    return "infinity" if math.isinf(distance) else f"{distance:.4g}"


def _refocus(app: App, steps: float) -> None:
    size = math.dist(*app.scene.bounds) or 1.0
    distance = app.settings.lens.focus_distance
    # Back from infinity the focus begins at the far end of the scene.
    distance = min(distance, max(10.0 * size, app.settings.camera.distance)) if steps > 0.0 else distance
    set_focus(app, distance * STEP**-steps)


def _open(app: App, factor: float) -> None:
    lens = app.settings.lens
    radius = lens.radius * factor if lens.radius > 0.0 else math.dist(*app.scene.bounds) * 1e-3
    if radius <= 1e12:
        app.settings = app.settings.with_(lens=lens.model_copy(update={"radius": radius}))
