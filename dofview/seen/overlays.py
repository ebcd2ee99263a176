"""What is drawn from a picture for the eye: the map of its error with the map's scale, and the band in focus."""

from __future__ import annotations

from dofview.gl.context import Gpu
from dofview.gl.passes import draw
from dofview.gl.targets import Image
from dofview.render.frame import Frame
from dofview.seen.model import Band, HeatSettings

LEGEND_PX = 256


def error_map(gpu: Gpu, image: Image, reference: Image, how: HeatSettings, name: str) -> Image:
    """Return the difference of two linear pictures as colours in the 8-bit image `name`."""
    into = gpu.targets.image(name, image.size, dtype="f1", linear=True)
    draw(
        gpu, "render/error_map.frag", into, textures={"first": image, "second": reference}, blocks={"Heat": how}
    )  # fmt: skip
    return into


def scale(gpu: Gpu, how: HeatSettings, name: str = "seen/scale") -> Image:
    """Return the colours of the map from one end to the other, a row of pixels."""
    into = gpu.targets.image(name, (LEGEND_PX, 1), dtype="f1", linear=True)
    draw(gpu, "render/error_map.frag", into, blocks={"Heat": how}, defines={"LEGEND": 1})
    return into


def in_focus(gpu: Gpu, frame: Frame, size: tuple[int, int], band: Band, name: str) -> Image:
    """Return a tint of what is in focus in `frame`, with its limits, clear elsewhere, in the 8-bit image `name`."""
    into = gpu.targets.image(name, size, dtype="f1", linear=True)
    scales = tuple(inner / outer for inner, outer in zip(frame.inner_size, size, strict=True))
    draw(
        gpu, "render/focus_band.frag", into, textures={"inverse_depth": frame.pinhole().inverse_depth},
        blocks={"Lens": frame.lens_block, "Band": band}, values={"scale": scales, "guard": frame.guard},
    )  # fmt: skip
    return into
