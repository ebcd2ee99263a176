"""Multiview synthesis: what its layers hold, where its rays end, and that what it leaves out changes nothing."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest
from scenes import noise_material, quad, scene_of, three_planes, unlit

from dofview import metrics
from dofview.gl.context import Gpu
from dofview.gl.layered import DepthArray, NoLayersError
from dofview.lens import Distribution, Lens
from dofview.methods import multiview
from dofview.methods.method import Recipe
from dofview.methods.multiview_cones import average, squares
from dofview.methods.multiview_layers import Kind, Layering, Layers, build, fit
from dofview.pipeline import Pipeline
from dofview.render.frame import Frame
from dofview.render.raster import depth_range
from dofview.sampling import halton, lens_samples, on_lens
from dofview.scene.camera import Camera
from dofview.scene.demo import build as demo
from dofview.scene.demo import view
from dofview.settings import ImageSettings, Settings, apply_view

CAMERA = Camera(position=(0.3, 0.2, 5.0), target=(0.0, 0.0, 0.0))
SETTINGS = Settings(
    camera=CAMERA, lens=Lens(radius=0.25, focus_distance=5.0), method="multiview", image=ImageSettings(size=(128, 96))
)


@pytest.fixture
def planes(gpu: Gpu) -> Iterator[Pipeline]:
    pipeline = Pipeline(gpu, three_planes())
    yield pipeline
    pipeline.release()


def layers_of(pipeline: Pipeline, layering: str, count: int = 6, **changes: object) -> tuple[Frame, Layers]:
    frame = pipeline.frame(SETTINGS, guard=True)
    kind = Kind(fit(frame, count, float(changes.pop("overlap", 0.1))), Layering(layering), 1, False, False)
    return frame, build(Recipe(frame, "multiview", multiview.Params()), kind._replace(**changes))


def reference(pipeline: Pipeline, settings: Settings, views: int = 128) -> np.ndarray:
    return pipeline.render(settings.with_(method="accumulation").with_params(views=views)).pixels()


def demo_settings(name: str, size: tuple[int, int]) -> Settings:
    return apply_view(Settings(), view(name), name).with_(image=ImageSettings(size=size), method="multiview")


@pytest.mark.parametrize("surfaces", [False, True])
def test_one_pass_fills_the_layers_as_one_pass_each_does(planes: Pipeline, surfaces: bool):
    _, layers = layers_of(planes, "exact", surfaces=surfaces)
    exact = {name: image.pixels().astype(float) for name, image in layers.images.items()}
    _, layers = layers_of(planes, "passes", surfaces=surfaces)
    # The two programs may round differently; which pixels are filled is what the method lives on.
    for name, image in layers.images.items():
        passes = image.pixels().astype(float)
        assert np.mean((passes != 0.0) != (exact[name] != 0.0)) <= 1e-5, name
        assert np.mean(np.abs(passes - exact[name]) > 1e-3 * np.abs(exact[name]).max()) <= 1e-5, name


@pytest.mark.parametrize("lacks", ["functions", "framebuffers"])
def test_a_driver_that_cannot_layer_draws_each_layer_by_itself(
    planes: Pipeline, monkeypatch: pytest.MonkeyPatch, lacks: str
):
    def refused(*_: object) -> None:
        raise NoLayersError("no")

    exact = planes.render(SETTINGS.with_params(layers=7))
    planes.forget()
    # Another size, as framebuffers are kept.
    settings = SETTINGS.with_params(layers=6)
    passes = planes.render(settings.with_params(layering="passes"))
    expected, drawn = passes.pixels(), passes.counts["geometry passes"]
    planes.forget()
    if lacks == "functions":
        monkeypatch.setattr(DepthArray, "available", lambda _: False)
    else:
        monkeypatch.setattr(DepthArray, "attach", refused)
    fallen = planes.render(settings)
    assert np.array_equal(fallen.pixels(), expected)
    assert fallen.counts["geometry passes"] == drawn > exact.counts["geometry passes"]


def test_more_layers_than_one_invocation_writes(planes: Pipeline):
    _, layers = layers_of(planes, "exact", count=30)
    depth = layers.images["layer_inverse_depth"].pixels()
    _, layers = layers_of(planes, "passes", count=30)
    assert layers.slabs.count > 17
    assert np.mean((layers.images["layer_inverse_depth"].pixels() > 0.0) != (depth > 0.0)) <= 1e-5


def test_the_paper_s_layers_are_wrong_in_few_texels_and_never_in_the_nearest(planes: Pipeline):
    """A triangle drawn into its farthest layer alone may hide others there (measured 0.0 % here, 0.2 % on `rail`)."""
    frame, layers = layers_of(planes, "exact")
    exact = layers.images["layer_inverse_depth"].pixels()
    _, layers = layers_of(planes, "paper")
    paper = layers.images["layer_inverse_depth"].pixels()
    assert np.mean((paper > 0.0) != (exact > 0.0)) <= 0.02
    assert np.abs(paper.max(axis=0) - frame.pinhole().inverse_depth.pixels()).max() < 1e-6


def test_a_layer_holds_its_slab_and_the_overlap_only(planes: Pipeline):
    _, layers = layers_of(planes, "exact", overlap=0.25)
    slabs, depth = layers.slabs, layers.images["layer_inverse_depth"].pixels()
    filled = 0
    for k in range(slabs.count):
        found = depth[k][depth[k] > 0.0]
        filled += found.size
        back = slabs.farthest if k + 1 == slabs.count else slabs.nearest - (k + 1) * slabs.step
        assert np.all(found <= slabs.nearest - (k - 0.2501) * slabs.step)
        assert np.all(found >= back - 0.2501 * slabs.step)
    assert filled > depth[0].size


def test_the_layers_reach_from_the_nearest_to_the_farthest_surface(planes: Pipeline):
    frame, layers = layers_of(planes, "exact")
    visible = frame.pinhole().inverse_depth.pixels()
    assert layers.slabs.nearest == visible.max()
    assert layers.slabs.farthest <= visible[visible > 0.0].min()


def test_what_is_hidden_behind_all_gets_a_layer_of_its_own(gpu: Gpu):
    """A far wall beside the picture stretches the scene's box; the layers in view keep their steps."""
    walls = [quad((0, 0, 0), (9, 9), 0), quad((200, 0, -100), (1, 1), 0), quad((0, 0, 3), (0.2, 0.2), 0)]
    pipeline = Pipeline(gpu, scene_of(walls, [unlit(0.5, 0.5, 0.5)]))
    frame = pipeline.frame(SETTINGS, guard=True)
    slabs, farthest_seen = fit(frame, 8, 0.1), frame.depth_range().farthest_surface
    pipeline.release()
    assert slabs.count == 9
    assert slabs.nearest - 8 * slabs.step == pytest.approx(farthest_seen)
    assert slabs.farthest < 1.0 / 100.0


