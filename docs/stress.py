"""Measure what docs/stress.md shows and write it there: python docs/stress.py [MINUTES] [--long].

The rows take as many minutes as are given, 5 by default, and each is tried once at least; `--long` measures the long
runs anew as well, some 10 minutes.
"""

from __future__ import annotations

import re
import sys
import time
from pathlib import Path

import numpy as np

from dofview.gl.context import create_headless
from dofview.stress import long
from dofview.stress.motion import picture_errors
from dofview.stress.report import convergence_table, long_table, rows_table
from dofview.stress.row import Failure, Row
from dofview.stress.run import ROWS, stress

PAGE = Path(__file__).parent / "stress.md"
SCENES = 4


def put(name: str, text: str) -> None:
    """Replace what stands between the marks of `name`."""
    page = PAGE.read_text(encoding="utf-8")
    page, count = re.subn(
        rf"(<!-- {name} -->\n).*?(<!-- /{name} -->)", lambda found: f"{found[1]}{text}\n{found[2]}", page, flags=re.S
    )
    assert count == 1, f"{PAGE} has no marks of {name}"
    PAGE.write_text(page, encoding="utf-8")


def tell(row: Row, method: str, seed: int, found: list[Failure]) -> None:
    """Say what was tried and what it failed."""
    print(row.number, method, seed, *found, flush=True)


def main(minutes: float, with_long: bool) -> int:
    gpu = create_headless()
    start = time.monotonic()
    report = stress(gpu, minutes=minutes, at_least=1, on_case=tell)
    spent = (time.monotonic() - start) / 60.0
    head = f"{report.cases} cases in {spent:.0f} minutes on {gpu.renderer}: {len(report.failures)} beyond their bounds."
    put("rows", "\n".join([head, *(f"* {failure}" for failure in report.failures), "", rows_table(report, ROWS)]))
    errors = [picture_errors(gpu, np.random.default_rng(seed)) for seed in range(SCENES)]
    put("convergence", convergence_table(errors))
    if with_long:
        with long.opened(gpu) as run:
            put("long", long_table([long.repeat(run, name, 500) for name in long.NAMES]))
    return len(report.failures)


if __name__ == "__main__":
    given = [float(word) for word in sys.argv[1:] if not word.startswith("-")]
    sys.exit(min(main(given[0] if given else 5.0, "--long" in sys.argv), 1))
