"""What is left out of a frame that does not need it: what it saves, and that the picture is the same.

Each entry is measured with the work left out and with the work done after all, from the same scenes and through a lens
that gives the rule something to do.
"""

from __future__ import annotations

import itertools
import json
import statistics
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from dofview.bench.measure import Bench, machine
from dofview.bench.plan import Case, natural
from dofview.bench.skip_page import skip_page
from dofview.bench.timing import timed
from dofview.export import write_whole
from dofview.metrics import psnr
from dofview.pipeline import Pipeline
from dofview.render.reference import Reference
from dofview.settings import Settings

SCENES = ("demo:foreground", "demo:background", "demo:rail")
SIZE = (256, 192)
COC_PX = 8.0
FRAMES, MOST_FRAMES, ENOUGH_MS = 3, 20, 1200.0
"""Frames each way: at least, at most, and how long they take together when there are no more."""

See = Callable[[Pipeline, Settings], Settings]


def as_it_is(pipeline: Pipeline, settings: Settings) -> Settings:
    """The scene's own view, opened to the mean CoC."""
    return settings


def focused_in_front(pipeline: Pipeline, settings: Settings) -> Settings:
    """Focus on the nearest surface: nothing is in front of it."""
    nearest = pipeline.frame(settings, guard=True).depth_range().nearest
    return _focused(settings, 0.999 / nearest)


def focused_behind(pipeline: Pipeline, settings: Settings) -> Settings:
    """Focus half as far again, the aperture six times as wide: little is in focus."""
    wide = settings.lens.model_copy(update={"radius": 6.0 * settings.lens.radius})
    return _focused(settings.with_(lens=wide), 1.5 * settings.lens.focus_distance)


def nearly_closed(largest_px: float) -> See:
    """An aperture with which no CoC radius is above `largest_px`."""

    def see(pipeline: Pipeline, settings: Settings) -> Settings:
        largest = max(abs(c) for c in pipeline.frame(settings, guard=True).coc_range())
        radius = settings.lens.radius * largest_px / largest
        return settings.with_(lens=settings.lens.model_copy(update={"radius": radius}))

    see.__doc__ = f"An aperture with no CoC radius above {largest_px:g} px." if largest_px else "A closed lens."
    return see


def through_a_long_lens(pipeline: Pipeline, settings: Settings) -> Settings:
    """A field of view of 8 degrees: most of the scene is outside."""
    return settings.with_(camera=settings.camera.model_copy(update={"vfov_deg": 8.0}))


def _focused(settings: Settings, distance: float) -> Settings:
    return settings.with_(lens=settings.lens.model_copy(update={"focus_distance": distance}))


@dataclass(frozen=True)
class Skip:
    """A rule: what is left out when, the counter that tells, and the situation it is measured in."""

    method: str
    what: str
    when: str
    counter: str
    see: See = as_it_is
    parameters: dict[str, Any] = field(default_factory=dict)
    scenes: tuple[str, ...] = SCENES


