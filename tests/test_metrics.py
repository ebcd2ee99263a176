"""PSNR, SSIM, FLIP and the zones of blur, against values computed by hand or by definition."""

from __future__ import annotations

import builtins
import math

import numpy as np
import pytest

from dofview.errors import InputError
from dofview.metrics import blur_zones, flip, psnr, srgb_decode, srgb_encode, ssim


def noise(height: int = 40, width: int = 50, seed: int = 0) -> np.ndarray:
    return np.random.default_rng(seed).random((height, width, 3))


def test_srgb_at_known_values() -> None:
    linear = [0.0, 0.0031308, 0.21404114, 0.5, 1.0]
    encoded = [0.0, 0.04044994, 0.5, 0.73535698, 1.0]
    np.testing.assert_allclose(srgb_encode(np.array(linear)), encoded, atol=1e-7)
    np.testing.assert_allclose(srgb_decode(np.array(encoded)), linear, atol=1e-7)
    np.testing.assert_allclose(srgb_encode(np.array([-1.0, 7.0, math.inf])), [0.0, 1.0, 1.0], atol=1e-15)


def test_srgb_there_and_back() -> None:
    levels = np.arange(256) / 255
    np.testing.assert_allclose(srgb_encode(srgb_decode(levels)), levels, atol=1e-12)


def test_psnr_of_a_known_difference() -> None:
    first = srgb_decode(np.full((4, 5, 3), 0.5))
    second = first.copy()
    second[..., 0] = srgb_decode(np.array(0.6))  # one channel of three off by 0.1
    assert psnr(second, first) == pytest.approx(-10 * math.log10(0.01 / 3))
    assert psnr(first.astype(np.float32), first.astype(np.float32)) == math.inf


def test_psnr_sees_what_is_shown() -> None:
    """Values beyond white are equal on a screen; a nan is not passed over."""
    bright = np.full((3, 3, 3), 2.0)
    assert psnr(bright, bright * 4) == math.inf
    bright[1, 1, 1] = math.nan
    assert math.isnan(psnr(bright, np.full((3, 3, 3), 2.0)))


def test_psnr_in_a_mask() -> None:
    first, second = np.zeros((4, 4, 3)), np.zeros((4, 4, 3))
    second[0] = 1.0
    mask = np.zeros((4, 4), bool)
    mask[:2] = True
    assert psnr(second, first, mask) == pytest.approx(-10 * math.log10(0.5))
    assert psnr(second, first, ~mask) == math.inf
    assert math.isnan(psnr(second, first, np.zeros((4, 4), bool)))


def test_shapes_must_agree() -> None:
    with pytest.raises(ValueError, match="accepted"):
        psnr(noise(4, 4), noise(4, 5))


def test_ssim() -> None:
    picture = noise()
    assert ssim(picture, picture) == pytest.approx(1.0)
    grey = np.full_like(picture, 0.3)
    luminance = (2 * 0.2 * 0.4 + 1e-4) / (0.2**2 + 0.4**2 + 1e-4)
    flat = [srgb_decode(np.full((30, 30, 3), v)) for v in (0.2, 0.4)]
    assert ssim(*flat) == pytest.approx(luminance, abs=1e-6), "flat pictures differ by the luminance term alone"
    assert ssim(picture, grey) < 0.1
    mask = np.zeros(picture.shape[:2], bool)
    mask[:, :20] = True
    half = picture.copy()
    half[:, 32:] = 0.3
    assert ssim(half, picture, mask) == pytest.approx(1.0) and ssim(half, picture, ~mask) < 0.7


@pytest.mark.parametrize("size", [(1, 1), (1, 300), (7, 12), (10, 10)])
def test_ssim_of_tiny_pictures(size: tuple[int, int]) -> None:
    picture = noise(*size)
    assert ssim(picture, picture) == pytest.approx(1.0)
    assert ssim(picture, 1 - picture) < 1.0


def test_flip() -> None:
    pytest.importorskip("flip_evaluator")
    picture = noise()
    assert flip(picture, picture) == 0.0
    assert 0.9 < flip(np.zeros((20, 20, 3)), np.ones((20, 20, 3))) <= 1.0
    mask = np.zeros(picture.shape[:2], bool)
    mask[:, :10] = True
    half = picture.copy()
    half[:, 30:] = 0.0
    assert flip(half, picture, mask) < 0.01 < 0.3 < flip(half, picture, ~mask)


def test_flip_says_how_to_get_it(monkeypatch: pytest.MonkeyPatch) -> None:
    real = builtins.__import__

    def without(name, *arguments, **options):
        if name == "flip_evaluator":
            raise ImportError(name)
        return real(name, *arguments, **options)

    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(InputError, match="pip install"):
        flip(noise(), noise())


def test_blur_zones_against_their_definition() -> None:
    rng = np.random.default_rng(3)
    coc = rng.uniform(-1.3, 3.0, (24, 31))
    coc[5, 7], coc[20, 28], coc[12, 0] = -6.4, -1.0, -3.0
    zones = blur_zones(coc)
    rows, columns = np.mgrid[: coc.shape[0], : coc.shape[1]]
    foreground = np.zeros(coc.shape, bool)
    for row, column in np.argwhere(coc <= -1.0):
        foreground |= np.hypot(rows - row, columns - column) <= -coc[row, column]
    np.testing.assert_array_equal(zones.foreground, foreground)
    np.testing.assert_array_equal(zones.focus, ~foreground & (np.abs(coc) < 1.0))
    assert (zones.focus.astype(int) + zones.foreground + zones.background == 1).all()


def test_zones_of_a_sharp_picture() -> None:
    zones = blur_zones(np.zeros((3, 3)))
    assert zones.focus.all() and not zones.foreground.any() and not zones.background.any()
