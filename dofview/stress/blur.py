"""Rows about the size of the blur: sharp where it must be, as wide as the lens says, in the right place."""

from __future__ import annotations

import numpy as np

from dofview.lens import Distribution, Lens, focal_px
from dofview.metrics import psnr
from dofview.stress import shapes
from dofview.stress.bench import CAMERA, GAUSSIAN, Bench, lens_for
from dofview.stress.light import one_pixel
from dofview.stress.row import Measured, Row, bounds

# Width of the 10–90 % rise of a blurred step edge, over the radius (disc) and over σ (Gaussian).
DISC_EDGE = 1.3740
GAUSSIAN_EDGE = 2.5631
LAW_VIEWS = 1024
"""Where the law of the lens is measured: 256 views place a tenth of an edge only to 1.3 % of the radius."""


def point_size(bench: Bench, method: str, random: np.random.Generator) -> list[Measured]:
    """√(2⟨r²⟩) of a blurred point is the CoC radius, its centroid the pinhole's place."""
    coc = random.uniform(0.05, 0.1) * bench.size
    scene, lens, _ = one_pixel(bench, method, random, coc)
    picture = bench.picture(scene, bench.settings(method, lens)).sum(axis=2)
    sharp = bench.picture(scene, bench.settings("pinhole", lens)).sum(axis=2)
    center, spread = _moments(picture)
    place, own = _moments(sharp)
    return [
        Measured("radius over the lens's, less 1", abs(np.sqrt(2.0 * max(spread - own, 0.0)) / coc - 1.0)),
        Measured("shift of the centroid, px", float(np.hypot(*(center - place)))),
    ]


def _moments(picture: np.ndarray) -> tuple[np.ndarray, float]:
    """Centroid (x, y) in pixels and ⟨r²⟩ about it."""
    rows, columns = np.indices(picture.shape)
    total = max(picture.sum(), 1e-12)
    center = np.array([(columns * picture).sum(), (rows * picture).sum()]) / total
    return center, float((((columns - center[0]) ** 2 + (rows - center[1]) ** 2) * picture).sum() / total)


def closing(bench: Bench, method: str, random: np.random.Generator) -> list[Measured]:
    """An aperture of nothing, and of a millionth of the scene, is the pinhole."""
    scene = shapes.scene(shapes.scattered(random), [shapes.textured(random) for _ in range(4)])
    sharp = bench.picture(scene, bench.settings("pinhole", Lens()))
    worst, inside = np.inf, 1.0
    for radius in (0.0, 1e-5):
        lens = Lens(radius=radius, focus_distance=random.uniform(2.0, 10.0))
        picture = bench.picture(scene, bench.settings(method, lens, views=4))
        worst = min(worst, psnr(picture, sharp))
        inside = min(inside, float((np.abs(picture - sharp).max(axis=2) <= 1.0 / 255.0).mean()))
    return [Measured("PSNR, dB", worst, at_least=True), Measured("share of equal pixels", inside, at_least=True)]


def sharp_plane(bench: Bench, method: str, random: np.random.Generator) -> list[Measured]:
    """A textured wall in focus under the largest aperture."""
    depth = random.uniform(1.0, 20.0)
    half = depth * 0.6
    scene = shapes.scene([shapes.facing(0, 0, 5.0 - depth, half, half)], [shapes.textured(random)])
    lens = Lens(radius=0.3 * depth, focus_distance=depth)
    settings = bench.settings(method, lens)
    sharp = bench.picture(scene, settings.with_(method="pinhole"))
    return [Measured("PSNR, dB", psnr(bench.picture(scene, settings), sharp), at_least=True)]


