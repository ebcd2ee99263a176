"""What every method owes, whichever it is: a new one is tested here the moment its name is in METHODS."""

from __future__ import annotations

from collections.abc import Iterator
from enum import Enum

import numpy as np
import pytest
from scenes import constant, empty, noise_material, quad, scene_of, three_planes, unlit

from dofview.gl.context import MOST_BLOCKS, Gpu
from dofview.lens import Lens
from dofview.methods import METHODS, method
from dofview.methods.method import Params
from dofview.metrics import psnr
from dofview.pipeline import Pipeline
from dofview.scene.camera import Camera
from dofview.settings import ImageSettings, Settings
from dofview.stress.living import live_objects

BLURRING = [name for name in METHODS if name != "pinhole"]
SIZE = (96, 72)
CAMERA = Camera(position=(0.3, 0.2, 5.0), target=(0.0, 0.0, 0.0))
WIDE = Lens(radius=0.25, focus_distance=5.0)


def settings_for(name: str, lens: Lens = WIDE, size: tuple[int, int] = SIZE, **image: object) -> Settings:
    settings = Settings(camera=CAMERA, lens=lens, method=name, image=ImageSettings(size=size, **image))
    return settings.with_params(views=8) if name == "accumulation" else settings


def skipping(settings: Settings, skip: bool) -> Settings:
    """With work left out that cannot change the picture, or not, for a method that has it to choose."""
    return settings.with_params(skip=skip) if "skip" in type(settings.method_params).model_fields else settings


@pytest.fixture
def planes(gpu: Gpu) -> Iterator[Pipeline]:
    pipeline = Pipeline(gpu, three_planes())
    yield pipeline
    pipeline.release()


@pytest.mark.parametrize("skip", [True, False])
@pytest.mark.parametrize("name", BLURRING)
def test_aperture_0_is_the_pinhole(planes: Pipeline, name: str, skip: bool):
    """Also where the whole method is not left out for it."""
    shut = Lens(radius=0.0, focus_distance=5.0)
    picture = planes.render(skipping(settings_for(name, shut), skip)).pixels()
    assert np.abs(picture - planes.render(settings_for("pinhole", shut)).pixels()).max() <= 1e-4


@pytest.mark.parametrize("name", BLURRING)
def test_a_closing_aperture_becomes_the_pinhole(planes: Pipeline, name: str):
    """At a largest CoC radius of 1e-5 px: no threshold may blur, and no division may fail."""
    barely = Lens(radius=1e-6, focus_distance=5.0)
    picture = planes.render(skipping(settings_for(name, barely), False)).pixels()
    assert psnr(picture, planes.render(settings_for("pinhole", barely)).pixels()) >= 60.0


@pytest.mark.parametrize("name", BLURRING)
@pytest.mark.parametrize("lens", [WIDE, Lens(radius=1.0, focus_distance=3.5), Lens(radius=0.4, focus_distance=60.0)])
def test_one_colour_stays_that_colour(gpu: Gpu, name: str, lens: Lens):
    """The white furnace, borders included: Σ weights is 1 wherever the depths jump."""
    pipeline = Pipeline(gpu, constant(0.5))
    picture = pipeline.render(settings_for(name, lens).with_(background_linear=(0.5, 0.5, 0.5))).pixels()
    pipeline.release()
    assert np.abs(picture - 0.5).max() <= 1e-3


@pytest.mark.parametrize("name", BLURRING)
def test_what_is_in_focus_stays_sharp(gpu: Gpu, name: str):
    wall = scene_of([quad((0, 0, 0), (8, 6), 0, 3.0)], [noise_material(4)])
    pipeline = Pipeline(gpu, wall)
    straight = Camera(position=(0.0, 0.0, 5.0), target=(0.0, 0.0, 0.0))
    open_wide = settings_for(name, Lens(radius=1.5, focus_distance=5.0)).with_(camera=straight)
    sharp = pipeline.render(open_wide.with_(method="pinhole")).pixels()
    blurred = pipeline.render(open_wide).pixels()
    pipeline.release()
    assert psnr(blurred, sharp) >= 45.0


def corners(model: type[Params]) -> list[dict[str, object]]:
    """Each parameter at each end of its range, or at each of its values, the others at their defaults."""
    found: list[dict[str, object]] = []
    for field, info in model.model_fields.items():
        if field == "views":
            continue
        if info.annotation is bool:
            found += [{field: value} for value in (False, True)]
        elif isinstance(info.annotation, type) and issubclass(info.annotation, Enum):
            found += [{field: value} for value in info.annotation]
        elif info.annotation in (int, float):
            for bound in info.metadata:
                found += [
                    {field: end} for end in (getattr(bound, "ge", None), getattr(bound, "le", None)) if end is not None
                ]
    return found or [{}]


