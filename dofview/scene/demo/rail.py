"""Demo scene `rail`: a toy railway on a trestle comes from close to the camera, through focus, to the far wall."""

from __future__ import annotations

import numpy as np

from dofview.scene.demo import patterns as paint
from dofview.scene.demo.parts import Part, near, painted, standing
from dofview.scene.demo.shapes import Shape, box, ground, lathe, place, sheet, sphere, torus, tube

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
START, END = np.array([-0.95, -1.46]), np.array([4.6, -12.9])
LENGTH = float(np.linalg.norm(END - START))
HEADING = float(np.degrees(np.arctan2(-(END - START)[1], (END - START)[0])))
WHEEL = ((0.0, -0.03), (0.04, -0.03), (0.045, 0.0), (0.12, 0.0), (0.13, 0.02), (0.12, 0.05), (0.0, 0.05))
FUNNEL = ((0.055, 0.0), (0.05, 0.16), (0.085, 0.26), (0.09, 0.29), (0.06, 0.29), (0.05, 0.2))
DOME = ((0.085, 0.0), (0.085, 0.06), (0.05, 0.12), (0.0, 0.135))
CAP = ((0.165, 0.0), (0.155, 0.025), (0.1, 0.045), (0.0, 0.05))
# Toy blocks: colour, edge, x, z, turn; and balls: radius, x, z.
BLOCKS = (
    (0, 0.7, 2.35, -5.0, 20), (1, 0.6, 3.1, -6.1, -15), (2, 0.8, -3.3, -8.4, 30), (3, 0.6, -2.6, -7.5, 8),
    (0, 0.7, -0.4, -10.2, 40), (2, 0.6, 5.4, -8.0, 12), (3, 0.9, 0.9, -12.6, -20), (1, 0.7, -5.2, -11.4, 25),
    (1, 0.55, -1.15, -4.9, 35),
)  # fmt: skip
BALLS = ((0.5, -2.05, -5.7), (0.7, 2.9, -11.3), (0.45, 0.1, -7.6))


def _along(distance: float, side: float = 0.0, height: float = DECK) -> tuple[float, float, float]:
    """The point `distance` along the track from its near end and `side` to the right of its middle."""
    heading = (END - START) / LENGTH
    x, z = START + heading * distance + np.array([-heading[1], heading[0]]) * side
    return float(x), height, float(z)


def parts() -> list[Part]:
    """All shapes with their materials."""
    return [*_room(), *_track(), *_train(), *_toys()]


def _room() -> list[Part]:
    floor = painted("parquet", paint.wood(81, ("3d2413", "6d4323", "9a6636", "b98149"), 6), 0.85)
    wall = painted("wallpaper", paint.stripes(82, ("2f5a58", "3c6c66", "2f5a58", "c9b98f"), 8, 256), 0.95)
    shelves = painted("books", paint.books(83), 0.9)
    rug = painted("rug", paint.kilim(84, ("8e2f24", "e8d6ad", "26404f", "d08a3a", "43201d"), 10), 1.0)
    toys = [(x, 0.45 * s, z, 0.6 * s) for _, s, x, z, _ in BLOCKS] + [(x, r, z, r) for r, x, z in BALLS]
    deck = [(*_along(d)[::2], 0.42) for d in np.arange(0.4, LENGTH, 0.8)]
    covered = near(*toys, *((x, 0.75, z, r) for x, z, r in deck), (-2.9, 0.1, -14.0, 2.0))
    behind = near(*((x, -0.1, -13.9, 0.8) for x in range(-9, 10)), strength=0.5)
    return [
        Part(ground(0.0, 1.6, 14.5, (48, 30), 2.4), floor, covered),
        Part(sheet((11, 0, -14.4), (0, 8, 0), (-22, 0, 0), (12, 24), 2.0), wall, behind),
        Part(place(box((5.2, 5.0, 0.5), 0.0, 4, 2.5), (-2.9, 2.5, -14.1)), shelves),
        Part(sheet((-3.4, 0.01, -4.2), (3.8, 0, 0), (0, 0, -6.4), (16, 24), 3.2), rug, covered),
    ]


def _track() -> list[Part]:
    sleeper = painted("sleeper", paint.wood(91, ("3a2213", "64401f", "8a5c30", "a87a48"), 1, 256), 0.8)
    steel = painted("steel", paint.plaster(92, ("6d6f70", "9a9c9b", "c9c8c2"), 0.8, 5.0), 0.5, 0.6)
    post = painted("post", paint.stripes(93, ("b3372b", "efe5cf"), 8), 0.6)
    turn = (0.0, HEADING, 0.0)
    planks: list[Shape] = [
        place(box((0.12, 0.05, 0.62), 0.0, 1, 0.5), _along(d, 0, DECK - 0.03), turn)
        for d in np.arange(0.2, LENGTH, 0.27)
    ]
    rails = [
        tube([_along(t * LENGTH, side, DECK + 0.02) for t in (0, 0.5, 1)], 0.022, (8, 40), 0.5) for side in (-0.2, 0.2)
    ]
    beams = [
        tube([_along(t * LENGTH, side, DECK - 0.1) for t in (0, 0.5, 1)], 0.04, (6, 24), 0.8) for side in (-0.2, 0.2)
    ]
    posts = [
        tube([_along(d, side, 0.0), _along(d, side * 0.75, DECK - 0.1)], 0.035, (10, 3), 0.9)
        for d in np.arange(0.6, LENGTH, 1.1) for side in (-0.3, 0.3)
    ]  # fmt: skip
    return [
        Part(sum(planks, ()), sleeper),
        Part(sum(rails, ()), steel),
        Part(sum(beams, ()), sleeper),
        Part(sum(posts, ()), post),
    ]