def test_layers_of_a_scene_that_surrounds_the_camera(gpu: Gpu):
    """Its near plane may be ten decades in front of its far one; each layer has planes of its own."""
    walls = [quad((0, 0, 0), (9, 9)), quad((0.3, 0, 2), (0.4, 1)), quad((0, -60, 40), (9, 9))]
    pipeline = Pipeline(gpu, scene_of(walls, [noise_material(4)]))
    settings = SETTINGS.with_params(skip=False)
    assert depth_range(pipeline.scene, CAMERA)[0] < 1e-6
    exact, passes = (pipeline.render(settings.with_params(layering=kind)).pixels() for kind in ("exact", "passes"))
    pipeline.release()
    assert metrics.psnr(exact, passes) > 60.0


def test_finer_layers_hold_the_pixel_centres(planes: Pipeline):
    frame, layers = layers_of(planes, "exact", detail=2)
    nearest = layers.images["layer_inverse_depth"].pixels().max(axis=0)
    # Texel (0, 0) of a pixel, counted from below, is at its centre; an edge through it may be drawn either way.
    assert np.mean(np.abs(nearest[1::2, ::2] - frame.pinhole().inverse_depth.pixels()) > 1e-6) < 1e-3


def test_layers_by_growth_are_as_many_as_their_growth_asks(planes: Pipeline):
    frame = planes.frame(SETTINGS, guard=True)
    near, far = frame.coc_range()
    assert multiview.count_for_growth(frame, 2.0) == int(np.ceil((far - near) / 2.0))
    assert multiview.count_for_growth(frame, 1e-3) == 31
    counts = [planes.render(SETTINGS.with_params(spacing="growth", growth=growth)).counts for growth in (2.0, 8.0)]
    assert all(count["geometry passes"] >= 1 for count in counts)


