"""Environments: read as they are stored, blurred without gain, and seen by every way of drawing."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scenes import quad, scene_of

from dofview.errors import InputError
from dofview.gl.context import Gpu
from dofview.pipeline import Pipeline
from dofview.render.environment import HEIGHT, LEVELS, Environment, Lighting, read, studio
from dofview.scene.camera import Camera
from dofview.scene.model import Material
from dofview.settings import ImageSettings, Settings, apply_view


def rgbe(pixels: np.ndarray) -> np.ndarray:
    """(h, w, 3) to Radiance's four bytes, (h, w, 4)."""
    exponent = np.ceil(np.log2(pixels.max(axis=-1, keepdims=True)) + 1e-9)
    mantissa = np.floor(pixels * 2.0 ** (8.0 - exponent))
    return np.concatenate([mantissa, exponent + 128], axis=-1).astype(np.uint8)


def run_length(row: np.ndarray) -> bytes:
    """One scanline (w, 4) in the new coding: runs of 3 where values repeat, else single values."""
    coded = bytes([2, 2, len(row) >> 8, len(row) & 255])
    for channel in row.T:
        at = 0
        while at < len(channel):
            run = 3 if at + 3 <= len(channel) and len(set(channel[at : at + 3])) == 1 else 1
            coded += bytes([131, channel[at]]) if run == 3 else bytes([1, channel[at]])
            at += run
    return coded


def write_hdr(path: Path, pixels: np.ndarray, flat: bool) -> Path:
    texels = rgbe(pixels)
    head = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n" + f"-Y {len(pixels)} +X {pixels.shape[1]}\n".encode()
    path.write_bytes(head + (texels.tobytes() if flat else b"".join(run_length(row) for row in texels)))
    return path


@pytest.mark.parametrize("flat", [True, False])
def test_a_radiance_picture_is_read_as_it_was_written(tmp_path: Path, flat: bool):
    pixels = np.random.default_rng(3).uniform(0.25, 40.0, (6, 16, 3)).repeat(2, axis=1)
    found = read(write_hdr(tmp_path / "a.hdr", pixels, flat))
    assert np.abs(found - pixels).max() <= pixels.max() / 128.0 and np.abs(found / pixels - 1.0).mean() < 0.02


def test_an_exr_picture_is_read_as_it_was_written(tmp_path: Path):
    from dofview.export import save

    pixels = np.random.default_rng(4).uniform(0.0, 9.0, (8, 16, 3)).astype(np.float32)
    save(tmp_path / "a.exr", pixels)
    assert np.array_equal(read(tmp_path / "a.exr"), pixels)


@pytest.mark.parametrize(
    "name, content",
    [
        ("none.hdr", None),
        ("empty.hdr", b""),
        ("cut.hdr", b"#?RADIANCE\n\n-Y 4 +X 8\n\2\2\0\10\205"),
        ("wide.hdr", b"#?RADIANCE\n\n-Y 1 +X 8\n\2\2\0\10" + bytes([255, 1])),
        ("huge.hdr", b"#?RADIANCE\n\n-Y 99999 +X 99999\n"),
        ("not.exr", b"v/1\1 but no more"),
        ("not.png", b"\x89PNG\r\n\x1a\n"),
    ],
)
def test_a_bad_picture_is_refused_in_one_line(tmp_path: Path, name: str, content: bytes | None):
    if content is not None:
        (tmp_path / name).write_bytes(content)
    with pytest.raises(InputError) as refused:
        read(tmp_path / name)
    assert name in str(refused.value) and "\n" not in str(refused.value)


def test_blurring_keeps_a_constant_and_darkens_towards_the_far_side(gpu: Gpu):
    half = np.full((32, 64, 3), 0.75, np.float32)
    half[16:] = 0.0
    for pixels, top in ((np.full((4, 8, 3), 3.5, np.float32), 3.5), (half, 0.75)):
        environment = Environment(gpu, pixels)
        for level in range(LEVELS):
            size = (2 * HEIGHT >> level, HEIGHT >> level)
            texels = np.frombuffer(environment.texture.read(level=level, alignment=1), np.float16)
            texels = texels.reshape(size[1], size[0], 4)[..., :3].astype(np.float32)
            if top == 3.5:
                assert np.abs(texels - 3.5).max() < 0.01
            else:
                # Row 0 looks down, into the dark half; the levels fade into each other more and more.
                assert texels[-1].min() > 0.6 and texels[0].max() < 0.15
                assert np.all(np.diff(texels.mean(axis=(1, 2))) >= -5e-3)
        environment.release()


