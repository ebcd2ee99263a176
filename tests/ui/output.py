"""Saving, restoring, recording, undo and redo, used through imgui's test engine in a folder of their own."""

from __future__ import annotations

import contextlib
import math
import os
import resource
import sys
import time
from pathlib import Path

import av
import numpy as np
import OpenEXR
from host import Context, Host, drive, press, until
from PIL import Image

from dofview.gl.compose import Part
from dofview.metrics import srgb_decode, srgb_encode
from dofview.remember import read_note, read_preset
from dofview.seen.model import Arrangement
from dofview.settings import Settings
from dofview.viewer.app import App
from dofview.viewer.compare import Compare
from dofview.viewer.filming import Shows
from dofview.viewer.focusing import Focusing
from dofview.viewer.output import KEYFRAMES, KINDS, LIVE, RACK, TURNTABLE, Output
from dofview.viewer.screen import seen_of
from dofview.viewer.shots import Shots


def use(context: Context, app: App, host: Host) -> None:
    folder = Path.cwd()
    HOST.append(host)
    context.yield_(6)
    before = app.settings
    pictures(context, app, folder)
    transparent(context, app, folder)
    assert app.settings == before
    films(context, app, folder)
    what_is_seen(context, app, folder)
    another_size(context, app, folder)
    whole_window(context, app, folder)
    out_of_room(context, app, folder)


def pictures(context: Context, app: App, folder: Path) -> None:
    press(context, "s", "ctrl")
    (shot,) = folder.glob("dofview-*.png")
    assert read_note(shot).settings == app.settings

    before = app.settings
    lens = before.lens.model_copy(update={"focus_distance": before.lens.focus_distance * 2.0})
    app.settings = before.with_(lens=lens)
    context.yield_(4)
    press(context, "z", "ctrl")
    assert app.settings.lens == before.lens, "undo"
    press(context, "z", "ctrl", "shift")
    assert app.settings.lens == lens, "redo"

    app.open_any(str(shot))
    until(context, lambda: app.settings == before, "restored from the picture")

    press(context, "e", "ctrl")
    (parts,) = folder.glob("dofview-*.exr")
    with OpenEXR.File(str(parts)) as file:
        assert [part.header["name"] for part in file.parts] == ["color", "depth", "coc"]
        assert all(next(iter(part.channels.values())).pixels.shape[:2] == _shape(app) for part in file.parts)
    app.settings = before.with_(method="mipmap", lens=lens)
    context.yield_(4)
    app.open_any(str(parts))
    until(context, lambda: app.settings == before, "restored from the EXR")

    press(context, "s", "ctrl", "shift")
    (preset,) = folder.glob("preset-*.toml")
    restored, complaints = read_preset(preset, Settings())
    assert not complaints and restored.lens == app.settings.lens
    for path in (shot, parts, preset):
        path.unlink()


def transparent(context: Context, app: App, folder: Path) -> None:
    """Over its background, the transparent picture is the picture; where nothing is, it is clear."""
    good = app.settings
    away = good.camera.model_copy(update={"target": (0.0, 2.5, 0.0)})
    shots, found = app.tool(Shots), {}
    shots.transparent = True
    for name in ("mipmap", "accumulation"):
        lens = good.lens.model_copy(update={"radius": 0.1, "focus_distance": 3.0})
        app.settings = good.with_(method=name, camera=away, lens=lens)
        until(context, lambda: app.result is not None and not app.busy, f"{name} is there", 120.0)
        context.yield_(2)
        press(context, "s", "ctrl")
        until(context, lambda: any(folder.glob("dofview-*.png")), f"{name} is saved", 120.0)
        (path,) = folder.glob("dofview-*.png")
        pixels = np.asarray(Image.open(path)).astype(float) / 255.0
        path.unlink()
        assert pixels.shape == (*_shape(app), 4)
        found[name] = pixels[..., 3]
        assert found[name].min() == 0.0 and found[name].max() == 1.0
        share = ((found[name] > 0.02) & (found[name] < 0.98)).mean()
        assert share > 0.02, "blurred edges are between"
        background = np.asarray(app.settings.background_linear)
        alpha = pixels[..., 3:]
        over = srgb_encode(srgb_decode(pixels[..., :3]) * alpha + background * (1.0 - alpha))
        kept = {}
        host_pixels(context, app, kept)
        error = np.abs(over - kept["shown"] / 255.0)
        assert error.mean() < 1.5 / 255.0, (name, error.mean(), error.max())
    assert np.abs(found["mipmap"] - found["accumulation"]).mean() < 0.1
    shots.transparent = False
    app.settings = good
    until(context, lambda: not app.busy, "back")
    context.yield_(2)


