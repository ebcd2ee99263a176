"""Palette, help, scale, theme, keyboard alone; and every action does something or says why not."""

from __future__ import annotations

from host import Context, Host, drive, press
from imgui_bundle import imgui

from dofview.viewer.app import App
from dofview.viewer.palette import Help, matching
from dofview.viewer.store import Interface, Theme

ELSEWHERE = {"Quit", "Open…", "Save picture", "Save EXR", "Save preset", "Record", "Compare with the reference"}
"""What closes the window, asks the desktop or writes files; what compares has a script of its own."""


def use(context: Context, app: App, host: Host) -> None:
    context.yield_(3)
    keys_are_unique(app)
    palette(context, app)
    help_window(context, app)
    appearance(context, app)
    by_keyboard(context, app)
    every_action(context, app, host)


def keys_are_unique(app: App) -> None:
    keys = [action.key for action in app.actions if action.key]
    assert len(keys) == len(set(keys)), "two actions share a key"
    names = [(action.menu, action.name) for action in app.actions]
    assert len(names) == len(set(names))
    assert all(action.help.endswith(".") and bool(action.key) == bool(action.key_text) for action in app.actions)


def palette(context: Context, app: App) -> None:
    assert [action.name for action in matching(app.actions, "focus mid")] == ["Focus in the middle"]
    assert matching(app.actions, "no such thing") == [] and len(matching(app.actions, "")) == len(app.actions)
    method = app.settings.method
    press(context, "p", "ctrl", "shift")
    context.key_chars("next meth")
    context.yield_(2)
    press(context, "enter")
    assert app.settings.method != method, "Enter runs what was found"
    before = app.settings
    press(context, "p", "ctrl", "shift")
    context.key_chars("method")
    press(context, "down_arrow")
    press(context, "enter")
    assert app.settings.method == method, "the arrow goes to the previous method, the second of the list"
    press(context, "p", "ctrl", "shift")
    context.key_chars("view from right")
    press(context, "escape")
    assert app.settings.camera == before.camera


def help_window(context: Context, app: App) -> None:
    press(context, "f1")
    assert app.tool(Help).shown
    assert context.window_info("Keys and gestures").window is not None
    press(context, "escape")
    assert not app.tool(Help).shown


def appearance(context: Context, app: App) -> None:
    size = imgui.get_font_size()
    padding = imgui.get_style().window_padding.x
    for _ in range(4):
        press(context, "equal", "ctrl")
    assert app.interface.scale > 1.4 and imgui.get_font_size() > 1.3 * size
    assert imgui.get_style().window_padding.x > padding
    press(context, "_0", "ctrl")
    assert app.interface.scale == 1.0
    assert imgui.get_font_size() == size and imgui.get_style().window_padding.x == padding
    dark = imgui.get_style().color_(imgui.Col_.window_bg).x
    context.set_ref("settings")
    for folded in ("Lens", "Method", "Picture", "Measurement"):
        context.item_close(folded)
    context.item_open("**/Interface")
    context.item_click("Interface/theme##theme")
    press(context, "down_arrow")
    press(context, "enter")
    context.yield_(3)
    light = imgui.get_style().color_(imgui.Col_.window_bg).x
    assert app.interface.theme == Theme.LIGHT and light > dark + 0.5
    context.item_click("Interface/theme##theme")
    press(context, "up_arrow")
    press(context, "enter")
    context.item_uncheck("**/reduced motion##reduced_motion")
    assert app.interface == Interface() == app.store.saved.interface
    context.item_check("**/reduced motion##reduced_motion")
    context.item_close("**/Interface")
    context.item_open("Lens")
    context.set_ref("")
    app.content_scale = 2.0
    context.yield_(3)
    assert imgui.get_style().font_scale_dpi == 2.0 and imgui.get_font_size() > 1.8 * size
    app.content_scale = 1.0
    context.yield_(3)


def by_keyboard(context: Context, app: App) -> None:
    """A parameter is changed without a mouse."""
    context.window_focus("//picture")
    press(context, "f6")
    assert app.panels_focused
    before = app.settings
    press(context, "home")
    for _ in range(3):
        press(context, "down_arrow")
    for _ in range(20):
        if app.settings != before:
            break
        press(context, "space")
        press(context, "right_arrow")
        press(context, "escape")
        press(context, "down_arrow")
    assert app.settings != before
    press(context, "f6")
    assert not app.panels_focused


def every_action(context: Context, app: App, host: Host) -> None:
    good = app.settings = app.settings.with_(method="pinhole")
    for action in app.actions:
        if action.name in ELSEWHERE or action.menu == "Compare":
            continue
        host.inside(context, action.run)
        app.settings = good
    press(context, "escape")
    context.yield_(3)
    assert app.settings.camera == good.camera and app.result is not None


if __name__ == "__main__":
    drive(use)
    print("used the interface")
