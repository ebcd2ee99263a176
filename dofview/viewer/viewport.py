"""The place where the picture is shown, and the gestures made over it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from imgui_bundle import imgui

from dofview.scene import navigation
from dofview.viewer.actions import Gesture
from dofview.viewer.tool import Rect

if TYPE_CHECKING:
    from dofview.viewer.app import App

ORBIT_DEG_PER_PICTURE = 180.0
BACKDROP = 0xB0141210
"""Behind text on the picture, ABGR."""

_BUTTONS = (
    imgui.ButtonFlags_.mouse_button_left
    | imgui.ButtonFlags_.mouse_button_right
    | imgui.ButtonFlags_.mouse_button_middle
)
GESTURES = (
    Gesture("left drag", "Turn around the pivot, which is in the middle of the picture."),
    Gesture("Shift+left drag, middle drag", "Shift the view."),
    Gesture("wheel", "Come nearer or go away."),
)


def draw(app: App) -> None:
    """Show the picture over the whole window, take gestures, write the figures over it."""
    origin = imgui.get_cursor_screen_pos()
    available = imgui.get_content_region_avail()
    factor = imgui.get_io().display_framebuffer_scale
    app.resize((round(available.x * factor.x), round(available.y * factor.y)))
    width, height = app.settings.image.size
    # As large as the picture, not as the room: its pixels are the screen's.
    rect = Rect(origin.x, origin.y, width / factor.x, height / factor.y, app.part)
    # Before the picture is handed to imgui: a resize replaces its texture.
    app.update()
    app.placed = []
    app.text_px = imgui.get_font_size() * factor.y
    image = app.screen.image(app)
    if image is not None:
        rect.draw(imgui.get_window_draw_list(), image)
        app.placed = app.screen.placed(app, rect)
        for tool in app.tools:
            tool.seen(app, image)
    imgui.invisible_button("canvas", (rect.width, rect.height), _BUTTONS)
    hovered, active = imgui.is_item_hovered(), imgui.is_item_active()
    mouse = imgui.get_mouse_pos()
    pointed_at = next((placed.rect for placed in app.placed if placed.rect.holds(mouse)), rect)
    taken = [tool.over_picture(app, pointed_at, hovered) for tool in app.tools]
    if not any(taken):
        camera = _navigate(app, pointed_at.height, hovered, active)
        if camera != app.settings.camera:
            app.settings = app.settings.with_(camera=camera)
    _write_figures(app, rect)


def _navigate(app: App, height: float, hovered: bool, active: bool):
    """Left drag orbits, Shift+left or middle drag pans, the wheel zooms."""
    io = imgui.get_io()
    camera = app.settings.camera
    if active and (io.mouse_delta.x or io.mouse_delta.y):
        right, down = io.mouse_delta.x / height, io.mouse_delta.y / height
        left_button = imgui.is_mouse_down(imgui.MouseButton_.left)
        if imgui.is_mouse_down(imgui.MouseButton_.middle) or (left_button and io.key_shift):
            camera = navigation.pan(camera, -right, down)
        elif left_button:
            camera = navigation.orbit(camera, right * ORBIT_DEG_PER_PICTURE, down * ORBIT_DEG_PER_PICTURE)
    if hovered and io.mouse_wheel:
        camera = navigation.zoom(camera, io.mouse_wheel)
    return camera


def _write_figures(app: App, rect: Rect) -> None:
    """The lines that app and tools left this frame, in the upper left corner."""
    draw_list, size = imgui.get_window_draw_list(), imgui.get_font_size()
    lines = app.take_figures()
    width = max(imgui.calc_text_size(line).x for line, _ in lines)
    left, top = rect.left + 0.8 * size, rect.top + 0.7 * size
    corner = (left + width + 0.5 * size, top + 1.3 * size * len(lines) + 0.2 * size)
    draw_list.add_rect_filled((left - 0.4 * size, top - 0.2 * size), corner, BACKDROP, 0.3 * size)
    for number, (line, faint) in enumerate(lines):
        draw_list.add_text((left, top + 1.3 * number * size), 0xFFB0B0B0 if faint else 0xFFFFFFFF, line)
