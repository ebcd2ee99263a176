"""Rows about light: nothing is lost, nothing is made, nothing is averaged after the screen's curve."""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np

from dofview.lens import Distribution, Lens, focal_px
from dofview.metrics import srgb_encode
from dofview.render.environment import Lighting
from dofview.scene.load import load
from dofview.scene.model import Material, Picture, Sampler, Texture
from dofview.stress import shapes
from dofview.stress.bench import CAMERA, Bench, lens_for
from dofview.stress.row import Measured, Row, bounds

WHITE = 255.0


def furnace(bench: Bench, method: str, random: np.random.Generator) -> list[Measured]:
    """Everything is 0.5, at random depths, under a random lens."""
    grey = shapes.scene(shapes.scattered(random, materials=1), [shapes.unlit((0.5, 0.5, 0.5))])
    lens = Lens(
        radius=10 ** random.uniform(-2.5, -0.2), focus_distance=random.choice([random.uniform(1.5, 12.0), np.inf]),
        distribution=random.choice([Distribution.UNIFORM_DISC, Distribution.GAUSSIAN, Distribution.POLYGON]),
        blades=int(random.integers(3, 9)),
    )  # fmt: skip
    picture = bench.picture(grey, bench.settings(method, lens, background=0.5))
    return [Measured("largest departure from one colour, 1/255", WHITE * float(np.abs(picture - 0.5).max()))]


def point_energy(bench: Bench, method: str, random: np.random.Generator) -> list[Measured]:
    """One pixel of 1000 on black keeps its sum."""
    scene, lens, before = one_pixel(bench, method, random)
    after = bench.picture(scene, bench.settings(method, lens))
    return [Measured("change of the sum", abs(float(after.sum()) / before - 1.0))]


def one_pixel(bench: Bench, method: str, random: np.random.Generator, coc_px: float | None = None):
    """One emitter exactly on a pixel of a black wall, a lens that gives it `coc_px`, and the sum it must keep."""
    pixels = focal_px(bench.size, CAMERA.vfov_deg)
    coc = coc_px if coc_px is not None else random.uniform(0.03, 0.12) * bench.size
    depth = random.choice([random.uniform(2.0, 3.5), random.uniform(7.0, 12.0)])
    focus = 5.0
    radius = coc / (pixels * abs(1.0 / focus - 1.0 / depth))
    column, row = random.integers(int(0.4 * bench.size), int(0.6 * bench.size), 2)
    unit = depth / pixels
    x, y = (column + 0.5 - bench.size / 2) * unit, (bench.size / 2 - row - 0.5) * unit
    emitter = shapes.facing(x, y, 5.0 - depth, 0.5 * unit, 0.5 * unit)
    wall = shapes.facing(0.0, 0.0, 5.0 - depth * 1.0001, 2.0 * depth, 2.0 * depth, 1)
    scene = shapes.scene([emitter, wall], [shapes.unlit((1000.0, 1000.0, 1000.0)), shapes.unlit((0.0, 0.0, 0.0))])
    lens = lens_for(method, radius, focus)
    before = float(bench.picture(scene, bench.settings("pinhole", Lens(focus_distance=focus))).sum())
    return scene, lens, before


def finite(bench: Bench, method: str, random: np.random.Generator) -> list[Measured]:
    """Light of 65504, an empty scene, and a file with vertices and colours that are no numbers, lit by a picture with
    texels that are none: every pixel is a number."""
    bright = [shapes.unlit((6.5e4, 6.5e4, 0.0)), shapes.textured(random), shapes.unlit((0.0, 0.0, 0.0))]
    scene = shapes.scene(shapes.scattered(random, materials=3), bright)
    lens = Lens(radius=10 ** random.uniform(-2.0, 0.3), focus_distance=random.uniform(1.0, 8.0))
    settings = bench.settings(method, lens, background=1e4)
    wrong = 0
    for pictured in (scene, shapes.scene([], [])):
        wrong += int((~np.isfinite(bench.picture(pictured, settings))).sum())
    with tempfile.TemporaryDirectory() as folder:
        broken, sky = _broken_files(Path(folder), random)
        lit = settings.with_(light=Lighting(environment=str(sky)))
        wrong += int((~np.isfinite(bench.picture(load(broken), lit))).sum())
    return [Measured("pixels that are not numbers", wrong)]


def _broken_files(folder: Path, random: np.random.Generator) -> tuple[Path, Path]:
    """A model and an environment, each with numbers that are none."""
    import OpenEXR

    odd = ("nan", "inf", "-inf", "1e39", "-0", "1e-45")
    vertices = [[f"{x:.3f}" for x in (*random.uniform(-2, 2, 3), *random.uniform(0, 1, 3))] for _ in range(300)]
    for number in range(0, 300, 7):
        vertices[number][random.integers(6)] = str(random.choice(odd))
    model = folder / "broken.obj"
    faces = [f"f {3 * i + 1} {3 * i + 2} {3 * i + 3}" for i in range(100)]
    model.write_text("\n".join([*("v " + " ".join(vertex) for vertex in vertices), *faces]))
    texels = random.uniform(0.0, 6e4, (16, 32, 3)).astype(np.float32)
    texels[random.integers(16, size=20), random.integers(32, size=20)] = [np.nan, np.inf, -np.inf]
    sky = folder / "broken.exr"
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    with OpenEXR.File(header, {"RGB": texels}) as file:
        file.write(str(sky))
    return model, sky


def linear_light(bench: Bench, method: str, random: np.random.Generator) -> list[Measured]:
    """A checker of single black and white pixels, far out of focus, is the grey of half the light: 188 of 255."""
    pixels = np.full((256, 256, 4), 255, np.uint8)
    pixels[..., :3] = (255 * (np.indices((256, 256)).sum(axis=0) % 2)).astype(np.uint8)[..., None]
    nearest = Sampler(magnify="NEAREST", minify="NEAREST")
    checker = Material("checker", unlit=True, double_sided=True,
                       base_color_texture=Texture(Picture("checker", pixels), nearest))  # fmt: skip
    half = 5.0 * np.tan(np.radians(20.0)) * 256 / bench.size
    scene = shapes.scene([shapes.facing(0, 0, 0, half, half)], [checker])
    picture = bench.picture(scene, bench.settings(method, lens_for(method, 0.5, 2.5), guard_px=0))
    middle = slice(bench.size // 4, -(bench.size // 4))
    grey = WHITE * float(srgb_encode(picture[middle, middle]).mean())
    return [Measured("distance from 188 in sRGB", abs(grey - 188.0))]


ROWS = (
    Row(1, "white furnace", bounds(0.25, 2.0, 1.0, 2.0, 1.0, 1.0), furnace),
    Row(2, "energy of a point", bounds(0.01, 0.03, 0.03, 0.05, 0.05, 0.05), point_energy),
    Row(13, "finite", bounds(0.0), finite),
    Row(19, "linear light", bounds(2.0), linear_light),
)  # fmt: skip
