"""Gaze to focus: numbers first, then depths from a real frame."""

from __future__ import annotations

import json
import math
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from scenes import three_planes

from dofview import focus
from dofview.errors import InputError
from dofview.focus import GazeSettings, Look, Pull, Row, Trace
from dofview.lens import HumanEye, Lens, focal_px
from dofview.pipeline import Pipeline
from dofview.record.paths import gaze
from dofview.scene.camera import Camera
from dofview.settings import ImageSettings, Settings

PLAIN = GazeSettings(fixation_radius=0.05, dwell_s=0.1, speed=6.0, rate_hz=60)
NEAR, FAR = (0.2, 0.5), (0.8, 0.5)


def depth_at(x: float, y: float) -> float:
    """A scene at 2 units on the left, at 10 on the right, and nothing above."""
    if y < 0.25:
        return 0.0
    return 0.5 if x < 0.5 else 0.1


def run(looks: list[Look], start: float = 5.0, settings: GazeSettings = PLAIN) -> list[Pull]:
    trace = Trace(Row(n / settings.rate_hz, look) for n, look in enumerate(looks))
    return list(focus.replay(trace, Pull.at(start), len(looks), depth_at, settings, 4 / 3))


def test_the_focus_waits_for_the_dwell_then_eases_in_dioptres():
    pulls = run([Look(NEAR)] * 120)
    waiting = [p.distance for p in pulls if p.target == 0.2]
    assert waiting == [5.0] * 6, "a tenth of a second is six ticks"
    left = np.array([0.5 - p.inverse_distance for p in pulls[6:40]])
    assert np.allclose(left[1:] / left[:-1], math.exp(-6.0 / 60.0), rtol=1e-9)
    assert pulls[-1].distance == 2.0 and pulls[-1].settled


def test_near_and_far_take_equally_long():
    to_near, to_far = run([Look(NEAR)] * 60, start=10.0), run([Look(FAR)] * 60, start=2.0)
    near = [p.inverse_distance - 0.1 for p in to_near]
    far = [0.5 - p.inverse_distance for p in to_far]
    assert np.allclose(near, far, rtol=1e-9)


def test_rate_changes_steps_and_not_the_way():
    slow = GazeSettings(**{**PLAIN.model_dump(), "dwell_s": 0.0, "rate_hz": 30})
    fast = GazeSettings(**{**PLAIN.model_dump(), "dwell_s": 0.0, "rate_hz": 120})
    few, many = run([Look(NEAR)] * 15, settings=slow), run([Look(NEAR)] * 60, settings=fast)
    assert [p.inverse_distance for p in few] == pytest.approx([p.inverse_distance for p in many[3::4]], rel=1e-12)


def test_background_a_look_away_and_the_interface_hold_the_focus():
    settled = run([Look(NEAR)] * 120 + [Look((0.2, 0.1))] * 30)
    assert settled[-1].distance == 2.0, "nothing is there to focus on"
    away = run([Look(NEAR)] * 10 + [Look(None)] * 120)
    assert away[-1].distance == 2.0, "on its way it arrives"


def test_freeze_stops_the_focus_on_its_way():
    pulls = run([Look(NEAR)] * 12 + [Look(NEAR, frozen=True)] * 30 + [Look(NEAR)] * 90)
    frozen = {p.distance for p in pulls[12:42]}
    assert frozen == {pulls[11].distance} and 2.0 < pulls[11].distance < 5.0
    assert pulls[-1].distance == 2.0


def test_small_movements_are_one_fixation_and_a_sweep_is_none():
    trembling = [Look((NEAR[0] + 0.02 * math.sin(n), NEAR[1])) for n in range(60)]
    anchors = {p.anchor for p in run(trembling) if p.fixated}
    assert len(anchors) == 1
    sweep = [Look((0.05 + 0.9 * n / 20, 0.5)) for n in range(20)]
    assert {p.distance for p in run(sweep)} == {5.0}


def test_at_infinity_and_back():
    assert Pull.at(math.inf).distance == math.inf
    assert run([Look(NEAR)] * 200, start=math.inf)[-1].distance == 2.0


def test_settled_means_that_nothing_changes_any_more():
    pulls = run([Look(NEAR)] * 200)
    first = next(n for n, p in enumerate(pulls) if p.settled and p.target == 0.5)
    assert len(set(pulls[first:])) == 1


