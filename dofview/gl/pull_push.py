"""Pull-push: holes in an image filled from what surrounds them, at a cost that does not depend on their size.

Pull: each coarser level is the mean of what is known of the finer one, until a single texel is left. Push: from the
coarsest level back, what is not known is taken from the level above, enlarged smoothly. What is known stays to the bit.

S. J. Gortler et al.: The Lumigraph. SIGGRAPH 1996. M. Strengert, M. Kraus, T. Ertl: Pyramid Methods in GPU-Based Image
Processing. VMV 2006. M. Kraus: The Pull-Push Algorithm Revisited. GRAPP 2009.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from dofview.gl.context import Gpu
from dofview.gl.passes import Blocks, Textures, draw
from dofview.gl.pyramids import Size, level_size, most_levels
from dofview.gl.shaders import Defines
from dofview.gl.targets import Image
from dofview.gl.tiles import Tiles

KNOWN = "pass/known.glsl"
Pair = tuple[Image, Image]


class Part(NamedTuple):
    """A part of level 0, the whole when `within` is None: what the file that says what is known reads there."""

    within: Tiles | None
    textures: Textures
    defines: Defines = {}


def pull_push(
    gpu: Gpu, name: str, size: Size, known: str = KNOWN, *, parts: Sequence[Part], blocks: Blocks | None = None,
    values: Mapping[str, object] | None = None, extras: bool = True,
) -> tuple[Image, ...]:  # fmt: skip
    """Return the filled level 1 over an image of `size`: colours times weight with the weight in alpha and, with
    `extras`, one more value times it. Level 0 is `pass/push.frag`, or a shader that does its work on the way.

    `known` names the GLSL file that says what level 0 knows (`pass/pull.frag`), in each of its `parts` and nothing
    elsewhere; `blocks` and `values` are what it reads. The weight of a level is 0 only where nothing at all is known.
    """
    top = max(most_levels(size), 1)
    alone: Defines = {} if extras else {"COLOR_ALONE": 1}
    pulled = [_images(gpu, f"{name} pulled", size, level, extras) for level in range(1, top + 1)]
    for number, part in enumerate(parts):
        within = part.within.at(1) if part.within else None
        _pull(
            gpu, size, pulled[0], known, part.textures, blocks or {}, values or {}, {**part.defines, **alone},
            within=within, clear=number == 0 and within is not None,
        )  # fmt: skip
    for level in range(2, top + 1):
        source = _named(("colors", "extras"), pulled[level - 2])
        _pull(gpu, level_size(size, level - 1), pulled[level - 1], KNOWN, source, {}, {}, alone)
    filled = pulled[-1]
    for level in range(top - 1, 0, -1):
        sources = _named(("colors", "extras"), pulled[level - 1]) | _named(("coarse_colors", "coarse_extras"), filled)
        filled = _images(gpu, f"{name} filled", size, level, extras)
        draw(gpu, "pass/push.frag", filled, textures=sources, defines={**alone, "KNOWN": KNOWN})
    return filled


def fill(gpu: Gpu, colors: Image, extras: Image, into: Pair, name: str) -> None:
    """Write `colors` (times weight, weight in alpha) and `extras` (times weight) to `into` with their holes filled."""
    own = {"colors": colors, "extras": extras}
    coarse = pull_push(gpu, name, colors.size, parts=[Part(None, own)])
    above = _named(("coarse_colors", "coarse_extras"), coarse)
    draw(gpu, "pass/push.frag", into, textures={**own, **above}, defines={"KNOWN": KNOWN})


def _pull(
    gpu: Gpu, fine_size: Size, into: Sequence[Image], known: str, textures: Textures, blocks: Blocks,
    values: Mapping[str, object], defines: Defines, *, within: Tiles | None = None, clear: bool = False,
) -> None:  # fmt: skip
    draw(
        gpu, "pass/pull.frag", into, textures=textures, blocks=blocks, values={**values, "fine_size": fine_size},
        defines={**defines, "KNOWN": known}, within=within, clear=clear,
    )  # fmt: skip


def _images(gpu: Gpu, name: str, size: Size, level: int, extras: bool) -> tuple[Image, ...]:
    shape = level_size(size, level)
    color = gpu.targets.image(f"{name} {level}", shape, linear=True)
    return (color, gpu.targets.image(f"{name} extra {level}", shape, 1, linear=True)) if extras else (color,)


def _named(names: tuple[str, str], images: Sequence[Image]) -> dict[str, Image]:
    """Images by name, the second only where it is there."""
    return dict(zip(names, images, strict=False))
