"""Milliseconds of whole frames."""

from __future__ import annotations

import statistics
import time
from typing import NamedTuple

from dofview.errors import GLError
from dofview.pipeline import Pipeline, Result
from dofview.settings import Settings


class Spread(NamedTuple):
    """Median and quartiles in milliseconds."""

    median: float
    lower: float
    upper: float


def timed(pipeline: Pipeline, settings: Settings, frames: int | None) -> tuple[Result, list[float]]:
    """Render `frames` whole frames after a warm-up, or one without when None: the last picture, milliseconds of each.

    Nothing is kept from one frame to the next, and each is waited for; reading back and writing is not in the time.
    """
    if frames is not None:
        pipeline.render(settings)
    milliseconds = []
    for _ in range(frames or 1):
        pipeline.forget()
        pipeline.gpu.ctx.finish()
        start = time.perf_counter()
        result = pipeline.render(settings)
        pipeline.gpu.ctx.finish()
        milliseconds.append((time.perf_counter() - start) * 1e3)
    complaint = pipeline.gpu.ctx.error
    if complaint != "GL_NO_ERROR":
        raise GLError(f"OpenGL reports {complaint} while rendering {settings.method}; a smaller picture may fit")
    return result, milliseconds


def spread(milliseconds: list[float]) -> Spread:
    """Median and quartiles; of few frames the extremes."""
    if len(milliseconds) < 4:
        return Spread(statistics.median(milliseconds), min(milliseconds), max(milliseconds))
    lower, median, upper = statistics.quantiles(milliseconds, n=4)
    return Spread(median, lower, upper)


def pass_times(pipeline: Pipeline, settings: Settings) -> dict[str, float]:
    """Milliseconds by pass of one whole frame, by the clock that `gpu.profile.clock` names; waiting after each pass
    makes the sum larger than the frame."""
    profile = pipeline.gpu.profile
    pipeline.forget()
    profile.timing = True
    try:
        pipeline.render(settings)
        return profile.resolve()
    finally:
        profile.timing = False
