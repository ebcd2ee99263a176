"""The row that asks somebody else: a path tracer's thin lens (Mitsuba 3) on the same scene.

The tracer's samples are independent, so the variance of its mean is known pixel by pixel, and the reference can be
tested against it: at a level of 1 % over all pixels together (Šidák), a picture without bias fails once in a hundred.
"""

from __future__ import annotations

import functools
from typing import Any

import numpy as np

from dofview.lens import Lens
from dofview.metrics import psnr
from dofview.scene.model import Primitive, Scene
from dofview.stress import shapes
from dofview.stress.bench import CAMERA, Bench
from dofview.stress.row import Measured, Row, Skipped, bounds

SIZE = 48
RUNS, SAMPLES = 64, 64
LEVEL = 0.01
VIEWS = 1024
SKY = 0.3


def unbiased(bench: Bench, method: str, random: np.random.Generator) -> list[Measured]:
    """The reference lies within the tracer's noise at every pixel; how near the methods come is for the record."""
    scene, lens, runs = _traced_scene(int(random.integers(1 << 20)))
    settings = bench.settings(method, lens, size=(SIZE, SIZE), background=SKY, views=VIEWS)
    if method != "accumulation":
        # A path tracer samples all of the pixel; a method that does not, at twice the size, comes as near as it may.
        doubled = settings.with_(image=settings.image.model_copy(update={"scale": 2.0}))
        return [Measured("PSNR, dB", psnr(bench.picture(scene, doubled), runs.mean(axis=0)), at_least=True)]
    picture = bench.picture(scene, settings.with_params(antialias=True))
    other = bench.picture(scene, settings.with_params(antialias=True, progressive=True))
    return [Measured("largest size of z over the limit for all pixels", _largest_z(runs, picture, other))]


@functools.lru_cache(maxsize=1)
def _traced_scene(seed: int) -> tuple[Scene, Lens, np.ndarray]:
    """A scene, a lens and the tracer's pictures: the same for all methods."""
    random = np.random.default_rng(seed)
    cards = shapes.scattered(random, materials=6)
    colors = [shapes.unlit(tuple(random.uniform(0.05, 1.0, 3).tolist())) for _ in range(6)]
    scene = shapes.scene(cards, colors)
    lens = Lens(radius=random.uniform(0.05, 0.25), focus_distance=random.uniform(3.0, 8.0))
    return scene, lens, _traced(scene, lens, seed)


def _largest_z(runs: np.ndarray, picture: np.ndarray, other: np.ndarray) -> float:
    """Largest deviation of `picture` (h, w, 3) from the mean of `runs` (n, h, w, 3) over the largest by chance.

    The reference errs a little too: by about as much as two sets of lens points differ. A sample that was never drawn
    has no variance, so none is taken as less than one sample of all makes.
    """
    from scipy import stats

    grey = runs.mean(axis=3)
    least = np.ptp(grey) / (RUNS * SAMPLES)
    own = (picture - other).mean(axis=2) ** 2
    error = np.sqrt(grey.var(axis=0, ddof=1) / len(grey) + own + least**2)
    z = np.abs(picture.mean(axis=2) - grey.mean(axis=0)) / error
    each = 1.0 - (1.0 - LEVEL) ** (1.0 / z.size)
    return float(z.max() / stats.t.ppf(1.0 - each / 2.0, RUNS - 1))


def _traced(scene: Scene, lens: Lens, seed: int) -> np.ndarray:
    """`RUNS` pictures of `SAMPLES` samples a pixel each, (RUNS, SIZE, SIZE, 3) linear."""
    try:
        import mitsuba
    except ImportError as error:
        raise Skipped("no Mitsuba here; pip install 'dofview[mitsuba]'") from error
    # The one variant that needs no compiler at run time.
    mitsuba.set_variant("scalar_rgb")
    to_world = mitsuba.ScalarTransform4f().look_at(
        list(CAMERA.position), list(CAMERA.target), list(CAMERA.up)
    )  # fmt: skip
    film = {"type": "hdrfilm", "width": SIZE, "height": SIZE, "rfilter": {"type": "box"}, "pixel_format": "rgb",
            "component_format": "float32"}  # fmt: skip
    description: dict[str, object] = {
        "type": "scene", "integrator": {"type": "path", "max_depth": 1},
        "sensor": {
            "type": "thinlens", "fov": CAMERA.vfov_deg, "fov_axis": "y", "aperture_radius": lens.radius,
            "focus_distance": lens.focus_distance, "near_clip": 1e-3, "to_world": to_world, "film": film,
            "sampler": {"type": "independent"},
        },
        "sky": {"type": "constant", "radiance": {"type": "rgb", "value": [SKY] * 3}},
    }  # fmt: skip
    for number, card in enumerate(scene.primitives):
        light = {
            "type": "area",
            "radiance": {"type": "rgb", "value": list(scene.materials[card.material].base_color[:3])},
        }
        for side, matrix in enumerate(_both_sides(card)):
            description[f"card{number}_{side}"] = {
                "type": "rectangle", "to_world": mitsuba.ScalarTransform4f(matrix.tolist()), "emitter": light
            }  # fmt: skip
    loaded = mitsuba.load_dict(description)
    seeds: Any = range(seed, seed + RUNS)  # typed as a number of Mitsuba's own, which a plain one becomes
    return np.array([np.array(mitsuba.render(loaded, spp=SAMPLES, seed=each)) for each in seeds])


def _both_sides(card: Primitive) -> list[np.ndarray]:
    """Two (4, 4) placements of the square [−1, 1]², back to back: it shines to one side only."""
    low, right, _, up = card.positions.astype(np.float64)
    across, along = (right - low) / 2.0, (up - low) / 2.0
    normal = np.cross(across, along)
    normal /= np.linalg.norm(normal)
    found = []
    for side in (1.0, -1.0):
        matrix = np.eye(4)
        matrix[:3, 0], matrix[:3, 1], matrix[:3, 2] = side * across, along, side * normal
        matrix[:3, 3] = low + across + along + side * 1e-5 * normal
        found.append(matrix)
    return found


ROWS = (
    Row(15, "unbiased beside a path tracer", bounds(1.0, 0.0, 0.0, 0.0, 0.0, 0.0), unbiased, rarely=True),
)  # fmt: skip
"""The methods are only ranked: any PSNR will do."""
