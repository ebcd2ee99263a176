"""How far two pictures are apart, measured on the GPU; `dofview.metrics` defines the same in numpy."""

from __future__ import annotations

import math

from dofview.gl.context import Gpu
from dofview.gl.filters import mean
from dofview.gl.passes import draw
from dofview.gl.targets import Image


def psnr(gpu: Gpu, image: Image, reference: Image) -> float:
    """PSNR in dB over sRGB-encoded values clipped to [0, 1], mean over RGB, peak 1; infinite for equal pictures."""
    squared = gpu.targets.image("compare/squared error", image.size)
    draw(gpu, "render/squared_error.frag", squared, textures={"first": image, "second": reference})
    error = float(mean(gpu, squared)[:3].mean())
    return -10.0 * math.log10(error) if error > 0.0 else math.inf
