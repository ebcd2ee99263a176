"""Where things stand: the picture fills the window, the panels stand beside it."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

from imgui_bundle import imgui

from dofview.settings import Settings
from dofview.viewer import panels, viewport

if TYPE_CHECKING:
    from dofview.viewer.app import App

PANEL_WIDTH_EM, LABEL_EM = 26.0, 9.5
FIXED = (
    imgui.WindowFlags_.no_move | imgui.WindowFlags_.no_resize | imgui.WindowFlags_.no_collapse
    | imgui.WindowFlags_.no_saved_settings | imgui.WindowFlags_.no_bring_to_front_on_focus
)  # fmt: skip


def draw(app: App) -> None:
    """Draw everything inside the main viewport's work area."""
    area = imgui.get_main_viewport()
    left, top = area.work_pos
    width, height = area.work_size
    panel = min(PANEL_WIDTH_EM * imgui.get_font_size(), 0.5 * width) if app.panels_shown else 0.0
    imgui.set_next_window_pos((left, top))
    imgui.set_next_window_size((max(width - panel, 1.0), max(height, 1.0)))
    imgui.push_style_var(imgui.StyleVar_.window_padding, (0.0, 0.0))
    imgui.begin("picture", None, FIXED | imgui.WindowFlags_.no_title_bar | imgui.WindowFlags_.no_scroll_with_mouse)
    imgui.pop_style_var()
    viewport.draw(app)
    imgui.end()
    if app.panels_shown:
        imgui.set_next_window_pos((left + width - panel, top))
        imgui.set_next_window_size((panel, height))
        imgui.begin("settings", None, FIXED | imgui.WindowFlags_.no_title_bar)
        app.panels_focused = imgui.is_window_focused(imgui.FocusedFlags_.root_and_child_windows)
        # A narrow panel of large text cuts names off before controls.
        imgui.push_item_width(-min(LABEL_EM * imgui.get_font_size(), 0.55 * panel))
        imgui.push_text_wrap_pos(0.0)
        _scroll(app)
        _panels(app)
        imgui.pop_text_wrap_pos()
        imgui.pop_item_width()
        imgui.end()


def _scroll(app: App) -> None:
    """Remember where the panels stood before one was sought, and go back there when it is not wanted any more."""
    if app.sought and app.scrolled_from is None:
        app.scrolled_from = imgui.get_scroll_y()
    elif app.sought == "" and app.scrolled_from is not None:
        imgui.set_scroll_y(app.scrolled_from)
        app.scrolled_from = None


def _panels(app: App) -> None:
    _panel("Lens", True, lambda: _edit(app, panels.lens_panel(app.settings, app.scene.bounds)))
    _panel("Method", True, lambda: _edit(app, panels.method_panel(app.settings)))
    _panel("Picture", True, lambda: _edit(app, panels.picture_panel(app.settings)))
    for tool in app.tools:
        if tool.title:
            _panel(tool.title, tool.opened, partial(tool.panel, app), sought=app.sought == tool.title)
    _panel("Scene", False, lambda: panels.scene_panel(app.scene))
    app.sought = None


def _panel(title: str, opened: bool, content: Callable[[], None], sought: bool = False) -> None:
    """A heading that folds; what stands under two of them may be called the same. A `sought` one comes into view."""
    if sought:
        imgui.set_next_item_open(True)
        imgui.set_scroll_here_y(0.0)
    if imgui.collapsing_header(title, imgui.TreeNodeFlags_.default_open if opened else 0):
        imgui.push_id(title)
        content()
        imgui.pop_id()


def _edit(app: App, settings: Settings) -> None:
    app.settings = settings
