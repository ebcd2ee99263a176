"""Demo scene `highlights`: a lantern in focus before a street at night whose lamps are 50 times as bright as white."""

from __future__ import annotations

import numpy as np

from dofview.scene.demo import patterns as paint
from dofview.scene.demo.parts import Part, lamp, painted
from dofview.scene.demo.shapes import Shape, box, lathe, place, sheet, sphere, torus, tube

VIEW = {
    "camera": {
        "position": [0.0, 1.0, 3.2], "target": [0.0, 0.82, 0.0], "up": [0.0, 1.0, 0.0],
        "vfov_deg": 40.0, "near": 2.5, "far": 30.0,
    },
    "lens": {"radius": 0.098, "focus_distance": 3.2, "distribution": "uniform_disc"},
    "image": {"size": [512, 384]},
    "background_linear": [0.006, 0.008, 0.014],
}  # fmt: skip

WHITE, WARM, AMBER, TEAL = (50.0, 50.0, 50.0), (50.0, 30.0, 12.0), (50.0, 17.0, 3.0), (8.0, 40.0, 50.0)
# Garlands across the street: the two ends, how far they sag, and how many lamps they carry.
GARLANDS = (
    ((-4.5, 3.4, -5.0), (4.5, 3.0, -6.0), 0.9, 12),
    ((-6.0, 4.2, -9.0), (6.5, 4.6, -8.0), 1.2, 14),
    ((-8.0, 5.4, -13.0), (8.5, 5.0, -13.5), 1.4, 16),
)
CAP = ((0.3, 0.0), (0.29, 0.05), (0.18, 0.16), (0.06, 0.22), (0.05, 0.27), (0.0, 0.28))
BASE = ((0.0, 0.0), (0.3, 0.0), (0.31, 0.04), (0.25, 0.09), (0.24, 0.12), (0.0, 0.12))


def parts() -> list[Part]:
    """All shapes with their materials."""
    street = painted("street", paint.bricks(121, ("1a1d24", "2a2e38", "3c404b"), 16), 0.4, tint=0.5)
    house = painted("house", paint.bricks(122, ("2a1713", "4a2419", "6b3524"), 12), 0.9, tint=0.35)
    sill = painted("sill", paint.wood(123, ("2b1a10", "4f3119", "7a5230", "9a6f44"), 4), 0.5)
    return [
        Part(sheet((-12, -1.0, -0.7), (24, 0, 0), (0, 0, -17), (16, 14), 2.0), street),
        Part(sheet((-12, -1.0, -17), (24, 0, 0), (0, 9, 0), (14, 8), 3.0), house),
        Part(
            sheet((-3, 0, 0), (6, 0, 0), (0, 0, -0.7), (10, 3), 1.4)
            + sheet((-3, -1.2, 0), (6, 0, 0), (0, 1.2, 0), (10, 4), 1.4),
            sill,
        ),
        *_lantern(),
        *_lamps(),
        *_street(),
    ]


