"""Runs a sweep, here or on Dask's workers, and keeps every result as it comes."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

from dofview.bench.measure import Bench
from dofview.bench.plan import Case, Sweep, cases
from dofview.bench.store import Store
from dofview.errors import InputError
from dofview.export import write_whole

OnCase = Callable[[Case, dict], None]
Group = list[tuple[Sweep, Case]]


def bench(sweeps: Sequence[Sweep], folder: Path, on_case: OnCase = lambda case, record: None) -> Store:
    """Measure the cases of `sweeps` that `folder` does not hold yet, and write its tables."""
    store = Store(folder)
    left = missing(sweeps, store)
    if left:
        measurer = Bench(folder)
        try:
            for sweep, case in left:
                record = measurer.run(case, sweep)
                store.add(case, record)
                on_case(case, record)
        finally:
            measurer.release()
    store.write_tables()
    return store


def bench_on_dask(
    sweeps: Sequence[Sweep], folder: Path, scheduler: str, on_case: OnCase = lambda case, record: None
) -> Store:  # fmt: skip
    """The same on the workers of the Dask scheduler at `scheduler`: cases that share a reference stay together, and
    what a lost worker had not sent is measured by another."""
    try:
        from distributed import Client, as_completed
    except ImportError as error:
        raise InputError("--scheduler needs the extra: pip install 'dofview[dask]'") from error
    store = Store(folder)
    left = missing(sweeps, store)
    try:
        client = Client(scheduler, timeout="20s")
    except (OSError, ValueError) as error:
        raise InputError(f"no Dask scheduler at {scheduler}: {error}") from error
    with client:
        futures = {client.submit(measure_group, group, pure=False): group for group in _groups(left)}
        for future in as_completed(list(futures)):
            for (_, case), (record, picture) in zip(futures[future], future.result(), strict=True):
                if picture:
                    _put(folder / record["picture"], picture)
                store.add(case, record)
                on_case(case, record)
    store.write_tables()
    return store


def measure_group(group: Group) -> list[tuple[dict, bytes]]:
    """Measure cases in this process, in a context of their own: each record, and the file of its picture if it has one,
    since another machine's folder is not ours."""
    with tempfile.TemporaryDirectory() as name:
        measurer = Bench(Path(name))
        try:
            records = [measurer.run(case, sweep) for sweep, case in group]
        finally:
            measurer.release()
        return [(r, (Path(name) / str(r["picture"])).read_bytes() if "picture" in r else b"") for r in records]


def _put(path: Path, content: bytes) -> None:
    path.parent.mkdir(exist_ok=True)
    write_whole(path, lambda part: part.write_bytes(content))


def missing(sweeps: Sequence[Sweep], store: Store) -> Group:
    """The cases that `store` does not hold, each with its sweep."""
    return [(sweep, case) for sweep, case in cases(sweeps) if not store.has(case)]


def _groups(left: Group) -> Iterator[Group]:
    together: dict[object, Group] = {}
    for sweep, case in left:
        together.setdefault(case.truth_key, []).append((sweep, case))
    yield from together.values()
