"""The tools of the viewer, in the order of their panels."""

from __future__ import annotations

from dofview.viewer.measure import Measure
from dofview.viewer.tool import Tool

TOOLS: tuple[type[Tool], ...] = (Measure,)
