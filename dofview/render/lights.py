"""What lights a scene: lights and a sky that stand with the camera, or an environment that stands in the world."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from pydantic import BaseModel, ConfigDict

from dofview.gl.passes import Textures
from dofview.render.environment import LEVELS, Environment
from dofview.scene.camera import Camera

Vec4 = tuple[float, float, float, float]
DARK: Vec4 = (0.0, 0.0, 0.0, 0.0)


class LightsBlock(BaseModel):
    """Three directional lights and a sky that stand with the camera, as VTK's light kit does: a scene is lit well from
    every side, and a scene turned together with its camera looks the same. Directions point to the light."""

    model_config = ConfigDict(frozen=True)

    key_direction: Vec4
    key_radiance: Vec4 = (2.7, 2.6, 2.4, 0.0)
    fill_direction: Vec4
    fill_radiance: Vec4 = (0.55, 0.6, 0.7, 0.0)
    back_direction: Vec4
    back_radiance: Vec4 = (0.4, 0.4, 0.45, 0.0)
    up: Vec4
    zenith: Vec4 = (0.42, 0.46, 0.52, 0.0)
    ground: Vec4 = (0.16, 0.145, 0.13, 0.0)

    @classmethod
    def at(cls, camera: Camera) -> LightsBlock:
        """The rig of a camera, in world directions."""
        axes = camera.axes()

        def direction(right: float, up: float, backward: float) -> Vec4:
            toward = np.array([right, up, backward]) @ axes
            return (*(toward / np.linalg.norm(toward)).tolist(), 0.0)

        return cls(
            key_direction=direction(-0.5, 0.75, 0.7), fill_direction=direction(0.9, 0.15, 0.6),
            back_direction=direction(0.2, 0.6, -0.9), up=direction(0.0, 1.0, 0.0),
        )  # fmt: skip


@dataclass(frozen=True)
class Lights:
    """All that include/shading.glsl needs; an environment takes the place of lights and sky."""

    block: LightsBlock
    environment: Environment | None = None

    @classmethod
    def of(cls, camera: Camera, environment: Environment | None) -> Lights:
        """The lights of a picture seen by `camera`."""
        block = LightsBlock.at(camera)
        if environment is not None:
            block = block.model_copy(update={"key_radiance": DARK, "fill_radiance": DARK, "back_radiance": DARK})
        return cls(block, environment)

    @property
    def defines(self) -> dict[str, int]:
        return {"ENVIRONMENT_LEVELS": LEVELS} if self.environment else {}

    @property
    def textures(self) -> Textures:
        return {"environment_map": self.environment.texture} if self.environment else {}
