"""One OpenGL context for the whole run; every test that uses it must leave no GL error behind."""

from __future__ import annotations

import os
from collections.abc import Iterator

import pytest

# llvmpipe rasterises in the calling thread: with a thread of its own it crashed in 4 of 70 runs of one test file (Mesa
# 22.3.6, inside a clear, the heap already damaged), without one in none; small pictures are no slower.
os.environ.setdefault("LP_NUM_THREADS", "0")

from dofview.gl.context import Gpu, create_headless  # noqa: E402
from dofview.pipeline import Pipeline  # noqa: E402
from dofview.scene.demo import build  # noqa: E402

_made: list[Gpu] = []


@pytest.fixture(scope="session")
def session_gpu() -> Iterator[Gpu]:
    gpu = create_headless()
    _made.append(gpu)
    yield gpu
    _made.remove(gpu)
    gpu.release()


@pytest.fixture(autouse=True)
def _current_context() -> Iterator[None]:
    """A command run in this process makes a context of its own and lets it go; the session's is current again."""
    yield
    for gpu in _made:
        gpu.ctx.__enter__()


@pytest.fixture
def gpu(session_gpu: Gpu) -> Iterator[Gpu]:
    """The session's context, with a clean error state before and after."""
    assert session_gpu.ctx.error == "GL_NO_ERROR"
    yield session_gpu
    assert session_gpu.ctx.error == "GL_NO_ERROR"


@pytest.fixture(scope="module")
def demos(session_gpu: Gpu) -> Iterator[dict[str, Pipeline]]:
    """The three demo scenes that methods are judged on, by name."""
    pipelines = {name: Pipeline(session_gpu, build(name)) for name in ("foreground", "background", "rail")}
    yield pipelines
    for pipeline in pipelines.values():
        pipeline.release()
