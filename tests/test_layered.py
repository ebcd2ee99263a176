"""Layered depth of field: the plan as numbers, the picture against its reference, what may be left out."""

from __future__ import annotations

import math

import numpy as np
import pytest

from dofview.lens import CocLaw
from dofview.methods.layered_plan import (
    FAR,
    LEAST_RADIUS,
    MOST_LAYERS,
    box_variance,
    cascade,
    expand_variance,
    plan,
    recursive,
    spaced,
    step_for,
)

LAW = CocLaw(scale=150.0, inverse_focus=0.2)


def laid_out(near: float, far: float, step: float = 1.0, power: float = 1.0, **how: object):
    options = {"sigma": 0.5, "between": False, "least_sigma": 0.0} | how
    return plan(LAW, spaced(near, step, power), spaced(far, step, power), **options)


def test_layers_are_spaced_up_to_the_reach():
    assert spaced(3.5, 1.0, 1.0) == [1.0, 2.0, 3.0, 3.5]
    assert spaced(4.0, 1.0, 1.0) == [1.0, 2.0, 3.0, 4.0]
    assert spaced(5.0, 0.5, 1.5) == pytest.approx([0.5, 0.5 * 2**1.5, 0.5 * 3**1.5, 4.0, 5.0])
    assert spaced(LEAST_RADIUS / 2, 1.0, 1.0) == []
    assert len(spaced(1e6, 0.25, 1.0)) == MOST_LAYERS and spaced(1e6, 0.25, 1.0)[-1] == 1e6


def test_the_paper_s_schedule():
    """Cumulative σ̂ of filters σ = 1, 2, 3, …: 1, 2.24, 3.74, 5.48, and a CoC radius of 2σ̂."""
    assert recursive(10.0) == pytest.approx([2.0, 4.47, 7.48, 10.95], abs=0.01)
    assert recursive(0.0) == []


@pytest.mark.parametrize(("near", "far"), [(14.0, 0.0), (0.0, 10.0), (21.0, 5.7)])
@pytest.mark.parametrize("count", [2, 5, 9, 17, 40])
def test_a_number_of_layers_by_hand_is_kept(near: float, far: float, count: int):
    step = step_for(count, near, far, 1.0)
    asked = 1 + len(spaced(near, step, 1.0)) + len(spaced(far, step, 1.0))
    fewest = 1 + (near > 0) + (far > 0)
    assert max(fewest, count - 1) <= asked <= max(fewest, count)


def test_anchors_are_the_depths_of_the_layers():
    layers = laid_out(2.0, 1.0)
    lined = [*layers.front, layers.focus, *reversed(layers.back)]
    assert [layer.radius for layer in lined] == [-2.0, -1.0, 0.0, 1.0]
    depths = [LAW.inverse_depth(layer.radius) for layer in lined]
    assert lined[1].anchors == pytest.approx((FAR, *depths[:3]))
    assert lined[0].anchors[:2] == (FAR, FAR) and lined[-1].anchors[3] == -FAR
    assert all(a >= b for layer in lined for a, b in zip(layer.anchors, layer.anchors[1:], strict=False))


def test_the_paper_s_anchors_lie_half_way():
    layers = laid_out(2.0, 1.0, between=True)
    assert layers.front[0].anchors[2] == pytest.approx(LAW.inverse_depth(-1.5))
    assert layers.focus.anchors[1:3] == pytest.approx((LAW.inverse_depth(-0.5), LAW.inverse_depth(0.5)))
    assert layers.back[0].anchors[2:] == (-FAR, -FAR)


def test_without_a_lens_there_is_one_layer_for_all_depths():
    shut = plan(CocLaw(0.0, 0.2), [], [], sigma=0.5, between=False, least_sigma=4.0)
    assert len(shut) == 1 and shut.focus.anchors == (FAR, FAR, 0.2, -FAR)


@pytest.mark.parametrize("least_sigma", [0.0, 2.5, 4.0])
@pytest.mark.parametrize(("step", "power"), [(0.25, 1.0), (1.0, 1.0), (4.0, 1.0), (0.5, 1.5)])
def test_every_layer_ends_up_with_its_own_blur(least_sigma: float, step: float, power: float):
    """Variances of the box, the filters and the expansions on the way add up to σ² of each layer."""
    layers = laid_out(0.0, 60.0, step, power, least_sigma=least_sigma).back
    filters = cascade(layers)
    for start, layer in enumerate(layers):
        variance = box_variance(layer.level)
        levels = [other.level for other in layers[start:]] + [0]
        for level, following, sigma in zip(levels, levels[1:], filters[start:], strict=False):
            variance += (sigma * 2**level) ** 2 + expand_variance(level, following)
        # Very dense layers leave too little between them for an expansion; a few are blurred a little less then.
        assert math.sqrt(variance) == pytest.approx(layer.sigma, rel=0.02 if step >= 0.5 else 0.07)
    assert (max(layer.level for layer in layers) > 0) == (least_sigma > 0.0)


def test_expanding_twice_is_expanding_through_the_level_between():
    assert expand_variance(2, 0) == expand_variance(2, 1) + expand_variance(1, 0) == 3.75
    assert np.isclose(box_variance(1), 0.25) and box_variance(0) == 0.0
