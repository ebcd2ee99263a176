"""Pyramids: their blur measured, nothing moved, at every size."""

from __future__ import annotations

import numpy as np
import pytest
from image_frame import moments

from dofview.gl.context import Gpu
from dofview.gl.pyramids import Analysis, Atlas, blur, expand, level_size, most_levels, pyramid
from dofview.gl.targets import Image


def blurred(gpu: Gpu, pixels: np.ndarray, levels: int, analysis: Analysis) -> np.ndarray:
    """One channel (height, width) reduced and expanded `levels` times."""
    height, width = pixels.shape
    source = gpu.targets.image("test/source", (width, height), linear=True)
    source.write(np.repeat(pixels[..., None], 4, axis=2))
    result: Image = gpu.targets.image("test/blurred", (width, height))
    first = blur(gpu, [source, *pyramid(gpu, "test/level", (width, height), levels)], analysis)
    expand(gpu, first, result)
    return result.pixels()[..., 0].astype(np.float64)


@pytest.mark.parametrize("analysis", Analysis)
@pytest.mark.parametrize("levels", [1, 2, 3, 4])
def test_the_measured_blur_is_the_one_that_is_said(gpu: Gpu, analysis: Analysis, levels: int):
    """Mean over all positions within a coarse texel, with the movement of the boxes counted as blur."""
    period, middle, size = 2**levels, 16 * 2**levels // 4 + 16, 12 * 2**levels + 32
    variances, shifts = [], []
    for x in range(period):
        point = np.zeros((size, size))
        at = np.array([middle + x, middle + (3 * x + 1) % period])
        point[at[1], at[0]] = 1.0
        total, center, variance = moments(blurred(gpu, point, levels, analysis))
        assert total == pytest.approx(1.0, abs=1e-4)
        shifts.append(np.abs(center - at).max())
        variances.append(variance + (center - at) ** 2)
    assert np.sqrt(np.mean(variances)) == pytest.approx(analysis.blur_sigma(levels), rel=0.01)
    if analysis is Analysis.SPLINE:
        assert max(shifts) < 1e-3
        assert np.ptp(np.sqrt(variances)) < 1e-2
    if analysis is Analysis.BOX2 and levels > 1:
        assert max(shifts) > 0.3 * 2 ** (levels - 1)


@pytest.mark.parametrize("analysis", Analysis)
@pytest.mark.parametrize("size", [(97, 61), (64, 48), (1, 90), (7, 5), (1, 1)])
def test_a_constant_stays_and_a_ramp_does_not_move(gpu: Gpu, analysis: Analysis, size: tuple[int, int]):
    width, height = size
    assert np.abs(blurred(gpu, np.full((height, width), 0.7), 3, analysis) - 0.7).max() < 1e-6
    if max(size) > 48:
        axis = int(height > width)
        ramp = np.broadcast_to(np.indices((height, width))[1 - axis] / 100.0, (height, width))
        inner = np.s_[20:-20, :] if axis else np.s_[:, 20:-20]
        assert np.abs(blurred(gpu, ramp, 3, analysis) - ramp)[inner].max() * 100.0 < 0.05


def test_levels_halve_and_round_up():
    assert [level_size((37, 1), level) for level in range(7)] == [
        (37, 1),
        (19, 1),
        (10, 1),
        (5, 1),
        (3, 1),
        (2, 1),
        (1, 1),
    ]
    assert [most_levels(size) for size in ((1, 1), (2, 1), (3, 2), (512, 3), (513, 513))] == [0, 1, 2, 9, 10]


@pytest.mark.parametrize("size", [(1, 1), (1, 4096), (255, 143), (512, 512), (3, 1000)])
def test_no_two_levels_of_an_atlas_overlap(size: tuple[int, int]):
    atlas = Atlas(size, max(most_levels(size), 1))
    taken = {parity: np.zeros(atlas.image_size(parity)[::-1], bool) for parity in (0, 1)}
    for level in range(atlas.levels + 1):
        left, bottom, width, height = atlas.viewport(level)
        part = taken[level % 2][bottom : bottom + height, left : left + width]
        assert part.shape == (height, width) and not part.any()
        part[:] = True
    assert max(atlas.image_size(0)) <= max(max(size), 1.4 * min(size) + 12)
