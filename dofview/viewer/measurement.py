"""What a measurement says: PSNR against the reference so far, and whether that reference can support it."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass
from typing import TYPE_CHECKING

from dofview.render.reference import Quality, Reference

if TYPE_CHECKING:
    from dofview.viewer.app import App

MARGIN_DB = 6.0
"""A method's PSNR within this of the reference's own estimate says more of the reference than of the method."""

FRAME_BUDGET_S = 0.03


@dataclass(frozen=True)
class Measurement:
    """PSNR in dB of the picture shown against the reference so far."""

    psnr: float = 0.0
    quality: Quality = Quality(0, 0.0)
    target_db: float = 50.0
    most_views: int = 4096

    @property
    def done(self) -> bool:
        """Whether more views would not change what is shown."""
        return self.quality.views >= self.most_views or self.quality.self_psnr >= self.target_db

    @property
    def trustworthy(self) -> bool:
        """Whether the reference supports the number: its own error is well below the difference."""
        return self.quality.self_psnr >= self.psnr + MARGIN_DB or (math.isinf(self.psnr) and self.done)

    @property
    def progress(self) -> float:
        """0 to 1 on the way to the target quality, dB over dB."""
        return min(max(self.quality.self_psnr / self.target_db, self.quality.views / self.most_views), 1.0)

    def psnr_text(self) -> str:
        """The number as it is shown."""
        return f"PSNR {self.psnr:.2f} dB" if math.isfinite(self.psnr) else "PSNR: equal"

    def reference_text(self) -> str:
        """What stands beside every number."""
        return f"reference: {self.quality.views} views, vouches for {self.quality.self_psnr:.1f} dB"


def add_views(app: App, reference: Reference, most: int = 1 << 30) -> None:
    """Render views into the reference for a part of a frame's time, at least one, and not more than `most`."""
    start = time.perf_counter()
    for _ in range(most):
        reference.add(1)
        app.scene_renders += 1
        app.gpu.ctx.finish()
        if time.perf_counter() - start >= FRAME_BUDGET_S:
            return