@pytest.mark.parametrize("name", METHODS)
def test_no_corner_of_the_parameters_gives_nan(planes: Pipeline, name: str):
    base = settings_for(name, size=(33, 25))
    for corner in corners(method(name).Params):
        picture = planes.render(base.with_params(**corner)).pixels()
        assert np.isfinite(picture).all() and picture.min() >= -1e-6, corner


@pytest.mark.parametrize("name", METHODS)
@pytest.mark.parametrize("size", [(1, 1), (1, 64), (61, 1), (2, 3), (37, 29), (65, 33)])
def test_every_size_works(planes: Pipeline, name: str, size: tuple[int, int]):
    for guard in (None, 0):
        picture = planes.render(settings_for(name, size=size, guard_px=guard)).pixels()
        assert picture.shape == (size[1], size[0], 3) and np.isfinite(picture).all()


@pytest.mark.parametrize("name", METHODS)
@pytest.mark.parametrize("scale", [0.5, 1.37, 2.0])
def test_render_scale_keeps_the_picture(gpu: Gpu, name: str, scale: float):
    """One colour at any scale, and the supersampled picture close to the plain one in its means."""
    pipeline = Pipeline(gpu, three_planes())
    plain = pipeline.render(settings_for(name)).pixels()
    scaled = pipeline.render(settings_for(name, scale=scale)).pixels()
    pipeline.release()
    assert scaled.shape == plain.shape
    assert np.abs(scaled.mean(axis=(0, 1)) - plain.mean(axis=(0, 1))).max() < 0.01


@pytest.mark.parametrize("name", METHODS)
def test_an_empty_scene_is_its_background(gpu: Gpu, name: str):
    pipeline = Pipeline(gpu, empty())
    picture = pipeline.render(settings_for(name).with_(background_linear=(0.2, 0.4, 0.6))).pixels()
    pipeline.release()
    assert np.abs(picture - [0.2, 0.4, 0.6]).max() <= 1e-3


@pytest.mark.parametrize("name", METHODS)
def test_bright_light_stays_finite(gpu: Gpu, name: str):
    spots = [quad((0, 0, -5), (12, 9), 0), quad((0.3, 0.4, 0), (0.02, 0.02), 1), quad((-0.5, 0.1, 3), (0.02, 0.02), 1)]
    pipeline = Pipeline(gpu, scene_of(spots, [unlit(0.0, 0.0, 0.0), unlit(6e4, 6e4, 6e4)]))
    picture = pipeline.render(settings_for(name)).pixels()
    pipeline.release()
    assert np.isfinite(picture).all() and picture.max() > 1.0


@pytest.mark.parametrize("name", METHODS)
def test_the_same_settings_give_the_same_bytes(planes: Pipeline, name: str):
    """Also after another method, another size and back: nothing of the window's history shows."""
    settings = settings_for(name)
    first = planes.render(settings).pixels()
    planes.render(settings_for(METHODS[(METHODS.index(name) + 1) % len(METHODS)], size=(40, 90)))
    assert np.array_equal(planes.render(settings).pixels(), first)
    planes.forget()
    assert np.array_equal(planes.render(settings).pixels(), first)


@pytest.mark.parametrize("name", METHODS)
def test_one_hundred_resizes_leave_no_gl_objects(gpu: Gpu, name: str):
    pipeline = Pipeline(gpu, three_planes())
    few = {"views": 2} if name == "accumulation" else {}

    def resize(steps: range) -> None:
        for step in steps:
            pipeline.render(settings_for(name, size=(16 + 5 * step % 37, 12 + 7 * step % 29)).with_params(**few))

    def settled() -> dict[str, int] | None:
        for _ in range(4):
            pipeline.render(settings_for(name, size=(50, 40)).with_params(**few))
        return live_objects(gpu.ctx)

    # A larger blur may need another variant of a shader; it is compiled once, and every size comes round in 37 steps.
    resize(range(37))
    before = settled()
    resize(range(37, 137))
    after = settled()
    pipeline.release()
    if before is not None and after is not None:
        # Uniform blocks are kept by content, up to a fixed number; everything else is as it was.
        assert after.pop("Buffer") - before.pop("Buffer") <= MOST_BLOCKS
        assert after == before
