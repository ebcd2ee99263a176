"""Long runs: the same thing hundreds of times, after which nothing may be left over.

Memory is compared at one place: at rest, when every method has drawn the same small picture and that is finished.
"""

from __future__ import annotations

import itertools
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

import numpy as np

from dofview import export
from dofview.errors import ModelError, SettingsError
from dofview.gl.context import Gpu
from dofview.lens import Lens
from dofview.methods import METHODS, method
from dofview.pipeline import Pipeline
from dofview.record.paths import still
from dofview.record.run import record
from dofview.scene.load import load
from dofview.settings import ImageSettings, Settings
from dofview.stress import shapes
from dofview.stress.bench import CAMERA
from dofview.stress.living import Alive, alive

WARM_UP = 100
"""Until then shader variants are still coming, which are kept on purpose."""
MOST_KB = 5.0
"""Growth per cycle that is taken for noise."""
LARGEST = (1920, 270)
SIZE = (96, 64)
NAMES = ("resize", "switch", "reload", "reload a broken file", "record", "screenshot")


class Growth(NamedTuple):
    """What a run of `cycles` left behind."""

    name: str
    cycles: int
    objects: int
    kb_per_cycle: float
    files: int
    threads: int
    children: int

    @property
    def held(self) -> bool:
        """Whether nothing is left over."""
        counts = (self.objects, self.files, self.threads, self.children)
        return max(counts) <= 0 and self.kb_per_cycle <= MOST_KB


class Run:
    """A pipeline with a small scene from a file, and a folder for what is written."""

    def __init__(self, gpu: Gpu, folder: Path, seed: int):
        self.gpu = gpu
        self.folder = folder
        self.random = np.random.default_rng(seed)
        self.model, self.broken = folder / "scene.obj", folder / "broken.glb"
        self.model.write_text(_model(self.random))
        self.broken.write_bytes(b"glTF\2\0\0\0" + bytes(range(200)))
        self.pipeline = Pipeline(gpu, load(self.model))
        self.methods: Iterator[str] = iter(())
        self.begin()

    def begin(self) -> int:
        """Begin with the first method again; how many there are."""
        names = [name for name in METHODS if self.gpu.version_code >= method(name).REQUIRES_GL]
        self.methods = itertools.cycle(names)
        return len(names)

    def settings(self, size: tuple[int, int] = SIZE) -> Settings:
        """The next method in turn."""
        settings = Settings(
            camera=CAMERA, lens=Lens(radius=0.1, focus_distance=5.0), method=next(self.methods),
            image=ImageSettings(size=size),
        )  # fmt: skip
        return settings.with_params(views=2) if settings.method == "accumulation" else settings

    def resize(self, narrower: int = 0) -> None:
        width, height = (int(self.random.integers(1, side + 1)) for side in LARGEST)
        self.pipeline.render(self.settings((max(width - narrower, 1), height)))

    def resize_beforehand(self, cycles: int) -> None:
        """Go through the sizes to come, a pixel narrower: so there are the shaders that they need, of which some serve
        one size in a thousand, but nothing that is kept for a size."""
        coming = self.random.bit_generator.state
        self.begin()
        for _ in range(cycles):
            self.resize(narrower=1)
        self.random.bit_generator.state = coming

    def switch(self) -> None:
        self.pipeline.render(self.settings())

    def reload(self) -> None:
        self.pipeline.load(load(self.model))
        self.pipeline.render(self.settings())

    def reload_broken(self) -> None:
        try:
            self.pipeline.load(load(self.broken))
            raise AssertionError("a broken file was loaded")
        except ModelError:
            pass
        self.pipeline.render(self.settings())

    def record(self) -> None:
        settings = self.settings()
        record(self.pipeline, still(settings), 2, self.folder / "film.mp4", 30.0)

    def screenshot(self) -> None:
        settings = self.settings()
        export.write_png8(self.folder / "picture.png", self.pipeline.shown(self.pipeline.render(settings), settings))

    def actions(self) -> dict[str, Callable[[], None]]:
        """What can be repeated, by name."""
        return dict(zip(NAMES, (self.resize, self.switch, self.reload, self.reload_broken, self.record,
                                self.screenshot), strict=True))  # fmt: skip


def _model(random: np.random.Generator) -> str:
    """An OBJ of scattered cards."""
    lines = ["# cards"]
    for number, card in enumerate(shapes.scattered(random)):
        lines += [f"v {x:.5f} {y:.5f} {z:.5f}" for x, y, z in card.positions]
        lines += ["f " + " ".join(str(4 * number + corner + 1) for corner in face) for face in card.triangles]
    return "\n".join(lines) + "\n"


@contextmanager
def opened(gpu: Gpu, seed: int = 1) -> Iterator[Run]:
    """A run's pipeline and folder, released afterwards."""
    if not sys.platform.startswith("linux"):
        raise SettingsError("long runs are counted through /proc, which only Linux has")
    with tempfile.TemporaryDirectory() as folder:
        run = Run(gpu, Path(folder), seed)
        try:
            yield run
        finally:
            run.pipeline.release()


def repeat(run: Run, name: str, cycles: int, on_cycle: Callable[[int], None] = lambda cycle: None) -> Growth:
    """Do `name` `cycles` times after a warm-up and say what is left over."""
    act = run.actions()[name]
    if name == "resize":
        run.resize_beforehand(cycles)
    else:
        for _ in range(WARM_UP):
            act()
    before = _rested(run)
    for cycle in range(cycles):
        act()
        run.gpu.ctx.finish()
        on_cycle(cycle + 1)
    after = _rested(run)
    return Growth(
        name, cycles, after.objects - before.objects, (after.memory_kb - before.memory_kb) / cycles,
        after.files - before.files, after.threads - before.threads, after.children - before.children,
    )  # fmt: skip


def _rested(run: Run) -> Alive:
    """What is alive when every method has drawn one picture and what is older is released."""
    for _ in range(run.begin()):
        run.switch()
    return alive(run.gpu.ctx)
