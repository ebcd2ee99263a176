"""Runs a sweep, here or on Dask's workers, and keeps every result as it comes."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

from dofview.bench.measure import Bench
from dofview.bench.plan import Case, Sweep
from dofview.bench.store import Store
from dofview.errors import InputError

OnCase = Callable[[Case, dict], None]


def bench(sweep: Sweep, folder: Path, on_case: OnCase = lambda case, record: None) -> Store:
    """Measure the cases of `sweep` that `folder` does not hold yet, and write its tables."""
    store = Store(folder)
    missing = [case for case in sweep.cases() if not store.has(case)]
    if missing:
        measurer = Bench(sweep, folder)
        try:
            for case in missing:
                record = measurer.run(case)
                store.add(case, record)
                on_case(case, record)
        finally:
            measurer.release()
    store.write_tables()
    return store


def bench_on_dask(
    sweep: Sweep, folder: Path, scheduler: str, on_case: OnCase = lambda case, record: None
) -> Store:  # fmt: skip
    """The same on the workers of the Dask scheduler at `scheduler`: cases that share a reference stay together, and
    what a lost worker had not sent is measured by another."""
    try:
        from distributed import Client, as_completed
    except ImportError as error:
        raise InputError("--scheduler needs the extra: pip install 'dofview[dask]'") from error
    store = Store(folder)
    missing = [case for case in sweep.cases() if not store.has(case)]
    try:
        client = Client(scheduler, timeout="20s")
    except OSError as error:
        raise InputError(f"no Dask scheduler at {scheduler}: {error}") from error
    with client:
        futures = {client.submit(measure_group, sweep, group, pure=False): group for group in _groups(missing)}
        for future in as_completed(list(futures)):
            for case, record in zip(futures[future], future.result(), strict=True):
                store.add(case, record)
                on_case(case, record)
    store.write_tables()
    return store


def measure_group(sweep: Sweep, cases: list[Case]) -> list[dict]:
    """Measure cases in this process, in a context of their own."""
    measurer = Bench(sweep)
    try:
        return [measurer.run(case) for case in cases]
    finally:
        measurer.release()


def _groups(cases: list[Case]) -> Iterator[list[Case]]:
    together: dict[object, list[Case]] = {}
    for case in cases:
        together.setdefault(case.truth_key, []).append(case)
    yield from together.values()
