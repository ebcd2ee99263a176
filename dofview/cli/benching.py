"""`dofview bench` and `dofview pick`: run time against error, and what to take for a budget."""

from __future__ import annotations

import dataclasses
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.progress import Progress

from dofview.bench.derived import DERIVED
from dofview.bench.fetches import SCENES, measure_fetches
from dofview.bench.pareto import pick, quality
from dofview.bench.plan import Case, Sweep, cases, full, quick
from dofview.bench.report import write_report
from dofview.bench.run import bench, bench_on_dask, missing
from dofview.bench.skips import SKIPS, measure_skips
from dofview.bench.store import Store
from dofview.cli.chosen import read_size
from dofview.errors import SettingsError
from dofview.framing import opening
from dofview.lens import Distribution
from dofview.methods import method
from dofview.scene.load import load

_WORDS = {Distribution.UNIFORM_DISC: "uniform disc", Distribution.GAUSSIAN: "Gaussian lens"}


def run_bench(
    out: Path, *, small: bool, scenes: str | None, methods: str | None, coc: str | None, sizes: str | None,
    frames: int | None, views: int | None, scheduler: str | None,
) -> None:  # fmt: skip
    """Measure a sweep into `out` and write its report there."""
    changes = _changes(scenes, methods, coc, sizes, frames, views)
    sweeps: Sequence[Sweep] = quick() if small else full()
    if changes:
        sweeps = [dataclasses.replace(quick()[0] if small else Sweep(), **changes)]
    total = len(list(cases(sweeps)))
    left = len(missing(sweeps, Store(out)))
    with Progress(console=Console(stderr=True)) as progress:
        task = progress.add_task("measuring", total=total, completed=total - left)

        def on_case(case: Case, record: dict) -> None:
            found = f"{case.scene} {case.method} CoC {case.coc_px:g}: {record['ms']:.1f} ms {quality(record):.1f} dB"
            progress.update(task, advance=1, description=found)

        store = bench(sweeps, out, on_case) if scheduler is None else bench_on_dask(sweeps, out, scheduler, on_case)
    write_report(store)
    print(f"{len(store.records)} cases in {out}: report.html, report.md, results.csv, results.json")


def run_skips(out: Path) -> None:
    """Measure what is left out of frames that do not need it into `out`."""
    total = sum(len(skip.scenes) for skip in SKIPS)
    with Progress(console=Console(stderr=True)) as progress:
        task = progress.add_task("measuring", total=total)
        measure_skips(out, lambda record: progress.update(task, advance=1, description=record["what"]))
    print(f"{total} measurements in {out}: skips.md, skips.json")


def run_fetches(out: Path) -> None:
    """Count what every method fetches into `out`."""
    with Progress(console=Console(stderr=True)) as progress:
        task = progress.add_task("counting", total=len(SCENES) * len(DERIVED))
        measure_fetches(
            out, lambda found: progress.update(task, advance=1, description=f"{found.scene} {found.method}")
        )
    print(f"{len(SCENES) * len(DERIVED)} frames counted in {out}: fetches.md")


def run_pick(
    scene: str, budget: str | None, min_psnr: float | None, coc_px: float, size: str, out: Path | None
) -> None:
    """Measure the methods on a scene, through the lens that it opens with, and name the one to take."""
    budget_ms = None if budget is None else _milliseconds(budget)
    if budget_ms is None and min_psnr is None:
        raise SettingsError("pick needs --budget 8ms, --min-psnr 38, or both")
    own = opening(load(scene), scene).lens.distribution
    lens = own if own is Distribution.GAUSSIAN else Distribution.UNIFORM_DISC
    sweep = dataclasses.replace(
        quick()[0], scenes=(scene,), coc_px=(coc_px,), sizes=(read_size(size),), every_quality=True, views=256,
        distributions=(lens.value,),
    )  # fmt: skip
    keys = {case.key for case in sweep.cases()}
    with tempfile.TemporaryDirectory() as folder, Progress(console=Console(stderr=True), transient=True) as progress:
        task = progress.add_task("measuring", total=len(keys))
        store = bench([sweep], out or Path(folder), lambda case, record: progress.advance(task))
    # The folder may hold other results.
    chosen = pick([r for r in store.records if r["key"] in keys], budget_ms=budget_ms, min_psnr=min_psnr)
    given = {"method": chosen["method"], "radius": f"{chosen['lens_radius']:.6g}", **chosen["parameters"]}
    flags = " ".join(f"--{name.replace('_', '-')} {value}" for name, value in given.items())
    print(f"{chosen['ms']:.1f} ms, {quality(chosen):.1f} dB against the reference ({_WORDS[lens]})")
    print(f"dofview {scene} {flags}")


def _changes(
    scenes: str | None, methods: str | None, coc: str | None, sizes: str | None, frames: int | None, views: int | None
) -> dict[str, Any]:
    """Fields of a sweep, as they were given."""
    changes: dict[str, Any] = {}
    if scenes:
        changes["scenes"] = tuple(scenes.split(","))
    if methods:
        changes["methods"] = tuple(methods.split(","))
        for name in methods.split(","):
            method(name)
    if coc:
        changes["coc_px"] = tuple(_number(text, "coc") for text in coc.split(","))
    if sizes:
        changes["sizes"] = tuple(read_size(text) for text in sizes.split(","))
    if frames is not None:
        changes["frames"] = _at_least_one(frames, "frames")
    if views is not None:
        changes["views"] = _at_least_one(views, "views")
    return changes


def _number(text: str, name: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = float("nan")
    if not 0.0 <= value <= 500.0:
        raise SettingsError(f"{name} is {text[:40]!r}; accepted: numbers from 0 to 500 with commas between")
    return value


def _at_least_one(value: int, name: str) -> int:
    if not 1 <= value <= 65536:
        raise SettingsError(f"{name} is {value}; accepted: a whole number from 1 to 65536")
    return value


def _milliseconds(text: str) -> float:
    number = _number_of(text.removesuffix("ms"))
    if number is None:
        raise SettingsError(f"budget is {text[:40]!r}; accepted: milliseconds, as 8ms")
    return number


def _number_of(text: str) -> float | None:
    try:
        value = float(text)
    except ValueError:
        return None
    return value if 0.0 < value < 1e9 else None
