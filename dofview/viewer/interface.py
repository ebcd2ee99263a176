"""How the interface looks: scale, theme, motion; and the way into the panels by keyboard."""

from __future__ import annotations

from typing import TYPE_CHECKING

from imgui_bundle import imgui

from dofview.viewer import theme
from dofview.viewer.actions import CTRL, Action
from dofview.viewer.store import Interface, Theme
from dofview.viewer.tool import Tool
from dofview.viewer.widgets import edit

if TYPE_CHECKING:
    from dofview.viewer.app import App

STEP = 1.1


class Appearance(Tool):
    """Applies the interface settings to imgui's style when they, or the screen, change."""

    title = "Interface"

    def __init__(self) -> None:
        self._applied: object = None

    def actions(self) -> tuple[Action, ...]:
        plus, minus, zero = int(imgui.Key.equal), int(imgui.Key.minus), int(imgui.Key._0)
        return (
            Action("Larger interface", CTRL | plus, "Ctrl+=", "Make text and controls larger.",
                   lambda app: _scale(app, app.interface.scale * STEP), "Interface", repeat=True),
            Action("Smaller interface", CTRL | minus, "Ctrl+-", "Make text and controls smaller.",
                   lambda app: _scale(app, app.interface.scale / STEP), "Interface", repeat=True),
            Action("Interface as the screen asks", CTRL | zero, "Ctrl+0", "Go back to the size the screen asks for.",
                   lambda app: _scale(app, 1.0), "Interface"),
            Action("Light or dark", 0, "", "Switch between the light and the dark theme.", _other_theme, "Interface"),
            Action("Reduced motion", 0, "", "Let views and focus jump where they would glide, or glide again.",
                   lambda app: change(app, reduced_motion=not app.interface.reduced_motion), "Interface"),
            Action("Go to the panels", int(imgui.Key.f6), "F6",
                   "Take the keyboard to the panels, or back to the picture; arrows, Tab, Space and Enter work there.",
                   _change_focus, "Interface"),
        )  # fmt: skip

    def windows(self, app: App) -> None:
        wanted = (app.interface, app.content_scale)
        if wanted == self._applied:
            return
        self._applied = wanted
        style = imgui.get_style()
        theme.apply(app.interface.theme, app.content_scale * app.interface.scale)
        style.font_scale_dpi = app.content_scale
        style.font_scale_main = app.interface.scale

    def panel(self, app: App) -> None:
        interface = edit(app.interface)
        if interface != app.interface:
            change(app, **interface.model_dump())

    def busy(self, app: App) -> bool:
        return (app.interface, app.content_scale) != self._applied


def change(app: App, **values: object) -> None:
    """Change how the interface looks, now and in later sessions."""
    app.interface = Interface.model_validate({**app.interface.model_dump(), **values})
    app.store.change(lambda saved: saved.model_copy(update={"interface": app.interface}))


def _scale(app: App, scale: float) -> None:
    change(app, scale=min(max(round(scale, 3), 0.5), 3.0))


def _other_theme(app: App) -> None:
    change(app, theme=Theme.DARK if app.interface.theme == Theme.LIGHT else Theme.LIGHT)


def _change_focus(app: App) -> None:
    app.panels_shown = True
    imgui.set_window_focus("picture" if app.panels_focused else "settings")
    imgui.set_nav_cursor_visible(True)
