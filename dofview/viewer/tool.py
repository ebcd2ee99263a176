"""A tool: something the viewer can do beyond showing a picture, in one file with its own state.

The app asks every tool in turn; a tool that has nothing to say leaves a method as it is here. Adding one is a module
and a line in `TOOLS` of `viewer/tools.py`.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from imgui_bundle.imgui import ImVec2

    from dofview.viewer.actions import Action, Gesture
    from dofview.viewer.app import App


class Rect(NamedTuple):
    """Where the picture is shown, in imgui's coordinates: left, top, width, height."""

    left: float
    top: float
    width: float
    height: float

    def share(self, at: ImVec2) -> tuple[float, float]:
        """A place on the screen as shares of the picture's width and height, from its upper left."""
        return (at.x - self.left) / self.width, (at.y - self.top) / self.height


class Tool:
    """What a tool may do; each method is called once a frame, in this order."""

    title = ""
    """Heading of its panel; empty for a tool without one."""
    opened = False
    """Whether the panel stands open at first."""

    def actions(self) -> tuple[Action, ...]:
        """What it adds to menus, keys, palette and help; asked once."""
        return ()

    def gestures(self) -> tuple[Gesture, ...]:
        """What it makes of the mouse, for help and docs; asked once."""
        return ()

    def menu(self, app: App, menu: str) -> None:
        """Add entries that are not known beforehand to the open menu called `menu`."""

    def update(self, app: App) -> None:
        """Work on the GPU, after the picture was brought up to date and before it is shown."""

    def over_picture(self, app: App, rect: Rect, hovered: bool) -> bool:
        """Draw over the picture and take gestures; True keeps the gesture from the camera."""
        return False

    def panel(self, app: App) -> None:
        """Draw the panel."""

    def windows(self, app: App) -> None:
        """Draw windows and popups of its own."""

    def busy(self, app: App) -> bool:
        """Whether it needs another frame though nobody touched anything."""
        return False

    def takes_file(self, app: App, path: Path) -> bool:
        """Use a file that was dropped on the window; False leaves it to the other tools."""
        return False

    def scene_changed(self, app: App) -> None:
        """Another scene was opened."""

    def release(self) -> None:
        """The window closes: stop what runs beside it."""
