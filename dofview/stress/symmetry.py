"""Rows about what must not matter: where the scene stands, how large it is, which way up, how often it was drawn."""

from __future__ import annotations

import numpy as np

from dofview.lens import Lens
from dofview.methods import METHODS
from dofview.metrics import psnr
from dofview.scene.camera import Camera
from dofview.stress import shapes
from dofview.stress.bench import CAMERA, Bench
from dofview.stress.row import Measured, Row, bounds


def _textured_scene(random: np.random.Generator) -> tuple[list, list]:
    return shapes.scattered(random), [shapes.textured(random, 32) for _ in range(4)]


def _lens(random: np.random.Generator) -> Lens:
    return Lens(radius=random.uniform(0.05, 0.25), focus_distance=random.uniform(3.0, 8.0))


def _difference(what: str, first: np.ndarray, second: np.ndarray) -> list[Measured]:
    """Mean and 99.9th percentile of the difference as it is shown, 1/255."""
    apart = 255.0 * np.abs(np.clip(first, 0, 1) - np.clip(second, 0, 1)).max(axis=2)
    return [Measured(f"{what}: mean, 1/255", float(apart.mean())),
            Measured(f"{what}: 99.9th percentile, 1/255", float(np.percentile(apart, 99.9)))]  # fmt: skip


def mirrored(bench: Bench, method: str, random: np.random.Generator) -> list[Measured]:
    """The mirrored scene gives the mirrored picture, the scene turned by 90° the turned one."""
    cards, materials = _textured_scene(random)
    lens = _lens(random)
    picture = bench.picture(shapes.scene(cards, materials), bench.settings(method, lens))
    flip = np.diag([-1.0, 1.0, 1.0, 1.0])
    turn = np.array([[0.0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
    flipped = bench.picture(shapes.scene(cards, materials, flip), bench.settings(method, lens))[:, ::-1]
    turned = np.rot90(bench.picture(shapes.scene(cards, materials, turn), bench.settings(method, lens)), -1)
    found = [_difference("mirrored", picture, flipped), _difference("turned", picture, turned)]
    return [max(pair, key=lambda m: m.value) for pair in zip(*found, strict=True)]


def deterministic(bench: Bench, method: str, random: np.random.Generator) -> list[Measured]:
    """The same bytes after other methods, other sizes and a fresh start."""
    scene = shapes.scene(*_textured_scene(random))
    settings = bench.settings(method, _lens(random))
    first = bench.picture(scene, settings)
    for _ in range(5):
        other = bench.settings(
            str(random.choice(METHODS)), _lens(random), size=tuple(random.integers(1, bench.size, 2).tolist())
        )
        bench.picture(scene, other.with_params(views=2) if other.method == "accumulation" else other)
    second = bench.picture(scene, settings)
    bench.pipeline(scene).forget()
    third = bench.picture(scene, settings)
    apart = max(float(np.abs(first - second).max()), float(np.abs(first - third).max()))
    return [Measured("largest difference, 1/255", 255.0 * apart)]


def scaled(bench: Bench, method: str, random: np.random.Generator) -> list[Measured]:
    """Scene, camera, focus and lens in other units."""
    cards, materials = _textured_scene(random)
    lens = _lens(random)
    picture = bench.picture(shapes.scene(cards, materials), bench.settings(method, lens))
    worst = [Measured("", 0.0), Measured("", 0.0)]
    for factor in (2.0**20, 2.0**-20, 1e3, 1e-3):
        matrix = np.diag([factor, factor, factor, 1.0])
        camera = CAMERA.model_copy(update={"position": tuple(factor * x for x in CAMERA.position)})
        larger = Lens(radius=lens.radius * factor, focus_distance=lens.focus_distance * factor)
        other = bench.picture(shapes.scene(cards, materials, matrix), bench.settings(method, larger, camera))
        apart = 255.0 * np.abs(picture - other).max(axis=2)
        found = [Measured("99.9th percentile, 1/255", float(np.percentile(apart, 99.9))),
                 Measured("mean, 1/255", float(apart.mean()))]  # fmt: skip
        worst = [max(pair, key=lambda m: m.value) for pair in zip(worst, found, strict=True)]
    return [m if m.what else Measured("none", 0.0) for m in worst]


def moved(bench: Bench, method: str, random: np.random.Generator) -> list[Measured]:
    """A node and the camera a thousand kilometres away."""
    cards, materials = _textured_scene(random)
    lens = _lens(random)
    offset = np.array([1e6, -2e6, 1e6])
    matrix = np.eye(4)
    matrix[:3, 3] = offset
    camera = Camera(
        position=tuple(np.add(CAMERA.position, offset)),
        target=tuple(np.add(CAMERA.target, offset)),
        vfov_deg=CAMERA.vfov_deg,
    )
    picture = bench.picture(shapes.scene(cards, materials), bench.settings(method, lens))
    there = bench.picture(shapes.scene(cards, materials, matrix), bench.settings(method, lens, camera))
    return _difference("moved", picture, there)


def rotated(bench: Bench, method: str, random: np.random.Generator) -> list[Measured]:
    """World and camera turned together."""
    cards, materials = _textured_scene(random)
    lens = _lens(random)
    turn = np.linalg.qr(random.normal(size=(3, 3)))[0]
    turn *= np.sign(np.linalg.det(turn))
    matrix = np.eye(4)
    matrix[:3, :3] = turn
    camera = Camera(
        position=tuple(turn @ CAMERA.position),
        target=(0.0, 0.0, 0.0),
        up=tuple(turn @ CAMERA.up),
        vfov_deg=CAMERA.vfov_deg,
    )
    picture = bench.picture(shapes.scene(cards, materials), bench.settings(method, lens))
    there = bench.picture(shapes.scene(cards, materials, matrix), bench.settings(method, lens, camera))
    return _difference("rotated", picture, there)[:1]


def resolution(bench: Bench, method: str, random: np.random.Generator) -> list[Measured]:
    """Four times the size, averaged down, is the picture itself: the blur is a share of the height."""
    scene = shapes.scene(shapes.scattered(random), [shapes.textured(random, 16) for _ in range(4)])
    lens = _lens(random)
    size = bench.size
    small = bench.picture(scene, bench.settings(method, lens, size=(size, size), views=64))
    large = bench.picture(scene, bench.settings(method, lens, size=(4 * size, 4 * size), views=64))
    reduced = large.reshape(size, 4, size, 4, 3).mean(axis=(1, 3))
    return [Measured("PSNR, dB", psnr(small, reduced), at_least=True)]


ROWS = (
    Row(7, "symmetry", bounds((0.3, 2), (0.5, 2), (0.5, 3), (0.5, 3), (0.5, 3), (0.5, 3)), mirrored),
    Row(8, "determinism", bounds(0.0, 1.0, 0.0, 0.0, 0.0, 0.0), deterministic),
    Row(9, "scale", bounds((2, 0.05), (2, 0.05), (4, 0.1), (2, 0.05), (2, 0.05), (2, 0.05)), scaled),
    Row(10, "a million metres away",
        bounds((0.1, 2), (0.1, 2), (0.3, 4), (0.1, 2), (0.1, 2), (0.1, 2)), moved),
    Row(11, "rotation", bounds(0.2, 0.3, 0.5, 0.3, 0.3, 0.3), rotated),
    Row(12, "resolution", bounds(35.0, 32.0, 30.0, 30.0, 28.0, 28.0), resolution),
)  # fmt: skip
