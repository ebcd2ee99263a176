"""Splatting: two ways to one picture, sprites that are the aperture, what may be skipped, what it owes the reference.

Bounds are the method's own promises; where one was measured, it says so.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from scenes import quad, scene_of, three_planes, unlit

from dofview.bokeh import of_lens
from dofview.gl.context import Gpu
from dofview.lens import Lens, focal_px
from dofview.methods.splatting import Computation, Params, _gather, _scatter
from dofview.methods.splatting_choice import faster
from dofview.methods.splatting_points import Reduction
from dofview.metrics import psnr, ssim
from dofview.pipeline import Pipeline
from dofview.scene.camera import Camera
from dofview.scene.demo import build, view
from dofview.scene.model import Scene
from dofview.settings import ImageSettings, Settings

WAYS = (Computation.GATHER, Computation.SCATTER)
PAPER = {
    "delta": 0.4, "hidden_test": "depth", "epsilon": 0.05, "edge_depth": 0.01, "fill": False, "reduction": "none",
}  # fmt: skip
CAMERA = Camera(position=(0.3, 0.2, 5.0), target=(0.0, 0.0, 0.0))
MIDDLE = Lens(radius=1.6, focus_distance=5.0)
"""CoC radii from −23 to 17 px over `three_planes` at 120×90: blur before, at and behind the focus, and every level."""


def settings_for(lens: Lens = MIDDLE, size: tuple[int, int] = (120, 90), camera: Camera = CAMERA, **image: object):
    return Settings(camera=camera, lens=lens, method="splatting", image=ImageSettings(size=size, **image))


def images(gpu: Gpu) -> dict[str, np.ndarray]:
    return {image.name.removeprefix("splatting/"): image.pixels() for image in gpu.targets.named("splatting/")}


@pytest.fixture
def planes(gpu: Gpu) -> Iterator[Pipeline]:
    pipeline = Pipeline(gpu, three_planes())
    yield pipeline
    pipeline.release()


LENSES = {
    "disc": MIDDLE,
    "triangle": MIDDLE.model_copy(update={"distribution": "polygon", "blades": 3, "rotation_deg": 20.0}),
    "gaussian": MIDDLE.model_copy(update={"distribution": "gaussian", "radius": 0.8}),
    "heart": Lens(radius=0.9, focus_distance=3.5, distribution="image", image=Path("heart")),
    "far": Lens(radius=0.4, focus_distance=12.0),
}


@pytest.mark.parametrize("lens", LENSES)
@pytest.mark.parametrize("reduction", Reduction)
def test_gather_equals_scatter(planes: Pipeline, lens: str, reduction: Reduction):
    settings = settings_for(Lens(**LENSES[lens].model_dump(warnings=False))).with_params(reduction=reduction)
    gathered = planes.render(settings.with_params(computation=Computation.GATHER)).pixels()
    scattered = planes.render(settings.with_params(computation=Computation.SCATTER)).pixels()
    assert np.abs(gathered - scattered).max() <= 1e-5


def test_gather_equals_scatter_without_the_hidden_image_and_with_the_papers_constants(planes: Pipeline):
    for params in ({"hidden": False}, PAPER, {**PAPER, "reduction": "paper", "reduced_from": 4.0}):
        settings = settings_for().with_params(**params)
        gathered = planes.render(settings).pixels()
        scattered = planes.render(settings.with_params(computation=Computation.SCATTER)).pixels()
        assert np.abs(gathered - scattered).max() <= 1e-5, params


@pytest.mark.parametrize("slow", [Computation.GATHER, Computation.SCATTER])
def test_the_faster_computation_is_taken(planes: Pipeline, monkeypatch: pytest.MonkeyPatch, slow: Computation):
    """On a GPU both are tried, once; the frame's own counts stay."""
    gpu, tried = planes.gpu, []
    frame = planes.render(settings_for()).frame
    monkeypatch.setattr(gpu, "facts", {})
    assert faster(frame, {}, Params()) is Computation.GATHER and not gpu.facts  # software: known
    monkeypatch.setattr(gpu, "software", False)

    def way(name: Computation, sum_up, *given: object) -> None:
        tried.append(name)
        if tried.count(name) == 1:
            sum_up(*given)
        elif name is slow:
            time.sleep(0.02)

    ways = {Computation.GATHER: _gather, Computation.SCATTER: _scatter}
    timed = {name: partial(way, name, sum_up) for name, sum_up in ways.items()}
    counts = dict(gpu.profile.counts)
    fast = ({*timed} - {slow}).pop()
    assert faster(frame, timed, Params()) is fast
    assert {*tried} == {*timed} and dict(gpu.profile.counts) == counts
    tried.clear()
    assert faster(frame, timed, Params()) is fast and not tried


