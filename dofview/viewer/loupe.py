"""Pan and zoom inside the picture, down to single pixels with their values: the same part of every picture shown."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from imgui_bundle import imgui

from dofview.gl.compose import Part
from dofview.viewer.actions import ALT, SHIFT, Action, Gesture
from dofview.viewer.inspect import texel
from dofview.viewer.tool import Placed, Rect, Tool
from dofview.viewer.truth import REFERENCE

if TYPE_CHECKING:
    from dofview.viewer.app import App

STEP = 1.25
MOST_PX = 64.0
"""Most of the screen that one pixel fills, and the most of it at pixel level."""

PIXEL_LEVEL_PX = 16.0
VALUES_FROM_PX = 8.0
PAN_SHARE = 0.1


class Loupe(Tool):
    """Moves `app.part`, and reads the pixels under the cursor."""

    title = "Loupe"

    def __init__(self) -> None:
        self.values = False
        self.lines: list[str] = []
        self._read: object = None
        self._dragging = False

    def actions(self) -> tuple[Action, ...]:
        arrows = (("left", -1, 0), ("right", 1, 0), ("up", 0, -1), ("down", 0, 1))
        return (
            Action("Pixel level", int(imgui.Key.l), "L", "Zoom to single pixels under the cursor, and back.",
                   self._toggle, "Compare"),
            Action("Values under the cursor", SHIFT | int(imgui.Key.l), "Shift+L",
                   "Show what the pictures hold under the cursor; at pixel level it is always shown.",
                   lambda app: self._toggle_values(), "Compare"),
            Action("Whole picture", ALT | int(imgui.Key.home), "Alt+Home", "End the zoom into the picture.",
                   lambda app: setattr(app, "part", Part()), "Compare"),
            Action("Zoom in", ALT | int(imgui.Key.page_up), "Alt+Page Up", "Zoom into the picture.",
                   lambda app: zoom(app, STEP, (0.5, 0.5)), "Compare", repeat=True),
            Action("Zoom out", ALT | int(imgui.Key.page_down), "Alt+Page Down", "Zoom out of the picture.",
                   lambda app: zoom(app, 1.0 / STEP, (0.5, 0.5)), "Compare", repeat=True),
            *(Action(f"Pan {name}", ALT | int(getattr(imgui.Key, f"{name}_arrow")), f"Alt+{name.capitalize()}",
                     f"See a part of the picture farther {name}.", _panning(x, y), "Compare", repeat=True)
              for name, x, y in arrows),
        )  # fmt: skip

    def gestures(self) -> tuple[Gesture, ...]:
        return (
            Gesture("Alt+wheel", "Zoom into the picture, up to single pixels and their values."),
            Gesture("Alt+drag", "Shift the part of the picture that is seen."),
        )

    def over_picture(self, app: App, rect: Rect, hovered: bool) -> bool:
        io = imgui.get_io()
        at = (io.mouse_pos.x - rect.left) / rect.width, (io.mouse_pos.y - rect.top) / rect.height
        zooming = hovered and io.key_alt and bool(io.mouse_wheel)
        if zooming:
            zoom(app, STEP**io.mouse_wheel, at)
        if hovered and io.key_alt and imgui.is_mouse_clicked(imgui.MouseButton_.left):
            self._dragging = True
        self._dragging &= imgui.is_mouse_down(imgui.MouseButton_.left)
        if self._dragging and (io.mouse_delta.x or io.mouse_delta.y):
            pan(app, -io.mouse_delta.x / rect.width, -io.mouse_delta.y / rect.height)
        if hovered and (self.values or pixel_size(app, rect) >= VALUES_FROM_PX):
            self._show_values(app, rect)
        return zooming or self._dragging

    def panel(self, app: App) -> None:
        self.values = imgui.checkbox("values under the cursor##values", self.values)[1]
        factor = 1.0 / app.part.width
        changed, wanted = imgui.slider_float(
            "zoom##zoom", factor, 1.0, _most(app), "%.1f", imgui.SliderFlags_.logarithmic
        )  # fmt: skip
        if changed:
            zoom(app, wanted / factor, (0.5, 0.5))
        for line in self.lines if self.values else ():
            imgui.text_disabled(line)

    def _toggle(self, app: App) -> None:
        if app.part != Part():
            app.part = Part()
            return
        mouse = imgui.get_mouse_pos()
        rect = next((placed.rect for placed in app.placed if placed.rect.holds(mouse)), None)
        at = rect.share(mouse) if rect else (0.5, 0.5)
        zoom(app, PIXEL_LEVEL_PX / _pixel_of_whole(app), at)

    def _toggle_values(self) -> None:
        self.values = not self.values

    def _show_values(self, app: App, rect: Rect) -> None:
        """A box beside the cursor: the pixel, and each picture's values there."""
        mouse, size = imgui.get_mouse_pos(), imgui.get_font_size()
        self._read_values(app, [p for p in app.placed if p.rect.holds(mouse)], rect.share(mouse))
        width = max((imgui.calc_text_size(line).x for line in self.lines), default=0.0)
        height = 1.2 * size * len(self.lines)
        origin, extent = imgui.get_window_pos(), imgui.get_window_size()
        left = min(mouse.x + size, origin.x + extent.x - width - size)
        top = min(mouse.y + size, origin.y + extent.y - height - size)
        draw_list = imgui.get_window_draw_list()
        corner = (left + width + 0.4 * size, top + height + 0.2 * size)
        draw_list.add_rect_filled((left - 0.4 * size, top - 0.2 * size), corner, 0xD0101010)
        for number, line in enumerate(self.lines):
            draw_list.add_text((left, top + 1.2 * size * number), 0xFFFFFFFF, line)

    def _read_values(self, app: App, under: list[Placed], share: tuple[float, float]) -> None:
        """Read again only where the cursor or the pictures have moved on."""
        key = (share, app.scene_renders, app.generation, [(p.image.name, p.image.texture.glo, p.layer) for p in under])
        if key == self._read:
            return
        self._read, self.lines = key, []
        for placed in under:
            width, height = placed.image.size
            x, y = int(share[0] * width), int(share[1] * height)
            if not (0 <= x < width and 0 <= y < height):
                continue
            if not self.lines:
                self.lines.append(f"pixel {x}, {y}")
            values = texel(app.gpu, placed.image, x, y, placed.layer)
            if placed.image.name in ("picture", "reference") or placed.image.name.startswith("compare/"):
                values = values[:3]
            self.lines.append(f"{placed.label}: " + "  ".join(f"{value:.4g}" for value in values))
        self.lines += _surface(app, share) if self.lines else []


