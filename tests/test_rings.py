"""The symmetric lens points."""

from __future__ import annotations

import numpy as np
import pytest

from dofview.rings import _error, rings
from dofview.sampling import spiral


@pytest.mark.parametrize("count", [1, 2, 3, 4, 5, 8, 13, 16, 31, 32, 64, 100, 256])
def test_rings_are_symmetric_centred_and_as_wide_as_the_disc(count: int):
    points = rings(count)
    assert points.shape == (count, 2) and (np.hypot(*points.T) < 1.0).all()
    assert np.abs(points.mean(axis=0)).max() < 1e-12
    as_set = {tuple(np.round(p, 9) + 0.0) for p in points}
    for turned in (points * [-1, 1], points * [1, -1], points[:, ::-1]):
        assert {tuple(np.round(p, 9) + 0.0) for p in turned} == as_set
    if count >= 4 and count % 4 == 0:
        assert np.mean(points**2) == pytest.approx(0.25, rel=1e-12)


@pytest.mark.parametrize("count", [16, 32, 64, 128])
def test_rings_err_about_as_little_as_the_spiral(count: int):
    assert _error(rings(count)) < 1.15 * _error(spiral(count))
