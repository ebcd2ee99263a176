"""Measure what `layered` costs beside the reference and `multiview`, as table 1 of its paper does.

Writes the table in docs/methods/layered.md. On llvmpipe set LP_NUM_THREADS=0: times are then the processor's, which
repeat to a few percent whatever else runs. About five minutes there.
"""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

from dofview.bench.timing import clock_of, pass_times, spread, timed
from dofview.framing import opening
from dofview.gl.context import Gpu, create_headless
from dofview.pipeline import Pipeline
from dofview.scene.load import load
from dofview.scene.model import Scene
from dofview.settings import Settings

PAGE = Path(__file__).parent / "methods" / "layered.md"
BEGIN, END = "<!-- cost -->", "<!-- /cost -->"
SCENES = ("foreground@74k", "foreground@610k")
SIZE = (1024, 1024)
VIEWS, MEASURED_VIEWS = 256, 16
RAYS = (256, 128, 32)
PAPER = {"constants": "paper", "matting": "paper", "coarse_sigma": 0.0, "fill": False}
ROWS = {
    "2 peels": {},
    "2 peels, separate": {"cascaded": False},
    "4 peels": {"peels": 4},
    "4 peels, separate": {"peels": 4, "cascaded": False},
    "4 peels, the paper's layers and filters": {"peels": 4, **PAPER},
}
STAGES = {
    "peel": ("scene/",),
    "matting": ("layered/depths", "layered/content", "layered/join"),
    "blur": ("layered/blur", "layered/clear", "layered/copy"),
}
PUBLISHED = (
    "| *Homunculus, 74 k, cascaded* | *46* | *5* | *51* | | *102* | | *47* | *13.2* | *6.8* | *1.8* |",
    "| *separate* | *46* | *5* | *95* | | *146* | | *33* | *9.2* | *4.7* | *1.3* |",
    "| *Dragons, 610 k, cascaded* | *40* | *7* | *51* | | *98* | | *42* | *14.7* | *7.7* | *2.2* |",
    "| *separate* | *40* | *8* | *85* | | *133* | | *31* | *10.8* | *5.7* | *1.6* |",
)
HEAD = (
    "| | peel | matting | blur | rest | total, ms | layers, passes, fragments | accumulation | 256 rays | 128 | 32 |",
    "|---|---|---|---|---|---|---|---|---|---|---|",
)


class Cost(NamedTuple):
    """Milliseconds of a frame, of its stages, and what it counted."""

    total: float
    stages: dict[str, float]
    counts: dict[str, int]


def milliseconds(pipeline: Pipeline, settings: Settings) -> tuple[float, dict[str, int]]:
    """Least of up to three whole frames, in which everything is drawn anew: what is above it is others' doing."""
    pipeline.render(settings)  # what is compiled is not of a frame, and a long frame is not warmed up for by `timed`
    pipeline.gpu.ctx.finish()
    result, found = timed(pipeline, settings, 3, clock_of(pipeline.gpu), enough_ms=3000.0)
    return spread(found).lower, result.counts


def cost(pipeline: Pipeline, settings: Settings) -> Cost:
    """The cost of a frame of `layered`, by the stages of the paper's table."""
    total, counts = milliseconds(pipeline, settings)
    passes = pass_times(pipeline, settings, clock_of(pipeline.gpu))
    stages = {
        stage: sum(ms for name, ms in passes.items() if name.startswith(prefixes)) for stage, prefixes in STAGES.items()
    }
    return Cost(total, stages, counts)


def lines(gpu: Gpu, scene: str) -> list[str]:
    """The rows of one scene, each with how many times longer the reference and `multiview` take."""
    loaded = load(f"demo:{scene}")
    pipeline = Pipeline(gpu, loaded)
    settings = opening(loaded, f"demo:{scene}").with_(image={"size": SIZE})
    settings = settings.with_(lens={**settings.lens.model_dump(), "distribution": "gaussian"})
    views, _ = milliseconds(pipeline, settings.with_(method="accumulation").with_params(views=MEASURED_VIEWS))
    others = [views * VIEWS / MEASURED_VIEWS]
    others += [milliseconds(pipeline, settings.with_(method="multiview").with_params(samples=n))[0] for n in RAYS]
    found = [
        f"| **{scene}**, {triangles(loaded) / 1000:.0f} k triangles |"
        + " |" * 6
        + "".join(f" {ms / 1000:.1f} s |" for ms in others)
    ]
    for name, params in ROWS.items():
        this = cost(pipeline, settings.with_(method="layered").with_params(**params))
        rest = this.total - sum(this.stages.values())
        size = f"{this.counts['layered layers']}, {this.counts['passes']}, {this.counts['fragments'] / 1e6:.1f} M"
        cells = [*(f"{ms:.0f}" for ms in (*this.stages.values(), rest)), f"**{this.total:.0f}**", size]
        cells += [f"{ms / this.total:.1f}" for ms in others]
        found.append(f"| {name} | " + " | ".join(cells) + " |")
        print(found[-1], flush=True)
    pipeline.release()
    return found


def triangles(scene: Scene) -> int:
    """Triangles of a scene, instances counted."""
    return sum(len(scene.primitives[instance.primitive].triangles) for instance in scene.instances)


def page(text: str, table: str) -> str:
    """`text` with the `table` in its place."""
    head, _, rest = text.partition(BEGIN)
    return f"{head}{BEGIN}\n{table}\n{END}{rest.partition(END)[2]}"


if __name__ == "__main__":
    gpu = create_headless()
    rows = [line for scene in SCENES for line in lines(gpu, scene)]
    note = f"*{gpu.renderer}, {clock_of(gpu).name} time.* The paper's own figures are in italics."
    PAGE.write_text(page(PAGE.read_text("utf-8"), "\n".join([note, "", *HEAD, *rows, *PUBLISHED])), "utf-8")
    print(f"wrote: {PAGE}")
    gpu.release()
