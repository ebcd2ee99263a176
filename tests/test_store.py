"""What the viewer remembers: read whole or as far as it is right, written whole or not at all."""

from __future__ import annotations

import json
import os
from pathlib import Path

import numpy as np
import pytest

from dofview.scene import navigation
from dofview.scene.camera import Camera
from dofview.settings import Settings, apply_view, view_of
from dofview.viewer.store import MOST_RECENT, MOST_VIEWS, Interface, Saved, Store, Theme


def test_what_is_saved_is_there_the_next_day(tmp_path: Path):
    path = tmp_path / "a" / "b" / "viewer.json"
    store = Store(path)
    store.change(lambda saved: saved.opened("one.glb").opened("two.glb").opened("one.glb"))
    store.change(lambda saved: saved.seen("one.glb", {"lens": {"radius": 0.5}}))
    store.change(lambda saved: saved.model_copy(update={"interface": Interface(scale=1.5, theme=Theme.LIGHT)}))
    again = Store(path)
    assert again.saved == store.saved and not again.problem
    assert again.saved.recent == ("one.glb", "two.glb") and again.saved.interface.scale == 1.5
    assert [p.name for p in path.parent.iterdir()] == ["viewer.json"], "nothing half-written is left"


def test_two_windows_do_not_lose_each_others_files(tmp_path: Path):
    one, two = Store(tmp_path / "v.json"), Store(tmp_path / "v.json")
    one.change(lambda saved: saved.opened("one.glb"))
    two.change(lambda saved: saved.opened("two.glb"))
    assert Store(tmp_path / "v.json").saved.recent == ("two.glb", "one.glb")


def test_it_does_not_grow_without_end():
    saved = Saved()
    for number in range(300):
        saved = saved.opened(f"{number}.glb").seen(f"{number}.glb", {})
    assert len(saved.recent) == MOST_RECENT and saved.recent[0] == "299.glb"
    assert len(saved.views) == MOST_VIEWS and "299.glb" in saved.views and "0.glb" not in saved.views


@pytest.mark.parametrize("content", [b"", b"{", b"[1]", b"\xff\xfe", b"[" * 100_000, b"null", b'{"recent": 5}'])
def test_a_broken_file_is_begun_anew(tmp_path: Path, content: bytes):
    path = tmp_path / "v.json"
    path.write_bytes(content)
    store = Store(path)
    assert store.saved == Saved() and "\n" not in store.problem
    store.change(lambda saved: saved.opened("x.glb"))
    assert Store(path).saved.recent == ("x.glb",)


def test_what_is_right_in_a_file_is_kept(tmp_path: Path):
    path = tmp_path / "v.json"
    path.write_text(json.dumps({"recent": ["a.glb"], "interface": {"scale": 1e999}, "later": 1}))
    store = Store(path)
    assert store.saved == Saved(recent=("a.glb",)) and "interface" in store.problem


def test_a_place_that_cannot_be_written_is_named(tmp_path: Path):
    (tmp_path / "file").write_text("")
    store = Store(tmp_path / "file" / "v.json")
    store.change(lambda saved: saved.opened("x.glb"))
    assert store.saved.recent == ("x.glb",) and "cannot" in store.problem


def test_safe_means_no_file(tmp_path: Path):
    before = sorted(os.listdir(tmp_path))
    Store(None).change(lambda saved: saved.opened("x.glb"))
    assert sorted(os.listdir(tmp_path)) == before


def test_a_view_as_text_is_the_same_view():
    settings = Settings(camera=Camera(position=(0.1, 1 / 3, 5.0), vfov_deg=33.3))
    settings = settings.with_(lens=settings.lens.model_copy(update={"focus_distance": float("inf"), "radius": 0.1}))
    text = json.dumps(view_of(settings))
    assert apply_view(Settings(), json.loads(text), "text") == settings


@pytest.mark.parametrize("share", [0.0, 0.25, 0.5, 1.0])
def test_between_two_views_the_distance_grows_in_proportion(share: float):
    a, b = Camera(position=(0, 0, 2)), Camera(position=(8, 0, 0), vfov_deg=20.0)
    camera = navigation.between(a, b, share)
    assert camera.distance == pytest.approx(2.0 * 4.0**share) and np.allclose(camera.target, (0, 0, 0))
    angle = np.degrees(np.arctan2(camera.position[0], camera.position[2]))
    assert angle == pytest.approx(90.0 * share) and camera.vfov_deg == pytest.approx(45.0 - 25.0 * share)


def test_looking_elsewhere_moves_nothing_but_the_target():
    a = Camera(position=(1, 2, 3), target=(1, 2, -3))
    b = a.model_copy(update={"target": (9.0, 2.0, 3.0)})
    for share in (0.2, 0.7):
        assert navigation.between(a, b, share).position == a.position
    assert navigation.between(a, b, 1.0) == b


def test_between_opposite_views_there_is_a_way():
    a, b = Camera(position=(0, 0, 5)), Camera(position=(0, 0, -5), up=(0, -1, 0))
    for share in np.linspace(0.0, 1.0, 11):
        camera = navigation.between(a, b, float(share))
        assert np.isfinite(camera.axes()).all() and camera.distance == pytest.approx(5.0)
