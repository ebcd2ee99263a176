"""Any two pictures side by side under a line that is dragged, flipped by a key that is held, or all of them at once."""

from __future__ import annotations

import math
from enum import StrEnum
from typing import TYPE_CHECKING

from imgui_bundle import imgui

from dofview.gl.targets import Image
from dofview.methods import METHODS, method
from dofview.viewer.actions import SHIFT, Action, Gesture
from dofview.viewer.measure import Measure
from dofview.viewer.measurement import Measurement
from dofview.viewer.pictures import Pictures
from dofview.viewer.tool import Placed, Rect, Tool
from dofview.viewer.truth import REFERENCE, Truth

if TYPE_CHECKING:
    from dofview.viewer.app import App

GRIP_EM = 0.5
FLIP = imgui.Key.v


class Mode(StrEnum):
    """How pictures share the window."""

    ONE = "one picture"
    WIPE = "wipe"
    GRID = "grid of all"


class Compare(Tool):
    """Shows the method in use beside `other`."""

    title = "Comparison"

    def __init__(self) -> None:
        self.mode = Mode.ONE
        self.other = REFERENCE
        self.split = 0.5
        self.flipped = False
        self._dragging = False
        self._shown: dict[str, Image] = {}

    def actions(self) -> tuple[Action, ...]:
        return (
            Action("Wipe", int(imgui.Key.w), "W", "Show two pictures, with a line between them that can be dragged.",
                   lambda app: self._toggle(Mode.WIPE), "Compare"),
            Action("Grid of all", int(imgui.Key.k), "K", "Show the pictures of all methods at once.",
                   lambda app: self._toggle(Mode.GRID), "Compare"),
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
        if self.mode is Mode.GRID:
            able = (name for name in METHODS if app.gpu.version_code >= method(name).REQUIRES_GL)
            return tuple(name for name in able if name != app.settings.method)
        wanted = (self.mode is Mode.WIPE or self.flipped) and self.other != app.settings.method
        return (self.other,) if wanted else ()

    def update(self, app: App) -> None:
        io = imgui.get_io()
        self.flipped = imgui.is_key_down(FLIP) and not io.want_text_input and not io.key_ctrl
        pictures, names = app.tool(Pictures), self.names(app)
        pictures.keep(app, names, self.other)
        # One of many pictures is rendered in a frame, so that the window lives while the camera moves.
        turn = next((name for name in names if pictures.outdated(app, name)), None)
        found = {name: pictures.shown(app, name, late=self.mode is Mode.GRID and name != turn) for name in names}
        self._shown = {name: image for name, image in found.items() if image is not None}
        if names and (own := pictures.shown(app, app.settings.method)):
            self._shown[app.settings.method] = own

    def busy(self, app: App) -> bool:
        return any(app.tool(Pictures).outdated(app, name) for name in self.names(app))

    def draw_picture(self, app: App, rect: Rect, draw_list: imgui.ImDrawList) -> bool:
        if self.mode is Mode.GRID:
            self._draw_grid(app, rect, draw_list)
        elif self.flipped and self.other in self._shown:
            self._draw(app, self.other, rect, draw_list)
        elif self.mode is Mode.WIPE and self.other in self._shown:
            self._draw_wipe(app, rect, draw_list)
        return bool(app.placed)

    def over_picture(self, app: App, rect: Rect, hovered: bool) -> bool:
        if REFERENCE in self._shown and app.settings.method != REFERENCE and not app.tool(Measure).on:
            app.figure(Measurement(0.0, app.tool(Truth).quality).reference_text(), faint=True)
        if self.mode is not Mode.WIPE or self.flipped:
            return False
        io = imgui.get_io()
        line = rect.left + self.split * rect.width
        near = hovered and abs(io.mouse_pos.x - line) < GRIP_EM * imgui.get_font_size()
        if near and imgui.is_mouse_clicked(imgui.MouseButton_.left):
            self._dragging = True
        self._dragging &= imgui.is_mouse_down(imgui.MouseButton_.left)
        if near or self._dragging:
            imgui.set_mouse_cursor(imgui.MouseCursor_.resize_ew)
        if self._dragging:
            self.split = min(max((io.mouse_pos.x - rect.left) / rect.width, 0.0), 1.0)
        return self._dragging

    def panel(self, app: App) -> None:
        for mode in Mode:
            if imgui.radio_button(f"{mode.value}##mode", self.mode is mode):
                self.mode = mode
        titles = [method(name).TITLE for name in METHODS]
        self.other = METHODS[imgui.combo("with##other", METHODS.index(self.other), titles)[1]]
        if self.mode is Mode.WIPE:
            self.split = imgui.slider_float("line##split", self.split, 0.0, 1.0)[1]

    def _toggle(self, mode: Mode) -> None:
        self.mode = Mode.ONE if self.mode is mode else mode

    def _next(self, app: App, step: int) -> None:
        index = METHODS.index(self.other) + step
        # The method in use is itself beside no other.
        index += step * (METHODS[index % len(METHODS)] == app.settings.method)
        self.other = METHODS[index % len(METHODS)]

    def _swap(self, app: App) -> None:
        other, self.other = self.other, app.settings.method
        app.settings = app.settings.with_(method=other)

    def _draw(self, app: App, name: str, rect: Rect, draw_list: imgui.ImDrawList) -> None:
        linear = app.tool(Pictures).linear(app, name, late=True)
        if name in self._shown and linear is not None:
            rect.draw(draw_list, self._shown[name])
            app.placed.append(Placed(name, linear, rect))
        _label(draw_list, (rect.left, rect.top + rect.height), name, at_right=False)

    def _draw_wipe(self, app: App, rect: Rect, draw_list: imgui.ImDrawList) -> None:
        line, bottom = rect.left + self.split * rect.width, rect.top + rect.height
        rect.draw(draw_list, self._shown[app.settings.method])
        draw_list.push_clip_rect((line, rect.top), (rect.left + rect.width, bottom), True)
        rect.draw(draw_list, self._shown[self.other])
        draw_list.pop_clip_rect()
        pictures = app.tool(Pictures)
        for name in (app.settings.method, self.other):
            linear = pictures.linear(app, name, late=True)
            if linear is not None:
                app.placed.append(Placed(name, linear, rect))
        draw_list.add_line((line, rect.top), (line, bottom), 0xC0000000, 3.0)
        draw_list.add_line((line, rect.top), (line, bottom), 0xFFFFFFFF, 1.0)
        draw_list.add_circle_filled((line, rect.top + 0.5 * rect.height), GRIP_EM * imgui.get_font_size(), 0xFFFFFFFF)
        _label(draw_list, (line, bottom), app.settings.method, at_right=True)
        _label(draw_list, (line, bottom), self.other, at_right=False)

    def _draw_grid(self, app: App, rect: Rect, draw_list: imgui.ImDrawList) -> None:
        names = [name for name in METHODS if name in self._shown]
        if not names:
            return
        columns = math.ceil(math.sqrt(len(names)))
        rows = math.ceil(len(names) / columns)
        scale = 1.0 / max(columns, rows)
        width, height = rect.width * scale, rect.height * scale
        left, top = rect.left + 0.5 * (rect.width - columns * width), rect.top + 0.5 * (rect.height - rows * height)
        for number, name in enumerate(names):
            row, column = divmod(number, columns)
            cell = Rect(left + column * width, top + row * height, width - 2.0, height - 2.0, rect.part)
            self._draw(app, name, cell, draw_list)


def _label(draw_list: imgui.ImDrawList, corner: tuple[float, float], text: str, *, at_right: bool) -> None:
    """Write `text` above `corner`: to the left of it when that is the text's right end."""
    size, extent = imgui.get_font_size(), imgui.calc_text_size(text)
    left = corner[0] - extent.x - 0.6 * size if at_right else corner[0] + 0.6 * size
    top = corner[1] - 1.5 * size
    draw_list.add_rect_filled((left - 0.3 * size, top), (left + extent.x + 0.3 * size, top + 1.2 * size), 0xA0000000)
    draw_list.add_text((left, top + 0.1 * size), 0xFFFFFFFF, text)
