"""Pull-push: what is known stays, what is not is filled from around it, at every size."""

from __future__ import annotations

import numpy as np
import pytest

from dofview.gl.context import Gpu
from dofview.gl.pull_push import fill

SIZES = [(64, 48), (61, 47), (1, 37), (40, 1), (1, 1), (2, 3), (129, 5)]


def filled(gpu: Gpu, values: np.ndarray, weights: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Fill one channel (height, width), also carried as the extra value: (height, width, 2) and the weight after."""
    height, width = values.shape
    pair = [gpu.targets.image(f"test/{name}", (width, height), n) for name, n in (("known", 4), ("known extra", 1))]
    premultiplied = (values * weights)[..., None]
    pair[0].write(np.concatenate([premultiplied.repeat(3, axis=2), weights[..., None]], axis=2))
    pair[1].write(premultiplied)
    into = [gpu.targets.image(f"test/{name}", (width, height), n) for name, n in (("full", 4), ("full extra", 1))]
    fill(gpu, pair[0], pair[1], (into[0], into[1]), "test/fill")
    color, extra = into[0].pixels().astype(np.float64), into[1].pixels()[..., 0].astype(np.float64)
    weight = color[..., 3]
    return np.stack([color[..., 0], extra], axis=2) / np.maximum(weight, 1e-12)[..., None], weight


def some_known(size: tuple[int, int], share: float, seed: int = 0) -> np.ndarray:
    mask = (np.random.default_rng(seed).random((size[1], size[0])) < share).astype(float)
    mask[size[1] // 2, size[0] // 3] = 1.0
    return mask


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("share", [0.0, 0.01, 0.3])
def test_one_colour_fills_with_that_colour(gpu: Gpu, size: tuple[int, int], share: float):
    """Also from a single known pixel (share 0), however far away."""
    after, weight = filled(gpu, np.full((size[1], size[0]), 0.7), some_known(size, share))
    assert np.abs(after - 0.7).max() < 1e-6
    assert np.abs(weight - 1.0).max() < 1e-6


@pytest.mark.parametrize("size", SIZES)
def test_what_is_known_stays_to_the_bit(gpu: Gpu, size: tuple[int, int]):
    values = np.random.default_rng(1).random((size[1], size[0])).astype(np.float32).astype(np.float64)
    known = some_known(size, 0.3)
    after, _ = filled(gpu, values, known)
    assert np.array_equal(after[known > 0.0], np.stack([values, values], axis=2)[known > 0.0])
    low, high = values[known > 0.0].min(), values[known > 0.0].max()
    assert after.min() >= low - 1e-6 and after.max() <= high + 1e-6


@pytest.mark.parametrize("size", SIZES)
def test_where_nothing_is_known_nothing_appears(gpu: Gpu, size: tuple[int, int]):
    after, weight = filled(gpu, np.ones((size[1], size[0])), np.zeros((size[1], size[0])))
    assert not after.any() and not weight.any()


def test_half_known_pixels_are_finite_and_count_by_their_weight(gpu: Gpu):
    """A hole between a surely known 1 and a hardly known 0 becomes nearly 1."""
    values, weights = np.zeros((32, 32)), np.zeros((32, 32))
    values[16, 6], weights[16, 6] = 1.0, 1.0
    values[16, 26], weights[16, 26] = 0.0, 0.02
    after, weight = filled(gpu, values, weights)
    assert np.isfinite(after).all() and weight.min() > 0.99
    assert after[16, 15, 0] > 0.9


def test_a_hole_in_a_ramp_is_bridged_smoothly(gpu: Gpu):
    """A hole 24 px wide: no step inside it is more than a few times the ramp's own, and it joins on both sides."""
    ramp = np.broadcast_to(np.arange(96) / 95.0, (64, 96)).copy()
    known = np.ones_like(ramp)
    known[20:44, 36:60] = 0.0
    after, _ = filled(gpu, ramp, known)
    assert np.abs(np.diff(after[32, :, 0])).max() < 12 / 95.0
    assert np.abs(after[20:44, 36:60, 0] - ramp[20:44, 36:60]).max() < 0.12
