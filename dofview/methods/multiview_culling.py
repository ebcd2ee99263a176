"""Which layers hold anything that a pixel's rays can reach: one bit per layer, for every pixel or tile of pixels.

Rays then walk only the layers whose bit is set, front to back. What is left out is empty all over, so the picture is
the same; of 16 layers about three are left.
"""

from __future__ import annotations

import math
from enum import StrEnum
from typing import NamedTuple

import numpy as np

from dofview.gl.targets import Image
from dofview.methods.method import Recipe
from dofview.methods.multiview_layers import MOST_LAYERS, TILE, Layers, Slabs, occupied


class Culling(StrEnum):
    """How layers out of reach are found."""

    TILES = "tiles"
    N_BUFFER = "n_buffer"
    OFF = "off"


class Mask(NamedTuple):
    """Bits per layer in texels of 2^`shift` by 2^`shift` pixels; `tiles` are those found by tiles in any case."""

    image: Image
    shift: int
    tiles: Image


def mask(recipe: Recipe, culling: Culling, layers: Layers, extent: float, footprint: np.ndarray) -> Mask:
    """Find the layers in reach of each pixel's rays.

    `extent` is the largest coordinate of a lens sample, lens radii; `footprint` how far around itself a ray reads each
    layer, pixels, (slabs.count,).
    """
    reach = reach_px(recipe, layers.slabs, extent, footprint)
    tiles = _by_tiles(recipe, layers, reach)
    match culling:
        case Culling.TILES:
            found = Mask(tiles, TILE.bit_length() - 1, tiles)
        case Culling.N_BUFFER:
            found = Mask(_by_n_buffer(recipe, layers, reach), 0, tiles)
        case _:
            found = Mask(recipe.image("mask", (1, 1), components=1, dtype="u4"), 31, tiles)
            found.image.write(np.full((1, 1, 1), (1 << layers.slabs.count) - 1, np.uint32))
    _count(recipe, layers, found.image)
    return found


def reach_px(recipe: Recipe, slabs: Slabs, extent: float, footprint: np.ndarray) -> np.ndarray:
    """How far from its pixel a ray can look while it passes each layer, pixels, (MOST_LAYERS,) int32."""
    reach = np.zeros(MOST_LAYERS, np.int32)
    if slabs.count == 0:
        return reach
    fronts, backs = slabs.bounds()
    margin = slabs.overlap * slabs.step
    widest = np.abs(recipe.frame.coc.radius_px(np.stack([fronts + margin, backs - margin]))).max(axis=0)
    # A pixel for rounding, one for the texel beside it.
    reach[: slabs.count] = np.minimum(np.ceil(widest * extent + footprint) + 2.0, max(recipe.frame.size))
    return reach


def _by_tiles(recipe: Recipe, layers: Layers, reach: np.ndarray) -> Image:
    """Tiles of 4 by 4 pixels, each layer's bits spread by its own reach, along one axis and then the other."""
    across, spread = (recipe.image(name, layers.tiles.size, 1, "u4") for name in ("tiles across", "tile mask"))
    tiles = -(-reach // TILE)
    # Bit k of texel d: whether layer k reaches d tiles far.
    reaching = (tiles[None, :] >= np.arange(tiles.max() + 1)[:, None]) @ (1 << np.arange(MOST_LAYERS, dtype=np.int64))
    table = recipe.image("reaching", (len(reaching), 1), 1, "u4")
    table.write(reaching.astype(np.uint32)[None, :, None])
    for source, into, axis in ((layers.tiles, across, (1, 0)), (across, spread, (0, 1))):
        recipe.draw("spread.frag", into, tiles=source, reaching=table, values={"axis": axis})
    return spread


def _by_n_buffer(recipe: Recipe, layers: Layers, reach: np.ndarray) -> Image:
    """The paper's N-buffer (Décoret 2005): level i says what lies in the 2^i by 2^i window that begins at a pixel, so
    four fetches at the level of its size answer for any window. A bit per layer in one image stands for a buffer of
    least depths per layer: as a layer's depths lie inside the layer, the test on them is whether there are any."""
    names = ("n-buffer", "n-buffer next", "mask", "mask next")
    level, larger, before, after = (recipe.image(name, None, 1, "u4") for name in names)
    occupied(recipe, layers.slabs, layers.images, level, layers.detail)
    recipe.draw("n_buffer_start.frag", before)
    most = int(math.log2(2 * int(reach.max()) + 1))
    for i in range(most + 1):
        recipe.draw(
            "n_buffer_query.frag", after, n_buffer=level, found=before,
            values={"level": i, "reach": reach.tobytes(), "count": layers.slabs.count},
        )  # fmt: skip
        before, after = after, before
        if i < most:
            recipe.draw("n_buffer_grow.frag", larger, n_buffer=level, values={"stride": 1 << i})
            level, larger = larger, level
    return before


def _count(recipe: Recipe, layers: Layers, mask: Image) -> None:
    """Say how many layers of how many are left out; read back, so only while a person looks at timings."""
    profile = recipe.gpu.profile
    if profile.timing:
        bits = np.ascontiguousarray(mask.pixels()[..., 0])
        kept = int(np.unpackbits(bits.view(np.uint8)).sum())
        profile.count("multiview layers in reach", kept)
        profile.count("multiview layers skipped", bits.size * layers.slabs.count - kept)
