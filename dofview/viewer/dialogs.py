"""Questions asked in the middle of the window."""

from __future__ import annotations

from typing import TYPE_CHECKING

from imgui_bundle import imgui

if TYPE_CHECKING:
    from dofview.viewer.app import App

_TYPED = ["demo:"]


def path_dialog(app: App) -> None:
    """Ask for a file by its path, or a demo by its name; Enter opens it, Escape leaves all as it was."""
    name = "Open path"
    if app.asking_for_path:
        imgui.open_popup(name)
        app.asking_for_path = False
    imgui.set_next_window_pos(imgui.get_main_viewport().get_center(), imgui.Cond_.appearing, (0.5, 0.5))
    if not imgui.begin_popup_modal(name, None, imgui.WindowFlags_.always_auto_resize)[0]:
        return
    if imgui.is_window_appearing():
        imgui.set_keyboard_focus_here()
    imgui.push_item_width(32.0 * imgui.get_font_size())
    entered, _TYPED[0] = imgui.input_text(
        "##path", _TYPED[0], imgui.InputTextFlags_.enter_returns_true | imgui.InputTextFlags_.auto_select_all
    )
    imgui.pop_item_width()
    if entered or imgui.button("Open"):
        app.open_any(_TYPED[0].strip())
        imgui.close_current_popup()
    imgui.same_line()
    if imgui.button("Cancel") or imgui.is_key_pressed(imgui.Key.escape):
        imgui.close_current_popup()
    imgui.end_popup()
