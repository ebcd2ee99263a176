"""Everything a key or a menu can do: one entry each, from which menus, keys, palette, help and docs come."""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

from imgui_bundle import imgui

from dofview.methods import METHODS

if TYPE_CHECKING:
    from dofview.viewer.app import App


@dataclass(frozen=True)
class Action:
    """A thing to do: `key` is an imgui key chord (0 for none), `help` one sentence.

    `repeat` does it again while the key is held. `on_release` waits for the key to be let go, and does nothing when a
    mouse button was pressed meanwhile: then the key was held for what the mouse does.
    """

    name: str
    key: int
    key_text: str
    help: str
    run: Callable[[App], None]
    menu: str = "View"
    repeat: bool = False
    on_release: bool = False


class Gesture(NamedTuple):
    """What the mouse does over the picture, in words."""

    how: str
    help: str


def _next_method(app: App, step: int) -> None:
    index = (METHODS.index(app.settings.method) + step) % len(METHODS)
    app.settings = app.settings.with_(method=METHODS[index])


log = logging.getLogger("dofview.viewer")
MENUS = ("File", "Edit", "View", "Camera", "Lens", "Focus", "Gaze", "Compare", "Interface", "Help")
CTRL, SHIFT, ALT = int(imgui.Key.mod_ctrl), int(imgui.Key.mod_shift), int(imgui.Key.mod_alt)

ACTIONS: tuple[Action, ...] = (
    Action("Open path…", CTRL | SHIFT | int(imgui.Key.o), "Ctrl+Shift+O",
           "Type the path of a file to open, or a demo such as demo:rail.",
           lambda app: setattr(app, "asking_for_path", True), "File"),
    Action("Quit", CTRL | int(imgui.Key.q), "Ctrl+Q", "Close the window.",
           lambda app: setattr(app, "quitting", True), "File"),
    Action("Next method", int(imgui.Key.m), "M", "Switch to the next method.", lambda app: _next_method(app, 1)),
    Action("Previous method", SHIFT | int(imgui.Key.m), "Shift+M", "Switch to the method before.",
           lambda app: _next_method(app, -1)),
    Action("Interface", int(imgui.Key.h), "H", "Show or hide the panels.",
           lambda app: setattr(app, "panels_shown", not app.panels_shown)),
)  # fmt: skip


MODIFIERS = CTRL | SHIFT | ALT | int(imgui.Key.mod_super)


def run_keys(app: App) -> None:
    """Run the action whose key was pressed, unless something is being typed or keys move the camera."""
    if imgui.get_io().want_text_input or imgui.is_mouse_down(imgui.MouseButton_.right):
        return
    for action in app.actions:
        if action.key and _pressed(action):
            perform(app, action)


def perform(app: App, action: Action) -> None:
    """Do it, and say so in the log."""
    log.info("action: %s", action.name)
    action.run(app)


def _pressed(action: Action) -> bool:
    io = imgui.get_io()
    if io.key_mods != action.key & MODIFIERS:
        return False
    key = imgui.Key(action.key & ~MODIFIERS)
    if not action.on_release:
        return imgui.is_key_pressed(key, action.repeat)
    # How long the key was down is counted up to the frame before; times are sums of many floats.
    began = imgui.get_time() - io.delta_time - imgui.internal.get_key_data(key).down_duration_prev - 1e-4
    return imgui.is_key_released(key) and all(time < began for time in io.mouse_clicked_time)


def menu_bar(app: App) -> None:
    """Draw the menus."""
    if not imgui.begin_main_menu_bar():
        return
    for menu in MENUS:
        if imgui.begin_menu(menu):
            for action in app.actions:
                if action.menu == menu and imgui.menu_item_simple(action.name, action.key_text):
                    perform(app, action)
                if action.menu == menu and imgui.is_item_hovered(imgui.HoveredFlags_.for_tooltip):
                    imgui.set_tooltip(action.help)
            for tool in app.tools:
                tool.menu(app, menu)
            imgui.end_menu()
    imgui.end_main_menu_bar()
