"""The tools of the viewer, in the order of their panels and of who is asked first what a file is."""

from __future__ import annotations

from dofview.viewer.auto import Auto
from dofview.viewer.browser import Browser
from dofview.viewer.cameras import Cameras
from dofview.viewer.compare import Compare
from dofview.viewer.focusing import Focusing
from dofview.viewer.gaze import Gaze
from dofview.viewer.heat import Heat
from dofview.viewer.history import History
from dofview.viewer.interface import Appearance
from dofview.viewer.judge import Judge
from dofview.viewer.loupe import Loupe
from dofview.viewer.measure import Measure
from dofview.viewer.messages import Messages
from dofview.viewer.opening import Opening
from dofview.viewer.optics import Optics
from dofview.viewer.output import Output
from dofview.viewer.palette import Help, Palette
from dofview.viewer.pictures import Pictures
from dofview.viewer.plots import Plots
from dofview.viewer.shots import Shots
from dofview.viewer.survey import Survey
from dofview.viewer.tool import Tool
from dofview.viewer.truth import Truth
from dofview.viewer.watching import Watching

TOOLS: tuple[type[Tool], ...] = (
    Truth,
    Pictures,
    Survey,
    Measure,
    Auto,
    Judge,
    Browser,
    Compare,
    Heat,
    Loupe,
    Plots,
    Focusing,
    Gaze,
    Optics,
    Cameras,
    Shots,
    Output,
    History,
    Watching,
    Appearance,
    Messages,
    Palette,
    Help,
    Opening,  # last: it takes files that nobody else wants
)
