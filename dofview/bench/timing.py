"""Milliseconds of whole frames."""

from __future__ import annotations

import os
import statistics
import time
from collections.abc import Callable
from typing import NamedTuple

from dofview.errors import GLError
from dofview.gl.context import Gpu
from dofview.pipeline import Pipeline, Result
from dofview.settings import Settings

ENOUGH_MS = 1500.0
"""Frames that take this long together need no more of them."""


class Spread(NamedTuple):
    """Median and quartiles in milliseconds."""

    median: float
    lower: float
    upper: float


class Clock(NamedTuple):
    """What frames are timed by: its name, and the function that reads it in seconds."""

    name: str
    now: Callable[[], float]


WALL = Clock("wall", time.perf_counter)
PROCESSOR = Clock("processor", time.process_time)


def clock_of(gpu: Gpu) -> Clock:
    """The clock that measures this context's work: the wall, or the processor where all of it is in this thread.

    That is llvmpipe with LP_NUM_THREADS=0. The processor's time is the same to a few percent whatever else runs.
    """
    alone = "llvmpipe" in gpu.renderer and os.environ.get("LP_NUM_THREADS") == "0"
    return PROCESSOR if alone else WALL


def timed(
    pipeline: Pipeline, settings: Settings, frames: int | None, clock: Clock = WALL, enough_ms: float = float("inf")
) -> tuple[Result, list[float]]:
    """Render `frames` whole frames after a warm-up, or one without when None: the last picture, milliseconds of each.

    Nothing is kept from one frame to the next, and each is waited for; reading back and writing is not in the time.
    After `enough_ms` in all there are no more frames. A warm-up that took as long counts as the frame: what it compiled
    is a few percent of it.
    """
    milliseconds: list[float] = []
    if frames is not None:
        result, warm_up = _frame(pipeline, settings, clock)
        milliseconds = [warm_up] if warm_up >= enough_ms else []
    while len(milliseconds) < (frames or 1) and sum(milliseconds) < enough_ms:
        result, spent = _frame(pipeline, settings, clock)
        milliseconds.append(spent)
    complaint = pipeline.gpu.ctx.error
    if complaint != "GL_NO_ERROR":
        raise GLError(f"OpenGL reports {complaint} while rendering {settings.method}; a smaller picture may fit")
    return result, milliseconds


def _frame(pipeline: Pipeline, settings: Settings, clock: Clock) -> tuple[Result, float]:
    pipeline.forget()
    pipeline.gpu.ctx.finish()
    start = clock.now()
    result = pipeline.render(settings)
    pipeline.gpu.ctx.finish()
    return result, (clock.now() - start) * 1e3


def spread(milliseconds: list[float]) -> Spread:
    """Median and quartiles; of few frames the extremes."""
    if len(milliseconds) < 4:
        return Spread(statistics.median(milliseconds), min(milliseconds), max(milliseconds))
    lower, median, upper = statistics.quantiles(milliseconds, n=4)
    return Spread(median, lower, upper)


def pass_times(pipeline: Pipeline, settings: Settings, clock: Clock = WALL) -> dict[str, float]:
    """Milliseconds by pass of one whole frame, by timer queries on a GPU and by `clock` without; waiting after each
    pass makes the sum larger than the frame."""
    profile = pipeline.gpu.profile
    pipeline.forget()
    profile.timing, profile.now = True, clock.now
    try:
        pipeline.render(settings)
        return profile.resolve()
    finally:
        profile.timing, profile.now = False, time.perf_counter
