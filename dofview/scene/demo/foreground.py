"""Demo scene `foreground`: strings of beads hang far in front of a tiled wall with a niche, in focus."""

from __future__ import annotations

import numpy as np

from dofview.scene.demo import patterns as paint
from dofview.scene.demo.parts import Part, both, near, painted, standing
from dofview.scene.demo.shapes import Shape, lathe, place, sheet, sphere, tube

POSITION, VFOV_DEG = (0.0, 1.5, 6.0), 40.0
VIEW = {
    "camera": {
        "position": [*POSITION], "target": [0.0, 1.5, 0.0], "up": [0.0, 1.0, 0.0],
        "vfov_deg": VFOV_DEG, "near": 1.5, "far": 8.0,
    },
    "lens": {"radius": 0.0875, "focus_distance": 6.0, "distribution": "uniform_disc"},
    "image": {"size": [512, 384]},
    "background_linear": [0.32, 0.30, 0.27],
}  # fmt: skip

# Each string: where it crosses the picture (−1 left … 1 right), its distance from the camera, and the height of its
# beads (−1 bottom … 1 top) with their radius as a share of the distance.
STRINGS = (
    (-1.02, 2.25, ((-0.75, 0.040), (-0.1, 0.055), (0.62, 0.045))),
    (-0.80, 2.9, ((-0.5, 0.03), (0.15, 0.045), (0.42, 0.025), (0.9, 0.03))),
    (-0.62, 4.2, ((-0.95, 0.025), (-0.2, 0.03), (0.05, 0.02), (0.72, 0.035))),
    (-0.44, 3.4, ((-0.72, 0.04), (-0.42, 0.022), (0.55, 0.03))),
    (-0.27, 4.7, ((-0.35, 0.02), (0.3, 0.026), (0.86, 0.02))),
    (-0.08, 3.1, ((-0.9, 0.03), (0.66, 0.034), (0.94, 0.02))),
    (0.13, 4.4, ((-0.55, 0.022), (0.2, 0.03), (0.44, 0.018))),
    (0.30, 2.6, ((-0.82, 0.045), (0.8, 0.05))),
    (0.47, 3.8, ((-0.3, 0.028), (-0.08, 0.02), (0.5, 0.036))),
    (0.63, 2.9, ((-0.62, 0.05), (0.1, 0.03), (0.3, 0.045))),
    (0.80, 4.1, ((-0.15, 0.03), (0.62, 0.025), (0.88, 0.034))),
    (0.99, 2.3, ((-0.35, 0.06), (0.38, 0.04), (0.85, 0.03))),
)
VASE = (
    (0.0, 0.0),
    (0.17, 0.0),
    (0.2, 0.03),
    (0.33, 0.3),
    (0.3, 0.55),
    (0.14, 0.75),
    (0.12, 0.86),
    (0.19, 0.94),
    (0.15, 0.92),
)
BOWL = ((0.0, 0.0), (0.16, 0.0), (0.18, 0.05), (0.34, 0.17), (0.4, 0.3), (0.37, 0.29), (0.3, 0.18), (0.0, 0.08))
NICHE = 1.2  # how high the niche is above its shelf, which is at y = 0
BOTTLE = (
    (0.0, 0.0),
    (0.15, 0.0),
    (0.17, 0.04),
    (0.17, 0.5),
    (0.14, 0.62),
    (0.06, 0.74),
    (0.055, 0.95),
    (0.075, 1.0),
    (0.05, 1.0),
)


def parts() -> list[Part]:
    """All shapes with their materials."""
    tiles = painted("tiles", paint.azulejo(), 0.5, tint=0.9)
    wall = sheet((-4.5, -1.8, 0), (9, 0, 0), (0, 1.8, 0), (24, 6), 2.4)
    wall += sheet((-4.5, NICHE, 0), (9, 0, 0), (0, 3.6, 0), (24, 10), 2.4)
    return [Part(wall, tiles), *_niche(), *_curtain()]