def films(context: Context, app: App, folder: Path) -> None:
    before, output = app.settings, app.tool(Output)
    output.path, output.seconds, output.fps = 1, 0.5, 10
    output.toggle(app)
    until(context, lambda: not output.recording, "the turntable")
    (film,) = folder.glob("dofview-*.mp4")
    with av.open(str(film)) as opened:
        assert sum(1 for _ in opened.decode(video=0)) == 5
    assert math.isfinite(app.settings.lens.radius) and app.settings == before, "a film changes no settings"

    output.path, output.rack_to, lens = RACK, 1.5, app.settings.lens
    plan, frames = output._planning(app)
    assert plan(0).lens.focus_distance == lens.focus_distance and frames == 5
    assert math.isclose(plan(4).lens.focus_distance, 1.5), "to where it was said"

    output.path, output.kind = KEYFRAMES, KINDS.index("/%05d.png")
    output.toggle(app)
    assert not output.recording and "two views" in app.message
    press(context, "m", "ctrl", "shift")
    press(context, "left_arrow", "ctrl")
    press(context, "m", "ctrl", "shift")
    output.toggle(app)
    until(context, lambda: not output.recording, "the keyframes")
    (pictures,) = folder.glob("dofview-film-*")
    names = sorted(path.name for path in pictures.iterdir())
    assert names == [f"{number:05d}.png" for number in range(5)]
    first, last = (np.asarray(Image.open(pictures / names[end])).astype(int) for end in (0, -1))
    assert np.abs(first - last).mean() > 1.0, "from the first view to the last"

    output.kind, output.seconds = KINDS.index(".webm"), 60.0
    output.toggle(app)
    context.yield_(3)
    (work,) = output.work(app)
    work.cancel()
    context.yield_(2)
    assert not output.recording and "stopped after" in app.message
    app.settings = before
    context.yield_(2)


def what_is_seen(context: Context, app: App, folder: Path) -> None:
    """A film and a picture hold wipe, overlay and zoom; the picture brings them back."""
    before, output, compare = app.settings, app.tool(Output), app.tool(Compare)
    app.settings = before.with_(method="mipmap")
    compare.mode, compare.other, compare.split, app.tool(Focusing).shown = Arrangement.WIPE, "pinhole", 0.4, True
    app.part = Part(0.1, 0.1, 0.8, 0.8)
    until(context, lambda: not app.busy, "a wipe")
    context.yield_(3)
    output.path, output.kind, output.fps, output.shows = LIVE, KINDS.index("/%05d.png"), 10, Shows.SEEN
    clocks = []
    output.toggle(app)
    HOST[0].after = lambda app: clocks.append(app.clock())
    (film,) = (path for path in folder.glob("dofview-film-*") if not any(path.iterdir()))
    until(context, lambda: len(list(film.glob("*.png"))) >= 3, "three frames")
    HOST[0].after = lambda app: None
    output.toggle(app)
    assert np.allclose(np.diff(sorted(set(clocks))), 0.1), "time is frame / fps"
    assert app.clock() - clocks[-1] < 60.0 and app.clock == time.monotonic
    press(context, "s", "ctrl", "alt")
    (shot,) = folder.glob("dofview-seen-*.png")
    seen = np.asarray(Image.open(shot))
    kept: dict[str, np.ndarray] = {}
    HOST[0].inside(
        context, lambda app: kept.update(now=app.screen.image(app).pixels()[..., :3], own=app.shown.pixels())
    )
    assert (seen == kept["now"]).all() and (seen != kept["own"][..., :3]).mean() > 0.1
    for frame in sorted(film.glob("*.png")):
        assert (np.asarray(Image.open(frame)) == seen).all(), frame

    wanted = seen_of(app)
    compare.mode, app.tool(Focusing).shown, app.part = Arrangement.GRID, False, Part()
    context.yield_(3)
    app.open_any(str(shot))
    until(context, lambda: seen_of(app) == wanted and not app.busy, "the wipe is back")
    HOST[0].inside(context, lambda app: kept.update(again=app.screen.image(app).pixels()[..., :3]))
    assert (kept["again"] == seen).all()
    compare.mode, app.tool(Focusing).shown, app.part, app.settings = Arrangement.ONE, False, Part(), before
    context.yield_(2)


