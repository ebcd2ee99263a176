"""The picture of `layered`: front buffer, layer in focus and back buffer over one another, the unknown filled in."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from dofview.gl.pull_push import Part, pull_push
from dofview.gl.targets import Image
from dofview.gl.tiles import Tiles, grown, upload
from dofview.methods.layered_peels import COMMON, Peels
from dofview.methods.layered_plan import Layer
from dofview.methods.layered_regions import CELL, tiled

MOST_OVER = 0.25
"""Part of the canvas that is drawn over rather than told apart."""


def final(peels: Peels, focus: Layer, sides: Mapping[str, Image], *, fill: bool, skip: bool) -> Image:
    """Front buffer over the layer in focus over the back buffer, normalised."""
    picture = peels.recipe.image("picture")
    defines: dict[str, object] = {f"HAS_{side.upper()}": 1 for side in sides}
    images = dict(sides)
    if fill:
        images["filled"] = _filled(peels, focus, sides.get("back"), skip=skip)
        defines["FILL"] = 1
    guard, count, deep = peels.frame.guard, len(peels.colors), peels.content.deep(focus)
    there = tiled(peels.content.cells(focus)) & peels.window.tiles(deep.shape, 0.0)
    common, viewport = min(count, COMMON), (guard, guard, *peels.frame.inner_size)
    lots: list[tuple[int, np.ndarray | None]] = [(common, None), (count, there & deep)]
    if not skip or count == common or deep.all():
        lots = [(count, None)]
    if skip and not there.any():
        lots = [(0, None)]
    draws = [(looked, where, False) for looked, where in lots]
    if "front" in sides and "PAPER" not in peels.defines:
        images["closed"], closed = _closed(peels, focus)
        closed &= peels.window.tiles(deep.shape, 0.0)
        # Drawn over what is there already; where it is much of the picture, everywhere in its place.
        if not skip or closed.mean() > MOST_OVER:
            draws = [(looked, where, True) for looked, where in lots]
        elif closed.any():
            draws.append((lots[-1][0], closed, True))
    for looked, where, close in draws:
        within = _listed(peels, "final", [where])[0] if where is not None else None
        kind = ({"CLOSE": 1, "CELL": CELL} if close else {}) | ({} if looked else {"EMPTY": 1})
        peels.draw(
            "final.frag", picture, focus, peels=looked, defines=defines | kind, images=images, within=within,
            viewport=None if within else viewport,
        )  # fmt: skip
    return picture


def _closed(peels: Peels, focus: Layer) -> tuple[Image, np.ndarray]:
    """Where nothing behind the front buffer can be seen, cell by cell, and the tiles that have something of it."""
    frame = peels.frame
    first = float(-frame.coc.radius_px(focus.anchors[1]))
    image = peels.recipe.image("closed", peels.content.shape[::-1], 1, linear=True)
    closed = peels.content.closed(frame.coc, frame.lens_block.sigma, first)
    image.write(closed[::-1, :, None])
    return image, tiled(grown(closed > 0.0, 1))


def _filled(peels: Peels, focus: Layer, back: Image | None, *, skip: bool) -> Image:
    """Half the size: what is behind the front buffer, its holes filled from around them."""
    # Two surfaces of a pixel are enough to make up a third from.
    looked = min(len(peels.colors), COMMON)
    textures = peels.textures(focus, looked) | ({"back": back} if back else {})
    defines = peels.defined(focus, looked) | ({"HAS_BACK": 1} if back else {})
    if looked < len(peels.colors):
        defines.pop("EXHAUSTED", None)
    parts = [Part(None, textures, defines)]
    if skip:
        there = tiled(peels.content.cells(focus))
        seen = peels.window.tiles(there.shape, 0.0)
        lists = _listed(peels, "fill", [there & seen, ~there & seen])
        if None not in lists:
            empty = {"EMPTY": 1, **({"HAS_BACK": 1} if back else {})}
            parts = [Part(lists[0], textures, defines), Part(lists[1], {"back": back} if back else {}, empty)]
    with peels.recipe.gpu.profile.section("layered/fill"):
        (filled,) = pull_push(
            peels.recipe.gpu, "layered/fill", peels.frame.size, "methods/layered/known.glsl", parts=parts,
            blocks=peels.recipe.blocks, values={**peels.values(focus), "window": tuple(peels.window)},
            extras=False,
        )  # fmt: skip
    return filled


def _listed(peels: Peels, name: str, masks: list[np.ndarray]) -> list[Tiles | None]:
    return upload(peels.recipe.gpu.targets, f"layered/{name} tiles", masks, peels.frame.size)
