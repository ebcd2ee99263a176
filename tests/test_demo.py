"""The demo scenes keep what they promise: circles of confusion, a filled frame, triangle counts, no chance."""

from __future__ import annotations

import importlib.util
import json
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from dofview.errors import ModelError
from dofview.scene import demo
from dofview.scene.camera import Camera
from dofview.scene.demo import shapes, texels
from dofview.scene.load import load
from dofview.scene.model import Scene

NAMES = tuple(demo.DEMOS)
ASSETS = Path(__file__).resolve().parents[1] / "assets"
GUARD = 1.08  # the picture and 4 % of its size beyond every edge, which is what the widest blur brings in


@cache
def built(name: str) -> Scene:
    return demo.build(name)


def project(positions: np.ndarray, view: dict) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """x and y in -1..1 over the picture and the depth along the view axis."""
    camera, (width, height) = Camera(**view["camera"]), view["image"]["size"]
    matrix = camera.view_matrix()
    eye = positions.astype(np.float64) @ matrix[:3, :3].T + matrix[:3, 3]
    scale = 1 / np.tan(np.radians(camera.vfov_deg) / 2)
    return eye[..., 0] / -eye[..., 2] * scale * height / width, eye[..., 1] / -eye[..., 2] * scale, -eye[..., 2]


def coc(depth: np.ndarray, view: dict) -> np.ndarray:
    """Signed radius in pixels."""
    focal = view["image"]["size"][1] / 2 / np.tan(np.radians(view["camera"]["vfov_deg"]) / 2)
    return view["lens"]["radius"] * focal * (1 / view["lens"]["focus_distance"] - 1 / depth)


@cache
def inverse_depth(name: str, size: tuple[int, int] = (128, 96)) -> np.ndarray:
    """1/z of what is seen over the guarded frame, 0 where nothing is, by points thrown on all triangles."""
    rng, view = np.random.default_rng(0), demo.view(name)
    buffer = np.zeros(size[0] * size[1])
    for primitive in built(name).primitives:
        x, y, depth = project(primitive.positions[primitive.triangles], view)
        assert depth.min() > 0
        px, py = (x / GUARD + 1) * size[0] / 2, (1 - y / GUARD) * size[1] / 2
        (ax, bx), (ay, by) = ((p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]) for p in (px, py))
        area = np.abs(ax * by - ay * bx) / 2
        seen = (px.max(1) > 0) & (px.min(1) < size[0]) & (py.max(1) > 0) & (py.min(1) < size[1])
        index = np.repeat(np.arange(len(area)), np.where(seen, np.ceil(area * 12).astype(int), 0))
        weight = rng.dirichlet((1, 1, 1), len(index))
        # Over the screen 1/z is what is linear.
        column, row, inverse = (np.sum(weight * a[index], axis=1) for a in (px, py, 1 / depth))
        inside = (column >= 0) & (column < size[0]) & (row >= 0) & (row < size[1])
        cell = row[inside].astype(int) * size[0] + column[inside].astype(int)
        np.maximum.at(buffer, cell, inverse[inside])
    return buffer.reshape(size[::-1])


@pytest.mark.parametrize("name", NAMES)
def test_circles_of_confusion_are_as_promised(name):
    view, (low, high) = demo.view(name), demo.DEMOS[name].coc
    seen = inverse_depth(name)
    rows, columns = (round(n * (1 - 1 / GUARD) / 2) for n in seen.shape)
    inner = seen[rows:-rows, columns:-columns]
    radius = coc(1 / inner[inner > 0], view)
    assert low - 0.1 <= radius.min() <= low + 1.0
    assert high - 1.0 <= radius.max() <= high + 0.1
    assert coc(1 / seen[seen > 0], view).min() >= 1.12 * low - 0.1


@pytest.mark.parametrize("name", NAMES)
def test_frame_and_guard_band_are_filled(name):
    assert np.mean(inverse_depth(name) > 0) > 0.998


@pytest.mark.parametrize("name", NAMES)
def test_focus_holds_a_share_of_the_picture(name):
    seen = inverse_depth(name)
    share = np.mean(np.abs(coc(1 / seen[seen > 0], demo.view(name))) < 1.0)
    assert share > (0.002 if name == "crossing" else 0.03)


