"""`dofview record`: a film of a path, without a screen."""

from __future__ import annotations

import contextlib
import json as jsonlib
from collections.abc import Iterator
from enum import StrEnum
from functools import partial
from pathlib import Path

from rich.console import Console
from rich.progress import Progress

from dofview.cli.beside import seen_for
from dofview.cli.chosen import applied, settings_for
from dofview.cli.flags import Given
from dofview.cli.picture import headless, tell_warnings
from dofview.errors import SettingsError
from dofview.focus import GazeSettings, Trace, read_trace
from dofview.record.paths import Path_, gaze, keyframes, rack_focus, read_keyframes, still, turntable
from dofview.record.run import frame_count, record
from dofview.record.writers import check
from dofview.scene.load import load
from dofview.settings import Settings, checked

DEFAULT_S = 4.0


class PathKind(StrEnum):
    """What moves."""

    TURNTABLE = "turntable"
    RACK = "rack"
    KEYFRAMES = "keyframes"
    GAZE = "gaze"
    STILL = "still"


def record_to(
    spec: str, output: Path, given: Given, *, view: Path | None, method: str | None, camera: str | None, kind: str,
    seconds: float | None, fps: float, focus_from: float | None, focus_to: float | None, keys: Path | None,
    trace: Path | None,
) -> None:  # fmt: skip
    """Render a film and print its facts, the last line as JSON."""
    if kind not in list(PathKind):
        raise SettingsError(f"path is {kind[:40]!r}; accepted: {', '.join(PathKind)}")
    frames = frame_count(DEFAULT_S if seconds is None else seconds, fps)
    looks = _trace(trace, fps) if kind == PathKind.GAZE else None
    if looks is not None and seconds is None:
        frames = looks[0].ticks(looks[1])
    seen = seen_for(given, applied(Settings(), given, view=view, method=method).image.size)
    check(output)
    scene = load(spec)
    settings = settings_for(scene, spec, given, view=view, method=method, camera=camera)
    tell_warnings(scene)
    with headless(scene) as pipeline, _progress(frames) as advance:
        if looks is not None:
            depth = partial(pipeline.inverse_depth, radius=looks[1].depth_radius)
            path = gaze(settings, looks[0], depth, looks[1])
        else:
            path = _path(PathKind(kind), settings, frames, focus_from, focus_to, keys)
        record(pipeline, path, frames, output, fps, advance, seen=seen)
        renderer = pipeline.gpu.renderer
    facts = {"output": str(output), "frames": frames, "fps": fps, "size": list(settings.image.size),
             "method": settings.method, "path": kind, "renderer": renderer}  # fmt: skip
    print(jsonlib.dumps(facts))


def _path(
    kind: PathKind, settings: Settings, frames: int, focus_from: float | None, focus_to: float | None, keys: Path | None
) -> Path_:  # fmt: skip
    match kind:
        case PathKind.TURNTABLE:
            return turntable(settings, frames)
        case PathKind.RACK:
            here = settings.lens.focus_distance
            return rack_focus(settings, frames, focus_from or here, focus_to or here * 3.0)
        case PathKind.KEYFRAMES:
            if keys is None:
                raise SettingsError("a path of keyframes needs --keyframes FILE, a JSON list of views")
            return keyframes(settings, frames, read_keyframes(keys, settings))
    return still(settings)


def _trace(path: Path | None, fps: float) -> tuple[Trace, GazeSettings]:
    if path is None:
        raise SettingsError("a path of gaze needs --gaze FILE, a CSV file with time_s, x, y")
    return read_trace(path), checked(GazeSettings, {"rate_hz": fps}, "fps")


@contextlib.contextmanager
def _progress(frames: int) -> Iterator:
    with Progress(console=Console(stderr=True), transient=True) as progress:
        task = progress.add_task("recording", total=frames)
        yield lambda done: progress.update(task, completed=done)
