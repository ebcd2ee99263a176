"""Films: paths as functions of the frame, files with exactly the frames asked for, playable when cut off."""

from __future__ import annotations

import hashlib
import math
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from scenes import three_planes

from dofview.errors import InputError, OutputError, SettingsError
from dofview.gl.context import Gpu
from dofview.lens import Lens
from dofview.metrics import srgb_encode
from dofview.pipeline import Pipeline
from dofview.record.paths import keyframes, rack_focus, read_keyframes, still, turntable
from dofview.record.run import Encoder, frame_count, record
from dofview.record.writers import check, writer
from dofview.scene.camera import Camera
from dofview.seen import headless
from dofview.seen.model import Arrangement, Seen
from dofview.settings import ImageSettings, Settings

SETTINGS = Settings(
    camera=Camera(position=(0, 1, 5)), lens=Lens(radius=0.1, focus_distance=4.0), method="pinhole",
    image=ImageSettings(size=(65, 47)),
)  # fmt: skip


def frames_of(path: Path) -> list[np.ndarray]:
    import av

    with av.open(str(path)) as film:
        return [frame.to_ndarray(format="rgb24") for frame in film.decode(video=0)]


def test_a_turntable_goes_once_around_and_loops():
    path = turntable(SETTINGS, 8)
    positions = np.array([path(i).camera.position for i in range(9)])
    assert np.allclose(positions[0], positions[8]) and np.ptp(positions[:, 1]) < 1e-9
    steps = np.linalg.norm(np.diff(positions, axis=0), axis=1)
    assert np.allclose(steps, steps[0])


def test_a_rack_focus_moves_in_dioptres_and_reaches_infinity():
    path = rack_focus(SETTINGS, 11, 2.0, math.inf)
    dioptres = [1.0 / path(i).lens.focus_distance for i in range(11)]
    assert dioptres[0] == 0.5 and dioptres[-1] == 0.0 and dioptres[5] == pytest.approx(0.25)
    assert (np.diff(dioptres) < 0).all()
    with pytest.raises(SettingsError, match="start is -1"):
        rack_focus(SETTINGS, 3, -1.0, 2.0)


def test_keyframes_pass_through_their_views(tmp_path):
    views = [SETTINGS.with_(camera=Camera(position=(x, 1, 5), target=(x / 2, 0, 0))) for x in (0.0, 1.0, 4.0)]
    path = keyframes(SETTINGS, 9, views)
    for frame, view in ((0, views[0]), (4, views[1]), (8, views[2])):
        assert np.allclose(path(frame).camera.position, view.camera.position)
    with pytest.raises(SettingsError, match="two views or more"):
        keyframes(SETTINGS, 9, views[:1])
    bad = tmp_path / "keys.json"
    bad.write_text('[{"camera": {"vfov_deg": 500}}]')
    with pytest.raises(SettingsError, match=r"keys\.json: view 0: .*vfov_deg"):
        read_keyframes(bad, SETTINGS)


@pytest.mark.parametrize(("seconds", "fps", "frames"), [(2.0, 30.0, 60), (0.1, 29.97, 3), (1 / 3, 24.0, 8)])
def test_a_film_has_round_of_duration_times_fps_frames(seconds, fps, frames):
    assert frame_count(seconds, fps) == frames


@pytest.mark.parametrize("suffix", [".mp4", ".webm"])
def test_a_film_shows_what_was_rendered_and_twice_the_same(gpu: Gpu, tmp_path, suffix):
    pipeline = Pipeline(gpu, three_planes())
    digests = []
    for name in ("one", "two"):
        film = tmp_path / f"{name}{suffix}"
        record(pipeline, turntable(SETTINGS, 6), 6, film, 12.0)
        digests.append(hashlib.sha256(film.read_bytes()).hexdigest())
        frames = frames_of(film)
        assert len(frames) == 6 and frames[0].shape == (48, 66, 3), "odd sizes are padded"
        for number in (0, 5):
            shown = 255.0 * srgb_encode(pipeline.render(turntable(SETTINGS, 6)(number)).pixels())
            # A film holds colour at half the size, so brightness (BT.709) is what is compared.
            apart = (frames[number][:47, :65] - shown) @ [0.2126, 0.7152, 0.0722]
            assert 10.0 * np.log10(255.0**2 / (apart**2).mean()) >= 35.0
    pipeline.release()
    assert digests[0] == digests[1] or suffix == ".webm", "the same bytes from two runs"
    assert not list(tmp_path.glob("*.part.*"))


