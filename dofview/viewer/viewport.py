"""The place where the picture is shown, and the gestures made over it."""

from __future__ import annotations

import statistics
from typing import TYPE_CHECKING

from imgui_bundle import imgui

from dofview.viewer import navigation

if TYPE_CHECKING:
    from dofview.viewer.app import App

ORBIT_DEG_PER_PICTURE = 180.0
_BUTTONS = (
    imgui.ButtonFlags_.mouse_button_left
    | imgui.ButtonFlags_.mouse_button_right
    | imgui.ButtonFlags_.mouse_button_middle
)


def draw(app: App) -> None:
    """Show the picture over the whole window, take gestures, write the figures over it."""
    origin = imgui.get_cursor_screen_pos()
    available = imgui.get_content_region_avail()
    factor = imgui.get_io().display_framebuffer_scale
    app.resize((round(available.x * factor.x), round(available.y * factor.y)))
    # Before the picture is handed to imgui: a resize replaces its texture.
    app.update()
    if app.shown is not None:
        # OpenGL's first row is the lowest: v runs upwards.
        imgui.image(imgui.ImTextureRef(app.shown.texture.glo), available, (0.0, 1.0), (1.0, 0.0))
        imgui.set_cursor_screen_pos(origin)
    imgui.invisible_button("canvas", (max(available.x, 1.0), max(available.y, 1.0)), _BUTTONS)
    _gestures(app, max(available.y, 1.0))
    _figures(app, origin)


def _gestures(app: App, height: float) -> None:
    io = imgui.get_io()
    camera = app.settings.camera
    if imgui.is_item_active():
        right, down = io.mouse_delta.x / height, io.mouse_delta.y / height
        panning = imgui.is_mouse_down(imgui.MouseButton_.middle) or (
            imgui.is_mouse_down(imgui.MouseButton_.left) and io.key_shift
        )
        if right or down:
            if panning:
                camera = navigation.pan(camera, -right, down)
            elif imgui.is_mouse_down(imgui.MouseButton_.left):
                camera = navigation.orbit(camera, right * ORBIT_DEG_PER_PICTURE, down * ORBIT_DEG_PER_PICTURE)
            elif imgui.is_mouse_down(imgui.MouseButton_.right):
                camera = navigation.zoom(camera, -down * 20.0)
    if imgui.is_item_hovered() and io.mouse_wheel:
        camera = navigation.zoom(camera, io.mouse_wheel)
    if camera != app.settings.camera:
        app.settings = app.settings.with_(camera=camera)


def _figures(app: App, origin: imgui.ImVec2) -> None:
    """Method, frame time and PSNR in the corner; a message at the foot."""
    draw_list = imgui.get_window_draw_list()
    size = imgui.get_font_size()
    lines = [app.settings.method]
    if app.milliseconds:
        lines[0] += f"   {statistics.median(app.milliseconds[-9:]):.1f} ms"
    if app.measuring and app.settings.method != "accumulation":
        lines.append(app.measurement.psnr_text())
    if app.measuring or app.settings.method == "accumulation":
        lines.append(app.measurement.reference_text())
    if app.message:
        lines.append(app.message)
    for number, line in enumerate(lines):
        position = (origin.x + 0.7 * size, origin.y + (0.5 + 1.3 * number) * size)
        shadow = (position[0] + 1.0, position[1] + 1.0)
        faint = number == 1 and app.measuring and not app.measurement.trustworthy
        draw_list.add_text(shadow, 0xC0000000, line)
        draw_list.add_text(position, 0xFFA0A0A0 if faint else 0xFFFFFFFF, line)
