"""Everything a key or a menu can do: one entry each, from which menu, key handling and help come."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from imgui_bundle import imgui

from dofview.methods import METHODS
from dofview.viewer import files

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
    index = (METHODS.index(app.settings.method) + step) % len(METHODS)
    app.settings = app.settings.with_(method=METHODS[index])


def _reset_view(app: App) -> None:
    app.settings = app.settings.with_(camera=app.home.camera, lens=app.home.lens)


def _ask_for_file(app: App) -> None:
    if not files.has_dialog():
        app.asking_for_path = True
    elif spec := files.ask_for_scene():
        app.open(spec)


CTRL, SHIFT = int(imgui.Key.mod_ctrl), int(imgui.Key.mod_shift)

ACTIONS: tuple[Action, ...] = (
    Action("Open…", CTRL | int(imgui.Key.o), "Ctrl+O", "Open a glTF or OBJ scene.", _ask_for_file, "File"),
    Action("Open path…", CTRL | SHIFT | int(imgui.Key.o), "Ctrl+Shift+O",
           "Type the path of a scene, or a demo such as demo:rail.",
           lambda app: setattr(app, "asking_for_path", True), "File"),
    Action("Save picture", CTRL | int(imgui.Key.s), "Ctrl+S", "Save the picture as PNG, without the interface.",
           lambda app: app.save_picture(), "File"),
    Action("Quit", CTRL | int(imgui.Key.q), "Ctrl+Q", "Close the window.",
           lambda app: setattr(app, "quitting", True), "File"),
    Action("Fit", int(imgui.Key.f), "F", "See the whole scene from this direction.", lambda app: app.fit()),
    Action("Reset view", int(imgui.Key.home), "Home", "Go back to the view the scene was opened with.", _reset_view),
    Action("Next method", int(imgui.Key.tab), "Tab", "Switch to the next method.", lambda app: _next_method(app, 1)),
    Action("Previous method", SHIFT | int(imgui.Key.tab), "Shift+Tab", "Switch to the method before.",
           lambda app: _next_method(app, -1)),
    Action("Interface", int(imgui.Key.h), "H", "Show or hide the panels.",
           lambda app: setattr(app, "panels_shown", not app.panels_shown)),
)  # fmt: skip


def run_keys(app: App) -> None:
    """Run the action whose key was pressed, unless something is being typed."""
    if imgui.get_io().want_text_input:
        return
    for action in app.actions:
        if action.key and imgui.is_key_chord_pressed(action.key):
            action.run(app)


def menu_bar(app: App) -> None:
    """Draw the menus."""
    if not imgui.begin_main_menu_bar():
        return
    for menu in dict.fromkeys(action.menu for action in app.actions):
        if imgui.begin_menu(menu):
            for action in app.actions:
                if action.menu == menu and imgui.menu_item_simple(action.name, action.key_text):
                    action.run(app)
                if action.menu == menu and imgui.is_item_hovered(imgui.HoveredFlags_.for_tooltip):
                    imgui.set_tooltip(action.help)
            imgui.end_menu()
    imgui.end_main_menu_bar()
