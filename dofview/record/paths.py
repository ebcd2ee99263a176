"""What a film shows: the settings of each frame as a function of its number, never of a clock."""

from __future__ import annotations

import json
import math
from bisect import bisect_right
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np

from dofview.errors import InputError, SettingsError
from dofview.focus import GazeSettings, Pull, Trace, step
from dofview.reading import read_small
from dofview.scene.navigation import orbit
from dofview.settings import Settings, apply_view

MOST_BYTES = 16 << 20
"""Of a file of keyframes."""

Path_ = Callable[[int], Settings]
"""Frame number, from 0, to settings."""


def still(settings: Settings) -> Path_:
    """The same picture all along."""
    return lambda frame: settings


def turntable(settings: Settings, frames: int, turns: float = 1.0) -> Path_:
    """Once around the target; the last frame is a step before the first, so that the film loops."""
    return lambda frame: settings.with_(camera=orbit(settings.camera, 360.0 * turns * frame / frames, 0.0))


def rack_focus(settings: Settings, frames: int, start: float, end: float) -> Path_:
    """Focus from `start` to `end`, scene units, smoothly in dioptres: near and far change at the pace the eye sees."""
    for name, value in (("start", start), ("end", end)):
        if not value > 0.0:
            raise SettingsError(f"rack focus {name} is {value:g}; accepted: a distance above 0, or inf")

    def at(frame: int) -> Settings:
        t = _ease(frame / max(frames - 1, 1))
        inverse = (1.0 - t) / start + t / end
        return _focused(settings, 1.0 / inverse if inverse > 0.0 else math.inf)

    return at


def gaze(
    settings: Settings, trace: Trace, inverse_depth: Callable[[Settings, float, float], float], how: GazeSettings
) -> Path_:  # fmt: skip
    """Focus as a recorded gaze pulls it, a step a frame: what a replay in the window shows at `how.rate_hz`.

    `inverse_depth` is asked what is under a point of the picture of some settings (`Pipeline.inverse_depth`).
    """
    pull = trace.start or Pull.at(settings.lens.focus_distance)
    width, height = settings.image.size
    seen = [_focused(settings, pull.distance)]

    def at(frame: int) -> Settings:
        nonlocal pull
        while len(seen) <= frame + 1:
            tick, now = len(seen) - 1, seen[-1]
            look = trace.at(tick / how.rate_hz)
            pull = step(pull, look, tick, partial(inverse_depth, now), how, width / height)
            seen.append(_focused(settings, pull.distance))
        return seen[frame + 1]

    return at


def keyframes(settings: Settings, frames: int, views: list[Settings]) -> Path_:
    """Through `views` at equal times: camera and focus on smooth curves that stop at both ends."""
    if len(views) < 2:
        raise SettingsError("a path of keyframes needs two views or more")
    positions = np.array([view.camera.position for view in views], dtype=np.float64)
    targets = np.array([view.camera.target for view in views], dtype=np.float64)
    numbers = np.array([[v.camera.vfov_deg, v.lens.radius, 1.0 / v.lens.focus_distance] for v in views])

    def at(frame: int) -> Settings:
        t = frame / max(frames - 1, 1) * (len(views) - 1)
        position, target, (vfov, radius, inverse) = (_curve(p, t) for p in (positions, targets, numbers))
        camera = settings.camera.model_copy(
            update={"position": tuple(position.tolist()), "target": tuple(target.tolist()), "vfov_deg": float(vfov)}
        )
        focus = 1.0 / float(inverse) if inverse > 0.0 else math.inf
        lens = settings.lens.model_copy(update={"radius": max(float(radius), 0.0), "focus_distance": focus})
        return settings.with_(camera=camera, lens=lens)

    return at


def read_keyframes(path: Path, settings: Settings) -> list[Settings]:
    """Read a JSON list of views; SettingsError names the file and the view that is wrong."""
    try:
        found = json.loads(read_small(path, "keyframes", MOST_BYTES))
    except InputError as error:
        raise SettingsError(str(error)) from error
    except (ValueError, RecursionError) as error:
        raise SettingsError(f"{path}: not a JSON list of views: {error}") from error
    if not isinstance(found, list):
        raise SettingsError(f"{path}: keyframes are a JSON list of views")
    return [apply_view(settings, view, f"{path}: view {number}") for number, view in enumerate(found)]


def _focused(settings: Settings, distance: float) -> Settings:
    return settings.with_(lens=settings.lens.model_copy(update={"focus_distance": distance}))


def _ease(t: float) -> float:
    """0 to 1 with no speed at the ends."""
    return t * t * (3.0 - 2.0 * t)


def _curve(points: np.ndarray, t: float) -> np.ndarray:
    """Catmull–Rom through `points` (n, k) at 0…n−1, its tangents zero at the ends."""
    last = len(points) - 1
    start = min(max(bisect_right(range(len(points)), t) - 1, 0), last - 1)
    u = t - start
    tangents = np.zeros_like(points)
    tangents[1:-1] = (points[2:] - points[:-2]) / 2.0
    a, b, m, n = points[start], points[start + 1], tangents[start], tangents[start + 1]
    return (2 * u**3 - 3 * u**2 + 1) * a + (u**3 - 2 * u**2 + u) * m + (3 * u**2 - 2 * u**3) * b + (u**3 - u**2) * n
