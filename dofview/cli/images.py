"""`dofview render --images`: what a method makes on its way, as pictures to look at."""

from __future__ import annotations

import re
from functools import partial
from pathlib import Path

import numpy as np

from dofview.errors import OutputError
from dofview.export import to_srgb8, write_png8, write_whole
from dofview.gl.targets import Image, TargetPool
from dofview.settings import Settings

SHARED = ("frame/", "picture")


def with_every_step(settings: Settings) -> Settings:
    """`settings` with all steps of the method kept, where it can keep them."""
    return settings.with_params(inspect=True) if "inspect" in type(settings.method_params).model_fields else settings


def made_folder(folder: Path) -> Path:
    """`folder`, made where it is missing."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(f"{folder}: cannot make this folder ({error.strerror})") from error
    return folder


def write_images(targets: TargetPool, method: str, folder: Path) -> list[str]:
    """Write the images of `method` and of its frame into `folder`, each layer of an array by itself; their names."""
    written = []
    for image in targets.named():
        if not image.name.startswith((f"{method}/", *SHARED)) or image.shape.dtype[0] in "iu":
            continue
        for name, pixels in _layers(image):
            path = folder / f"{name}.png"
            write_whole(path, partial(_write, pixels=pixels))
            written.append(path.name)
    return written


def _write(part: Path, pixels: np.ndarray) -> None:
    write_png8(part, picture(pixels))


def picture(pixels: np.ndarray) -> np.ndarray:
    """(height, width, 3 or 4) uint8 of (height, width, 1 to 4): colour in sRGB, with its opacity when it has one, which
    it is multiplied by; a single value in grey from the least of the image to the greatest."""
    if pixels.shape[2] >= 3:
        alpha = pixels[..., 3:].clip(0.0, 1.0)
        color = np.divide(pixels[..., :3], alpha, out=np.zeros_like(pixels[..., :3]), where=alpha > 0.0) if alpha.size \
            else pixels  # fmt: skip
        return np.concatenate([to_srgb8(color), np.rint(alpha * 255.0).astype(np.uint8)], axis=2)
    values = pixels[..., 0]
    finite = values[np.isfinite(values)]
    low, high = (float(finite.min()), float(finite.max())) if finite.size else (0.0, 0.0)
    grey = (np.nan_to_num(values, nan=low) - low) / (high - low) if high > low else np.zeros_like(values)
    return np.repeat(np.rint(grey.clip(0.0, 1.0) * 255.0).astype(np.uint8)[..., None], 3, axis=2)


def _layers(image: Image) -> list[tuple[str, np.ndarray]]:
    """File names, without suffix, and pixels."""
    name = re.sub(r"[^\w.+-]+", "_", image.name)
    pixels = image.pixels()
    return [(f"{name}_{n}", layer) for n, layer in enumerate(pixels)] if image.shape.layers else [(name, pixels)]
