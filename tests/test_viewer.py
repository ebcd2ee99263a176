"""The viewer: navigation as numbers, panels through imgui's test engine, and the real window under a virtual screen."""

from __future__ import annotations

import contextlib
import os
import shutil
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

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
    """The environment of a screen of our own, so that no test touches the one a person is using."""
    if not shutil.which("Xvfb"):
        pytest.skip("no Xvfb on this machine")
    read, write = os.pipe()
    server = subprocess.Popen(
        ["Xvfb", "-displayfd", str(write), "-screen", "0", "1400x900x24", "-nolisten", "tcp"],
        pass_fds=(write,), stderr=subprocess.DEVNULL,
    )  # fmt: skip
    os.close(write)
    with os.fdopen(read) as stream:
        number = stream.readline().strip()
    home = tmp_path_factory.mktemp("home")
    yield {**os.environ, "DISPLAY": f":{number}", "HOME": str(home), "PYTHONPATH": str(ROOT)}
    server.terminate()
    server.wait(timeout=10)


@pytest.mark.window
@pytest.mark.parametrize("script", sorted(p.name for p in (ROOT / "tests" / "ui").glob("*.py") if p.name != "host.py"))
def test_panels_and_actions_do_what_they_say(display: dict[str, str], tmp_path: Path, script: str):
    """A script is given a folder to write to."""
    done = subprocess.run(
        [sys.executable, str(ROOT / "tests" / "ui" / script), str(tmp_path)], cwd=tmp_path, env=display,
        capture_output=True, text=True, timeout=300,
    )  # fmt: skip
    assert done.returncode == 0, (done.stdout + done.stderr)[-2000:]


class Window:
    """The real program in a real window, used by mouse and keyboard."""

    def __init__(self, environment: dict[str, str], folder: Path, *arguments: str):
        self.environment = environment
        self.folder = folder
        self.process = subprocess.Popen(
            [sys.executable, "-m", "dofview", *arguments],
            cwd=folder,
            env=environment,
            stderr=subprocess.PIPE,
            text=True,
        )
        self.xdo("search", "--sync", "--onlyvisible", "--name", "dofview")

    def xdo(self, *arguments: object) -> str:
        command = ["xdotool", *map(str, arguments)]
        return subprocess.run(command, env=self.environment, capture_output=True, text=True, timeout=60).stdout

    def key(self, chord: str) -> None:
        self.xdo("key", chord)

    def drag(self, start: tuple[int, int], *through: tuple[int, int]) -> None:
        """Press the left button at `start`, move, release; a hand is slower than a program."""
        self.xdo("mousemove", *start, "sleep", 0.2, "mousedown", 1, "sleep", 0.2)
        for point in through:
            self.xdo("mousemove", *point, "sleep", 0.1)
        self.xdo("mouseup", 1)

    def quit(self) -> int:
        """Press Ctrl+Q until the program has ended, and return its exit status."""
        for _ in range(9):
            self.key("ctrl+q")
            with contextlib.suppress(subprocess.TimeoutExpired):
                return self.process.wait(timeout=10)
        raise AssertionError("the window did not close")

    def until(
        self, what: str, wanted: Callable[[np.ndarray], bool], act: Callable[[], None] = lambda: None
    ) -> np.ndarray:
        """Save pictures with Ctrl+S until one is as `wanted`: a slow machine shows the answer late. `act` is what
        brings it about, and is done again when the answer does not come."""
        deadline = time.monotonic() + 90.0
        known: set[Path] = set(self.folder.glob("dofview-*.png"))
        act_at = 0.0
        while time.monotonic() < deadline:
            if time.monotonic() > act_at:
                act()
                act_at = time.monotonic() + 15.0
            self.key("ctrl+s")
            time.sleep(1.0)
            fresh = sorted(set(self.folder.glob("dofview-*.png")) - known)
            known |= set(fresh)
            for path in fresh:
                picture = np.asarray(Image.open(path).convert("RGB")).astype(float)
                if wanted(picture):
                    return picture
            assert self.process.poll() is None, self.process.stderr and self.process.stderr.read()
        raise AssertionError(f"not seen in time: {what}")


@pytest.mark.window
def test_the_real_window(display: dict[str, str], tmp_path: Path):
    """Open, drag a slider, switch scenes, save pictures, quit: by mouse and keyboard alone."""
    if not shutil.which("xdotool"):
        pytest.skip("no xdotool on this machine")
    window = Window(display, tmp_path, "demo:crossing", "--method", "mipmap", "--size", "320x240")
    window.until("a picture", lambda p: p.std() > 5.0)
    first = window.until("the picture settled", lambda p: p.std() > 5.0)

    def changed(picture: np.ndarray, before: np.ndarray, least: float) -> bool:
        return picture.shape == before.shape and bool(np.abs(picture - before).mean() > least)

    window.key("h")
    window.until("the picture fills the window without panels", lambda p: p.shape[1] > first.shape[1])
    window.key("h")
    window.until("the panels are back", lambda p: p.shape == first.shape)

    turned = window.until(
        "dragging turns the scene",
        lambda p: changed(p, first, 2.0),
        lambda: window.drag((200, 300), (240, 310), (290, 320)),
    )

    slider = first.shape[1] + 30, 68  # the lens panel stands first, its topmost slider is the aperture
    wider = window.until(
        "a slider changes the blur",
        lambda p: changed(p, turned, 0.5),
        lambda: window.drag(slider, (slider[0] + 90, slider[1])),
    )

    window.key("ctrl+shift+o")
    time.sleep(1.0)
    window.key("ctrl+a")
    window.xdo("type", "--delay", "30", "demo:rail")
    window.key("Return")
    window.until("another scene is shown", lambda p: changed(p, wider, 10.0))

    assert window.quit() == 0
    assert window.process.stderr is not None and "Traceback" not in window.process.stderr.read()
