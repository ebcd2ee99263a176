"""One side of the focus in `layered`: its layers blurred and blended into one buffer."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from dofview.gl.gaussian import convolve, kernel
from dofview.gl.passes import ADD, OVER, UNDER
from dofview.gl.pyramids import expand, level_size, reduce
from dofview.gl.targets import Image
from dofview.gl.tiles import Tiles, grown, upload
from dofview.methods.layered_peels import COMMON, NOTHING, Color, Peels
from dofview.methods.layered_plan import Layer
from dofview.methods.layered_regions import Step, steps

Weights = tuple[float, ...]

MOST_TAPS = 32
"""Weights of a filter that a joining layer applies on the way; a wider one is a pass of its own."""

UNCHANGED: Weights = (1.0, 0.0)


class Side:
    """All layers in front of the focus, or all behind it, blurred and blended; `inspect` keeps every step's images."""

    def __init__(self, peels: Peels, name: str, layers: Sequence[Layer], *, skip: bool, inspect: bool):
        self.peels = peels
        self.recipe = peels.recipe
        self.gpu = peels.recipe.gpu
        self.name = name
        self.layers = layers
        self.skip = skip
        self.inspect = inspect
        self.start = peels.start if name == "back" else NOTHING
        self._cleared: set[Image] = set()
        self._filled: list[Tiles | None] = []

    def cascaded(self) -> Image:
        """Blur recursively: a layer joins the buffer, the buffer is blurred, the next one joins (GPU Pro 4, p. 204)."""
        plan = steps(self.layers, self.peels.content, self.peels.window if self.skip else None)
        tiles = self._upload(plan)
        total = self._buffer()
        across: Image | None = None
        for number, (step, places) in enumerate(zip(plan, tiles, strict=True)):
            level = step.layer.level
            joined = self._image("joined", level, number)
            if across is None:
                self._join(step, joined, places)
            else:
                self._carry_on(across, plan[number - 1], tiles[number - 1], step, places, number, joined)
            if step.finished.any():
                weights = kernel(step.finish)
                across = self._convolved(joined, "finished across", level, weights, (1, 0), places.beyond)
                blurred = self._convolved(across, "finished", level, weights, (0, 1), places.around, number)
                self._enlarge(blurred, level, total, places.finished, places.around)
            across = self._convolved(joined, "across", level, kernel(step.sigma), (1, 0), places.after)
            if self.inspect:
                self._join(step, self._image("layer", level, number), places, alone=True)
                self._convolved(across, "blurred", level, kernel(step.sigma), (0, 1), places.after, number + 1)
        assert across is not None, "a side has a layer"
        level, weights = plan[-1].layer.level, kernel(plan[-1].sigma)
        if level == 0:
            self._convolve(across, total, 0, weights, (0, 1), tiles[-1].rest)
        else:
            blurred = self._convolved(across, "blurred", level, weights, (0, 1), tiles[-1].after, len(plan))
            self._enlarge(blurred, level, total, tiles[-1].rest, tiles[-1].after)
        return total

    def separate(self) -> Image:
        """Blur each layer by itself with the whole of its σ, and blend them."""
        total, start, self.start = self._buffer(), self.start, NOTHING
        self.gpu.targets.framebuffer((total,)).clear(*start)
        window = self.peels.window if self.skip else None
        plan = [steps([layer], self.peels.content, window)[0] for layer in self.layers]
        for number, (step, places) in enumerate(zip(plan, self._upload(plan), strict=True)):
            layer = step.layer
            self._cleared.clear()
            alone = self._image("layer", layer.level, number)
            self._join(replace(step, sigma=0.0), alone, places, alone=True)
            across = self._convolved(alone, "across", layer.level, kernel(step.sigma), (1, 0), places.after)
            blurred = self._convolved(across, "blurred", layer.level, kernel(step.sigma), (0, 1), places.after, number)
            if layer.level > 0:
                full = self._image("enlarged", 0)
                self._enlarge(blurred, layer.level, full, places.after, places.after)
                blurred = full
            blend = UNDER if self.name == "front" else OVER
            self.recipe.draw("pass/copy.frag", total, source=blurred, blend=blend, within=places.after)
        return total

    def _carry_on(
        self, across: Image, before: Step, held: Places, step: Step, places: Places, number: int, joined: Image
    ) -> None:
        """Finish the filter of the step `before`, which is done along x, and let the layer of `step` join."""
        former, level, weights = before.layer.level, step.layer.level, kernel(before.sigma)
        if former == level and len(weights) <= MOST_TAPS:
            self._convolve(across, joined, level, weights, (0, 1), places.others)
            self._join(step, joined, places, across=across, weights=weights)
            return
        blurred = self._convolved(across, "blurred", former, weights, (0, 1), held.after, number)
        if former == level:
            self._convolve(blurred, joined, level, UNCHANGED, (0, 1), places.others)
            self._join(step, joined, places, across=blurred)
            return
        if former > level + 1:
            finer = self._image("enlarged", level + 1)
            self._enlarge(blurred, former, finer, held.after, held.after, level + 1)
            blurred = finer
        self._enlarge(blurred, level + 1, joined, places.others, places.others, level)
        self._join(step, joined, places, coarse=blurred)

    def _join(
        self, step: Step, into: Image, places: Places, *, across: Image | None = None, coarse: Image | None = None,
        weights: Weights = UNCHANGED, alone: bool = False,
    ) -> None:  # fmt: skip
        """Draw the layer of `step` under or over what `across` holds, filtered along y by `weights`, or `coarse`, or
        the start.

        At a smaller size `into` holds that already. What the layer adds to it is drawn at full size and reduced by
        filters that move nothing; a mean of 2 × 2 pixels would move a point by half a pixel along each axis.
        """
        layer, before = step.layer, across or coarse
        added, under = layer.level > 0, self.name == "front" and not alone
        defines: dict[str, object] = {"SOURCE": 0, **({"FRONT": 1} if under else {}), **({"ADDED": 1} if added else {})}
        values: dict[str, object] = {"start": NOTHING if alone else self.start}
        if added and before:
            before = into if under else None
        if before and added:
            defines |= {"SOURCE": 2, "LEVEL": layer.level}
        elif before:
            defines |= {"SOURCE": 1, "TAPS": len(weights)} if across else {"SOURCE": 3}
        if defines["SOURCE"] == 1:
            values["weights"] = np.array(weights, np.float32).tobytes()
        target, clear = (self._emptied(places.own), False) if added else (into, self._clear(into))
        samplers = {"buffered": self.gpu.nearest} if defines["SOURCE"] in (1, 2) else {}
        for number, (peels, tiles) in enumerate(places.kinds):
            self.peels.draw(
                "join.frag", target, layer, reach=layer.reach * (step.sigma > 0.0), defines=defines, values=values,
                within=tiles, clear=clear if number == 0 else False, images={"buffered": before} if before else None,
                samplers=samplers, peels=peels,
            )  # fmt: skip
        if added:
            self._reduce(target, layer.level, into, places.near, ADD if self.name == "front" or alone else OVER)

    def _emptied(self, own: Tiles | None) -> Image:
        """The image, of full size, for what a layer adds in the tiles `own`: with nothing of the former layer's."""
        target = self.recipe.image(f"{self.name} added", linear=True)
        if not self._filled:
            self.gpu.targets.framebuffer((target,)).clear()
        for tiles in self._filled:
            self.recipe.draw("pass/clear.frag", target, within=tiles)
        self._filled = [own]
        return target

    def _reduce(self, fine: Image, level: int, into: Image, tiles: Tiles | None, blend: tuple) -> None:
        """Bring `fine`, of full size, to `level` and blend it into `into`."""
        with self.gpu.profile.section("layered/join"):
            for coarser in range(1, level):
                half = self._image("added half", coarser)
                reduce(self.gpu, fine, half, within=_at(tiles, coarser), clear=NOTHING)
                fine = half
            reduce(self.gpu, fine, into, blend=blend, within=_at(tiles, level), clear=self._clear(into))

    def _convolved(
        self, source: Image, what: str, level: int, weights: Weights, axis: tuple[int, int], tiles: Tiles | None,
        number: int = 0,
    ) -> Image:  # fmt: skip
        into = self._image(what, level, number)
        self._convolve(source, into, level, weights, axis, tiles)
        return into

    def _convolve(
        self, source: Image, into: Image, level: int, weights: Weights, axis: tuple[int, int], tiles: Tiles | None
    ) -> None:
        with self.gpu.profile.section("layered/blur"):
            convolve(self.gpu, source, into, weights, axis, within=_at(tiles, level), clear=self._clear(into))

    def _enlarge(
        self, coarse: Image, level: int, into: Image, tiles: Tiles | None, around: Tiles | None, to: int = 0
    ) -> None:
        """Bring `coarse` from `level` to the finer level `to`, doubling by doubling, last in `tiles` of `into`."""
        with self.gpu.profile.section("layered/blur"):
            for finer in reversed(range(to + 1, level)):
                half = self._image("halfway", finer)
                expand(self.gpu, coarse, half, within=_at(around, finer), clear=self._clear(half))
                coarse = half
            expand(self.gpu, coarse, into, within=_at(tiles, to), clear=self._clear(into))

    def _clear(self, image: Image) -> Color | bool:
        """What to clear `image` to before its first use. Later steps draw at least the same tiles of it again."""
        if image in self._cleared:
            return False
        self._cleared.add(image)
        return self.start

    def _buffer(self) -> Image:
        return self.recipe.image(f"{self.name} buffer")

    def _image(self, what: str, level: int, number: int = 0) -> Image:
        """An image of one level; with `inspect`, one of its own for every layer."""
        name = f"{self.name} {number:02d} {what}" if self.inspect else f"{self.name} level {level} {what}"
        return self.recipe.image(name, level_size(self.recipe.frame.size, level), linear=True)

    def _upload(self, plan: Sequence[Step]) -> list[Places]:
        count = len(self.peels.colors)
        kinds = [self._kinds(step, count) for step in plan]
        masks = [mask for step in plan for mask in _masks(step)]
        self.gpu.profile.count("layered tiles skipped", sum(int((~mask).sum()) for mask in masks))
        masks += [where for found in kinds for _, where in found]
        tiles = iter(upload(self.gpu.targets, f"layered/{self.name} tiles", masks, self.recipe.frame.size))
        main = [[next(tiles) for _ in range(len(Places._fields) - 1)] for _ in plan]
        return [
            Places([(peels, next(tiles)) for peels, _ in found], *lists)
            for found, lists in zip(kinds, main, strict=True)
        ]

    def _kinds(self, step: Step, count: int) -> list[tuple[int, np.ndarray]]:
        """The tiles that the layer joins in, by how many of its `count` peels have to be looked at. Too long a list is
        drawn everywhere; those that look at more come later, so they are drawn over it."""
        deep = self.peels.content.deep(step.layer)
        if not self.skip or count <= COMMON or deep.all():
            return [(count, step.own)]
        return [(COMMON, step.own & ~deep), (count, step.own & deep)]


class Places(NamedTuple):
    """Where the passes of a step are drawn, as `Step` has it; filters along y and changes of size read beyond that. Of
    `kinds`, the tiles `own` by the surfaces that are looked at there, together they are all."""

    kinds: list[tuple[int, Tiles | None]]
    own: Tiles | None
    near: Tiles | None
    others: Tiles | None
    after: Tiles | None
    finished: Tiles | None
    around: Tiles | None
    beyond: Tiles | None
    rest: Tiles | None


def _masks(step: Step) -> list[np.ndarray]:
    """Those of `Places` but for the kinds."""
    near, around = grown(step.own, 1), grown(step.finished, 1)
    return [step.own, near, step.others, step.after, step.finished, around, grown(around, 1), step.rest]


def _at(tiles: Tiles | None, level: int) -> Tiles | None:
    return tiles.at(level) if tiles else None
