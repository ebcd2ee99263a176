"""Rows about corners: lenses, depths, sizes, parameters and scenes at the ends of what is accepted.

A picture with depth of field is a weighted mean of what is seen from the lens. So wherever a setting stands, each pixel
is a number between the darkest and the brightest light of the scene, and a scene of one colour keeps it.
"""

from __future__ import annotations

from enum import Enum

import numpy as np

from dofview import fields
from dofview.errors import DofviewError
from dofview.lens import Distribution, Lens, focal_px
from dofview.methods import METHODS
from dofview.methods import method as method_named
from dofview.scene.camera import Camera
from dofview.scene.model import Scene
from dofview.settings import Settings
from dofview.stress import shapes
from dofview.stress.bench import CAMERA, Bench, lens_for
from dofview.stress.row import Measured, Row, bounds

FEW_VIEWS = 8
MOST_VIEWS = 32
SIZES = ((1, 1), (1, 300), (300, 1), (2, 3), (255, 143), (4099, 17), (17, 1031))


def history(bench: Bench, method: str, random: np.random.Generator) -> list[Measured]:
    """After other sizes, other methods and other lenses, the same settings give the same bytes."""
    scene = _colourful(random)
    settings = bench.settings(method, Lens(radius=0.15, focus_distance=random.uniform(3.0, 8.0)), views=FEW_VIEWS)
    first = bench.picture(scene, settings)
    worst = 0.0
    for change in (_resized, _other_methods, _other_lenses):
        for other in change(bench, settings, random):
            bench.picture(scene, other)
        worst = max(worst, float(np.abs(bench.picture(scene, settings) - first).max()))
    return [Measured("largest difference, 1/255", 255.0 * worst)]


def _resized(bench: Bench, settings: Settings, random: np.random.Generator) -> list[Settings]:
    sizes = [(bench.size + 7, bench.size), (1, 1), tuple(random.integers(1, 2 * bench.size, 2).tolist())]
    return [settings.with_(image=settings.image.model_copy(update={"size": size})) for size in sizes]


def _other_methods(bench: Bench, settings: Settings, random: np.random.Generator) -> list[Settings]:
    return [bench.settings(name, settings.lens, views=2) for name in random.permutation(METHODS).tolist()]


def _other_lenses(bench: Bench, settings: Settings, random: np.random.Generator) -> list[Settings]:
    return [settings.with_(lens=Lens(radius=radius, focus_distance=focus))
            for radius, focus in ((0.0, 5.0), (1.0, np.inf), (0.02, 1.0))]  # fmt: skip


def cornered_lens(bench: Bench, method: str, random: np.random.Generator) -> list[Measured]:
    """Focus at the nearest object, before all, behind all and at infinity; from no blur to 500 px of CoC radius."""
    cards = shapes.scattered(random)
    scenes = _colourful(random, cards), shapes.scene(cards, [shapes.unlit((0.5, 0.5, 0.5))] * 4)
    nearest = 5.0 - max(card.positions[:, 2].max() for card in cards)
    pixels = focal_px(bench.size, CAMERA.vfov_deg)
    worst = _Worst()
    for focus in (1e-3, float(nearest), 11.5, 1e6, np.inf):
        for coc in (1e-3, 0.5, float(10 ** random.uniform(0.0, 2.7)), 500.0):
            # The blur of the nearest object, or of the wall where the nearest one is in focus.
            depth = 11.0 if focus == nearest else float(nearest)
            radius = coc / (pixels * abs(1.0 / focus - 1.0 / depth))
            lens = _any_lens(random, radius, focus)
            worst.add(bench, scenes, bench.settings(method, lens, background=0.5, views=FEW_VIEWS))
    return worst.measured()


def _any_lens(random: np.random.Generator, radius: float, focus: float) -> Lens:
    kind = random.choice([Distribution.UNIFORM_DISC, Distribution.GAUSSIAN, Distribution.POLYGON])
    return Lens(radius=radius, focus_distance=focus, distribution=kind, blades=int(random.integers(3, 9)))


