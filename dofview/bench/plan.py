"""What a sweep consists of: cases, each a scene, a lens, a size, a method and its quality."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from dataclasses import asdict, dataclass
from itertools import product

from dofview.lens import Distribution
from dofview.methods import METHODS, method

UNMEASURED = ("pinhole", "accumulation")
GAUSSIAN_BY_NATURE = ("mipmap", "layered", "pyramid")


@dataclass(frozen=True)
class Case:
    """One picture to time and to judge. `coc_px` is the mean CoC diameter over the visible pixels of the picture."""

    scene: str
    method: str
    distribution: str
    coc_px: float
    size: tuple[int, int]
    parameters: tuple[tuple[str, object], ...] = ()

    @property
    def key(self) -> str:
        """Text that is equal for equal cases: what a sweep is taken up again by."""
        return json.dumps(asdict(self), sort_keys=True)

    @property
    def truth_key(self) -> tuple[str, str, float, tuple[int, int]]:
        """What the reference depends on."""
        return self.scene, self.distribution, self.coc_px, self.size


@dataclass(frozen=True)
class Sweep:
    """Lists to be combined, and how long to measure."""

    scenes: tuple[str, ...] = ("demo:foreground", "demo:background", "demo:rail")
    methods: tuple[str, ...] = tuple(name for name in METHODS if name not in UNMEASURED)
    distributions: tuple[str, ...] = ()
    coc_px: tuple[float, ...] = (4.0, 8.0, 16.0, 32.0, 64.0)
    sizes: tuple[tuple[int, int], ...] = ((512, 384),)
    frames: int = 5
    views: int = 1024
    every_quality: bool = True

    def cases(self) -> Iterator[Case]:
        """Every combination; reference views of few kinds come first, so that a picture of cost is there early."""
        for scene, size, coc in product(self.scenes, self.sizes, self.coc_px):
            for name in self.methods:
                for distribution in self.distributions or (natural(name),):
                    for parameters in qualities(name, self.every_quality):
                        yield Case(scene, name, distribution, coc, size, tuple(sorted(parameters.items())))
            for distribution in self.distributions or sorted({natural(name) for name in self.methods}):
                for views in (16, 64, 256) if self.every_quality else (64,):
                    yield Case(scene, "accumulation", distribution, coc, size, (("views", views),))


def quick() -> Sweep:
    """Small enough for two cores and five minutes."""
    return Sweep(coc_px=(8.0, 16.0), sizes=((192, 144),), frames=3, views=128, every_quality=False)


def natural(name: str) -> str:
    """The lens that a method's blur is made for."""
    return Distribution.GAUSSIAN.value if name in GAUSSIAN_BY_NATURE else Distribution.UNIFORM_DISC.value


def qualities(name: str, every: bool) -> Iterable[dict[str, object]]:
    """The settings of a method from fast to fine, as it declares them in `QUALITIES`, or its defaults alone."""
    declared: tuple[dict[str, object], ...] = getattr(method(name), "QUALITIES", ({},))
    return declared if every else ({},)