def test_a_trace_is_read_as_it_was_written(tmp_path):
    generator = np.random.default_rng(1)
    looks = [Look((float(x), float(y)), bool(f > 0.9)) for x, y, f in generator.random((40, 3))] + [Look(None)]
    trace = Trace(Row(n / 60, look, 3.0 + 1.0 / (n + 1)) for n, look in enumerate(looks))
    path = tmp_path / "trace.csv"
    path.write_text(trace.text())
    read = focus.read_trace(path)
    assert read.rows == trace.rows and read.start == trace.start and read.ticks(PLAIN) == 41
    assert [read.at(n / 60) for n in range(41)] == looks


def test_a_trace_of_another_make_is_read(tmp_path):
    path = tmp_path / "tracker.csv"
    path.write_text("pupil,time_s,x,y\n1,0.0,0.5,0.5\n1,0.5,,\n1,1.0,1.5,0.5\n")
    trace = focus.read_trace(path)
    assert [row.look.point for row in trace.rows] == [(0.5, 0.5), None, None] and trace.start is None
    assert trace.at(0.499) == Look((0.5, 0.5)) and trace.at(0.5) == Look(None) and trace.at(-1.0) == Look(None)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "time_s, x, y"),
        ("time_s,x\n0,1\n", "no column y"),
        ("time_s,x,y\n0,0,0\n1,a,0\n", "line 3: x is 'a'"),
        ("time_s,x,y\n1,0,0\n0,0,0\n", "line 3: time_s"),
        ("time_s,x,y\nnan,0,0\n", "time_s"),
        ("time_s,x,y\n1e999,0,0\n", "time_s"),
        ("time_s,x,y\n\n0\n,,\n", "time_s is ''"),
        ("time_s,x,y,focus_distance\n0,0,0,-1\n", "focus_distance is -1"),
        ("time_s,x,y\n" + '"' + "9" * 200_000 + '"', "not a gaze trace"),
        ("time_s,x,y\n\0\xff", "not a gaze trace"),
    ],
)
def test_a_bad_trace_is_refused_in_one_line(tmp_path, text: str, said: str):
    path = tmp_path / "bad.csv"
    path.write_text(text, encoding="latin-1")
    with pytest.raises(InputError) as caught:
        focus.read_trace(path)
    message = str(caught.value)
    assert said in message and str(path) in message and "\n" not in message and len(message) < 400


def test_a_folder_or_a_missing_file_is_no_trace(tmp_path):
    for path in (tmp_path, tmp_path / "missing.csv"):
        with pytest.raises(InputError, match="cannot read gaze trace"):
            focus.read_trace(path)


@pytest.mark.parametrize("focus_mm", [1e3, 3e3, 1e9])
def test_the_eye_blurs_as_in_the_paper(focus_mm: float):
    """Lee 2009 (mipmap) eq 3–4 with the numbers of its §8, on a picture 768 pixels high."""
    eye = HumanEye()
    pixels = focal_px(768.0, eye.vfov_deg(768.0))
    law = Lens(radius=eye.radius(), focus_distance=focus_mm * 1e-3).coc(pixels)
    for depth_mm in (300.0, 500.0, 2000.0, 1e5):
        on_retina = 4.0 * 17.0 / (focus_mm - 17.0) * abs(depth_mm - focus_mm) / depth_mm
        diameter = 0.32 * 3000.0 / 24.0 * on_retina
        ours = 2.0 * abs(law.radius_px(1e3 / depth_mm))
        assert ours == pytest.approx(diameter * (focus_mm - 17.0) / focus_mm, rel=1e-12)
        assert diameter < 10.0, "the paper: not above 10 pixels from 300 mm on"


def test_a_film_of_a_gaze_has_the_focus_of_its_replay():
    trace = Trace(Row(n / 10, Look(point), 5.0) for n, point in enumerate((NEAR, FAR, NEAR, (0.2, 0.1))))
    how = GazeSettings(rate_hz=24.0)
    seen = gaze(Settings(), trace, lambda settings, x, y: depth_at(x, y), how)
    replayed = focus.replay(trace, Pull.at(5.0), 20, depth_at, how, 4 / 3)
    distances = [pull.distance for pull in replayed]
    assert [seen(frame).lens.focus_distance for frame in range(20)] == distances
    assert seen(3).lens.focus_distance == distances[3], "any frame may be asked for again"