def _lantern() -> list[Part]:
    brass = painted("brass", paint.plaster(131, ("7d5a25", "b98f42", "e0bd6c"), 0.8, 4.0), 0.4, 0.7)
    glass = painted("shade", paint.kilim(132, ("f2d9a0", "c8452f", "1f5a66", "e0a030"), 8), 0.3)
    cup = painted("cup", paint.stripes(133, ("e8dcc0", "28507a", "e8dcc0", "c8452f"), 12), 0.3)
    book = painted("book", paint.checker(134, ("5a1f1d", "7a2b26"), 16), 0.8)
    pillars = [
        tube(
            [(0.25 * np.cos(a), 0.1, 0.25 * np.sin(a)), (0.25 * np.cos(a), 0.72, 0.25 * np.sin(a))], 0.018, (8, 4), 0.2
        )
        for a in np.radians(np.arange(30, 390, 60))
    ]
    frame = [
        lathe(BASE, (32, 12)),
        place(lathe(CAP, (32, 14)), (0, 0.7, 0)),
        place(torus(0.09, 0.014, (24, 8)), (0, 1.05, 0), (90, 0, 0)),
        *pillars,
    ]
    at = (-0.3, 0.0, -0.36)
    return [
        Part(sum((place(s, at) for s in frame), ()), brass),
        Part(place(lathe(((0.2, 0.12), (0.22, 0.3), (0.22, 0.55), (0.2, 0.7)), (32, 16), (3, 1)), at), glass),
        Part(place(box((0.62, 0.1, 0.44), 0.015, 8, 0.4), (0.58, 0.05, -0.38), (0, 14, 0)), book),
        Part(
            place(
                lathe(
                    ((0.0, 0.0), (0.1, 0.0), (0.12, 0.02), (0.15, 0.26), (0.14, 0.27), (0.12, 0.05), (0.0, 0.04)),
                    (28, 14),
                    (3, 1),
                ),
                (0.58, 0.1, -0.38),
            ),
            cup,
        ),
    ]


def _lamps() -> list[Part]:
    bulbs: list[list[Shape]] = [[], [], [], []]
    wires = []
    for n, (first, last, sag, count) in enumerate(GARLANDS):
        t = (np.arange(count) + 0.5) / count
        line = np.outer(1 - t, first) + np.outer(t, last) - np.outer(4 * sag * t * (1 - t), (0, 1, 0))
        ends = np.linspace(0, 1, 9)
        curve = np.outer(1 - ends, first) + np.outer(ends, last) - np.outer(4 * sag * ends * (1 - ends), (0, 1, 0))
        wires.append(tube([tuple(p) for p in curve], 0.012, (5, 24), 0.5))
        for k, (x, y, z) in enumerate(line):
            bulbs[(2 * n + k) % 4 if k % 3 == 0 else (0 if n == 1 else 1)].append(
                place(sphere(0.028 + 0.008 * n, (8, 6)), (x, y - 0.07, z))
            )
    rng = np.random.default_rng(7)
    for k in range(26):
        x, y, z = rng.random(3) * (18, 2.6, 8) + (-9, -0.6, -16)
        bulbs[(k % 7) % 4].append(place(sphere(0.045, (8, 6)), (x, y, z)))
    wire = painted("wire", paint.plaster(141, ("17181c", "26282e")), 0.8)
    names = ("white", "warm", "amber", "teal")
    lights = (WHITE, WARM, AMBER, TEAL)
    return [
        Part(sum(wires, ()), wire),
        *(Part(sum(s, ()), lamp(n, c)) for s, n, c in zip(bulbs, names, lights, strict=True)),
    ]


def _street() -> list[Part]:
    iron = painted("post", paint.stripes(151, ("15222b", "22343f"), 16), 0.5)
    car = painted("car", paint.plaster(152, ("3a0f12", "5c171a", "7d2322")), 0.25, tint=0.6)
    van = painted("van", paint.stripes(153, ("1f3d4c", "b9a678", "1f3d4c", "1f3d4c"), 4), 0.4, tint=0.5)
    posts = [
        tube([(x, -1.0, z), (x, 3.6, z)], 0.06, (8, 8), 1.0)
        for x, z in ((-3.6, -4.2), (3.9, -6.5), (-5.4, -10.0), (6.4, -11.5))
    ]
    heads = [place(sphere(0.09, (10, 8)), (x, 3.7, z)) for x, z in ((-3.6, -4.2), (3.9, -6.5))]
    return [
        Part(sum(posts, ()), iron),
        Part(sum(heads, ()), lamp("head", WARM)),
        Part(place(box((2.6, 0.9, 1.3), 0.2, 8, 1.0), (3.0, -0.5, -8.0), (0, 20, 0)), car),
        Part(place(box((3.0, 1.5, 1.4), 0.2, 8, 1.0), (-3.4, -0.2, -11.5), (0, -12, 0)), van),
    ]
