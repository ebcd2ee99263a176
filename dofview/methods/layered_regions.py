"""Where the layers of `layered` are, and where each of its passes has something to do.

Numbers only, no GL. Surfaces are known by cells of 8 × 8 pixels, passes are drawn by tiles of 4 × 4 cells.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from dofview.gl.tiles import TILE, coarser, grown
from dofview.lens import CocLaw
from dofview.methods.layered_plan import Layer, Plan, cascade, finishing

CELL = 8
SLICES = 128

MARGIN = 0.9e-5
"""A little less than that of `matte.glsl`: within it of an end of a layer's interval a surface has no part in it."""

ROUNDING = 2.0**-22

FARTHEST_SKY = 48
"""Cells. No blur lets the background shine through that far from where it is seen."""

CLOSED = (0.8, 1.5)
"""σ. A pixel in front of the focus that is the second of these away from all that is not lets nothing of it through."""

REACH = 5.0
"""How far a blur reaches, in σ: less than 1e-6 of it lies beyond."""


class Content:
    """In which slices of depth each cell has surfaces; arrays are (rows, columns), row 0 the bottom one, as in GL.

    Made of the two images of `content.frag`: `bits` (rows, columns, 4) uint32, nearest slice first, and `extremes`
    (rows, columns, 4), the greatest and least 1/z in the first slice of a cell and in the last; and of `farthest`, the
    least 1/z of what is visible, 0 where it is background. Peels that hold little have a content of their own, `deep`.
    """

    def __init__(
        self, nearest: float, slices_per_depth: float, bits: np.ndarray, extremes: np.ndarray,
        farthest: np.ndarray | None = None, deep: Content | None = None,
    ):  # fmt: skip
        self.nearest = nearest
        self.slices_per_depth = slices_per_depth
        self._words = [np.ascontiguousarray(bits[..., i]) for i in range(4)]
        self._extremes = [np.ascontiguousarray(extremes[..., i], np.float64) for i in range(4)]
        self.shape = bits.shape[:2]
        self._farthest = np.full(self.shape, np.inf) if farthest is None else farthest[..., 0]
        self._deep = deep

    def cells(self, layer: Layer) -> np.ndarray:
        """The cells that may have something of `layer`, (rows, columns) bool: its interval, and those it shares."""
        front, ahead, own, behind = layer.anchors
        # Depths and anchors are rounded to 24 bits in shaders.
        near = front - MARGIN * (ahead - own) * (front == ahead) + ROUNDING * abs(front)
        far = behind + MARGIN * (own - behind) - ROUNDING * abs(behind)
        first, last = (int(min(max((self.nearest - z) * self.slices_per_depth, 0.0), SLICES - 1)) for z in (near, far))
        wanted = ((1 << (last - first + 1)) - 1) << first
        found = (self._extremes[0] >= far) & (self._extremes[1] <= near)
        found |= (self._extremes[2] >= far) & (self._extremes[3] <= near)
        for number, word in enumerate(self._words):
            if wanted >> 32 * number & 0xFFFFFFFF:
                found |= (word & np.uint32(wanted >> 32 * number & 0xFFFFFFFF)) != 0
        return found | self._deep.cells(layer) if self._deep else found

    def deep(self, layer: Layer) -> np.ndarray:
        """The tiles where the peels that hold little may have something of `layer`, (rows, columns) bool; all for the
        farthest layer, as the background is in it, which a pixel has behind its last surface."""
        if self._deep and not layer.farthest:
            return tiled(self._deep.cells(layer))
        return np.ones_like(tiled(self._farthest > 0.0))

    def sky_distance(self) -> np.ndarray:
        """How far the background is that can be seen, px, (rows, columns) float32; along the axes or diagonals, up to
        `FARTHEST_SKY` cells."""
        return _distance(self._farthest <= 0.0, FARTHEST_SKY)

    def closed(self, law: CocLaw, sigma: float, first: float) -> np.ndarray:
        """Where the front buffer has to be opaque, 0 to 1, (rows, columns) float32: where all that is visible is in
        front of the focus, as far around as its blur, `sigma` for a CoC radius of 1 px, lets anything through.

        `first` is the CoC radius of the first layer in front of the focus, px: what is nearer to the focus is not
        opaque in that buffer, but in part in focus.
        """
        radius = np.maximum(-law.radius_px(np.minimum(self._farthest, self.nearest)), 0.0)
        most = math.ceil(CLOSED[1] * sigma * float(radius.max()) / CELL) + 2
        # What is not in front may be anywhere in its cell. At a silhouette its whole cell is let off, or the rim of
        # what is in front would be opaque; where a steep surface comes into focus, half of one.
        behind = radius <= first
        edges = behind & grown(_jumps(radius, 0, first) | _jumps(radius, 1, first), 1)
        distance = np.minimum(_distance(behind, most) - 0.5 * CELL, _distance(edges, most) - CELL)
        inside = _smoothstep(*CLOSED, distance / np.maximum(sigma * radius, 1e-6))
        return (inside * _smoothstep(first, 2.0 * first, radius)).astype(np.float32)

    def filled(self, plan: Plan) -> Plan:
        """The plan without layers that nothing belongs to. Their blur goes to the filters of those that remain."""
        front, back = (tuple(x for x in side if self.cells(x).any()) for side in (plan.front, plan.back))
        return replace(plan, front=front, back=back)


