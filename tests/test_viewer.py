"""The viewer: navigation as numbers, panels through imgui's test engine, and the real window under a virtual screen."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from real_window import screen, tools_missing

from dofview.scene import navigation
from dofview.scene.camera import Camera

ROOT = Path(__file__).parents[1]
CAMERA = Camera(position=(1.0, 2.0, 5.0), target=(0.5, 0.5, 0.0), vfov_deg=40.0)


def test_orbit_keeps_distance_and_target_and_comes_back():
    turned = navigation.orbit(CAMERA, 30.0, 12.0)
    assert turned.target == CAMERA.target and turned.distance == pytest.approx(CAMERA.distance)
    back = navigation.orbit(navigation.orbit(turned, 0.0, -12.0), -30.0, 0.0)
    assert np.allclose(back.position, CAMERA.position)


def test_orbit_stops_before_the_pole():
    above = navigation.orbit(CAMERA, 0.0, 1000.0)
    assert np.isfinite(above.axes()).all()
    assert above.axes()[2][1] == pytest.approx(np.sin(np.radians(navigation.STEEPEST_DEG)), abs=1e-6)


def test_pan_moves_the_target_by_its_share_of_the_picture():
    moved = navigation.pan(CAMERA, 0.25, -0.5)
    height = 2 * CAMERA.distance * np.tan(np.radians(20.0))
    shift = np.subtract(moved.target, CAMERA.target) @ CAMERA.axes().T / height
    assert np.allclose(shift, [0.25, -0.5, 0.0])


def test_zoom_never_reaches_the_target():
    near = CAMERA
    for _ in range(2000):
        near = navigation.zoom(near, 1.0)
    assert near.distance > 0.0 and np.isfinite(near.axes()).all()
    assert navigation.zoom(CAMERA, -3.0).distance > CAMERA.distance


def test_look_turns_to_where_it_says():
    right = navigation.look(CAMERA, 20.0, 0.0)
    assert right.position == CAMERA.position
    assert np.subtract(right.target, CAMERA.position) @ CAMERA.axes()[0] > 0.0
    up = navigation.look(CAMERA, 0.0, 10.0)
    assert np.subtract(up.target, CAMERA.position) @ CAMERA.axes()[1] > 0.0


def test_fit_sees_the_whole_box():
    bounds = np.array([[-3.0, -1.0, -2.0], [5.0, 4.0, 2.0]])
    camera = navigation.fit(CAMERA, bounds)
    corners = np.array([[x, y, z] for x in bounds[:, 0] for y in bounds[:, 1] for z in bounds[:, 2]])
    seen = (corners - camera.position) @ camera.axes().T
    assert (np.abs(seen[:, 1] / seen[:, 2]) <= np.tan(np.radians(20.0)) + 1e-9).all() and (seen[:, 2] < 0).all()


@pytest.fixture(scope="module")
def display(tmp_path_factory) -> Iterator[dict[str, str]]:
    if "Xvfb" in tools_missing():
        pytest.skip("no Xvfb on this machine")
    with screen(tmp_path_factory.mktemp("home")) as environment:
        yield environment


@pytest.mark.window
@pytest.mark.parametrize("script", sorted(p.name for p in (ROOT / "tests" / "ui").glob("*.py") if p.name != "host.py"))
def test_panels_and_actions_do_what_they_say(display: dict[str, str], tmp_path: Path, script: str):
    """A script is given a folder to write to."""
    done = subprocess.run(
        [sys.executable, str(ROOT / "tests" / "ui" / script), str(tmp_path)], cwd=tmp_path, env=display,
        capture_output=True, text=True, timeout=300,
    )  # fmt: skip
    assert done.returncode == 0, (done.stdout + done.stderr)[-2000:]
