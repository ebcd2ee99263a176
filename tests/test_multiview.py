"""Multiview synthesis: what its layers hold, and that what it leaves out changes nothing."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest
from scenes import noise_material, quad, scene_of, three_planes

from dofview import metrics
from dofview.gl.context import Gpu
from dofview.lens import Lens
from dofview.methods import multiview
from dofview.methods.method import Recipe
from dofview.methods.multiview_layers import Kind, Layering, build, fit
from dofview.pipeline import Pipeline
from dofview.scene.camera import Camera
from dofview.settings import ImageSettings, Settings

CAMERA = Camera(position=(0.3, 0.2, 5.0), target=(0.0, 0.0, 0.0))
SETTINGS = Settings(
    camera=CAMERA, lens=Lens(radius=0.25, focus_distance=5.0), method="multiview", image=ImageSettings(size=(128, 96))
)


@pytest.fixture
def planes(gpu: Gpu) -> Iterator[Pipeline]:
    pipeline = Pipeline(gpu, three_planes())
    yield pipeline
    pipeline.release()


def layers_of(pipeline: Pipeline, layering: str, count: int = 6, overlap: float = 0.1):
    frame = pipeline.frame(SETTINGS, guard=True)
    recipe = Recipe(frame, "multiview", multiview.Params())
    return frame, build(recipe, Kind(fit(frame, count, overlap), Layering(layering), 1, False, False))


def test_one_pass_fills_the_layers_as_one_pass_each_does(planes: Pipeline):
    _, exact = layers_of(planes, "exact")
    color, depth = exact.images["layer_color"].pixels(), exact.images["layer_inverse_depth"].pixels()
    _, passes = layers_of(planes, "passes")
    # The two programs may round differently; which pixels are filled is what the method lives on.
    assert np.mean((passes.images["layer_inverse_depth"].pixels() > 0.0) != (depth > 0.0)) <= 1e-5
    assert np.mean(np.abs(passes.images["layer_inverse_depth"].pixels() - depth) > 1e-6) <= 1e-5
    assert np.mean(np.abs(passes.images["layer_color"].pixels() - color) > 1e-3) <= 1e-5


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


@pytest.mark.parametrize("lens", [SETTINGS.lens, Lens(radius=0.4, focus_distance=4.0)])
def test_culling_leaves_the_picture_as_it_is(planes: Pipeline, lens: Lens):
    settings = SETTINGS.with_(lens=lens)
    every = planes.render(settings.with_params(culling="off")).pixels()
    assert np.array_equal(planes.render(settings).pixels(), every)


def test_moving_the_focus_draws_no_triangle(planes: Pipeline):
    settings = SETTINGS.with_(image=ImageSettings(size=(128, 96), guard_px=16))
    planes.render(settings)
    moved = planes.render(settings.with_(lens=Lens(radius=0.1, focus_distance=3.5)))
    assert moved.counts.get("geometry passes", 0) == 0


def test_it_is_near_the_reference(planes: Pipeline):
    """Measured 37.6 dB; the paper's 30.84 dB and SSIM 0.97 are the floor."""
    truth = planes.render(SETTINGS.with_(method="accumulation").with_params(views=128)).pixels()
    picture = planes.render(SETTINGS).pixels()
    assert metrics.psnr(picture, truth) > 35.0 and metrics.ssim(picture, truth) > 0.97


def test_a_wall_seen_past_a_bar_is_there(gpu: Gpu):
    """What the bar hides from the lens centre is in the layers: nothing of it is made up."""
    wall = quad((0, 0, -5), (12, 9), 0, 6.0), quad((0, 0, 2), (0.15, 3.0), 1)
    pipeline = Pipeline(gpu, scene_of([*wall], [noise_material(1), noise_material(2)]))
    truth = pipeline.render(SETTINGS.with_(method="accumulation").with_params(views=128)).pixels()
    picture = pipeline.render(SETTINGS.with_params(samples=128)).pixels()
    pipeline.release()
    assert np.abs(picture - truth)[:, 56:72].mean() < 0.01
