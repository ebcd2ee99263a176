"""The stress tool itself: it finds what is wrong, repeats it from its seed, and the cheap rows hold."""

from __future__ import annotations

import sys
from itertools import islice

import numpy as np
import pytest

from dofview.errors import SettingsError
from dofview.gl.context import Gpu
from dofview.methods import METHODS
from dofview.stress import long, shapes
from dofview.stress.bench import Bench
from dofview.stress.row import Measured, Row, Skipped, bounds
from dofview.stress.run import ROWS, cases, chosen_rows, stress

CHEAP = (1, 2, 4, 5, 13, 19, 20, 24)


def test_every_bound_has_a_value(gpu: Gpu):
    """A row measures as many values as it has bounds for; the reference stands for all methods."""
    rows = tuple(row for row in ROWS if not row.rarely)
    report = stress(gpu, rows=rows, methods=("accumulation",), size=48, views=16)
    assert report.cases == sum("accumulation" in row.bounds for row in rows)


def test_what_cannot_be_tried_here_is_said(gpu: Gpu):
    def lacking(bench: Bench, method: str, random: np.random.Generator) -> list[Measured]:
        raise Skipped("no such thing here")

    report = stress(gpu, rows=(Row(97, "lacking", bounds(1.0), lacking),), methods=("mipmap",), size=16)
    assert report.skipped == {97: "no such thing here"} and not report.cases and not report.failures


def test_rows_that_take_long_get_every_fourth_seed():
    slow = Row(96, "slow", bounds(1.0), lambda bench, method, random: [], rarely=True)
    seeds = [seed for _, _, seed in islice(cases((slow,), ("mipmap",), 3), 3)]
    assert seeds == [3, 7, 11]


def test_however_little_time_there_is_every_row_can_be_asked_for_once(gpu: Gpu):
    row = Row(95, "quick", bounds(1.0), lambda bench, method, random: [Measured("nothing", 0.0)])
    tried = [stress(gpu, rows=(row,), size=16, minutes=1e-9, at_least=count).cases for count in (0, 1, 2)]
    assert tried == [0, len(row.methods()), 2 * len(row.methods())]


def test_a_broken_bound_is_reported_with_the_command_that_repeats_it(gpu: Gpu):
    seen: list[float] = []

    def wrong(bench: Bench, method: str, random: np.random.Generator) -> list[Measured]:
        seen.append(float(random.random()))
        return [Measured("an error", seen[-1] + 1.0)]

    row = Row(99, "broken", bounds(1.0), wrong)
    report = stress(gpu, rows=(row,), methods=("accumulation",), seed=7, size=16, views=4, rounds=2)
    assert report.cases == 2 and len(report.failures) == 2 and seen[0] != seen[1]
    assert report.failures[0].command() == "dofview stress --row 99 --method accumulation --seed 7 --size 16 --views 4"
    again = stress(gpu, rows=(row,), methods=("accumulation",), seed=7, size=16, views=4)
    assert again.failures[0].value == report.failures[0].value


def test_a_value_that_is_not_a_number_is_a_failure(gpu: Gpu):
    row = Row(98, "nan", bounds(1.0), lambda bench, method, random: [Measured("nothing", float("nan"))])
    assert stress(gpu, rows=(row,), methods=("pinhole", "accumulation"), size=16).failures


def test_the_furnace_row_sees_a_scene_that_is_not_of_one_colour(gpu: Gpu, monkeypatch):
    monkeypatch.setattr(shapes, "unlit", lambda rgb, name="": shapes.textured(np.random.default_rng(0)))
    assert stress(gpu, rows=chosen_rows(1), methods=("accumulation",), size=32, views=8).failures


@pytest.mark.parametrize("number", CHEAP)
def test_the_cheap_rows_hold_for_every_method(gpu: Gpu, number: int):
    report = stress(gpu, rows=chosen_rows(number), methods=METHODS, size=64, views=64)
    assert not report.failures, "\n".join(map(str, report.failures))


def test_the_last_layer_of_multiview_stops_all_light(gpu: Gpu):
    """What it held of the layer in front hid the wall behind, and this was 33/255 too dark."""
    report = stress(gpu, rows=chosen_rows(20), methods=("multiview",), seed=2, size=128, views=16)
    assert report.cases == 1 and not report.failures, "\n".join(map(str, report.failures))


def test_an_unknown_row_is_refused():
    with pytest.raises(SettingsError, match="no row 99; accepted: 1, 2"):
        chosen_rows(99)


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="counted through /proc")
@pytest.mark.parametrize("name", [name for name in long.NAMES if name != "resize"])
def test_nothing_is_left_over_after_a_few_cycles(gpu: Gpu, monkeypatch, name: str):
    """Five hundred cycles and memory are for `dofview stress --long`; a hundred resizes are in test_methods."""
    monkeypatch.setattr(long, "WARM_UP", 8)
    with long.opened(gpu) as run:
        found = long.repeat(run, name, 12)
    assert (found.objects, found.files, found.threads, found.children) == (0, 0, 0, 0)


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="counted through /proc")
def test_what_is_left_over_is_seen(gpu: Gpu, monkeypatch):
    monkeypatch.setattr(long, "WARM_UP", 1)
    kept = []
    with long.opened(gpu) as run:
        monkeypatch.setattr(run, "switch", lambda: kept.append(gpu.ctx.buffer(reserve=16)))
        assert long.repeat(run, "switch", 5).objects >= 5
    for buffer in kept:
        buffer.release()