def test_little_memory_means_less_detail_and_then_fewer_layers(planes: Pipeline):
    planes.render(SETTINGS.with_params(detail=3))
    size = planes.gpu.targets.named("multiview/layer color")[0].shape
    planes.render(SETTINGS.with_params(detail=3, memory=16))
    small = planes.gpu.targets.named("multiview/layer color")[0].shape
    planes.render(SETTINGS.with_params(detail=1, memory=16, layers=31, view_dependent=True))
    few = planes.gpu.targets.named("multiview/layer color")[0].shape
    assert size.size[0] == 3 * small.size[0] or small.size[0] < size.size[0]
    assert few.layers < 31 and few.size == planes.frame(SETTINGS, guard=True).size


@pytest.mark.parametrize("lens", [SETTINGS.lens, Lens(radius=0.4, focus_distance=4.0)])
@pytest.mark.parametrize("changes", [{}, {"cones": False}, {"detail": 2}, {"jitter": "noise"}, {"samples": 3}])
def test_culling_leaves_the_picture_as_it_is(planes: Pipeline, lens: Lens, changes: dict):
    settings = SETTINGS.with_(lens=lens).with_params(**changes)
    every = planes.render(settings.with_params(culling="off")).pixels()
    assert np.array_equal(planes.render(settings.with_params(culling="tiles")).pixels(), every)
    assert np.array_equal(planes.render(settings.with_params(culling="n_buffer")).pixels(), every)


def test_culling_leaves_most_layers_out_and_counts_them(planes: Pipeline):
    planes.gpu.profile.timing = True
    try:
        counts = planes.render(SETTINGS).counts
    finally:
        planes.gpu.profile.timing = False
        planes.gpu.profile.resolve()
    assert 0 < counts["multiview layers in reach"] < 0.4 * counts["multiview layers skipped"]


def test_moving_the_focus_draws_no_triangle(planes: Pipeline):
    settings = SETTINGS.with_(image=ImageSettings(size=(128, 96), guard_px=16))
    planes.render(settings)
    moved = planes.render(settings.with_(lens=Lens(radius=0.1, focus_distance=3.5)))
    assert moved.counts.get("geometry passes", 0) == 0


def test_it_is_near_the_reference_and_nearer_with_more_rays(planes: Pipeline):
    """The paper's 30.84 dB and SSIM 0.97 are the floor. From 32 rays on the texels of the layers limit this scene."""
    truth = reference(planes, SETTINGS)
    picture = planes.render(SETTINGS).pixels()
    assert metrics.psnr(picture, truth) > 45.0 and metrics.ssim(picture, truth) > 0.98
    finer = SETTINGS.with_params(detail=2)
    reached = [metrics.psnr(planes.render(finer.with_params(samples=n)).pixels(), truth) for n in (16, 32, 64)]
    assert reached == sorted(reached)


