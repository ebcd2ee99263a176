"""Fetches of every method's frame, counted in its shaders, beside what its page derives."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from dofview.bench.derived import DERIVED, Facts, Fetches
from dofview.bench.measure import Bench, machine
from dofview.bench.plan import Case, natural
from dofview.export import write_whole
from dofview.gl.fetches import Count, CountingLibrary

SCENES = ("demo:foreground", "demo:background", "demo:rail")
SIZE, COC_PX, VIEWS = (256, 192), 8.0, 64
MOST_RATIO = 1.5
SHARED = ("render/resolve.frag", "render/depth_range.frag", "render/occupancy.frag", "render/squared_error.frag",
          "pass/sum.frag", "render/close.frag", "render/peeled.frag")  # fmt: skip
"""What every method has, what is made once for a camera, or helps to draw the scene: no method's page derives it."""


class Counted(NamedTuple):
    """One method on one scene: fetches by shader, counted and derived, and blended fragments; all per picture pixel."""

    scene: str
    method: str
    counted: Fetches
    derived: Fetches
    blended: float

    @property
    def ratio(self) -> float:
        """What is fetched over what is derived."""
        return sum(self.counted.values()) / sum(self.derived.values())


def count(bench: Bench, scene: str, method: str, size: tuple[int, int] = SIZE, coc_px: float = COC_PX) -> Counted:
    """Render a frame with everything anew by shaders that count, and derive what it should fetch."""
    parameters = (("views", VIEWS),) if method == "accumulation" else ()
    case = Case(scene, method, natural(method), coc_px, size, parameters)
    pipeline, settings, gpu = bench.pipeline(scene), bench.settings(case), bench.gpu
    own, gpu.shaders = gpu.shaders, CountingLibrary(gpu.ctx)
    try:
        # What is made once for a context is not in the frame.
        pipeline.render(settings)
        pipeline.forget()
        gpu.shaders.clear()
        gpu.profile.timing = True
        result = pipeline.render(settings)
        gpu.profile.resolve()
        drawn = [one for one in gpu.shaders.counts() if one.shader not in SHARED]
        images = {image.name: image for image in gpu.targets.named()}
        facts = Facts(result.frame, settings, result.counts, drawn, lambda name: images[name].pixels())
        derived = DERIVED[method](facts)
    finally:
        gpu.profile.timing = False
        gpu.shaders.release()
        gpu.shaders = own
    pixels = math.prod(size)
    return Counted(
        scene, method, _by_shader(drawn, pixels), {name: total / pixels for name, total in derived.items() if total},
        result.counts.get("blended fragments", 0) / pixels,
    )  # fmt: skip


def _by_shader(drawn: list[Count], pixels: int) -> Fetches:
    found: Fetches = {}
    for one in drawn:
        if one.fetches:
            found[one.shader] = found.get(one.shader, 0.0) + one.fetches / pixels
    return found


def measure_fetches(out: Path, on_case: Callable[[Counted], None] = lambda found: None) -> None:
    """Count every method on every scene and write fetches.md into the folder `out`."""
    out.mkdir(parents=True, exist_ok=True)
    bench, found = Bench(), []
    try:
        for scene in SCENES:
            for method in DERIVED:
                found.append(count(bench, scene, method))
                on_case(found[-1])
        renderer = machine(bench.gpu)["renderer"]
    finally:
        bench.release()
    page = fetches_page(found, renderer)
    write_whole(out / "fetches.md", lambda part: part.write_text(page, encoding="utf-8"))


TEXT = """\
# Fetches, counted and derived

Made by `dofview bench --fetches --out docs/benchmark` on {renderer}: {size}, mean CoC
{coc:g} px, each method with its defaults and its own lens, accumulation with {views} views, everything drawn anew.

Every call of a texture function in the fragment shaders of full-screen passes adds one to a counter of its shader
(`dofview/gl/fetches.py`); a bilinear fetch is one, a gather of four texels too. *Derived* is what the section *Cost* of
the method's page says, evaluated for the frame (`dofview/bench/derived.py`): levels, sub-images, layers, how far pixels
look. Where tiles or geometry decide how many fragments a pass has, it is those drawn, and their fetches are derived:
all of `layered` but its first and last passes, and multiview's `cones`. Both are for a pixel of the picture; the guard
band is in them, so a wide blur makes them larger. What is made once for a camera, and what draws the scene, is not. A
method is to stay within {most:g} of what it derives (test).

{table}

## By pass

{passes}
"""


def fetches_page(found: list[Counted], renderer: str) -> str:
    """The page of Markdown."""
    scenes = list(dict.fromkeys(one.scene for one in found))
    lines = ["| method | " + " | ".join(f"{name.removeprefix('demo:')}: counted, derived | ratio" for name in scenes)
             + " | blended fragments |", "|---|" + "---|---|" * len(scenes) + "---|"]  # fmt: skip
    for method in dict.fromkeys(one.method for one in found):
        cells, own = [], [one for one in found if one.method == method]
        for one in own:
            cells += [f"{sum(one.counted.values()):.0f}, {sum(one.derived.values()):.0f}", f"**{one.ratio:.2f}**"]
        blended = ", ".join(f"{one.blended:.2g}" for one in own)
        lines.append(f"| {method} | " + " | ".join(cells) + f" | {blended} |")
    passes = ["| method | shader | " + " | ".join(f"{name.removeprefix('demo:')}" for name in scenes) + " |",
              "|---|---|" + "---|" * len(scenes)]  # fmt: skip
    for method in dict.fromkeys(one.method for one in found):
        own = [one for one in found if one.method == method]
        for number, shader in enumerate(dict.fromkeys(name for one in own for name in (*one.derived, *one.counted))):
            both = [(one.counted.get(shader, 0.0), one.derived.get(shader, 0.0)) for one in own]
            cells = [f"{one:.1f}, {other:.1f}" if one or other else "–" for one, other in both]
            name = shader.removesuffix(".frag").removeprefix(f"methods/{method}/")
            passes.append(f"| {method if not number else ''} | `{name}` | " + " | ".join(cells) + " |")
    return TEXT.format(
        renderer=renderer, size="×".join(map(str, SIZE)), coc=COC_PX, views=VIEWS, most=MOST_RATIO,
        table="\n".join(lines), passes="\n".join(passes),
    )  # fmt: skip
