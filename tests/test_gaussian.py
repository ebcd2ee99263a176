"""Gaussian filters by their impulse responses."""

from __future__ import annotations

import math

import numpy as np
import pytest

from dofview.gl.context import Gpu
from dofview.gl.gaussian import COARSE_SIGMA, blur, kernel, level_for, paired
from dofview.gl.targets import Image
from dofview.metrics import psnr

SIGMAS = [0.2, 0.4, 0.7, 1.0, 1.7, 3.0, 4.5, 8.0]


def impulse(gpu: Gpu, size: tuple[int, int], at: tuple[int, int]) -> Image:
    """One texel of 1, `at` (x, y) from the top left."""
    image = gpu.targets.image("test/impulse", size, linear=True)
    pixels = np.zeros((size[1], size[0], 4), np.float32)
    pixels[at[1], at[0]] = 1.0
    image.write(pixels)
    return image


def moments(image: Image) -> tuple[float, np.ndarray, np.ndarray]:
    """Sum, mean place (x, y) from the top left in px and variance per axis of the first component."""
    values = image.pixels()[..., 0].astype(float)
    total = values.sum()
    y, x = np.mgrid[: values.shape[0], : values.shape[1]]
    mean = np.array([(values * x).sum(), (values * y).sum()]) / total
    variance = np.array([(values * (x - mean[0]) ** 2).sum(), (values * (y - mean[1]) ** 2).sum()]) / total
    return float(total), mean, variance


def noise(size: tuple[int, int], seed: int = 0) -> np.ndarray:
    """A picture whose spectrum falls as photographs' do, with hard edges in it, linear in 0…1."""
    generator = np.random.default_rng(seed)
    spectrum = np.fft.rfft2(generator.standard_normal((size[1], size[0], 4)), axes=(0, 1))
    fy, fx = np.fft.fftfreq(size[1])[:, None], np.fft.rfftfreq(size[0])[None]
    spectrum /= np.hypot(fx, fy)[..., None] + 1.0 / max(size)
    picture = np.fft.irfft2(spectrum, s=(size[1], size[0]), axes=(0, 1))
    picture = 0.5 + 0.2 * picture / picture.std()
    picture[size[1] // 3 : size[1] // 2, size[0] // 4 : size[0] // 2] = 1.0
    return picture.clip(0.0, 1.0).astype(np.float32)


@pytest.mark.parametrize("sigma", SIGMAS)
def test_a_kernel_has_the_variance_it_was_asked_for(sigma: float):
    weights = np.array(kernel(sigma))
    twice = np.where(np.arange(len(weights)) > 0, 2.0, 1.0)
    assert (weights * twice).sum() == pytest.approx(1.0, abs=1e-12)
    assert (weights * twice * np.arange(len(weights)) ** 2).sum() == pytest.approx(sigma * sigma, rel=1e-6)
    assert len(weights) - 1 == max(math.ceil(3.0 * sigma), 1)


@pytest.mark.parametrize("sigma", [-0.05, -0.3, -0.55])
def test_a_kernel_can_take_variance_away(sigma: float):
    middle, beside = kernel(sigma)
    assert middle + 2.0 * beside == pytest.approx(1.0) and 2.0 * beside == pytest.approx(-sigma * sigma)


def test_bilinear_taps_are_the_same_kernel():
    weights = kernel(2.3)
    spread = np.zeros(len(weights) + 1)
    for distance, weight in paired(weights):
        below = int(distance)
        spread[below] += weight * (below + 1 - distance)
        spread[below + 1] += weight * (distance - below)
    assert np.allclose(spread[: len(weights)], weights, atol=1e-12) and spread[-1] == 0.0


@pytest.mark.parametrize("sigma", SIGMAS)
@pytest.mark.parametrize("bilinear", [False, True])
@pytest.mark.parametrize("coarse_sigma", [0.0, 4.0, 2.5])
@pytest.mark.parametrize("size", [(129, 97), (96, 131)])
def test_impulse_response(gpu: Gpu, sigma: float, bilinear: bool, coarse_sigma: float, size: tuple[int, int]):
    """Sum 1, σ as asked and no shift, at odd sizes too and wherever the impulse falls on the coarse grid."""
    for at in ((61, 47), (58, 50)):
        blurred = blur(gpu, impulse(gpu, size, at), "test/blur", sigma, bilinear=bilinear, coarse_sigma=coarse_sigma)
        total, mean, variance = moments(blurred)
        assert blurred.size == size
        assert total == pytest.approx(1.0, abs=2e-3)
        assert np.abs(mean - at).max() < 2e-3
        assert np.abs(np.sqrt(variance) / sigma - 1.0).max() < 3e-3


@pytest.mark.parametrize("sigma", [2.5, 4.0, 6.0, 9.0, 16.0])
def test_blur_at_reduced_size_is_as_good_as_equal(gpu: Gpu, sigma: float):
    """59 dB is where 8-bit pictures end. Along the border, where texels are repeated, the coarse level repeats wider
    ones: a picture that matters up to its edge has a guard band."""
    source = gpu.targets.image("test/picture", (255, 191), linear=True)
    source.write(noise(source.size))
    full = blur(gpu, source, "test/full", sigma, coarse_sigma=0.0).pixels()[..., :3]
    coarse = blur(gpu, source, "test/coarse", sigma).pixels()[..., :3]
    border = math.ceil(2.5 * sigma)
    inner = np.s_[border:-border, border:-border]
    assert level_for(sigma, COARSE_SIGMA) >= 1
    assert psnr(coarse[inner], full[inner]) >= 65.0
    assert psnr(coarse, full) >= 44.0


def test_blur_is_the_gaussian(gpu: Gpu):
    from scipy.ndimage import gaussian_filter

    source = gpu.targets.image("test/picture", (150, 110), linear=True)
    picture = noise(source.size)
    source.write(picture)
    for sigma in (1.0, 2.5, 6.0):
        exact = gaussian_filter(picture, (sigma, sigma, 0), mode="nearest", truncate=8.0)
        blurred = blur(gpu, source, "test/blur", sigma).pixels()
        assert psnr(blurred[16:-16, 16:-16, :3], exact[16:-16, 16:-16, :3]) >= 65.0


@pytest.mark.parametrize("size", [(1, 1), (1, 33), (7, 5), (64, 48)])
@pytest.mark.parametrize("sigma", [0.3, 5.0, 40.0])
def test_a_constant_stays(gpu: Gpu, size: tuple[int, int], sigma: float):
    source = gpu.targets.image("test/constant", size, linear=True)
    source.write(np.full((size[1], size[0], 4), 0.7, np.float32))
    assert np.abs(blur(gpu, source, "test/blur", sigma).pixels() - 0.7).max() < 1e-5
