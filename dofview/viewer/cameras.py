"""Ways through a scene: flying, views along the axes, the file's own cameras, a pivot of one's choice, the keyboard."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from imgui_bundle import imgui

from dofview.framing import opening
from dofview.lens import focal_px
from dofview.scene import navigation
from dofview.scene.camera import Camera
from dofview.viewer.actions import CTRL, SHIFT, Action, Gesture
from dofview.viewer.tool import Rect, Tool
from dofview.viewer.widgets import edit, plain

if TYPE_CHECKING:
    from dofview.viewer.app import App

GLIDE_S = 0.3
LONGEST_STEP_S = 0.1
"""A frame that took longer moves no further: who flies must see where."""

TURN_DEG, SHIFT_SHARE = 5.0, 0.05
AXES = (
    ("right", "X", (1.0, 0.0, 0.0), imgui.Key.x, 0), ("left", "Shift+X", (-1.0, 0.0, 0.0), imgui.Key.x, SHIFT),
    ("top", "Y", (0.0, 1.0, 0.0), imgui.Key.y, 0), ("bottom", "Shift+Y", (0.0, -1.0, 0.0), imgui.Key.y, SHIFT),
    ("front", "Z", (0.0, 0.0, 1.0), imgui.Key.z, 0), ("back", "Shift+Z", (0.0, 0.0, -1.0), imgui.Key.z, SHIFT),
)  # fmt: skip
_STEPS = (
    (imgui.Key.d, (1, 0, 0)), (imgui.Key.a, (-1, 0, 0)), (imgui.Key.e, (0, 1, 0)), (imgui.Key.q, (0, -1, 0)),
    (imgui.Key.w, (0, 0, 1)), (imgui.Key.s, (0, 0, -1)),
)  # fmt: skip


class Cameras(Tool):
    """Moves the camera by more than a drag."""

    title = "Camera"

    def __init__(self) -> None:
        self.speed = 1.0
        self._flying = False
        self._glide: tuple[Camera, Camera, float] | None = None
        self._set: Camera | None = None
        self._flown_at = 0.0

    def actions(self) -> tuple[Action, ...]:
        return (
            Action("Fit", int(imgui.Key.f), "F", "See the whole scene from this direction.",
                   lambda app: self.go(app, navigation.fit(app.settings.camera, app.scene.bounds)), "Camera",
                   on_release=True),
            Action("Reset view", int(imgui.Key.home), "Home", "Go back to the view the scene was opened with.",
                   self._reset, "Camera"),
            *(Action(f"View from {name}", modifier | int(key), text, f"See the whole scene from {_where(name)}.",
                     self._toward(direction), "Camera") for name, text, direction, key, modifier in AXES),
            Action("Pivot in the middle", int(imgui.Key.p), "P", "Turn around what is in the middle of the picture.",
                   lambda app: self.look_at(app, (0.5, 0.5)), "Camera"),
            Action("Next camera", int(imgui.Key.c), "C", "Look through the next camera of the file.", self._next,
                   "Camera"),
            *_steps(),
        )  # fmt: skip

    def gestures(self) -> tuple[Gesture, ...]:
        return (
            Gesture("double click", "Look at what is there and turn around it from now on."),
            Gesture("right drag", "Look around."),
            Gesture("right button and W A S D, E Q",
                    "Fly forward, left, back, right, up, down; Shift is four times as fast, the wheel sets the speed."),
        )  # fmt: skip

    def go(self, app: App, camera: Camera) -> None:
        """Take the view of `camera`, gliding there unless motion is reduced."""
        if app.interface.reduced_motion:
            app.settings = app.settings.with_(camera=camera)
        else:
            self._glide, self._set = (app.settings.camera, camera, app.clock()), app.settings.camera

    def look_at(self, app: App, point: tuple[float, float]) -> None:
        """Make what is at `point` of the picture the pivot."""
        inverse = app.pipeline.inverse_depth(app.settings, *point)
        if inverse > 0.0:
            self.go(app, app.settings.camera.model_copy(update={"target": world_point(app, point, 1.0 / inverse)}))
        else:
            app.report("nothing there to turn around")

    def update(self, app: App) -> None:
        if self._glide is None:
            return
        start, end, began = self._glide
        share = min((app.clock() - began) / GLIDE_S, 1.0)
        if share >= 1.0 or app.settings.camera != self._set:
            self._glide = None
        if app.settings.camera == self._set:
            self._set = navigation.between(start, end, share * share * (3.0 - 2.0 * share))
            app.settings = app.settings.with_(camera=self._set)

    def over_picture(self, app: App, rect: Rect, hovered: bool) -> bool:
        mouse = imgui.get_mouse_pos()
        plain_click = not (imgui.get_io().key_ctrl or imgui.is_key_down(imgui.Key.f))
        if hovered and plain_click and imgui.is_mouse_double_clicked(imgui.MouseButton_.left):
            self.look_at(app, rect.share(mouse))
        if hovered and imgui.is_mouse_clicked(imgui.MouseButton_.right):
            self._flying = True
            self._flown_at = app.clock()
        self._flying &= imgui.is_mouse_down(imgui.MouseButton_.right)
        if self._flying:
            camera = self._flown(app.settings.camera, rect.height, app.clock() - self._flown_at)
            if camera != app.settings.camera:
                app.settings = app.settings.with_(camera=camera)
            self._flown_at = app.clock()
        return self._flying

    def busy(self, app: App) -> bool:
        return self._glide is not None or (self._flying and any(imgui.is_key_down(key) for key, _ in _STEPS))

    def menu(self, app: App, menu: str) -> None:
        if menu != "Camera" or not app.scene.cameras:
            return
        imgui.separator()
        for number, camera in enumerate(app.scene.cameras):
            if imgui.menu_item_simple(f"{plain(camera.name) or f'Camera {number}'}##camera{number}"):
                self.look_through(app, number)

    def panel(self, app: App) -> None:
        camera = edit(app.settings.camera, only=("vfov_deg",), ranges={"vfov_deg": (5.0, 120.0)})
        if camera != app.settings.camera:
            app.settings = app.settings.with_(camera=camera)
        self.speed = imgui.slider_float("flying speed##speed", self.speed, 0.01, 100.0, "%.3g",
                                        imgui.SliderFlags_.logarithmic)[1]  # fmt: skip
        for number, (name, _, direction, _, _) in enumerate(AXES):
            if number % 3:
                imgui.same_line()
            if imgui.button(f"{name}##view", (5.5 * imgui.get_font_size(), 0.0)):
                self._toward(direction)(app)
        for number, other in enumerate(app.scene.cameras):
            if imgui.selectable(f"{plain(other.name) or f'Camera {number}'}##filecamera{number}", False)[0]:
                self.look_through(app, number)

    def look_through(self, app: App, number: int) -> None:
        """Take the view of a camera of the file."""
        self.go(app, opening(app.scene, "", app.settings, str(number)).camera)

    def _flown(self, camera: Camera, height: float, passed_s: float) -> Camera:
        io = imgui.get_io()
        if io.mouse_wheel:
            self.speed = min(max(self.speed * 1.2**io.mouse_wheel, 0.01), 100.0)
        if io.mouse_delta.x or io.mouse_delta.y:
            degrees = 1.5 * camera.vfov_deg / height
            camera = navigation.look(camera, io.mouse_delta.x * degrees, -io.mouse_delta.y * degrees)
        moving = np.sum([step for key, step in _STEPS if imgui.is_key_down(key)] or [(0, 0, 0)], axis=0)
        if moving.any():
            fast = 4.0 if io.key_shift else 1.0
            camera = navigation.fly(
                camera, *moving * (self.speed * fast * camera.distance * min(max(passed_s, 0.0), LONGEST_STEP_S))
            )
        return camera

    def _toward(self, direction: tuple[float, float, float]) -> Callable[[App], None]:
        return lambda app: self.go(app, navigation.toward(app.settings.camera, app.scene.bounds, direction))

    def _reset(self, app: App) -> None:
        app.settings = app.settings.with_(lens=app.home.lens)
        self.go(app, app.home.camera)

    def _next(self, app: App) -> None:
        count = len(app.scene.cameras)
        if not count:
            app.report("this file has no cameras")
            return
        seen = [opening(app.scene, "", app.settings, str(number)).camera for number in range(count)]
        self.go(app, seen[(seen.index(app.settings.camera) + 1) % count if app.settings.camera in seen else 0])


def world_point(app: App, point: tuple[float, float], depth: float) -> tuple[float, float, float]:
    """The place in the world at a point of the picture, `depth` along the view axis."""
    camera, (width, height) = app.settings.camera, app.settings.image.size
    pixels = focal_px(height, camera.vfov_deg)
    seen = np.array([(point[0] - 0.5) * width / pixels, (0.5 - point[1]) * height / pixels, -1.0]) * depth
    return tuple(float(x) for x in np.asarray(camera.position) + seen @ camera.axes())  # type: ignore[return-value]


def _where(name: str) -> str:
    return {"top": "above", "bottom": "below", "front": "the front", "back": "behind"}.get(name, f"the {name}")


def _steps() -> tuple[Action, ...]:
    """Turning, shifting and zooming by keyboard."""

    def action(name: str, key: int, text: str, help_text: str, change: Callable[[Camera], Camera]) -> Action:
        def run(app: App) -> None:
            app.settings = app.settings.with_(camera=change(app.settings.camera))

        return Action(name, CTRL | key, f"Ctrl+{text}", help_text, run, "Camera", repeat=True)

    found = []
    for name, x, y in (("left", -1, 0), ("right", 1, 0), ("up", 0, 1), ("down", 0, -1)):
        key, text = int(getattr(imgui.Key, f"{name}_arrow")), name.capitalize()
        turned = partial(navigation.orbit, right_deg=-x * TURN_DEG, up_deg=y * TURN_DEG)
        shifted = partial(navigation.pan, right=x * SHIFT_SHARE, up=y * SHIFT_SHARE)
        found += [
            action(f"Turn {name}", key, text, f"Move the camera around the pivot, {name}.", turned),
            action(f"Shift {name}", SHIFT | key, f"Shift+{text}", f"Shift the view {name}.", shifted),
        ]
    nearer, away = partial(navigation.zoom, steps=1.0), partial(navigation.zoom, steps=-1.0)
    return (
        *found,
        action("Nearer", int(imgui.Key.page_up), "Page Up", "Come nearer to the pivot.", nearer),
        action("Away", int(imgui.Key.page_down), "Page Down", "Go away from the pivot.", away),
    )
