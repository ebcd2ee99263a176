"""Milliseconds and counts of what a frame did.

A software rasteriser runs nothing until it is asked to finish, and its timer queries report almost nothing (8 ms for
150 ms of work), so there the wall is timed around `finish`; a GPU is asked through timer queries. `clock` says which.
"""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager

import moderngl

SOFTWARE_RENDERERS = ("llvmpipe", "softpipe", "swrast", "SwiftShader", "Software")


class Profile:
    """Counts always, times when `timing` is on. Sections are flat: timer queries must not nest."""

    def __init__(self, ctx: moderngl.Context, software: bool):
        self._ctx = ctx
        self.clock = "wall" if software else "gpu"
        self.now = time.perf_counter
        """What the wall is timed by; `bench` takes the time of the processor where that is the cost of a frame."""
        self.timing = False
        self.done_anyway: frozenset[str] = frozenset()
        self.counts: Counter[str] = Counter()
        self.milliseconds: dict[str, float] = {}
        self._pending: list[tuple[str, moderngl.Query]] = []
        self._idle: list[moderngl.Query] = []
        self._open = False

    def begin(self) -> None:
        """Forget the last frame."""
        self.counts.clear()
        self.milliseconds.clear()

    def count(self, name: str, amount: int = 1) -> None:
        """Add to a counter: passes, fragments, draws, skipped work."""
        if amount:
            self.counts[name] += amount

    def may_skip(self, name: str) -> bool:
        """Whether the work that the counter `name` is of may be left out; without, to show that nothing needs it."""
        return name not in self.done_anyway

    @contextmanager
    def section(self, name: str) -> Iterator[None]:
        """Time what happens inside under `name`; inside another section it belongs to that one."""
        if not self.timing or self._open:
            yield
            return
        self._open = True
        try:
            if self.clock == "wall":
                self._ctx.finish()
                start = self.now()
                yield
                self._ctx.finish()
                self._add(name, (self.now() - start) * 1e3)
            else:
                query = self._idle.pop() if self._idle else self._ctx.query(time=True)
                with query:
                    yield
                self._pending.append((name, query))
        finally:
            self._open = False

    def resolve(self) -> dict[str, float]:
        """Wait for pending queries and return milliseconds by section, in order of first use."""
        for name, query in self._pending:
            self._add(name, query.elapsed / 1e6)
            self._idle.append(query)
        self._pending.clear()
        return dict(self.milliseconds)

    def _add(self, name: str, milliseconds: float) -> None:
        self.milliseconds[name] = self.milliseconds.get(name, 0.0) + milliseconds
