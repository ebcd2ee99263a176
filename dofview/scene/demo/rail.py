"""Demo scene `rail`: a toy railway on a trestle comes from close to the camera, through focus, to the far wall."""

from __future__ import annotations

import numpy as np

from dofview.scene.demo import patterns as paint
from dofview.scene.demo.parts import Part, painted
from dofview.scene.demo.shapes import Shape, box, lathe, place, sheet, sphere, tube

VIEW = {
    "camera": {
        "position": [0.0, 1.75, 0.0], "target": [0.0, 1.2, -5.0], "up": [0.0, 1.0, 0.0],
        "vfov_deg": 40.0, "near": 1.2, "far": 18.0,
    },
    "lens": {"radius": 0.0845, "focus_distance": 5.0, "distribution": "uniform_disc"},
    "image": {"size": [512, 384]},
    "background_linear": [0.25, 0.22, 0.19],
}  # fmt: skip

DECK = 1.05
START, END = np.array([-0.95, -1.46]), np.array([3.9, -13.6])
WHEEL = ((0.0, 0.0), (0.1, 0.0), (0.11, 0.02), (0.11, 0.05), (0.0, 0.05))
FUNNEL = ((0.06, 0.0), (0.06, 0.2), (0.1, 0.3), (0.08, 0.31), (0.0, 0.29))


def _along(distance: float, side: float = 0.0, height: float = DECK) -> tuple[float, float, float]:
    """The point `distance` along the track from its near end and `side` to the right of its middle."""
    heading = (END - START) / np.linalg.norm(END - START)
    x, z = START + heading * distance + np.array([-heading[1], heading[0]]) * side
    return float(x), height, float(z)


LENGTH = float(np.linalg.norm(END - START))
HEADING = float(np.degrees(np.arctan2(-(END - START)[1], (END - START)[0])))


def parts() -> list[Part]:
    """All shapes with their materials."""
    return [*_room(), *_track(), *_train(), *_toys()]


def _room() -> list[Part]:
    floor = painted("parquet", paint.wood(81, ("3d2413", "6d4323", "9a6636", "b98149"), 6), 0.5)
    wall = painted("wallpaper", paint.stripes(82, ("2f5a58", "356562", "2f5a58", "c9b98f"), 8, 256), 0.9)
    shelves = painted("books", paint.books(83), 0.8)
    rug = painted("rug", paint.kilim(84, ("8e2f24", "e8d6ad", "26404f", "d08a3a", "43201d"), 10), 1.0)
    return [
        Part(sheet((-9, 0, -1.4), (18, 0, 0), (0, 0, -13.2), (16, 14), 2.4), floor),
        Part(sheet((-9, 0, -14.4), (18, 0, 0), (0, 8, 0), (12, 8), 2.0), wall),
        Part(place(box((5.2, 5.0, 0.5), 0.0, 4, 2.5), (-2.9, 2.5, -14.1)), shelves),
        Part(sheet((-3.4, 0.01, -4.2), (3.6, 0, 0), (0, 0, -6.4), (8, 10), 3.2), rug),
    ]


def _track() -> list[Part]:
    sleeper = painted("sleeper", paint.wood(91, ("3a2213", "64401f", "8a5c30", "a87a48"), 1, 256), 0.8)
    steel = painted("steel", paint.plaster(92, ("6d6f70", "9a9c9b", "c9c8c2"), 0.8, 5.0), 0.4, 0.6)
    post = painted("post", paint.stripes(93, ("b3372b", "efe5cf"), 8), 0.6)
    turn = (0.0, HEADING, 0.0)
    planks: list[Shape] = [
        place(box((0.12, 0.05, 0.62), 0.012, 3, 0.5), _along(d, 0, DECK - 0.03), turn)
        for d in np.arange(0.2, LENGTH, 0.27)
    ]
    rails = [
        tube([_along(t * LENGTH, side, DECK + 0.02) for t in (0, 0.5, 1)], 0.022, (8, 60), 0.5) for side in (-0.2, 0.2)
    ]
    beams = [
        tube([_along(t * LENGTH, side, DECK - 0.1) for t in (0, 0.5, 1)], 0.04, (8, 40), 0.8) for side in (-0.2, 0.2)
    ]
    posts = [
        tube([_along(d, side, 0.0), _along(d, side * 0.75, DECK - 0.1)], 0.035, (10, 6), 0.9)
        for d in np.arange(0.6, LENGTH, 1.1) for side in (-0.3, 0.3)
    ]  # fmt: skip
    return [
        Part(sum(planks, ()), sleeper),
        Part(sum(rails, ()), steel),
        Part(sum(beams, ()), sleeper),
        Part(sum(posts, ()), post),
    ]