def zoom(app: App, factor: float, at: tuple[float, float]) -> None:
    """Enlarge by `factor`; what is at `at`, shares of the place of the picture, stays where it is."""
    part = app.part
    width = min(max(part.width / factor, 1.0 / _most(app)), 1.0)
    height = part.height * width / part.width
    left = part.left + at[0] * (part.width - width)
    app.part = _inside(Part(left, part.top + at[1] * (part.height - height), width, height))


def pan(app: App, x: float, y: float) -> None:
    """Shift by shares of what is seen."""
    part = app.part
    app.part = _inside(part._replace(left=part.left + x * part.width, top=part.top + y * part.height))


def pixel_size(app: App, rect: Rect) -> float:
    """How much of the screen one pixel of the picture fills."""
    return rect.width / (rect.part.width * app.settings.image.size[0])


def _pixel_of_whole(app: App) -> float:
    rect = app.placed[0].rect if app.placed else None
    return rect.width / app.settings.image.size[0] if rect else 1.0


def _most(app: App) -> float:
    return max(MOST_PX / _pixel_of_whole(app), 2.0)


def _inside(part: Part) -> Part:
    left = min(max(part.left, 0.0), 1.0 - part.width)
    return part._replace(left=left, top=min(max(part.top, 0.0), 1.0 - part.height))


def _panning(x: int, y: int) -> Callable[[App], None]:
    return lambda app: pan(app, x * PAN_SHARE, y * PAN_SHARE)


def _surface(app: App, share: tuple[float, float]) -> list[str]:
    """Distance and blur of the surface there; the reference has no picture through the lens's centre."""
    if app.result is None or app.settings.method == REFERENCE:
        return []
    frame = app.result.frame
    depth = frame.pinhole().inverse_depth
    x, y = (int(s * size) + frame.guard for s, size in zip(share, frame.inner_size, strict=True))
    inverse = float(texel(app.gpu, depth, min(x, depth.size[0] - 1), min(y, depth.size[1] - 1))[0])
    blur = float(np.asarray(frame.coc.radius_px(inverse)))
    return [f"distance {1.0 / inverse:.4g}, blur {blur:+.2f} px" if inverse > 0.0 else f"nothing, blur {blur:+.2f} px"]
