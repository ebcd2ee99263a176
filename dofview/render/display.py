"""From a linear picture to what a screen shows: exposure, tone curve, sRGB."""

from __future__ import annotations

from enum import StrEnum

from pydantic import BaseModel, ConfigDict, Field

from dofview.gl.context import Gpu
from dofview.gl.passes import draw
from dofview.gl.targets import Image


class Tonemap(StrEnum):
    """Curves of `shaders/render/display.frag`, each with its source there."""

    LINEAR = "linear"
    REINHARD = "reinhard"
    ACES = "aces"
    NEUTRAL = "neutral"


class Display(BaseModel):
    """How linear light is shown; changes nothing that is measured."""

    model_config = ConfigDict(frozen=True, allow_inf_nan=False)

    exposure_ev: float = Field(
        default=0.0, ge=-16.0, le=16.0, description="Exposure, stops.", json_schema_extra={"unit": "EV"}
    )
    tonemap: Tonemap = Field(default=Tonemap.LINEAR, description="Tone curve applied before sRGB.")


def show(gpu: Gpu, picture: Image, display: Display, name: str) -> Image:
    """Return `picture` as 8-bit sRGB in the image `name`."""
    shown = gpu.targets.image(name, picture.size, dtype="f1", linear=True)
    draw(gpu, "render/display.frag", shown, textures={"picture": picture}, blocks={"Display": display})
    return shown
