"""Switching methods, moving the focus and asking for a depth draw no geometry that is already there: counted."""

from __future__ import annotations

from itertools import permutations

import pytest
from scenes import three_planes

from dofview.gl.context import Gpu
from dofview.lens import Lens
from dofview.methods import METHODS, method
from dofview.pipeline import Pipeline
from dofview.scene.camera import Camera
from dofview.settings import ImageSettings, Settings

NAMES = [name for name in METHODS if name != "accumulation"]
PER_LENS = {"splatting"}
"""Draws what a lens hides in every picture; the tests that find it are of that lens."""
LAYERS_ONLY = {"multiview"}
"""Draws no pinhole picture: the depths that its layers span, if they are not there, and the layers."""

SETTINGS = Settings(
    camera=Camera(), lens=Lens(radius=0.1, focus_distance=5.0), image=ImageSettings(size=(48, 36), guard_px=16)
)


@pytest.fixture(scope="module")
def pipeline(session_gpu: Gpu):
    pipeline = Pipeline(session_gpu, three_planes())
    yield pipeline
    pipeline.release()


@pytest.fixture(scope="module")
def alone(session_gpu: Gpu, pipeline: Pipeline) -> dict[str, int]:
    """Passes over the geometry that each method needs when nothing is there."""
    found = {}
    for name in NAMES:
        if session_gpu.version_code >= method(name).REQUIRES_GL:
            pipeline.forget()
            found[name] = pipeline.render(SETTINGS.with_(method=name)).counts["geometry passes"]
    return found


@pytest.mark.parametrize(("before", "after"), list(permutations(NAMES, 2)))
def test_the_pinhole_picture_is_drawn_once(
    gpu: Gpu, pipeline: Pipeline, alone: dict[str, int], before: str, after: str
):
    if not {before, after} <= alone.keys():
        pytest.skip("needs a newer OpenGL")
    pipeline.forget()
    pipeline.render(SETTINGS.with_(method=before))
    passes = pipeline.render(SETTINGS.with_(method=after)).counts.get("geometry passes", 0)
    assert passes == alone[after] - (0 if before in LAYERS_ONLY else 1)
    back = pipeline.render(SETTINGS.with_(method=before)).counts.get("geometry passes", 0)
    assert back == (alone[before] - 1 if before in PER_LENS else 0)


@pytest.mark.parametrize("name", NAMES)
def test_moving_the_focus_draws_no_geometry(gpu: Gpu, pipeline: Pipeline, alone: dict[str, int], name: str):
    if name not in alone:
        pytest.skip("needs a newer OpenGL")
    pipeline.forget()
    pipeline.render(SETTINGS.with_(method=name))
    moved = SETTINGS.with_(method=name, lens=Lens(radius=0.1, focus_distance=3.2))
    assert pipeline.inverse_depth(moved, 0.5, 0.5, 0.02) > 0.0
    passes = pipeline.render(moved).counts.get("geometry passes", 0)
    assert passes <= alone[name] - 1 if name in PER_LENS else passes == 0