SKIPS = (
    Skip("mipmap", "the whole method", "no CoC radius above 0.003 px", "frames in focus", nearly_closed(0.002)),
    Skip("splatting", "the whole method", "no CoC radius above 0.35 px", "frames in focus", nearly_closed(0.3)),
    Skip("multiview", "the whole method", "no CoC radius above 5e-6 px", "frames in focus", nearly_closed(0.0)),
    Skip("layered", "the whole method", "no CoC radius above 0.05 px", "frames in focus", nearly_closed(0.04)),
    Skip("pyramid", "the whole method", "no CoC radius above 1e-5 px", "frames in focus", nearly_closed(0.0)),
    Skip("splatting", "searching and blending in tiles in focus", "no point reaches out of its pixel or into the tile",
         "splatting tiles copied", nearly_closed(2.0)),
    Skip("splatting", "image H: a pass over the scene and its points", "nothing in front of the focus",
         "splatting hidden passes skipped", focused_in_front),
    Skip("splatting", "layer L0", "no point can be in front of another's layer", "splatting front layers skipped",
         nearly_closed(0.45)),
    Skip("multiview", "layers that a pixel's rays cannot meet anything in", "tile masks say so",
         "multiview layers skipped"),
    Skip("layered", "further peels", "a peel found nothing", "layered peels skipped", parameters={"peels": 8}),
    Skip("layered", "parts of the scene, in all passes behind a surface", "no sample of them is behind it",
         "peel parts skipped", parameters={"peels": 4}, scenes=tuple(f"{name}@200k" for name in SCENES)),
    Skip("layered", "layers without surfaces", "no cell has any in their range", "layered layers empty",
         parameters={"layers": 24}),
    Skip("layered", "filtering and blending in tiles", "nothing of a layer can be seen there", "layered tiles skipped"),
    Skip("pyramid", "sub-images without pixels", "no depth occurs in their range", "pyramid sub-images skipped",
         focused_behind, scenes=("demo:foreground", "demo:crossing", "demo:highlights")),
    Skip("pyramid", "pull-push of a sub-image", "no pixel of it was culled", "pyramid fills skipped"),
    Skip("pyramid", "pull-push of a sub-image", "nothing in front of the focus", "pyramid fills skipped",
         focused_in_front),
    Skip("mipmap", "levels that no blur reads", "the largest CoC asks for fewer", "mipmap levels skipped"),
    Skip("mipmap", "smoothing of the foreground's blur", "nothing in front of the focus", "mipmap smoothings skipped",
         focused_in_front),
    Skip("accumulation", "all views but one", "the lens is closed", "accumulation views skipped", nearly_closed(0.0),
         {"views": 16}),
    Skip("accumulation", "pieces outside the union of all lens frusta", "their box is beyond one side of it",
         "pieces culled", through_a_long_lens, {"views": 16}, tuple(f"{name}@200k" for name in SCENES)),
    Skip("layered", "pieces outside the picture and its guard band", "their box is beyond one side of it",
         "pieces culled", through_a_long_lens, scenes=tuple(f"{name}@200k" for name in SCENES)),
    Skip("splatting", "all passes over the scene", "scene, camera and size are as before (focus moved)", "kept images"),
    Skip("multiview", "all passes over the scene", "scene, camera and size are as before (focus moved)", "kept images"),
    Skip("accumulation", "further views", "the reference vouches for 45 dB", "converged", parameters={"views": 256}),
)  # fmt: skip


def measure_skips(out: Path, on_skip: Callable[[dict], None] = lambda record: None) -> None:
    """Measure every entry of `SKIPS` and write skips.json and the table skips.md into the folder `out`."""
    out.mkdir(parents=True, exist_ok=True)
    bench = Bench()
    records = []
    try:
        for record in _measured(bench):
            records.append(record)
            on_skip(record)
        machines = machine(bench.gpu)
    finally:
        bench.release()
    content = {"machine": machines, "clock": bench.clock.name, "size": SIZE, "mean_coc_px": COC_PX, "skips": records}
    text = json.dumps(content, indent=1) + "\n"
    write_whole(out / "skips.json", lambda part: part.write_text(text, encoding="utf-8"))
    page = skip_page(content)
    write_whole(out / "skips.md", lambda part: part.write_text(page, encoding="utf-8"))


def _measured(bench: Bench) -> Iterator[dict]:
    for skip in SKIPS:
        for scene in skip.scenes:
            case = Case(scene, skip.method, natural(skip.method), COC_PX, SIZE, tuple(skip.parameters.items()))
            pipeline = bench.pipeline(scene)
            settings = skip.see(pipeline, bench.settings(case))
            measure = {"kept images": _kept_images, "converged": _converged}.get(skip.counter, _switched)
            found = measure(bench, pipeline, settings, skip)
            shown = {name: value for name, value in asdict(skip).items() if name not in ("see", "scenes")}
            yield {**shown, "scene": scene, "seen": skip.see.__doc__ or f"aperture for {skip.when}", **found}


