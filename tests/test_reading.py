"""What a person names on the command line is read, or refused in one line: never waited for, never in two voices."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from dofview.cli import main
from dofview.errors import InputError
from dofview.export import save
from dofview.focus import read_trace
from dofview.record.paths import read_keyframes
from dofview.remember import read_note, read_preset
from dofview.render.environment import read
from dofview.settings import Settings, read_view

READERS: dict[str, Callable[[Path], object]] = {
    "gaze.csv": read_trace,
    "preset.toml": lambda path: read_preset(path, Settings()),
    "keys.json": lambda path: read_keyframes(path, Settings()),
    "view.json": lambda path: read_view(path, Settings()),
    "like.png": read_note,
    "like.exr": read_note,
    "sky.hdr": read,
    "sky.exr": read,
}


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes in folders here")
@pytest.mark.parametrize("name", READERS)
def test_a_pipe_is_refused_and_not_waited_for(tmp_path: Path, name: str):
    os.mkfifo(tmp_path / name)
    with pytest.raises(InputError, match=name):
        READERS[name](tmp_path / name)


@pytest.mark.parametrize("name", READERS)
@pytest.mark.parametrize("content", [None, b"\0", b"\xff\xfe\x00", b"[" * 5000])
def test_what_cannot_be_read_is_one_line(tmp_path: Path, name: str, content: bytes | None):
    path = tmp_path / name
    path.mkdir() if content is None else path.write_bytes(content)
    with pytest.raises(InputError) as refusal:
        READERS[name](path)
    assert "\n" not in str(refusal.value) and name in str(refusal.value)


@pytest.mark.parametrize("share", [0.2, 0.6, 0.95])
def test_a_cut_exr_says_so_once(tmp_path: Path, capfd: pytest.CaptureFixture[str], share: float):
    whole = tmp_path / "whole.exr"
    save(whole, np.random.default_rng(1).random((32, 64, 3)).astype(np.float32))
    cut = tmp_path / "cut.exr"
    cut.write_bytes(whole.read_bytes()[: int(whole.stat().st_size * share)])
    with pytest.raises(InputError):
        read(cut)
    said = capfd.readouterr()
    assert said.out == "" and said.err == ""


@pytest.mark.parametrize(
    ("typed", "said"),
    [
        (["rendr", "scene.glb"], "did you mean render?"),
        (["render", "demo:rail", "--focuss", "3", "-o", "a.png"], "did you mean --focus?"),
        (["render", "demo:rail", "--methd", "mipmap", "-o", "a.png"], "did you mean --method?"),
        (["info", "demo:rail", "demo:glossy"], "too much was given: 'demo:glossy'"),
    ],
)
def test_a_slip_is_answered_with_what_was_meant(typed: list[str], said: str, capsys: pytest.CaptureFixture[str]):
    assert main(typed) == 2
    assert said in capsys.readouterr().err
