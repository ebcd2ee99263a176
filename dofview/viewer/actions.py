"""Everything a key or a menu can do: one entry each, from which menu, key handling and help come."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from imgui_bundle import imgui

if TYPE_CHECKING:
    from dofview.viewer.app import App


@dataclass(frozen=True)
class Action:
    """A thing to do: `key` is an imgui key chord (0 for none), `help` one sentence."""

    name: str
    key: int
    key_text: str
    help: str
    run: Callable[[App], None]
    menu: str = "View"


def _next_method(app: App, step: int) -> None:
    from dofview.methods import METHODS

    index = (METHODS.index(app.settings.method) + step) % len(METHODS)
    app.settings = app.settings.with_(method=METHODS[index])


CTRL = int(imgui.Key.mod_ctrl)

ACTIONS: tuple[Action, ...] = (
    Action("Open…", CTRL | int(imgui.Key.o), "Ctrl+O", "Open a glTF or OBJ scene.", lambda a: a.ask_for_file(), "File"),
    Action("Open path…", CTRL | int(imgui.Key.mod_shift) | int(imgui.Key.o), "Ctrl+Shift+O",
           "Type the path of a scene, or a demo such as demo:rail.", lambda a: a.ask_for_path(), "File"),
    Action("Save picture", CTRL | int(imgui.Key.s), "Ctrl+S", "Save the picture as PNG, without the interface.",
           lambda a: a.save_picture(), "File"),
    Action("Quit", CTRL | int(imgui.Key.q), "Ctrl+Q", "Close the window.", lambda a: a.quit(), "File"),
    Action("Fit", int(imgui.Key.f), "F", "See the whole scene from this direction.", lambda a: a.fit()),
    Action("Reset view", int(imgui.Key.home), "Home", "Go back to the view the scene was opened with.",
           lambda a: a.reset_view()),
    Action("Next method", int(imgui.Key.tab), "Tab", "Switch to the next method.", lambda a: _next_method(a, 1)),
    Action("Previous method", int(imgui.Key.mod_shift) | int(imgui.Key.tab), "Shift+Tab",
           "Switch to the method before.", lambda a: _next_method(a, -1)),
    Action("Compare with the reference", int(imgui.Key.r), "R", "Measure PSNR against the reference as it accumulates.",
           lambda a: a.toggle_measuring()),
    Action("Interface", int(imgui.Key.h), "H", "Show or hide the panels.", lambda a: a.toggle_panels()),
)  # fmt: skip


def run_keys(app: App) -> None:
    """Run the action whose key was pressed, unless something is being typed."""
    if imgui.get_io().want_text_input:
        return
    for action in ACTIONS:
        if action.key and imgui.is_key_chord_pressed(action.key):
            action.run(app)


def menu_bar(app: App) -> None:
    """Draw the menus."""
    if not imgui.begin_main_menu_bar():
        return
    for menu in dict.fromkeys(action.menu for action in ACTIONS):
        if imgui.begin_menu(menu):
            for action in ACTIONS:
                if action.menu == menu and imgui.menu_item_simple(action.name, action.key_text):
                    action.run(app)
                if action.menu == menu and imgui.is_item_hovered(imgui.HoveredFlags_.for_tooltip):
                    imgui.set_tooltip(action.help)
            imgui.end_menu()
    imgui.end_main_menu_bar()
