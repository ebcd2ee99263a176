"""What is seen through: laid over what it covers, in the order of depth, alike in the reference and in the methods."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scenes import quad, scene_of, unlit

from dofview.gl.context import Gpu
from dofview.lens import Lens
from dofview.metrics import psnr
from dofview.pipeline import Pipeline
from dofview.render.blended import MOST_RUNS
from dofview.scene.camera import Camera
from dofview.scene.model import Material, Scene
from dofview.settings import ImageSettings, Settings

WALL = (0.1, 0.2, 0.6)
SETTINGS = Settings(
    camera=Camera(position=(0.0, 0.0, 5.0), target=(0.0, 0.0, 0.0), vfov_deg=40.0),
    lens=Lens(radius=0.0, focus_distance=5.0), image=ImageSettings(size=(48, 48)), method="pinhole",
    background_linear=(0.3, 0.3, 0.3),
)  # fmt: skip


def glass(red: float, green: float, blue: float, alpha: float) -> Material:
    return replace(unlit(red, green, blue), base_color=(red, green, blue, alpha), alpha_mode="BLEND")


def middle(gpu: Gpu, scene: Scene, settings: Settings = SETTINGS) -> tuple[np.ndarray, float]:
    """Colour of the middle pixel and its depth, 0 where there is none."""
    pipeline = Pipeline(gpu, scene)
    result = pipeline.render(settings)
    inverse = float(result.frame.pinhole().inverse_depth.pixels()[24, 24, 0])
    pixel = result.pixels()[24, 24]
    pipeline.release()
    return pixel, 1.0 / inverse if inverse > 0.0 else 0.0


def over(*layers: tuple[tuple[float, float, float], float]) -> np.ndarray:
    """Colours and opacities from the nearest on, over the wall."""
    seen = np.array(WALL)
    for color, alpha in reversed(layers):
        seen = alpha * np.array(color) + (1.0 - alpha) * seen
    return seen


@pytest.mark.parametrize("order", [(0, 1, 2), (2, 1, 0), (1, 2, 0)])
@pytest.mark.parametrize(
    "method", ["pinhole", "accumulation", "splatting", "multiview", "mipmap", "pyramid", "layered"]
)
def test_panes_lie_over_one_another_whatever_their_order_in_the_file(gpu: Gpu, method: str, order: tuple[int, ...]):
    panes = [quad((0, 0, z), (1, 1), material) for material, z in enumerate((1.0, 0.0, -1.0))]
    materials = [glass(0.9, 0.1, 0.1, 0.3), glass(0.1, 0.9, 0.1, 0.6), glass(0.8, 0.8, 0.1, 0.4), unlit(*WALL)]
    scene = scene_of([*(panes[i] for i in order), quad((0, 0, -3), (4, 4), 3)], materials)
    expected = over(*((m.base_color[:3], m.base_color[3]) for m in materials[:3]))
    pixel, depth = middle(gpu, scene, SETTINGS.with_(method=method))
    np.testing.assert_allclose(pixel, expected, atol=2e-3)
    assert depth == pytest.approx(5.0)  # of the nearest that is half opaque


def test_clear_glass_leaves_the_depth_of_what_is_behind_and_has_its_own_before_nothing(gpu: Gpu):
    pane = quad((0, 0, 1), (1, 1), 0)
    materials = [glass(1, 1, 1, 0.2), unlit(*WALL)]
    _, depth = middle(gpu, scene_of([pane, quad((0, 0, -3), (4, 4), 1)], materials))
    assert depth == pytest.approx(8.0)
    for method in ("pinhole", "multiview"):
        settings = SETTINGS.with_(method=method, lens=Lens(radius=0.05, focus_distance=4.0))
        pixel, depth = middle(gpu, scene_of([pane], materials), settings)
        assert depth == pytest.approx(4.0)
        np.testing.assert_allclose(pixel, 0.2 + 0.8 * 0.3, atol=2e-3)


def test_what_is_behind_a_wall_is_not_seen_through_it(gpu: Gpu):
    scene = scene_of([quad((0, 0, -4), (1, 1), 0), quad((0, 0, -3), (4, 4), 1)], [glass(1, 1, 1, 0.7), unlit(*WALL)])
    pixel, depth = middle(gpu, scene)
    np.testing.assert_allclose(pixel, WALL, atol=2e-3)
    assert depth == pytest.approx(8.0)


def test_a_blended_material_that_is_opaque_everywhere_costs_nothing(gpu: Gpu):
    scene = scene_of([quad((0, 0, 0), (1, 1), 0)], [glass(0.5, 0.5, 0.5, 1.0)])
    pipeline = Pipeline(gpu, scene)
    assert not pipeline.scene.blended
    pipeline.release()


def test_colours_of_vertices_let_light_through_too(gpu: Gpu):
    pane = replace(quad((0, 0, 0), (1, 1), 0), colors=np.tile(np.float32([1, 1, 1, 0.25]), (4, 1)))
    pixel, _ = middle(gpu, scene_of([pane, quad((0, 0, -3), (4, 4), 1)], [glass(1, 0, 0, 1.0), unlit(*WALL)]))
    np.testing.assert_allclose(pixel, over(((1, 0, 0), 0.25)), atol=2e-3)


def test_very_many_panes_of_two_materials_are_drawn_in_few_runs(gpu: Gpu):
    panes = [quad((0, 0, -k / (2 * MOST_RUNS)), (0.5, 0.5), k % 2) for k in range(2 * MOST_RUNS)]
    scene = scene_of(panes, [glass(1, 0, 0, 0.5), glass(0, 1, 0, 0.5)])
    pipeline = Pipeline(gpu, scene)
    result = pipeline.render(SETTINGS)
    assert result.counts["draws"] <= 12 and np.isfinite(result.pixels()).all()
    pipeline.release()


@pytest.mark.parametrize("method", ["splatting", "multiview", "layered", "pyramid", "mipmap"])
@pytest.mark.parametrize("focus", [4.0, 8.0])
def test_methods_blur_glass_as_the_reference_does(gpu: Gpu, method: str, focus: float):
    random = np.random.default_rng(3)
    places = [(*random.uniform(-1.2, 1.2, 2), float(z)) for z in np.linspace(-2, 1.5, 12)]
    panes = [quad(place, (0.4, 0.4), n % 4) for n, place in enumerate(places)]
    materials = [glass(*random.uniform(0, 1, 3), alpha) for alpha in (0.3, 0.45, 0.6, 0.75)]
    scene = scene_of([*panes, quad((0, 0, -3), (5, 5), 4)], [*materials, unlit(*WALL)])
    lens = Lens(radius=0.06, focus_distance=focus)
    settings = SETTINGS.with_(lens=lens, image=ImageSettings(size=(96, 96)))
    pipeline = Pipeline(gpu, scene)
    truth = pipeline.render(settings.with_(method="accumulation").with_params(views=128)).pixels()
    picture = pipeline.render(settings.with_(method=method)).pixels()
    sharp = pipeline.render(settings.with_(method="pinhole")).pixels()
    pipeline.release()
    # Panes less than half opaque are blurred as what is behind them. Cut out at a half, all of them are at 20 to 24 dB.
    assert psnr(picture, truth) > 34.0
    assert focus == 4.0 or method == "mipmap" or psnr(picture, truth) > psnr(sharp, truth) + 2.0
