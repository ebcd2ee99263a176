"""What a scene opens with: something to see, in focus somewhere, blurred elsewhere."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scenes import empty, quad, scene_of, three_planes, unlit

from dofview.errors import InputError
from dofview.framing import OPENING_BLUR, opening
from dofview.lens import focal_px
from dofview.scene import demo
from dofview.scene.model import SceneCamera

LOOKING_DOWN_Z = np.array([[1.0, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 9], [0, 0, 0, 1]])


@pytest.mark.parametrize("name", demo.DEMOS)
def test_a_demo_scene_brings_its_view(name: str):
    settings = opening(demo.build(f"{name}@8k"), f"demo:{name}@8k")
    view = demo.view(name)
    assert settings.camera.position == tuple(view["camera"]["position"])
    assert settings.lens.radius == view["lens"]["radius"]
    assert settings.image.size == tuple(view["image"]["size"])
    assert settings.background_linear == tuple(view["background_linear"])


def test_the_first_camera_of_a_file_is_used_and_others_can_be_asked_for():
    turned = LOOKING_DOWN_Z.copy()
    turned[:3, 3] = (1.0, 0.0, 4.0)
    cameras = (SceneCamera("wide", LOOKING_DOWN_Z, 70.0, 0.1), SceneCamera("close", turned, 30.0, 0.1))
    scene = replace(three_planes(), cameras=cameras)
    assert opening(scene).camera.vfov_deg == 70.0 and opening(scene).camera.position == (0.0, 0.0, 9.0)
    for asked in ("close", "1"):
        assert opening(scene, camera=asked).camera.vfov_deg == 30.0
    with pytest.raises(InputError, match=r"accepted: 0 \(wide\), 1 \(close\)"):
        opening(scene, camera="far")
    with pytest.raises(InputError, match="the file has no camera"):
        opening(three_planes(), camera="0")


def test_without_a_camera_all_of_the_scene_is_seen():
    scene = three_planes()
    camera = opening(scene).camera
    low, high = scene.bounds
    corners = np.array([[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])])
    seen = (corners - camera.position) @ camera.axes().T
    depth = -seen[:, 2]
    assert (depth > 0).all()
    assert (np.hypot(seen[:, 0], seen[:, 1]) / depth <= np.tan(np.radians(camera.vfov_deg / 2)) * 1.25).all()


@pytest.mark.parametrize("shift", [0.0, 1e6])
@pytest.mark.parametrize("size", [1e-3, 1.0, 1e3])
def test_the_lens_blurs_by_the_same_share_of_the_picture_at_every_scale(size: float, shift: float):
    boxes = [quad((shift, 0, -3 * size), (2 * size, size), 0), quad((shift, 0, 2 * size), (size, size), 0)]
    settings = opening(scene_of(boxes, [unlit(0.5, 0.5, 0.5)]))
    height = settings.image.size[1]
    law = settings.lens.coc(focal_px(height, settings.camera.vfov_deg))
    position, axes = np.array(settings.camera.position), settings.camera.axes()
    depths = [float((position - [shift, 0, z * size]) @ axes[2]) for z in (-3, 2)]
    largest = max(abs(float(law.radius_px(1.0 / depth))) for depth in depths)
    assert 0.3 * OPENING_BLUR <= largest / height <= OPENING_BLUR * 1.001


@pytest.mark.parametrize("scene", [empty(), scene_of([quad((0, 0, 0), (0, 0), 0)], [unlit(1, 1, 1)])])
def test_a_scene_of_nothing_still_opens(scene):
    settings = opening(scene)
    assert np.isfinite(settings.lens.radius) and settings.lens.focus_distance > 0


@pytest.mark.parametrize("size", [1e-43, 1e-20, 1e-3, 1e6, 1e15, 1e18, 1e30])
@pytest.mark.parametrize("shift", [0.0, 1e6, 1e18])
def test_any_finite_scene_opens(size: float, shift: float):
    matrix = np.diag([size, size, size, 1.0])
    matrix[:3, 3] = shift
    scene = three_planes()
    scene = replace(scene, instances=tuple(replace(i, matrix=matrix) for i in scene.instances), _bounds=[])
    at_once = replace(scene, cameras=(SceneCamera("there", np.array(matrix) / [size, size, size, 1.0], 40.0, 0.1),))
    for opened in (opening(scene), opening(at_once)):
        assert opened.camera.distance > 0.0 and np.isfinite(opened.camera.axes()).all()
        assert 0.0 <= opened.lens.radius < opened.lens.focus_distance < np.inf
