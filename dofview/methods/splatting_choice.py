"""Which of the two ways to sum sprites is the faster one on the machine at hand."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from enum import StrEnum
from typing import TYPE_CHECKING

import numpy as np

from dofview.gl.targets import Image
from dofview.methods.method import Recipe
from dofview.methods.splatting_aperture import DISC
from dofview.methods.splatting_points import EVERY, Points, constants
from dofview.render.frame import Frame

if TYPE_CHECKING:
    from dofview.methods.splatting import Params

SIDE, RADIUS = 128, 8.0
"""The trial: a square of points of one CoC, px."""

TIMES = 3


class Computation(StrEnum):
    """How the sprites are summed; the picture is the same."""

    AUTO = "auto"
    GATHER = "gather"
    SCATTER = "scatter"


Way = Callable[[Recipe, Points, Image, "Params"], None]


def faster(frame: Frame, ways: Mapping[Computation, Way], params: Params) -> Computation:
    """The way that takes less time here: on a GPU both are tried once for a context, with `TIMES` small pictures.

    A software rasteriser is not tried. It is known to gather faster, two to four times, and trying would take it longer
    than a frame.
    """
    gpu = frame.gpu
    if gpu.software:
        return Computation.GATHER
    if "splatting computation" not in gpu.facts:
        counts, timing = gpu.profile.counts.copy(), gpu.profile.timing
        gpu.profile.timing = False
        took = trial(frame, ways, params)
        gpu.profile.counts, gpu.profile.timing = counts, timing
        gpu.facts["splatting computation"] = min(took, key=lambda way: took[way])
    return gpu.facts["splatting computation"]  # type: ignore[return-value]


def trial(frame: Frame, ways: Mapping[Computation, Way], params: Params) -> dict[Computation, float]:
    """Seconds that each way takes, the least of `TIMES` after a first one that compiles."""
    small = Frame(frame.gpu, frame.scene, frame.camera, frame.lens, (SIDE, SIDE))
    # Nothing is left out, so that the scene itself is not asked for.
    params = params.model_copy(update={"skip": False, "inspect": False})
    recipe = Recipe(small, "splatting", params)
    source, picture = recipe.image("trial points"), recipe.image("trial")
    source.write(np.full((SIDE, SIDE, 4), (0.5, 0.5, 0.5, 64.0 * RADIUS + 0.66), np.float32))
    points = Points(
        visible=[(source,)], hidden=[], sprites=None, sprite=DISC, widest=RADIUS, merged_from=EVERY,
        flags=constants(levels=0, sprite=DISC),
    )  # fmt: skip
    took = {}
    for way, draw in ways.items():
        found = []
        for _ in range(TIMES + 1):
            frame.gpu.ctx.finish()
            start = time.perf_counter()
            draw(recipe, points, picture, params)
            frame.gpu.ctx.finish()
            found.append(time.perf_counter() - start)
        took[way] = min(found[1:])
    return took
