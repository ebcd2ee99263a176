"""Measure what `multiview` costs beside the reference with as many views, and write docs/methods/multiview.md.

Layers and rays as in table 1 of its paper, on scenes of as many triangles, and on three of 5,000. Each frame is drawn
from nothing. A software rasteriser is timed by the processor time of one thread, so other work on the machine does not
show; a GPU by the clock. The views are measured in the same run: eight of them, times their number.

    LP_NUM_THREADS=0 python docs/multiview_cost.py
"""

from __future__ import annotations

import datetime
import os
import re
import time
from collections.abc import Callable
from pathlib import Path

os.environ.setdefault("LP_NUM_THREADS", "0")

from dofview.framing import opening
from dofview.gl.context import Gpu, create_headless
from dofview.pipeline import Pipeline
from dofview.scene.load import load
from dofview.settings import Settings

PAGE = Path(__file__).parent / "methods" / "multiview.md"
SIZE = (400, 300)
VIEWS = 8
RAYS = (8, 16, 32, 64, 256)
LAYERS = (1, 8, 12, 16)
SCENES = ("demo:rail@67k", "demo:background@300k", "demo:foreground@1.76m")
SMALL = tuple(f"demo:{name}@5k" for name in ("rail", "background", "foreground"))
STAGES = {
    "depths": ("scene/guard band", "scene/depths"), "layers": ("multiview/layers", "multiview/occupied"),
    "averaged for cones": ("multiview/cones",), "masks": ("multiview/spread",), "tracing": ("multiview/trace",),
}  # fmt: skip


class Measured:
    """One scene: milliseconds by settings, each frame from nothing, the least of several."""

    def __init__(self, gpu: Gpu, scene: str):
        self.gpu, self.pipeline = gpu, Pipeline(gpu, load(scene))
        self.settings = opening(load(scene), scene).with_(image={"size": SIZE})
        self.triangles = sum(piece.count // 3 for piece in self.pipeline.scene.draws)
        self.view = self.frame(self.settings.with_(method="accumulation").with_params(views=VIEWS)) / VIEWS

    def multiview(self, rays: int, layers: int, **params: object) -> Settings:
        return self.settings.with_(method="multiview").with_params(samples=rays, layers=layers, **params)

    def frame(self, settings: Settings, forget: bool = True) -> float:
        self.pipeline.render(settings)
        times = []
        for _ in range(3):
            if forget:
                self.pipeline.forget()
            times.append(milliseconds(self.gpu, lambda: self.pipeline.render(settings)))
        return min(times)

    def stages(self, settings: Settings) -> dict[str, float]:
        """Each stage of one frame, with what the others have begun waited for."""
        profile = self.gpu.profile
        profile.now, profile.timing = clock(self.gpu), True
        self.pipeline.forget()
        self.pipeline.render(settings)
        found = profile.resolve()
        profile.timing = False
        return {stage: sum(found.get(section, 0.0) for section in parts) for stage, parts in STAGES.items()}


def clock(gpu: Gpu) -> Callable[[], float]:
    return time.process_time if gpu.software else time.perf_counter


def milliseconds(gpu: Gpu, work: Callable[[], object]) -> float:
    gpu.ctx.finish()
    start = clock(gpu)()
    work()
    gpu.ctx.finish()
    return (clock(gpu)() - start) * 1e3


def line(*cells: object) -> str:
    return f"| {' | '.join(str(cell) for cell in cells)} |"


def large(gpu: Gpu, scene: str) -> tuple[list[str], str]:
    """Rows over layers and rays, and the row of the stages."""
    measured = Measured(gpu, scene)
    name = f"`{scene.partition(':')[2].partition('@')[0]}` {measured.triangles:,}".replace(",", " ")
    rows = [line(name, "accumulation", *(f"{measured.view * rays:.0f}" for rays in RAYS), "")]
    took: dict[int, list[float]] = {layers: [] for layers in LAYERS}
    # Layers in turns, so that a machine that becomes slower does not show in what one costs over the other.
    for rays in RAYS:
        for layers, times in took.items():
            times.append(measured.frame(measured.multiview(rays, layers)))
    for layers, times in took.items():
        ratio = max(time / eight for time, eight in zip(times, took[8], strict=True)) if layers > 8 else 0.0
        rows.append(line("", layers, *(f"{time:.0f}" for time in times), f"{ratio:.2f}" if ratio else ""))
    stages = measured.stages(measured.multiview(32, 16))
    measured.pipeline.release()
    print(*rows, sep="\n", flush=True)
    return rows, line(name, *(f"{stages[stage]:.0f}" for stage in STAGES))


def small(gpu: Gpu, scene: str) -> str:
    """How many times faster than the reference, with as many rays as it has views."""
    measured = Measured(gpu, scene)
    cells = []
    for rays in (8, 32):
        for params in ({}, {"cones": False}):
            cells.append(f"{measured.view * rays / measured.frame(measured.multiview(rays, 16, **params)):.2f}")
        cells.append(f"{measured.view * rays / measured.frame(measured.multiview(rays, 16), forget=False):.2f}")
    row = line(f"`{scene.partition(':')[2].partition('@')[0]}`", f"{measured.triangles:,}".replace(",", " "), *cells)
    measured.pipeline.release()
    print(row, flush=True)
    return row


def page(gpu: Gpu) -> str:
    large_rows, stage_rows = zip(*(large(gpu, scene) for scene in SCENES), strict=True)
    by = "processor time of one thread" if gpu.software else "wall time"
    return "\n".join([
        f"{datetime.date.today()}, {gpu.renderer}, {by}, ms, {SIZE[0]}×{SIZE[1]}, cones, `detail` 1, everything drawn",
        "anew. *Accumulation* has N views. The last column is the largest share of what eight layers cost.", "",
        line("scene, triangles", "layers", *(f"N = {rays}" for rays in RAYS), "over 8 layers"), "|---" * 8 + "|",
        *(row for rows in large_rows for row in rows), "",
        "Stages at 16 layers and N = 32, each waited for:", "",
        line("scene, triangles", *STAGES), "|---" * 6 + "|", *stage_rows, "",
        "Times faster than accumulation with the same N, 16 layers; *at rest*: scene and camera as they were, so that",
        "only masks and tracing are done:", "",
        line("scene", "triangles", *(f"N = {n}{way}" for n in (8, 32) for way in ("", ", no cones", ", at rest"))),
        "|---" * 8 + "|", *(small(gpu, scene) for scene in SMALL),
    ])  # fmt: skip


if __name__ == "__main__":
    gpu = create_headless()
    text = PAGE.read_text(encoding="utf-8")
    table = f"<!-- cost -->\n{page(gpu)}\n<!-- /cost -->"
    PAGE.write_text(re.sub(r"<!-- cost -->.*?<!-- /cost -->", lambda _: table, text, flags=re.S), encoding="utf-8")
    print(f"wrote: {PAGE}")
    gpu.release()
