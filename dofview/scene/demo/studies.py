"""Two demo scenes for one question each: `crossing` (two bars about the focal plane) and `glossy` (polished metal)."""

from __future__ import annotations

from dofview.scene.demo import patterns as paint
from dofview.scene.demo.parts import Part, both, near, painted, standing
from dofview.scene.demo.shapes import box, ground, lathe, place, sheet, sphere, torus, tube

CROSSING = {
    "camera": {
        "position": [0.0, 0.0, 6.0], "target": [0.0, 0.0, 0.0], "up": [0.0, 1.0, 0.0],
        "vfov_deg": 40.0, "near": 3.0, "far": 16.0,
    },
    "lens": {"radius": 0.2, "focus_distance": 6.0, "distribution": "uniform_disc"},
    "image": {"size": [512, 384]},
    "background_linear": [0.3, 0.3, 0.3],
}  # fmt: skip
GLOSSY = {
    "camera": {
        "position": [0.0, 1.5, 5.0], "target": [0.0, 0.62, 0.0], "up": [0.0, 1.0, 0.0],
        "vfov_deg": 40.0, "near": 2.0, "far": 14.0,
    },
    "lens": {"radius": 0.11, "focus_distance": 5.0, "distribution": "uniform_disc"},
    "light": {"environment": "studio"},
    "image": {"size": [512, 384]},
    "background_linear": [0.2, 0.2, 0.22],
}  # fmt: skip

PAWN = (
    (0.0, 0.0), (0.32, 0.0), (0.34, 0.06), (0.27, 0.14), (0.2, 0.2), (0.12, 0.45), (0.1, 0.62),
    (0.2, 0.68), (0.1, 0.72), (0.2, 0.86), (0.18, 1.0), (0.1, 1.08), (0.0, 1.1),
)  # fmt: skip


def crossing() -> list[Part]:
    """A bar at distance 4, one at 12, beads at the focus distance 6 and a wall at 14."""
    wall = painted("wall", paint.bricks(161, ("4d6b80", "7391a3", "9db4bd", "c3cfd0"), 16), 0.95)
    front = painted("front", paint.stripes(162, ("c8452f", "f6ead0"), 8), 0.5)
    back = painted("back", paint.stripes(163, ("e8c14a", "1e2b3f"), 8), 0.5)
    bead = painted("bead", paint.checker(164, ("f6ead0", "16202c"), 8), 0.4)
    beads = [
        place(sphere(0.16, (32, 20)), (x, y, 0), (20, 0, 20)) for x, y in ((-1.6, 0), (1.6, 0), (0, 1.2), (0, -1.2))
    ]
    return [
        Part(sheet((-8, -6, -8), (16, 0, 0), (0, 12, 0), (16, 12), 4.0), wall),
        Part(tube([(-2.6, -1.95, 2), (2.6, 1.95, 2)], 0.04, (12, 60), 0.6), front),
        Part(tube([(-7.8, 5.85, -6), (7.8, -5.85, -6)], 0.12, (12, 60), 1.8), back),
        Part(sum(beads, ()), bead),
    ]


# What stands on the table: the balls that shade it, x, y, z, radius.
STANDING = (
    (0.1, 0.62, -0.3, 0.62), (-0.75, 0.34, 1.5, 0.34), (-1.9, 0.5, -1.6, 0.5), (2.2, 0.35, -0.7, 0.42),
    (-1.15, 0.2, 0.5, 0.3), (1.2, 0.2, 1.3, 0.3), (1.9, 0.25, -2.4, 0.4), (-2.6, 0.2, -3.2, 0.36),
)  # fmt: skip


def glossy() -> list[Part]:
    """Balls, rings and pawns of polished metal on a steel table that mirrors a studio."""
    table = painted("table", paint.checker(171, ("cbbfa8", "6a6668"), 4, 512), 0.08, 1.0)
    back = painted("back", paint.kilim(172, ("8e2f24", "e8d6ad", "26404f", "d08a3a"), 8), 0.9)
    gold = painted("gold", paint.plaster(173, ("efbb58", "f4c566", "f8cf76"), 1.5), 0.14, 1.0)
    silver = painted("silver", paint.plaster(174, ("dedddb", "e8e7e3", "f2f0eb"), 1.5), 0.08, 1.0)
    copper = painted("copper", paint.plaster(175, ("dd9470", "e29b78", "e8a583"), 1.5), 0.2, 1.0)
    blue = painted("enamel", paint.stripes(176, ("28507a", "2f5c8a", "28507a", "e8dcc0"), 12), 0.1, 0.0)
    pawns = [(gold, 1.0, -1.15, 0.5), (silver, 1.0, 1.2, 1.3), (copper, 1.3, 1.9, -2.4), (gold, 1.2, -2.6, -3.2)]
    foot, ring = standing(0, 0.1), (0.75, 0.14, 0.75)
    around = near(*((ring[0] + 0.5 * x, 0.14, ring[2] + 0.5 * z, 0.16) for x, z in ((1, 0), (0, 1), (-1, 0), (0, -1))))
    return [
        Part(ground(5.0, 2.3, 11.2, (48, 30), 2.0), table, both(near(*STANDING), around)),
        Part(sheet((-8.5, 0, -6), (17, 0, 0), (0, 5, 0), (12, 6), 2.5), back),
        Part(place(sphere(0.62, (48, 28)), (0.1, 0.62, -0.3), (10, 0, 20)), silver, foot),
        Part(place(sphere(0.34, (36, 22)), (-0.75, 0.34, 1.5)), copper, foot),
        Part(place(sphere(0.5, (36, 22)), (-1.9, 0.5, -1.6), (30, 20, 10)), blue, foot),
        Part(place(torus(0.5, 0.14, (48, 20)), ring), gold, foot),
        Part(place(torus(0.7, 0.16, (48, 20)), (0.2, 0.86, -3.4), (80, 0, 30)), copper, foot),
        Part(place(box((0.7, 0.7, 0.7), 0.08, 12, 0.7), (2.2, 0.35, -0.7), (0, 30, 0)), blue, foot),
        *(Part(place(lathe(PAWN, (32, 36)), (x, 0, z), scale=s), m, foot) for m, s, x, z in pawns),
    ]