@pytest.mark.parametrize(
    ("scene", "size", "params"),
    [("background", (192, 144), {}), ("glossy", (256, 192), {"view_dependent": True, "detail": 2})],
)
def test_cones_at_16_rays_are_worth_2_db(gpu: Gpu, scene: str, size: tuple[int, int], params: dict):
    """Of surfaces too: where two meet their light is averaged, not only what is lit."""
    settings = demo_settings(scene, size).with_params(samples=16, **params)
    pipeline = Pipeline(gpu, demo(f"{scene}@5k"))
    truth = reference(pipeline, settings)
    rays, cones = (pipeline.render(settings.with_params(cones=cones)).pixels() for cones in (False, True))
    pipeline.release()
    assert metrics.psnr(cones, truth) >= metrics.psnr(rays, truth) + 2.0


def test_cones_do_not_let_light_through_a_slanted_floor(gpu: Gpu):
    """Half of a cone may meet the floor in one layer and half in the next: together they stop it."""
    corners = np.float32([[-20, -1, 4], [20, -1, 4], [20, -1, -60], [-20, -1, -60]])
    floor = quad((0, 0, 0), (1, 1))
    floor.positions[:] = corners
    pipeline = Pipeline(gpu, scene_of([floor], [unlit(0.5, 0.5, 0.5)]))
    settings = SETTINGS.with_(
        camera=Camera(position=(0.0, 0.2, 5.0), target=(0.0, -0.6, 0.0)), background_linear=(0.0, 0.0, 0.0)
    )
    for lens in (Lens(radius=0.1, focus_distance=5.0), Lens(radius=0.3, focus_distance=12.0)):
        picture = pipeline.render(settings.with_(lens=lens)).pixels()
        assert np.abs(picture[50:] - 0.5).max() <= 0.005
    for radius, focus in ((0.2, 5.0), (0.2, 8.0), (0.3, 3.0), (0.3, 5.0), (0.3, 8.0)):
        picture = pipeline.render(settings.with_(lens=Lens(radius=radius, focus_distance=focus))).pixels()
        assert np.abs(picture[50:] - 0.5).max() <= 0.01
    pipeline.release()


def test_cones_count_a_surface_once(gpu: Gpu):
    """A lamp within the overlap of two layers is in both. Counted twice it would be up to 27 % too bright."""
    lamps = [quad((0.25 * i - 1.5, 0.0, 0.25 * i), (0.08, 0.08)) for i in range(13)]
    pipeline = Pipeline(gpu, scene_of([*lamps, quad((0, 0, -20), (90, 90), 1)], [unlit(50, 50, 50), unlit(0, 0, 0)]))
    settings = SETTINGS.with_(lens=Lens(radius=0.25, focus_distance=9.0))
    truth = reference(pipeline, settings, 256).mean()
    light = [pipeline.render(settings.with_params(overlap=share)).pixels().mean() for share in (0.0, 0.1, 0.5)]
    pipeline.release()
    assert light == pytest.approx([truth] * 3, rel=0.08)
    assert max(light) < 1.03 * min(light)


def test_cones_spread_the_lens_points_no_farther_than_the_lens():
    """A cone adds a quarter of its radius squared along each axis to what the points have."""
    lens = Lens(radius=1.0, focus_distance=5.0)
    for count in (8, 32, 64):
        points = lens_samples(lens, count, progressive=False, symmetric=True)
        inside = multiview.drawn_in(points, count**-0.5)
        assert np.mean(inside**2) + 0.25 / count == pytest.approx(np.mean(points**2))
        assert np.array_equal(np.sort(-inside, axis=0), np.sort(inside, axis=0))
    assert np.array_equal(multiview.drawn_in(points, 0.0), points)


