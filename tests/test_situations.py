"""What machines are like: an OpenGL that can less, small limits, a window without one, a screen that goes away."""

from __future__ import annotations

import contextlib
import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from dofview.errors import SettingsError
from dofview.gl.context import Gpu
from dofview.methods import METHODS, method
from dofview.pipeline import Pipeline
from dofview.scene.load import load
from dofview.scene.model import Scene
from dofview.settings import ImageSettings, Settings

ROOT = Path(__file__).parents[1]
DEMO = "demo:crossing"
linux = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="Mesa's variables")


def environment(**variables: str) -> dict[str, str]:
    return {**os.environ, "PYTHONPATH": str(ROOT), "LP_NUM_THREADS": "0", **variables}


@linux
@pytest.mark.parametrize(
    "variables",
    [{"MESA_GL_VERSION_OVERRIDE": "3.3"}, {"GALLIUM_DRIVER": "softpipe"},
     {"MESA_EXTENSION_OVERRIDE": "-GL_EXT_texture_filter_anisotropic -GL_ARB_texture_filter_anisotropic"}],
    ids=("OpenGL 3.3", "softpipe", "no anisotropy"),
)  # fmt: skip
def test_every_method_draws_where_opengl_can_less(tmp_path: Path, variables: dict[str, str]):
    done = subprocess.run(
        [sys.executable, "-m", "dofview", "compare", DEMO, "--size", "24x16", "--views", "2", "--out", str(tmp_path)],
        env=environment(**variables), capture_output=True, text=True, timeout=240,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    pictures = {path.stem.rpartition("-")[2] for path in tmp_path.glob("*.png")}
    assert {name for name in METHODS if method(name).REQUIRES_GL <= 330} <= pictures


@linux
def test_an_opengl_that_is_too_old_is_named_beside_what_is_needed(tmp_path: Path):
    done = subprocess.run(
        [sys.executable, "-m", "dofview", "render", DEMO, "-o", str(tmp_path / "a.png")],
        env=environment(MESA_GL_VERSION_OVERRIDE="3.0"), capture_output=True, text=True, timeout=120,
    )  # fmt: skip
    if done.returncode == 0:
        pytest.skip("this OpenGL does not heed the variable")
    assert done.returncode == 4 and done.stderr.count("\n") == 1
    assert "3.3" in done.stderr and "offers 3.0" in done.stderr


@pytest.fixture
def scene() -> Scene:
    return load(DEMO)


def test_pictures_beyond_the_largest_texture_are_refused_and_textures_made_smaller(
    gpu: Gpu, scene: Scene, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(gpu, "max_size", 128)
    pipeline = Pipeline(gpu, scene)
    try:
        for name in METHODS:
            small = Settings(method=name, image=ImageSettings(size=(48, 32)))
            pipeline.render(small.with_params(views=2) if name == "accumulation" else small)
        with pytest.raises(SettingsError, match="too large; accepted: sides up to 128"):
            pipeline.render(Settings(method="pinhole", image=ImageSettings(size=(129, 8))))
    finally:
        pipeline.release()


@contextlib.contextmanager
def screen() -> Iterator[tuple[subprocess.Popen, str]]:
    """A screen of our own, and its name."""
    if not shutil.which("Xvfb"):
        pytest.skip("no Xvfb on this machine")
    read, write = os.pipe()
    server = subprocess.Popen(
        ["Xvfb", "-displayfd", str(write), "-screen", "0", "800x600x24", "-nolisten", "tcp"],
        pass_fds=(write,), stderr=subprocess.DEVNULL,
    )  # fmt: skip
    os.close(write)
    with os.fdopen(read) as stream:
        name = f":{stream.readline().strip()}"
    try:
        yield server, name
    finally:
        if server.poll() is None:
            server.terminate()
        server.wait(timeout=10)


@pytest.mark.window
@linux
@pytest.mark.parametrize("variables", [{"MESA_GL_VERSION_OVERRIDE": "2.1"}, {"LIBGL_DRIVERS_PATH": "/nonexistent"}])
def test_a_window_without_usable_opengl_is_one_line(variables: dict[str, str]):
    with screen() as (_, name):
        done = subprocess.run(
            [sys.executable, "-m", "dofview", DEMO, "--safe"], env=environment(DISPLAY=name, **variables),
            capture_output=True, text=True, timeout=120,
        )  # fmt: skip
    told = [line for line in done.stderr.splitlines() if not line.startswith("libGL error")]
    assert done.returncode == 4 and len(told) == 1 and "3.3" in told[0], done.stderr


@pytest.mark.window
@linux
def test_a_film_lives_on_when_the_screen_goes_away(tmp_path: Path):
    """Xlib ends the process at once; what was recorded until then can be played, but for the last second."""
    if not shutil.which("xdotool"):
        pytest.skip("no xdotool on this machine")
    import av

    with screen() as (server, name):
        variables = environment(DISPLAY=name, HOME=str(tmp_path))
        window = subprocess.Popen(
            [sys.executable, "-m", "dofview", DEMO, "--method", "pinhole"], cwd=tmp_path, env=variables,
            stderr=subprocess.PIPE, text=True,
        )  # fmt: skip
        subprocess.run(
            ["xdotool", "search", "--sync", "--onlyvisible", "--name", "dofview"], env=variables, timeout=60,
            stdout=subprocess.DEVNULL,
        )  # fmt: skip
        time.sleep(3.0)
        subprocess.run(["xdotool", "key", "ctrl+m"], env=variables, timeout=60)
        deadline = time.monotonic() + 90.0
        films: list[Path] = []
        while not (films and films[0].stat().st_size > 2000) and time.monotonic() < deadline:
            time.sleep(0.5)
            films = list(tmp_path.glob("*.mp4"))
        assert films, "nothing is recorded"
        server.send_signal(signal.SIGKILL)
        _, told = window.communicate(timeout=60)
    assert window.returncode not in (0, None) and "Traceback" not in told, told
    with av.open(str(films[0])) as film:
        assert sum(1 for _ in film.decode(video=0)) >= 30
