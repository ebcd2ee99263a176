"""A tool: something the viewer can do beyond showing a picture, in one file with its own state.

The app asks every tool in turn; a tool that has nothing to say leaves a method as it is here. Adding one is a module
and a line in `TOOLS` of `viewer/tools.py`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from imgui_bundle import imgui
from moderngl import NEAREST

from dofview.gl.compose import WHOLE, Part

if TYPE_CHECKING:
    from imgui_bundle.imgui import ImDrawList, ImVec2

    from dofview.gl.targets import Image
    from dofview.viewer.actions import Action, Gesture
    from dofview.viewer.app import App


class Rect(NamedTuple):
    """Where a picture is shown, in imgui's coordinates: left, top, width, height; and which part of it."""

    left: float
    top: float
    width: float
    height: float
    part: Part = WHOLE

    def share(self, at: ImVec2) -> tuple[float, float]:
        """A place on the screen as shares of the picture's width and height, from its upper left."""
        x, y = (at.x - self.left) / self.width, (at.y - self.top) / self.height
        return self.part.left + x * self.part.width, self.part.top + y * self.part.height

    def place(self, share: tuple[float, float]) -> tuple[float, float]:
        """Where on the screen a point of the picture is; undoes `share`."""
        x, y = (share[0] - self.part.left) / self.part.width, (share[1] - self.part.top) / self.part.height
        return self.left + x * self.width, self.top + y * self.height

    def holds(self, at: ImVec2) -> bool:
        """Whether a place on the screen is inside."""
        return 0.0 <= at.x - self.left < self.width and 0.0 <= at.y - self.top < self.height

    def draw(self, draw_list: ImDrawList, image: Image) -> None:
        """Show the whole of an 8-bit image, which is as large as this in pixels."""
        image.texture.filter = (NEAREST, NEAREST)
        # OpenGL's first row is the lowest: v runs upwards.
        corner = (self.left + self.width, self.top + self.height)
        texture = imgui.ImTextureRef(image.texture.glo)
        draw_list.add_image(texture, (self.left, self.top), corner, (0.0, 1.0), (1.0, 0.0))


class Placed(NamedTuple):
    """A picture that is on the screen: its name, its values, and where."""

    label: str
    image: Image
    rect: Rect
    layer: int = 0


class Work(NamedTuple):
    """Something that takes a while: what it is, how far it has come, 0 to 1 or None, and how to stop it."""

    what: str
    share: float | None
    cancel: Callable[[], object]
    button: str = "Cancel"


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

    def seen(self, app: App, image: Image) -> None:
        """Take note of what is seen in this frame, 8 bits."""

    def over_picture(self, app: App, rect: Rect, hovered: bool) -> bool:
        """Draw over the picture and take gestures; True keeps the gesture from the camera."""
        return False

    def panel(self, app: App) -> None:
        """Draw the panel."""

    def windows(self, app: App) -> None:
        """Draw windows and popups of its own."""

    def work(self, app: App) -> Iterable[Work]:
        """What it is at beside the window, to be shown with progress and a way to stop it."""
        return ()

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
