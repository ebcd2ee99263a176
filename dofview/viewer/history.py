"""Undo and redo of settings: a step is a gesture, from the first change until hands are off."""

from __future__ import annotations

import logging
from typing import TYPE_CHECKING, Any

from imgui_bundle import imgui

from dofview.settings import Settings
from dofview.viewer.actions import CTRL, SHIFT, Action
from dofview.viewer.tool import Tool

if TYPE_CHECKING:
    from dofview.viewer.app import App

MOST_STEPS = 200
log = logging.getLogger("dofview.viewer")


class History(Tool):
    """Remembers settings that rested; the size of the window is not one of them."""

    def __init__(self) -> None:
        self._past: list[Settings] = []
        self._future: list[Settings] = []
        self._now: Settings | None = None

    def actions(self) -> tuple[Action, ...]:
        return (
            Action("Undo", CTRL | int(imgui.Key.z), "Ctrl+Z", "Go back to the settings before.",
                   lambda app: self._step(app, self._past, self._future), "Edit"),
            Action("Redo", CTRL | SHIFT | int(imgui.Key.z), "Ctrl+Shift+Z", "Take back an undo.",
                   lambda app: self._step(app, self._future, self._past), "Edit"),
        )  # fmt: skip

    def update(self, app: App) -> None:
        """Take note of settings once no button is held and no control is in use."""
        if imgui.is_any_item_active() or imgui.is_mouse_down(imgui.MouseButton_.left):
            return
        settings = app.settings
        if self._now is None or _same(self._now, settings):
            self._now = settings
            return
        log.info("settings: %s", changes(self._now, settings))
        self._past = [*self._past, self._now][-MOST_STEPS:]
        self._future.clear()
        self._now = settings

    def scene_changed(self, app: App) -> None:
        """Another scene is another story."""
        self._past.clear()
        self._future.clear()
        self._now = None

    def _step(self, app: App, source: list[Settings], target: list[Settings]) -> None:
        if not source:
            return
        target.append(app.settings)
        settings = source.pop()
        image = settings.image.model_copy(update={"size": app.settings.image.size})
        app.settings = self._now = settings.with_(image=image)


def changes(before: Settings, after: Settings) -> str:
    """The values of `after` that differ, in words."""
    old, new = _flat(before.model_dump(mode="json")), _flat(after.model_dump(mode="json"))
    return ", ".join(f"{name} {value}" for name, value in new.items() if old.get(name) != value)


def _flat(values: dict[str, Any], prefix: str = "") -> dict[str, Any]:
    found: dict[str, Any] = {}
    for name, value in values.items():
        found |= _flat(value, f"{prefix}{name}.") if isinstance(value, dict) else {f"{prefix}{name}": value}
    return found


def _same(first: Settings, second: Settings) -> bool:
    """Equal but for the size of the window."""
    image = first.image.model_copy(update={"size": second.image.size})
    return first.model_copy(update={"image": image}) == second
