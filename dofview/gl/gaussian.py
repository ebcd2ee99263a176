"""Gaussian filters of any width: separable, with plain or bilinear taps, and wide ones at half and quarter size.

What counts is the width of the filter that is applied, not of the curve it was sampled from. A Gaussian sampled at
whole texels and cut off has another variance than it was asked for (σ = 0.4 comes out as 0.29), and filters applied one
after the other add their variances, so `kernel` solves for weights whose variance is exactly σ².

At full size a wide filter costs 6σ fetches per pixel and direction. Its result has no fine detail, so it is nearly the
same when it is reduced to half or a quarter of the size, blurred with what variance is left, and expanded again.
"""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from dofview.gl.context import Gpu
from dofview.gl.passes import Color, draw
from dofview.gl.pyramids import Analysis, expand, level_size, reduce
from dofview.gl.targets import Image
from dofview.gl.tiles import Tiles

TRUNCATION = 3.0
"""Where a kernel is cut, in σ. Cut at 2 a blurred picture is 47–53 dB from the exact one, at 3 70–78 dB."""

COARSE_SIGMA = 2.5
"""From this σ on, px, half size is used, and from twice this a quarter, and so on: 68 dB or more from full size."""


@lru_cache(maxsize=256)
def kernel(sigma: float, truncation: float = TRUNCATION) -> tuple[float, ...]:
    """Weights w₀ … w_R of a symmetric kernel at texel distances 0 … R: their sum is 1 and their variance `sigma`².

    R is `truncation` · `sigma` rounded up, at least 1. A negative `sigma` takes the variance σ² away, which can be done
    by a little, to what is smooth by texels or will be blurred.
    """
    if sigma <= 0.0:
        return (1.0 + sigma * sigma, -0.5 * sigma * sigma) if sigma < 0.0 else (1.0, 0.0)
    distance = np.arange(max(math.ceil(truncation * sigma), 1) + 1, dtype=float)
    twice = np.where(distance > 0, 2.0, 1.0)

    def weights(parameter: float) -> np.ndarray:
        curve = np.exp(-0.5 * (distance / parameter) ** 2)
        return curve / (curve * twice).sum()

    low, high = 1e-3, 4.0 * sigma + 1.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        too_wide = (weights(middle) * twice * distance**2).sum() > sigma * sigma
        low, high = (low, middle) if too_wide else (middle, high)
    return tuple(weights(0.5 * (low + high)).tolist())


def paired(weights: tuple[float, ...]) -> tuple[tuple[float, float], ...]:
    """The same kernel for bilinear taps: (distance, weight) of each tap, two texels in one from the second on."""
    taps = [(0.0, weights[0])]
    for near in range(1, len(weights), 2):
        first, second = weights[near], weights[near + 1] if near + 1 < len(weights) else 0.0
        both = first + second
        taps.append((near + (second / both if both > 0.0 else 0.0), both))
    return tuple(taps)


def convolve(
    gpu: Gpu, source: Image, into: Image, weights: tuple[float, ...], axis: tuple[int, int], *, bilinear: bool = False,
    within: Tiles | None = None, clear: bool | Color = False,
) -> None:  # fmt: skip
    """Filter along one `axis`, (1, 0) or (0, 1); beyond the border the last texel is repeated.

    `bilinear` reads two texels with each tap and needs a `source` with linear filtering: half the fetches, which pays
    where a bilinear fetch costs as much as a plain one. A software rasteriser's costs twice as much.
    """
    if bilinear:
        taps = np.array(paired(weights), np.float32)
        defines, values = {"BILINEAR": 1, "TAPS": len(taps)}, {"taps": taps.tobytes()}
    else:
        defines, values = {"TAPS": len(weights)}, {"weights": np.array(weights, np.float32).tobytes()}
    draw(
        gpu, "pass/gaussian.frag", into, textures={"source": source}, values={**values, "axis": axis}, defines=defines,
        within=within, clear=clear, samplers=None if bilinear else {"source": gpu.nearest},
    )  # fmt: skip


def blur(
    gpu: Gpu, source: Image, name: str, sigma: float, *, truncation: float = TRUNCATION, bilinear: bool = False,
    coarse_sigma: float = COARSE_SIGMA,
) -> Image:  # fmt: skip
    """Return `source` (bilinear) blurred by `sigma`, px, in images `name`/…; with `coarse_sigma` 0 at full size."""
    levels = min(level_for(sigma, coarse_sigma), (min(source.size) - 1).bit_length())
    chain = [source]
    for level in range(1, levels + 1):
        chain.append(_image(gpu, f"{name}/reduced {level}", source, level))
        reduce(gpu, chain[-2], chain[-1])
    left = math.sqrt(max(sigma**2 - Analysis.SPLINE.blur_sigma(levels) ** 2, 0.0)) / 2**levels
    across, result = (_image(gpu, f"{name}/{what} {levels}", source, levels) for what in ("across", "blurred"))
    weights = kernel(left, truncation)
    convolve(gpu, chain[-1], across, weights, (1, 0), bilinear=bilinear)
    convolve(gpu, across, result, weights, (0, 1), bilinear=bilinear)
    for level in reversed(range(levels)):
        finer = _image(gpu, f"{name}/blurred {level}", source, level)
        expand(gpu, result, finer)
        result = finer
    return result


def level_for(sigma: float, coarse_sigma: float) -> int:
    """How often an image may be halved before a blur of `sigma`, px: while σ is `coarse_sigma` texels or more."""
    if not 0.0 < coarse_sigma <= sigma:
        return 0
    return 1 + int(math.log2(sigma / coarse_sigma) + 1e-9)


def _image(gpu: Gpu, name: str, like: Image, level: int) -> Image:
    shape = like.shape
    return gpu.targets.image(name, level_size(like.size, level), shape.components, shape.dtype, linear=True)