@dataclass(frozen=True)
class Step:
    """A layer joins the buffer and the buffer is filtered; all tiles are (rows, columns) bool.

    `sigma` is the filter, in texels of the layer's level. The layer joins in the tiles `own`; in the tiles `others` the
    buffer is only carried on (at a smaller size in all that hold something, and the layer is added to it then); after
    the filter it is wanted in `after`. The tiles `finished` have no more to come from layers of finer levels: there the
    buffer is blurred by `finish` instead and enlarged. `rest` are those that come through all steps.
    """

    layer: Layer
    sigma: float
    own: np.ndarray
    others: np.ndarray
    after: np.ndarray
    finish: float
    finished: np.ndarray
    rest: np.ndarray


class Window(NamedTuple):
    """The part of the canvas that will be seen, px; the rest of it is there to blur in."""

    left: int
    bottom: int
    right: int
    top: int

    def tiles(self, shape: tuple[int, int], reach: float) -> np.ndarray:
        """The tiles at most `reach` px away from it, (rows, columns) bool."""
        found = np.zeros(shape, bool)
        low = [max(math.floor((side - reach) / TILE), 0) for side in (self.bottom, self.left)]
        high = [math.ceil((side + reach) / TILE) for side in (self.top, self.right)]
        found[low[0] : high[0], low[1] : high[1]] = True
        return found


def steps(layers: Sequence[Layer], content: Content, window: Window | None) -> list[Step]:
    """Lay out the recursion over `layers`, farthest from the focus first.

    Given a `window`, passes are confined to the tiles where something is that may be seen in it.
    """
    skip = window is not None
    cells = [content.cells(layer) for layer in layers]
    held = spread(layers, cells, skip)
    region = np.ones_like(held[0])
    done = np.zeros_like(held[0])
    found = []
    for number, (layer, sigma) in enumerate(zip(layers, cascade(layers), strict=True)):
        reach = REACH * layer.sigma + (2 << layer.level)
        region = region & window.tiles(region.shape, reach) if window is not None else region
        own = (tiled(cells[number]) if skip else np.ones_like(region)) & region
        others = held[number] & region & (~own | (layer.level > 0))
        finished = np.zeros_like(region)
        if number + 1 < len(layers) and layers[number + 1].level < layer.level:
            near = np.zeros_like(cells[0])
            for finer, where in zip(layers[number + 1 :], cells[number + 1 :], strict=True):
                near |= grown(where, _cells(REACH * finer.sigma + (2 << layer.level)))
            near = tiled(near)
            finished = held[-1] & region & ~near & ~done
            done = done | finished
            region = region & grown(near, math.ceil((REACH * layers[number + 1].sigma + (2 << layer.level)) / TILE))
        after = held[number + 1] & region
        found.append(Step(layer, sigma, own, others, after, finishing(layer), finished, after & ~done))
    return found


def spread(layers: Sequence[Layer], cells: Sequence[np.ndarray], skip: bool = True) -> list[np.ndarray]:
    """The tiles that hold something in the buffer before each layer joins and, last, after all of them."""
    everywhere = np.ones_like(tiled(cells[0]))
    found = [everywhere & False]
    for number in range(1, len(layers) + 1):
        if not skip or found[-1].all():
            found.append(everywhere)
            continue
        rest = layers[number].sigma ** 2 if number < len(layers) else 0.0
        rings: dict[int, np.ndarray] = {}
        for layer, where in zip(layers[:number], cells, strict=False):
            ring = _cells(REACH * math.sqrt(max(layer.sigma**2 - rest, 0.0)) + (2 << layer.level))
            ring = ring if ring < 4 else -(-ring // 4) * 4
            rings[ring] = rings[ring] | where if ring in rings else where
        found.append(tiled(np.logical_or.reduce([grown(where, ring) for ring, where in rings.items()])))
    if not skip:
        found[0] = everywhere
    return found


def _smoothstep(low: float, high: float, x: np.ndarray) -> np.ndarray:
    t = np.clip((x - low) / (high - low), 0.0, 1.0)
    return t * t * (3.0 - 2.0 * t)


def _jumps(radius: np.ndarray, axis: int, least: float) -> np.ndarray:
    """The cells that differ from a neighbour along `axis` by more than `least` and more than 1.5 times what the cells
    on either side of the two do: at silhouettes, not where a steep surface comes into focus."""
    change = np.abs(np.diff(np.moveaxis(radius, axis, 0), axis=0))
    found = np.zeros((len(change) + 1, *change.shape[1:]), bool)
    if len(change):
        beside = np.pad(change, ((1, 1), (0, 0)))
        jump = change > np.maximum(1.5 * np.maximum(beside[:-2], beside[2:]), least)
        found[:-1] |= jump
        found[1:] |= jump
    return np.moveaxis(found, 0, axis)


def _distance(there: np.ndarray, most: int) -> np.ndarray:
    """How far the cells `there` are, px, along the axes or diagonals; up to `most` cells."""
    found = np.zeros(there.shape, np.float32)
    for _ in range(most):
        if there.all() or not there.any():
            break
        found += ~there
        there = grown(there, 1)
    return (found if there.any() else np.full_like(found, most)) * CELL


def _cells(pixels: float) -> int:
    return math.ceil(pixels / CELL)


def tiled(cells: np.ndarray) -> np.ndarray:
    """Cells to the tiles that they are in."""
    return coarser(cells, TILE // CELL)