def deep(bench: Bench, method: str, random: np.random.Generator) -> list[Measured]:
    """Objects from 0.001 to 1,000,000 units away in one picture: the near ones are there, nothing is odd."""
    depths = (1e-3, 0.03, 1.0, 30.0, 1e3, 1e6)
    turn = random.permutation(len(depths) - 1)
    cards = [shapes.facing(0.0, 0.0, -1e6, 1e6, 1e6, 0)]
    for place, depth in zip(turn, depths[:-1], strict=True):
        angle = 2.0 * np.pi * place / len(turn)
        x, y = 0.22 * depth * np.cos(angle), 0.22 * depth * np.sin(angle)
        cards.append(shapes.facing(x, y, -depth, 0.08 * depth, 0.08 * depth, 1))
    dark, light = shapes.unlit((0.25, 0.25, 0.25)), shapes.unlit((0.75, 0.75, 0.75))
    scene, grey = shapes.scene(cards, [dark, light]), shapes.scene(cards, [shapes.unlit((0.5, 0.5, 0.5))] * 2)
    camera = Camera(position=(0.0, 0.0, 0.0), target=(0.0, 0.0, -1.0), vfov_deg=CAMERA.vfov_deg)
    worst = _Worst()
    for focus in depths:
        settings = bench.settings(
            method, Lens(radius=1e-5 * focus, focus_distance=focus), camera, background=0.5, views=FEW_VIEWS
        )
        worst.add(bench, (scene, grey), settings)
    sharp = bench.picture(scene, bench.settings(method, Lens(), camera, views=1))
    missing = 0
    for place in turn:
        angle = 2.0 * np.pi * place / len(turn)
        x, y = 0.5 + 0.22 / 0.728 * np.cos(angle), 0.5 - 0.22 / 0.728 * np.sin(angle)
        missing += int(abs(sharp[int(y * bench.size), int(x * bench.size), 0] - 0.75) > 0.01)
    return [*worst.measured(), Measured("objects not seen", missing)]


def sizes(bench: Bench, method: str, random: np.random.Generator) -> list[Measured]:
    """Pictures of one pixel, of one line, and of 4099 by 17."""
    cards = shapes.scattered(random)
    scenes = _colourful(random, cards), shapes.scene(cards, [shapes.unlit((0.5, 0.5, 0.5))] * 4)
    worst = _Worst()
    for size in SIZES:
        lens = _any_lens(random, random.uniform(0.02, 0.3), random.uniform(2.0, 12.0))
        worst.add(bench, scenes, bench.settings(method, lens, size=size, background=0.5, views=FEW_VIEWS))
    return worst.measured()