@pytest.mark.parametrize("lens", [MIDDLE, Lens(radius=0.2, focus_distance=2.8), Lens(radius=0.05, focus_distance=5.0)])
@pytest.mark.parametrize("reduction", Reduction)
def test_skipping_changes_nothing(planes: Pipeline, lens: Lens, reduction: Reduction):
    settings = settings_for(lens).with_params(reduction=reduction, inspect=True)
    skipped = planes.render(settings).pixels()
    assert np.abs(planes.render(settings.with_params(skip=False)).pixels() - skipped).max() <= 1e-5


def test_skipped_work_is_counted(planes: Pipeline):
    """Nothing in front of focus: no second geometry pass. Hardly open: the focused panel's tiles are copied. One blur
    everywhere: no layer in front."""
    near = planes.render(settings_for(Lens(radius=0.2, focus_distance=2.75)).with_params(inspect=True)).counts
    assert near["splatting hidden passes skipped"] == 1
    sharp = settings_for(Lens(radius=0.05, focus_distance=5.0)).with_params(inspect=True)
    counts = planes.render(sharp).counts
    assert 0 < counts["splatting tiles copied"] < counts["splatting tiles"]
    assert "splatting hidden passes skipped" not in counts and "splatting front layers skipped" not in counts
    assert planes.render(sharp.with_params(skip=False)).counts.get("splatting tiles copied", 0) == 0
    flat = planes.render(settings_for(Lens(radius=0.01, focus_distance=50.0)).with_params(inspect=True)).counts
    assert flat["splatting front layers skipped"] == 1


SHAPES = {
    "disc": {}, "gaussian": {"distribution": "gaussian"},
    "triangle": {"distribution": "polygon", "blades": 3, "rotation_deg": 20.0},
    "hexagon": {"distribution": "polygon", "blades": 6, "rotation_deg": 10.0},
    "heart": {"distribution": "image", "image": "heart"},
    "ring": {"distribution": "image", "image": "ring", "rotation_deg": 45.0},
}  # fmt: skip


def point_light(size: int, value: float) -> Scene:
    """One pixel of light 5 units away in the middle of a picture of odd `size`, with nothing behind it."""
    half = 0.4995 * 5.0 / focal_px(size, 45.0)
    return scene_of([quad((0, 0, 0), (half, half))], [unlit(value, value, value)])


def lens_of(coc: float, size: int, shape: dict[str, object]) -> Lens:
    """A lens of this shape under which the light has the CoC radius `coc`, px."""
    focus = 1.0 / (0.2 + 0.1 * np.sign(coc))
    return Lens(radius=abs(coc) / (0.1 * focal_px(size, 45.0)), focus_distance=focus, **shape)


