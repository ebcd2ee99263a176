"""Measure what 16 instead of 32 bits in intermediate images cost and save, for docs/benchmark/precision.md.

    python docs/precision.py

Every kind of image is made both ways, the rest of the method as it is; the reference is of 96 views through the same
lens. Nothing is kept between the two.
"""

from __future__ import annotations

import re
import statistics
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))

from dofview import metrics  # noqa: E402
from dofview.bench.measure import Bench, machine  # noqa: E402
from dofview.bench.plan import Case, Sweep, natural  # noqa: E402
from dofview.bench.timing import timed  # noqa: E402

PAGE = Path(__file__).parent / "benchmark" / "precision.md"
SCENES = ("demo:foreground", "demo:rail", "demo:highlights")
SIZE, COC_PX, FRAMES = (160, 120), 8.0, 1
SWEEP = Sweep(views=96, trust_db=60.0)


class Kind(NamedTuple):
    """Images of a method, by a pattern for their names, and the format that the method takes."""

    method: str
    what: str
    names: str
    chosen: str = "f4"
    parameters: tuple[tuple[str, object], ...] = ()


KINDS = (
    Kind("mipmap", "colour levels", r"mipmap/colour"),
    Kind("mipmap", "depth, blur and nearness levels", r"mipmap/(ZBN|DoN)"),
    Kind("splatting", "points: colour, CoC and share", r"splatting/.*points"),
    Kind("splatting", "sums of highlights' sprites", r"splatting/sprites"),
    Kind("splatting", "sums of all sprites (scattered)", r"splatting/[LM]\d", parameters=(("computation", "scatter"),)),
    Kind("multiview", "colour of the layers", r"multiview/layer color", "f2"),
    Kind("multiview", "inverse depth of the layers", r"multiview/layer inverse depth"),
    Kind("layered", "layers, filters and buffers", r"layered/(front|back) (?!tiles)"),
    Kind("layered", "filling", r"layered/fill"),
    Kind("layered", "inverse depths of the peels", r"layered/depths"),
    Kind("pyramid", "sub-images, levels and blending", r"pyramid/(level|sub-image|blended)"),
    Kind("pyramid", "filling", r"pyramid/fill"),
    Kind("accumulation", "sum of 64 views", r"accumulation/sum", parameters=(("views", 64),)),
    Kind("accumulation", "sum of 256 views", r"accumulation/sum", parameters=(("views", 256),)),
    Kind("layered", "pinhole picture and peels", r"frame/(pinhole|peel\d)$"),
    Kind("layered", "inverse depth of pinhole picture and peels", r"frame/.*inverse depth"),
)


def measured(bench: Bench, scene: str, kind: Kind) -> tuple[float, float, float, float, float]:
    """Largest difference of linear light, PSNR against the reference in 32 and in 16 bits, milliseconds of both."""
    case = Case(scene, kind.method, natural(kind.method), COC_PX, SIZE, kind.parameters)
    pipeline, settings, targets = bench.pipeline(scene), bench.settings(case), bench.gpu.targets
    truth = bench.truth(case, SWEEP).pixels
    make = type(targets).image
    pictures, times = {}, {}
    for dtype in ("f4", "f2"):

        def image(name, size, components=4, asked="f4", layers=0, linear=False, *, dtype="", instead=dtype):
            asked = dtype or asked
            chosen = instead if re.match(kind.names, name) and asked in ("f2", "f4") else asked
            return make(targets, name, size, components, chosen, layers, linear)

        targets.image = image
        result, milliseconds = timed(pipeline, settings, FRAMES, bench.clock)
        pictures[dtype], times[dtype] = result.pixels(), statistics.median(milliseconds)
    del targets.image
    difference = float(np.abs(pictures["f4"] - pictures["f2"]).max())
    return (difference, metrics.psnr(pictures["f4"], truth), metrics.psnr(pictures["f2"], truth), times["f4"],
            times["f2"])  # fmt: skip


def rows(bench: Bench) -> Iterator[str]:
    found: dict[Kind, list[tuple]] = {kind: [] for kind in KINDS}
    # A reference serves all methods of a lens.
    for scene in SCENES:
        for kind in sorted(KINDS, key=lambda kind: natural(kind.method)):
            found[kind].append(measured(bench, scene, kind))
            print(scene, kind.method, kind.what, *(f"{x:.3g}" for x in found[kind][-1]), flush=True)
    for kind, values in found.items():
        losses = " | ".join(f"{f4:.2f} − {max(f4 - f2, 0.0):.2f}" if f4 >= f2 else f"{f4:.2f} + {f2 - f4:.2f}"
                            for _, f4, f2, _, _ in values)  # fmt: skip
        largest = max(difference for difference, *_ in values)
        time = statistics.median(f2 / f4 for *_, f4, f2 in values)
        bits = "16" if kind.chosen == "f2" else "32"
        yield f"| {kind.method} | {kind.what} | {losses} | {largest:.1g} | {time:.2f} | **{bits}** |"


TEXT = """\
# 16 or 32 bits in intermediate images

Made by `python docs/precision.py`. {size}, mean CoC {coc:g} px, through the lens that each method is made for; PSNR in
dB against a reference of up to {views} views, in 32 bits and what 16 change in it. *Time* is of a whole frame with 16
over one with 32 bits ({clock}'s clock, {renderer}, {processor}). All else is as the method has it.

| method | images | {scenes} | largest difference | time | used |
|{lines}
{rows}

What follows:

* **32 bits are the rule.** 16 lose next to nothing in colours that are filtered or blended, at most 0.01 of white at a
  pixel and less than 0.1 dB, but here they gain nothing either: the time is the same within what timing is worth. On a
  machine where memory bandwidth counts, pyramids, filters and blurred layers are what would bear them.
* **Sums are in 32 bits whatever the machine.** The accumulation buffer adds small numbers to large ones, which 16 bits
  round away: half a dB at 64 views, six to seven at 256, and it stalls beyond. The sums of sprites lose the more the
  larger the sprites are.
* The lamps of *highlights* are 50 times as bright as white and 96 views do not resolve them: its differences are worth
  more than its PSNR.
* **What packs more than a colour is in 32 bits**: splatting's points carry CoC and share in one number; in 16 bits the
  picture is lost.
* **Depths are in 32 bits**: in 16 surfaces next to one another change places, seen at single pixels along silhouettes.
* **Multiview's layers keep their colours in 16 bits**: there are up to 32 of them, and memory is what limits them.
  Where nothing is blurred they are kept in 32, so that a closed lens gives the pinhole's picture.
"""


def main() -> None:
    bench = Bench()
    facts, clock = machine(bench.gpu), bench.clock.name
    lines = list(rows(bench))
    bench.release()
    page = TEXT.format(
        size="×".join(map(str, SIZE)), coc=COC_PX, views=SWEEP.views, clock=clock, renderer=facts["renderer"],
        processor=facts["processor"], scenes=" | ".join(name.removeprefix("demo:") for name in SCENES),
        lines="---|" * (len(SCENES) + 5), rows="\n".join(lines),
    )  # fmt: skip
    PAGE.parent.mkdir(exist_ok=True)
    PAGE.write_text(page, encoding="utf-8")
    print(f"wrote {PAGE}")


if __name__ == "__main__":
    main()
