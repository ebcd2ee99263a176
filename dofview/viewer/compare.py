"""Any two pictures side by side under a line that is dragged, flipped by a key that is held, or all of them at once."""

from __future__ import annotations

from typing import TYPE_CHECKING

from imgui_bundle import imgui

from dofview.gl.targets import Image
from dofview.methods import METHODS, method
from dofview.seen.model import Arrangement
from dofview.viewer.actions import SHIFT, Action, Gesture
from dofview.viewer.measurement import Measurement
from dofview.viewer.pictures import Pictures
from dofview.viewer.tool import Rect, Tool
from dofview.viewer.truth import REFERENCE, Truth

if TYPE_CHECKING:
    from dofview.viewer.app import App

GRIP_EM = 0.5
FLIP = imgui.Key.v


class Compare(Tool):
    """Shows the method in use beside `other`."""

    title = "Comparison"

    def __init__(self) -> None:
        self.mode = Arrangement.ONE
        self.other = REFERENCE
        self.split = 0.5
        self.flipped = False
        self._dragging = False
        self.shown: dict[str, Image] = {}
        """What is there of the pictures on the screen, as they are shown."""

    def actions(self) -> tuple[Action, ...]:
        return (
            Action("Wipe", int(imgui.Key.w), "W", "Show two pictures, with a line between them that can be dragged.",
                   lambda app: self._toggle(Arrangement.WIPE), "Compare"),
            Action("Grid of all", int(imgui.Key.k), "K", "Show the pictures of all methods at once.",
                   lambda app: self._toggle(Arrangement.GRID), "Compare"),
            Action("Flip", int(FLIP), "V", "Show the other picture while the key is held.", lambda app: None,
                   "Compare"),
            Action("Next other picture", int(imgui.Key.n), "N", "Compare with the next method.",
                   lambda app: self._next(app, 1), "Compare"),
            Action("Previous other picture", SHIFT | int(imgui.Key.n), "Shift+N", "Compare with the method before.",
                   lambda app: self._next(app, -1), "Compare"),
            Action("Swap the two", int(imgui.Key.u), "U", "Use the other method and compare with this one.",
                   self._swap, "Compare"),
        )  # fmt: skip

    def gestures(self) -> tuple[Gesture, ...]:
        return (Gesture("drag the line", "Wipe between two pictures."),)

    def names(self, app: App) -> tuple[str, ...]:
        """The methods whose pictures are on the screen besides the one in use."""
        if self.mode is Arrangement.GRID:
            able = (name for name in METHODS if app.gpu.version_code >= method(name).REQUIRES_GL)
            return tuple(name for name in able if name != app.settings.method)
        wanted = (self.mode is Arrangement.WIPE or self.flipped) and self.other != app.settings.method
        return (self.other,) if wanted else ()

    def update(self, app: App) -> None:
        io = imgui.get_io()
        self.flipped = imgui.is_key_down(FLIP) and not io.want_text_input and not io.key_ctrl
        pictures, names = app.tool(Pictures), self.names(app)
        pictures.keep(app, names, self.other)
        # One of many pictures is rendered in a frame, so that the window lives while the camera moves.
        turn = next((name for name in names if pictures.outdated(app, name)), None)
        found = {name: pictures.shown(app, name, late=self.mode is Arrangement.GRID and name != turn) for name in names}
        self.shown = {name: image for name, image in found.items() if image is not None}
        if own := pictures.shown(app, app.settings.method):
            self.shown[app.settings.method] = own

    def front(self, app: App) -> str:
        """The method whose picture is in front: the one in use, or the other while it is flipped to."""
        return self.other if self.flipped and self.other in self.shown else app.settings.method

    def busy(self, app: App) -> bool:
        return any(app.tool(Pictures).outdated(app, name) for name in self.names(app))

    def over_picture(self, app: App, rect: Rect, hovered: bool) -> bool:
        if REFERENCE in self.shown and app.settings.method != REFERENCE:
            app.figure(Measurement(0.0, app.tool(Truth).quality).reference_text(), faint=True)
        if self.mode is not Arrangement.WIPE or self.flipped or len(app.placed) != 2:
            return False
        io = imgui.get_io()
        line = rect.left + self.split * rect.width
        near = hovered and abs(io.mouse_pos.x - line) < GRIP_EM * imgui.get_font_size()
        if near and imgui.is_mouse_clicked(imgui.MouseButton_.left):
            self._dragging = True
        self._dragging &= imgui.is_mouse_down(imgui.MouseButton_.left)
        grip = (line, rect.top + 0.5 * rect.height)
        imgui.get_window_draw_list().add_circle_filled(grip, GRIP_EM * imgui.get_font_size(), 0xFFFFFFFF)
        if near or self._dragging:
            imgui.set_mouse_cursor(imgui.MouseCursor_.resize_ew)
        if self._dragging:
            self.split = min(max((io.mouse_pos.x - rect.left) / rect.width, 0.0), 1.0)
        return self._dragging

    def panel(self, app: App) -> None:
        for mode in Arrangement:
            if imgui.radio_button(f"{mode.value}##mode", self.mode is mode):
                self.mode = mode
        titles = [method(name).TITLE for name in METHODS]
        self.other = METHODS[imgui.combo("with##other", METHODS.index(self.other), titles)[1]]
        if self.mode is Arrangement.WIPE:
            self.split = imgui.slider_float("line##split", self.split, 0.0, 1.0)[1]

    def _toggle(self, mode: Arrangement) -> None:
        self.mode = Arrangement.ONE if self.mode is mode else mode

    def _next(self, app: App, step: int) -> None:
        index = METHODS.index(self.other) + step
        # The method in use is itself beside no other.
        index += step * (METHODS[index % len(METHODS)] == app.settings.method)
        self.other = METHODS[index % len(METHODS)]

    def _swap(self, app: App) -> None:
        other, self.other = self.other, app.settings.method
        app.settings = app.settings.with_(method=other)