def _curtain() -> list[Part]:
    beads = [
        painted("coral", paint.kilim(31, ("c8452f", "f0d9b0", "7c1f2a", "e58a4e")), 0.35),
        painted("teal", paint.stripes(32, ("14616b", "e9e2cc", "2b8f8b", "0f3d4c"), 8), 0.3),
        painted("ochre", paint.checker(33, ("e0a030", "6a3413"), 8), 0.4),
        painted("ivory", paint.marble(34, ("5b4636", "d9cbb0", "f3ead6", "fff9ec")), 0.25),
        painted("plum", paint.terrazzo(35, ("4a2340", "5d2c4f"), ("f0c9a0", "e07a5f", "f4efe2", "9cc5c9"), 256), 0.3),
    ]
    cane = painted("cane", paint.stripes(36, ("b98a45", "c99b57", "a8783a", "6b4520"), 12), 0.6)
    shapes: list[list[Shape]] = [[] for _ in beads]
    rods = []
    for index, (across, distance, threaded) in enumerate(STRINGS):
        half = distance * np.tan(np.radians(VFOV_DEG / 2))
        x, z = across * half * 4 / 3, POSITION[2] - distance
        rods.append(tube([(x, 1.5 - 1.3 * half, z), (x, 1.5 + 1.3 * half, z)], 0.0045 * distance, (8, 8), 0.4))
        for nth, (height, radius) in enumerate(threaded):
            ball = sphere(radius * distance, (18, 11))
            turn = (15.0 * nth - 20, 40.0 * index, 25.0 * (nth % 3) - 25)
            shapes[(index * 2 + nth) % len(beads)].append(place(ball, (x, 1.5 + height * half, z), turn))
    rods.append(tube([(-1.5, 0.1, 2.6), (0.1, 1.35, 2.2), (2.4, 3.1, 1.7)], 0.022, (10, 12), 0.5))
    rods.append(tube([(-2.6, 2.9, 1.2), (0.1, 2.3, 1.7), (1.6, 2.05, 2.9)], 0.02, (10, 12), 0.5))
    return [*(Part(sum(s, ()), m) for s, m in zip(shapes, beads, strict=True)), Part(sum(rods, ()), cane)]


def _dusk(positions: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """Shade in the niche: darker the deeper and the nearer to its ceiling."""
    return 1.0 - 0.5 * np.clip(-positions[:, 2] / 0.4, 0, 1) * np.clip(positions[:, 1] / NICHE + 0.15, 0, 1)


def _niche() -> list[Part]:
    """A recess in the wall; what stands in it has its outline in the plane of the tiles, where focus is."""
    oak = painted("oak", paint.wood(41, ("4a2c17", "7a4c28", "a87240", "c69458"), 2, 256), 0.7)
    ochre = painted("ochre wall", paint.plaster(46, ("b98534", "cc9a45", "dcb062"), 1.0), 0.95)
    blue = painted("vase", paint.kilim(42, ("1d3f7a", "f4efe2", "d9942f", "7fb2d9"), 6), 0.4)
    clay = painted("clay", paint.plaster(43, ("8a3f22", "b65a31", "d07a48")), 0.8)
    glass = painted("bottle", paint.stripes(44, ("23513f", "2f6b52", "e2d9b8", "2f6b52"), 16), 0.4)
    fruit = painted("orange", paint.plaster(45, ("d9701a", "f08c24", "f6a93b"), 0.7), 0.6)
    oranges = [(0.08, 0.26, 0.05, 0.13), (0.33, 0.27, 0.02, 0.14), (0.22, 0.4, 0.02, 0.13)]
    balls = [place(sphere(radius), (x, y, z)) for x, y, z, radius in oranges]
    stood = near((-1.75, 0.3, 0, 0.36), (0.2, 0.2, 0, 0.36), (1.55, 0.3, 0, 0.2), (2.2, 0.2, 0, 0.22), strength=0.9)
    shelf = sheet((-4.5, 0, 0), (9, 0, 0), (0, 0, -0.4), (60, 4), 1.5)
    ceiling = sheet((-4.5, NICHE, -0.4), (9, 0, 0), (0, 0, 0.4), (12, 2), 1.5)
    floor = standing(0, 0.15)
    return [
        Part(shelf + ceiling, oak, stood),
        Part(sheet((-4.5, 0, -0.4), (9, 0, 0), (0, NICHE, 0), (45, 8), 1.2), ochre, both(_dusk, stood)),
        Part(place(lathe(VASE, (32, 24), (3, 1)), (-1.75, 0, 0)), blue, floor),
        Part(place(lathe(BOWL, (32, 16), (4, 1)), (0.2, 0, 0), scale=1.1), clay, floor),
        Part(sum(balls, ()), fruit, both(standing(0, 0.2), near(*oranges))),
        Part(place(lathe(BOTTLE, (24, 20), (2, 1)), (1.55, 0, 0)), glass, floor),
        Part(place(lathe(VASE, (24, 16), (3, 1)), (2.2, 0, 0), scale=0.6), clay, floor),
    ]