def _train() -> list[Part]:
    red = painted("engine", paint.plaster(101, ("8f1d17", "b8281e", "c9392a"), 0.9), 0.35)
    dark = painted("iron", paint.plaster(102, ("1c1d20", "2b2c30", "3d3e42"), 0.8), 0.4)
    brass = painted("brass", paint.plaster(103, ("9a7434", "c9a04e", "e2c070"), 0.8, 5.0), 0.3, 1.0)
    blue = painted("wagon", paint.checker(104, ("28507a", "e8d9b4"), 6), 0.5)
    gold = painted("wagon", paint.kilim(105, ("d99a2b", "7d2a26", "f0e2bf", "2b5d50"), 5), 0.5)
    turn = (0.0, HEADING, 0.0)

    def block(size: tuple[float, float, float], at: float, lift: float) -> Shape:
        return place(box(size, 0.02, 5, 0.5), _along(at, 0, DECK + lift), turn)

    start = 3.6
    wheels = [
        place(lathe(WHEEL, (16, 5)), _along(start + d, side, DECK + 0.15), (90, 0, 0))
        for d in (-0.2, 0.12, 0.62, 0.95, 1.42, 1.75) for side in (-0.23, 0.18)
    ]  # fmt: skip
    boiler = tube([_along(start - 0.38, 0, DECK + 0.36), _along(start + 0.1, 0, DECK + 0.36)], 0.15, (20, 6), 0.5)
    return [
        Part(block((0.75, 0.1, 0.36), start - 0.05, 0.2) + block((0.3, 0.42, 0.36), start + 0.2, 0.42) + boiler, red),
        Part(
            block((0.36, 0.05, 0.42), start + 0.2, 0.66)
            + sum(wheels, ())
            + place(lathe(FUNNEL, (16, 8)), _along(start - 0.27, 0, DECK + 0.48)),
            dark,
        ),
        Part(
            place(sphere(0.15, (20, 12)), _along(start - 0.38, 0, DECK + 0.36))
            + place(sphere(0.07), _along(start - 0.05, 0, DECK + 0.52)),
            brass,
        ),
        Part(block((0.66, 0.32, 0.38), start + 0.78, 0.34), blue),
        Part(block((0.66, 0.32, 0.38), start + 1.58, 0.34), gold),
    ]


def _toys() -> list[Part]:
    colors = (("c8452f", "f0e2bf"), ("e0a030", "5a3013"), ("2f6b62", "e8dcc0"), ("28507a", "d9e2e6"))
    cubes = [painted("cube", paint.checker(110 + i, pair, 4), 0.6) for i, pair in enumerate(colors)]
    ball = painted("ball", paint.stripes(115, ("c8452f", "f4efe2", "28507a", "e0a030"), 8), 0.3)
    spots = [
        (0, 0.7, (2.1, -5.2), 20), (1, 0.6, (2.75, -5.9), -15), (2, 0.8, (-3.2, -8.4), 30), (3, 0.6, (-2.6, -7.6), 8),
        (0, 0.7, (-0.4, -10.2), 9), (2, 0.6, (4.6, -8.0), 12), (3, 0.9, (0.6, -12.6), -20), (1, 0.7, (-5.2, -11.4), 25)
    ]  # fmt: skip
    blocks = [
        Part(place(box((s, s, s), 0.04, 5, s), (x, s / 2, z), (0, turn, 0)), cubes[i]) for i, s, (x, z), turn in spots
    ]
    balls = [
        place(sphere(r, (28, 16)), (x, r, z), (30, 40, 20))
        for r, x, z in ((0.5, -1.7, -5.6), (0.7, 3.2, -11.0), (0.45, 1.5, -8.0))
    ]
    return [
        *blocks,
        Part(place(box((0.5, 0.5, 0.5), 0.04, 8, 0.5), (2.35, 0.95, -5.5), (0, 50, 0)), cubes[3]),
        Part(sum(balls, ()), ball),
    ]
