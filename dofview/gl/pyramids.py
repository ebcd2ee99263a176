"""Image pyramids: each level half the size of the one before, rounded up, with texels that never drift.

Texel i of level l covers pixels i·2ˡ to (i + 1)·2ˡ of level 0, also where those end outside the picture, so a position
p in pixels of level 0 is p / 2ˡ in texels of level l at every size. (Sizes rounded down, or coordinates normalised by
the picture instead of the level, move coarse levels by up to a texel of theirs.)
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

Size = tuple[int, int]


def level_size(size: Size, level: int) -> Size:
    """Size in texels of `level` of a pyramid over `size`."""
    return -(-size[0] >> level), -(-size[1] >> level)


def most_levels(size: Size) -> int:
    """How often `size` can be halved until a single texel is left."""
    return (max(size) - 1).bit_length()


@dataclass(frozen=True)
class Atlas:
    """A pyramid of `levels` + 1 levels over `size` in two images: even levels in one, odd levels in the other.

    A pass may then write a level while it reads the one before, which GL forbids within one image, and a shader that
    mixes two neighbouring levels fetches each from the image it is in, with no branch over levels.
    """

    size: Size
    levels: int

    def corner(self, level: int) -> Size:
        """Lower left texel of `level` in its image. Levels are stacked along the picture's shorter side."""
        axis = 0 if self.size[0] < self.size[1] else 1
        offset = sum(level_size(self.size, below)[axis] for below in range(level % 2, level, 2))
        return (offset, 0) if axis == 0 else (0, offset)

    def image_size(self, parity: int) -> Size:
        """Size of the image that holds the even (0) or the odd (1) levels."""
        first, last = min(parity, self.levels), self.levels - (self.levels - parity) % 2
        if last < first:
            return 1, 1
        corner, end = self.corner(last), level_size(self.size, last)
        widest = level_size(self.size, first)
        return max(widest[0], corner[0] + end[0]), max(widest[1], corner[1] + end[1])

    def viewport(self, level: int) -> tuple[int, int, int, int]:
        """Where `level` is in its image: left, bottom, width, height."""
        return (*self.corner(level), *level_size(self.size, level))

    def values(self) -> dict[str, object]:
        """What `include/atlas.glsl` must know."""
        corners = np.array([self.corner(level) for level in range(self.levels + 1)], dtype=np.int32)
        return {"atlas_size": self.size, "atlas_corners": corners.tobytes()}
