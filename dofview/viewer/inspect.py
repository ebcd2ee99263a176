"""Shows any image of the pool in a range, and reads single texels of it."""

from __future__ import annotations

from enum import StrEnum

import numpy as np
from pydantic import BaseModel, ConfigDict

from dofview.gl.context import Gpu
from dofview.gl.passes import draw
from dofview.gl.targets import Image


class Channel(StrEnum):
    """What of a texel is shown."""

    COLOUR = "colour"
    RED = "red"
    GREEN = "green"
    BLUE = "blue"
    ALPHA = "alpha"


class Inspect(BaseModel):
    """The range, channel and layer that are shown; `low` is black, `high` white."""

    model_config = ConfigDict(frozen=True, allow_inf_nan=False)

    low: float = 0.0
    high: float = 1.0
    channel: Channel = Channel.COLOUR
    layer: int = 0
    light: bool = True
    """Colours are linear light and shown with the sRGB curve, as pictures are; single channels are numbers."""


def develop(gpu: Gpu, image: Image, inspect: Inspect, name: str) -> Image:
    """Return `image` as 8-bit values in the image `name`."""
    shown = gpu.targets.image(name, image.size, dtype="f1", linear=True)
    draw(
        gpu, "viewer/inspect.frag", shown, textures={"source": image}, blocks={"Inspect": inspect},
        defines=_defines(image),
    )  # fmt: skip
    return shown


def texel(gpu: Gpu, image: Image, x: int, y: int, layer: int = 0) -> np.ndarray:
    """Values of one texel, (components,) float32; `y` counts from the top. Waits for the GPU."""
    value = gpu.targets.image("loupe/value", (1, 1))
    draw(
        gpu, "viewer/inspect.frag", value, textures={"source": image}, blocks={"Inspect": Inspect(layer=layer)},
        values={"texel": (x, image.size[1] - 1 - y)}, defines={**_defines(image), "VALUE": 1},
    )  # fmt: skip
    return value.pixels()[0, 0, : image.shape.components]


def _defines(image: Image) -> dict[str, int]:
    integer, layered = image.shape.dtype[0] in "iu", image.shape.layers > 0
    return {name: 1 for name, wanted in (("INTEGER", integer), ("LAYERED", layered)) if wanted}


def extremes(image: Image, channel: Channel, layer: int) -> tuple[float, float]:
    """Least and greatest finite value of what is shown; reads the whole image back."""
    pixels = image.pixels()[layer] if image.shape.layers else image.pixels()
    index = list(Channel).index(channel)
    values = pixels[..., :3] if index == 0 else pixels[..., min(index, pixels.shape[-1]) - 1]
    values = values[np.isfinite(values)]
    low, high = (float(values.min()), float(values.max())) if values.size else (0.0, 1.0)
    return (low, high) if high > low else (low, low + 1.0)
