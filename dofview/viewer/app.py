"""The viewer without a window: scene, settings and picture, and one function that draws the interface.

It runs inside any imgui frame on any moderngl context: the real window and imgui's test engine host the same code.
Nothing is rendered unless something it depends on has changed.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path

from dofview.errors import DofviewError
from dofview.gl.context import Gpu
from dofview.gl.targets import Image
from dofview.pipeline import Pipeline
from dofview.render.display import show
from dofview.scene.model import Scene
from dofview.settings import ImageSettings, Settings
from dofview.viewer import files, layout, navigation
from dofview.viewer.actions import menu_bar, run_keys
from dofview.viewer.dialogs import path_dialog
from dofview.viewer.measure import Measurement

REFERENCE_BUDGET_S = 0.03
MESSAGE_S = 8.0


class App:
    """What the window shows and what a person can do with it."""

    def __init__(self, gpu: Gpu, scene: Scene, settings: Settings, wake: Callable[[], None] = lambda: None):
        self.gpu = gpu
        self.settings = settings
        self.pipeline = Pipeline(gpu, scene)
        self.measuring = False
        self.antialias = False
        self.panels_shown = True
        self.asking_for_path = False
        self.quitting = False
        self.measurement = Measurement()
        self.milliseconds: list[float] = []
        self.scene_renders = 0
        self.message = ""
        self.shown: Image | None = None
        self._wake = wake
        self._home = settings
        self._message_until = 0.0
        self._rendered: object = None
        self._displayed: object = None
        self._worker = ThreadPoolExecutor(max_workers=1, thread_name_prefix="load")
        self._loading: tuple[str, Future[tuple[Scene, Settings]]] | None = None
        self._result = None

    @property
    def scene(self) -> Scene:
        """The scene shown."""
        return self.pipeline.scene.scene

    @property
    def busy(self) -> bool:
        """Whether another frame is needed though nobody touched anything."""
        accumulating = self.measuring or self.settings.method == "accumulation"
        return (accumulating and not self.measurement.done) or self._loading is not None or self._picture_outdated()

    def gui(self) -> None:
        """Draw the interface; call between imgui's new_frame and render."""
        self._finish_loading()
        if self.message and time.monotonic() > self._message_until:
            self.message = ""
        run_keys(self)
        if self.panels_shown:
            menu_bar(self)
        layout.draw(self)
        path_dialog(self)

    def update(self) -> None:
        """Render what has changed; the interface calls it once it knows the size of the picture."""
        try:
            if self.settings.method == "accumulation":
                self._accumulate_as_picture()
            elif self._picture_outdated():
                self._render()
            if self.measuring and self.settings.method != "accumulation":
                self._measure()
        except DofviewError as error:
            self.report(str(error))
            self._rendered = self._picture_key()
        self._display()

    def resize(self, size: tuple[int, int]) -> None:
        """Follow the size of the place where the picture is shown, pixels."""
        size = (max(size[0], 1), max(size[1], 1))
        if size != self.settings.image.size:
            image = ImageSettings(**{**self.settings.image.model_dump(), "size": size})
            self.settings = self.settings.with_(image=image)

    def open(self, spec: str) -> None:
        """Load a scene beside the window; the one shown stays until it is there."""
        self._loading = (spec, self._worker.submit(files.scene_and_view, spec, self.settings))
        self._loading[1].add_done_callback(lambda _: self._wake())

    def ask_for_file(self) -> None:
        """Let the person choose a scene file."""
        if not files.has_dialog():
            self.asking_for_path = True
        elif spec := files.ask_for_scene():
            self.open(spec)

    def ask_for_path(self) -> None:
        """Let the person type the path of a scene, or the name of a demo."""
        self.asking_for_path = True

    def save_picture(self, path: Path | None = None) -> None:
        """Save the picture shown as PNG under `path`, or under a new name in the working folder."""
        if self.shown is None:
            return
        try:
            self.report(f"saved {files.save_png(self.shown.pixels(), path)}")
        except DofviewError as error:
            self.report(str(error))

    def fit(self) -> None:
        """See the whole scene."""
        self.settings = self.settings.with_(camera=navigation.fit(self.settings.camera, self.scene.bounds))

    def reset_view(self) -> None:
        """Go back to the camera and lens the scene was opened with."""
        self.settings = self.settings.with_(camera=self._home.camera, lens=self._home.lens)

    def toggle_measuring(self) -> None:
        """Switch the comparison with the reference."""
        self.measuring = not self.measuring

    def toggle_panels(self) -> None:
        """Show or hide the panels."""
        self.panels_shown = not self.panels_shown

    def quit(self) -> None:
        """Ask the host to close."""
        self.quitting = True

    def reload_shaders(self) -> bool:
        """Take up shader files that were edited; True when the picture is to be drawn again."""
        if not self.gpu.shaders.reload():
            return False
        self.pipeline.forget()
        self._rendered = None
        self.report(self.gpu.shaders.error or "shaders reloaded")
        return True

    def report(self, message: str) -> None:
        """Show one line for a while."""
        self.message = message
        self._message_until = time.monotonic() + MESSAGE_S
        self._wake()

    def release(self) -> None:
        """Release what was made here."""
        self._worker.shutdown(wait=False, cancel_futures=True)
        self.pipeline.release()

    def _finish_loading(self) -> None:
        if self._loading is None or not self._loading[1].done():
            return
        spec, future = self._loading
        self._loading = None
        try:
            scene, settings = future.result()
            self.pipeline.load(scene)
        except DofviewError as error:
            self.report(str(error))
            return
        kept = self.settings.image
        self.settings = self._home = settings.with_(image=kept)
        self._rendered = None
        self.measurement = Measurement()
        notes = f", {len(scene.warnings)} notes" if scene.warnings else ""
        self.report(f"{spec}: {scene.triangle_count} triangles{notes}")

    def _picture_key(self) -> object:
        return self.settings.model_copy(update={"display": None})

    def _picture_outdated(self) -> bool:
        return self._rendered != self._picture_key() and self.settings.method != "accumulation"

    def _render(self) -> None:
        self.gpu.ctx.finish()
        start = time.perf_counter()
        self._result = self.pipeline.render(self.settings)
        self.gpu.ctx.finish()
        self.milliseconds = [*self.milliseconds[-119:], (time.perf_counter() - start) * 1e3]
        self.scene_renders += 1
        self._rendered = self._picture_key()
        self._displayed = None
        self.measurement = Measurement()

    def _measure(self) -> None:
        """Add views to the reference and compare, until it vouches for the target."""
        if self._result is None or self.measurement.done:
            return
        reference = self._add_views()
        if reference.quality().views != self.measurement.quality.views:
            psnr, quality = self.pipeline.compare(self._result, self.settings, antialias=self.antialias)
            self.measurement = Measurement(psnr, quality)

    def _accumulate_as_picture(self) -> None:
        if self._rendered != self._picture_key():
            self.measurement = Measurement()
            self._rendered = self._picture_key()
        if self.measurement.done:
            return
        antialias = self.settings.params.accumulation.antialias
        reference = self._add_views(antialias)
        picture = self.pipeline.reference_picture(self.settings, antialias=antialias, name="picture")
        self._result = _Accumulated(picture)
        self.measurement = Measurement(0.0, reference.quality())
        self._displayed = None

    def _add_views(self, antialias: bool | None = None):
        reference = self.pipeline.reference(self.settings, antialias=self.antialias if antialias is None else antialias)
        start = time.perf_counter()
        while True:
            reference.add(1)
            self.scene_renders += 1
            self.gpu.ctx.finish()
            if time.perf_counter() - start >= REFERENCE_BUDGET_S:
                return reference

    def _display(self) -> None:
        key = (self._rendered, self.settings.display)
        if self._result is not None and self._displayed != key:
            self.shown = show(self.gpu, self._result.image, self.settings.display, "shown")
            self._displayed = key


class _Accumulated:
    """The reference's mean in the place of a method's result."""

    def __init__(self, image: Image):
        self.image = image