def test_a_gaze_is_recorded_without_a_window(tmp_path):
    (tmp_path / "gaze.csv").write_text("time_s,x,y\n0,0.5,0.5\n0.4,0.5,0.5\n")
    command = [sys.executable, "-m", "dofview", "record", "demo:crossing", "--path", "gaze", "--method", "pinhole",
               "--size", "32x24", "--fps", "10", "-o", str(tmp_path / "%02d.png")]  # fmt: skip
    root = str(Path(focus.__file__).parents[1])
    run = {"capture_output": True, "text": True, "env": {**os.environ, "PYTHONPATH": root}}
    done = subprocess.run([*command, "--gaze", str(tmp_path / "gaze.csv")], **run)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout.splitlines()[-1])["frames"] == 5 == len(list(tmp_path.glob("*.png")))
    done = subprocess.run(command, **run)
    assert done.returncode == 2 and "--gaze" in done.stderr and done.stderr.count("\n") == 1


@pytest.fixture(scope="module")
def planes(session_gpu):
    pipeline = Pipeline(session_gpu, three_planes())
    yield pipeline
    pipeline.release()


SEEN = Settings(
    camera=Camera(), lens=Lens(radius=0.05, focus_distance=5.0), method="mipmap", image=ImageSettings(size=(128, 96))
)


def place(x: float, y: float, z: float) -> tuple[float, float]:
    """Where a point of the world stands in the picture of `SEEN`."""
    pixels = focal_px(96.0, 45.0) / (5.0 - z)
    return (64.0 + x * pixels) / 128.0, (48.0 - y * pixels) / 96.0


@pytest.mark.parametrize("scale", [1.0, 2.0])
def test_depth_under_a_point(gpu, planes: Pipeline, scale: float):
    settings = SEEN.with_(image=ImageSettings(size=(128, 96), scale=scale))
    for x, y, z in ((0.6, 0.4, 0.0), (-0.6, 0.6, 2.0), (-1.5, 1.2, -5.0), (0.6, -0.75, 2.2)):
        assert planes.inverse_depth(settings, *place(x, y, z)) == pytest.approx(1.0 / (5.0 - z), rel=1e-5)
    for corner in ((0.0, 0.0), (1.0, 1.0), (0.0, 1.0), (1.0, 0.0)):
        assert planes.inverse_depth(settings, *corner, radius=0.05) == pytest.approx(0.1, rel=0.5)


def test_the_median_ignores_a_thin_thing(gpu, planes: Pipeline):
    """The bar at z = 2 is 9 pixels wide; a disc of 25 pixels around its edge lies on the wall for the most part."""
    x, y = place(-0.52, 1.2, 2.0)
    assert planes.inverse_depth(SEEN, x, y) == pytest.approx(1.0 / 3.0, rel=1e-5)
    assert planes.inverse_depth(SEEN, x, y, radius=0.13) == pytest.approx(0.1, rel=1e-5)


def test_asking_for_a_depth_draws_nothing_twice(gpu, planes: Pipeline):
    planes.forget()
    planes.render(SEEN)
    drawn = gpu.profile.counts["geometry passes"]
    assert drawn > 0
    planes.inverse_depth(SEEN, 0.5, 0.5, 0.02)
    assert gpu.profile.counts["geometry passes"] == drawn


def test_a_gaze_over_a_real_picture_is_the_same_every_time(gpu, planes: Pipeline):
    looks = [place(0.6, 0.4, 0.0), place(-0.6, 0.6, 2.0), place(-1.5, 1.2, -5.0)]
    trace = Trace(Row(n * 0.2, Look(point)) for n, point in enumerate(looks))

    def distances() -> list[float]:
        planes.forget()
        depth = lambda x, y: planes.inverse_depth(SEEN, x, y, PLAIN.depth_radius)  # noqa: E731
        return [p.distance for p in focus.replay(trace, Pull.at(5.0), 40, depth, PLAIN, 4 / 3)]

    first = distances()
    assert first == distances()
    assert min(first) < 4.0 and first[-1] > min(first)
