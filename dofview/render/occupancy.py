"""Which depths occur in the pinhole picture: bits of a coarse histogram, read back once per geometry key.

What a lens makes of depths is affine in 1/z, and so are the bits, so one read-back tells for every focus and aperture
which ranges of blur are empty.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from dofview.gl.filters import reduce_blocks
from dofview.render.frame import Frame

BINS = 128


@dataclass(frozen=True)
class Occupancy:
    """`bits` tells of each of BINS equal parts of 1/z from `farthest` to `nearest` whether a surface is there."""

    nearest: float
    farthest: float
    background: bool
    bits: np.ndarray

    def between(self, nearest: float, farthest: float) -> bool:
        """Whether anything may be at 1/z between `nearest` and `farthest`; surely not when false."""
        if self.background and farthest <= 0.0 <= nearest:
            return True
        scale = BINS / max(self.nearest - self.farthest, 1e-30)
        # A part in a thousand of a bin covers what rounding moves across its edge.
        first = math.floor(min(max((farthest - self.farthest) * scale - 1e-3, 0.0), BINS))
        last = math.floor(min(max((nearest - self.farthest) * scale + 1e-3, -1.0), BINS - 1))
        return bool(self.bits[first : last + 1].any())


def occupancy(frame: Frame) -> Occupancy:
    """Return the occupied depths of the frame's pinhole picture, guard band included."""
    key = (frame.geometry_key, "occupancy")
    if key not in frame.cache.values:
        depths = frame.depth_range()
        scale = BINS / max(depths.nearest - depths.farthest_surface, 1e-30)
        words = reduce_blocks(
            frame.gpu, frame.pinhole().inverse_depth, "render/occupancy.frag", "occupancy/", dtype="u4",
            values={"farthest": depths.farthest_surface, "scale": scale},
        )  # fmt: skip
        bits = (words[:, None] >> np.arange(32, dtype=np.uint32)) & 1
        frame.cache.values[key] = Occupancy(depths.nearest, depths.farthest_surface, depths.empty, bits.reshape(-1) > 0)
    return frame.cache.values[key]  # type: ignore[return-value]
