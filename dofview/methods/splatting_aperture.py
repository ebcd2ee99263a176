"""The lens's distribution of light as the sprites of `splatting` read it.

Nothing for a disc, whose coverage is a formula, and a summed-area table for any other.
"""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple, cast

import numpy as np

from dofview.bokeh import Aperture, of_lens
from dofview.gl.targets import Image
from dofview.lens import Distribution, Lens
from dofview.methods.method import Recipe

TEXELS = 256
# Light that may be lost beyond where a sprite ends: a Gaussian has no rim of its own.
MOST_LOST = 1e-4


class Sprite(NamedTuple):
    """What shaders that include sprite.glsl are given; `extent` is how far a sprite reaches and `spread` its standard
    deviation on one axis, both in CoC radii, and `key` changes with the shape."""

    key: object
    extent: float
    spread: float
    flags: dict[str, object]
    values: dict[str, object]
    textures: dict[str, Image]


SHARP_PX = 0.35
"""CoC radius up to which a disc's sprite is its own pixel and the picture the pinhole's, px."""
DISC = Sprite("disc", 1.0, 0.5, {"SHARP_PX": SHARP_PX}, {"extent": 1.0, "spread": 0.5}, {})


def sprite_of(recipe: Recipe) -> Sprite:
    """The sprite of the frame's lens, its table made when the lens's shape has changed."""
    lens, cache = recipe.frame.lens, recipe.frame.cache
    if lens.distribution is Distribution.UNIFORM_DISC:
        return DISC
    key = ("aperture", _shape_key(lens))
    if key not in cache.values:
        aperture = of_lens(lens, TEXELS)
        cache.values[key] = (aperture, reach_of(aperture), spread_of(aperture))
    aperture, extent, spread = cast("tuple[Aperture, float, float]", cache.values[key])
    side = len(aperture.weights) + 1
    table = recipe.image("aperture", (side, side), components=1, linear=True)
    if not cache.holds(key, table):
        table.write(summed_area(aperture.weights)[..., None])
    values: dict[str, object] = {"extent": extent, "spread": spread, "aperture_half_width": aperture.extent}
    return Sprite(key, extent, spread, {"APERTURE": 1}, values, {"aperture_sums": table})


def summed_area(weights: np.ndarray) -> np.ndarray:
    """Sums of all that is to the left and below, (n + 1, n + 1) float64, from weights (n, n) with row 0 at the top."""
    table = np.zeros((weights.shape[0] + 1, weights.shape[1] + 1))
    table[1:, 1:] = weights[::-1].cumsum(axis=0).cumsum(axis=1)
    return table[::-1]


def spread_of(aperture: Aperture) -> float:
    """Standard deviation of the light on one axis, lens radii: the mean of both, about the middle of the light."""
    place = ((np.arange(len(aperture.weights)) + 0.5) * (2.0 / len(aperture.weights)) - 1.0) * aperture.extent
    axes = aperture.weights.sum(axis=0), aperture.weights.sum(axis=1)
    return float(np.sqrt(np.mean([light @ place**2 - (light @ place) ** 2 for light in axes])))


def reach_of(aperture: Aperture) -> float:
    """Distance from the middle, lens radii, within which all but `MOST_LOST` of the light is."""
    size = len(aperture.weights)
    # The outer edge of each texel on either axis.
    edge = (np.abs(np.arange(size) - 0.5 * (size - 1)) + 0.5) * (2.0 * aperture.extent / size)
    distance = np.hypot(edge[:, None], edge[None, :]).ravel()
    order = np.argsort(distance)
    within = aperture.weights.ravel()[order].cumsum()
    last = min(int(np.searchsorted(within, within[-1] * (1.0 - MOST_LOST))), len(order) - 1)
    return float(distance[order[last]])


def _shape_key(lens: Lens) -> tuple[object, ...]:
    """All that the picture of the aperture depends on; a file that was written anew is another."""
    stamp = None
    if lens.image is not None and Path(lens.image).is_file():
        stat = Path(lens.image).stat()
        stamp = (stat.st_size, stat.st_mtime_ns)
    return lens.distribution, lens.blades, lens.rotation_deg, lens.sigma_fraction, lens.image, stamp
