"""What lies outside the picture is not drawn, and the picture is the same as if it were."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

from dofview.framing import opening
from dofview.gl.context import Gpu
from dofview.methods import METHODS
from dofview.pipeline import Pipeline
from dofview.render.frame import FrameCache
from dofview.render.guard import guard_band
from dofview.render.raster import in_view
from dofview.render.reference import Reference
from dofview.render.upload import PIECE_TRIANGLES, GpuScene
from dofview.scene.load import load
from dofview.settings import Settings

SPEC = "demo:rail@60k"


@pytest.fixture(scope="module")
def rail(session_gpu: Gpu) -> Iterator[Pipeline]:
    pipeline = Pipeline(session_gpu, load(SPEC))
    yield pipeline
    pipeline.release()


def narrow(pipeline: Pipeline, method: str) -> Settings:
    """A long lens: most of the scene lies outside."""
    settings = opening(pipeline.scene.scene, SPEC)
    settings = settings.with_(
        method=method, image=settings.image.model_copy(update={"size": (96, 72)}),
        camera=settings.camera.model_copy(update={"vfov_deg": 6.0}),
    )  # fmt: skip
    return settings.with_params(views=8) if method == "accumulation" else settings


@pytest.mark.parametrize("name", METHODS)
def test_the_picture_is_the_same_without_what_lies_outside(gpu: Gpu, rail: Pipeline, name: str):
    pictures, counts = [], []
    for culling in (True, False):
        rail.scene.culling = culling
        rail.forget()
        result = rail.render(narrow(rail, name))
        pictures.append(result.pixels())
        counts.append(result.counts)
    rail.scene.culling = True
    assert counts[0]["pieces culled"] > 0 and "pieces culled" not in counts[1]
    assert counts[0]["triangles"] < counts[1]["triangles"]
    assert np.array_equal(*pictures)


def test_every_view_through_the_lens_is_inside_the_union_of_them(gpu: Gpu, rail: Pipeline):
    settings = narrow(rail, "accumulation")
    settings = settings.with_(lens=settings.lens.model_copy(update={"radius": settings.lens.radius * 20.0}))
    reference = Reference(rail.frame(settings, guard=False), antialias=True)
    union = covered(reference._draws.ranges)
    views = [
        reference._seen_from(tuple(np.array(point) * settings.lens.radius), jitter)
        for point, jitter in (reference._point(i) for i in range(64))
    ]
    seen = [covered(in_view(rail.scene, view).ranges) for view in views]
    assert all(one <= union for one in seen)
    assert len(union) < sum(draw.count for draw in rail.scene.draws) // 3
    assert any(one != seen[0] for one in seen), "the lens is wide enough for its views to differ"


def test_pieces_that_lie_together_are_drawn_at_once(rail: Pipeline):
    draws = rail.scene.draws
    assert all(draw.count <= 3 * PIECE_TRIANGLES for draw in draws)
    runs = rail.scene.runs(np.arange(len(draws)))
    assert len(runs) == len({draw.material for draw in draws}) < len(draws)
    assert sum(count for _, _, count in runs) == sum(draw.count for draw in draws)
    assert rail.scene.runs(np.array([], int)) == []
    assert len(rail.scene.runs(np.array([0, 2]))) == 2


def covered(ranges: list[tuple[int, int, int]]) -> set[int]:
    """The triangles of `ranges`, by number."""
    return {triangle for _, first, count in ranges for triangle in range(first // 3, (first + count) // 3)}


@pytest.mark.parametrize("name", ["foreground@20k", "background", "rail@20k", "highlights"])
def test_the_guard_band_looks_only_at_what_may_be_nearest(gpu: Gpu, monkeypatch: pytest.MonkeyPatch, name: str):
    """It comes out as wide as when everything is looked at, for lenses focused before, in and behind the scene."""
    pipeline = Pipeline(gpu, load(f"demo:{name}"))
    settings = opening(pipeline.scene.scene, f"demo:{name}").with_(image={"size": (320, 240)})
    lenses = [
        settings.lens.model_copy(update={"focus_distance": settings.lens.focus_distance * focus, "radius": radius})
        for focus in (0.3, 1.0, 4.0)
        for radius in (settings.lens.radius, 4.0 * settings.lens.radius)
    ]

    def widths() -> tuple[list[int], int]:
        found, triangles = [], 0
        for lens in lenses:
            gpu.profile.begin()
            found.append(guard_band(gpu, pipeline.scene, settings.camera, lens, (320, 240), FrameCache()))
            triangles += gpu.profile.counts["triangles"]
        return found, triangles

    found, drawn = widths()
    nothing_known = np.zeros, np.ones, lambda count: np.zeros(count, bool)
    monkeypatch.setattr(GpuScene, "depths", lambda _, numbers, __: tuple(make(len(numbers)) for make in nothing_known))
    everything, most = widths()
    assert found == everything and len(set(found)) > 1
    assert drawn < most or "@" not in name
    pipeline.release()
