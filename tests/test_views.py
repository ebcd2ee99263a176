"""View files: what they mean, and that any numbers at all give a finite picture or one line."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from scenes import three_planes

from dofview.errors import SettingsError
from dofview.gl.context import Gpu
from dofview.lens import Distribution
from dofview.methods import METHODS
from dofview.pipeline import Pipeline
from dofview.settings import Settings, apply_view, read_view

EDGES = [0, -0.0, 1, -1, 1e-300, 5e-324, 1e300, 1.7e308, -1e308, 1e38, 1e-38, 1e19, 1e12, 1e-12, 0.5, 45, 178.99]
NUMBER = st.one_of(st.sampled_from([*EDGES, float("inf"), float("nan")]), st.floats(-5.0, 5.0))
VECTOR = st.lists(NUMBER, min_size=3, max_size=3)
VIEW = st.fixed_dictionaries({}, optional={
    "camera": st.fixed_dictionaries({}, optional={
        "position": VECTOR, "target": VECTOR, "up": VECTOR, "vfov_deg": NUMBER, "near": NUMBER, "far": NUMBER}),
    "lens": st.fixed_dictionaries({}, optional={
        "radius": NUMBER, "focus_distance": NUMBER, "gaussian_sigma": NUMBER, "rotation_deg": NUMBER,
        "distribution": st.sampled_from(["uniform_disc", "gaussian", "polygon"]), "blades": st.integers(2, 33)}),
    "background_linear": VECTOR,
})  # fmt: skip


@pytest.mark.parametrize("name", METHODS)
def test_any_numbers_give_a_finite_picture_or_one_line(gpu: Gpu, name: str):
    pipeline = Pipeline(gpu, three_planes())
    base = Settings().with_(method=name, image={"size": (16, 12)})
    base = base.with_params(views=2) if name == "accumulation" else base

    @settings(max_examples=40, deadline=None, derandomize=True, suppress_health_check=list(HealthCheck))
    @given(VIEW)
    def holds(view: dict) -> None:
        try:
            chosen = apply_view(base, view, "view.json")
        except SettingsError as error:
            assert str(error).startswith("view.json: ") and "\n" not in str(error)
            return
        assert np.isfinite(pipeline.render(chosen).pixels()).all()
        pipeline.forget()

    holds()
    pipeline.release()


def test_what_is_said_is_taken_and_the_rest_stays(tmp_path: Path):
    base = Settings().with_(method="pinhole", image={"size": (10, 20), "scale": 2.0})
    view = {
        "camera": {"position": [1, 2, 3], "extra": 1},
        "lens": {"radius": 2, "distribution": "gaussian"},
        "image": {"size": [30, 40], "scale": 1.0},
        "method": "accumulation",
    }
    (tmp_path / "view.json").write_text(json.dumps(view), encoding="utf-8-sig")
    read = read_view(tmp_path / "view.json", base)
    assert read.camera.position == (1, 2, 3) and read.camera.target == base.camera.target
    assert read.lens.radius == 2 and read.lens.distribution == Distribution.GAUSSIAN
    assert read.lens.sigma_fraction == 0.5 and read.lens.matched_sigma_fraction == 0.5
    assert read.image.size == (30, 40)
    assert (read.image.scale, read.method, read.background_linear) == (2.0, "pinhole", base.background_linear)


def test_a_gaussian_method_matches_what_the_view_asks_for():
    """σ of the view for a Gaussian lens; 0.55 of the radius for a disc."""
    lens = apply_view(Settings(), {"lens": {"radius": 2, "distribution": "gaussian", "gaussian_sigma": 0.5}}, "v").lens
    assert lens.matched_sigma_fraction == 0.25
    disc = apply_view(Settings(), {"lens": {"radius": 2}}, "v").lens
    assert disc.matched_sigma_fraction == pytest.approx(0.55)


def test_a_picture_is_looked_for_beside_the_view_file(tmp_path: Path):
    (tmp_path / "star.png").write_bytes(b"")
    (tmp_path / "view.json").write_text('{"lens": {"distribution": "image", "image": "star.png"}}')
    assert Path(read_view(tmp_path / "view.json", Settings()).lens.image) == tmp_path / "star.png"
