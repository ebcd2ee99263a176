"""Fetches are counted as they are made, and no method makes many more than its page derives."""

from __future__ import annotations

import numpy as np
import pytest

from dofview.bench import fetches
from dofview.bench.derived import DERIVED
from dofview.bench.measure import Bench
from dofview.bench.plan import UNMEASURED
from dofview.gl.context import Gpu
from dofview.gl.fetches import REQUIRED, CountingLibrary, counting
from dofview.gl.gaussian import convolve
from dofview.gl.passes import draw
from dofview.methods import METHODS
from dofview.pipeline import Pipeline
from dofview.scene.load import load
from dofview.settings import Settings

SMALL = (96, 72)


@pytest.fixture
def counter(gpu: Gpu):
    """The shaders of `gpu`, counting."""
    if gpu.version_code < REQUIRED:
        pytest.skip("needs OpenGL 4.3")
    own, gpu.shaders = gpu.shaders, CountingLibrary(gpu.ctx)
    yield gpu.shaders
    gpu.shaders.release()
    gpu.shaders = own


@pytest.mark.parametrize("size", [(1, 1), (7, 5), (64, 48)])
def test_every_fetch_of_every_pixel_is_counted(gpu: Gpu, counter: CountingLibrary, size: tuple[int, int]):
    source, into = gpu.targets.image("source", size), gpu.targets.image("into", size)
    draw(gpu, "pass/copy.frag", into, textures={"source": source})
    convolve(gpu, source, into, (0.4, 0.2, 0.1), (1, 0))
    found = {one.shader: (one.fragments, one.fetches) for one in counter.counts()}
    pixels = size[0] * size[1]
    assert found == {"pass/copy.frag": (pixels, pixels), "pass/gaussian.frag": (pixels, 5 * pixels)}
    counter.clear()
    assert not counter.counts()


def test_only_calls_are_counted():
    text = (
        "#version 410 core\nvec4 f() { return mix(texelFetch(a, ivec2(texture(b, p).r, 0), 0), c, textureSize(a).x); }"
    )
    assert counting(text, 3).splitlines()[-1] == (
        "vec4 f() { return mix((atomicAdd(counted_[3].y, 1u), texelFetch(a, ivec2((atomicAdd(counted_[3].y, 1u), "
        "texture(b, p)).r, 0), 0)), c, textureSize(a).x); }"
    )


@pytest.mark.parametrize("name", [name for name in METHODS if name != "pinhole"])
def test_counting_does_not_change_the_picture(gpu: Gpu, name: str, request: pytest.FixtureRequest):
    settings = Settings(method=name).with_(image={"size": SMALL})
    settings = settings.with_params(views=4) if name == "accumulation" else settings
    pipeline = Pipeline(gpu, load("demo:crossing"))
    plain = pipeline.render(settings).pixels()
    request.getfixturevalue("counter")
    pipeline.forget()
    assert np.array_equal(pipeline.render(settings).pixels(), plain)
    pipeline.release()


def test_every_method_that_is_measured_has_a_derivation():
    assert set(DERIVED) == {name for name in METHODS if name not in UNMEASURED} | {"accumulation"}


@pytest.mark.parametrize("scene", fetches.SCENES)
def test_no_method_fetches_many_more_than_its_page_derives(gpu: Gpu, scene: str):
    """Nor less than half: then the page would say nothing."""
    if gpu.version_code < REQUIRED:
        pytest.skip("needs OpenGL 4.3")
    bench = Bench()
    try:
        ratios = {name: fetches.count(bench, scene, name, SMALL).ratio for name in DERIVED}
    finally:
        bench.release()
    assert max(ratios.values()) <= fetches.MOST_RATIO, ratios
    assert min(ratios.values()) >= 0.5, ratios