def settings_lit_by(environment: str) -> Settings:
    return Settings(
        camera=Camera(position=(0.0, 0.0, 5.0)), method="pinhole", light=Lighting(environment=environment),
        image=ImageSettings(size=(32, 24)),
    )  # fmt: skip


def test_a_wall_shows_the_light_it_faces(gpu: Gpu, tmp_path: Path):
    """White light from +z (the edges of the picture), none from elsewhere: a matt wall facing it is lit, others not."""
    pixels = np.full((32, 64, 3), 2.0**-7)
    pixels[8:24, :12] = pixels[8:24, -12:] = 2.0
    path = write_hdr(tmp_path / "front.hdr", pixels, True)
    matt = Material(name="matt", base_color=(0.8, 0.8, 0.8, 1.0), roughness=1.0, double_sided=True)
    pipeline = Pipeline(gpu, scene_of([quad((0, 0, 0), (9, 9))], [matt]))
    lit = pipeline.render(settings_lit_by(str(path))).pixels()[12, 16]
    turned = settings_lit_by(str(path)).with_(camera=Camera(position=(0.0, 0.0, -5.0)))
    behind = pipeline.render(turned).pixels()[12, 16]
    pipeline.release()
    assert lit.min() > 0.5 and behind.max() < 0.2


def test_every_way_of_drawing_sees_the_environment(gpu: Gpu):
    shiny = Material(name="shiny", base_color=(0.9, 0.9, 0.9, 1.0), metallic=1.0, roughness=0.1, double_sided=True)
    pipeline = Pipeline(gpu, scene_of([quad((0, 0, 0), (9, 9))], [shiny]))
    pictures = []
    for name in ("pinhole", "accumulation", "multiview"):
        settings = settings_lit_by("studio").with_(method=name)
        settings = settings.with_params(views=2) if name == "accumulation" else settings
        pictures.append(pipeline.render(settings).pixels())
    plain = pipeline.render(settings_lit_by("sky")).pixels()
    pipeline.release()
    assert np.abs(pictures[0] - plain).max() > 0.1
    assert np.abs(pictures[0] - pictures[1]).max() < 1e-3 and np.abs(pictures[0] - pictures[2]).max() < 1e-3


def test_a_changed_file_is_loaded_again_and_the_reference_begins_anew(gpu: Gpu, tmp_path: Path):
    path = write_hdr(tmp_path / "a.hdr", np.full((4, 8, 3), 0.5), True)
    pipeline = Pipeline(gpu, scene_of([quad((0, 0, 0), (9, 9))], [Material(name="m", double_sided=True)]))
    first = pipeline.render(settings_lit_by(str(path))).pixels()
    reference = pipeline.reference(settings_lit_by(str(path)))
    assert pipeline.reference(settings_lit_by(str(path))) is reference
    write_hdr(path, np.full((5, 8, 3), 2.0), True)
    assert pipeline.reference(settings_lit_by(str(path))) is not reference
    assert np.allclose(pipeline.render(settings_lit_by(str(path))).pixels(), 4.0 * first, rtol=0.02)
    pipeline.release()


def test_a_view_file_names_it_beside_itself(tmp_path: Path):
    (tmp_path / "room.hdr").write_bytes(b"")
    view = {"light": {"environment": "room.hdr"}}
    assert apply_view(Settings(), view, "v.json", tmp_path).light.environment == str(tmp_path / "room.hdr")
    assert apply_view(Settings(), {"light": {"environment": "studio"}}, "v", tmp_path).light.environment == "studio"


def test_the_studio_is_bright_enough_to_see_by():
    room = studio(64)
    assert room.shape == (64, 128, 3) and 0.3 < room.mean() < 1.5 and room.max() > 4.0