def test_a_film_of_what_is_seen_holds_the_comparison_and_twice_the_same(gpu: Gpu, tmp_path):
    """A wipe of two methods under a map of what is in focus, frame by frame as it is made without a film."""
    pipeline = Pipeline(gpu, three_planes())
    values = Seen(arrangement=Arrangement.WIPE, other="mipmap", split=0.4, in_focus=True, text_px=8.0)
    for name in ("one", "two"):
        record(pipeline, turntable(SETTINGS, 3), 3, tmp_path / name / "%d.png", 12.0, seen=values)
    for number in range(3):
        first, second = (np.asarray(Image.open(tmp_path / name / f"{number}.png")) for name in ("one", "two"))
        wanted = headless.picture(pipeline, turntable(SETTINGS, 3)(number), values).pixels()[..., :3]
        assert (first == second).all() and (first == wanted).all()
        assert (first != pipeline.shown(pipeline.render(SETTINGS), SETTINGS)).mean() > 0.1
    record(pipeline, still(SETTINGS), 1, tmp_path / "linear" / "%d.exr", 12.0, seen=values)
    pipeline.release()
    assert (tmp_path / "linear" / "0.exr").stat().st_size > 1000


def test_a_sequence_and_a_gif(gpu: Gpu, tmp_path):
    pipeline = Pipeline(gpu, three_planes())
    record(pipeline, still(SETTINGS), 3, tmp_path / "frames" / "%03d.png", 10.0)
    record(pipeline, turntable(SETTINGS, 3), 3, tmp_path / "turn.gif", 10.0)
    pipeline.release()
    assert sorted(p.name for p in (tmp_path / "frames").iterdir()) == ["000.png", "001.png", "002.png"]
    with Image.open(tmp_path / "turn.gif") as film:
        assert film.n_frames == 3 and film.info["duration"] == 100


def test_what_cannot_be_written_is_said_before_rendering(tmp_path):
    with pytest.raises(InputError, match="accepted: .mp4, .webm, .gif"):
        check(tmp_path / "film.avi")
    with pytest.raises(OutputError, match="no folder"):
        check(tmp_path / "missing" / "film.mp4")
    with pytest.raises(InputError, match="not a pattern"):
        check(tmp_path / "%d-%d.png")
    with pytest.raises(OutputError):
        writer(tmp_path / "missing" / "film.mp4", (16, 16), 10.0)


def test_an_error_of_the_encoder_reaches_who_records():
    class Broken:
        def add(self, pixels):
            raise OutputError("no space left")

        def close(self): ...
        def abandon(self): ...

    encoder = Encoder(Broken())
    with pytest.raises(OutputError, match="no space left"):
        for _ in range(100):
            encoder.add(np.zeros((2, 2, 3)))
            time.sleep(0.01)
    encoder.abandon()


def test_a_killed_recording_plays_to_within_two_seconds(tmp_path):
    """kill -9 after some 120 frames of 30 a second: what is on disk holds all but the last second."""
    script = (
        "import numpy as np, sys, time\n"
        "from pathlib import Path\n"
        "from dofview.record.writers import writer\n"
        "film = writer(Path(sys.argv[1]), (64, 48), 30.0)\n"
        "noise = np.random.default_rng(0).random((48, 64, 3), dtype=np.float32)\n"
        "for frame in range(100000):\n"
        "    film.add(np.roll(noise, frame, axis=1))\n"
        "    print(frame, flush=True)\n"
    )
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parents[1])}
    process = subprocess.Popen(
        [sys.executable, "-c", script, str(tmp_path / "film.mp4")], env=environment, stdout=subprocess.PIPE, text=True
    )
    assert process.stdout is not None
    written = 0
    while written < 120:
        written = int(process.stdout.readline())
    process.send_signal(signal.SIGKILL)
    written = max([written, *map(int, process.stdout.read().split())])
    process.wait()
    assert not (tmp_path / "film.mp4").exists(), "a cut film does not carry the name of a whole one"
    assert len(frames_of(tmp_path / "film.part.mp4")) >= written - 60
