"""The truth: views through many points of the lens, averaged (the accumulation buffer, Haeberli and Akeley 1990).

Each view is an off-axis frustum that keeps the plane in focus still; views are added in RGBA32F, where 4096 of them
lose less than 1e-4 (fp16 stalls near 64). Its own estimate of how good it is needs no ground truth: how much the mean
changed since half as many views, which is 0.3–6 dB pessimistic for low-discrepancy points.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from dofview.gl.passes import ADD, draw
from dofview.gl.targets import Image
from dofview.render.compare import psnr
from dofview.render.frame import Frame
from dofview.render.raster import Projection, Runs, depth_range, draw_scene, in_view, projection
from dofview.sampling import lens_samples, pixel_jitter

BATCH = 64


@dataclass(frozen=True)
class Quality:
    """How far the reference has come: views so far, and the PSNR in dB it can vouch for (0 before two views)."""

    views: int
    self_psnr: float


class Reference:
    """A running mean of lens views for one frame.

    With `total` views known in advance the points are a Fibonacci spiral; without, a scrambled Sobol sequence that is
    good at every length. `antialias` also moves each view inside the pixel. Points with the symmetries of a square
    were tried: up to 1.4 dB better on the demo scenes, but few of them differ where a texture alternates by the pixel.
    """

    def __init__(self, frame: Frame, *, antialias: bool, total: int | None = None):
        self.frame = frame
        self.antialias = antialias
        self.total = total
        self.views = 0
        self._half = 0
        self._estimate = 0.0
        self._estimate_at = 0
        self._points: list = []
        self._near_far = depth_range(frame.scene, frame.camera)
        self._draws = self._seen_through_the_lens()

    def add(self, count: int) -> None:
        """Render `count` more views into the sum."""
        gpu, size = self.frame.gpu, self.frame.size
        total = self._image("sum")
        with gpu.profile.section("accumulation/views"):
            for _ in range(count):
                view = gpu.targets.image("accumulation/view", size)
                self._draw_view(view)
                draw(gpu, "pass/copy.frag", total, textures={"source": view}, blend=ADD, clear=self.views == 0)
                self.views += 1
                if self.views & (self.views - 1) == 0:
                    self._checkpoint(total)

    def mean(self) -> Image:
        """The mean so far, on the frame's canvas."""
        mean = self._image("mean")
        values = {"inverse_views": 1.0 / max(self.views, 1)}
        draw(self.frame.gpu, "render/mean.frag", mean, textures={"total": self._image("sum")}, values=values)
        return mean

    def touch(self) -> None:
        """Keep the running images alive through a frame that does not use them."""
        for name in ("sum", "latest", "earlier") if self.views else ():
            self._image(name)

    def quality(self) -> Quality:
        """The estimate, renewed whenever the views have grown by a quarter; waits for the GPU then."""
        if self._half and self.views > self._half and self.views >= self._estimate_at * 1.25:
            self._estimate = psnr(self.frame.gpu, self.mean(), self._image("earlier"))
            self._estimate_at = self.views
        return Quality(self.views, self._estimate)

    def _checkpoint(self, total: Image) -> None:
        """At 2ᵏ views keep the mean of the first half, to measure how much the second half changed it."""
        gpu = self.frame.gpu
        latest, earlier = self._image("latest"), self._image("earlier")
        if self._half:
            draw(gpu, "pass/copy.frag", earlier, textures={"source": latest})
        values = {"inverse_views": 1.0 / self.views}
        draw(gpu, "render/mean.frag", latest, textures={"total": total}, values=values)
        if not self._half:
            draw(gpu, "pass/copy.frag", earlier, textures={"source": latest})
        self._half = max(self.views // 2, 1)

    def _draw_view(self, into: Image) -> None:
        frame = self.frame
        lens_point, jitter = self._point(self.views)
        view = self._seen_from((lens_point[0] * frame.lens.radius, lens_point[1] * frame.lens.radius), jitter)
        # Views that move inside the pixel antialias textures by themselves; mipmaps would blur them once more.
        bias = -0.5 * math.log2(self.total or 64) if self.antialias else 0.0
        draw_scene(
            frame.gpu, frame.scene, view, (into,), lights=frame.lights, background=frame.background, lod_bias=bias,
            background_alpha=1.0, draws=self._draws,
        )  # fmt: skip

    def _seen_through_the_lens(self) -> Runs:
        """What is inside the union of all views' frusta: found once, for they hardly differ.

        Clip coordinates are affine in the lens point, x in its x and y in its y, so the corners of a square around the
        lens and of the pixel bound all views.
        """
        lens = self.frame.lens
        extent = lens.radius * (8.0 * lens.sigma_fraction if lens.distribution == "gaussian" else math.sqrt(2.0))
        corners = [((e, e), (j, j)) for e in (extent, -extent) for j in (0.5, -0.5)]
        return in_view(self.frame.scene, *(self._seen_from(e, j) for e, j in corners))

    def _seen_from(self, lens_point: tuple[float, float], jitter: tuple[float, float] = (0.0, 0.0)) -> Projection:
        """The view from a point of the lens, scene units from its centre."""
        frame = self.frame
        return projection(
            frame.scene, frame.camera, frame.inner_size, frame.guard, near_far=self._near_far, lens_point=lens_point,
            focus_distance=frame.lens.focus_distance, jitter_px=jitter,
        )  # fmt: skip

    def _point(self, index: int) -> tuple[tuple[float, float], tuple[float, float]]:
        """Lens sample in units of the radius and pixel jitter of view `index`."""
        while index >= len(self._points):
            start = len(self._points)
            count, progressive = (BATCH, True) if self.total is None else (self.total, False)
            lens = lens_samples(self.frame.lens, count, progressive=progressive, start=start)
            jitter = pixel_jitter(count, progressive=progressive, start=start) if self.antialias else lens * 0.0
            pairs = [(tuple(v), tuple(j)) for v, j in zip(lens.tolist(), jitter.tolist(), strict=True)]
            self._points += pairs if progressive else [pairs[i] for i in spread_order(count)]
        return self._points[index]

    def _image(self, name: str) -> Image:
        return self.frame.gpu.targets.image(f"accumulation/{name}", self.frame.size)


def spread_order(count: int) -> list[int]:
    """A permutation of 0 … count − 1 whose every prefix is spread over the whole: steps of the golden ratio.

    A spiral is numbered from its centre outwards; taken in that order, half of it would be half the lens.
    """
    step = max(round(count * 0.6180339887), 1)
    while math.gcd(step, count) != 1:
        step += 1
    return [i * step % count for i in range(count)]
