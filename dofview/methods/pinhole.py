"""No lens at all: everything sharp. What the methods start from, and what aperture 0 must give."""

from __future__ import annotations

from dofview.gl.targets import Image
from dofview.methods.method import Params as BaseParams
from dofview.render.frame import Frame

TITLE = "Pinhole"
CITATION = "A camera with a point for a lens."
REQUIRES_GL = 330
GUARD_BAND = True


class Params(BaseParams):
    """A pinhole has nothing to set."""


def render(frame: Frame, params: Params) -> Image:
    """Return the nearest surfaces' colour."""
    return frame.pinhole().color
