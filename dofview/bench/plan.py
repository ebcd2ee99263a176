"""What a sweep consists of: cases, each a scene, a lens, a size, a method and its quality."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from dataclasses import asdict, dataclass, replace
from itertools import product

from dofview.lens import Distribution
from dofview.methods import METHODS, method

UNMEASURED = ("pinhole", "accumulation")
GAUSSIAN_BY_NATURE = ("mipmap", "layered", "pyramid")
OWN, FARTHEST = "own", "farthest"
PAPER_SIZE = (1024, 768)
DEFAULT_VIEWS = 64
"""Views of the accumulation that stands beside the methods' defaults."""


@dataclass(frozen=True)
class Case:
    """One picture to time and to judge. `coc_px` is the mean CoC diameter over the visible pixels of the picture.

    `focus` is the scene's own or on the farthest surface, `guard` the width of the guard band, px, if not as needed.
    """

    scene: str
    method: str
    distribution: str
    coc_px: float
    size: tuple[int, int]
    parameters: tuple[tuple[str, object], ...] = ()
    focus: str = OWN
    guard: int | None = None

    @property
    def key(self) -> str:
        """Text that is equal for equal cases: what a sweep is taken up again by."""
        own = {"focus": OWN, "guard": None}
        told = {name: value for name, value in asdict(self).items() if name not in own or value != own[name]}
        return json.dumps(told, sort_keys=True)

    @property
    def truth_key(self) -> tuple[str, str, float, tuple[int, int], str]:
        """What the reference depends on."""
        return self.scene, self.distribution, self.coc_px, self.size, self.focus


@dataclass(frozen=True)
class Sweep:
    """Lists to be combined, and how long to measure.

    `frames` are timed after a warm-up, fewer where they take seconds. The reference ends at `views` views, or where it
    vouches for `trust_db`. `beside` is how many views of accumulation stand beside the methods' defaults; 0 for none.
    """

    scenes: tuple[str, ...] = ("demo:foreground", "demo:background", "demo:rail")
    methods: tuple[str, ...] = tuple(name for name in METHODS if name not in UNMEASURED)
    distributions: tuple[str, ...] = ()
    coc_px: tuple[float, ...] = (16.0, 8.0, 32.0, 4.0, 64.0)
    sizes: tuple[tuple[int, int], ...] = ((512, 384),)
    frames: int = 5
    views: int = 384
    trust_db: float = 52.0
    every_quality: bool = True
    focus: str = OWN
    guard: int | None = None
    beside: int = DEFAULT_VIEWS

    def cases(self) -> Iterator[Case]:
        """Every combination, one blur after the other; cases that share a reference follow one another."""
        for coc, scene, size in product(self.coc_px, self.scenes, self.sizes):
            for distribution in Distribution.UNIFORM_DISC.value, Distribution.GAUSSIAN.value:
                of_lens = [
                    name for name in self.methods if distribution in (self.distributions or (natural(name),))
                ]  # fmt: skip
                for name in [*of_lens, "accumulation"] if of_lens and self.beside else of_lens:
                    for parameters in qualities(name, self.every_quality, self.beside):
                        settings = tuple(sorted(parameters.items()))
                        yield Case(scene, name, distribution, coc, size, settings, self.focus, self.guard)


def quick() -> tuple[Sweep, ...]:
    """Small enough for two cores and five minutes."""
    return (Sweep(coc_px=(8.0, 16.0), sizes=((192, 144),), frames=3, views=128, every_quality=False),)


def full() -> tuple[Sweep, ...]:
    """Every quality at one blur, and there the other lens, more and fewer pixels, more and fewer triangles.

    Then the defaults at every blur.
    """
    sweep = Sweep()
    one = replace(sweep, coc_px=(16.0,), every_quality=False, frames=3)
    background = replace(one, scenes=("demo:background",), views=96)
    return (
        replace(sweep, coc_px=(16.0,)),
        replace(one, distributions=tuple(kind.value for kind in (Distribution.UNIFORM_DISC, Distribution.GAUSSIAN))),
        replace(background, sizes=((256, 192), (512, 384), (1024, 768))),
        replace(background, scenes=tuple(f"demo:background{count}" for count in ("@5k", "", "@60k", "@150k"))),
        replace(sweep, coc_px=(32.0, 8.0, 64.0, 4.0), every_quality=False, frames=3, views=96),
        *as_the_papers(),
    )


def as_the_papers() -> tuple[Sweep, ...]:
    """What the papers report, under their circumstances: as many triangles and pixels, the farthest surface in focus,
    a canvas that does not grow. Only the one with another focus is judged by its errors."""
    sweep = Sweep(every_quality=False, frames=3, views=32, sizes=(PAPER_SIZE,), beside=16)
    scenes = sweep.scenes
    return (
        replace(
            sweep, scenes=tuple(f"{name}@216k" for name in scenes), methods=("splatting",), coc_px=(8.0, 16.0, 32.0)
        ),
        replace(sweep, scenes=tuple(f"{name}@74k" for name in scenes), methods=("layered",), coc_px=(16.0,)),
        Sweep(
            scenes=("demo:background",), methods=("mipmap", "pyramid"), coc_px=(8.0, 16.0), every_quality=False,
            frames=3, views=256, focus=FARTHEST, beside=0,
        ),
        Sweep(methods=("mipmap", "pyramid"), coc_px=(4.0, 64.0), every_quality=False, views=16, guard=0, beside=0),
    )  # fmt: skip


def cases(sweeps: Iterable[Sweep]) -> Iterator[tuple[Sweep, Case]]:
    """The cases of all `sweeps`, each once, with the sweep that says how to measure it."""
    seen = set()
    for sweep in sweeps:
        for case in sweep.cases():
            if case not in seen:
                seen.add(case)
                yield sweep, case


def natural(name: str) -> str:
    """The lens that a method's blur is made for."""
    return Distribution.GAUSSIAN.value if name in GAUSSIAN_BY_NATURE else Distribution.UNIFORM_DISC.value


def qualities(name: str, every: bool, views: int = DEFAULT_VIEWS) -> tuple[dict[str, object], ...]:
    """The settings of a method from cheap to good, as it declares them in `QUALITIES`, or its defaults alone, those of
    accumulation with `views`."""
    if not every:
        return ({"views": views},) if name == "accumulation" else ({},)
    return getattr(method(name), "QUALITIES", ({},))


def is_default(record: dict) -> bool:
    """Whether a record is of a method's defaults; accumulation's are those that stand beside them."""
    return record["parameters"] in ({}, {"views": DEFAULT_VIEWS})


def own_view(record: dict) -> bool:
    """Whether a record is of the scene as it opens, on the canvas that its blur needs."""
    return record.get("focus", OWN) == OWN and record.get("guard") is None
