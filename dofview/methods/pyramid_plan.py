"""Which sub-images a picture is cut into, and how a pixel's blur decides its weights in them (Kraus 2007, section 3.3).

All in signed σ, pixels: the width of the Gaussian that a pixel is blurred by, negative in front of the focus. It is
affine in 1/z, so the background at infinity is an ordinary value, and no anchor is ill-defined as the paper's in z are.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum

FAR = 1e30
NOTHING = 1e-5
"""σ in px that changes no picture, but which rounding gives to a plane in focus."""

Ramps = tuple[float, float, float, float]


class Matting(StrEnum):
    """How much of a pixel goes into the sub-images around its blur.

    PAPER: a pixel between the blurs of i − 1 and i has weight 1 in sub-image i, and what is left and right of it on the
    ramps, linear in z, in i − 1 and i + 1: 2 in all. Blended over one another, they are opaque where a surface is
    whole, but at its silhouettes the three count as three surfaces and cover too much.

    PARTITION: only i − 1 and i, with weights that sum to 1, blended into what is left of 1. A surface that is whole is
    opaque, one that covers a part of a pixel covers that part, and one sub-image fewer is needed.
    """

    PARTITION = "partition"
    PAPER = "paper"


@dataclass(frozen=True)
class SubImage:
    """Sub-image `index`: 0 in focus, negative in front, blurred by |index| levels.

    Pixels with σ below `cull` are left out. The weight rises from ramps[0] to ramps[1] and falls from ramps[2] to
    ramps[3]. `soft` says over which σ behind `cull` a pixel comes to be a source of filling, and over which σ in front
    of it the filling comes to be seen in full. `fills` if the scene has pixels before or on the rising ramp.
    """

    index: int
    cull: float
    ramps: Ramps
    fills: bool
    soft: tuple[float, float]


def plan(
    front: float, back: float, infinity: float, blur: Callable[[int], float], limit: int, matting: Matting
) -> list[SubImage]:
    """Return the sub-images for pixels with σ from `front` to `back`, front to back.

    `blur(n)` is the σ of n levels, `infinity` that of the farthest background; no index goes beyond ±`limit`.
    """

    def anchor(index: int) -> float:
        return blur(index) if index >= 0 else -blur(-index)

    paper = matting is Matting.PAPER
    low = next((-k for k in range(limit) if anchor(-k) <= front + NOTHING), -limit)
    # The paper's sub-image i reaches back to the blur of i − 1 only with part of its weight.
    high = next((k for k in range(int(paper), limit) if anchor(k - paper) >= back - NOTHING), limit)
    found = []
    for index in range(low, high + 1):
        ramps = [anchor(index + step) for step in ((-2, -1, 0, 1) if paper else (-1, 0, 0, 1))]
        if index == high or (paper and max(ramps[2:]) >= infinity):
            ramps[2:] = FAR, FAR
        if index == high and paper:
            # A step, lest silhouettes before the last sub-image are seen through; it pops when a slider moves.
            ramps[1] = ramps[0]
        if index == low:
            ramps[:2] = -FAR, -FAR
        # The paper culls at once, and fills nothing behind what it has not culled.
        soft = (0.0, 0.0) if paper else (ramps[1] - ramps[0], 0.5 * (anchor(index - 1) - anchor(index - 2)))
        found.append(
            SubImage(index, ramps[0], (ramps[0], ramps[1], ramps[2], ramps[3]), front < ramps[0 if paper else 1], soft)
        )
    return found