def scaled_aperture(lens: Lens, coc: float, size: int) -> np.ndarray:
    """What each pixel gets of the light: the aperture picture scaled to `coc` (negative: turned), by exact areas."""
    aperture = of_lens(lens)
    count = len(aperture.weights)
    sums = np.zeros((count + 1, count + 1))
    sums[1:, 1:] = aperture.weights[::-1].cumsum(axis=0).cumsum(axis=1)
    edges = (np.arange(size + 1) - 0.5 * size) / coc
    place = np.clip((edges / (2.0 * aperture.extent) + 0.5) * count, 0.0, count)
    low = np.minimum(place.astype(int), count - 1)
    part = place - low
    across = sums[:, low] * (1.0 - part) + sums[:, low + 1] * part
    both = across[low] * (1.0 - part)[:, None] + across[low + 1] * part[:, None]
    return np.diff(np.diff(both, axis=0), axis=1)[::-1]


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("coc", [1.5, 2.3, -5.2, 16.6, -60.0])
def test_a_point_is_the_aperture_and_keeps_its_energy(gpu: Gpu, shape: str, coc: float):
    """To 2 % RMS and 1e-3, for diameters from 3 to 120 px, by either computation."""
    size = 2 * int(abs(coc) * (2.2 if shape == "gaussian" else 1.2)) + 9
    lens = lens_of(coc, size, SHAPES[shape])
    pipeline = Pipeline(gpu, point_light(size, 1000.0))
    settings = settings_for(lens, (size, size), Camera()).with_(background_linear=(0, 0, 0))
    expected = scaled_aperture(lens, coc, size)
    for computation in WAYS if abs(coc) < 20.0 else ("gather",):
        found = pipeline.render(settings.with_params(computation=computation)).pixels()[..., 1] / 1000.0
        assert abs(found.sum() / expected.sum() - 1.0) <= 1e-3
        assert np.sqrt(((found - expected) ** 2).sum() / (expected**2).sum()) <= 0.02
    pipeline.release()


@pytest.mark.parametrize("value", [1.0, 30.0, 1e4])
def test_a_point_keeps_its_shape_at_any_brightness_when_others_are_merged(gpu: Gpu, value: float):
    pipeline = Pipeline(gpu, point_light(81, value))
    settings = settings_for(lens_of(30.0, 81, SHAPES["hexagon"]), (81, 81), Camera())
    settings = settings.with_(background_linear=(0, 0, 0))
    plain = pipeline.render(settings.with_params(reduction="none")).pixels()
    merged = pipeline.render(settings).pixels()
    pipeline.release()
    assert np.abs(merged - plain).max() <= 1e-4 * plain.max()


@pytest.mark.parametrize("coc", [14.0, -14.0])
def test_a_polygon_stands_as_the_reference_has_it(gpu: Gpu, coc: float):
    """A triangle turned by 20° is not its mirror image; measured correlation 0.99 upright, at most 0.80 mirrored."""
    size = 49
    pipeline = Pipeline(gpu, point_light(size, 1000.0))
    settings = settings_for(lens_of(coc, size, SHAPES["triangle"]), (size, size), Camera()).with_(
        background_linear=(0, 0, 0)
    )
    found = pipeline.render(settings).pixels()[..., 0].ravel()
    truth = pipeline.render(settings.with_(method="accumulation").with_params(views=2048)).pixels()[..., 0]
    pipeline.release()
    upright, *others = (np.corrcoef(found, t.ravel())[0, 1] for t in (truth, truth[::-1], truth[:, ::-1]))
    assert upright >= 0.97 and max(others) <= 0.9


def test_k_n_is_that_of_the_disc_for_large_circles_and_counts_pixels_for_small_ones(gpu: Gpu, planes: Pipeline):
    planes.render(settings_for())
    table = images(gpu)["k_n"][0, :, 0]
    assert abs(table[128:] / (4.0 / np.pi) - 1.0).max() < 0.01
    # At C = 0 a sprite of diameter 1 covers one pixel, by the rim's formula as far as sprite() says.
    assert np.isfinite(table).all() and table.min() >= 1.0 and table.max() <= 1.5


