"""`dofview render` and `dofview compare`: pictures without a screen."""

from __future__ import annotations

import json as jsonlib
import statistics
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from dofview import export
from dofview.bench.timing import timed
from dofview.cli.beside import seen_for
from dofview.cli.chosen import applied, settings_for
from dofview.cli.flags import Given
from dofview.cli.images import made_folder, with_every_step, write_images
from dofview.cli.runs import Timing
from dofview.errors import InputError
from dofview.gl.context import create_headless
from dofview.pipeline import Pipeline, Result
from dofview.remember import note, read_note, read_preset
from dofview.render.display import Display
from dofview.scene.load import load
from dofview.scene.model import Scene
from dofview.seen.headless import picture as headless_picture
from dofview.seen.model import Seen
from dofview.settings import Settings, checked

MOST_NOTES = 5


def render_to(
    spec: str | None, output: Path, given: Given, *, view: Path | None, method: str | None, camera: str | None,
    like: Path | None, preset: Path | None, images: Path | None = None,
) -> None:  # fmt: skip
    """Render one picture into `output`, what the method makes on its way into `images`, and print its facts, the last
    line as JSON."""
    timing = checked(Timing, given.get("timing", {}), "render")
    remembered = read_note(like) if like is not None else None
    if spec is None and remembered is not None:
        spec = remembered.spec
    if spec is None:
        raise InputError("render needs a SCENE, or --like PICTURE with one saved by dofview; see dofview render --help")
    base = _with_preset(remembered.settings if remembered else Settings(), preset)
    size = applied(base, given, view=view, method=method).image.size
    seen = seen_for(given, size, remembered.seen if remembered else None)
    export.check_writable(output)
    if images is not None:
        made_folder(images)
    scene = load(spec)
    if remembered is not None:
        settings = applied(base, given, view=view, method=method)
    else:
        settings = settings_for(scene, spec, given, view=view, method=method, camera=camera, preset=preset)
    tell_warnings(scene)
    if images is not None:
        settings = with_every_step(settings)
    with headless(scene) as pipeline:
        result, milliseconds = timed(pipeline, settings, timing.frames)
        _save(pipeline, result, settings, seen, output, note(spec, settings, seen))
        facts = {
            "ms": round(statistics.median(milliseconds), 3),
            "method": settings.method,
            "size": list(settings.image.size),
            "renderer": pipeline.gpu.renderer,
            "clock": "wall",
            "frames": len(milliseconds),
            "warm": timing.frames is not None,
            "counts": result.counts,
            "parameters": settings.method_params.model_dump(mode="json"),
            "scale": settings.image.scale,
            "guard_px": result.frame.guard,
            "triangles": scene.triangle_count,
            "scene": spec,
            "output": str(output),
        }
        if images is not None:
            facts["images"] = write_images(pipeline.gpu.targets, settings.method, images)
    print(jsonlib.dumps(facts))


def _save(
    pipeline: Pipeline, result: Result, settings: Settings, seen: Seen | None, output: Path, remark: str
) -> None:  # fmt: skip
    """Write the picture, or what is seen of it: as a screen shows it into a PNG, else linear light."""
    if output.suffix.lower() == ".png" and (seen is not None or settings.display != Display()):
        shown = pipeline.shown(result, settings) if seen is None else _seen(pipeline, settings, seen, linear=False)
        export.write_whole(output, lambda part: export.write_png8(part, shown, remark))
    else:
        linear = result.pixels() if seen is None else _seen(pipeline, settings, seen, linear=True)
        export.save(output, linear, remark)


def _seen(pipeline: Pipeline, settings: Settings, seen: Seen, linear: bool) -> np.ndarray:
    return np.ascontiguousarray(headless_picture(pipeline, settings, seen, linear=linear).pixels()[..., :3])


def _with_preset(settings: Settings, preset: Path | None) -> Settings:
    """`settings` with a preset; what it says that is of no use is told once."""
    if preset is None:
        return settings
    settings, complaints = read_preset(preset, settings)
    for complaint in complaints:
        print(f"dofview: note: {complaint}", file=sys.stderr)
    return settings


@contextmanager
def headless(scene: Scene) -> Iterator[Pipeline]:
    """A pipeline for `scene` in a context of its own, released at the end."""
    gpu = create_headless()
    try:
        yield Pipeline(gpu, scene)
    finally:
        gpu.release()
        gpu.ctx.release()


def tell_warnings(scene: Scene) -> None:
    """What a scene file asked for that is not shown, a line each."""
    for warning in scene.warnings[:MOST_NOTES]:
        print(f"dofview: note: {warning}", file=sys.stderr)
    if len(scene.warnings) > MOST_NOTES:
        print(f"dofview: note: and {len(scene.warnings) - MOST_NOTES} more; see dofview info", file=sys.stderr)
