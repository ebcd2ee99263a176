"""The benchmark: a sweep that can be broken off, figures that are what they say, the Pareto front."""

from __future__ import annotations

import csv
import json
import math
from dataclasses import replace

import numpy as np
import pytest

from dofview.bench.measure import Bench
from dofview.bench.pareto import front, pick
from dofview.bench.plan import Case, Sweep, cases, full, qualities, quick
from dofview.bench.run import bench
from dofview.bench.store import Store
from dofview.errors import InputError
from dofview.methods import METHODS
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
        assert len(settings) >= 3
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
    from dofview.bench.papers import CLAIMS
    from dofview.bench.report import write_report

    store = bench([TINY], tmp_path)
    write_report(store)
    markdown = (tmp_path / "report.md").read_text()
    assert all(f"{record['psnr']:.2f}" in markdown for record in store.records)
    assert all(claim.what in markdown for claim in CLAIMS)
    page = (tmp_path / "report.html").read_text()
    assert page.count("<svg") >= 4 and "http://" not in page.replace("http://www.w3.org", "").replace(
        "http://purl.org", ""
    ).replace("http://creativecommons.org", "")