def test_cones_read_layers_averaged_over_their_squares(planes: Pipeline):
    """Against numpy: each square holds the mean of what it covers of its layer; in focus it is the texel itself."""
    frame, layers = layers_of(planes, "exact")
    cones = average(Recipe(frame, "multiview", multiview.Params()), layers, 0.6)
    sides = squares(frame.coc, layers.slabs, 0.6)
    assert sides.min() == 1.0 and sides.max() > 2.0
    width, height = frame.size
    source = layers.images["layer_color"].pixels()[:, ::-1].astype(float)
    found = cones.images["layer_color"].pixels()[:, ::-1]
    for k, side in enumerate(sides):

        def weights(length: int, side: float = side) -> np.ndarray:
            low = (np.arange(length)[:, None] - length / 2) * side + length / 2
            covered = np.minimum(low + side, np.arange(length) + 1.0) - np.maximum(low, np.arange(length))
            return np.maximum(covered, 0.0) / side

        mean = np.einsum("yj,jic,xi->yxc", weights(height), source[k], weights(width))
        inside = np.s_[height // 2 - 4 : height // 2 + 4, width // 2 - 6 : width // 2 + 6]
        assert np.abs(found[k][inside] - mean[inside]).max() < 2e-3


def test_what_is_in_focus_is_sharp_however_thick_its_layer(planes: Pipeline):
    """A layer that the focus lies in spans many pixels of blur where something is near; its squares are texels."""
    near = quad((0.0, -0.42, 4.3), (0.5, 0.2), 1)
    pipeline = Pipeline(planes.gpu, scene_of([*three_planes().primitives, near], list(three_planes().materials)))
    settings = SETTINGS.with_(lens=Lens(radius=2.0, focus_distance=10.0))
    frame = pipeline.frame(settings.with_(method="multiview"), guard=True)
    slabs = fit(frame, 16, 0.1)
    fronts, backs = (frame.coc.radius_px(bound) for bound in slabs.bounds())
    focus = int(np.flatnonzero((fronts <= 0.0) & (backs >= 0.0))[-1])
    assert backs[0] - fronts[0] > 8.0 and squares(frame.coc, slabs, 1.0)[focus] == 1.0
    wide = squares(frame.coc, slabs, 1.0)
    assert (wide[: focus - 1] > 8.0).all() and (np.diff(wide[: focus + 1]) < 0.0).all()
    truth = reference(pipeline, settings)
    assert metrics.psnr(pipeline.render(settings).pixels(), truth) > 34.0  # 27.6 with squares as in other layers
    pipeline.release()


def test_two_crossing_bars_are_displaced_as_in_the_reference(gpu: Gpu):
    settings = demo_settings("crossing", (256, 192))
    pipeline = Pipeline(gpu, demo("crossing"))
    truth = reference(pipeline, settings)
    picture = pipeline.render(settings).pixels()
    pinhole = pipeline.render(settings.with_(method="pinhole")).pixels()
    pipeline.release()
    crossing = np.s_[64:128, 96:160]
    assert metrics.psnr(picture[crossing], truth[crossing]) > 38.0
    assert metrics.psnr(picture[crossing], truth[crossing]) > metrics.psnr(pinhole[crossing], truth[crossing]) + 12.0


def test_shading_at_the_hit_is_worth_8_db_on_polished_metal(gpu: Gpu):
    """The paper: 41.38 against 27.68 dB."""
    settings = demo_settings("glossy", (256, 192))
    pipeline = Pipeline(gpu, demo("glossy"))
    truth = reference(pipeline, settings)
    finer = [settings.with_params(view_dependent=on, detail=2) for on in (False, True)]
    fixed, seen = (pipeline.render(each).pixels() for each in finer)
    pipeline.release()
    assert metrics.psnr(seen, truth) >= metrics.psnr(fixed, truth) + 8.0


def test_seen_from_the_middle_of_the_lens_surfaces_are_as_the_scene_draws_them(gpu: Gpu):
    """One ray, no blur: base colour, normal, roughness, metalness, emission and occlusion all came through."""
    settings = demo_settings("glossy", (96, 72)).with_(lens=Lens(radius=0.0, focus_distance=5.0))
    for light in ("sky", "studio"):
        lit = settings.with_(light=settings.light.model_copy(update={"environment": light}))
        pipeline = Pipeline(gpu, demo("glossy@3k"))
        picture = pipeline.render(lit.with_params(view_dependent=True)).pixels()
        pinhole = pipeline.render(lit.with_(method="pinhole")).pixels()
        pipeline.release()
        assert metrics.psnr(picture, pinhole) > 55.0


@pytest.mark.parametrize(
    "lens",
    [
        Lens(radius=0.3, focus_distance=5.0, distribution=Distribution.GAUSSIAN),
        Lens(radius=0.3, focus_distance=5.0, distribution=Distribution.POLYGON, blades=5, rotation_deg=20.0),
        Lens(radius=0.3, focus_distance=5.0, distribution=Distribution.IMAGE, image="heart"),
    ],
)
def test_any_lens_of_the_reference_is_traced(planes: Pipeline, lens: Lens):
    settings = SETTINGS.with_(lens=lens)
    picture = planes.render(settings.with_params(samples=128)).pixels()
    assert metrics.psnr(picture, reference(planes, settings)) > 36.0


def test_without_a_guard_band_rays_that_leave_are_left_out(planes: Pipeline):
    """The border is less exact, not dark: constant colour stays (contract), and the picture stays near."""
    settings = SETTINGS.with_(image=ImageSettings(size=(128, 96), guard_px=0))
    truth = reference(planes, settings)
    picture = planes.render(settings).pixels()
    border = np.ones((96, 128), bool)
    border[12:-12, 12:-12] = False
    assert metrics.psnr(picture, truth, border) > 28.0
    assert abs(picture[border].mean() - truth[border].mean()) < 0.01


@pytest.mark.parametrize("jitter", ["noise", "halton"])
def test_jitter_turns_steps_into_noise_around_the_truth(gpu: Gpu, jitter: str):
    """The same eight lens points everywhere make eight ghosts of an edge; others for each pixel average to its blur."""
    pipeline = Pipeline(
        gpu, scene_of([quad((0, 0, 0), (9, 9)), quad((-4.0, 0, 2), (4.0, 9), 1)], [unlit(1, 1, 1), unlit(0, 0, 0)])
    )
    settings = SETTINGS.with_(camera=Camera(position=(0.0, 0.0, 5.0), target=(0.0, 0.0, 0.0)))
    truth = reference(pipeline, settings)[:, 48:80].mean(axis=0)
    error = {}
    for kind in ("off", jitter):
        picture = pipeline.render(settings.with_params(samples=8, cones=False, jitter=kind)).pixels()
        error[kind] = np.abs(picture[:, 48:80].mean(axis=0) - truth).mean()
    pipeline.release()
    assert error[jitter] < 0.85 * error["off"]


def test_halton_points_follow_the_lens():
    points = on_lens(Lens(radius=1.0, focus_distance=5.0), halton(512))
    assert np.hypot(*points.T).max() <= 1.0 and np.abs(points.mean(axis=0)).max() < 0.01
    assert np.mean(points**2) == pytest.approx(0.25, abs=0.005)


def test_what_it_shows_of_itself(planes: Pipeline):
    def shown(**params: object) -> np.ndarray:
        return planes.render(SETTINGS.with_params(**params)).pixels()

    coverage = np.stack([shown(show="coverage", shown_layer=k)[..., 0] for k in range(16)])
    assert set(np.unique(coverage)) == {0.0, 1.0} and (coverage.max(axis=0) == 1.0).all()
    first = coverage.argmax(axis=0)
    colors = np.stack([shown(show="color", shown_layer=k) for k in range(16)])
    front = np.take_along_axis(colors, first[None, ..., None], 0)[0]
    pinhole = planes.render(SETTINGS.with_(method="pinhole")).pixels()
    assert np.abs(front - pinhole).max() < 2e-3
    # More layers in reach, and more probes, where the bars are than on the bare wall.
    for what in ("layers", "probes"):
        heat = shown(show=what).sum(axis=-1)
        assert heat[40:56, 30:60].mean() > heat[2:10, 100:].mean() > 0.0