@pytest.fixture(scope="module")
def foreground(session_gpu: Gpu) -> Iterator[tuple[Pipeline, Settings, np.ndarray]]:
    """The foreground-blur demo at 256×192, and the reference's picture of it from 96 views."""
    pipeline = Pipeline(session_gpu, build("foreground"))
    shown = view("foreground")
    settings = settings_for(Lens(**shown["lens"]), (256, 192), Camera(**shown["camera"]))
    settings = settings.with_(background_linear=tuple(shown["background_linear"]))
    truth = pipeline.render(settings.with_(method="accumulation").with_params(views=96)).pixels()
    yield pipeline, settings, truth
    pipeline.release()


def test_the_foreground_demo_against_the_reference(foreground: tuple[Pipeline, Settings, np.ndarray]):
    """Measured here 37.2 dB and 0.993, without the hidden image 25.3 dB; at the demo's own size, where thin strings are
    more than a pixel or two wide, 41.9 dB (docs/methods/splatting.md)."""
    pipeline, settings, truth = foreground
    picture = pipeline.render(settings).pixels()
    assert psnr(picture, truth) >= 36.0 and ssim(picture, truth) >= 0.99
    without = pipeline.render(settings.with_params(hidden=False)).pixels()
    assert psnr(without, truth) <= psnr(picture, truth) - 6.0


def test_merging_costs_little_and_the_papers_constants_are_there(foreground: tuple[Pipeline, Settings, np.ndarray]):
    """The paper reports 36.33 dB with the hidden image and 32.84 without."""
    pipeline, settings, truth = foreground
    plain = psnr(pipeline.render(settings.with_params(reduction="none")).pixels(), truth)
    for reduction, lost in (("levels", 0.6), ("paper", 0.3)):
        assert psnr(pipeline.render(settings.with_params(reduction=reduction)).pixels(), truth) >= plain - lost
    assert psnr(pipeline.render(settings.with_params(**PAPER)).pixels(), truth) >= 36.33


@pytest.mark.parametrize("lens", ["triangle", "heart", "gaussian"])
def test_other_apertures_match_their_references(planes: Pipeline, lens: str):
    """Measured 38.0, 42.5 and 40.9 dB; turned upside down the triangle has 32.5 and the heart 39.6."""
    chosen = LENSES[lens].model_dump(warnings=False) | {"radius": 0.5}
    settings = settings_for(Lens(**chosen))
    truth = planes.render(settings.with_(method="accumulation").with_params(views=256)).pixels()
    assert psnr(planes.render(settings).pixels(), truth) >= {"triangle": 36.0, "heart": 41.0, "gaussian": 39.0}[lens]


def test_no_light_is_lost_by_merging(planes: Pipeline):
    """The shares of all points over all levels are the pixels they stand for."""
    planes.render(settings_for().with_params(hidden=False))
    found = images(planes.gpu)
    level_0 = found["points"][..., 3]
    radius = np.abs(np.floor(level_0)) / 64.0
    highlights = (found["other points"][..., 3] % 1.0 > 0.0).sum()
    stays = np.where(level_0 % 1.0 > 0.0, np.clip(17.0 - 16.0 * radius / 3.0, 0.0, 1.0), 0.0).sum()
    merged, limit = 0.0, 6.0
    for level in (1, 2, 3):
        for name in (f"points {level}", f"far points {level}"):
            packed = found[name][..., 3]
            kept = np.clip(17.0 - 16.0 * np.abs(np.floor(packed)) / 64.0 / limit, 0.0, 1.0) if level < 3 else 1.0
            merged += (1.5 * (packed % 1.0) * kept).sum() * 4.0**level
        limit *= 2.0
    assert abs((stays + highlights + merged) / level_0.size - 1.0) <= 0.02  # k_n is up to 2 % off the disc's


