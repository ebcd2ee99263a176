"""`dofview stress`: random and cornered settings against the invariants, a table of the nearest misses."""

from __future__ import annotations

import sys

from rich.console import Console
from rich.table import Table

from dofview.errors import SettingsError
from dofview.gl.context import create_headless
from dofview.methods import METHODS
from dofview.methods import method as method_named
from dofview.stress import long
from dofview.stress.row import Failure, Row
from dofview.stress.run import Report, chosen_rows, stress


def run_stress(
    minutes: float | None, row: int | None, method: str | None, seed: int, size: int, views: int, rounds: int
) -> int:
    """Run the stress cases and return the exit status: 1 when a bound was not held."""
    if not 8 <= size <= 2048:
        raise SettingsError(f"size is {size}; accepted: a whole number from 8 to 2048")
    if minutes is not None and not 0 < minutes < 1e5:
        raise SettingsError(f"minutes is {minutes:g}; accepted: a number above 0")
    rows = chosen_rows(row)
    if method is not None:
        method_named(method)
    methods = METHODS if method is None else (method,)
    print(f"seeds from {seed}, pictures of {size}x{size}, reference of {views} views", flush=True)
    gpu = create_headless()
    try:
        report = stress(
            gpu, rows=rows, methods=methods, seed=seed, size=size, views=views, minutes=minutes, rounds=rounds,
            on_case=_tell,
        )  # fmt: skip
    finally:
        gpu.release()
        gpu.ctx.release()
    _table(report, rows)
    for number, reason in report.skipped.items():
        print(f"row {number} left out: {reason}")
    print(f"{report.cases} cases, {len(report.failures)} failures")
    return 1 if report.failures else 0


def run_long(cycles: int, what: str | None, seed: int) -> int:
    """Repeat everything, or `what` alone, `cycles` times; exit status 1 when something is left over."""
    if not 1 <= cycles <= 1_000_000:
        raise SettingsError(f"cycles is {cycles}; accepted: a whole number from 1 to 1000000")
    if what is not None and what not in long.NAMES:
        raise SettingsError(f"nothing called {what[:40]!r}; accepted: {', '.join(long.NAMES)}")
    table = Table("what", "cycles", "GL objects", "kB a cycle", "files", "threads", "children", "")
    failed = 0
    gpu = create_headless()
    try:
        with long.opened(gpu, seed) as run:
            for name in long.NAMES if what is None else (what,):
                found = long.repeat(run, name, cycles)
                print(found, file=sys.stderr, flush=True)
                failed += not found.held
                table.add_row(name, str(cycles), f"{found.objects:+d}", f"{found.kb_per_cycle:.2f}",
                              f"{found.files:+d}", f"{found.threads:+d}", str(found.children),
                              "" if found.held else "left over")  # fmt: skip
    finally:
        gpu.release()
        gpu.ctx.release()
    Console().print(table)
    return 1 if failed else 0


def _tell(row: Row, method: str, seed: int, found: list[Failure]) -> None:
    for failure in found:
        print(failure, file=sys.stderr, flush=True)


def _table(report: Report, rows: tuple[Row, ...]) -> None:
    table = Table("row", "invariant", "method", "measured", "worst", "bound")
    names = {row.number: row.name for row in rows}
    for (number, method, what), (value, bound) in sorted(report.worst.items()):
        table.add_row(str(number), names[number], method, what, f"{value:.4g}", f"{bound:g}")
    Console().print(table)
