"""Which layers `layered` works with: their blur, their anchors in depth, the size each is blurred at.

Numbers only, no GL: what the recipe does is laid out here first, and tested as numbers.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

from dofview.gl.gaussian import level_for
from dofview.lens import CocLaw

FAR = 1e30
"""Stands for infinity in anchors: beyond any inverse depth, and finite, so that a ramp to it is 0 and not NaN."""

LEAST_RADIUS = 0.05
"""Blur of a smaller CoC radius, px, changes a pixel by less than 4e-4 of its contrast: no layer is made for it."""

MOST_LAYERS = 128
"""Of each side. More are not asked for: the step grows until this many reach."""

MOST_HALVINGS = 2
"""A filter of the cascade is narrow; beyond a quarter of the size the seams between levels would cost more than it."""

Anchors = tuple[float, float, float, float]


@dataclass(frozen=True)
class Layer:
    """One slice of depth.

    `radius` is its signed CoC radius and `sigma` its blur, px of the full image. `anchors` are the inverse depths
    z_(k-2) … z_(k+1) of Schedl 2012 eq 3–4. Its blur is done at one texel for 2^`level` pixels. `reach` is how far the
    blur between it and the next layer towards the focus carries, px.
    """

    radius: float
    sigma: float
    anchors: Anchors
    level: int = 0
    reach: float = 0.0

    @property
    def farthest(self) -> bool:
        """Whether the background belongs to it, which a pixel has behind its last surface."""
        return self.anchors[3] == -FAR


@dataclass(frozen=True)
class Plan:
    """Layers in front of the focus, nearest first; the one in focus; layers behind it, farthest first."""

    front: tuple[Layer, ...]
    focus: Layer
    back: tuple[Layer, ...]

    def __len__(self) -> int:
        return len(self.front) + 1 + len(self.back)


def spaced(reach: float, step: float, power: float) -> list[float]:
    """CoC radii step · j^power up to `reach`, px; the last is `reach` itself, so that a moving lens makes no jump."""
    if reach < LEAST_RADIUS:
        return []
    # The last may lie a little farther than its place, or there would be one more, hardly apart from it.
    count = min(max(math.ceil((reach / step) ** (1.0 / power) - 0.02), 1), MOST_LAYERS)
    step = max(step, reach / count**power)
    return [min(step * j**power, reach) for j in range(1, count)] + [reach]


def recursive(reach: float) -> list[float]:
    """The paper's schedule: the j-th filter has σ = j, so σ̂ = √(j(j+1)(2j+1)/6), and a CoC diameter of 4σ̂ (eq 10).

    The last radius is `reach` or the first beyond it.
    """
    radii: list[float] = []
    while reach >= LEAST_RADIUS and (not radii or radii[-1] < reach) and len(radii) < MOST_LAYERS:
        j = len(radii) + 1
        radii.append(2.0 * math.sqrt(j * (j + 1) * (2 * j + 1) / 6.0))
    return radii


def step_for(layers: int, near: float, far: float, power: float) -> float:
    """The smallest step with which `layers` layers in all cover the radii `near` in front and `far` behind, px."""

    def needed(step: float) -> int:
        return 1 + len(spaced(near, step, power)) + len(spaced(far, step, power))

    low, high = 1e-3, max(near, far, 1e-3)
    if needed(high) > layers:
        return high
    for _ in range(40):
        middle = math.sqrt(low * high)
        low, high = (low, middle) if needed(middle) <= layers else (middle, high)
    return high


def plan(law: CocLaw, near: list[float], far: list[float], *, sigma: float, between: bool, least_sigma: float) -> Plan:
    """Lay out the layers with CoC radii `near` in front of the focus and `far` behind it, both rising, px.

    `sigma` is the blur of a CoC radius of 1 px. Anchors lie at the layers' depths, or half way `between` them (eq 9).
    """
    radii = [-r for r in reversed(near)] + [0.0] + far
    edges = [0.5 * (a + b) for a, b in pairwise(radii)] if between else radii
    line = [FAR, FAR, *(float(law.inverse_depth(e)) if e else law.inverse_focus for e in edges), -FAR, -FAR, -FAR]

    def level(blur: float) -> int:
        return min(level_for(blur, least_sigma), MOST_HALVINGS)

    def anchors(k: int) -> Anchors:
        # Without a ramp in front of the interval before it, a layer begins where that interval does.
        return line[k if between else k + 1], line[k + 1], line[k + 2], line[k + 3]

    def reach(k: int) -> float:
        sharper = radii[k + 1 if k < focus else k - 1] if k != focus else 0.0
        return sigma * math.sqrt(max(radii[k] ** 2 - sharper**2, 0.0))

    focus = len(near)
    layers = [
        Layer(radius, sigma * abs(radius), anchors(k), level(sigma * abs(radius)), reach(k))
        for k, radius in enumerate(radii)
    ]
    return Plan(tuple(layers[:focus]), layers[focus], tuple(reversed(layers[focus + 1 :])))


def cascade(layers: Sequence[Layer]) -> list[float]:
    """σ of the filter after each layer joined, in texels of its level, so that each layer ends up with its own blur.

    Variances add. A layer's own is spent on coming to its level, on the filters from there on, and on each expansion
    to twice the size. Between dense layers a change of size takes more than lies between them: then σ is negative, and
    the filter takes the variance σ² away before (`gl.gaussian.kernel`).
    """
    filters = []
    for layer, following in zip(layers, [*layers[1:], None], strict=True):
        level = following.level if following else 0
        rest = following.sigma**2 - entry_variance(level) if following else 0.0
        needed = layer.sigma**2 - entry_variance(layer.level) - rest - expand_variance(layer.level, level)
        filters.append(math.copysign(math.sqrt(abs(needed)), needed) / 2**layer.level)
    return filters


def finishing(layer: Layer) -> float:
    """σ, in texels of its level, of the filter that gives `layer` the rest of its blur at once, to be enlarged then."""
    needed = layer.sigma**2 - entry_variance(layer.level) - expand_variance(layer.level, 0)
    return math.sqrt(max(needed, 0.0)) / 2**layer.level


def entry_variance(level: int) -> float:
    """Variance per axis of bringing a layer to `level` by [1 3 3 1] / 8, px²: 3/4 of each finer texel²."""
    return sum(0.75 * 4**finer for finer in range(level))


def expand_variance(level: int, to: int) -> float:
    """Variance per axis of expanding `level` to level `to` by biquadratic B-splines, px²: 3/4 of each finer texel²."""
    return sum(0.75 * 4**finer for finer in range(to, level))
