"""Demo scene `highlights`: a lantern in focus before a street at night whose lamps are 50 times as bright as white."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from dofview.scene.demo import patterns as paint
from dofview.scene.demo.parts import Part, both, lamp, near, painted, standing
from dofview.scene.demo.shapes import Shape, box, ground, lathe, place, sheet, sphere, torus, tube
from dofview.scene.model import Material, Picture

VIEW = {
    "camera": {
        "position": [0.0, 1.0, 3.2], "target": [0.0, 0.82, 0.0], "up": [0.0, 1.0, 0.0],
        "vfov_deg": 40.0, "near": 2.5, "far": 30.0,
    },
    "lens": {"radius": 0.098, "focus_distance": 3.2, "distribution": "uniform_disc"},
    "image": {"size": [512, 384]},
    "background_linear": [0.006, 0.008, 0.014],
}  # fmt: skip

LIGHTS = {
    "white": (50.0, 50.0, 50.0), "warm": (50.0, 30.0, 12.0), "amber": (50.0, 17.0, 3.0), "teal": (8.0, 40.0, 50.0),
    "red": (50.0, 3.0, 2.0),
}  # fmt: skip
# Garlands across the street: the two ends, how far they sag, how many lamps they carry, of which colours in turn.
GARLANDS = (
    ((-4.5, 2.9, -4.0), (4.8, 2.5, -4.6), 0.7, 14, ("warm", "warm", "white")),
    ((-6.0, 4.0, -8.0), (6.5, 4.4, -7.4), 1.1, 16, ("amber", "warm", "teal")),
    ((-8.0, 5.2, -12.0), (8.5, 5.0, -12.5), 1.3, 18, ("white", "warm", "amber")),
)
STREET = -1.0
POSTS = ((-3.1, -4.2), (3.7, -6.0), (-4.9, -9.6), (5.8, -11.0))
CARS = ((2.6, -7.2, 8.0, "white"), (-2.9, -10.6, -10.0, "red"), (0.5, -13.6, 4.0, "white"), (-1.3, -6.3, 0.0, "red"))
CAP = ((0.3, 0.0), (0.29, 0.05), (0.18, 0.16), (0.06, 0.22), (0.05, 0.27), (0.0, 0.28))
BASE = ((0.0, 0.0), (0.3, 0.0), (0.31, 0.04), (0.25, 0.09), (0.24, 0.12), (0.0, 0.12))
CUP = ((0.0, 0.0), (0.1, 0.0), (0.12, 0.02), (0.15, 0.26), (0.14, 0.27), (0.12, 0.05), (0.0, 0.04))


def parts() -> list[Part]:
    """All shapes with their materials."""
    sill = painted("sill", paint.wood(123, ("2b1a10", "4f3119", "7a5230", "9a6f44"), 4), 0.85, tint=0.75)
    top = sheet((-3, 0, 0), (6, 0, 0), (0, 0, -0.7), (72, 9), 1.4)
    front = sheet((-3, -1.2, 0), (6, 0, 0), (0, 1.2, 0), (16, 4), 1.4)
    covered = near((-0.3, 0.14, -0.36, 0.28), (0.5, 0.05, -0.38, 0.22), (0.75, 0.05, -0.38, 0.22))
    return [
        Part(top + front, sill, covered), *_street(), *_lantern(), *_lamps(), *_cars(),
    ]  # fmt: skip


def _night(name: str, picture: Picture) -> Material:
    """Unlit: the light of the street is in its vertex colours, not in the renderer's lights."""
    return replace(painted(name, picture), unlit=True)


