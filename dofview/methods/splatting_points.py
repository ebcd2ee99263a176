"""What `splatting` splats: points of the visible and the hidden image, merged where they are blurred, and where to look
for them.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING

import moderngl
import numpy as np

from dofview.gl.passes import ADD
from dofview.gl.pyramids import level_size
from dofview.gl.targets import Image
from dofview.methods.method import Recipe
from dofview.methods.splatting_aperture import DISC, Sprite, sprite_of
from dofview.render.frame import Surfaces
from dofview.render.raster import depth_range, draw_scene

if TYPE_CHECKING:
    from dofview.methods.splatting import Params

TILE = 8
MOST_RADIUS = 256.0
MOST_LEVELS = 3
K_N_STEPS, K_N_COUNT = 16.0, 256
EVERY = 2.0 * MOST_RADIUS
"""A CoC radius that no point has: up to it, all belong to their level."""


class Reduction(StrEnum):
    """Which points are merged before they are splatted."""

    NONE = "none"
    PAPER = "paper"
    LEVELS = "levels"


@dataclass
class Points:
    """All points of a frame by level: `visible[0]` is one image, `visible[l]` the nearer and the farther of each block;
    `hidden` likewise one each, none without a hidden image. `sprites` are those that are always drawn."""

    visible: list[tuple[Image, ...]]
    hidden: list[Image]
    sprites: Image | None
    sprite: Sprite
    widest: float
    merged_from: float
    flags: dict[str, object]

    @property
    def levels(self) -> int:
        """How often points were merged."""
        return len(self.visible) - 1

    @property
    def finest(self) -> float:
        """The largest CoC radius that points of single pixels can have, px."""
        return self.widest if self.levels == 0 or self.merged_from == EVERY else 2.0 * self.merged_from

    def upper(self, level: int) -> float:
        """CoC radius from which points of `level` are merged into the next, px."""
        return EVERY if level == self.levels else self.merged_from * 2.0**level

    def draw_sprites(
        self, recipe: Recipe, image: Image, level: int, layers: tuple[Image, ...] | list[Image], *, clear: bool = True,
        when: moderngl.Query | None = None, last: bool = False, rows: range | None = None,
    ) -> None:  # fmt: skip
        """Add a sprite for each point of `image`, or of its `rows`, to `layers`: with, behind, in front of each pixel's
        surface. `last` takes whole points also where they are merged into the next level."""
        rows = range(image.size[1]) if rows is None else rows
        recipe.draw(
            "sprites.frag", layers, sprites=image.size[0] * len(rows), blend=ADD, clear=clear, when=when,
            defines={**self.flags, **({} if len(layers) == 3 else {"OF_HIDDEN": 1})},
            values={
                "canvas": layers[0].size, "level": level, "to": EVERY if last else self.upper(level),
                "first_row": rows.start, **self.sprite.values,
            },
            sprite_points=image, points=self.visible[0][0], images=self.sprite.textures,
        )  # fmt: skip


def constants(levels: int, sprite: Sprite) -> dict[str, object]:
    """What all shaders of the method must agree on."""
    return {
        "MOST_RADIUS": MOST_RADIUS, "K_N_STEPS": K_N_STEPS, "K_N_COUNT": K_N_COUNT, "TILE": TILE, "LEVELS": levels,
        **sprite.flags,
    }  # fmt: skip


def make_points(recipe: Recipe, params: Params) -> Points:
    """Render the images that the method asks for and pack them into points."""
    frame = recipe.frame
    hidden = _hidden_image(recipe, params)
    visible = max(-frame.coc_range()[0], frame.coc_range()[1])
    widest = min(max(visible, frame.coc.at_infinity if hidden else 0.0), MOST_RADIUS)
    by_paper = params.reduction is Reduction.PAPER
    sprite = sprite_of(recipe)
    # A shape with its light near the middle, a triangle say, is as fine as a smaller disc.
    merged_from = 0.5 * params.reduced_from * (1.0 if by_paper else max(DISC.spread / sprite.spread, 1.0))
    levels = 0
    if params.reduction is not Reduction.NONE:
        while levels < (1 if by_paper else MOST_LEVELS) and visible >= merged_from * 2.0**levels:
            levels += 1
    flags = constants(levels, sprite) | ({"HIDDEN": 1} if hidden else {}) | ({"BY_PAPER": 1} if by_paper else {})
    images = [recipe.image("points"), recipe.image("hidden points"), recipe.image("other points")]
    surfaces = frame.pinhole()
    textures = {
        "color": surfaces.color,
        "inverse_depth": surfaces.inverse_depth,
        "k_n": _k_n(recipe, sprite),
        **sprite.textures,
    }
    if hidden:
        textures |= {
            "hidden_color": hidden.color, "hidden_inverse_depth": hidden.inverse_depth,
            "hidden_limit": _limit(recipe),
        }  # fmt: skip
    if levels and not by_paper:
        textures |= _brightness(recipe, surfaces.color)
    recipe.draw(
        "points.frag", images, images=textures,
        defines=flags | {"REDUCED_FROM": merged_from, **({"EXTRAPOLATE": 1} if params.extrapolate else {})},
        values=sprite.values | ({"background": frame.background} if hidden else {}),
    )  # fmt: skip
    points = Points(
        visible=[(images[0],)], hidden=[images[1]] if hidden else [],
        sprites=images[2] if levels and not by_paper else None, sprite=sprite, widest=widest,
        merged_from=EVERY if by_paper else merged_from, flags=flags,
    )  # fmt: skip
    _merge(recipe, points, levels, images[2] if by_paper else images[0], 0.0 if by_paper else merged_from)
    return points


def _merge(recipe: Recipe, points: Points, levels: int, source: Image, merged_from: float) -> None:
    """Add `levels` levels of blocks of points; the first is made from `source`."""
    for level in range(1, levels + 1):
        size = level_size(recipe.frame.size, level)
        into = [recipe.image(f"{name} {level}", size) for name in ("points", "far points", "hidden points")]
        flags, textures = dict(points.flags), {"near_points": source}
        if level == 1:
            flags["FIRST"] = 1
        else:
            textures["far_points"] = points.visible[-1][1]
        # The paper merges only where nothing is hidden.
        if "BY_PAPER" in flags:
            flags.pop("HIDDEN", None)
        elif points.hidden:
            textures["hidden_points"] = points.hidden[-1]
        recipe.draw(
            "reduce.frag", into, defines=flags, values={"from": merged_from * 2.0 ** (level - 1)}, images=textures
        )
        points.visible.append((into[0], into[1]))
        if points.hidden:
            points.hidden.append(into[2])
        source = into[0]


def search_map(recipe: Recipe, points: Points, skip: bool) -> tuple[Image, Image]:
    """How far each tile must look for points of each level, and the largest CoC in each that this comes from."""
    frame, rows = recipe.frame, -(-recipe.frame.size[1] // TILE)
    tiles = (-(-frame.size[0] // TILE), rows * (points.levels + 1))
    largest, reach = recipe.image("largest", tiles), recipe.image("reach", tiles)
    for level, images in enumerate(points.visible):
        textures = {"points": images[0]}
        second = images[1] if level else points.sprites
        if second is not None:
            textures["second_points"] = second
        if points.hidden:
            textures["hidden_points"] = points.hidden[level]
        recipe.draw(
            "tiles.frag", largest, viewport=(0, level * rows, tiles[0], rows),
            defines={**points.flags, "LEVEL": level, **({"SECOND": 1} if second is not None else {})},
            values={"to": points.upper(level), "row": level * rows}, images=textures,
        )  # fmt: skip
    farthest = int(points.widest * points.sprite.extent) // TILE + 1
    recipe.draw(
        "reach.frag", reach, defines={**points.flags, "SKIP": skip}, largest=largest,
        values={"farthest": farthest, "extent": points.sprite.extent},
    )  # fmt: skip
    return reach, largest


def draw_highlights(recipe: Recipe, points: Points, largest: Image, layers: list[Image]) -> bool:
    """Draw the points that were set apart as sprites; whether there were any.

    They are few, and seldom there at all. A GPU is left to find out for itself whether they are: to be asked it would
    have to finish first. Software has finished, and pays for each corner of a sprite that is not there.
    """
    rows = -(-recipe.frame.size[1] // TILE)
    assert points.sprites is not None
    if not recipe.gpu.software:
        seen = recipe.gpu.samples_passed
        with seen:
            unused = recipe.image("any", largest.size, components=1)
            recipe.draw("any_second.frag", unused, viewport=(0, 0, largest.size[0], rows), largest=largest)
        points.draw_sprites(recipe, points.sprites, 0, layers, when=seen, last=True)
        return True
    found = np.flatnonzero((largest.pixels()[::-1][:rows, :, 3] >= 0.0).any(axis=1))
    clear = True
    for run in np.split(found, np.flatnonzero(np.diff(found) > 1) + 1) if len(found) else []:
        lines = range(int(run[0]) * TILE, min(int(run[-1] + 1) * TILE, recipe.frame.size[1]))
        points.draw_sprites(recipe, points.sprites, 0, layers, clear=clear, last=True, rows=lines)
        clear = False
    return not clear


def _k_n(recipe: Recipe, sprite: Sprite) -> Image:
    """k_n(C) for the sprite, counted anew when its shape has changed."""
    table = recipe.image("k_n", (K_N_COUNT, 1), components=1)
    if not recipe.frame.cache.holds(sprite.key, table):
        recipe.draw(
            "k_n.frag", table, defines={"MOST_RADIUS": MOST_RADIUS, "K_N_STEPS": K_N_STEPS, **sprite.flags},
            values=sprite.values, images=sprite.textures,
        )  # fmt: skip
    return table


def _brightness(recipe: Recipe, color: Image) -> dict[str, Image]:
    found: dict[str, Image] = {}
    source = color
    for level in range(1, MOST_LEVELS + 1):
        image = recipe.image(f"brightness {level}", level_size(recipe.frame.size, level), components=1)
        recipe.draw("brightness.frag", image, defines={"FIRST": 1} if level == 1 else {}, source=source)
        found[f"brightness_{level}"] = source = image
    return found


def _limit(recipe: Recipe) -> Image:
    return recipe.image("hidden limit", components=2)


def _hidden_image(recipe: Recipe, params: Params) -> Surfaces | None:
    """The nearest surfaces that pass the three tests of section 3.2; None when nothing is in front of the focus."""
    frame = recipe.frame
    if not params.hidden:
        return None
    without = "splatting hidden passes skipped"
    if params.skip and recipe.gpu.profile.may_skip(without) and frame.coc_range()[0] > -0.5:
        recipe.gpu.profile.count(without)
        return None
    surfaces = frame.pinhole()
    limit = _limit(recipe)
    recipe.draw(
        "hidden_limit.frag", limit, inverse_depth=surfaces.inverse_depth,
        defines={
            **({"BY_PAPER": 1} if params.reduction is Reduction.PAPER else {}),
            **({"BY_DEPTH": 1} if params.hidden_test == "depth" else {}),
        },
        values={"depth_range": depth_range(frame.scene, frame.camera)},
    )  # fmt: skip
    hidden = Surfaces(recipe.image("hidden"), recipe.image("hidden inverse depth", components=1))
    with recipe.gpu.profile.section("splatting/hidden"):
        # Behind the limit is the same question that depth peeling asks of the surface before.
        draw_scene(recipe.gpu, frame.scene, frame.projection(), hidden, lights=frame.lights, behind=limit, sparse=True)
    return hidden
