"""Where things stand on the screen: pictures by their methods, lines, names, legends, as layers of one canvas."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from dofview.gl.compose import Box, Layer, Part
from dofview.gl.context import Gpu
from dofview.gl.targets import Image
from dofview.methods import method
from dofview.seen import labels, overlays
from dofview.seen.model import Arrangement, Difference, Seen

GAP_PX = 2
WHITE, SHADE, DARK = (1.0, 1.0, 1.0, 1.0), (0.0, 0.0, 0.0, 0.75), (0.06, 0.06, 0.06, 0.75)
LEGEND_EM = 20.0


def layers(
    gpu: Gpu, seen: Seen, names: Sequence[str], pictures: Mapping[str, Image], size: tuple[int, int],
    overlay: Image | None = None,
) -> list[Layer]:  # fmt: skip
    """What is seen on a canvas of `size`: a place for each of `names`, the one in use first unless they are a grid.

    `pictures` are as they are to be shown; the place of one that is not there yet stays empty. `overlay` is laid over
    each.
    """
    canvas = Box(0, 0, *size)
    found: list[Layer] = []
    words = Words(gpu, seen.text_px)
    boxes = cells(len(names), canvas) if seen.arrangement is Arrangement.GRID else []
    if boxes:
        for name, box in zip(names, boxes, strict=False):
            found += [Layer(pictures[name], box, seen.part, label=name)] if name in pictures else []
            words.put(_title(name, box.width, seen.text_px), box, foot=True)
    else:
        line = round(seen.split * size[0])
        halves = (Box(0, 0, line, size[1]), Box(line, 0, size[0] - line, size[1]))
        for number, name in enumerate(names):
            within = halves[number] if len(names) == 2 else canvas
            found += [Layer(pictures[name], canvas, seen.part, within, name)] if name in pictures else []
    if overlay is not None:
        found += [layer._replace(image=overlay, label="") for layer in found]
    if seen.arrangement is Arrangement.WIPE and len(names) == 2:
        found += _line(line, size)
        for name, half, right in zip(names, halves, (True, False), strict=True):
            words.put(_title(name, half.width, seen.text_px), half, foot=True, right=right)
    if any(seen.covers(name) for name in names):
        found += _legend(gpu, seen, words, _legend_room(seen, canvas, boxes, len(names)))
    return found + words.layers()


def cells(count: int, canvas: Box) -> list[Box]:
    """Boxes of a grid with the proportions of the canvas, in its middle: `count` and those that are left empty."""
    columns = max(math.ceil(math.sqrt(count)), 1)
    rows = max(math.ceil(count / columns), 1)
    share = max(columns, rows)
    width, height = canvas.width // share, canvas.height // share
    left, top = (canvas.width - columns * width) // 2, (canvas.height - rows * height) // 2
    return [
        Box(left + number % columns * width, top + number // columns * height,
            max(width - GAP_PX, 1), max(height - GAP_PX, 1)) for number in range(columns * rows)
    ]  # fmt: skip


class Words:
    """Lines of text and where they go; they share one image, so all are known before one is drawn."""

    def __init__(self, gpu: Gpu, text_px: float):
        self._gpu, self._text_px = gpu, text_px
        self._put: list[tuple[str, Box, bool, bool]] = []

    def put(self, text: str, room: Box, *, foot: bool = False, right: bool = False) -> None:
        """Write `text` into a corner of `room`, which cuts it off."""
        self._put.append((text, room, foot, right))

    def layers(self) -> list[Layer]:
        """Each of them at its place."""
        if not self._put:
            return []
        pixels, boxes = labels.drawn(tuple(text for text, *_ in self._put), self._text_px)
        height, width = pixels.shape[:2]
        image = self._gpu.targets.image("seen/words", (width, height), dtype="f1", linear=True)
        image.write(pixels)
        margin, found = round(0.4 * self._text_px), []
        for (_, room, foot, right), box in zip(self._put, boxes, strict=True):
            left = room.left + (room.width - box.width - margin if right else margin)
            top = room.top + (room.height - box.height - margin if foot else margin)
            part = Part(box.left / width, box.top / height, box.width / width, box.height / height)
            found.append(Layer(image, Box(left, top, box.width, box.height), part, room))
        return found


def _line(x: int, size: tuple[int, int]) -> list[Layer]:
    return [Layer(SHADE, Box(x - 1, 0, 3, size[1])), Layer(WHITE, Box(x, 0, 1, size[1]))]


def _title(name: str, width: int, text_px: float) -> str:
    """The method's title, or its short name where that does not fit."""
    title = method(name).TITLE
    return title if labels.drawn((title,), text_px)[1][0].width + text_px <= width else name


def _legend_room(seen: Seen, canvas: Box, boxes: list[Box], used: int) -> Box:
    """Where the scale of an error map may be, in its lower left: the top of what a grid leaves empty, else all of the
    canvas above the names."""
    if len(boxes) > used:
        first, last = boxes[used], boxes[-1]
        height = min(_legend_height(seen.text_px), first.height)
        return Box(first.left, first.top, last.left + last.width - first.left, height)
    names = labels.line_height(seen.text_px) if seen.arrangement is Arrangement.WIPE else 0
    return canvas._replace(height=canvas.height - names)


def _legend_height(em: float) -> int:
    """Pixels that the scale takes with what is around it."""
    return 2 * labels.line_height(em) + round(0.9 * em) + 3 * round(0.4 * em) + 2 * round(0.5 * em)


def _legend(gpu: Gpu, seen: Seen, words: Words, within: Box) -> list[Layer]:
    """The scale of an error map in the lower left corner of `within`, with its ends and what it measures in words."""
    em, line = seen.text_px, labels.line_height(seen.text_px)
    margin = round(0.5 * em)
    width, bar = min(round(LEGEND_EM * em), within.width - 2 * margin), round(0.9 * em)
    height = _legend_height(em) - 2 * margin
    room = Box(within.left + margin, within.top + within.height - margin - height, width, height).cut(within)
    end = 1.0 / seen.heat.gain
    signed = seen.heat.difference is Difference.SIGNED
    words.put(f"{seen.heat.difference.value} error against the reference", room)
    words.put(f"-{end:.3g}" if signed else "0", room, foot=True)
    words.put(f"{'+' if signed else ''}{end:.3g}", room, foot=True, right=True)
    inset = round(0.7 * em)
    place = Box(room.left + inset, room.top + line + round(0.6 * em), max(room.width - 2 * inset, 1), bar)
    return [Layer(DARK, room), Layer(overlays.scale(gpu, seen.heat), place, within=room)]
