"""What an invariant is: a number, a sentence, what is measured and the bound for each method."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from dofview.stress.bench import Bench

COLUMNS = ("accumulation", "splatting", "multiview", "layered", "pyramid", "mipmap")
"""The order in which a row gives its bounds: the reference, then the methods."""


class Skipped(Exception):
    """A row cannot be tried on this machine; the message says what is missing."""


class Measured(NamedTuple):
    """One measured value; `at_least` says on which side of the bound it must lie."""

    what: str
    value: float
    at_least: bool = False


@dataclass(frozen=True)
class Row:
    """An invariant. `check(bench, method, random)` measures as many values as the row has bounds for the method.

    One that is tried `rarely`, because it takes many times as long as others, comes last and gets every fourth seed.
    """

    number: int
    name: str
    bounds: Mapping[str, Sequence[float]]
    check: Callable[[Bench, str, np.random.Generator], list[Measured]]
    rarely: bool = False

    def methods(self) -> tuple[str, ...]:
        """The methods it says something about."""
        return tuple(name for name in COLUMNS if name in self.bounds)


def bounds(*columns: Sequence[float] | float | None) -> dict[str, tuple[float, ...]]:
    """Bounds in the order of `COLUMNS`, one entry per measured value; None leaves a method out, a single column is for
    all of them."""
    if len(columns) == 1:
        columns = columns * len(COLUMNS)
    found = {}
    for name, column in zip(COLUMNS, columns, strict=True):
        if column is not None:
            found[name] = tuple(column) if isinstance(column, Sequence) else (float(column),)
    return found


@dataclass(frozen=True)
class Failure:
    """A bound that was not held, with the command that shows it again."""

    row: int
    method: str
    seed: int
    size: int
    views: int
    what: str
    value: float
    bound: float

    def command(self) -> str:
        """A command line that repeats this case alone."""
        return (
            f"dofview stress --row {self.row} --method {self.method} --seed {self.seed} --size {self.size} "
            f"--views {self.views}"
        )

    def __str__(self) -> str:
        what = f"row {self.row} {self.method}: {self.what} is {self.value:.4g}, bound {self.bound:.4g}"
        return f"{what}\n    {self.command()}"


def failures(row: Row, method: str, seed: int, size: int, views: int, measured: Sequence[Measured]) -> list[Failure]:
    """The values beyond their bounds; a value that is not a number is beyond every bound."""
    found = []
    for value, bound in zip(measured, row.bounds[method], strict=True):
        held = value.value >= bound if value.at_least else value.value <= bound
        if not held:
            found.append(Failure(row.number, method, seed, size, views, value.what, value.value, bound))
    return found
