"""The pictures of other methods than the one in use, each rendered when it is wanted and only when it has changed."""

from __future__ import annotations

from typing import TYPE_CHECKING

from dofview.errors import DofviewError
from dofview.gl.targets import Image
from dofview.render.display import show
from dofview.seen import overlays
from dofview.viewer.heat import Heat
from dofview.viewer.tool import Tool
from dofview.viewer.truth import REFERENCE, Truth

if TYPE_CHECKING:
    from dofview.viewer.app import App


class Pictures(Tool):
    """Pictures by the name of their method, as linear light and as they are shown."""

    def __init__(self) -> None:
        self._linear: dict[str, tuple[object, Image]] = {}
        self._shown: dict[str, tuple[object, Image]] = {}
        self._failed: object = None

    def outdated(self, app: App, name: str) -> bool:
        """Whether `linear` would have to render."""
        if name in (app.settings.method, REFERENCE):
            return False
        key = self._key(app, name)
        kept = self._linear.get(name)
        image = app.gpu.targets.image(f"compare/{name}", app.settings.image.size)
        return (kept is None or kept[0] != key or kept[1] is not image) and key != self._failed

    def linear(self, app: App, name: str, *, late: bool = False) -> Image | None:
        """The picture as linear light; None when it cannot be rendered. With `late` nothing is rendered: the last one
        does, if it still lives."""
        if name == app.settings.method:
            return app.result.image if app.result else None
        if name == REFERENCE:
            return app.tool(Truth).picture(app)
        if self.outdated(app, name) and not late:
            self._render(app, name)
        kept = self._linear.get(name)
        return kept[1] if kept is not None and kept[1] in app.gpu.targets else None

    def shown(self, app: App, name: str, *, late: bool = False) -> Image | None:
        """The same as it is shown: developed, or as a map of its error."""
        heat = app.tool(Heat)
        if name == app.settings.method and not heat.covers(name):
            return app.shown
        linear = self.linear(app, name, late=late)
        if linear is None:
            return None
        how: object = app.settings.display
        if heat.covers(name):
            truth = app.tool(Truth)
            how = (heat.settings, truth.key(app), truth.advance(app).views)
        shown = app.gpu.targets.image(f"compare/{name} shown", linear.size, dtype="f1", linear=True)
        key = (self._state(app, name), how)
        if self._shown.get(name) != (key, shown):
            if heat.covers(name):
                overlays.error_map(app.gpu, linear, app.tool(Truth).picture(app), heat.settings, shown.name)
            else:
                show(app.gpu, linear, app.settings.display, shown.name)
            self._shown[name] = key, shown
        return shown

    def keep(self, app: App, names: tuple[str, ...], also: str) -> None:
        """Forget all but `names` and one that may come back, and make the pool hold what `names` need in turn."""
        wanted = (*names, also, app.settings.method)
        self._linear = {name: kept for name, kept in self._linear.items() if name in wanted}
        self._shown = {name: kept for name, kept in self._shown.items() if name in wanted}
        app.gpu.targets.keep_frames = 2 + len(names)

    def _render(self, app: App, name: str) -> None:
        key = self._key(app, name)
        try:
            result = app.pipeline.render(
                app.settings.with_(method=name), name=f"compare/{name}", ends_frame=False
            )  # fmt: skip
        except DofviewError as error:
            self._linear.pop(name, None)
            self._failed = key
            app.report(str(error))
            return
        app.scene_renders += 1
        self._linear[name] = key, result.image

    def _key(self, app: App, name: str) -> object:
        settings = app.settings
        return (name, app.generation, settings.camera, settings.lens, settings.image, settings.background_linear,
                settings.light.stamp(), getattr(settings.params, name))  # fmt: skip

    def _state(self, app: App, name: str) -> object:
        """What the picture that `linear` returned shows."""
        if name == app.settings.method:
            return app.picture_key, app.scene_renders if name == REFERENCE else 0, app.generation
        if name == REFERENCE:
            truth = app.tool(Truth)
            return truth.key(app), truth.quality.views
        return self._linear[name][0]