def parameters(bench: Bench, method: str, random: np.random.Generator) -> list[Measured]:
    """Every parameter of the method at both ends and in between, then all of them anywhere."""
    cards = shapes.scattered(random)
    scenes = _colourful(random, cards), shapes.scene(cards, [shapes.unlit((0.5, 0.5, 0.5))] * 4)
    params = method_named(method).Params
    choices = {name: _choices(method, name, field, random) for name, field in params.model_fields.items()}
    lens = lens_for(method, 0.2, random.uniform(3.0, 8.0))
    size = (bench.size // 2, bench.size // 2)
    base = bench.settings(method, lens, size=size, background=0.5, views=FEW_VIEWS)
    worst = _Worst()
    tried = [{name: value} for name, values in choices.items() for value in values]
    tried += [{name: values[random.integers(len(values))] for name, values in choices.items() if values}
              for _ in range(12)]  # fmt: skip
    for changes in tried:
        settings = base.with_params(**changes)
        worst.add(bench, scenes, settings, only_finite=_makes_light(settings))
    return worst.measured()


def _makes_light(settings: Settings) -> bool:
    """Whether the settings show a method's inside, or brighten highlights, which is what the two are for."""
    chosen = settings.method_params.model_dump()
    return str(chosen.get("show", "picture")) != "picture" or chosen.get("extrapolate", False)


def _choices(method: str, name: str, field, random: np.random.Generator) -> list:
    """Values of a parameter: its ends, what is special in between, and one at random."""
    plain = fields.kind(field)
    if plain is bool:
        return [False, True]
    if isinstance(plain, type) and issubclass(plain, Enum):
        return list(plain)
    if plain not in (int, float):
        return []
    low, high, open_low, open_high = fields.bounds(field)
    if low is None or high is None:
        return []
    if method == "accumulation" and name == "views":
        high = MOST_VIEWS
    low, high = (low + 1e-3 * (high - low) if open_low else low), (high - 1e-3 * (high - low) if open_high else high)
    if plain is int:
        return sorted(
            {int(low), min(int(low) + 1, int(high)), int(random.integers(int(low), int(high) + 1)), int(high)}
        )
    return [float(low), float(random.uniform(low, high)), float(high)]


def scenes_at_the_ends(bench: Bench, method: str, random: np.random.Generator) -> list[Measured]:
    """An empty scene, a card that covers the lens, thousands of faces in one plane, triangles of no area, objects only
    behind the camera, a box that it stands in."""
    grey = shapes.unlit((0.5, 0.5, 0.5))
    places, halves = random.uniform(-3, 3, (3000, 2)), random.uniform(0.01, 0.5, (3000, 2))
    many = [shapes.facing(x, y, 0.0, w, h) for (x, y), (w, h) in zip(places, halves, strict=True)]
    flat = [shapes.card(np.array([x, 0.0, 0.0]), np.array([0.0, 1e-12, 0.0]), np.array([1e-12, 0.0, 0.0]))
            for x in (-0.5, 0.5)]  # fmt: skip
    covering = [shapes.facing(0, 0, 5.0 - 1e-3, 1.0, 1.0), shapes.facing(0, 0, -3.0, 9.0, 9.0)]
    behind = [shapes.facing(0, 0, 8.0, 1.0, 1.0)]
    around = [shapes.card(np.array([0, 0, 5.0]) + 2.0 * axis, 2.0 * np.roll(axis, 1), 2.0 * np.roll(axis, 2))
              for axis in (*np.eye(3), *-np.eye(3))]  # fmt: skip
    worst = _Worst()
    for cards in ([], many, flat, covering, behind, around, [*many, *covering]):
        lens = _any_lens(random, random.uniform(0.02, 0.3), float(random.choice([0.5, 5.0, np.inf])))
        settings = bench.settings(method, lens, background=0.5, views=FEW_VIEWS)
        worst.add(bench, (shapes.scene(cards, [grey]),), settings)
    return worst.measured()


class _Worst:
    """The worst of many pictures: values that are no numbers, and distance beyond the light there is."""

    def __init__(self) -> None:
        self.wrong = 0
        self.beyond = 0.0

    def add(self, bench: Bench, scenes: tuple[Scene, ...], settings: Settings, only_finite: bool = False) -> None:
        """Take in a picture of each scene; a scene of one colour must keep it, one of many its range of 0 to 1."""
        for scene in scenes:
            try:
                picture = bench.picture(scene, settings)
            except DofviewError as error:
                raise AssertionError(f"{settings.method} refused {settings.method_params!r}: {error}") from error
            self.wrong += int((~np.isfinite(picture)).sum())
            if only_finite:
                continue
            one = len({material.base_color for material in scene.materials}) == 1 and not any(
                material.base_color_texture for material in scene.materials
            )
            low, high = (0.5, 0.5) if one else (0.0, 1.0)
            apart = max(float(low - picture.min()), float(picture.max() - high), 0.0)
            self.beyond = max(self.beyond, 255.0 * apart)

    def measured(self) -> list[Measured]:
        return [Measured("values that are not numbers", self.wrong), Measured("beyond the scene's light, 1/255",
                self.beyond)]  # fmt: skip


def _colourful(random: np.random.Generator, cards: list | None = None) -> Scene:
    cards = shapes.scattered(random) if cards is None else cards
    return shapes.scene(cards, [shapes.textured(random, 32) for _ in range(4)])


FURNACE = ((0, 0.25), (0, 2), (0, 1), (0, 2), (0, 1), (0, 1))
"""As in row 1."""

ROWS = (
    Row(22, "history", bounds(0.0), history),
    Row(23, "cornered lenses", bounds(*FURNACE), cornered_lens),
    Row(24, "depths from 1e-3 to 1e6", bounds(*((*both, 0) for both in FURNACE)), deep),
    Row(25, "cornered sizes", bounds(*FURNACE), sizes),
    Row(26, "cornered parameters", bounds(*FURNACE), parameters),
    Row(27, "cornered scenes", bounds(*FURNACE), scenes_at_the_ends),
)  # fmt: skip
