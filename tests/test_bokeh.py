"""Aperture pictures: built-in shapes, files of all kinds, and what is refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from dofview import bokeh
from dofview.errors import InputError
from dofview.lens import Lens


def moments(aperture: bokeh.Aperture) -> tuple[np.ndarray, np.ndarray]:
    """Centroid (x, y) and covariance (2, 2) in lens radii."""
    size = len(aperture.weights)
    along = ((np.arange(size) + 0.5) * 2.0 / size - 1.0) * aperture.extent
    x, y = np.broadcast_arrays(along[None, :], -along[:, None])
    points = np.stack([x.ravel(), y.ravel()])
    center = points @ aperture.weights.ravel()
    offsets = points - center[:, None]
    return center, (offsets * aperture.weights.ravel()) @ offsets.T


def save(path: Path, array: np.ndarray, **options) -> Path:
    Image.fromarray(array).save(path, **options)
    return path


def ramp(size: int = 64) -> np.ndarray:
    """Unlike its mirror images: bright at the top right."""
    x, y = np.meshgrid(np.linspace(0, 1, size), np.linspace(1, 0, size))
    return np.round(255 * x * y**2).astype(np.uint8)


@pytest.mark.parametrize("name", bokeh.SHAPES)
def test_built_in_shapes(name: str) -> None:
    aperture = bokeh.load(name)
    assert aperture.weights.shape == (256, 256) and aperture.weights.dtype == np.float64
    assert aperture.weights.sum() == pytest.approx(1.0, abs=1e-12) and aperture.weights.min() >= 0.0
    center, _ = moments(aperture)
    assert np.abs(center).max() < 1e-3, "a shape must not shift what it blurs"
    along = (np.arange(256) + 0.5) / 128 - 1
    beyond = np.hypot(along[None, :], along[:, None]) > 1.0 + 1.5 / 128
    assert not aperture.weights[beyond].any()


def test_shapes_have_their_analytic_spread() -> None:
    for name, variance in {
        "disc": 1 / 4,
        "ring": (1 - (2 / 3) ** 4) / (1 - (2 / 3) ** 2) / 4,
        **{n: (2 + np.cos(2 * np.pi / b)) / 12 for n, b in {"triangle": 3, "square": 4, "hexagon": 6}.items()},
    }.items():
        np.testing.assert_allclose(moments(bokeh.load(name))[1], np.eye(2) * variance, atol=1e-3, err_msg=name)


def test_shapes_stand_upright() -> None:
    heart, triangle = bokeh.load("heart").weights, bokeh.load("triangle").weights
    lobes, tip = heart[50], heart[235]
    assert np.count_nonzero(lobes) > 2 * np.count_nonzero(tip) > 0
    assert lobes[128] == 0.0 < lobes[70], "there is a notch between the lobes"
    assert triangle[:128].sum() < triangle[128:].sum(), "the corner of the triangle is up"


@pytest.mark.parametrize("distribution", ["uniform_disc", "gaussian", "polygon", "image"])
def test_the_drawn_lens_is_what_the_reference_samples(distribution: str) -> None:
    from dofview.sampling import lens_samples

    lens = Lens(radius=3.0, distribution=distribution, gaussian_sigma=1.2, blades=5, rotation_deg=40.0, image="heart")
    aperture = bokeh.of_lens(lens)
    points = lens_samples(lens, 1 << 14, progressive=True)
    center, covariance = moments(aperture)
    np.testing.assert_allclose(points.mean(axis=0), center, atol=2e-3)
    np.testing.assert_allclose(np.cov(points.T), covariance, atol=2e-3)


def test_a_file_is_read_as_it_is(tmp_path: Path) -> None:
    values = ramp()
    aperture = bokeh.load(save(tmp_path / "ramp.png", values))
    np.testing.assert_allclose(aperture.weights, values / values.sum(dtype=float), atol=1e-15)
    assert bokeh.load(str(tmp_path / "ramp.png")) is aperture


def test_all_kinds_of_pixels_mean_the_same(tmp_path: Path) -> None:
    grey = ramp()
    expected = grey / grey.sum(dtype=float)
    white = np.full_like(grey, 255)
    kinds = {
        "16 bit": grey.astype(np.uint16) * 257,
        "dark 16 bit": grey.astype(np.uint16),
        "rgb": np.dstack([grey] * 3),
        "alpha": np.dstack([white, white, white, grey]),
        "grey and alpha": np.dstack([white, grey]),
    }
    for name, pixels in kinds.items():
        weights = bokeh.load(save(tmp_path / f"{name}.png", pixels)).weights
        np.testing.assert_allclose(weights, expected, atol=1e-12, err_msg=name)
    bilevel = save(tmp_path / "bilevel.png", grey > 100)
    np.testing.assert_allclose(bokeh.load(bilevel).weights, (grey > 100) / (grey > 100).sum(), atol=1e-15)
    Image.fromarray(np.dstack([grey] * 3)).quantize(256).save(tmp_path / "palette.png")
    np.testing.assert_allclose(bokeh.load(tmp_path / "palette.png").weights, expected, atol=2e-6)
    for suffix, options in {"bmp": {}, "webp": {"lossless": True}, "jpg": {"quality": 100}, "tga": {}}.items():
        weights = bokeh.load(save(tmp_path / f"p.{suffix}", np.dstack([grey] * 3), **options)).weights
        np.testing.assert_allclose(weights, expected, atol=2e-5, err_msg=suffix)


def test_brightness_does_not_matter(tmp_path: Path) -> None:
    bright = bokeh.load(save(tmp_path / "bright.png", ramp().astype(np.uint16) * 250)).weights
    dark = bokeh.load(save(tmp_path / "dark.png", ramp().astype(np.uint16) * 25)).weights
    np.testing.assert_allclose(dark, bright, atol=1e-15)


def test_a_long_picture_keeps_its_shape(tmp_path: Path) -> None:
    aperture = bokeh.load(save(tmp_path / "bar.png", np.full((10, 40), 200, np.uint8)))
    _, covariance = moments(aperture)
    np.testing.assert_allclose(covariance, np.diag([1 / 3, 1 / 48]), atol=1e-3)


def test_a_large_picture_is_reduced_and_the_same(tmp_path: Path) -> None:
    large = np.kron(ramp(100), np.ones((25, 25), np.uint8))
    reduced = bokeh.load(save(tmp_path / "large.png", large))
    assert max(reduced.weights.shape) <= bokeh.LARGEST
    small = bokeh.load(save(tmp_path / "small.png", ramp(100)))
    np.testing.assert_allclose(moments(reduced)[0], moments(small)[0], atol=2e-3)


def test_a_changed_file_is_read_again(tmp_path: Path) -> None:
    path = save(tmp_path / "p.png", np.full((4, 4), 255, np.uint8))
    assert bokeh.load(path).weights.shape == (4, 4)
    save(path, np.full((6, 6), 255, np.uint8))
    assert bokeh.load(path).weights.shape == (6, 6)


def test_black_and_clear_are_refused(tmp_path: Path) -> None:
    black = save(tmp_path / "black.png", np.zeros((8, 8), np.uint8))
    clear = save(tmp_path / "clear.png", np.dstack([np.full((8, 8, 3), 255, np.uint8), np.zeros((8, 8), np.uint8)]))
    for path in (black, clear):
        with pytest.raises(InputError, match="lets no light through; accepted"):
            bokeh.load(path)


def bomb() -> bytes:
    """A valid header that claims 60000 × 60000 pixels."""
    import struct
    import zlib

    def chunk(kind: bytes, body: bytes) -> bytes:
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    header = struct.pack(">IIBBBBB", 60000, 60000, 8, 0, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(b"")) + chunk(b"IEND", b"")


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "no accepted picture format"),
        (b"hello, this is text", "no accepted picture format"),
        (b"%!PS-Adobe-3.0 EPSF-3.0\n%%BoundingBox: 0 0 9 9\n", "no accepted picture format"),
        (b"\x89PNG\r\n\x1a\n" + b"\0" * 50, "not a readable picture"),
        (bomb(), "pixels; accepted: up to"),
    ],
    ids=["empty", "text", "postscript", "broken", "bomb"],
)
def test_what_is_no_picture_is_refused(tmp_path: Path, content: bytes, message: str) -> None:
    path = tmp_path / "p.png"
    path.write_bytes(content)
    with pytest.raises(InputError, match=message) as caught:
        bokeh.load(path)
    assert "p.png" in str(caught.value) and "\n" not in str(caught.value)


@pytest.mark.parametrize("name", [None, "", "no such file", "a\0b", "x" * 5000, "new\nline", "."])
def test_what_is_no_file_is_refused(name: str | None) -> None:
    with pytest.raises(InputError) as caught:
        bokeh.load(name)
    assert "\n" not in str(caught.value)


def test_a_cut_off_file_is_refused(tmp_path: Path) -> None:
    path = save(tmp_path / "p.png", np.random.default_rng(0).integers(0, 255, (64, 64), dtype=np.uint8))
    path.write_bytes(path.read_bytes()[:500])
    with pytest.raises(InputError, match="not a readable picture"):
        bokeh.load(path)
