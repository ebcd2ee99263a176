"""The viewer without a window: scene, settings and picture, and one function that draws the interface.

It runs inside any imgui frame on any moderngl context: the real window and imgui's test engine host the same code.
Nothing is rendered unless something it depends on has changed.
"""

from __future__ import annotations

import logging
import statistics
import time
from collections import deque
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

import numpy as np

from dofview.errors import DofviewError
from dofview.gl.compose import Part
from dofview.gl.context import Gpu
from dofview.gl.targets import Image
from dofview.methods import method
from dofview.pipeline import Pipeline, Result
from dofview.render.display import show
from dofview.scene.load import DEMO
from dofview.scene.model import Scene
from dofview.settings import ImageSettings, Settings
from dofview.viewer import layout, viewport
from dofview.viewer.actions import ACTIONS, Action, Gesture, menu_bar, run_keys
from dofview.viewer.dialogs import path_dialog
from dofview.viewer.loading import Loader
from dofview.viewer.measurement import Measurement, add_views
from dofview.viewer.screen import Screen
from dofview.viewer.store import Store
from dofview.viewer.tool import Placed, Tool
from dofview.viewer.tools import TOOLS

MOST_MESSAGES = 200
log = logging.getLogger("dofview.viewer")
T = TypeVar("T", bound=Tool)