@pytest.mark.parametrize("name", NAMES)
def test_arrays_are_sound_and_textured(name):
    scene = built(name)
    assert 4_000 <= scene.triangle_count <= 26_000
    assert len(scene.cameras) == 1 and scene.warnings == ()
    for primitive in scene.primitives:
        material = scene.materials[primitive.material]
        assert material.base_color_texture is not None or max(material.emissive) == 50.0
        uv, colors = primitive.texcoords[0], primitive.colors
        if colors is not None:
            assert colors.dtype == np.float32 and colors.min() >= 0 and colors.max() <= 1 and np.ptp(colors) > 0.05
        assert primitive.positions.dtype == primitive.normals.dtype == uv.dtype == np.float32
        assert primitive.triangles.dtype == np.uint32 and primitive.triangles.max() < len(primitive.positions)
        assert np.isfinite(primitive.positions).all() and np.isfinite(uv).all()
        assert np.abs(np.linalg.norm(primitive.normals, axis=1) - 1).max() < 1e-5


@pytest.mark.parametrize("name", NAMES)
def test_triangles_turn_the_way_normals_point(name):
    for primitive in built(name).primitives:
        a, b, c = (primitive.positions[primitive.triangles[:, k]].astype(np.float64) for k in range(3))
        face = np.cross(b - a, c - a)
        turned = np.sum(face * primitive.normals[primitive.triangles].sum(axis=1), axis=1)
        assert np.linalg.norm(face, axis=1).min() > 0
        assert np.mean(turned > 0) > 0.99, primitive.name


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize(("suffix", "count"), [("@46k", 46_000), ("@216k", 216_000), ("@67.5k", 67_500)])
def test_triangle_switch_is_within_a_tenth(name, suffix, count):
    assert demo.build(name + suffix).triangle_count == pytest.approx(count, rel=0.1)


def test_a_million_triangles_are_the_same_shapes():
    scene = demo.build("background@1m")
    assert scene.triangle_count == pytest.approx(1_000_000, rel=0.1)
    assert np.allclose(scene.bounds, built("background").bounds, atol=0.02)


@pytest.mark.parametrize("name", NAMES)
def test_built_twice_is_the_same(name):
    once, twice = demo.build(name), demo.build(name)
    for a, b in zip(once.primitives, twice.primitives, strict=True):
        assert a.positions.tobytes() == b.positions.tobytes() and a.triangles.tobytes() == b.triangles.tobytes()
    for a, b in zip(once.materials, twice.materials, strict=True):
        if a.base_color_texture:
            assert np.array_equal(a.base_color_texture.picture.pixels, b.base_color_texture.picture.pixels)


@pytest.mark.parametrize("name", ["", "nothing", "rail@", "rail@0", "rail@10", "rail@9m", "rail@-5k", "rail@1g"])
def test_names_that_are_not_there_are_refused_in_one_line(name):
    with pytest.raises(ModelError) as error:
        demo.build(name)
    assert "accepted" in str(error.value) and "\n" not in str(error.value)


@pytest.mark.parametrize("name", NAMES)
def test_view_is_a_view_file(name):
    view = demo.view(f"{name}@46k")
    assert json.loads(json.dumps(view)) == view == demo.view(name)
    assert Camera(**view["camera"]).vfov_deg == 40 and view["image"]["size"] == [512, 384]
    view["lens"]["radius"] = -1
    assert demo.view(name)["lens"]["radius"] > 0


def test_highlights_are_small_bright_and_behind_focus():
    scene, view = built("highlights"), demo.view("highlights")
    lamps = [p for p in scene.primitives if max(scene.materials[p.material].emissive) == 50.0]
    assert any(scene.materials[p.material].emissive == (50.0, 50.0, 50.0) for p in lamps)
    for lamp in lamps:
        x, _, depth = project(lamp.positions, view)
        assert coc(depth, view).min() > 6
        triangles = x[lamp.triangles] * view["image"]["size"][0] / 2
        assert np.ptp(triangles, axis=1).max() < 4  # pixels: none of the lamps' facets, nor the lamps, are large


def test_surfaces_close_and_carry_their_analytic_normals():
    ball = shapes.place(shapes.sphere(0.5, (96, 64)), (1, 2, 3), (10, 20, 30), 2.0)
    positions, normals, _, triangles = ball[0].mesh(1.0)
    assert np.allclose(positions, normals + (1, 2, 3), atol=1e-12)
    a, b, c = (positions[triangles[:, k]] - (1, 2, 3) for k in range(3))
    assert np.sum(a * np.cross(b, c)) / 6 == pytest.approx(4 / 3 * np.pi, rel=0.01)
    others = (
        shapes.lathe(((0, 0), (1, 0.2), (0.4, 1), (0, 1.4)), (64, 64)),
        shapes.tube(((0, 0, 0), (1, 1, 0), (2, 0, 1)), 0.1, (48, 96)),
        shapes.box((1, 2, 3), 0.2, 24),
        shapes.torus(1, 0.3, (64, 48)),
    )
    for patch in sum(others, ()):
        positions, normals, _, triangles = patch.mesh(1.0)
        a, b, c = (positions[triangles[:, k]] for k in range(3))
        face = np.cross(b - a, c - a)
        face /= np.linalg.norm(face, axis=1, keepdims=True)
        assert np.sum(face * normals[triangles[:, 0]], axis=1).min() > 0.9


