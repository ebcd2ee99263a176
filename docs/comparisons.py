"""Make the pictures of docs/methods/*.md, a method beside the reference it is judged by: part of `make docs`.

Method, reference and four times their difference; and for `pyramid` four sizes of lens, as in figure 4 of its paper.
Tests make the methods' parts again and compare.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from PIL import Image

from dofview.export import to_srgb8
from dofview.framing import opening
from dofview.gl.context import Gpu, create_headless
from dofview.pipeline import Pipeline
from dofview.scene.load import load
from dofview.settings import Settings

IMAGES = Path(__file__).parent / "images"
VIEWS = 256
COMPARED = {
    "layered": ("demo:foreground", "gaussian", (272, 204)),
    "mipmap": ("demo:background", "gaussian", (320, 240)),
    "multiview": ("demo:foreground", "uniform_disc", (272, 204)),
    "pyramid": ("demo:foreground", "gaussian", (272, 204)),
    "splatting": ("demo:foreground", "uniform_disc", (272, 204)),
}
RADII = (0.1, 0.3, 1.0, 3.0)
RADII_SCENE, RADII_SIZE = "demo:rail", (180, 135)


def seen(scene: str, distribution: str, size: tuple[int, int], wider: float = 1.0) -> Settings:
    """The scene's own view through a lens `wider` times as large."""
    settings = opening(load(scene), scene)
    lens = {**settings.lens.model_dump(), "distribution": distribution, "radius": settings.lens.radius * wider}
    return settings.with_(lens=lens, image={"size": size})


def rendered(pipeline: Pipeline, settings: Settings, name: str) -> np.ndarray:
    """8-bit sRGB of `settings` by the method `name`."""
    chosen = settings.with_(method=name)
    if name == "accumulation":
        chosen = chosen.with_params(views=VIEWS)
    return to_srgb8(pipeline.render(chosen).pixels())


def comparison(gpu: Gpu, name: str) -> Image.Image:
    """Method, reference and their difference times four, side by side."""
    scene, distribution, size = COMPARED[name]
    pipeline, settings = Pipeline(gpu, load(scene)), seen(scene, distribution, size)
    picture, reference = rendered(pipeline, settings, name), rendered(pipeline, settings, "accumulation")
    pipeline.release()
    difference = np.abs(picture.astype(int) - reference.astype(int)) * 4
    return Image.fromarray(np.concatenate([picture, reference, difference.clip(0, 255).astype(np.uint8)], axis=1))


def radii(gpu: Gpu) -> Image.Image:
    """Reference over `pyramid`, for lenses of growing radius."""
    pipeline = Pipeline(gpu, load(RADII_SCENE))
    columns = []
    for wider in RADII:
        settings = seen(RADII_SCENE, "gaussian", RADII_SIZE, wider)
        columns.append(np.concatenate([rendered(pipeline, settings, name) for name in ("accumulation", "pyramid")]))
    pipeline.release()
    return Image.fromarray(np.concatenate(columns, axis=1))


if __name__ == "__main__":
    gpu = create_headless()
    made = {name: comparison(gpu, name) for name in COMPARED} | {"pyramid-radii": radii(gpu)}
    for name, picture in made.items():
        picture.save(IMAGES / f"{name}.png", optimize=True)
        print(f"wrote: {IMAGES / f'{name}.png'}")
    gpu.release()