class App:
    """What the window shows and what a person can do with it."""

    def __init__(
        self, gpu: Gpu, scene: Scene, settings: Settings, wake: Callable[[], None] = lambda: None, *,
        spec: str = "", store: Store | None = None,
    ):  # fmt: skip
        """Show `scene`, loaded from `spec`. `wake` draws a frame soon, from any thread; `store` is what was saved."""
        self.gpu = gpu
        self.spec = spec
        self.store = store or Store(None)
        self.interface = self.store.saved.interface
        self.content_scale = 1.0
        self.settings = settings
        self.home = settings
        self.pipeline = Pipeline(gpu, scene)
        self.tools: tuple[Tool, ...] = tuple(tool() for tool in TOOLS)
        self.actions: tuple[Action, ...] = (*ACTIONS, *(a for tool in self.tools for a in tool.actions()))
        self.gestures: tuple[Gesture, ...] = (*viewport.GESTURES, *(g for tool in self.tools for g in tool.gestures()))
        self.wake = wake
        self.panels_shown: bool = True
        self.panels_focused = False
        self.asking_for_path = False
        self.scrolled_from: float | None = None
        self.sought: str | None = None
        """Title of a panel to be opened and scrolled to, empty to scroll back to what was in view before."""
        self.quitting = False
        self.when_drawn: list[Callable[[np.ndarray], None]] = []
        """Called once by the window with what it shows, (h, w, 4) uint8."""
        self.window_size = settings.image.size
        self.clock: Callable[[], float] = time.monotonic
        """The time that what moves by itself goes by, seconds; a film has its own."""
        self.message, self.said = "", deque[str](maxlen=MOST_MESSAGES)
        self.said_at = 0.0
        self.milliseconds: list[float] = []
        self.scene_renders = 0
        self.result: Result | None = None
        self.timing, self.passes = False, dict[str, float]()
        self.generation = 0
        self.part, self.placed = Part(), list[Placed]()
        self.screen, self.text_px = Screen(), 15.0
        self.shown: Image | None = None
        self.accumulated = Measurement()
        self._figures: list[tuple[str, bool]] = []
        self._rendered: object = None
        self._displayed: object = None
        self.loader = Loader(wake)
        self._rendered_well = settings

    @property
    def scene(self) -> Scene:
        """The scene shown."""
        return self.pipeline.scene.scene

    @property
    def picture_key(self) -> Settings:
        """What the picture depends on: the settings but for how it is displayed."""
        return self.settings.model_copy(update={"display": None})

    @property
    def busy(self) -> bool:
        """Whether another frame is needed though nobody touched anything."""
        accumulating = self.settings.method == "accumulation" and not self.accumulated.done
        outdated = self._rendered != self.picture_key
        return accumulating or outdated or self.loader.ready or any(tool.busy(self) for tool in self.tools)

    def gui(self) -> None:
        """Draw the interface; call between imgui's new_frame and render."""
        self._finish_loading()
        run_keys(self)
        if self.panels_shown:
            menu_bar(self)
        layout.draw(self)
        path_dialog(self)
        for tool in self.tools:
            tool.windows(self)

    def update(self) -> None:
        """Render what has changed; the interface calls it once it knows the size of the picture."""
        try:
            if self.settings.method == "accumulation":
                self._accumulate()
            elif self._rendered != self.picture_key:
                self._render()
            self._develop()
            for tool in self.tools:
                tool.update(self)
            self._rendered_well = self.settings
        except DofviewError as error:
            self.report(str(error))
            self._rendered = self.picture_key
            self.settings = self._rendered_well
        self._develop()

    def figure(self, line: str, faint: bool = False) -> None:
        """Write a line over the picture in this frame."""
        self._figures.append((line, faint))

    def take_figures(self) -> list[tuple[str, bool]]:
        """The lines of this frame, method and time first."""
        first = method(self.settings.method).TITLE
        if self.milliseconds and self.settings.method != "accumulation":
            first += f"   {statistics.median(self.milliseconds[-9:]):.1f} ms"
        lines = [(first, False), *dict(self._figures).items()]
        if self.settings.method == "accumulation":
            lines.append((self.accumulated.reference_text(), False))
        self._figures = []
        return lines

    def resize(self, size: tuple[int, int]) -> None:
        """Follow the size of the place where the picture is shown, pixels."""
        size = (max(size[0], 1), max(size[1], 1))
        if size != self.settings.image.size:
            image = ImageSettings(**{**self.settings.image.model_dump(), "size": size})
            self.settings = self.settings.with_(image=image)

    def tool(self, kind: type[T]) -> T:
        """The tool of this class."""
        return next(tool for tool in self.tools if isinstance(tool, kind))

    def open(self, spec: str, *, keep_view: bool = False) -> None:
        """Load a scene beside the window; the one shown stays until it is there."""
        self.loader.start(spec, self.settings, keep_view)

    def open_any(self, spec: str) -> None:
        """Open a demo by its name, or a file of any kind: the first tool that knows it takes it, else it is a scene."""
        try:
            if spec.startswith(DEMO) or not any(tool.takes_file(self, Path(spec)) for tool in self.tools):
                self.open(spec)
        except DofviewError as error:
            self.report(str(error))

    def reload_shaders(self) -> bool:
        """Take up shader files that were edited; True when the picture is to be drawn again."""
        if not self.gpu.shaders.reload():
            return False
        self.pipeline.forget()
        self._rendered, self.generation = None, self.generation + 1
        self.report(self.gpu.shaders.error or "shaders reloaded")
        return True

    def report(self, message: str) -> None:
        """Show one line for a while, and keep it in the list of messages and in the log."""
        self.message, self.said_at = message, time.monotonic()
        self.said.append(message)
        log.info(message)
        self.wake()

    def release(self) -> None:
        """Release what was made here."""
        for tool in self.tools:
            tool.release()
        self.loader.release()
        self.pipeline.release()

    def _finish_loading(self) -> None:
        if not self.loader.ready:
            return
        try:
            spec, scene, settings = self.loader.take()
            self.pipeline.load(scene)
        except DofviewError as error:
            self.report(str(error))
            return
        self.spec, self._rendered, self.generation = spec, None, self.generation + 1
        if settings is not None:
            self.settings = self.home = self._rendered_well = settings.with_(image=self.settings.image)
        for tool in self.tools:
            tool.scene_changed(self)
        notes = f", {len(scene.warnings)} notes" if scene.warnings else ""
        self.report(f"{spec}: {scene.triangle_count} triangles{notes}")

    def _develop(self) -> None:
        """Bring what is shown of the picture up to date; before the tools look at it, and after they changed how."""
        key = (self._rendered, self.settings.display)
        if self.result is not None and self._displayed != key:
            self.shown = show(self.gpu, self.result.image, self.settings.display, "shown")
            self._displayed = key

    def _render(self) -> None:
        self.gpu.ctx.finish()
        start, spent = time.perf_counter(), time.process_time()
        self.gpu.profile.timing = self.timing
        self.result = self.pipeline.render(self.settings)
        self.gpu.profile.timing = False
        self.gpu.ctx.finish()
        self.milliseconds = [*self.milliseconds[-119:], (time.perf_counter() - start) * 1e3]
        spent = (time.process_time() - spent) * 1e3
        log.info("rendered %s in %.1f ms, %.1f of the processor", self.settings.method, self.milliseconds[-1], spent)
        self.passes = self.gpu.profile.resolve() if self.timing else {}
        self.scene_renders += 1
        self._rendered = self.picture_key
        self._displayed = None

    def _accumulate(self) -> None:
        """Show the progressive reference as the picture, a few views a frame."""
        if self._rendered != self.picture_key:
            self._rendered, self.accumulated = self.picture_key, Measurement()
        if self.accumulated.done:
            return
        antialias = self.settings.params.accumulation.antialias
        reference = self.pipeline.reference(self.settings, antialias=antialias)
        add_views(self, reference)
        picture = self.pipeline.reference_picture(self.settings, antialias=antialias, name="picture")
        self.result = Result(picture, reference.frame)
        self.accumulated = Measurement(0.0, reference.quality())
        self._displayed = None
