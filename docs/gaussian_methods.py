"""Measure the three methods whose blur is a Gaussian beside each other, and `pyramid` by its sub-images.

Writes the tables and the picture of docs/methods/gaussian-methods.md and the cost table of docs/methods/pyramid.md. On
llvmpipe set LP_NUM_THREADS=0: times are then the processor's, which repeat to a few percent whatever else runs.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from PIL import Image

from dofview.bench.timing import clock_of, spread, timed
from dofview.export import to_srgb8
from dofview.framing import opening
from dofview.gl.context import Gpu, create_headless
from dofview.metrics import psnr, ssim
from dofview.pipeline import Pipeline
from dofview.scene.load import load
from dofview.settings import Settings

PAGES = Path(__file__).parent / "methods"
PICTURE = Path(__file__).parent / "images" / "gaussian-methods.png"
SIZE, SMALL = (512, 384), (208, 156)
VIEWS = 256
CASES = {"background": "blur behind the focus", "foreground": "blur in front of it"}
METHODS = ("mipmap", "pyramid", "layered")
PAPER = {
    "mipmap": {"constants": "paper"},
    "pyramid": {"analysis": "box4", "blur": "paper", "matting": "paper"},
    "layered": {"constants": "paper", "matting": "paper", "coarse_sigma": 0.0, "fill": False, "peels": 4},
}
RADII = (0.1, 0.3, 1.0, 3.0, 10.0)


def seen(scene: str, distribution: str, size: tuple[int, int], wider: float = 1.0) -> Settings:
    """The demo scene's own view through a lens `wider` times as large."""
    settings = opening(load(f"demo:{scene}"), f"demo:{scene}")
    lens = {**settings.lens.model_dump(), "distribution": distribution, "radius": settings.lens.radius * wider}
    return settings.with_(lens=lens, image={"size": size})


def measured(pipeline: Pipeline, settings: Settings) -> tuple[float, dict[str, int], np.ndarray]:
    """Milliseconds of the least of five whole frames, what it counted, and the picture."""
    result, found = timed(pipeline, settings, 3, clock_of(pipeline.gpu), enough_ms=1000.0)
    return spread(found).lower, result.counts, result.pixels()


def figures(picture: np.ndarray, reference: np.ndarray) -> str:
    """PSNR and SSIM as a cell."""
    return f"{psnr(picture, reference):.1f} ({ssim(picture, reference):.3f})"


def comparison(gpu: Gpu, scene: str) -> list[str]:
    """Rows of one case: each method calibrated and by its paper, under both lenses, with what it costs."""
    pipeline = Pipeline(gpu, load(f"demo:{scene}"))
    gaussian, disc = (seen(scene, kind, SIZE) for kind in ("gaussian", "uniform_disc"))
    references = [
        pipeline.render(s.with_(method="accumulation").with_params(views=VIEWS)).pixels() for s in (gaussian, disc)
    ]
    view, _, _ = measured(pipeline, gaussian.with_(method="accumulation").with_params(views=8))
    rows = [f"| **`{scene}`**, {CASES[scene]}; a view of the reference: {view / 8:.0f} ms | | | | | | |"]
    for name in ("pinhole", *METHODS):
        milliseconds, counts, picture = measured(pipeline, gaussian.with_(method=name))
        cells = [figures(picture, references[0])]
        cells.append(figures(pipeline.render(disc.with_(method=name)).pixels(), references[1]))
        for settings, reference in zip((gaussian, disc), references, strict=True):
            paper = settings.with_(method=name).with_params(**PAPER[name]) if name in PAPER else None
            cells.append(figures(pipeline.render(paper).pixels(), reference) if paper else "")
        pixels = SIZE[0] * SIZE[1]
        cells += [f"{milliseconds:.0f}", f"{counts['passes']}, {counts.get('fragments', 0) / pixels:.1f}"]
        rows.append(f"| {name} | " + " | ".join(cells) + " |")
        print(rows[-1], flush=True)
    pipeline.release()
    return rows


def growth(gpu: Gpu) -> list[str]:
    """Cost of `pyramid` on `rail` for growing lenses, that is, for growing numbers of sub-images."""
    pipeline = Pipeline(gpu, load("demo:rail"))
    rows = []
    for wider in RADII:
        settings = seen("rail", "gaussian", SIZE, wider).with_(method="pyramid", image={"size": SIZE, "guard_px": 64})
        milliseconds, counts, _ = measured(pipeline, settings)
        pinhole, drawn, _ = measured(pipeline, settings.with_(method="pinhole"))
        canvas = (SIZE[0] + 128) * (SIZE[1] + 128)
        subs, own = counts["pyramid sub-images"], milliseconds - pinhole
        written = (counts["fragments"] - drawn["fragments"]) / canvas / subs
        rows.append(f"| {wider:g} | {subs} | {counts['passes']} | {written:.2f} | {own:.0f} | {own / subs:.1f} |")
        print(rows[-1], flush=True)
    pipeline.release()
    return rows


def picture(gpu: Gpu) -> Image.Image:
    """Reference and methods, from left to right, for both cases."""
    rows = []
    for scene in CASES:
        pipeline, settings = Pipeline(gpu, load(f"demo:{scene}")), seen(scene, "gaussian", SMALL)
        shown = [settings.with_(method="accumulation").with_params(views=VIEWS)]
        shown += [settings.with_(method=name) for name in METHODS]
        rows.append(np.concatenate([to_srgb8(pipeline.render(s).pixels()) for s in shown], axis=1))
        pipeline.release()
    return Image.fromarray(np.concatenate(rows)).quantize(256, dither=Image.Dither.NONE)


def put(page: str, name: str, lines: list[str]) -> None:
    """Write `lines` between <!-- name --> and <!-- /name --> of a page."""
    path, begin, end = PAGES / page, f"<!-- {name} -->", f"<!-- /{name} -->"
    head, _, rest = path.read_text("utf-8").partition(begin)
    path.write_text(f"{head}{begin}\n" + "\n".join(lines) + f"\n{end}{rest.partition(end)[2]}", "utf-8")
    print(f"wrote: {path}")


if __name__ == "__main__":
    gpu = create_headless()
    head = [
        "| | Gaussian lens | uniform disc | as printed, Gaussian | as printed, disc | ms | passes, pictures written |",
        "|---|---|---|---|---|---|---|",
    ]
    note = f"{gpu.renderer}, {clock_of(gpu).name} time."
    compared = [row for scene in CASES for row in comparison(gpu, scene)]
    put("gaussian-methods.md", "table", [*head, *compared, "", f"*{note}*"])
    head = [
        "| lens | sub-images | passes | pictures written, each | ms without the pinhole picture | ms, each |",
        "|---|---|---|---|---|---|",
    ]
    put("pyramid.md", "cost", [*head, *growth(gpu), "", f"*{note}*"])
    picture(gpu).save(PICTURE, optimize=True)
    print(f"wrote: {PICTURE}")
    gpu.release()
