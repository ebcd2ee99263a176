"""`dofview compare`: every method beside the reference, as pictures in a folder and one table."""

from __future__ import annotations

import json as jsonlib
import math
import statistics
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from dofview import export, metrics
from dofview.cli.chosen import applied, settings_for
from dofview.cli.flags import Given
from dofview.cli.picture import headless, tell_warnings, timed
from dofview.cli.runs import Comparing
from dofview.errors import OutputError
from dofview.methods import METHODS
from dofview.methods import method as method_named
from dofview.pipeline import Pipeline
from dofview.scene.load import DEMO, load
from dofview.settings import Settings, checked

if TYPE_CHECKING:
    from rich.table import Table

REFERENCE = "accumulation"


@dataclass(frozen=True)
class Row:
    """One method beside the reference: dB, 0…1, milliseconds of a finished frame, and its picture."""

    method: str
    psnr: float | None
    ssim: float | None
    ms: float
    picture: str


def compare_into(
    spec: str, out: Path, given: Given, *, view: Path | None, camera: str | None, methods: str | None, json: bool
) -> None:
    """Render the reference and `methods` (names with commas between; None: all) into the folder `out`, and print."""
    comparing = checked(Comparing, given.get("comparing", {}), "compare")
    names = _names(methods)
    applied(Settings(), given, view=view)
    _make_folder(out)
    scene = load(spec)
    settings = settings_for(scene, spec, given, view=view, camera=camera)
    tell_warnings(scene)
    stem = spec[len(DEMO) :].replace("@", "-") if spec.startswith(DEMO) else Path(spec).stem
    with headless(scene) as pipeline:
        rows = _rows(pipeline, settings, names, comparing, out / stem)
        renderer = pipeline.gpu.renderer
    if json:
        print(jsonlib.dumps({"scene": spec, "renderer": renderer, "clock": "wall", "rows": [asdict(r) for r in rows]}))
        return
    from rich.console import Console

    size = "x".join(map(str, settings.image.size))
    console = Console()
    console.print(_table(rows))
    print(f"{spec} at {size}, reference of {comparing.views} views, {renderer}; pictures in {out}/")


def _rows(
    pipeline: Pipeline, settings: Settings, names: Sequence[str], comparing: Comparing, stem: Path
) -> list[Row]:  # fmt: skip
    from rich.console import Console
    from rich.progress import Progress

    rows: list[Row] = []
    truth: np.ndarray | None = None
    with Progress(console=Console(stderr=True), transient=True) as progress:
        for name in progress.track([REFERENCE, *names], description="rendering"):
            if pipeline.gpu.version_code < method_named(name).REQUIRES_GL:
                continue
            shown = settings.with_(method=name)
            if name == REFERENCE:
                shown = shown.with_params(views=comparing.views)
            # The reference takes too long to be rendered twice, and compiling is a small part of it.
            frames = comparing.frames if name == REFERENCE else comparing.frames or 1
            result, milliseconds = timed(pipeline, shown, frames)
            pixels = result.pixels()
            picture = stem.with_name(f"{stem.name}-{name}.png")
            export.save(picture, pixels)
            psnr = None if truth is None else _finite(metrics.psnr(pixels, truth))
            ssim = None if truth is None else round(metrics.ssim(pixels, truth), 4)
            truth = pixels if truth is None else truth
            rows.append(Row(name, psnr, ssim, round(statistics.median(milliseconds), 1), str(picture)))
    return rows


def _finite(decibels: float) -> float | None:
    return round(decibels, 2) if math.isfinite(decibels) else None


def _names(methods: str | None) -> list[str]:
    names = list(METHODS) if methods is None else [name.strip() for name in methods.split(",")]
    for name in names:
        method_named(name)
    return [name for name in dict.fromkeys(names) if name != REFERENCE]


def _make_folder(out: Path) -> None:
    try:
        out.mkdir(parents=True, exist_ok=True)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise OutputError(f"cannot make the folder {str(out)!r}: {reason.lower()}") from error
    export.check_writable(out / "picture.png")


def _table(rows: Sequence[Row]) -> Table:
    from rich.table import Table

    table = Table(box=None, pad_edge=False)
    for column in ("method", "PSNR dB", "SSIM", "ms"):
        table.add_column(column, justify="left" if column == "method" else "right", no_wrap=True)
    for row in rows:
        psnr = "reference" if row.ssim is None else "equal" if row.psnr is None else f"{row.psnr:.2f}"
        ssim = "" if row.ssim is None else f"{row.ssim:.4f}"
        table.add_row(row.method, psnr, ssim, f"{row.ms:.1f}")
    return table
