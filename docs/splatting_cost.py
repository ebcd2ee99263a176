"""Measure what `splatting` costs beside the reference, as table 1 of its paper has it, for docs/methods/splatting.md.

1024×768, scenes of about 216,000 and 46,000 triangles, mean CoC diameters of 8, 16 and 32 px against 24, 96 and 384
views of the reference. Each frame is drawn from nothing, both geometry passes included. A software rasteriser is timed
by the processor time of one thread, so other work on the machine does not show; a GPU by the clock. The views are
measured in the same run: eight of them, times their number.

    LP_NUM_THREADS=0 python docs/splatting_cost.py
"""

from __future__ import annotations

import datetime
import os
import re
import time
from collections.abc import Callable
from pathlib import Path

os.environ.setdefault("LP_NUM_THREADS", "0")

import numpy as np

from dofview.framing import opening
from dofview.gl.context import Gpu, create_headless
from dofview.pipeline import Pipeline, Result
from dofview.scene.load import load
from dofview.settings import Settings

PAGE = Path(__file__).parent / "methods" / "splatting.md"
SCENES = {"demo:foreground@216k": (5.6, 17.0, 44.0), "demo:foreground@46k": (4.5, 7.5, 19.0)}
"""The scenes, and how many times faster than the reference the paper's accelerated method was on its own two."""
BLURS = {8: 24, 16: 96, 32: 384}
"""Mean CoC diameter, px, and the views that the paper gives the reference for it."""
FOCUS = 3.3
"""Between the strings of beads: the largest CoC is 1.4 times the mean, as on the paper's scenes (24 px at 16)."""
WAYS = {
    "as it is": {},
    "nothing left out": {"skip": False},
    "the paper's merging": {"reduction": "paper", "reduced_from": 4.0},
    "nothing merged": {"reduction": "none"},
    "nothing merged, scatter": {"reduction": "none", "computation": "scatter"},
}


def timed(gpu: Gpu, work: Callable[[], Result], times: int) -> tuple[float, Result]:
    """The least of `times` measurements, ms, and the last result."""
    clock = time.process_time if gpu.software else time.perf_counter
    found = []
    for _ in range(times):
        gpu.ctx.finish()
        start = clock()
        result = work()
        gpu.ctx.finish()
        found.append((clock() - start) * 1e3)
    return min(found), result


def with_mean_coc(pipeline: Pipeline, settings: Settings, diameter: float) -> Settings:
    """The aperture under which the mean CoC diameter over the picture is `diameter` px."""
    frame = pipeline.render(settings.with_(method="pinhole")).frame
    guard = frame.guard
    inverse = frame.pinhole().inverse_depth.pixels()[guard : guard + 768, guard : guard + 1024, 0]
    now = 2.0 * float(np.abs(frame.coc.radius_px(inverse)).mean())
    lens = settings.lens.model_copy(update={"radius": settings.lens.radius * diameter / now})
    return settings.with_(lens=lens)


def looked_at(pipeline: Pipeline, settings: Settings) -> float:
    """Points that each pixel looks at, or whose sprites cover it, in the mean."""
    found = {image.name.removeprefix("splatting/"): image for image in pipeline.gpu.targets.named("splatting/")}
    if settings.params.splatting.computation != "scatter":
        guard = pipeline.render(settings.with_params(inspect=True)).frame.guard
        fetches = next(iter(pipeline.gpu.targets.named("splatting/fetches")))
        return float(fetches.pixels()[guard : guard + 768, guard : guard + 1024].mean())
    sides = 0.0
    for name in ("points", "hidden points"):
        packed = found[name].pixels()[..., 3]
        radius = np.abs(np.floor(packed)) / 64.0
        sprite = np.sqrt(radius**2 + 0.25 * np.maximum(1.0 - radius / 1.5, 0.0))
        sides += float(np.where(packed % 1.0 > 0.0, (2.0 * sprite + 2.0) ** 2, 0.0).sum())
    return sides / packed.size


def rows(gpu: Gpu, scene: str, published: tuple[float, ...]) -> list[str]:
    """One table row per blur and way."""
    pipeline = Pipeline(gpu, load(scene))
    start = opening(load(scene), scene)
    start = start.with_(image={"size": (1024, 768)}, lens={**start.lens.model_dump(), "focus_distance": FOCUS})
    lines = []
    for (diameter, views), paper in zip(BLURS.items(), published, strict=True):
        settings = with_mean_coc(pipeline, start, diameter)
        reference = settings.with_(method="accumulation").with_params(views=8)
        pipeline.render(reference)
        view = timed(gpu, lambda chosen=reference: pipeline.render(chosen), 3)[0] / 8
        for way, params in WAYS.items():
            chosen = settings.with_(method="splatting").with_params(**params)

            def frame(chosen: Settings = chosen) -> Result:
                pipeline.forget()
                return pipeline.render(chosen)

            # The slow ones are done once; what they compile, the smallest blur has compiled before.
            slow = "merg" in way and diameter > 8
            if not slow:
                frame()
            took, result = timed(gpu, frame, 1 if slow else 3)
            near, far = result.frame.coc_range()
            ratio, counts = f"{view * views / took:.1f}", result.counts
            lines.append(
                f"| {scene.partition('@')[2]} | {diameter} ({2 * max(-near, far):.0f}) | {way} | {took:.0f} "
                f"| {view:.0f} × {views} | {f'**{ratio}**' if not params else ratio} | {'' if params else paper} "
                f"| {looked_at(pipeline, chosen):.0f} | {counts['passes']} + {counts['geometry passes']} |"
            )
            print(lines[-1], flush=True)
    pipeline.release()
    return lines


if __name__ == "__main__":
    gpu = create_headless()
    clock = "processor time of one thread" if gpu.software else "wall time"
    found = [
        f"Measured on {datetime.date.today():%d %B %Y} in one run: {gpu.renderer}, {clock}, ms.", "",
        "| triangles | mean CoC (largest), px | | frame | reference | times faster | the paper | points per pixel "
        "| passes + geometry |",
        "|---|---|---|---|---|---|---|---|---|",
        *(line for scene, published in SCENES.items() for line in rows(gpu, scene, published)),
    ]  # fmt: skip
    text = PAGE.read_text(encoding="utf-8")
    table = "<!-- cost -->\n" + "\n".join(found) + "\n<!-- /cost -->"
    PAGE.write_text(re.sub(r"<!-- cost -->.*?<!-- /cost -->", lambda _: table, text, flags=re.S), encoding="utf-8")
    print(f"wrote: {PAGE}")
    gpu.release()
