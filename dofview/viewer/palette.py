"""Every action by name: the command palette, and the help overlay that lists keys and gestures."""

from __future__ import annotations

from typing import TYPE_CHECKING

from imgui_bundle import imgui

from dofview.viewer.actions import CTRL, SHIFT, Action
from dofview.viewer.tool import Tool

if TYPE_CHECKING:
    from dofview.viewer.app import App

WIDTH_EM, ROWS = 36.0, 12


class Palette(Tool):
    """Type a part of a name, choose with the arrows, run with Enter."""

    def __init__(self) -> None:
        self._asked = False
        self._typed = ""
        self._chosen = 0

    def actions(self) -> tuple[Action, ...]:
        return (
            Action("Command palette", CTRL | SHIFT | int(imgui.Key.p), "Ctrl+Shift+P", "Find an action by its name.",
                   lambda app: self._ask(), "Help"),
        )  # fmt: skip

    def windows(self, app: App) -> None:
        name = "Commands"
        if self._asked:
            imgui.open_popup(name)
            self._asked, self._typed, self._chosen = False, "", 0
        area = imgui.get_main_viewport()
        imgui.set_next_window_pos((area.get_center().x, area.work_pos.y), 0, (0.5, 0.0))
        imgui.set_next_window_size((WIDTH_EM * imgui.get_font_size(), 0.0))
        # The arrows choose from the list while the text field stays active.
        if not imgui.begin_popup(name, imgui.WindowFlags_.no_nav_inputs):
            return
        if imgui.is_window_appearing():
            imgui.set_keyboard_focus_here()
        imgui.push_item_width(-1.0)
        entered, typed = imgui.input_text("##command", self._typed, imgui.InputTextFlags_.enter_returns_true)
        imgui.pop_item_width()
        if typed != self._typed:
            self._typed, self._chosen = typed, 0
        actions = matching(app.actions, self._typed)
        run = self._list(actions)
        if entered and actions:
            run = actions[self._chosen]
        if run is not None or imgui.is_key_pressed(imgui.Key.escape):
            imgui.close_current_popup()
        imgui.end_popup()
        if run is not None:
            run.run(app)

    def _ask(self) -> None:
        self._asked = True

    def _list(self, actions: list[Action]) -> Action | None:
        """Show the actions and return one that was clicked."""
        moved = imgui.is_key_pressed(imgui.Key.down_arrow) - imgui.is_key_pressed(imgui.Key.up_arrow)
        self._chosen = min(max(self._chosen + moved, 0), max(len(actions) - 1, 0))
        clicked = None
        height = min(len(actions), ROWS) * imgui.get_text_line_height_with_spacing() + imgui.get_text_line_height()
        imgui.begin_child("##actions", (0.0, height), 0, imgui.WindowFlags_.no_nav_inputs)
        right = imgui.get_content_region_avail().x
        for number, action in enumerate(actions):
            if imgui.selectable(f"{action.name}##{number}", number == self._chosen)[0]:
                clicked = action
            if number == self._chosen and moved:
                imgui.set_scroll_here_y()
            if action.key_text:
                imgui.same_line(right - imgui.calc_text_size(action.key_text).x)
                imgui.text_disabled(action.key_text)
        imgui.end_child()
        if actions:
            imgui.text_disabled(actions[self._chosen].help)
        return clicked


class Help(Tool):
    """All keys and gestures, over the picture."""

    def __init__(self) -> None:
        self.shown = False

    def actions(self) -> tuple[Action, ...]:
        return (
            Action("Keys and gestures", int(imgui.Key.f1), "F1", "Show or hide what keys and mouse do.",
                   lambda app: self._toggle(), "Help"),
        )  # fmt: skip

    def windows(self, app: App) -> None:
        if not self.shown:
            return
        area = imgui.get_main_viewport()
        size = imgui.get_font_size()
        width, height = min(60.0 * size, area.work_size.x - 2 * size), area.work_size.y - 2 * size
        imgui.set_next_window_pos(area.get_work_center(), imgui.Cond_.appearing, (0.5, 0.5))
        imgui.set_next_window_size((width, height), imgui.Cond_.appearing)
        visible, stays = imgui.begin("Keys and gestures", True, imgui.WindowFlags_.no_saved_settings)
        if visible:
            _table("mouse over the picture", [(gesture.how, "", gesture.help) for gesture in app.gestures])
            for menu in dict.fromkeys(action.menu for action in app.actions):
                _table(menu, [(a.key_text, a.name, a.help) for a in app.actions if a.menu == menu])
        if imgui.is_window_focused() and imgui.is_key_pressed(imgui.Key.escape):
            stays = False
        self.shown = bool(stays)
        imgui.end()

    def _toggle(self) -> None:
        self.shown = not self.shown


def matching(actions: tuple[Action, ...], typed: str) -> list[Action]:
    """Actions with every typed word in their name, menu or help; those with all of them in the name come first."""
    words = typed.lower().split()
    found = [a for a in actions if all(word in f"{a.menu} {a.name} {a.help}".lower() for word in words)]
    return sorted(found, key=lambda a: not all(word in a.name.lower() for word in words))


def _table(title: str, rows: list[tuple[str, str, str]]) -> None:
    imgui.separator_text(title)
    if not imgui.begin_table(f"##{title}", 2, imgui.TableFlags_.row_bg):
        return
    imgui.table_setup_column("how", imgui.TableColumnFlags_.width_fixed, 14.0 * imgui.get_font_size())
    imgui.table_setup_column("what", imgui.TableColumnFlags_.width_stretch)
    for how, name, help_text in rows:
        imgui.table_next_row()
        imgui.table_next_column()
        imgui.text_unformatted(how or "–")
        imgui.table_next_column()
        imgui.text_wrapped(f"{name}: {help_text}" if name else help_text)
    imgui.end_table()
