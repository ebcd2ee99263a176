"""Filters over whole images that know nothing of depth of field."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from dofview.gl.context import Gpu
from dofview.gl.passes import draw
from dofview.gl.targets import Image

BLOCK = 8


def reduce_blocks(
    gpu: Gpu, source: Image, shader: str, name: str, dtype: str = "f4", values: Mapping[str, object] | None = None
) -> np.ndarray:
    """Run the block-reducing `shader` until one texel is left and return its components; the first level has the
    define FIRST. Waits for the result: for what changes with the scene, not for every frame."""
    image, level = source, 0
    while image.size != (1, 1) or level == 0:
        size = (-(-image.size[0] // BLOCK), -(-image.size[1] // BLOCK))
        smaller = gpu.targets.image(f"{name}{level}", size, dtype=dtype)
        draw(
            gpu, shader, smaller, textures={"source": image}, values=values,
            defines={"BLOCK": BLOCK, **({"FIRST": 1} if level == 0 else {})},
        )  # fmt: skip
        image, level = smaller, level + 1
    return image.pixels()[0, 0]


def mean(gpu: Gpu, source: Image) -> np.ndarray:
    """Mean of all texels, (4,) float32; waits for the result."""
    return reduce_blocks(gpu, source, "pass/sum.frag", "mean/") / (source.size[0] * source.size[1])