def edge_widths(bench: Bench, method: str, random: np.random.Generator) -> list[Measured]:
    """The blurred edge between black and white halves of a wall, at 12 depths: never narrower farther from focus, and
    as wide as the lens says."""
    focus = random.uniform(4.0, 6.0)
    pixels = focal_px(bench.size, CAMERA.vfov_deg)
    widest = 0.06 * bench.size
    radius = widest / (pixels * abs(1.0 / focus - 1.0 / 2.0))
    lens = lens_for(method, radius, focus)
    backwards, error = 0.0, 0.0
    for depths in (np.geomspace(focus, 2.0, 7), np.geomspace(focus, 60.0, 7)):
        before = 0.0
        for depth in depths:
            half = depth
            wall = [
                shapes.facing(-half, 0, 5.0 - depth, half, half, 0),
                shapes.facing(half, 0, 5.0 - depth, half, half, 1),
            ]
            scene = shapes.scene(wall, [shapes.unlit((0, 0, 0)), shapes.unlit((1, 1, 1))])
            rise = bench.picture(scene, bench.settings(method, lens, views=LAW_VIEWS))[bench.size // 2, :, 0]
            width = _rise_10_90(rise)
            coc = pixels * radius * abs(1.0 / focus - 1.0 / depth)
            wanted = GAUSSIAN_EDGE * lens.sigma_fraction * coc if method in GAUSSIAN else DISC_EDGE * coc
            backwards = max(backwards, before - width)
            if wanted > 4.0:
                error = max(error, abs(width / wanted - 1.0))
            before = width
    return [
        Measured("edge narrower farther from focus, px", backwards),
        Measured("edge width over the law's, less 1", error),
    ]


def _rise_10_90(profile: np.ndarray) -> float:
    """Distance between the places where a rising profile crosses 0.1 and 0.9, pixels."""

    def crossing(level: float) -> float:
        above = int(np.argmax(profile >= level))
        if above == 0:
            return 0.0
        low, high = profile[above - 1], profile[above]
        return above - 1 + float((level - low) / max(high - low, 1e-9))

    return crossing(0.9) - crossing(0.1)


def occlusion(bench: Bench, method: str, random: np.random.Generator) -> list[Measured]:
    """A blurred bar before a sharp texture: beside the analytic mix, and no light of the background on the sharp card
    that stands before it."""
    texture = shapes.textured(random)
    pixels = focal_px(bench.size, CAMERA.vfov_deg)
    coc = 0.05 * bench.size
    near, focus = 2.5, 5.0
    radius = coc / (pixels * (1.0 / near - 1.0 / focus))
    half_px = random.uniform(0.04, 0.1) * bench.size
    bar = shapes.facing(0.0, 0.0, 5.0 - near, half_px * near / pixels, 4.0, 1)
    wall = shapes.facing(0.0, 0.0, 5.0 - focus, 4.0, 4.0, 0)
    lens = lens_for(method, radius, focus)
    behind = shapes.scene([wall], [texture])
    sharp = bench.picture(behind, bench.settings("pinhole", lens))
    covered = _bar_coverage(bench, half_px, coc, lens)
    truth = sharp * (1.0 - covered)[None, :, None] + covered[None, :, None] * 0.9
    picture = bench.picture(
        shapes.scene([wall, bar], [texture, shapes.unlit((0.9, 0.9, 0.9))]), bench.settings(method, lens)
    )
    middle = slice(bench.size // 4, -(bench.size // 4))
    rmse = float(np.sqrt(((picture - truth)[middle, middle] ** 2).mean()))
    return [
        Measured("RMSE against the analytic mix", rmse),
        Measured("leak onto the sharp card, 1/255", _leak(bench, method, texture)),
    ]


def _bar_coverage(bench: Bench, half_px: float, coc: float, lens: Lens) -> np.ndarray:
    """The share of the lens that a bar of half-width `half_px` at the middle hides from each column."""
    offset = np.arange(bench.size) + 0.5 - bench.size / 2
    steps = np.linspace(-4.0, 4.0, 4001) if lens.distribution is Distribution.GAUSSIAN else np.linspace(-1.0, 1.0, 4001)
    if lens.distribution is Distribution.GAUSSIAN:
        weight = np.exp(-0.5 * (steps / lens.sigma_fraction) ** 2)
    else:
        weight = np.sqrt(np.maximum(1.0 - steps**2, 0.0))
    weight /= weight.sum()
    hidden = np.abs(offset[:, None] + coc * steps[None, :]) <= half_px
    return hidden @ weight


def _leak(bench: Bench, method: str, texture) -> float:
    """How much a bright, blurred background shines onto a sharp dark card more than 2 px inside its edge."""
    scene = shapes.scene(
        [shapes.facing(0, 0, -10.0, 20, 20, 0), shapes.facing(0, 0, 0.0, 0.8, 0.8, 1)],
        [shapes.unlit((1.0, 1.0, 1.0)), shapes.unlit((0.1, 0.1, 0.1))],
    )  # fmt: skip
    picture = bench.picture(scene, bench.settings(method, lens_for(method, 0.15, 5.0)))
    half = int(0.8 / 5.0 * focal_px(bench.size, CAMERA.vfov_deg)) - 3
    middle = slice(bench.size // 2 - half, bench.size // 2 + half)
    return 255.0 * float(np.abs(picture[middle, middle] - 0.1).max())


ROWS = (
    Row(3, "size and place of a disc",
        bounds((0.02, 0.25), (0.04, 0.25), (0.04, 0.5), (0.10, 0.5), (0.15, 0.5), (0.15, 0.5)), point_size),
    Row(4, "aperture to 0 is the pinhole",
        bounds((60, 0.999), (55, 0.999), (45, 0.999), (50, 0.999), (50, 0.999), (50, 0.999)), closing),
    Row(5, "the focus plane is sharp", bounds(45.0, 45.0, 40.0, 40.0, 40.0, 40.0), sharp_plane),
    Row(6, "width of edges",
        bounds((0.25, 0.03), (0.25, 0.05), (0.25, 0.05), (0.25, 0.10), (0.25, 0.15), (0.25, 0.15)), edge_widths),
    Row(16, "partial occlusion",
        bounds((0.02, 1), (0.05, 3), (0.05, 3), (0.08, 3), (0.15, 8), (0.15, 8)), occlusion),
)  # fmt: skip
