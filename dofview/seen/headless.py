"""What is seen, made without a window: every picture that is part of it is rendered, then all are laid out."""

from __future__ import annotations

from dofview.gl.compose import compose
from dofview.gl.targets import Image
from dofview.methods import method
from dofview.pipeline import Pipeline, Result
from dofview.render.display import show
from dofview.seen import overlays
from dofview.seen.layout import layers
from dofview.seen.model import REFERENCE, Seen
from dofview.settings import Settings


def picture(pipeline: Pipeline, settings: Settings, seen: Seen, *, linear: bool = False) -> Image:
    """Return what is seen of `settings`: 8 bits as shown, or linear light. The reference has its `views` of settings.

    It ends a frame, as rendering a picture does.
    """
    gpu, size = pipeline.gpu, settings.image.size
    able = [name for name in seen.names(settings.method) if gpu.version_code >= method(name).REQUIRES_GL]
    needed = dict.fromkeys([*able, REFERENCE] if any(map(seen.covers, able)) else able)
    results = {
        name: pipeline.render(settings.with_(method=name), f"seen/{name}", ends_frame=False) for name in needed
    }  # fmt: skip
    shown = {name: _shown(pipeline, name, results, settings, seen, linear) for name in able}
    overlay = None
    if seen.in_focus:
        frame = pipeline.frame(settings, guard=method(settings.method).GUARD_BAND)
        overlay = overlays.in_focus(gpu, frame, size, seen.band, "seen/focus band")
    found = layers(gpu, seen, able, shown, size, overlay)
    canvas = compose(gpu, found, size, "seen once", linear=linear)
    gpu.targets.collect()
    return canvas


def _shown(
    pipeline: Pipeline, name: str, results: dict[str, Result], settings: Settings, seen: Seen, linear: bool
) -> Image:  # fmt: skip
    image, into = results[name].image, f"seen/{name} shown"
    if seen.covers(name):
        return overlays.error_map(pipeline.gpu, image, results[REFERENCE].image, seen.heat, into)
    return image if linear else show(pipeline.gpu, image, settings.display, into)
