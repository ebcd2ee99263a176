"""The progressive reference that measuring and comparing share; a few views more in each frame it is needed."""

from __future__ import annotations

import logging
from collections.abc import Iterable
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

from imgui_bundle import imgui

from dofview.bench.plan import natural
from dofview.gl.targets import Image
from dofview.lens import Distribution
from dofview.render.reference import Quality
from dofview.settings import Settings
from dofview.viewer.measurement import Measurement, add_views
from dofview.viewer.tool import Tool, Work

if TYPE_CHECKING:
    from dofview.viewer.app import App

log = logging.getLogger("dofview.viewer")
REFERENCE = "accumulation"
NO_VIEWS = Quality(0, 0.0)


class Truth(Tool):
    """What pictures are compared with. Like is compared with like: its lens is the picture's, unless `other_lens`."""

    def __init__(self) -> None:
        self.antialias = False
        self.other_lens = False
        self.quality = NO_VIEWS
        self._key: object = None
        self._asked = -1
        self._enough: object = None
        self._mean: tuple[object, Image] | None = None

    def settings(self, app: App) -> Settings:
        """The settings that the reference is rendered with."""
        if not self.other_lens or app.settings.method == REFERENCE:
            return app.settings
        lens = app.settings.lens
        return app.settings.with_(lens=lens.model_copy(update={"distribution": other(lens.distribution)}))

    def antialiased(self, app: App) -> bool:
        """Whether its views move inside the pixel; the reference as a method has its own say in that."""
        return app.settings.params.accumulation.antialias if app.settings.method == REFERENCE else self.antialias

    def key(self, app: App) -> object:
        """What the reference depends on."""
        settings = self.settings(app)
        light = settings.light.stamp()
        return (app.generation, settings.camera, settings.lens, settings.image, settings.background_linear, light,
                self.antialiased(app))  # fmt: skip

    def advance(self, app: App) -> Quality:
        """Add views, once in a frame however many ask, until the reference vouches for its target."""
        key, frame = self.key(app), imgui.get_frame_count()
        if app.settings.method == REFERENCE:
            self._key, self.quality = key, app.accumulated.quality
        elif key != self._key:
            self._key, self.quality = key, NO_VIEWS
        if self._asked != frame and app.settings.method != REFERENCE and not self.done(app):
            reference = app.pipeline.reference(self.settings(app), antialias=self.antialiased(app))
            add_views(app, reference)
            self.quality = reference.quality()
            if self.done(app):
                log.info(Measurement(0.0, self.quality).reference_text())
        self._asked = frame
        return self.quality

    def done(self, app: App) -> bool:
        """Whether there are as many views as are wanted, or somebody said that these are enough."""
        key = self.key(app)
        return self._key == key and (Measurement(0.0, self.quality).done or key == self._enough)

    def work(self, app: App) -> Iterable[Work]:
        if app.settings.method == REFERENCE and not app.accumulated.done:
            yield Work("reference", app.accumulated.progress, partial(self._be_content, app), "Enough")
        elif self.busy(app):
            yield Work("reference", self.progress, partial(self._be_content, app), "Enough")

    def _be_content(self, app: App) -> None:
        """Add no more views to this reference."""
        self._enough = self.key(app)
        if app.settings.method == REFERENCE:
            app.accumulated = replace(app.accumulated, most_views=max(app.accumulated.quality.views, 1))

    @property
    def progress(self) -> float:
        """0 to 1 on the way to as many views as are wanted."""
        return Measurement(0.0, self.quality).progress

    def picture(self, app: App) -> Image:
        """The mean so far, drawn anew when views were added."""
        self.advance(app)
        key = (self._key, self.quality.views)
        image = app.gpu.targets.image("reference", app.settings.image.size)
        if self._mean is None or self._mean[0] != key or self._mean[1] is not image:
            image = app.pipeline.reference_picture(self.settings(app), antialias=self.antialiased(app))
            self._mean = key, image
        return image

    def busy(self, app: App) -> bool:
        return self._asked >= imgui.get_frame_count() - 1 and not self.done(app)


def other(distribution: Distribution) -> Distribution:
    """The Gaussian for a lens with an edge, the disc for the Gaussian."""
    return Distribution.UNIFORM_DISC if distribution == Distribution.GAUSSIAN else Distribution.GAUSSIAN


def match_panel(app: App, truth: Truth) -> None:
    """Say whether like is compared with like; every other combination is one click away."""
    settings = app.settings
    truth.antialias = imgui.checkbox("antialiased reference##antialias", truth.antialias)[1]
    if imgui.is_item_hovered(imgui.HoveredFlags_.for_tooltip):
        imgui.set_tooltip("Methods are not antialiased by themselves: compare with render scale 2.")
    like = truth.antialias == (settings.image.scale > 1.0)
    if not like and imgui.button("match the antialiasing##matchscale"):
        scale = 2.0 if truth.antialias else 1.0
        app.settings = settings.with_(image=settings.image.model_copy(update={"scale": scale}))
    truth.other_lens = imgui.checkbox("reference of the other lens##otherlens", truth.other_lens)[1]
    if imgui.is_item_hovered(imgui.HoveredFlags_.for_tooltip):
        imgui.set_tooltip(f"Compare with a {_words(other(settings.lens.distribution))} lens.")
    own = Distribution(natural(settings.method))
    if settings.lens.distribution != own:
        if imgui.button("the method's own lens##ownlens"):
            app.settings = settings.with_(lens=settings.lens.model_copy(update={"distribution": own}))
        imgui.same_line()
        imgui.text_disabled(_words(own))
    if not like or truth.other_lens:
        imgui.text_disabled("like is not compared with like")


def _words(distribution: Distribution) -> str:
    return distribution.value.replace("_", " ")
