"""Demo scene `background`: a still life at the front edge of a hall, in focus; all else is behind it."""

from __future__ import annotations

from dofview.scene.demo import patterns as paint
from dofview.scene.demo.foreground import VASE
from dofview.scene.demo.parts import Part, both, near, painted, standing
from dofview.scene.demo.shapes import box, ground, lathe, place, sheet, sphere, torus

VIEW = {
    "camera": {
        "position": [0.0, 1.15, 3.2], "target": [0.0, 0.8, 0.0], "up": [0.0, 1.0, 0.0],
        "vfov_deg": 40.0, "near": 2.5, "far": 20.0,
    },
    "lens": {"radius": 0.0755, "focus_distance": 3.2, "distribution": "uniform_disc"},
    "image": {"size": [512, 384]},
    "background_linear": [0.16, 0.13, 0.11],
}  # fmt: skip

COLUMN = ((0.5, 0.0), (0.52, 0.12), (0.42, 0.3), (0.4, 0.4), (0.38, 2.5), (0.36, 5.0), (0.36, 7.0))


# Every ball in the hall: material, radius, x, z.
BALLS = (
    ("red", 0.55, -1.7, -2.6), ("green", 0.7, 1.75, -3.2), ("blue", 0.95, -0.5, -5.6), ("gold", 0.6, 2.9, -6.3),
    ("green", 0.8, -3.6, -6.6), ("red", 1.0, 1.2, -8.9), ("blue", 0.7, 4.6, -8.2), ("gold", 1.1, -2.6, -10.4),
)  # fmt: skip
PILLARS = ((-3.2, -4.6), (3.4, -4.9), (-5.6, -9.6), (5.8, -10.2))
SUBJECT = ((0.5, 0.25, -0.55, 0.3), (-0.35, 0.25, -0.6, 0.26), (0.1, 0.03, -0.27, 0.11), (-0.72, 0.08, -0.28, 0.08))


def parts() -> list[Part]:
    """All shapes with their materials."""
    chips = ("7a3b2b", "2f4f4a", "e8dcc0", "c98a3b", "413a36")
    floor = painted("floor", paint.terrazzo(51, ("a3937a", "b5a78b", "c6b99c"), chips), 0.75)
    shelves = painted("books", paint.books(52), 0.9, tint=0.8)
    apron = painted("apron", paint.kilim(53, ("8e2f24", "e8d6ad", "26404f", "d08a3a", "3a1d1a"), 6), 0.9)
    covered = near(
        *((x, r, z, r) for _, r, x, z in BALLS), *SUBJECT, *((x, h, z, 0.5) for x, z in PILLARS for h in (0.3, 1.3))
    )
    foot = near(*((x, -0.1, -12.5, 0.7) for x in range(-9, 10)), strength=0.5)
    return [
        Part(ground(3.2, 3.2, 16.4, (48, 28), 2.0), floor, covered),
        Part(sheet((-3, -1.6, 0), (6, 0, 0), (0, 1.6, 0), (12, 4), 0.8), apron),
        Part(sheet((-12, 0, -13), (24, 0, 0), (0, 7.5, 0), (24, 12), 3.75), shelves, foot),
        *_subject(),
        *_hall(),
    ]


def _subject() -> list[Part]:
    wood = painted("cube", paint.checker(61, ("e6d3a7", "3a2115"), 4), 0.5)
    jar = painted("jar", paint.kilim(66, ("f2ead6", "1f5a66", "c8452f", "e0a030"), 9), 0.45)
    ball = painted(
        "ball", paint.terrazzo(63, ("f0e9da", "f8f3e8"), ("c8452f", "1f5a66", "e0a030", "26313f"), 256), 0.25
    )
    brass = painted("brass", paint.plaster(64, ("b58a40", "c9a04e", "dab868"), 1.4, 6.0), 0.5, 1.0)
    cube = place(box((0.5, 0.5, 0.5), 0.03, 8, 0.5), (0.5, 0.25, -0.55), (0, 28, 0))
    on_cube = near((0.52, 0.25, -0.55, 0.3))
    return [
        Part(cube, wood, both(standing(0, 0.12), near((0.52, 0.74, -0.55, 0.24)))),
        Part(place(lathe(VASE, (44, 36), (3, 1)), (-0.35, 0, -0.6), scale=1.2), jar, standing(0, 0.15)),
        Part(place(sphere(0.24, (40, 24)), (0.52, 0.74, -0.55), (20, 10, 15)), ball, both(standing(0.5, 0.1), on_cube)),
        Part(place(torus(0.14, 0.035), (0.1, 0.035, -0.27)), brass, standing(0, 0.05)),
        Part(place(sphere(0.08, (24, 14)), (-0.72, 0.08, -0.28)), brass, standing(0, 0.05)),
    ]


def _hall() -> list[Part]:
    column = painted("column", paint.marble(71, ("6b5a4a", "c7b394", "dccbac", "efe3c9")), 0.7)
    paints = {
        "red": painted("red", paint.stripes(72, ("a33122", "e9dcc0"), 10), 0.4),
        "green": painted("green", paint.checker(73, ("2b5d50", "d8cfae"), 6), 0.4),
        "blue": painted("blue", paint.marble(74, ("e8e2d0", "1d3550", "2b4f73", "3e6a94")), 0.3),
        "gold": painted("gold", paint.kilim(75, ("d99a2b", "7d2a26", "f0e2bf"), 6), 0.5),
    }
    balls = [
        Part(place(sphere(r, (28, 18)), (x, r, z), (25, 70 * i, 20)), paints[kind], standing(0, 0.5 * r))
        for i, (kind, r, x, z) in enumerate(BALLS)
    ]
    pillars = sum((place(lathe(COLUMN, (20, 16), (2, 4)), (x, 0, z)) for x, z in PILLARS), ())
    return [*balls, Part(pillars, column, standing(0, 0.4))]
