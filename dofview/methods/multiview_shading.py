"""What shaders are given where they light the surfaces that layers hold."""

from __future__ import annotations

from typing import NamedTuple

from pydantic import BaseModel, ConfigDict

from dofview.gl.passes import Textures
from dofview.lens import focal_px
from dofview.methods.multiview_layers import Layers, detail_shift
from dofview.render.frame import Frame

Vec3 = tuple[float, float, float]


class ViewBlock(BaseModel):
    """Directions to pixels and offsets of lens points in local space: `corner` + x `right` + y `up` reaches depth 1."""

    model_config = ConfigDict(frozen=True)

    corner: Vec3
    right: Vec3
    up: Vec3
    lens_right: Vec3
    lens_up: Vec3

    @classmethod
    def of(cls, frame: Frame) -> ViewBlock:
        right, up, backward = frame.camera.axes()
        focal = focal_px(frame.inner_size[1], frame.camera.vfov_deg)
        width, height = frame.size
        corner = -backward - right * (width / 2 / focal) - up * (height / 2 / focal)
        vectors = (corner, right / focal, up / focal, right * frame.lens.radius, up * frame.lens.radius)
        return cls(**dict(zip(cls.model_fields, (tuple(v.tolist()) for v in vectors), strict=True)))


class Shading(NamedTuple):
    """Blocks, textures and defines; nothing of them where layers hold light."""

    blocks: dict[str, BaseModel]
    textures: Textures
    defines: dict[str, int]


def shading(frame: Frame, layers: Layers) -> Shading:
    """Return what lighting the surfaces of `layers` takes."""
    if not layers.kind.surfaces:
        return Shading({}, {}, {})
    blocks: dict[str, BaseModel] = {"View": ViewBlock.of(frame), "Lights": frame.lights.block}
    return Shading(blocks, frame.lights.textures, {"SURFACES": 1, **frame.lights.defines})


def grid(layers: Layers) -> dict[str, float]:
    """Where the texels of `layers` are on the canvas, as shaders read it."""
    return {"detail": float(layers.detail), "detail_shift": detail_shift(layers.detail)}
