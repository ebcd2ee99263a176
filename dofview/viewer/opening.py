"""Everything that can be opened or dropped besides scenes, recent files, and views: the last of each scene, as text."""

from __future__ import annotations

import json
from collections.abc import Iterable
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from imgui_bundle import imgui

from dofview import bokeh
from dofview.errors import DofviewError, SettingsError
from dofview.lens import Distribution
from dofview.render import environment
from dofview.render.environment import Lighting
from dofview.scene.load import DEMO
from dofview.settings import Settings, apply_view, read_view, view_of
from dofview.viewer import files
from dofview.viewer.actions import CTRL, Action
from dofview.viewer.store import Saved, Store
from dofview.viewer.tool import Tool, Work
from dofview.viewer.widgets import plain

if TYPE_CHECKING:
    from dofview.viewer.app import App

PANORAMAS = (".hdr", ".exr")
PICTURES = (".png", ".jpg", ".jpeg", ".webp", ".bmp", ".tga")
VIEWS = (".json",)
MOST_TEXT = 1 << 20


class Opening(Tool):
    """Knows files by their kind and scenes by their last view. It stands last among the tools: what another tool wants
    of a file, it gets."""

    def __init__(self) -> None:
        self._worker = ThreadPoolExecutor(max_workers=2, thread_name_prefix="opening")
        self._asked: Future[str | None] | None = None
        self._environment: tuple[Lighting, Future[np.ndarray]] | None = None
        self._store: Store | None = None
        self._shown: tuple[str, Settings] | None = None

    def actions(self) -> tuple[Action, ...]:
        return (
            Action("Open…", CTRL | int(imgui.Key.o), "Ctrl+O",
                   "Open a scene, a picture or whatever else can be dropped.", self._ask, "File"),
            Action("Stop loading", int(imgui.Key.escape), "Escape", "Forget the scene that is being read.",
                   lambda app: app.loader.cancel(), "File"),
            Action("Reload", CTRL | int(imgui.Key.r), "Ctrl+R", "Read the scene's file again and keep the view.",
                   lambda app: app.open(app.spec, keep_view=True) if app.spec else None, "File"),
            Action("Forget recent files", 0, "", "Empty the list of recent files.",
                   lambda app: app.store.change(lambda saved: saved.model_copy(update={"recent": ()})), "File"),
            Action("Copy view", CTRL | int(imgui.Key.c), "Ctrl+C",
                   "Copy camera, lens, light and background as the text of a view file.", copy_view, "View"),
            Action("Paste view", CTRL | int(imgui.Key.v), "Ctrl+V", "Take the view from text in the clipboard.",
                   paste_view, "View"),
        )  # fmt: skip

    def menu(self, app: App, menu: str) -> None:
        if menu != "File" or not app.store.saved.recent or not imgui.begin_menu("Open recent"):
            return
        for number, spec in enumerate(app.store.saved.recent):
            if imgui.menu_item_simple(f"{plain(spec)}##recent{number}"):
                app.open(spec)
        imgui.end_menu()

    def takes_file(self, app: App, path: Path) -> bool:
        match path.suffix.lower():
            case suffix if suffix in PANORAMAS:
                lighting = Lighting(environment=str(path))
                self._environment = lighting, self._worker.submit(environment.prepare, lighting)
                self._environment[1].add_done_callback(lambda _: app.wake())
                app.report(f"reading {path.name}")
            case suffix if suffix in PICTURES:
                bokeh.load(path)
                lens = app.settings.lens.model_copy(update={"distribution": Distribution.IMAGE, "image": str(path)})
                app.settings = app.settings.with_(lens=lens)
                app.report(f"{path.name} is the shape of the aperture")
            case suffix if suffix in VIEWS:
                app.settings = read_view(path, app.settings)
            case _:
                return False
        return True

    def update(self, app: App) -> None:
        self._store = app.store
        if app.store.problem:
            app.report(app.store.problem)
            app.store.problem = ""
        if self._shown is None:
            self._remember(app)
        self._shown = (app.spec, app.settings)
        if self._asked is not None and self._asked.done():
            chosen, self._asked = self._asked.result(), None
            if chosen:
                app.open_any(chosen)
        if self._environment is not None and self._environment[1].done():
            lighting, pixels = self._environment
            self._environment = None
            try:
                pixels.result()
                app.settings = app.settings.with_(light=lighting)
            except DofviewError as error:
                app.report(str(error))

    def work(self, app: App) -> Iterable[Work]:
        if app.loader.spec:
            yield Work(f"loading, {app.loader.seconds:.0f} s", None, app.loader.cancel)
        if self._environment is not None:
            yield Work("reading the environment", None, self._forget_environment)

    def busy(self, app: App) -> bool:
        waiting = (self._asked, self._environment and self._environment[1])
        return any(future.done() for future in waiting if future)

    def scene_changed(self, app: App) -> None:
        if self._shown is None or key_of(self._shown[0]) != key_of(app.spec):
            self._keep()
            if app.settings == app.home:  # another tool may have a view for it
                restore_view(app)
            self._remember(app)
        self._shown = (app.spec, app.settings)

    def release(self) -> None:
        self._worker.shutdown(wait=False, cancel_futures=True)
        self._keep()

    def _ask(self, app: App) -> None:
        """Ask by the desktop's dialog while the window lives on, or by path where there is none."""
        if not files.has_dialog():
            app.asking_for_path = True
        elif self._asked is None:
            self._asked = self._worker.submit(files.ask)
            self._asked.add_done_callback(lambda _: app.wake())

    def _forget_environment(self) -> None:
        self._environment = None

    def _remember(self, app: App) -> None:
        if spec := key_of(app.spec):
            app.store.change(lambda saved: saved.opened(spec))

    def _keep(self) -> None:
        """Save the view of the scene that was shown."""
        if self._store is None or self._shown is None or not key_of(self._shown[0]):
            return
        spec, view = key_of(self._shown[0]), view_of(self._shown[1])
        self._store.change(lambda saved: saved.seen(spec, view))


def key_of(spec: str) -> str:
    """The name a scene is remembered by: a demo's own, a file's whole path."""
    return spec if not spec or spec.startswith(DEMO) else str(Path(spec).absolute())


def restore_view(app: App) -> None:
    """Show the scene as it was last seen, if it was; Home still leads to how it opens."""
    saved: Saved = app.store.saved
    view = saved.views.get(key_of(app.spec))
    if view is None:
        return
    try:
        app.settings = apply_view(app.settings, view, "last view")
    except SettingsError as error:
        app.report(str(error))


def copy_view(app: App) -> None:
    """Put the view into the clipboard as the text of a view file."""
    imgui.set_clipboard_text(json.dumps(view_of(app.settings), indent=1))
    app.report("view copied")


def paste_view(app: App) -> None:
    """Take the view from the clipboard; text that is none changes nothing."""
    text = imgui.get_clipboard_text() or ""
    try:
        view = json.loads(text[:MOST_TEXT])
    except (ValueError, RecursionError):
        app.report("the clipboard holds no view; accepted: the text of a JSON view file")
        return
    try:
        app.settings = apply_view(app.settings, view, "clipboard")
    except SettingsError as error:
        app.report(str(error))
