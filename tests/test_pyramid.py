"""Pyramidal image processing: its plan of sub-images, its blur, its silhouettes, what it leaves out, its quality."""

from __future__ import annotations

import math

import numpy as np
import pytest
from image_frame import ImageFrame, moments, point
from scenes import demo_through_gaussian, quad, scene_of, unlit

from dofview.gl.context import Gpu
from dofview.gl.pyramids import Analysis
from dofview.lens import Distribution, Lens
from dofview.methods import pyramid
from dofview.methods.pyramid import Blur, Params
from dofview.methods.pyramid_plan import FAR, Matting, plan
from dofview.metrics import psnr
from dofview.pipeline import Pipeline
from dofview.render.occupancy import occupancy
from dofview.scene.camera import Camera
from dofview.settings import ImageSettings, Settings

PAPER = Params(analysis=Analysis.BOX4, blur=Blur.PAPER, matting=Matting.PAPER)


def picture(gpu: Gpu, color: np.ndarray, coc: np.ndarray | float, params: Params | None = None) -> np.ndarray:
    frame = ImageFrame(gpu, color, np.asarray(coc))
    return pyramid.render(frame, params or Params()).pixels()[..., :3].astype(np.float64)


def octaves(levels: int) -> float:
    """A blur that doubles, for plans."""
    return 2.0 ** (levels - 1) if levels else 0.0


@pytest.mark.parametrize("front, back", [(-7.0, 0.0), (0.0, 5.0), (-3.3, 12.0), (0.0, 0.0), (-2.0, 4.0)])
def test_the_weights_of_a_pixel_are_a_partition_or_the_papers(front: float, back: float):
    """Each blur of the scene has weight 1 in all (or 2, in three neighbours), in sub-images that do not cull it."""

    def weight(sub, sigma: float) -> float:
        def ramp(low: float, high: float) -> float:
            return min(max((sigma - low) / (high - low), 0.0), 1.0) if high > low else float(sigma >= high)

        return 0.0 if sigma < sub.cull else ramp(*sub.ramps[:2]) * (1.0 - ramp(*sub.ramps[2:]))

    for matting, total in ((Matting.PARTITION, 1.0), (Matting.PAPER, 2.0)):
        subs = plan(front, back, math.inf, octaves, 12, matting)
        assert [sub.index for sub in subs] == list(range(subs[0].index, subs[-1].index + 1))
        for sigma in np.linspace(front, back, 40):
            weights = [weight(sub, sigma) for sub in subs]
            # At the last the paper's front ramp is a step, so there is more than 2 there, never less than 1.
            assert sum(weights) == pytest.approx(total, abs=1e-9) or (matting is Matting.PAPER and sum(weights) >= 1.0)
            assert sum(w > 0.0 for w in weights) <= (2 if matting is Matting.PARTITION else 4)


def test_the_plan_covers_the_scene_and_no_more():
    subs = plan(-7.0, 3.0, math.inf, octaves, 12, Matting.PARTITION)
    assert [sub.index for sub in subs] == [-4, -3, -2, -1, 0, 1, 2, 3]
    assert [sub.fills for sub in subs] == [False] + [True] * 7
    assert [sub.fills for sub in plan(0.0, 3.0, math.inf, octaves, 12, Matting.PARTITION)] == [False, True, True, True]
    assert subs[0].cull == -FAR and subs[-1].ramps[2:] == (FAR, FAR)
    assert [sub.index for sub in plan(-100.0, 100.0, math.inf, octaves, 2, Matting.PARTITION)] == [-2, -1, 0, 1, 2]
    # The paper: r^(i_max−2) < r(∞) < r^(i_max−1), no ramp towards a blur that no depth has, a step at the last.
    subs = plan(-1.5, 3.0, 3.0, octaves, 12, Matting.PAPER)
    assert [sub.index for sub in subs] == [-2, -1, 0, 1, 2, 3, 4]
    assert subs[-1].ramps == (2.0, 2.0, FAR, FAR) and subs[-3].ramps == (0.0, 1.0, FAR, FAR)


