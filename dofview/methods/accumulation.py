"""The reference as a method: the scene drawn through many points of the lens and averaged.

Paul Haeberli and Kurt Akeley: The Accumulation Buffer. SIGGRAPH 1990. The work is in `render/reference.py`, which the
window also runs a few views at a time.
"""

from __future__ import annotations

from pydantic import Field

from dofview.gl.targets import Image
from dofview.methods.method import Params as BaseParams
from dofview.render.frame import Frame
from dofview.render.reference import Reference

TITLE = "Accumulation buffer (reference)"
CITATION = (
    "P. Haeberli, K. Akeley. The Accumulation Buffer: Hardware Support for High-Quality Rendering. SIGGRAPH 1990."
)
REQUIRES_GL = 330
GUARD_BAND = False
QUALITIES = ({"views": 4}, {"views": 16}, {"views": 64})


class Params(BaseParams):
    """How many views, and how they are placed."""

    views: int = Field(
        default=256, ge=1, le=65536, description="Views through the lens.", json_schema_extra={"symbol": "N"}
    )
    antialias: bool = Field(default=False, description="Also move each view inside the pixel.")
    progressive: bool = Field(
        default=False, description="Scrambled Sobol points, good at every count, instead of a spiral for a fixed one."
    )
    skip: bool = Field(default=True, description="Leave out work that cannot change the picture.")


def render(frame: Frame, params: Params) -> Image:
    """Return the mean of `params.views` views."""
    total = None if params.progressive else params.views
    reference = Reference(frame, antialias=params.antialias, total=total)
    # Through a closed lens all views are one, unless they move inside the pixel.
    name = "accumulation views skipped"
    closed = frame.lens.radius == 0.0 and not params.antialias
    views = 1 if closed and params.skip and frame.gpu.profile.may_skip(name) else params.views
    frame.gpu.profile.count(name, params.views - views)
    reference.add(views)
    return reference.mean()
