"""PLY, STL and OFF: what trimesh writes is read as it was, and broken bytes are refused in one line."""

from __future__ import annotations

import random
from pathlib import Path

import numpy as np
import pytest
import trimesh
from mutations import mutated_bytes
from test_load_hostile import load_or_refuse

from dofview.errors import ModelError
from dofview.metrics import srgb_decode
from dofview.scene.limits import Limits
from dofview.scene.load import load

BALL = trimesh.creation.icosphere(subdivisions=2, radius=2.0)
FAR = np.array([5e6, 0.0, -3e6])


@pytest.mark.parametrize("suffix", ["ply", "stl", "off"])
def test_a_ball_is_read_as_it_was_written(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"ball.{suffix}"
    BALL.copy().apply_translation(FAR).export(path)
    scene = load(path)
    assert scene.triangle_count == len(BALL.faces) and scene.warnings == ()
    (primitive,), (instance,) = scene.primitives, scene.instances
    world = primitive.positions[primitive.triangles] + instance.matrix[:3, 3]
    # STL and binary PLY hold float32: half a unit at five million.
    np.testing.assert_allclose(np.linalg.norm(world - FAR, axis=-1), 2.0, atol=0.8)
    outward = (world.mean(axis=1) - FAR) * primitive.normals[primitive.triangles].mean(axis=1)
    assert outward.sum(axis=-1).min() > 0


def test_colours_of_vertices_become_linear(tmp_path: Path) -> None:
    mesh = BALL.copy()
    mesh.visual.vertex_colors = np.tile(np.uint8([200, 100, 50, 255]), (len(mesh.vertices), 1))
    mesh.export(tmp_path / "a.ply")
    (primitive,) = load(tmp_path / "a.ply").primitives
    expected = srgb_decode(np.array([200, 100, 50]) / 255.0)
    np.testing.assert_allclose(primitive.colors[0, :3], expected, rtol=1e-5)


@pytest.mark.parametrize(
    ("text", "what"),
    [
        ("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n", "face|vertex|readable"),
        ("OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n", "no faces|readable"),
        ("", "readable|no faces"),
    ],
)
def test_what_is_wrong_is_said(tmp_path: Path, text: str, what: str) -> None:
    (tmp_path / "a.off").write_text(text)
    with pytest.raises(ModelError, match=what):
        load(tmp_path / "a.off")


def test_faces_without_a_place_are_left_out(tmp_path: Path) -> None:
    (tmp_path / "a.off").write_text("OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\nnan 0 0\n3 0 1 2\n3 0 1 3\n")
    scene = load(tmp_path / "a.off")
    assert scene.triangle_count == 1 and scene.warnings == ("1 face with a corner that is not finite, left out",)


def test_limits_hold(tmp_path: Path) -> None:
    BALL.export(tmp_path / "a.ply")
    with pytest.raises(ModelError, match="limit triangles"):
        load(tmp_path / "a.ply", Limits(triangles=100))


@pytest.mark.parametrize("suffix", ["ply", "stl", "off"])
def test_broken_bytes_are_refused_or_read(tmp_path: Path, suffix: str) -> None:
    rng = random.Random(7)
    path = tmp_path / f"a.{suffix}"
    data = trimesh.creation.box().export(file_type=suffix)
    data = data.encode() if isinstance(data, str) else data
    for _ in range(150):
        path.write_bytes(mutated_bytes(data, rng))
        load_or_refuse(path)
    for length in range(0, len(data), max(1, len(data) // 60)):
        path.write_bytes(data[:length])
        load_or_refuse(path)