def test_noise_is_periodic_and_one_over_f():
    field = texels.noise(3, 1.0)
    assert np.abs(field[:, 0] - field[:, -1]).mean() < 1.5 * np.abs(np.diff(field, axis=1)).mean()
    power = np.abs(np.fft.rfft2(field - field.mean())) ** 2
    radius = np.hypot(np.fft.fftfreq(512)[:, None], np.fft.rfftfreq(512)[None, :]) * 512
    low, high = (power[(radius > r) & (radius < 2 * r)].mean() for r in (8, 64))
    assert low / high == pytest.approx(64, rel=0.3)  # power falls as 1/f², over three octaves


@cache
def scene_files():
    spec = importlib.util.spec_from_file_location("make_scenes", ASSETS / "make_scenes.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def same_surface(kept: Scene, made: Scene, tolerance: float) -> None:
    """Corner by corner, whatever the order of vertices: positions, normals, texture coordinates, colours."""
    assert kept.warnings == () and len(kept.primitives) == len(made.primitives)
    for instance, b in zip(kept.instances, made.primitives, strict=True):
        a = kept.primitives[instance.primitive]
        corners, others = a.triangles.ravel(), b.triangles.ravel()
        placed = a.positions[corners] @ instance.matrix[:3, :3].T + instance.matrix[:3, 3]
        assert np.allclose(placed, b.positions[others], atol=tolerance)
        assert np.allclose(a.normals[corners], b.normals[others], atol=10 * tolerance)
        assert np.allclose(a.texcoords[0][corners], b.texcoords[0][others], atol=tolerance)
        if a.colors is not None:
            assert np.allclose(a.colors[corners], b.colors[others], atol=1e-6)


@pytest.mark.parametrize("name", ["foreground", "background", "rail", "highlights"])
def test_kept_glb_is_what_the_script_makes_and_reads_back_whole(name):
    path = ASSETS / "scenes" / f"{name}.glb"
    assert path.stat().st_size < 1_000_000
    kept, made = load(path), demo.build(name + scene_files().GLB_TRIANGLES)
    same_surface(kept, made, 1e-5)
    for a, b in zip(kept.materials, made.materials, strict=True):
        assert (a.name, a.unlit, a.metallic, a.roughness) == (b.name, b.unlit, b.metallic, b.roughness)
        assert np.allclose(a.emissive, b.emissive, rtol=1e-6) and np.allclose(a.base_color, b.base_color)
        if b.base_color_texture:
            drawn = a.base_color_texture.picture.pixels.astype(float)[..., :3]
            full = b.base_color_texture.picture.pixels.astype(float)[..., :3]
            half = full.reshape(drawn.shape[0], 2, drawn.shape[1], 2, 3).mean(axis=(1, 3))
            assert np.abs(drawn - half).mean() < 8, a.name  # of 255: 64 colours
    assert np.allclose(kept.cameras[0].matrix, made.cameras[0].matrix, atol=1e-9)
    assert kept.cameras[0].vfov_deg == pytest.approx(40)


def test_kept_obj_is_what_the_script_makes_and_reads_back_whole():
    files = scene_files()
    kept, made = load(ASSETS / "scenes" / "chess.obj"), files.chess()
    assert sum(path.stat().st_size for path in (ASSETS / "scenes").glob("chess*")) < 300_000
    same_surface(kept, made, 2e-4)
    for a, b in zip(kept.materials, made.materials, strict=True):
        assert (a.name, a.roughness, a.metallic) == (b.name, b.roughness, 0.0)
        assert a.base_color_texture is not None


@pytest.mark.parametrize("name", [*NAMES, "chess"])
def test_kept_view_files_are_the_views(name):
    kept = json.loads((ASSETS / "scenes" / f"{name}.json").read_text())
    assert kept == (scene_files().CHESS_VIEW if name == "chess" else demo.view(name))
