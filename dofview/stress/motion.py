"""Rows about movement, number of views, aperture pictures and depth: nothing pops, stalls or has holes."""

from __future__ import annotations

import numpy as np

from dofview.gl.context import Gpu
from dofview.lens import Distribution, Lens, focal_px
from dofview.pipeline import Pipeline
from dofview.sampling import lens_samples
from dofview.scene.model import Material, Picture, Texture
from dofview.settings import ImageSettings, Settings
from dofview.stress import shapes
from dofview.stress.bench import CAMERA, Bench
from dofview.stress.row import Measured, Row, bounds


def smooth(bench: Bench, method: str, random: np.random.Generator) -> list[Measured]:
    """Small steps of focus and of aperture change the picture's mean by small steps: no popping."""
    scene = shapes.scene(shapes.scattered(random), [shapes.textured(random) for _ in range(4)])
    size = (bench.size // 2, bench.size // 2)
    start, radius = random.uniform(3.0, 6.0), random.uniform(0.08, 0.2)
    ratio, largest = 0.0, 0.0
    for path in (
        [Lens(radius=radius, focus_distance=start * 1.004**step) for step in range(60)],
        [Lens(radius=radius * step / 59.0, focus_distance=start) for step in range(60)],
    ):
        pictures = [bench.picture(scene, bench.settings(method, lens, size=size)) for lens in path]
        steps = 255.0 * np.array([np.abs(b - a).mean() for a, b in zip(pictures, pictures[1:], strict=False)])
        ratio = max(ratio, float(steps.max() / max(np.median(steps), 0.02)))
        largest = max(largest, float(steps.max()))
    return [Measured("largest step over the median one", ratio), Measured("largest step, 1/255", largest)]


def convergence(bench: Bench, method: str, random: np.random.Generator) -> list[Measured]:
    """The share of the lens behind a half-plane, at 400 offsets: error against the number of views."""
    offsets = np.linspace(-0.995, 0.995, 400)
    truth = 0.5 + (offsets * np.sqrt(1.0 - offsets**2) + np.arcsin(offsets)) / np.pi
    counts = 2 ** np.arange(4, 11)
    errors = []
    for count in counts:
        apart = []
        for _ in range(12):
            points = lens_samples(Lens(radius=1.0), int(count), progressive=True, seed=int(random.integers(1 << 30)))
            angle = random.uniform(0.0, 2.0 * np.pi)
            along = points @ [np.cos(angle), np.sin(angle)]
            apart.append((along[None, :] <= offsets[:, None]).mean(axis=1) - truth)
        errors.append(float(np.sqrt(np.mean(np.square(apart)))))
    slope = float(np.polyfit(np.log(counts), np.log(errors), 1)[0])
    return [Measured("log-log slope", slope), Measured("RMSE at 64", errors[2]), Measured("RMSE at 1024", errors[-1])]


def picture_convergence(bench: Bench, method: str, random: np.random.Generator) -> list[Measured]:
    """The reference's error against the analytic picture of a blurred slanted edge, from 16 to 4096 views."""
    errors = picture_errors(bench.gpu, random)
    counts = np.array(list(errors))
    slope = float(np.polyfit(np.log(counts), np.log(list(errors.values())), 1)[0])
    return [Measured("log-log slope to 4096 views", slope), Measured("RMSE at 4096", errors[4096])]


def picture_errors(gpu: Gpu, random: np.random.Generator, size: int = 48) -> dict[int, float]:
    """RMS error of a picture of `size` px by number of views, 2⁴ to 2¹², each twice what it was."""
    angle, shift = random.uniform(0.0, 2.0 * np.pi), random.uniform(-0.2, 0.2) * size
    across, along = np.array([np.cos(angle), np.sin(angle), 0.0]), np.array([-np.sin(angle), np.cos(angle), 0.0])
    depth, half = random.uniform(2.0, 3.5), 20.0
    unit = depth / focal_px(size, CAMERA.vfov_deg)
    edge = across * shift * unit + [0.0, 0.0, 5.0 - depth]
    white = shapes.card(edge - half * across, half * across, half * along)
    lens = Lens(radius=random.uniform(0.15, 0.3) * size / focal_px(size, CAMERA.vfov_deg) / abs(0.2 - 1.0 / depth))
    coc = lens.radius * focal_px(size, CAMERA.vfov_deg) * abs(0.2 - 1.0 / depth)
    rows, columns = np.indices((size, size)) + 0.5
    offset = shift - (columns - size / 2) * across[0] - (size / 2 - rows) * across[1]
    share = np.clip(offset / coc, -1.0, 1.0)
    truth = 0.5 + (share * np.sqrt(1.0 - share**2) + np.arcsin(share)) / np.pi
    pipeline = Pipeline(gpu, shapes.scene([white], [shapes.unlit((1.0, 1.0, 1.0))]))
    settings = Settings(
        camera=CAMERA, lens=lens, background_linear=(0.0, 0.0, 0.0), image=ImageSettings(size=(size, size))
    )
    errors = {}
    try:
        reference = pipeline.reference(settings)
        while reference.views < 4096:
            reference.add(max(reference.views, 16))
            picture = pipeline.reference_picture(settings).pixels()[..., 0]
            errors[reference.views] = float(np.sqrt(np.mean((picture - truth) ** 2)))
    finally:
        pipeline.release()
    return errors


def bokeh_picture(bench: Bench, method: str, random: np.random.Generator) -> list[Measured]:
    """A heart as aperture: near and far points are each other turned by 180°."""
    near = _spot(bench, method, random, 2.5)
    far = _spot(bench, method, random, 11.0)
    return [Measured("correlation of near and turned far disc", _correlation(near, far[::-1, ::-1]), at_least=True)]


def _spot(bench: Bench, method: str, random: np.random.Generator, depth: float) -> np.ndarray:
    """A blurred point in the middle, seen through a heart, its disc 0.15 of the height wide."""
    pixels = focal_px(bench.size + 1, CAMERA.vfov_deg)
    unit = depth / pixels
    radius = 0.15 * bench.size / (pixels * abs(1.0 / 5.0 - 1.0 / depth))
    wall = shapes.facing(0.0, 0.0, 5.0 - depth * 1.0001, 2.0 * depth, 2.0 * depth, 1)
    scene = shapes.scene(
        [shapes.facing(0.0, 0.0, 5.0 - depth, 0.5 * unit, 0.5 * unit), wall],
        [shapes.unlit((1000.0, 1000.0, 1000.0)), shapes.unlit((0.0, 0.0, 0.0))],
    )  # fmt: skip
    lens = Lens(radius=radius, focus_distance=5.0, distribution=Distribution.IMAGE, image="heart")
    size = (bench.size + 1, bench.size + 1)
    return bench.picture(scene, bench.settings(method, lens, size=size)).mean(axis=2)


def _correlation(first: np.ndarray, second: np.ndarray) -> float:
    """Best correlation over shifts of a pixel: the middle of the picture may lie between two."""
    best = -1.0
    for rows in (-1, 0, 1):
        for columns in (-1, 0, 1):
            moved = np.roll(second, (rows, columns), (0, 1))
            best = max(best, float(np.corrcoef(first.ravel(), moved.ravel())[0, 1]))
    return best


def stacked(bench: Bench, method: str, random: np.random.Generator) -> list[Measured]:
    """64 sheets full of holes, more than any method has layers: no pixel darker than the darkest sheet by more than
    8/255."""
    holes = np.full((64, 64, 4), 255, np.uint8)
    holes[..., 3] = np.where(random.random((64, 64)) < 0.5, 255, 0)
    sheet = Material("sheet", unlit=True, double_sided=True, alpha_mode="MASK", base_color=(0.6, 0.7, 0.8, 1.0),
                     base_color_texture=Texture(Picture("holes", holes)))  # fmt: skip
    sheets = [shapes.facing(0, 0, z, 6, 6, 0) for z in np.linspace(2.5, -4.0, 64)]
    wall = shapes.facing(0, 0, -6, 14, 10, 1)
    scene = shapes.scene([*sheets, wall], [sheet, shapes.unlit((0.6, 0.7, 0.8))])
    lens = Lens(radius=random.uniform(0.05, 0.3), focus_distance=random.uniform(3.0, 8.0))
    picture = bench.picture(scene, bench.settings(method, lens))
    sharp = bench.picture(scene, bench.settings("pinhole", lens))
    return [Measured("darker than the pinhole's darkest, 1/255", 255.0 * float(sharp.min() - picture.min()))]


ROWS = (
    Row(14, "convergence of the lens samples",
        bounds((-0.65, 0.020, 0.0025), None, None, None, None, None), convergence),
    Row(17, "smooth sliders", bounds((3.0, 1.5)), smooth),
    Row(18, "aperture picture", bounds(0.9, 0.9, 0.9, None, None, None), bokeh_picture),
    Row(20, "more sheets than layers", bounds(8.0), stacked),
    Row(28, "convergence of pictures",
        bounds((-0.5, 0.001), None, None, None, None, None), picture_convergence),
)  # fmt: skip
