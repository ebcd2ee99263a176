"""What is seen as one image: every pixel of it is that of the picture, map or overlay it is made of."""

from __future__ import annotations

import numpy as np
import pytest
from scenes import three_planes

from dofview.gl.compose import Box, Layer, Part, compose, fitted
from dofview.gl.context import Gpu
from dofview.lens import Lens
from dofview.methods import METHODS
from dofview.metrics import srgb_decode, srgb_encode
from dofview.pipeline import Pipeline
from dofview.render.display import show
from dofview.scene.camera import Camera
from dofview.seen import overlays
from dofview.seen.headless import picture
from dofview.seen.layout import cells
from dofview.seen.model import Arrangement, Band, Difference, HeatSettings, Seen
from dofview.settings import ImageSettings, Settings

SIZE = (96, 64)
SETTINGS = Settings(
    camera=Camera(position=(0, 1, 5)), lens=Lens(radius=0.1, focus_distance=4.0), method="accumulation",
    image=ImageSettings(size=SIZE),
).with_params(views=8).with_(method="mipmap")  # fmt: skip
PLAIN = Seen(text_px=4.0)
UNWRITTEN = (slice(28, 54), slice(None))
"""Rows of the canvas that neither names nor legends reach."""


@pytest.fixture
def planes(gpu: Gpu):
    pipeline = Pipeline(gpu, three_planes())
    yield pipeline
    pipeline.release()


def shown(pipeline: Pipeline, method: str) -> np.ndarray:
    settings = SETTINGS.with_(method=method)
    return pipeline.shown(pipeline.render(settings), settings)


def seen(pipeline: Pipeline, **changes) -> np.ndarray:
    return picture(pipeline, SETTINGS, PLAIN.model_copy(update=changes)).pixels()[..., :3]


def noise(gpu: Gpu, size: tuple[int, int] = (12, 8)):
    pixels = np.random.default_rng(3).integers(0, 256, (size[1], size[0], 4), dtype=np.uint8)
    pixels[..., 3] = 255
    image = gpu.targets.image("test/noise", size, dtype="f1", linear=True)
    image.write(pixels)
    return image, pixels


def test_a_texel_on_a_pixel_is_copied_and_enlarged_ones_stay_squares(gpu: Gpu):
    image, pixels = noise(gpu)
    beside = compose(gpu, [Layer(image, Box(5, 2, 12, 8))], (20, 14), "test/canvas").pixels()
    assert (beside[2:10, 5:17] == pixels).all() and (beside[:2, :, :3] == 0).all() and (beside[:, 17:, :3] == 0).all()
    part = Part(0.25, 0.5, 0.5, 0.5)
    large = compose(gpu, [Layer(image, Box(0, 0, 48, 32), part)], (48, 32), "test/canvas").pixels()
    assert (large == np.repeat(np.repeat(pixels[4:8, 3:9], 8, axis=0), 8, axis=1)).all()


def test_a_smaller_picture_is_the_mean_of_what_falls_on_each_pixel(gpu: Gpu):
    image, pixels = noise(gpu)
    small = compose(gpu, [Layer(image, Box(0, 0, 4, 4))], (4, 4), "test/canvas").pixels().astype(float)
    assert np.abs(small - pixels.reshape(4, 2, 4, 3, 4).mean(axis=(1, 3))).max() <= 0.51
    uneven = fitted(gpu, image, (9, 9), "test/canvas").pixels().astype(float)
    assert (uneven[:1, :, :3] == 0).all() and (uneven[-2:, :, :3] == 0).all(), "as large as it fits, in the middle"
    assert abs(uneven[1:7, :, :3].mean() - pixels[..., :3].mean()) < 1.0


def test_what_is_clear_lets_the_layer_below_through_and_a_colour_needs_no_image(gpu: Gpu):
    image, pixels = noise(gpu)
    veil = Layer((1.0, 0.0, 0.0, 0.25), Box(3, 0, 4, 8))
    found = compose(gpu, [Layer(image, Box(0, 0, 12, 8)), veil], (12, 8), "test/canvas").pixels().astype(float)
    wanted = pixels[:, 3:7, :3] * 0.75 + np.array([255.0, 0.0, 0.0]) * 0.25
    assert np.abs(found[:, 3:7, :3] - wanted).max() <= 1.0 and (found[:, :3] == pixels[:, :3]).all()


def test_one_picture_is_that_picture(planes: Pipeline):
    assert (seen(planes) == shown(planes, "mipmap")).all()


