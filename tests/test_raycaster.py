"""The judge is judged: the ray caster against formulas that need no ray."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from raycaster import Rectangle, ThinLensCamera, bilinear, cast, disc, gaussian, picture, polygon

CAMERA = ThinLensCamera((0, 0, 0), (0, 0, -1), (0, 1, 0), 53.0, 0.3, 2.0, disc)
HEIGHT = 40
FOCAL_PX = HEIGHT / 2 / math.tan(math.radians(26.5))


def white(u: np.ndarray, v: np.ndarray) -> np.ndarray:
    return np.ones((len(u), 3))


def half_plane(depth: float) -> Rectangle:
    """All that is right of the view axis, at `depth`."""
    return Rectangle((0.0, 50.0, -depth), (100.0, 0.0, 0.0), (0.0, -100.0, 0.0), white)


@pytest.mark.parametrize("depth", [1.0, 1.4, 3.0, 9.0])
@pytest.mark.parametrize(
    ("name", "transmission", "extent"),
    [("disc", disc, 1.0), ("gaussian", gaussian(0.5), 2.5), ("square", polygon(4, 45.0), 1.0)],
)
def test_an_edge_blurs_as_its_aperture(depth: float, name: str, transmission, extent: float) -> None:
    """The profile across the edge is the area of the aperture up to a line, at B·(1/s − 1/z) px per lens radius."""
    camera = replace(CAMERA, transmission=transmission, extent=extent)
    seen = cast(camera, [half_plane(depth)], 40, HEIGHT, lens_grid=64, antialias=False)[..., 0].mean(axis=0)
    blur = abs(camera.lens_radius * FOCAL_PX * (1 / camera.focus_distance - 1 / depth))
    x = (np.arange(40) + 0.5 - 20) / blur
    inside = np.clip(x, -1, 1)
    side = np.clip(x, -math.sqrt(0.5), math.sqrt(0.5))
    expected = {
        "disc": 1 - (np.arccos(inside) - inside * np.sqrt(1 - inside**2)) / np.pi,
        "gaussian": np.array([0.5 + 0.5 * math.erf(v / 0.5 / math.sqrt(2)) for v in x]),
        "square": 0.5 + side / math.sqrt(2),
    }[name]
    np.testing.assert_allclose(seen, expected, atol=2e-3)


def test_the_pixel_is_a_box() -> None:
    """An edge at 0.3 of a pixel covers 0.7 of it with antialiasing, all or nothing without."""
    pinhole = replace(CAMERA, lens_radius=0.0)
    edge = Rectangle((0.3 * 2.0 / FOCAL_PX, 50.0, -2.0), (100.0, 0.0, 0.0), (0.0, -100.0, 0.0), white)
    soft = cast(pinhole, [edge], 40, HEIGHT, lens_grid=20)[..., 0].mean(axis=0)
    hard = cast(pinhole, [edge], 40, HEIGHT, lens_grid=2, antialias=False)[..., 0]
    np.testing.assert_allclose(soft[18:22], [0, 0, 0.7, 1], atol=2e-3)
    np.testing.assert_array_equal(hard[:, 18:22], np.tile([0.0, 0.0, 1.0, 1.0], (HEIGHT, 1)))


def test_up_is_up_and_near_hides_far() -> None:
    camera = replace(CAMERA, lens_radius=0.0)
    top_right = Rectangle((0, 9, -3), (9, 0, 0), (0, -9, 0), lambda u, v: np.tile([1.0, 0.0, 0.0], (len(u), 1)))
    far = Rectangle((-9, 9, -4), (18, 0, 0), (0, -18, 0), lambda u, v: np.stack([u * 0, u, v], axis=1))
    seen = cast(camera, [top_right, far], 8, 8, lens_grid=1, antialias=False)
    assert (seen[:4, 4:] == [1, 0, 0]).all() and (seen[:, :4, 0] == 0).all() and (seen[4:, :, 0] == 0).all()
    assert (np.diff(seen[6, :, 1]) > 0).all() and (np.diff(seen[:, 1, 2]) > 0).all(), "u goes right, v goes down"


def test_bilinear_lookup_at_known_places() -> None:
    texels = np.arange(12, dtype=float).reshape(2, 2, 3)
    look_up = bilinear(texels)
    u, v = np.array([0.25, 0.75, 0.5, 0.0, 1.0]), np.array([0.25, 0.25, 0.25, 0.25, 0.75])
    expected = [texels[0, 0], texels[0, 1], (texels[0, 0] + texels[0, 1]) / 2, (texels[0, 0] + texels[0, 1]) / 2,
                (texels[1, 0] + texels[1, 1]) / 2]  # fmt: skip
    np.testing.assert_allclose(look_up(u, v), expected)


def test_the_top_of_an_aperture_picture_is_up() -> None:
    look_up = picture(np.array([[1.0, 2.0], [3.0, 4.0]]))
    assert look_up(np.array([-0.5, 0.5, -0.5, 0.5]), np.array([0.5, 0.5, -0.5, -0.5])).tolist() == [1, 2, 3, 4]
