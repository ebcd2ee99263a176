"""Runs rows over methods and seeds until time or cases are used up, and says what was not held."""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

import numpy as np

from dofview.errors import SettingsError
from dofview.gl.context import Gpu
from dofview.methods import METHODS
from dofview.stress import blur, corners, drivers, light, motion, pathtraced, symmetry
from dofview.stress.bench import Bench
from dofview.stress.row import Failure, Measured, Row, Skipped, failures

RARELY = 4

ROWS: tuple[Row, ...] = tuple(
    sorted(
        (*light.ROWS, *blur.ROWS, *symmetry.ROWS, *motion.ROWS, *pathtraced.ROWS, *drivers.ROWS, *corners.ROWS),
        key=lambda row: (row.rarely, row.number),
    )
)


@dataclass
class Report:
    """What was run: cases, failures, the value nearest to its bound for each row and method, and what could not be."""

    cases: int = 0
    failures: list[Failure] = field(default_factory=list)
    worst: dict[tuple[int, str, str], tuple[float, float]] = field(default_factory=dict)
    skipped: dict[int, str] = field(default_factory=dict)

    def add(self, row: Row, method: str, seed: int, bench: Bench, measured: list[Measured]) -> list[Failure]:
        """Take in one case and return what it failed."""
        self.cases += 1
        for value, bound in zip(measured, row.bounds[method], strict=True):
            key = (row.number, method, value.what)
            before = self.worst.get(key)
            if before is None or (value.value < before[0] if value.at_least else value.value > before[0]):
                self.worst[key] = (value.value, bound)
        found = failures(row, method, seed, bench.size, bench.views, measured)
        self.failures += found
        return found


def chosen_rows(number: int | None) -> tuple[Row, ...]:
    """The row called `number`, or all."""
    rows = tuple(row for row in ROWS if number in (None, row.number))
    if not rows:
        raise SettingsError(f"no row {number}; accepted: {', '.join(str(row.number) for row in ROWS)}")
    return rows


def cases(rows: tuple[Row, ...], methods: tuple[str, ...], seed: int) -> Iterator[tuple[Row, str, int]]:
    """Every row and method with `seed`, then with the next seed, for ever."""
    for number in itertools.count(seed):
        for row in rows:
            if row.rarely and (number - seed) % RARELY:
                continue
            for method in row.methods():
                if method in methods:
                    yield row, method, number


def stress(
    gpu: Gpu, *, rows: tuple[Row, ...] = ROWS, methods: tuple[str, ...] = METHODS, seed: int = 1, size: int = 128,
    views: int = 256, minutes: float | None = None, rounds: int = 1, at_least: int = 0,
    on_case: Callable[[Row, str, int, list[Failure]], None] = lambda row, method, seed, found: None,
) -> Report:  # fmt: skip
    """Run cases for `minutes`, on a slow machine longer: until every row and method had `at_least` so many seeds. When
    no time is given, run `rounds` seeds."""
    bench = Bench(gpu, size, views)
    report = Report()
    deadline = None if minutes is None else time.monotonic() + 60.0 * minutes
    try:
        for row, method, number in cases(rows, methods, seed):
            if deadline is None:
                over = number >= seed + rounds
            else:
                over = number >= seed + at_least and time.monotonic() >= deadline
            if over:
                return report
            try:
                measured = row.check(bench, method, np.random.default_rng([row.number, number]))
            except Skipped as reason:
                report.skipped[row.number] = str(reason)
                continue
            if gpu.ctx.error != "GL_NO_ERROR":
                report.failures.append(Failure(row.number, method, number, size, views, "OpenGL errors", 1.0, 0.0))
            on_case(row, method, number, report.add(row, method, number, bench, measured))
    finally:
        bench.release()
    return report