def test_a_wipe_has_each_picture_on_its_side(planes: Pipeline):
    found = seen(planes, arrangement=Arrangement.WIPE, other="pinhole", split=0.375)
    line = round(0.375 * SIZE[0])
    rows = UNWRITTEN[0]
    assert (found[rows, : line - 1] == shown(planes, "mipmap")[rows, : line - 1]).all()
    assert (found[rows, line + 2 :] == shown(planes, "pinhole")[rows, line + 2 :]).all()
    assert (found[rows, line] == 255).all(), "the line between them"
    assert (seen(planes, arrangement=Arrangement.WIPE, other="mipmap") == shown(planes, "mipmap")).all()


def test_a_grid_has_every_method_in_its_cell(planes: Pipeline, gpu: Gpu):
    found = seen(planes, arrangement=Arrangement.GRID).astype(float)
    boxes = cells(len(METHODS), Box(0, 0, *SIZE))[: len(METHODS)]
    assert len({(box.left, box.top) for box in boxes}) == len(METHODS)
    for name, box in zip(METHODS, boxes, strict=True):
        there = found[box.top : box.top + box.height - 9, box.left : box.left + box.width]
        settings = SETTINGS.with_(method=name)
        image = show(gpu, planes.render(settings).image, settings.display, "test/shown")
        alone = compose(gpu, [Layer(image, Box(0, 0, box.width, box.height))], SIZE, "test/canvas").pixels()
        assert (there == alone[: there.shape[0], : there.shape[1], :3]).all(), name


def test_the_zoom_is_of_every_picture(planes: Pipeline):
    part = Part(0.25, 0.25, 0.5, 0.5)
    found = seen(planes, arrangement=Arrangement.WIPE, other="pinhole", split=0.5, part=part)
    twice = {
        name: np.repeat(np.repeat(shown(planes, name)[16:48, 24:72], 2, 0), 2, 1) for name in ("mipmap", "pinhole")
    }
    rows = UNWRITTEN[0]
    assert (found[rows, :47] == twice["mipmap"][rows, :47]).all()
    assert (found[rows, 50:] == twice["pinhole"][rows, 50:]).all()


@pytest.mark.parametrize("difference", Difference)
def test_an_error_map_is_that_of_the_two_pictures(planes: Pipeline, gpu: Gpu, difference: Difference):
    heat = HeatSettings(difference=difference, gain=8.0)
    found = seen(planes, error_map=True, heat=heat)
    own = planes.render(SETTINGS).image
    truth = planes.render(SETTINGS.with_(method="accumulation"), "test/truth").image
    wanted = overlays.error_map(gpu, own, truth, heat, "test/map").pixels()[..., :3]
    assert (found[:36] == wanted[:36]).all() and np.ptp(wanted[:36].astype(int)) > 20
    assert (found[36:] != wanted[36:]).any(), "its scale stands over it"


def test_what_is_in_focus_is_tinted_once_on_either_side_of_a_wipe(planes: Pipeline):
    band = Band(blur_px=1.0)
    plain = shown(planes, "mipmap").astype(float)
    found = seen(planes, in_focus=True, band=band)
    tinted = np.abs(found - plain).max(axis=2) > 4.0
    assert 0.02 < tinted.mean() < 0.98, "a part of it"
    beside = seen(planes, arrangement=Arrangement.WIPE, other="pinhole", split=0.5, in_focus=True, band=band)
    rows = UNWRITTEN[0]
    assert (beside[rows, :46] == found[rows, :46]).all()


def test_in_linear_light_pictures_keep_what_a_screen_cannot_show(planes: Pipeline):
    values = PLAIN.model_copy(update={"arrangement": Arrangement.WIPE, "other": "pinhole"})
    found = picture(planes, SETTINGS, values, linear=True).pixels()[UNWRITTEN]
    own = planes.render(SETTINGS).pixels()[UNWRITTEN]
    assert (found[:, :46, :3] == own[:, :46]).all()
    image, pixels = noise(planes.gpu)
    decoded = compose(planes.gpu, [Layer(image, Box(0, 0, 12, 8))], (12, 8), "test/linear", linear=True).pixels()
    assert np.abs(srgb_encode(decoded[..., :3]) * 255.0 - pixels[..., :3]).max() < 0.01
    assert np.abs(decoded[..., :3] - srgb_decode(pixels[..., :3] / 255.0)).max() < 1e-5


def test_nothing_is_left_behind(planes: Pipeline, gpu: Gpu):
    values = Seen(arrangement=Arrangement.GRID, error_map=True, in_focus=True)
    counts = []
    for _ in range(5):
        picture(planes, SETTINGS, values)
        counts.append(len(gpu.targets.named()))
    assert counts[-2] == counts[-1]
    for _ in range(4):
        planes.render(SETTINGS)
    assert not gpu.targets.named("seen/")
