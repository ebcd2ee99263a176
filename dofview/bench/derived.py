"""What each method's page derives that a frame fetches (section Cost), pass by pass, to be held against the count.

A pass costs its fragments times its fetches a fragment. Where passes cover the canvas, fragments are derived as well;
where tiles or geometry decide, those that were drawn are taken, and the fetches of each are derived.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from dofview.gl.fetches import Count
from dofview.gl.pull_push import KNOWN
from dofview.gl.pyramids import level_size, most_levels
from dofview.methods.multiview_layers import TILE as MASK_TILE
from dofview.methods.splatting_points import MOST_LEVELS, MOST_RADIUS, TILE
from dofview.render.frame import Frame
from dofview.settings import Settings


class Facts(NamedTuple):
    """What a derivation starts from: the frame and its settings, the frame's counters, what was drawn, and the images
    that passes left, by name."""

    frame: Frame
    settings: Settings
    counts: dict[str, int]
    drawn: list[Count]
    image: Callable[[str], np.ndarray]

    @property
    def canvas(self) -> int:
        """Pixels with the guard band."""
        return math.prod(self.frame.size)

    @property
    def picture(self) -> int:
        """Pixels without it."""
        return math.prod(self.frame.inner_size)

    def each(self, shader: str, fetches: Callable[[dict[str, object]], int]) -> int:
        """Fetches of all that was drawn by `shader`, of whose fragments each makes as many as `fetches` derives from
        what was compiled in."""
        return sum(fetches(one.defines) * one.fragments for one in self.drawn if one.shader == shader)

    def fragments(self, shader: str) -> int:
        """For how many fragments `shader` ran."""
        return self.each(shader, lambda defines: 1)

    def coarser(self, first: int, last: int) -> int:
        """Texels of the levels `first` to `last` over the canvas."""
        return sum(math.prod(level_size(self.frame.size, level)) for level in range(first, last + 1))


Fetches = dict[str, float]


def accumulation(facts: Facts) -> Fetches:
    """Each view is added once; at every doubling of the views two means are kept."""
    views = facts.settings.params.accumulation.views
    doublings = views.bit_length()
    return {"pass/copy.frag": (views + doublings) * facts.canvas, "render/mean.frag": (doublings + 1) * facts.canvas}


def mipmap(facts: Facts) -> Fetches:
    levels = max(most_levels(facts.frame.size) - facts.counts.get("mipmap levels skipped", 0), 1)
    smoothed = facts.frame.coc_range()[0] < 0.0
    return {
        "methods/mipmap/prepare.frag": 2 * facts.canvas,
        "methods/mipmap/reduce.frag": 48 * facts.coarser(1, levels),
        "methods/mipmap/neighbours.frag": 18 * facts.coarser(1, 1) * smoothed,
        "methods/mipmap/blend.frag": (19 + 3 * smoothed) * facts.canvas,
    }


def pyramid(facts: Facts) -> Fetches:
    subs, fills = (facts.counts.get(f"pyramid {what}", 0) for what in ("sub-images", "fills"))
    coarse = facts.coarser(1, most_levels(facts.frame.size))
    return {
        "methods/pyramid/sub_image.frag": (2 * subs + 2 * fills) * facts.canvas,
        # That of the sub-image in focus has no levels.
        "pass/reduce.frag": 4 / 3 * (subs - 1) * facts.canvas,
        "pass/expand.frag": 1 / 3 * (subs - 1) * facts.canvas,
        "methods/pyramid/blend.frag": 2 * subs * facts.canvas,
        "pass/pull.frag": 8 * fills * coarse,
        "pass/push.frag": 4 * fills * coarse,
    }


def splatting(facts: Facts) -> Fetches:
    """The search map says how far pixels look; a circle of that radius holds the points that they fetch."""
    near, far = facts.frame.coc_range()
    hidden = "splatting hidden passes skipped" not in facts.counts
    depths = facts.image("frame/pinhole inverse depth")
    in_front = float(np.mean(facts.frame.coc.radius_px(depths) < -0.5))
    reach = facts.image("splatting/reach")[::-1, :, :3]
    levels = reach.shape[0] // -(-facts.frame.size[1] // TILE) - 1
    widest = min(max(-near, far, facts.frame.coc.at_infinity * hidden), MOST_RADIUS)
    across = 2 * (int(widest) // TILE + 1) + 1
    return {
        "methods/splatting/hidden_limit.frag": (1 + 12 * in_front) * facts.canvas * hidden,
        "methods/splatting/brightness.frag": 4 * facts.coarser(1, MOST_LEVELS) * bool(levels),
        "methods/splatting/points.frag": 9 * facts.canvas,
        "methods/splatting/reduce.frag": 4 * facts.canvas * bool(levels),
        "methods/splatting/tiles.frag": 4 * facts.canvas,
        "methods/splatting/reach.frag": across**2 * (levels + 1) * facts.canvas / TILE**2,
        "methods/splatting/gather.frag": (_points(facts, reach, levels) + 2 + levels * (1 + hidden)) * facts.picture,
    }


def _points(facts: Facts, reach: np.ndarray, levels: int) -> float:
    """Points that a pixel of the picture looks at, in the mean over its tiles: a level's are 2^level px apart, and a
    sprite covers pixels whose middle is up to a rim away."""
    guard = facts.frame.guard // TILE
    found = 0.0
    for level, part in enumerate(np.split(reach, levels + 1)):
        seen = part[guard : part.shape[0] - guard, guard : part.shape[1] - guard]
        radius = np.maximum(seen, 0.0) / 2.0**level + (0.5 if level else 0.71)
        found += float((math.pi * radius**2 * (seen >= 0.0)).sum(axis=2).mean())
    return found


def multiview(facts: Facts) -> Fetches:
    """Of the layers that a mask leaves, half are walked before the ray stops; one or two probes in each, and its
    colour."""
    params, guard = facts.settings.params.multiview, facts.frame.guard // MASK_TILE
    mask = facts.image("multiview/tile mask")[..., 0]
    seen = np.ascontiguousarray(mask[guard : mask.shape[0] - guard, guard : mask.shape[1] - guard])
    layers = np.unpackbits(seen.view(np.uint8)).sum() / seen.size
    count = (facts.counts["multiview layers in reach"] + facts.counts["multiview layers skipped"]) / mask.size
    reached = facts.image("multiview/reaching").size
    return {
        "methods/multiview/occupied.frag": count / 4 * facts.canvas,
        "methods/multiview/spread.frag": 2 * 3 * reached * facts.canvas / 16,
        "methods/multiview/cones.frag": 4 * facts.fragments("methods/multiview/cones.frag"),
        "methods/multiview/trace.frag": (3 + params.samples * (1 + 2.5 * (layers + 1) / 2)) * facts.picture,
    }


def layered(facts: Facts) -> Fetches:
    """In a layer's tiles: depths and colours of the peels, the distance of the background, what is around the pixel
    behind the focus, and the buffer, filtered along y on the way by 2R + 1 taps."""
    peels = facts.counts["layered peels"]

    def joining(defines: dict[str, object]) -> int:
        buffer = {0: 0, 1: 2 * int(str(defines.get("TAPS", 1))) - 1}.get(int(str(defines["SOURCE"])), 1)
        around = 8 if "PRESENCE" in defines and "FRONT" not in defines else 0
        return 1 + peels + ("SKY" in defines) + around + buffer

    def filling(defines: dict[str, object]) -> int:
        if defines["KNOWN"] == KNOWN:
            return 4
        in_focus = 0 if "EMPTY" in defines else 1 + int(str(defines["PEELS"])) + ("SKY" in defines)
        return 4 * (in_focus + ("HAS_BACK" in defines))

    return {
        "methods/layered/depths.frag": max(peels, 2) * facts.canvas,
        "methods/layered/content.frag": (1 + (peels > 4)) * facts.canvas,
        "methods/layered/join.frag": facts.each("methods/layered/join.frag", joining),
        "pass/gaussian.frag": facts.each("pass/gaussian.frag", lambda defines: 2 * int(str(defines["TAPS"])) - 1),
        "pass/reduce.frag": 4 * facts.fragments("pass/reduce.frag"),
        "pass/expand.frag": facts.fragments("pass/expand.frag"),
        "pass/pull.frag": facts.each("pass/pull.frag", filling),
        "pass/push.frag": 2 * facts.fragments("pass/push.frag"),
        "methods/layered/final.frag": (peels + 5) * facts.picture,
    }  # fmt: skip


DERIVED: dict[str, Callable[[Facts], Fetches]] = {
    "accumulation": accumulation, "splatting": splatting, "multiview": multiview, "layered": layered,
    "pyramid": pyramid, "mipmap": mipmap,
}  # fmt: skip
