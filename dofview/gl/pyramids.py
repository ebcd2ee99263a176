"""Image pyramids: each level half the size of the one before, rounded up, with texels that never drift.

Texel i of level l covers pixels i·2ˡ to (i + 1)·2ˡ of level 0, also where those end outside the picture, so a position
p in pixels of level 0 is p / 2ˡ in texels of level l at every size. (Sizes rounded down, or coordinates normalised by
the picture instead of the level, move coarse levels by up to a texel of theirs.)
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from dofview.gl.context import Gpu
from dofview.gl.passes import Color, draw
from dofview.gl.targets import Image
from dofview.gl.tiles import Tiles

Size = tuple[int, int]


def level_size(size: Size, level: int) -> Size:
    """Size in texels of `level` of a pyramid over `size`."""
    return -(-size[0] >> level), -(-size[1] >> level)


def most_levels(size: Size) -> int:
    """How often `size` can be halved until a single texel is left."""
    return (max(size) - 1).bit_length()


class Analysis(StrEnum):
    """The filter that makes a level from the finer one before it."""

    SPLINE = "spline"
    BOX4 = "box4"
    BOX2 = "box2"

    def blur_sigma(self, levels: int) -> float:
        """σ, px, of reducing `levels` times and expanding as often, mean over positions.

        Reducing adds 3/4, 5/4 or 1/4 texel², expanding by biquadratic B-splines 3/4, each in texels twice the size of
        those before. Only with the spline it is the same at every position, and nothing moves: with the boxes the
        middle of a blurred point is up to half a coarse texel off (2×2) or half a pixel (4×4).
        """
        per_level = {Analysis.SPLINE: 0.75, Analysis.BOX4: 1.25, Analysis.BOX2: 0.25}[self] + 0.75
        return float(np.sqrt(per_level * (4.0**levels - 1.0) / 3.0))


def pyramid(gpu: Gpu, name: str, size: Size, levels: int, components: int = 4) -> list[Image]:
    """Images of levels 1 to `levels` over `size`, called `name` and their number, fetched bilinearly."""
    return [
        gpu.targets.image(f"{name} {level}", level_size(size, level), components, linear=True)
        for level in range(1, levels + 1)
    ]


def reduce(
    gpu: Gpu, fine: Image, coarse: Image, analysis: Analysis = Analysis.SPLINE, *, blend: tuple | None = None,
    within: Tiles | None = None, clear: bool | Color = False,
) -> None:  # fmt: skip
    """Write `coarse`, half the size of `fine` rounded up. `fine` must be fetched bilinearly (`linear=True`)."""
    draw(
        gpu, "pass/reduce.frag", coarse, textures={"fine": fine}, defines={analysis.name: 1}, blend=blend,
        within=within, clear=clear,
    )  # fmt: skip


def expand(gpu: Gpu, coarse: Image, fine: Image, *, within: Tiles | None = None, clear: bool | Color = False) -> None:
    """Write `fine`, of twice the size of `coarse`, by biquadratic B-splines."""
    draw(gpu, "pass/expand.frag", fine, textures={"coarse": coarse}, within=within, clear=clear)


def blur(gpu: Gpu, levels: Sequence[Image], analysis: Analysis = Analysis.SPLINE) -> Image:
    """Blur the first of `levels` by reducing down to the last and expanding back to the second, which is returned: one
    more expansion, left to the reader, and σ is `analysis.blur_sigma(len(levels) - 1)`."""
    for fine, coarse in zip(levels[:-1], levels[1:], strict=True):
        reduce(gpu, fine, coarse, analysis)
    for fine, coarse in zip(levels[-2:0:-1], levels[:1:-1], strict=True):
        expand(gpu, coarse, fine)
    return levels[1]


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