@pytest.mark.parametrize("sigma", [1.2247, 2.0, 2.7386, 4.0, 5.6125, 8.0, 11.292])
@pytest.mark.parametrize("sign", [1, -1])
def test_the_measured_blur_is_the_one_asked_for(gpu: Gpu, sigma: float, sign: int):
    """Exact where a sub-image has that blur, up to 8 % more between two, which are mixed; nothing lost or moved."""
    size = int(14 * sigma) | 33
    variances = []
    for step in range(4):
        at = (size // 2 + step, size // 2 - 3 * step)
        total, center, variance = moments(picture(gpu, point((size, size), at), sign * 2.0 * sigma)[..., 0])
        assert total == pytest.approx(1.0, abs=1e-3)
        assert np.abs(center - at).max() < 0.05
        variances.append(variance)
    assert 0.98 < math.sqrt(np.mean(variances)) / sigma < 1.08


@pytest.mark.parametrize("largest", [0.0, 1e-6, 1.0, 300.0])
def test_the_papers_settings_work_at_every_aperture(gpu: Gpu, largest: float):
    color = np.random.default_rng(3).random((33, 47, 3))
    coc = np.linspace(-largest, 0.9 * largest, 47)[None, :].repeat(33, axis=0)
    after = picture(gpu, color, coc, PAPER)
    assert np.isfinite(after).all() and after.min() >= 0.0 and after.max() <= 1.0 + 1e-5
    if largest < 1e-3:
        assert np.abs(after - color).max() <= 1e-4


@pytest.mark.parametrize("size", [(97, 61), (101, 3), (1, 90)])
def test_a_ramp_stays_where_it_is_at_odd_sizes(gpu: Gpu, size: tuple[int, int]):
    width, height = size
    axis = int(height > width)
    ramp = np.broadcast_to(np.indices((height, width))[1 - axis] / 100.0, (height, width))
    after = picture(gpu, np.repeat(ramp[..., None], 3, axis=2), 8.0)[..., 0]
    inner = np.s_[28:-28, :] if axis else np.s_[:, 28:-28]
    assert np.abs(after - ramp)[inner].max() * 100.0 < 0.05


@pytest.mark.parametrize("params", [Params(), Params(matting=Matting.PAPER)], ids=["partition", "paper"])
def test_a_part_covered_pixel_is_covered_by_that_part(gpu: Gpu, params: Params):
    """A thin white bar in front of a black wall in focus: the light that is left is the bar's, but the paper's three
    sub-images cover more than a surface of that width can."""
    bar = np.zeros((96, 96, 3))
    bar[:, 46:50] = 1.0
    after = picture(gpu, bar, np.where(bar[..., 0] > 0.0, -8.0, 0.0), params)[48, :, 0]
    expected = 4.0
    if params.matting is Matting.PARTITION:
        assert after.sum() == pytest.approx(expected, rel=0.05)
    else:
        assert after.sum() > 1.3 * expected


@pytest.mark.parametrize("radius, focus", [(0.25, 5.0), (0.5, 3.5), (0.3, 12.0)])
def test_silhouettes_are_not_dark(gpu: Gpu, radius: float, focus: float):
    """Bright things before bright things: where culled pixels leaked in as black it would show. The picture may not be
    darker than the reference by more than 0.06, nor than the darkest surface by more than 0.01."""
    shapes = [
        quad((0, 0, -5), (12, 9), 0), quad((0.4, 0.2, 0), (0.9, 0.7), 1), quad((-0.6, 0, 2), (0.12, 1.6), 2),
        quad((0, -0.75, 2.2), (1.8, 0.1), 3),
    ]  # fmt: skip
    pipeline = Pipeline(gpu, scene_of(shapes, [unlit(0.6, 0.8, 0.7), unlit(0.8, 0.6, 0.7), unlit(0.7, 0.7, 0.9),
                                               unlit(0.9, 0.7, 0.6)]))  # fmt: skip
    settings = Settings(
        camera=Camera(position=(0.3, 0.2, 5.0), target=(0.0, 0.0, 0.0)), image=ImageSettings(size=(96, 72)),
        lens=Lens(radius=radius, focus_distance=focus, distribution=Distribution.GAUSSIAN),
    )  # fmt: skip
    truth = pipeline.render(settings.with_(method="accumulation").with_params(views=128)).pixels()
    after = pipeline.render(settings.with_(method="pyramid")).pixels()
    pipeline.release()
    assert (after - truth).min() > -0.06
    assert after.min() > 0.6 - 0.01


def steps(width: int, height: int, values: list[float]) -> np.ndarray:
    """CoC radii in vertical bands, each with one of `values`."""
    return np.repeat(np.array(values)[np.arange(width) * len(values) // width][None, :], height, axis=0)


@pytest.mark.parametrize("values", [[0.0], [0.0, 20.0], [-20.0, 0.0], [-30.0, -1.0, 0.5, 25.0], [3.0, 5.0]])
def test_skipping_changes_nothing(gpu: Gpu, values: list[float]):
    color = np.random.default_rng(5).random((45, 70, 3))
    coc = steps(70, 45, values)
    gpu.profile.begin()
    quick = picture(gpu, color, coc)
    counts = dict(gpu.profile.counts)
    gpu.profile.begin()
    slow = picture(gpu, color, coc, Params(skip=False))
    assert np.abs(quick - slow).max() <= 1e-5
    assert counts.get("passes", 0) <= gpu.profile.counts["passes"]
    if values == [0.0]:
        # Nothing is blurred: the pinhole picture itself.
        assert "pyramid sub-images" not in counts
        return
    assert counts["pyramid fills skipped"] > 0
    assert counts["pyramid sub-images skipped"] > 0


def test_occupied_depths_are_found(gpu: Gpu):
    frame = ImageFrame(gpu, np.zeros((33, 47, 3)), steps(47, 33, [-10.0, -9.0, 4.0, 20.0]))
    found, depth = occupancy(frame), frame.coc.inverse_depth

    def between(low: float, high: float) -> bool:
        return found.between(depth(low), depth(high))

    assert all(between(c - 0.01, c + 0.01) for c in (-10.0, -9.0, 4.0, 20.0))
    assert between(-100.0, -9.5) and between(19.0, 1e30) and between(-1e30, 1e30)
    assert not between(-8.0, 3.0) and not between(5.0, 19.0)
    assert not between(21.0, 1e30) and not between(-1e30, -11.0)


def test_cost_is_linear_in_the_sub_images(gpu: Gpu):
    """Each costs between 2 and 3⅓ pictures: weights and blending, 2/3 for its blur and 2/3 for its filling."""
    color = np.zeros((256, 256, 3))
    rows = []
    for largest in (2.0, 4.0, 9.0, 20.0, 40.0):
        gpu.profile.begin()
        picture(gpu, color, np.broadcast_to(np.linspace(-largest, largest, 256), (256, 256)), Params(skip=False))
        rows.append((gpu.profile.counts["pyramid sub-images"], gpu.profile.counts["fragments"] / color[..., 0].size))
    assert [count for count, _ in rows] == [3, 5, 7, 9, 11]
    growth = np.diff([pictures for _, pictures in rows]) / 2.0
    assert (growth > 2.0).all() and (growth < 10.0 / 3.0 + 0.05).all()
    assert np.ptp(growth[1:]) < 0.2


def test_every_step_can_be_looked_at(gpu: Gpu):
    color = np.random.default_rng(2).random((40, 60, 3))
    coc = steps(60, 40, [-6.0, 0.0, 8.0])
    plain = picture(gpu, color, coc)
    inspected = picture(gpu, color, coc, Params(inspect=True))
    assert np.array_equal(plain, inspected)
    images = {
        image.name.removeprefix("pyramid/sub-image "): image.pixels() for image in gpu.targets.named("pyramid/sub")
    }
    front = coc == -6.0
    assert {f"{i:+d} {step}" for i in (-2, 0, 2) for step in ("culled", "filled", "matte", "blurred")} <= images.keys()
    assert not images["+2 culled"][front].any() and images["+2 culled"][coc == 8.0][:, 3].all()
    assert images["+2 filled"][..., 3].min() == pytest.approx(1.0, abs=1e-5)
    # σ = 4 lies 44 % of the way from sub-image 2 to 3; nothing behind the focus is in sub-image -2.
    assert np.allclose(images["+2 matte"][coc == 8.0][:, 3], 0.561, atol=0.002)
    assert not images["-2 matte"][coc >= 0.0].any()
    assert 0.0 < images["-2 blurred"][20, 22, 3] < 1.0


@pytest.mark.parametrize("name, floor", [("foreground", 30.0), ("background", 37.0), ("rail", 37.0)])
def test_quality_is_above_its_floor(demos: dict[str, Pipeline], name: str, floor: float):
    """Asked are 30, 37 and 37 dB."""
    settings = demo_through_gaussian(name, "pyramid")
    truth = demos[name].render(settings.with_(method="accumulation").with_params(views=48)).pixels()
    reached = psnr(demos[name].render(settings).pixels(), truth)
    paper = psnr(demos[name].render(settings.with_params(**PAPER.model_dump())).pixels(), truth)
    assert reached >= floor
    assert reached > paper + 2.0


@pytest.mark.parametrize("slider", ["focus", "aperture"])
def test_sliders_move_the_picture_smoothly(demos: dict[str, Pipeline], slider: str):
    """No popping where a sub-image comes or goes or begins to cull: no step is more than 3 times the median one."""
    settings = demo_through_gaussian("foreground", "pyramid", (96, 72))
    lens, changes, before = settings.lens, [], None
    for t in np.linspace(0.05, 1.0, 100):
        if slider == "focus":
            change = {"focus_distance": lens.focus_distance / (0.6 + t), "radius": lens.radius * 4.0}
        else:
            change = {"radius": lens.radius * 5.0 * t}
        after = demos["foreground"].render(settings.with_(lens=lens.model_copy(update=change))).pixels()
        if before is not None:
            changes.append(np.abs(after - before).mean() * 255.0)
        before = after
    assert max(changes) <= 3.0 * np.median(changes)
    assert max(changes) <= 1.5
