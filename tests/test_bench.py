"""The benchmark: a sweep that can be broken off, figures that are what they say, the Pareto front."""

from __future__ import annotations

import csv
import dataclasses
import json
import math
import os
import re
import signal
from dataclasses import replace

import numpy as np
import pytest

from dofview.bench.measure import Bench
from dofview.bench.papers import CLAIMS, Claim, verdict
from dofview.bench.pareto import front, pick
from dofview.bench.plan import Case, Sweep, cases, full, qualities, quick
from dofview.bench.report import write_report
from dofview.bench.run import bench, bench_on_dask
from dofview.bench.skips import SKIPS
from dofview.bench.store import Store
from dofview.bench.tables import equal
from dofview.errors import InputError
from dofview.framing import opening
from dofview.methods import METHODS, method
from dofview.pipeline import Pipeline
from dofview.scene.load import load
from dofview.settings import Settings

TINY = Sweep(
    scenes=("demo:crossing",), methods=("mipmap",), coc_px=(4.0, 8.0), sizes=((64, 48),), frames=1, views=16,
    every_quality=False,
)  # fmt: skip


def test_a_sweep_is_measured_once_and_taken_up_again(tmp_path):
    seen: list[Case] = []
    store = bench([TINY], tmp_path, lambda case, record: seen.append(case))
    assert len(seen) == len(list(TINY.cases())) == 4
    text = (tmp_path / "results.jsonl").read_text()
    (tmp_path / "results.jsonl").write_text("".join(text.splitlines(keepends=True)[:3])[:-20])
    again: list[Case] = []
    store = bench([TINY], tmp_path, lambda case, record: again.append(case))
    assert len(again) == 2, "the cut line and the missing one are measured again"
    assert len(store.records) == len(Store(tmp_path).records) == 4
    rows = list(csv.DictReader((tmp_path / "results.csv").open()))
    assert [float(row["coc_px"]) for row in rows] == [
        r["coc_px"] for r in json.loads((tmp_path / "results.json").read_text())
    ]


def test_the_lens_gives_the_mean_coc_that_was_asked_for():
    measurer = Bench()
    case = next(iter(TINY.cases()))
    settings = measurer.settings(case)
    frame = measurer.pipeline(case.scene).frame(settings, guard=False)
    coc = np.abs(frame.coc.radius_px(frame.pinhole().inverse_depth.pixels()))
    record = measurer.run(case, TINY)
    measurer.release()
    assert 2.0 * coc.mean() == pytest.approx(case.coc_px, rel=1e-4)
    assert record["ms"] > 0 and record["reference_views"] == 16 and record["triangles"] > 1000
    assert record["passes_ms"] and record["counts"]["passes"] > 0


def test_what_was_left_out_is_counted():
    """Counters that cost time are of a frame that is not in the times."""
    sweep = replace(TINY, methods=("splatting",))
    measurer = Bench()
    record = measurer.run(next(iter(sweep.cases())), sweep)
    measurer.release()
    assert record["counts"]["splatting tiles"] > record["counts"].get("splatting tiles copied", 0)


def test_every_method_is_in_the_quick_sweep():
    named = {case.method for _, case in cases(quick())}
    assert named == set(METHODS) - {"pinhole"}


def test_the_full_sweep_measures_each_case_once_and_every_quality():
    found = [case for _, case in cases(full())]
    assert len(found) == len({case.key for case in found})
    for name in set(METHODS) - {"pinhole"}:
        settings = qualities(name, every=True)
        assert len(settings) >= 3 or not hasattr(method(name), "QUALITIES")
        assert name == "accumulation" or {} in settings, "the defaults are one of them"
        checked = [Settings(method=name).with_params(**parameters) for parameters in settings]
        assert len(set(map(str, checked))) == len(settings)
        assert {tuple(sorted(p.items())) for p in settings} == {c.parameters for c in found if c.method == name}


def test_damage_in_the_middle_of_results_is_named(tmp_path):
    (tmp_path / "results.jsonl").write_text('{"key": "a"}\nnonsense\n{"key": "b"}\n')
    with pytest.raises(InputError, match=r"results\.jsonl:2: not a result"):
        Store(tmp_path)


POINTS = [
    {"method": "a", "ms": 1.0, "psnr": 30.0}, {"method": "b", "ms": 2.0, "psnr": 29.0},
    {"method": "c", "ms": 3.0, "psnr": 40.0}, {"method": "d", "ms": 9.0, "psnr": None},
]  # fmt: skip


def test_the_front_holds_what_nothing_beats():
    assert [r["method"] for r in front(POINTS)] == ["a", "c", "d"]


@pytest.mark.parametrize(
    ("limits", "chosen"),
    [({"budget_ms": 8.0}, "c"), ({"budget_ms": 1.0}, "a"), ({"min_psnr": 35.0}, "c"), ({"min_psnr": 50.0}, "d"),
     ({"budget_ms": 4.0, "min_psnr": 20.0}, "a"), ({"budget_ms": math.inf}, "d")],
)  # fmt: skip
def test_pick_takes_the_best_that_fits(limits, chosen):
    assert pick(POINTS, **limits)["method"] == chosen


