"""Images laid upon one another on a canvas: what a screen shows of several pictures at once, as one image."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from dofview.gl.context import Gpu
from dofview.gl.passes import OVER, draw
from dofview.gl.targets import Image

Color = tuple[float, float, float, float]


class Part(NamedTuple):
    """The part of a picture that is seen: shares of its width and height, from its upper left."""

    left: float = 0.0
    top: float = 0.0
    width: float = 1.0
    height: float = 1.0


WHOLE = Part()


class Box(NamedTuple):
    """A rectangle of a canvas, pixels from its upper left."""

    left: int
    top: int
    width: int
    height: int

    def cut(self, other: Box) -> Box:
        """What both have in common; its width and height may be 0."""
        left, top = max(self.left, other.left), max(self.top, other.top)
        right = min(self.left + self.width, other.left + other.width)
        bottom = min(self.top + self.height, other.top + other.height)
        return Box(left, top, max(right - left, 0), max(bottom - top, 0))


class Layer(NamedTuple):
    """The `part` of an image, or a colour, on the `box` of the canvas; of that only what lies `within` is drawn.

    `label` names what a picture shows; what is laid over pictures has none.
    """

    image: Image | Color
    box: Box
    part: Part = WHOLE
    within: Box | None = None
    label: str = ""


def compose(gpu: Gpu, layers: Iterable[Layer], size: tuple[int, int], name: str, *, linear: bool = False) -> Image:
    """Draw `layers`, the lowest first, on black, into the image `name` of `size`: 8 bits as a screen shows them.

    With `linear` it is linear light, for which 8-bit layers are decoded and others taken as they are.
    """
    canvas = gpu.targets.image(name, size, dtype="f4" if linear else "f1", linear=not linear)
    gpu.targets.framebuffer([canvas]).clear(color=(0.0, 0.0, 0.0, 1.0))
    for layer in layers:
        visible = layer.box.cut(Box(0, 0, *size)).cut(layer.within or layer.box)
        if visible.width and visible.height:
            _place(gpu, layer, visible, canvas, linear)
    return canvas


def fitted(gpu: Gpu, image: Image, size: tuple[int, int], name: str, *, linear: bool = False) -> Image:
    """Return the whole of `image` as large as it fits into `size`, in the middle, in the image `name`."""
    return compose(gpu, [Layer(image, fit(image.size, Box(0, 0, *size)))], size, name, linear=linear)


def fit(size: tuple[int, int], room: Box) -> Box:
    """The largest box in the middle of `room` with the proportions of `size`."""
    scale = min(room.width / size[0], room.height / size[1])
    width, height = max(round(size[0] * scale), 1), max(round(size[1] * scale), 1)
    return Box(room.left + (room.width - width) // 2, room.top + (room.height - height) // 2, width, height)


def _place(gpu: Gpu, layer: Layer, visible: Box, canvas: Image, linear: bool) -> None:
    height = canvas.size[1]
    viewport = (visible.left, height - visible.top - visible.height, visible.width, visible.height)
    solid = not isinstance(layer.image, Image)
    decoded = linear and (solid or layer.image.shape.dtype == "f1")  # type: ignore[union-attr]
    defines = {name: 1 for name, wanted in (("SOLID", solid), ("DECODE", decoded)) if wanted}
    values: dict[str, object] = {"solid": layer.image}
    if not solid:
        values = {"place": tuple(map(float, layer.box)), "part": tuple(layer.part), "canvas_height": float(height)}
    draw(
        gpu, "pass/place.frag", canvas, textures={} if solid else {"source": layer.image},  # type: ignore[dict-item]
        values=values, defines=defines, blend=OVER, viewport=viewport,
    )  # fmt: skip