def _train() -> list[Part]:
    paints = {
        "body": painted("engine", paint.plaster(101, ("7d1a15", "a8251c", "bf3527"), 1.2), 0.5),
        "boiler": painted("boiler", paint.stripes(106, ("1d4a3c", "235746", "1d4a3c", "c9a04e"), 8), 0.5),
        "dark": painted("iron", paint.plaster(102, ("1f2023", "2b2c30", "38393d"), 0.9), 0.55),
        "brass": painted("brass", paint.plaster(103, ("b58a40", "c9a04e", "dab868"), 1.4, 5.0), 0.5, 1.0),
        "blue": painted("wagon", paint.checker(104, ("28507a", "e8d9b4"), 6), 0.5),
        "gold": painted("wagon", paint.kilim(105, ("d99a2b", "7d2a26", "f0e2bf", "2b5d50"), 5), 0.5),
    }
    vehicles = ((3.25, _engine()), (4.62, _wagon("blue", "brass")), (5.82, _wagon("gold", "body")))
    built: dict[str, list[Shape]] = {name: [] for name in paints}
    for at, vehicle in vehicles:
        for name, shape in vehicle:
            built[name].append(place(shape, _along(at, 0, DECK + 0.04), (0, HEADING + 180, 0), 1.2))
    shade = standing(DECK, 0.12)
    return [Part(sum(shapes, ()), paints[name], shade) for name, shapes in built.items()]


def _wheels(spots: tuple[float, ...], radius: float) -> Shape:
    disc = lathe(WHEEL, (18, 6))
    scale = radius / 0.13
    right = (place(disc, (x, radius, 0.15), (90, 0, 0), scale) for x in spots)
    left = (place(disc, (x, radius, -0.15), (-90, 0, 0), scale) for x in spots)
    return sum((*right, *left), ())


def _engine() -> list[tuple[str, Shape]]:
    """A tank engine about a metre long with its wheels on y = 0, facing +x."""
    cab = [
        place(box((0.3, 0.44, 0.38), 0.02, 5, 0.5), (-0.32, 0.41, 0)),
        place(box((0.05, 0.1, 0.42), 0.012, 4), (0.54, 0.2, 0)),
    ]
    smokebox = [
        tube([(0.33, 0.4, 0), (0.5, 0.4, 0)], 0.165, (24, 2)),
        place(lathe(CAP, (24, 6)), (0.5, 0.4, 0), (0, 0, -90)),
    ]
    windows = [
        place(box((0.14, 0.13, 0.39), 0.01, 4), (-0.32, 0.5, 0)),
        place(box((0.31, 0.13, 0.2), 0.01, 4), (-0.32, 0.5, 0)),
    ]
    roof = place(box((0.42, 0.045, 0.46), 0.02, 5), (-0.32, 0.65, 0))
    lamps = [place(sphere(0.035, (14, 9)), (0.575, 0.25, z)) for z in (-0.13, 0.13)]
    return [
        ("body", sum(cab, place(box((1.05, 0.08, 0.34), 0.01, 4), (0, 0.2, 0)))),
        ("boiler", tube([(-0.2, 0.4, 0), (0.34, 0.4, 0)], 0.155, (24, 6), 0.54)),
        ("dark", sum((*smokebox, *windows, roof, place(lathe(FUNNEL, (20, 10)), (0.42, 0.54, 0))), ())),
        ("dark", _wheels((-0.34, 0.0, 0.32), 0.14)),
        (
            "brass",
            sum(
                (
                    *lamps,
                    place(lathe(DOME, (20, 8)), (0.1, 0.53, 0)),
                    place(torus(0.085, 0.016, (20, 8)), (0.42, 0.83, 0)),
                ),
                (),
            ),
        ),
    ]


def _wagon(body: str, load: str) -> list[tuple[str, Shape]]:
    """An open wagon of 0.9 with a load of balls."""
    cargo = [
        place(sphere(0.12, (16, 10)), (x, 0.47, z), (30, 50 * i, 0))
        for i, (x, z) in enumerate(((-0.26, 0.03), (0.0, -0.04), (0.25, 0.04)))
    ]
    return [
        (body, place(box((0.86, 0.24, 0.4), 0.02, 5, 0.43), (0, 0.32, 0))),
        ("dark", place(box((0.98, 0.05, 0.26), 0.01, 4), (0, 0.17, 0)) + _wheels((-0.26, 0.26), 0.11)),
        (load, sum(cargo, ())),
    ]


def _toys() -> list[Part]:
    colors = (("c8452f", "f0e2bf"), ("e0a030", "5a3013"), ("2f6b62", "e8dcc0"), ("28507a", "d9e2e6"))
    cubes = [painted("cube", paint.checker(110 + i, pair, 4), 0.6) for i, pair in enumerate(colors)]
    ball = painted("ball", paint.stripes(115, ("c8452f", "f4efe2", "28507a", "e0a030"), 8), 0.5)
    shade = standing(0, 0.25)
    blocks = [
        Part(place(box((s, s, s), 0.04, 5, s), (x, s / 2, z), (0, turn, 0)), cubes[i], shade)
        for i, s, x, z, turn in BLOCKS
    ]
    balls = sum((place(sphere(r, (28, 16)), (x, r, z), (30, 40, 20)) for r, x, z in BALLS), ())
    upper = place(box((0.5, 0.5, 0.5), 0.04, 5, 0.5), (2.45, 0.95, -5.2), (0, 50, 0))
    return [*blocks, Part(upper, cubes[3], standing(0.7, 0.1)), Part(balls, ball, shade)]