def another_size(context: Context, app: App, folder: Path) -> None:
    """The panels go away while a film is made: it goes on in the size it began with."""
    output = app.tool(Output)
    output.path, output.kind, output.fps, output.shows = LIVE, KINDS.index(".mp4"), 10, Shows.SEEN
    before = app.settings.image.size
    films = set(folder.glob("*.mp4"))
    output.toggle(app)
    context.yield_(5)
    press(context, "h")
    until(context, lambda: app.settings.image.size != before, "another size")
    context.yield_(20)
    assert output.recording, "it goes on"
    output.toggle(app)
    press(context, "h")
    until(context, lambda: app.settings.image.size == before, "the size before")
    (film,) = set(folder.glob("*.mp4")) - films
    with av.open(str(film)) as opened:
        frames = [frame.to_ndarray(format="rgb24") for frame in opened.decode(video=0)]
    assert {frame.shape[1::-1] for frame in frames} == {tuple(side + side % 2 for side in before)}
    bars = [frame[[2, -3]].max() for frame in frames]
    assert bars[0] > 40 and bars[-1] < 40, "the wider picture stands between bars"


def whole_window(context: Context, app: App, folder: Path) -> None:
    """A film of the window has what the window hands over, fitted when that is of another size."""
    output, size = app.tool(Output), app.window_size
    shots = [np.random.default_rng(n).integers(0, 256, (size[1], size[0], 4), dtype=np.uint8) for n in range(2)]
    shots.append(np.full((size[1] // 2, size[0], 4), 200, np.uint8))
    given: list[np.ndarray] = []

    def hand_over(app: App) -> None:
        promised, app.when_drawn = app.when_drawn, []
        for take in promised:
            given.append(shots[min(len(given), 2)])
            take(given[-1])

    output.path, output.kind, output.fps, output.shows = LIVE, KINDS.index("/%05d.png"), 30, Shows.WINDOW
    before = set(folder.glob("dofview-film-*"))
    HOST[0].after = hand_over
    output.toggle(app)
    until(context, lambda: len(given) >= 4, "four frames")
    output.toggle(app)
    HOST[0].after = lambda app: None
    (film,) = {path for path in folder.glob("dofview-film-*") if path.is_dir()} - before
    frames = [np.asarray(Image.open(path)) for path in sorted(film.iterdir())]
    assert len(frames) >= 4 and all((frames[n] == shots[n][..., :3]).all() for n in range(2))
    assert frames[3].shape == frames[0].shape and frames[3][size[1] // 2].min() == 200 and frames[3][0].max() == 0
    output.shows = Shows.SEEN


def out_of_room(context: Context, app: App, folder: Path) -> None:
    """The disk takes no more: a message says so, what there is plays to within two seconds, the window lives on."""
    output, soft = app.tool(Output), resource.getrlimit(resource.RLIMIT_FSIZE)
    output.path, output.kind, output.fps, output.seconds, output.shows = TURNTABLE, 0, 30, 60.0, Shows.PICTURE
    app.settings = app.settings.with_(method="pinhole")
    until(context, lambda: not app.busy, "pinhole")
    output.toggle(app)
    (part,) = (path for path in folder.glob("*.part.mp4"))
    until(context, lambda: part.stat().st_size > 30_000, "some of the film", 120.0)
    resource.setrlimit(resource.RLIMIT_FSIZE, (part.stat().st_size + 60_000, soft[1]))
    written: list[int] = []
    HOST[0].after = lambda app: written.extend(round(work.share * 1800) for work in output.work(app))
    until(context, lambda: not output.recording, "it ends", 120.0)
    HOST[0].after = lambda app: None
    resource.setrlimit(resource.RLIMIT_FSIZE, soft)
    assert "cannot go on writing the film: file too large" in app.message
    assert not part.with_name(part.name.replace(".part", "")).exists(), "a cut film has not the name of a whole one"
    playable = 0
    with contextlib.suppress(av.FFmpegError), av.open(str(part)) as opened:
        for _ in opened.decode(video=0):
            playable += 1
    assert playable >= written[-1] - 60, (playable, written[-1])
    renders = app.scene_renders
    app.settings = app.settings.with_(lens=app.settings.lens.model_copy(update={"focus_distance": 2.5}))
    until(context, lambda: app.scene_renders > renders, "the window lives on")


def _shape(app: App) -> tuple[int, int]:
    width, height = app.settings.image.size
    return height, width


def host_pixels(context: Context, app: App, kept: dict[str, np.ndarray]) -> None:
    """What is shown, read where OpenGL is."""
    HOST[0].after = lambda app: kept.setdefault("shown", app.shown.pixels()[..., :3].astype(float))
    until(context, lambda: "shown" in kept, "pixels")
    HOST[0].after = lambda app: None


HOST: list[Host] = []


if __name__ == "__main__":
    os.chdir(sys.argv[1])
    drive(use)
    print("used every output")
