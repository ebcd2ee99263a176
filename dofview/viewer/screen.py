"""The one image that stands in the window where pictures are: what the window shows, films and screenshots read.

It is laid out anew only when something in it has changed.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from dofview.gl.compose import WHOLE, Box, Layer, compose, fit
from dofview.gl.targets import Image
from dofview.methods import method
from dofview.seen.layout import layers
from dofview.seen.model import Seen
from dofview.viewer.browser import Browser
from dofview.viewer.compare import Compare
from dofview.viewer.focusing import Focusing
from dofview.viewer.heat import Heat
from dofview.viewer.pictures import Pictures
from dofview.viewer.tool import Placed, Rect
from dofview.viewer.truth import Truth

if TYPE_CHECKING:
    from dofview.viewer.app import App

NAME = "screen"


class Screen:
    """What is seen, as layers and as the image made of them."""

    def __init__(self) -> None:
        self._key: object = None
        self._layers: list[Layer] = []
        self._image: Image | None = None

    def image(self, app: App) -> Image | None:
        """What is seen, 8 bits at the size of the picture; None while there is nothing yet."""
        size = app.settings.image.size
        seen, own, pictures = seen_of(app), app.tool(Compare).front(app), app.tool(Compare).shown
        browser, overlay = app.tool(Browser), app.tool(Focusing).overlay
        key = (seen, own, app.settings, app.scene_renders, app.generation, app.tool(Truth).quality.views,
               tuple(pictures.items()), overlay, browser.stamp)  # fmt: skip
        lives = self._image is not None and self._image in app.gpu.targets
        if key != self._key or not lives:
            self._key, self._layers = key, layers_of(app, seen, own, pictures)
            self._image = self._composed(app, size)
        if self._image is not None:
            app.gpu.targets.touch(self._image)
        return self._image

    def linear(self, app: App) -> Image:
        """The same in linear light: pictures as they are, what is laid over them decoded."""
        own, names = app.tool(Compare).front(app), app.tool(Compare).shown
        plain = [name for name in names if not app.tool(Heat).covers(name)]
        found = {name: app.tool(Pictures).linear(app, name, late=True) or names[name] for name in plain}
        mixed = layers_of(app, seen_of(app), own, {**names, **found})
        return compose(app.gpu, mixed, app.settings.image.size, "screen linear", linear=True)

    def placed(self, app: App, rect: Rect) -> list[Placed]:
        """The pictures in the image, with their values, and where they are when it stands on `rect`."""
        browser, (width, height) = app.tool(Browser), app.settings.image.size
        found = []
        for layer in self._layers:
            if not layer.label:
                continue
            x, y = rect.width / width, rect.height / height
            box = layer.box
            place = Rect(rect.left + x * box.left, rect.top + y * box.top, x * box.width, y * box.height, layer.part)
            if browser.shown(app) is not None:
                found.append(Placed(layer.label, browser.images(app)[layer.label], place, browser.inspect.layer))
                continue
            linear = app.tool(Pictures).linear(app, layer.label, late=True)
            if linear is not None:
                found.append(Placed(layer.label, linear, place))
        if len(found) == 1 and app.tool(Heat).covers(found[0].label) and browser.shown(app) is None:
            found.append(Placed("reference", app.tool(Truth).picture(app), found[0].rect))
        return found

    def _composed(self, app: App, size: tuple[int, int]) -> Image | None:
        """The image of the layers; a picture that is alone and whole is that image itself."""
        if not self._layers:
            return None
        first = self._layers[0]
        alone = len(self._layers) == 1 and first.box == Box(0, 0, *size) and first.part == WHOLE
        if alone and isinstance(first.image, Image) and first.image.size == size:
            return first.image
        return compose(app.gpu, self._layers, size, NAME)


def seen_of(app: App) -> Seen:
    """What the tools say is to be seen."""
    compare, heat, focusing = app.tool(Compare), app.tool(Heat), app.tool(Focusing)
    mode, text_px = compare.mode if not compare.flipped else Seen().arrangement, app.text_px
    return Seen(
        arrangement=mode, other=compare.other, split=compare.split, part=app.part, error_map=heat.on,
        heat=heat.settings, in_focus=focusing.shown, band=focusing.band, text_px=text_px,
    )  # fmt: skip


def take(app: App, seen: Seen) -> None:
    """Let the tools show it."""
    compare, heat, focusing = app.tool(Compare), app.tool(Heat), app.tool(Focusing)
    compare.mode, compare.other, compare.split, app.part = seen.arrangement, seen.other, seen.split, seen.part
    heat.on, heat.settings, focusing.shown, focusing.band = seen.error_map, seen.heat, seen.in_focus, seen.band
    app.tool(Browser).on = False


def layers_of(app: App, seen: Seen, own: str, pictures: dict[str, Image]) -> list[Layer]:
    """An image of the method's in place of pictures, or the pictures."""
    size, browser = app.settings.image.size, app.tool(Browser)
    inspected = browser.shown(app)
    if inspected is not None:
        return [Layer(inspected, fit(inspected.size, Box(0, 0, *size)), seen.part, label=browser.name)]
    names = [name for name in seen.names(own) if app.gpu.version_code >= method(name).REQUIRES_GL]
    # The second of two is waited for; a grid has a place for what is still to come.
    names = names if len(names) > 2 else [name for name in names if name in pictures]
    return layers(app.gpu, seen, names, pictures, size, app.tool(Focusing).overlay)
