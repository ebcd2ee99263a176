"""Colours and shapes of the interface, light and dark: quiet greys around the picture, blue for what can be used."""

from __future__ import annotations

from imgui_bundle import imgui

from dofview.viewer.store import Theme

DARK = {
    "text": 0xE6E9ED, "text_disabled": 0xA3ABB6, "window_bg": 0x1D2025, "popup_bg": 0x262A31, "menu_bar_bg": 0x15171B,
    "border": 0x434B57, "frame_bg": 0x2B3038, "frame_bg_hovered": 0x363D48, "frame_bg_active": 0x414A58,
    "title_bg": 0x15171B, "title_bg_active": 0x24344A, "scrollbar_bg": 0x1D2025, "scrollbar_grab": 0x454D59,
    "scrollbar_grab_hovered": 0x5A6472, "scrollbar_grab_active": 0x6F7B8B, "check_mark": 0x74B4F5,
    "slider_grab": 0x5596DB, "slider_grab_active": 0x7DBBFA, "button": 0x2F4A6B, "button_hovered": 0x3C5F8A,
    "button_active": 0x4A75A8, "header": 0x2C3A4C, "header_hovered": 0x385071, "header_active": 0x456491,
    "separator": 0x434B57, "plot_histogram": 0x5596DB, "plot_lines": 0x7DBBFA, "table_header_bg": 0x2B3038,
    "table_border_light": 0x363D48, "table_row_bg": 0x1D2025, "table_row_bg_alt": 0x24282E, "text_link": 0x74B4F5,
    "nav_cursor": 0xFFC857, "text_selected_bg": 0x35639A, "input_text_cursor": 0xE6E9ED,
}  # fmt: skip
LIGHT = {
    "text": 0x1A1D21, "text_disabled": 0x59616B, "window_bg": 0xF2F3F5, "popup_bg": 0xFBFBFC, "menu_bar_bg": 0xE3E6EA,
    "border": 0xB4BBC5, "frame_bg": 0xFFFFFF, "frame_bg_hovered": 0xE9F1FB, "frame_bg_active": 0xD9E7F8,
    "title_bg": 0xE3E6EA, "title_bg_active": 0xC9DBF0, "scrollbar_bg": 0xF2F3F5, "scrollbar_grab": 0xBFC6CF,
    "scrollbar_grab_hovered": 0xA4ADB9, "scrollbar_grab_active": 0x8B95A3, "check_mark": 0x1F66B5,
    "slider_grab": 0x5F9BDD, "slider_grab_active": 0x2F77C6, "button": 0xCFE0F4, "button_hovered": 0xB8D2F0,
    "button_active": 0x9DC1EA, "header": 0xDCE4EE, "header_hovered": 0xC6D8EE, "header_active": 0xAFCBEA,
    "separator": 0xB4BBC5, "plot_histogram": 0x9DC1EA, "plot_lines": 0x1F66B5, "table_header_bg": 0xE3E6EA,
    "table_border_light": 0xD3D8DF, "table_row_bg": 0xF2F3F5, "table_row_bg_alt": 0xE8EBEF, "text_link": 0x1F66B5,
    "nav_cursor": 0xC25A00, "text_selected_bg": 0xA9CDF5, "input_text_cursor": 0x1A1D21,
}  # fmt: skip
_KEPT = ("alpha", "font_size_base", "font_scale_main", "font_scale_dpi")
"""Fields of a style that are no sizes, or are set apart."""


def apply(theme: Theme, scale: float) -> None:
    """Give imgui the colours of `theme` and shapes of `scale` times their size."""
    style = imgui.get_style()
    for name, value in vars_of(_shapes(scale)).items():
        setattr(style, name, value)
    light = theme == Theme.LIGHT
    (imgui.style_colors_light if light else imgui.style_colors_dark)()
    for name, rgb in (LIGHT if light else DARK).items():
        red, green, blue = (((rgb >> shift) & 255) / 255.0 for shift in (16, 8, 0))
        style.set_color_(getattr(imgui.Col_, name), (red, green, blue, 1.0))


def vars_of(style: imgui.Style) -> dict[str, object]:
    """The sizes of a style by name."""
    found = {name: getattr(style, name) for name in dir(style) if not name.startswith("_") and name not in _KEPT}
    return {name: value for name, value in found.items() if isinstance(value, float | imgui.ImVec2)}


def _shapes(scale: float) -> imgui.Style:
    style = imgui.Style()
    style.window_padding = imgui.ImVec2(8.0, 6.0)
    style.frame_padding = imgui.ImVec2(6.0, 3.0)
    style.item_spacing = imgui.ImVec2(8.0, 5.0)
    style.item_inner_spacing = imgui.ImVec2(7.0, 4.0)
    style.frame_rounding = style.grab_rounding = style.popup_rounding = style.child_rounding = 3.0
    style.frame_border_size = 1.0
    style.grab_min_size = 12.0
    style.scrollbar_size = 12.0
    style.scale_all_sizes(scale)
    return style