def _pools(positions: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """Light on the ground around the lamp posts, and less of it farther down the street."""
    light = np.full(len(positions), 0.22)
    for x, z in POSTS:
        light += 0.7 * np.exp(-np.sum((positions[:, ::2] - (x, z)) ** 2, axis=1) / 3.0)
    for x, z, _, color in CARS:
        if color == "white":
            light += 0.5 * np.exp(-np.sum((positions[:, ::2] - (x, z + 1.4)) ** 2 / (0.6, 1.5), axis=1))
    return light


def _street() -> list[Part]:
    cobbles = _night("street", paint.bricks(121, ("2a2f3b", "434a58", "6a6f78"), 16))
    house = _night("house", paint.facade(122))
    iron = painted("post", paint.stripes(151, ("15222b", "22343f"), 16), 0.6, tint=0.4)
    posts = sum((tube([(x, STREET, z), (x, 3.1, z)], 0.05, (8, 8), 1.0) for x, z in POSTS), ())
    walls = sheet((-14, STREET, -17), (28, 0, 0), (0, 9.6, 0), (28, 10), 4.8)
    left = sheet((-7.5, STREET, -1.5), (0, 0, -15.5), (0, 9.6, 0), (16, 10), 4.8)
    right = sheet((7.5, STREET, -17), (0, 0, 15.5), (0, 9.6, 0), (16, 10), 4.8)
    return [
        Part(ground(3.2, 3.9, 20.3, (40, 32), 2.0, STREET), cobbles, _pools),
        Part(walls + left + right, house),
        Part(posts, iron),
    ]


def _lantern() -> list[Part]:
    brass = painted("brass", paint.plaster(131, ("9c7434", "b98f42", "d0aa58"), 1.2, 4.0), 0.35, 0.8)
    woven = painted("shade", paint.kilim(132, ("f2d9a0", "c8452f", "1f5a66", "e0a030"), 8), 0.6)
    glow = replace(woven, emissive=(1.3, 0.85, 0.45), emissive_texture=woven.base_color_texture)
    cup = painted("cup", paint.stripes(133, ("e8dcc0", "28507a", "e8dcc0", "c8452f"), 12), 0.3)
    book = painted("book", paint.checker(134, ("5a1f1d", "7a2b26"), 16), 0.8)
    ring = 0.25 * np.exp(1j * np.radians(np.arange(30, 390, 60)))
    frame = [
        lathe(BASE, (32, 12)), place(lathe(CAP, (32, 14)), (0, 0.7, 0)),
        place(torus(0.09, 0.014, (24, 8)), (0, 1.05, 0), (90, 0, 0)),
        *(tube([(p.real, 0.1, p.imag), (p.real, 0.72, p.imag)], 0.018, (8, 4), 0.2) for p in ring),
    ]  # fmt: skip
    at, on_sill = (-0.3, 0.0, -0.36), standing(0, 0.1)
    on_book = both(standing(0.1, 0.05), near((0.58, 0.05, -0.38, 0.12)))
    return [
        Part(sum((place(s, at) for s in frame), ()), brass, on_sill),
        Part(place(lathe(((0.2, 0.12), (0.22, 0.3), (0.22, 0.55), (0.2, 0.7)), (32, 16), (3, 1)), at), glow),
        Part(place(box((0.62, 0.1, 0.44), 0.015, 8, 0.4), (0.58, 0.05, -0.38), (0, 14, 0)), book, on_sill),
        Part(place(lathe(CUP, (28, 14), (3, 1)), (0.58, 0.1, -0.38)), cup, on_book),
    ]


def _lamps() -> list[Part]:
    bulbs: dict[str, list[Shape]] = {name: [] for name in LIGHTS}
    wires = []
    for first, last, sag, count, colors in GARLANDS:

        def hanging(t: np.ndarray, first: tuple = first, last: tuple = last, sag: float = sag) -> np.ndarray:
            return np.outer(1 - t, first) + np.outer(t, last) - np.outer(4 * sag * t * (1 - t), (0, 1, 0))

        wires.append(tube([tuple(p) for p in hanging(np.linspace(0, 1, 9))], 0.012, (5, 24), 0.5))
        radius = 0.0036 * (3.2 - first[2])
        for k, (x, y, z) in enumerate(hanging((np.arange(count) + 0.5) / count)):
            bulbs[colors[k % len(colors)]].append(place(sphere(radius, (8, 6)), (x, y - 0.07, z)))
    for x, z in POSTS:
        bulbs["warm"].append(place(sphere(0.0055 * (3.2 - z), (10, 8)), (x, 3.15, z)))
    for x, z, turn, color in CARS:
        for side in (-0.5, 0.5):
            lights = place(place(sphere(0.04 + 0.002 * -z, (8, 6)), (side, 0.42, 0.95)), (x, STREET, z), (0, turn, 0))
            bulbs[color].append(lights)
    wire = painted("wire", paint.plaster(141, ("17181c", "26282e")), 0.8)
    return [Part(sum(wires, ()), wire), *(Part(sum(s, ()), lamp(n, LIGHTS[n])) for n, s in bulbs.items())]


def _cars() -> list[Part]:
    metal = painted("car", paint.stripes(152, ("3a1014", "4c171a", "28384a", "1c2a38"), 4), 0.3, tint=0.5)
    tyre = painted("tyre", paint.plaster(153, ("101114", "1c1d20")), 0.9)
    cabin = place(box((1.1, 0.42, 1.0), 0.16, 5, 1.0), (0, 0.78, -0.15))
    body = place(box((1.3, 0.5, 1.9), 0.14, 5, 1.0), (0, 0.42, 0)) + cabin
    wheel = lathe(((0.0, 0.0), (0.2, 0.0), (0.22, 0.05), (0.2, 0.14), (0.0, 0.14)), (14, 5))
    wheels = sum((place(wheel, (0.52 * s, 0.22, 0.58 * e), (0, 0, -90 * s)) for s in (-1, 1) for e in (-1, 1)), ())

    def parked(shape: Shape) -> Shape:
        return sum((place(shape, (x, STREET, z), (0, turn, 0)) for x, z, turn, _ in CARS), ())

    return [Part(parked(body), metal, standing(STREET, 0.3)), Part(parked(wheels), tyre)]