def test_a_gpu_draws_the_same_highlights(gpu: Gpu, monkeypatch: pytest.MonkeyPatch):
    """Where software looks which rows have any, a GPU draws them all under a condition."""
    spots = [quad((x, y, 1.0), (0.02, 0.02), 1) for x, y in ((0.1, 0.2), (-0.7, 0.6), (0.9, -0.8))]
    scene = scene_of([quad((0, 0, -5), (12, 9), 0), *spots], [unlit(0.2, 0.3, 0.1), unlit(80.0, 60.0, 40.0)])
    pipeline = Pipeline(gpu, scene)
    rows = pipeline.render(settings_for()).pixels()
    monkeypatch.setattr(gpu, "software", False)
    every = pipeline.render(settings_for()).pixels()
    pipeline.release()
    assert rows.max() > 0.5 and np.abs(rows - every).max() <= 1e-6


def test_cut_off_highlights_are_extended_by_equation_8(gpu: Gpu):
    """λ0 = 0.8, β = 3, γ = 2: a grey of 0.9 is half way, which gives 1 − 1/8 + 1/8 · 2 times itself."""
    for value, factor in ((0.7, 1.0), (0.9, 1.125), (1.0, 2.0)):
        pipeline = Pipeline(gpu, scene_of([quad((0, 0, 0), (20, 20))], [unlit(value, value, value)]))
        settings = settings_for(Lens(radius=0.3, focus_distance=3.0), (32, 24)).with_params(extrapolate=True)
        assert np.abs(pipeline.render(settings).pixels() / value - factor).max() <= 2e-3
        pipeline.release()


def test_what_is_just_outside_blurs_in_with_a_guard_band_only(gpu: Gpu):
    """A bright bar two pixels beyond the left border, blurred by 8 px."""
    unit = 5.0 / focal_px(64, 45.0)
    bar = quad((-37 * unit, 0, 0), (3 * unit, 40 * unit))
    pipeline = Pipeline(gpu, scene_of([bar], [unlit(1.0, 1.0, 1.0)]))
    settings = settings_for(lens_of(8.0, 64, {}), (64, 64), Camera()).with_(background_linear=(0, 0, 0))
    assert pipeline.render(settings).pixels()[:, 0].min() > 0.1
    without = settings.with_(image=settings.image.model_copy(update={"guard_px": 0}))
    assert pipeline.render(without).pixels().max() == 0.0
    pipeline.release()


@pytest.mark.parametrize("computation", WAYS)
def test_a_circle_larger_than_any_sprite_is_cut_but_finite(planes: Pipeline, computation: Computation):
    huge = settings_for(Lens(radius=60.0, focus_distance=5.0), (40, 30)).with_params(computation=computation)
    picture = planes.render(huge).pixels()
    assert np.isfinite(picture).all() and picture.min() >= 0.0 and picture.max() <= 1.0


def test_steps_are_kept_by_name(planes: Pipeline):
    planes.render(settings_for().with_params(inspect=True))
    names = {image.name for image in planes.gpu.targets.named("splatting/")} | {"frame/pinhole"}
    wanted = {
        "frame/pinhole",
        *(f"splatting/{n}" for n in ("hidden", "L0", "L1", "L2", "fetches", "k_n", "reach", "largest")),
    }
    assert wanted <= names


@pytest.mark.parametrize(("reduction", "size", "way"), [
    (Reduction.NONE, (300, 300), "scatter"), (Reduction.NONE, (40, 30), "gather"),
    (Reduction.LEVELS, (300, 300), "gather"),
])  # fmt: skip
def test_software_gathers_only_as_many_points_as_its_loops_may_turn(
    gpu: Gpu, planes: Pipeline, monkeypatch: pytest.MonkeyPatch, reduction: Reduction, size: tuple[int, int], way: str
):
    """Beyond, llvmpipe ends the shader: a room of 294 px blur came out black (7 dB)."""
    if not gpu.software:
        pytest.skip("a GPU has no such limit")
    taken: list[str] = []
    for name in ("gather", "scatter"):
        monkeypatch.setattr(f"dofview.methods.splatting._{name}", lambda *_, name=name: taken.append(name))
    lens = MIDDLE.model_copy(update={"radius": 16.0})
    settings = settings_for(lens, size, guard_px=0).with_params(reduction=reduction, computation="gather")
    planes.render(settings)
    assert taken == [way]
