"""How near one picture is to another: PSNR, SSIM and FLIP, over the whole picture or one zone of blur.

Pictures come in as linear light, (h, w, 3) float, and are compared as people see them: sRGB-encoded, clipped to 0…1.
PSNR is the mean over all three channels with a peak of 1 (Lee 2008, Lee 2009); 8-bit pictures cannot pass 58.9 dB.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from dofview.errors import InputError

_SSIM_WINDOW = 11


def srgb_encode(linear: np.ndarray) -> np.ndarray:
    """Linear light in 0…1 to sRGB (IEC 61966-2-1), float64; what lies outside is clipped."""
    linear = np.clip(np.asarray(linear, dtype=np.float64), 0.0, 1.0)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1.0 / 2.4) - 0.055)


def srgb_decode(encoded: np.ndarray) -> np.ndarray:
    """SRGB in 0…1 to linear light (IEC 61966-2-1), float64; what lies outside is clipped."""
    encoded = np.clip(np.asarray(encoded, dtype=np.float64), 0.0, 1.0)
    return np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)


def psnr(image: np.ndarray, reference: np.ndarray, mask: np.ndarray | None = None) -> float:
    """Peak signal-to-noise ratio in dB: infinite for equal pictures, nan for an empty `mask` or a nan in `image`.

    `mask` (h, w) bool picks the pixels that count.
    """
    image, reference = _encoded(image, reference)
    squared = np.square(image - reference)
    error = _mean(squared if mask is None else squared[mask])
    return -10.0 * math.log10(error) if error > 0.0 else math.inf if error == 0.0 else math.nan


def ssim(image: np.ndarray, reference: np.ndarray, mask: np.ndarray | None = None) -> float:
    """Structural similarity as Wang et al. 2004 have it (Gaussian window, σ 1.5 px), mean over pixels and channels."""
    from skimage.metrics import structural_similarity

    image, reference = _encoded(image, reference)
    smallest = min(image.shape[:2])
    mean, values = structural_similarity(
        image, reference,
        win_size=min(_SSIM_WINDOW, smallest - 1 + smallest % 2), gaussian_weights=True, sigma=1.5,
        use_sample_covariance=False, data_range=1.0, channel_axis=2, full=True,
    )  # fmt: skip
    return float(mean) if mask is None else _mean(values[mask])


def flip(image: np.ndarray, reference: np.ndarray, mask: np.ndarray | None = None) -> float:
    """Mean LDR-FLIP difference (Andersson et al. 2020) at 67 pixels per degree: 0 for equal, 1 at most."""
    try:
        import flip_evaluator
    except ImportError as error:
        raise InputError(
            "FLIP needs the package flip-evaluator; install it with: pip install 'dofview[flip]'"
        ) from error
    image, reference = (np.ascontiguousarray(p, dtype=np.float32) for p in _encoded(image, reference))
    values, mean, _ = flip_evaluator.evaluate(reference, image, "LDR", applyMagma=False)
    return float(mean) if mask is None else _mean(values[..., 0][mask])


class BlurZones(NamedTuple):
    """Three masks (h, w) bool that share out all pixels."""

    focus: np.ndarray
    foreground: np.ndarray
    background: np.ndarray


def blur_zones(coc: np.ndarray) -> BlurZones:
    """Share out the pixels by their signed CoC radius `coc` (h, w), px.

    Foreground is what a blurred pixel in front of the focus (c ≤ −1) spreads over: its own disc, halo and all. Of the
    rest, |c| < 1 is in focus, and c ≥ 1 is background.
    """
    foreground = _spread(np.where(coc <= -1.0, np.square(coc, dtype=np.float64), -1.0))
    focus = ~foreground & (np.abs(coc) < 1.0)
    return BlurZones(focus, foreground, ~foreground & ~focus)


def _spread(squared_radius: np.ndarray) -> np.ndarray:
    """Tell which pixels lie in the disc of some pixel, given each one's squared radius, negative for no disc.

    max(r² − dx² − dy²) ≥ 0, one axis after the other (as the distance transform of Felzenszwalb and Huttenlocher).
    """
    field = squared_radius
    reach = math.floor(math.sqrt(max(float(field.max(initial=0.0)), 0.0)))
    for axis in (0, 1):
        source, field = field, field.copy()
        for step in range(1, min(reach, field.shape[axis] - 1) + 1):
            ahead, behind = [slice(None)] * 2, [slice(None)] * 2
            ahead[axis], behind[axis] = slice(step, None), slice(None, -step)
            for target, origin in ((ahead, behind), (behind, ahead)):
                part = field[tuple(target)]
                np.maximum(part, source[tuple(origin)] - step * step, out=part)
    return field >= 0.0


def _encoded(image: np.ndarray, reference: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    if image.shape != reference.shape or image.ndim != 3 or image.shape[2] != 3:
        raise ValueError(f"pictures of shape {image.shape} and {reference.shape}; accepted: both (h, w, 3), equal")
    return srgb_encode(image), srgb_encode(reference)


def _mean(values: np.ndarray) -> float:
    return float(values.mean()) if values.size else math.nan
