"""Settings inside pictures and presets: what goes out comes back, and what is wrong is named."""

from __future__ import annotations

import math

import numpy as np
import pytest
from PIL import Image

from dofview import export
from dofview.cli import main
from dofview.errors import InputError, SettingsError
from dofview.gl.compose import Part
from dofview.lens import Distribution, Lens
from dofview.remember import note, read_note, read_preset, write_preset
from dofview.seen.model import Arrangement, Seen
from dofview.settings import ImageSettings, Settings

ODD = Settings(
    lens=Lens(radius=0.123, focus_distance=math.inf, distribution=Distribution.POLYGON, blades=7, rotation_deg=-12.5),
    method="mipmap", image=ImageSettings(size=(33, 21), scale=1.5, guard_px=3), background_linear=(0.1, 0.2, 0.3),
).with_params(delta=1.25)  # fmt: skip
COMPARED = Seen(
    arrangement=Arrangement.WIPE, other="pinhole", split=0.3, part=Part(0.1, 0.2, 0.3, 0.3), error_map=True,
    in_focus=True,
)  # fmt: skip


@pytest.mark.parametrize("suffix", [".png", ".exr"])
def test_a_picture_remembers_its_settings(tmp_path, suffix):
    path = tmp_path / f"shot{suffix}"
    pixels = np.random.default_rng(0).random((21, 33, 3), dtype=np.float32)
    export.save(path, pixels, note("scène.glb", ODD))
    assert read_note(path) == ("scène.glb", ODD, None)
    export.save(path, pixels, note("scène.glb", ODD, COMPARED))
    assert read_note(path) == ("scène.glb", ODD, COMPARED)


def test_the_parts_of_an_exr_are_all_there(tmp_path):
    import OpenEXR

    path = tmp_path / "parts.exr"
    parts = {"color": np.ones((4, 5, 3), np.float32), "coc": np.full((4, 5), -2.5, np.float32)}
    export.save_parts(path, parts, note("x", ODD))
    with OpenEXR.File(str(path)) as file:
        assert [part.name() for part in file.parts] == ["color", "coc"]
        assert (file.parts[1].channels["Y"].pixels == -2.5).all()
    assert read_note(path).settings == ODD
    with pytest.raises(InputError, match="ends in .exr"):
        export.save_parts(tmp_path / "parts.png", parts)


def test_a_picture_of_another_program_is_refused(tmp_path):
    Image.new("RGB", (2, 2)).save(tmp_path / "plain.png")
    (tmp_path / "text.png").write_text("no picture")
    for name in ("plain.png", "text.png", "missing.png"):
        with pytest.raises(InputError, match=name):
            read_note(tmp_path / name)


def test_render_like_makes_the_same_picture_again(tmp_path):
    first, again = tmp_path / "first.npy", tmp_path / "again.npy"
    shot = tmp_path / "shot.png"
    view = ["demo:crossing", "--size", "48x36", "--method", "mipmap", "--delta", "0.9", "--focus", "4.5"]
    assert main(["render", *view, "-o", str(shot)]) == 0
    assert main(["render", *view, "-o", str(first)]) == 0
    assert main(["render", "--like", str(shot), "-o", str(again)]) == 0
    assert np.array_equal(np.load(first), np.load(again))
    assert main(["render", "-o", str(again)]) == 2


def test_a_preset_comes_back(tmp_path):
    path = tmp_path / "soft.toml"
    write_preset(path, ODD)
    settings, complaints = read_preset(path, Settings())
    assert not complaints
    assert settings.lens == ODD.lens and settings.params == ODD.params and settings.method == "mipmap"
    assert settings.image.scale == 1.5 and settings.image.size == Settings().image.size, "not the size of the window"


def test_bad_values_of_a_preset_are_named_and_the_rest_is_kept(tmp_path):
    path = tmp_path / "bad.toml"
    path.write_text(
        'method = "nonsense"\nshell = "rm"\n[lens]\nradius = 0.5\nblades = 900\ncolour = 1\n'
        "[params.mipmap]\ndelta = nan\nanisotropic = false\n[params.unknown]\nx = 1\n"
    )
    settings, complaints = read_preset(path, ODD)
    assert settings.lens.radius == 0.5 and settings.lens.blades == ODD.lens.blades
    assert settings.params.mipmap.anisotropic is False and settings.params.mipmap.delta == 1.25
    assert settings.method == ODD.method
    for word in ("nonsense", "shell", "blades", "colour", "delta", "unknown"):
        assert any(word in complaint for complaint in complaints), word
    for text in ("[lens", "\x00"):
        path.write_text(text)
        with pytest.raises(SettingsError, match=r"bad\.toml: not a TOML preset"):
            read_preset(path, ODD)


def test_what_is_seen_is_rendered_and_made_again_from_its_picture(tmp_path, capfd):
    seen, again, alone = (tmp_path / f"{name}.png" for name in ("seen", "again", "alone"))
    picture = ["render", "demo:crossing", "--size", "96x64", "--method", "pinhole"]
    assert main([*picture, "-o", str(alone)]) == 0
    assert main([*picture, "--beside", "mipmap", "--wipe", "0.25", "--in-focus", "-o", str(seen)]) == 0
    remembered = read_note(seen).seen
    assert remembered is not None and read_note(alone).seen is None
    assert (remembered.other, remembered.split, remembered.in_focus) == ("mipmap", 0.25, True)
    assert main(["render", "--like", str(seen), "-o", str(again)]) == 0
    pixels = [np.asarray(Image.open(path)).astype(int) for path in (seen, again, alone)]
    assert (pixels[0] == pixels[1]).all() and np.abs(pixels[0] - pixels[2])[:, 28:].mean() > 2.0
    assert main([*picture, "--error-map", "signed", "--gain", "8", "-o", str(tmp_path / "map.exr")]) == 0
    capfd.readouterr()
    for wrong, words in (
        (["--gain", "3"], "with --error-map"),
        (["--grid", "--wipe", "0.3"], "--grid, or --beside"),
        (["--beside", "nobody"], "accepted: pinhole"),
        (["--wipe", "2"], "wipe is '2'"),
        (["--error-map", "none"], "absolute, squared"),
    ):
        assert main([*picture, *wrong, "-o", str(tmp_path / "no.png")]) == 2
        said = capfd.readouterr().err
        assert words in said and said.count("\n") == 1, said
    assert not (tmp_path / "no.png").exists()