def test_pick_says_how_near_it_comes():
    with pytest.raises(InputError, match="nothing within 0.5 ms; the fastest is a with 1 ms"):
        pick(POINTS, budget_ms=0.5)
    with pytest.raises(InputError, match="nothing of 60 dB; the best is c with 40.0 dB"):
        pick(POINTS, budget_ms=5.0, min_psnr=60.0)


def test_the_report_holds_every_case_and_every_claim(tmp_path):
    store = bench([TINY], tmp_path)
    write_report(store)
    markdown = (tmp_path / "report.md").read_text()
    assert all(f"{record['psnr']:.1f}" in markdown for record in store.records)
    assert all(claim.what in markdown for claim in CLAIMS)
    shown = re.findall(r"\]\(((?:plots|sheets)/[^)]+)\)", markdown)
    assert len(shown) >= 4 and all((tmp_path / name).stat().st_size > 1000 for name in shown)
    page = (tmp_path / "report.html").read_text()
    assert page.count("<img src='data:") == len(shown) and "http://" not in page and "https://" not in page


def record(method: str, psnr: float, ms: float, **parameters: object) -> dict:
    return {"scene": "s", "distribution": "gaussian", "coc_px": 8.0, "size": [4, 3], "method": method,
            "parameters": parameters, "psnr": psnr, "ms": ms}  # fmt: skip


def test_equal_quality_is_read_off_the_curve_of_the_reference():
    """30, 36 and 44 dB for 4, 16 and 64 views of 10 ms: 33 dB are half way up from 4 to 16."""
    curve = [record("accumulation", db, 10.0 * n, views=n) for db, n in ((30.0, 4), (36.0, 16), (44.0, 64))]
    for db, views in ((33.0, 8.0), (30.0, 4.0), (40.0, 32.0), (48.0, 128.0), (24.0, 1.0)):
        found = equal(record("mipmap", db, 1.0), curve)
        assert found.views == pytest.approx(views) and found.ms == pytest.approx(10.0 * views)
    assert equal(record("mipmap", 33.0, 1.0), curve[:1]) is None


@pytest.mark.parametrize(
    ("judged", "measured", "word"),
    [("least", 12.0, "better"), ("least", 10.1, "reproduced"), ("least", 9.8, "reproduced"), ("least", 9.0, "not"),
     ("most", 9.0, "better"), ("most", 10.2, "reproduced"), ("most", 11.0, "not"), ("order", 0.1, "reproduced"),
     ("order", -0.1, "not"), ("least", None, "not measured")],
)  # fmt: skip
def test_a_claim_is_judged_by_its_kind(judged, measured, word):
    claim = Claim("A 2000", "a", 10.0, "dB", lambda records: measured, "how", "why", judged)
    found = verdict(claim, measured)
    assert found.word == word and ("why" in found.reason) == (word == "not")


def test_what_is_left_out_is_counted_and_can_be_done_after_all(gpu):
    """Every rule by a name that its method knows: without the name it is done, and the picture is the same."""
    pipeline = Pipeline(gpu, load("demo:crossing"))
    base = opening(pipeline.scene.scene, "demo:crossing")
    base = base.with_(image=base.image.model_copy(update={"size": (64, 48)}))
    try:
        for skip in SKIPS:
            if skip.counter in ("kept images", "converged", "pieces culled"):
                continue
            settings = base.with_(method=skip.method).with_params(**skip.parameters)
            settings = skip.see(pipeline, settings)
            pictures, counts = [], []
            for done_anyway in (frozenset(), frozenset({skip.counter})):
                gpu.profile.done_anyway, gpu.profile.timing = done_anyway, True
                pipeline.forget()
                result = pipeline.render(settings)
                pictures.append(result.pixels())
                counts.append(result.counts.get(skip.counter, 0))
                gpu.profile.resolve()
            assert counts[1] <= counts[0], skip.counter
            # The filters of empty layers are summed into one: equal up to how filters below a pixel are sampled.
            bound = 0.05 if skip.counter == "layered layers empty" else 1e-5
            assert np.abs(pictures[0] - pictures[1]).max() <= bound
    finally:
        gpu.profile.done_anyway, gpu.profile.timing = frozenset(), False
        pipeline.release()


def test_a_lost_worker_loses_no_finished_result(tmp_path):
    """One of two workers is killed after the first result: all cases arrive, each once, the first as it was."""
    distributed = pytest.importorskip("distributed")
    sweep = dataclasses.replace(TINY, coc_px=(2.0, 4.0, 6.0, 8.0), frames=1, views=8)
    first: list[str] = []

    def on_case(case: Case, record: dict) -> None:
        if not first:
            first.extend((tmp_path / "results.jsonl").read_text().splitlines())
            os.kill(next(iter(cluster.workers.values())).pid, signal.SIGKILL)

    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        store = bench_on_dask([sweep], tmp_path, cluster.scheduler_address, on_case)
    lines = (tmp_path / "results.jsonl").read_text().splitlines()
    keys = [json.loads(line)["key"] for line in lines]
    assert sorted(keys) == sorted(case.key for case in sweep.cases()) == sorted(r["key"] for r in store.records)
    assert lines[: len(first)] == first and len(first) == 1
    # Pictures come from the workers, too.
    shown = [r["picture"] for r in store.records if "picture" in r]
    assert shown and all((tmp_path / name).stat().st_size > 500 for name in shown), (
        "pictures come from the workers, too"
    )
