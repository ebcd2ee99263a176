"""Lenses to begin with: cameras, and an eye before a screen."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from imgui_bundle import imgui
from pydantic import BaseModel, ConfigDict, Field

from dofview.lens import CAMERAS, HumanEye, Photographic
from dofview.viewer.actions import Action
from dofview.viewer.tool import Tool
from dofview.viewer.widgets import edit

if TYPE_CHECKING:
    from dofview.viewer.app import App


class Measures(BaseModel):
    """How real lenses fit the scene."""

    model_config = ConfigDict(frozen=True, allow_inf_nan=False)

    unit_m: float = Field(
        default=1.0, gt=0.0, ge=1e-4, le=1e4, json_schema_extra={"unit": "m"},
        description="Length of a scene unit, metres; with 0.01 a scene in centimetres is seen through a real lens.",
    )  # fmt: skip
    keep_view: bool = Field(default=False, description="Take the aperture alone and leave the angle of view as it is.")


class Optics(Tool):
    """Sets aperture and angle of view as a real lens has them."""

    title = "Real lenses"

    def __init__(self) -> None:
        self.eye = HumanEye()
        self.measures = Measures()

    def actions(self) -> tuple[Action, ...]:
        return (
            *(Action(f"Lens: {name}", 0, "", f"Focal length and aperture of this lens: {name}.",
                     partial(self.apply, lens=lens), "Lens") for name, lens in CAMERAS.items()),
            Action("Lens: human eye", 0, "", "The eye before a screen of Lee 2009 (mipmap): pupil 4 mm, screen at 3 m.",
                   lambda app: self.apply(app, self.eye), "Lens"),
        )  # fmt: skip

    def apply(self, app: App, lens: Photographic | HumanEye) -> None:
        """Set aperture and, unless it is kept, the angle of view."""
        settings = app.settings
        changed = settings.lens.model_copy(update={"radius": lens.radius(self.measures.unit_m)})
        settings = settings.with_(lens=changed)
        if not self.measures.keep_view:
            angle = lens.vfov_deg(settings.image.size[1]) if isinstance(lens, HumanEye) else lens.vfov_deg()
            settings = settings.with_(camera=settings.camera.model_copy(update={"vfov_deg": angle}))
        app.settings = settings

    def panel(self, app: App) -> None:
        self.measures = edit(self.measures)
        for name, lens in CAMERAS.items():
            if imgui.button(name, (-1.0, 0.0)):
                self.apply(app, lens)
        if imgui.button("Human eye before a screen", (-1.0, 0.0)):
            self.apply(app, self.eye)
        eye = edit(self.eye, ranges={
            "focal_length_mm": (10.0, 25.0), "pupil_mm": (0.0, 9.0), "retina_mm": (15.0, 30.0),
            "screen_distance_mm": (200.0, 10000.0), "dots_per_mm": (0.1, 20.0),
        })  # fmt: skip
        if eye != self.eye:
            self.eye = eye
            self.apply(app, eye)
