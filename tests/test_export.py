"""Pictures in files: the values in them, and that a file appears whole or not at all."""

from __future__ import annotations

import os
import stat
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from dofview import export
from dofview.errors import InputError, OutputError

PIXELS = np.linspace(-0.1, 4.0, 5 * 7 * 3, dtype=np.float32).reshape(5, 7, 3)


def test_npy_holds_the_floats_as_they_are(tmp_path: Path):
    export.save(tmp_path / "a.npy", PIXELS)
    again = np.load(tmp_path / "a.npy")
    assert again.dtype == np.float32 and np.array_equal(again, PIXELS)


def test_exr_holds_the_floats_as_they_are(tmp_path: Path):
    OpenEXR = pytest.importorskip("OpenEXR")
    export.save(tmp_path / "a.exr", PIXELS)
    with OpenEXR.File(str(tmp_path / "a.exr")) as file:
        again = file.channels()["RGB"].pixels
    assert again.dtype == np.float32 and np.array_equal(again, PIXELS)


def test_png_is_srgb_by_the_standard(tmp_path: Path):
    """Every 8-bit code from the linear value IEC 61966-2-1 gives it; beyond white is white, below black is black."""
    codes = np.arange(256)
    coded = codes / 255.0
    linear = np.where(coded <= 0.04045, coded / 12.92, ((coded + 0.055) / 1.055) ** 2.4)
    row = np.concatenate([linear, [-1.0, 7.0, np.inf, np.nan]])
    export.save(tmp_path / "a.png", np.repeat(row[None, :, None], 3, axis=2).astype(np.float32))
    image = Image.open(tmp_path / "a.png")
    assert image.mode == "RGB"
    assert np.asarray(image)[0, :, 1].tolist() == [*codes.tolist(), 0, 255, 255, 0]


def test_row_0_is_on_top(tmp_path: Path):
    pixels = np.zeros((4, 3, 3), np.float32)
    pixels[0] = 1.0
    for name in ("a.png", "a.npy"):
        export.save(tmp_path / name, pixels)
    assert np.asarray(Image.open(tmp_path / "a.png"))[:, 0, 0].tolist() == [255, 0, 0, 0]
    assert np.load(tmp_path / "a.npy")[:, 0, 0].tolist() == [1, 0, 0, 0]


@pytest.mark.parametrize("suffix", export.WRITERS)
def test_a_failed_write_leaves_the_old_file_and_nothing_else(
    tmp_path: Path, suffix: str, monkeypatch: pytest.MonkeyPatch
):
    path = tmp_path / f"a{suffix}"
    path.write_bytes(b"old")

    def half(part: Path, pixels: np.ndarray, note: str) -> None:
        part.write_bytes(b"half")
        raise OSError(28, "No space left on device")

    monkeypatch.setitem(export.WRITERS, suffix, half)
    with pytest.raises(OutputError, match="no space left on device"):
        export.save(path, PIXELS)
    assert [p.name for p in tmp_path.iterdir()] == [path.name] and path.read_bytes() == b"old"


def test_an_interrupted_write_leaves_nothing(tmp_path: Path):
    def interrupted(part: Path) -> None:
        part.write_bytes(b"half")
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        export.write_whole(tmp_path / "a.bin", interrupted)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("name", "words"),
    [("folder.png", "it is a folder"), ("missing/a.png", "no folder"), ("x" * 300 + ".png", "name too long"),
     ("nul\0.png", "cannot write"), ("loop.png", "cannot write"), ("pipe.png", "not a regular file")],
)  # fmt: skip
def test_what_cannot_be_written_is_said_before_rendering(tmp_path: Path, name: str, words: str):
    (tmp_path / "folder.png").mkdir()
    (tmp_path / "loop.png").symlink_to(tmp_path / "loop.png")
    os.mkfifo(tmp_path / "pipe.png")
    before = sorted(p.name for p in tmp_path.iterdir())
    for call in (export.check_writable, lambda path: export.save(path, PIXELS)):
        with pytest.raises(OutputError, match=words):
            call(tmp_path / name)
    assert sorted(p.name for p in tmp_path.iterdir()) == before


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may write anywhere")
def test_a_read_only_file_or_folder_is_refused(tmp_path: Path):
    (tmp_path / "a.png").write_bytes(b"old")
    (tmp_path / "a.png").chmod(0o444)
    (tmp_path / "shut").mkdir(mode=0o555)
    for path in (tmp_path / "a.png", tmp_path / "shut" / "a.png"):
        with pytest.raises(OutputError):
            export.check_writable(path)


def test_an_unknown_suffix_is_refused(tmp_path: Path):
    for name in ("a.gif", "a", ".png"):
        with pytest.raises(InputError, match=r"accepted: \.png, \.exr, \.npy"):
            export.check_writable(tmp_path / name)


def test_a_link_is_followed_and_rights_are_ordinary(tmp_path: Path):
    (tmp_path / "real.png").write_bytes(b"old")
    (tmp_path / "link.png").symlink_to("real.png")
    export.save(tmp_path / "link.png", PIXELS)
    assert (tmp_path / "link.png").is_symlink() and (tmp_path / "real.png").stat().st_size > 10
    (tmp_path / "plain").write_bytes(b"")
    assert stat.S_IMODE((tmp_path / "real.png").stat().st_mode) == stat.S_IMODE((tmp_path / "plain").stat().st_mode)
