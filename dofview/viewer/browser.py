"""The images a method leaves on its way: any of them, in any range, channel, layer and level."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from imgui_bundle import imgui

from dofview.gl.targets import Image
from dofview.viewer.actions import Action
from dofview.viewer.inspect import Channel, Inspect, develop, extremes
from dofview.viewer.tool import Rect, Tool

if TYPE_CHECKING:
    from dofview.viewer.app import App

SHARED = ("frame/", "picture")
OWN = ("shown", "compare/", "inspected", "loupe/", "seen/", "screen", "focus band", "matte", "film")
"""Images that belong to the viewer."""

LIST_ROWS = 9


class Browser(Tool):
    """Shows one named image in place of the picture."""

    title = "Images of the method"

    def __init__(self) -> None:
        self.on = False
        self.everything = False
        self.name = ""
        self.inspect = Inspect()
        self._shown: tuple[object, Image] | None = None
        self._fit = False

    def actions(self) -> tuple[Action, ...]:
        return (
            Action("Images of the method", int(imgui.Key.i), "I", "Show the images the method makes on its way.",
                   self._toggle, "Compare"),
        )  # fmt: skip

    def images(self, app: App) -> dict[str, Image]:
        """What can be chosen, by name: the method's own images and those of its frame, or every one."""
        prefixes = (f"{app.settings.method}/", *SHARED)
        return {
            image.name: image
            for image in app.gpu.targets.named()
            if image.name.startswith(prefixes) or (self.everything and not image.name.startswith(OWN))
        }

    def choose(self, name: str) -> None:
        """Show the image `name`, its range fitted to it."""
        self.name, self._fit = name, True

    def update(self, app: App) -> None:
        if not self.on:
            return
        images = self.images(app)
        if self.name not in images and images:
            self.choose(next(iter(images)))
        image = images.get(self.name)
        if image is None:
            self._shown = None
            return
        shape = image.shape
        # A single channel is one of grey; colours of two channels have no blue.
        channel = Channel.RED if shape.components == 1 else self.inspect.channel
        layer = min(self.inspect.layer, max(shape.layers - 1, 0))
        self.inspect = self.inspect.model_copy(update={"channel": channel, "layer": layer})
        if self._fit:
            low, high = extremes(image, channel, layer)
            self.inspect, self._fit = self.inspect.model_copy(update={"low": low, "high": high}), False
        shown = app.gpu.targets.image("inspected", image.size, dtype="f1", linear=True)
        key = (self.name, image.texture.glo, self.inspect, app.scene_renders, app.generation)
        if self._shown != (key, shown):
            self._shown = key, develop(app.gpu, image, self.inspect, "inspected")

    @property
    def stamp(self) -> object:
        """What the image shown depends on."""
        return self._shown if self.on else None

    def shown(self, app: App) -> Image | None:
        """The image as it is shown in place of the picture; None while pictures are."""
        there = self.on and self._shown is not None and self.name in self.images(app)
        return self._shown[1] if there and self._shown else None

    def over_picture(self, app: App, rect: Rect, hovered: bool) -> bool:
        if self.on and self._shown is not None:
            app.figure(f"{self.name}: {self.inspect.channel.value}, {self.inspect.low:.4g} to {self.inspect.high:.4g}")
        return False

    def panel(self, app: App) -> None:
        self.on = imgui.checkbox("in place of the picture##inspect", self.on)[1]
        self.everything = imgui.checkbox("those of other parts too##everything", self.everything)[1]
        images = self.images(app)
        levels = groups(list(images))
        imgui.begin_child("##images", (0.0, LIST_ROWS * imgui.get_text_line_height_with_spacing()))
        for base, names in levels.items():
            if imgui.selectable(f"{base}##{names[0]}", self.name in names)[0]:
                self.choose(names[0])
                self.on = True
        imgui.end_child()
        if self.name in images:
            self._controls(images[self.name], next(names for names in levels.values() if self.name in names))

    def _controls(self, image: Image, levels: list[str]) -> None:
        shape = image.shape
        layers = f", {shape.layers} layers" if shape.layers else ""
        imgui.text_disabled(f"{shape.size[0]}x{shape.size[1]}, {shape.components} x {shape.dtype}{layers}")
        changes: dict[str, object] = {}
        if len(levels) > 1:
            level = imgui.slider_int("level##level", levels.index(self.name), 0, len(levels) - 1)[1]
            if levels[level] != self.name:
                self.name = levels[level]
        if shape.layers > 1:
            changes["layer"] = imgui.slider_int("layer##layer", self.inspect.layer, 0, shape.layers - 1)[1]
        if shape.components > 1:
            channels = list(Channel)[: shape.components + 1]
            chosen = min(channels.index(self.inspect.channel) if self.inspect.channel in channels else 0, len(channels))
            changes["channel"] = channels[imgui.combo("channel##channel", chosen, [c.value for c in channels])[1]]
            if changes["channel"] is Channel.COLOUR:
                changes["light"] = imgui.checkbox("as light, with the sRGB curve##light", self.inspect.light)[1]
        speed = 0.005 * max(abs(self.inspect.high - self.inspect.low), 1e-6)
        changes["low"] = imgui.drag_float("black##low", self.inspect.low, speed, format="%.4g")[1]
        changes["high"] = imgui.drag_float("white##high", self.inspect.high, speed, format="%.4g")[1]
        self.inspect = self.inspect.model_copy(update=changes)
        self._fit |= imgui.button("fit the range##fit")

    def _toggle(self, app: App) -> None:
        self.on = not self.on
        app.sought = self.title if self.on else ""


def groups(names: list[str]) -> dict[str, list[str]]:
    """Names that differ in a number at their end are the levels of one image, in order of that number."""
    found: dict[str, list[str]] = {}
    for name in names:
        found.setdefault(re.sub(r"\s*\d+$", "", name) or name, []).append(name)
    return {
        base: sorted(group, key=lambda name: int((re.findall(r"\d+$", name) or ["-1"])[0]))
        for base, group in found.items()
    }