def _switched(bench: Bench, pipeline: Pipeline, settings: Settings, skip: Skip) -> dict[str, object]:
    """Frames in turn with the work left out and done: milliseconds of both, and how far the pictures differ."""
    profile, pictures = bench.gpu.profile, {}
    times: dict[bool, list[float]] = {True: [], False: []}
    for left_out in itertools.cycle((True, False)):
        if left_out and _enough(times[True]):
            break
        profile.done_anyway = frozenset() if left_out else frozenset({skip.counter})
        pipeline.scene.culling = left_out or skip.counter != "pieces culled"
        if left_out not in pictures:
            pipeline.forget()
            pictures[left_out] = pipeline.render(settings).pixels()
        times[left_out] += timed(pipeline, settings, None, bench.clock)[1]
    profile.done_anyway, pipeline.scene.culling = frozenset(), True
    return {**_times(times), "max_difference": _difference(pictures), "count": _count(pipeline, settings, skip.counter)}


def _enough(milliseconds: list[float]) -> bool:
    count = len(milliseconds)
    return count >= MOST_FRAMES or (count >= FRAMES and sum(milliseconds) >= ENOUGH_MS)


def _count(pipeline: Pipeline, settings: Settings, counter: str) -> int:
    """What the counter says of one frame; some count only while a person looks at timings."""
    profile = pipeline.gpu.profile
    pipeline.forget()
    profile.timing = True
    try:
        return pipeline.render(settings).counts.get(counter, 0)
    finally:
        profile.resolve()
        profile.timing = False


def _kept_images(bench: Bench, pipeline: Pipeline, settings: Settings, skip: Skip) -> dict[str, object]:
    """The focus moves to and fro: with the images of the frame before, and with nothing kept."""
    pictures, passes = {}, {}
    times: dict[bool, list[float]] = {True: [], False: []}
    for kept in (True, False):
        for number in range(2 * FRAMES):
            moved = _focused(settings, settings.lens.focus_distance * (1.02 if number % 2 else 1.0))
            if not kept:
                pipeline.forget()
            bench.gpu.ctx.finish()
            start = bench.clock.now()
            result = pipeline.render(moved)
            bench.gpu.ctx.finish()
            if number > 1:
                times[kept].append((bench.clock.now() - start) * 1e3)
        pictures[kept], passes[kept] = result.pixels(), result.counts.get("geometry passes", 0)
    count = passes[False] - passes[True]
    return {**_times(times), "max_difference": _difference(pictures), "count": count}


def _converged(bench: Bench, pipeline: Pipeline, settings: Settings, skip: Skip) -> dict[str, object]:
    """A progressive reference that ends where it vouches for 45 dB, and one of a fixed number of views."""
    most, pictures, times, views = int(skip.parameters["views"]), {}, {}, {}
    for ends in (True, False):
        start = bench.clock.now()
        reference = Reference(pipeline.frame(settings, guard=False), antialias=False)
        while reference.views < most and not (ends and reference.quality().self_psnr >= 45.0):
            reference.add(16)
        bench.gpu.ctx.finish()
        times[ends] = [(bench.clock.now() - start) * 1e3]
        pictures[ends], views[ends] = reference.mean().pixels()[..., :3], reference.views
    left_out = most - views[True]
    quality = {"psnr": round(psnr(pictures[True], pictures[False]), 1)} if left_out else {}
    return {**_times(times), "max_difference": _difference(pictures), "count": left_out, **quality}


def _times(times: dict[bool, list[float]]) -> dict[str, float]:
    return {"ms": round(statistics.median(times[True]), 3), "ms_without": round(statistics.median(times[False]), 3)}


def _difference(pictures: dict[bool, np.ndarray]) -> float:
    return float(np.abs(pictures[True] - pictures[False]).max())
