"""Times one case and judges it by the matched reference."""

from __future__ import annotations

import math
import os
import platform
from dataclasses import asdict, dataclass
from datetime import date
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

import numpy as np

import dofview
from dofview import metrics
from dofview.bench.pictures import side_by_side
from dofview.bench.plan import FARTHEST, OWN, Case, Sweep, is_default
from dofview.bench.timing import ENOUGH_MS, clock_of, pass_times, spread, timed
from dofview.errors import InputError
from dofview.framing import opening
from dofview.gl.context import Gpu, create_headless
from dofview.lens import Distribution, Lens
from dofview.pipeline import Pipeline
from dofview.render.reference import Reference
from dofview.scene.load import load
from dofview.settings import Settings

BATCH = 32


@dataclass(frozen=True)
class Truth:
    """The reference of some cases: linear RGB, what it vouches for, and the signed CoC of its pixels."""

    pixels: np.ndarray
    self_psnr: float
    views: int
    coc: np.ndarray


class Bench:
    """One context; scenes and references are kept while consecutive cases share them."""

    def __init__(self, folder: Path | None = None):
        self.gpu: Gpu = create_headless()
        self.clock = clock_of(self.gpu)
        self._folder = folder
        self._pipeline: Pipeline | None = None
        self._scene = ""
        self._truths: dict[object, Truth] = {}
        self._lenses: dict[object, tuple[Settings, Lens]] = {}

    def run(self, case: Case, sweep: Sweep) -> dict[str, object]:
        """Return the record of a case: what it is, what it cost, how far it is from the truth."""
        pipeline = self.pipeline(case.scene)
        settings = self.settings(case)
        result, milliseconds = timed(pipeline, settings, sweep.frames, self.clock, ENOUGH_MS)
        pixels, counts, guard = result.pixels(), result.counts, result.frame.guard
        time = spread(milliseconds)
        record = {
            **asdict(case), "size": list(case.size), "parameters": dict(case.parameters), "ms": round(time.median, 3),
            "ms_lower": round(time.lower, 3), "ms_upper": round(time.upper, 3), "frames": len(milliseconds),
            "clock": self.clock.name, "lens_radius": settings.lens.radius,
            "guard_px": guard, "triangles": pipeline.scene.scene.triangle_count,
        }  # fmt: skip
        record["counts"], record["passes_ms"] = counts, {}
        if is_default(record):
            passes = pass_times(pipeline, settings, self.clock)
            record["passes_ms"] = {name: round(value, 3) for name, value in passes.items()}
            # Some counters cost time, and are there only while passes are timed.
            record["counts"] = counts | pipeline.gpu.profile.counts
        truth = self.truth(case, sweep)
        record |= {"reference_views": truth.views, "reference_self_psnr": _finite(truth.self_psnr)}
        record |= errors(pixels, truth) | machine(pipeline.gpu)
        if self._folder is not None and is_default(record):
            record["picture"] = self._keep(case, pixels, truth)
        return record

    def settings(self, case: Case) -> Settings:
        """The settings of a case: the scene's own view, its lens opened until the mean CoC is the case's."""
        key = (case.scene, case.size, case.focus)
        if key not in self._lenses:
            pipeline = self.pipeline(case.scene)
            base = opening(pipeline.scene.scene, case.scene)
            base = base.with_(image=base.image.model_copy(update={"size": case.size}))
            if case.focus == FARTHEST:
                farthest = 1.0 / pipeline.frame(base, guard=False).depth_range().farthest_surface
                base = base.with_(lens=base.lens.model_copy(update={"focus_distance": farthest}))
            self._lenses[key] = base, _lens_of_mean_coc(pipeline, base)
        base, per_px = self._lenses[key]
        radius = per_px.radius * case.coc_px
        lens = per_px.model_copy(update={"radius": radius, "distribution": Distribution(case.distribution)})
        image = base.image.model_copy(update={"guard_px": case.guard})
        return base.with_(lens=lens, image=image, method=case.method).with_params(**dict(case.parameters))

    def truth(self, case: Case, sweep: Sweep) -> Truth:
        """The reference of a case, without antialiasing as the methods are."""
        if case.truth_key not in self._truths:
            pipeline = self.pipeline(case.scene)
            settings = self.settings(case).with_(method="pinhole")
            frame = pipeline.frame(settings, guard=False)
            reference = Reference(frame, antialias=False)
            while reference.views < sweep.views and reference.quality().self_psnr < sweep.trust_db:
                reference.add(min(BATCH, sweep.views - reference.views))
            quality = reference.quality()
            pixels = reference.mean().pixels()[..., :3]
            coc = frame.coc.radius_px(frame.pinhole().inverse_depth.pixels()[..., 0])
            self._truths = {case.truth_key: Truth(pixels, quality.self_psnr, quality.views, np.asarray(coc))}
        return self._truths[case.truth_key]

    def release(self) -> None:
        if self._pipeline is not None:
            self._pipeline.release()
        self.gpu.release()
        self.gpu.ctx.release()

    def pipeline(self, spec: str) -> Pipeline:
        """The pipeline, with the scene `spec` in it."""
        if self._scene != spec or self._pipeline is None:
            scene = load(spec)
            if self._pipeline is None:
                self._pipeline = Pipeline(self.gpu, scene)
            else:
                self._pipeline.load(scene)
            self._scene = spec
        return self._pipeline

    def _keep(self, case: Case, pixels: np.ndarray, truth: Truth) -> str:
        """Write the picture beside what is wrong with it; return its name in the folder."""
        assert self._folder is not None
        words = [case.scene.removeprefix("demo:"), case.method, case.distribution, f"{case.coc_px:g}"]
        words.append("x".join(map(str, case.size)))
        words += [] if case.focus == OWN else [case.focus]
        words += [] if case.guard is None else [f"guard{case.guard}"]
        name = "_".join("".join(c if c.isalnum() or c in "-." else "-" for c in word) for word in words)
        (self._folder / "pictures").mkdir(exist_ok=True)
        side_by_side(self._folder / "pictures" / f"{name}.jpg", pixels, truth.pixels)
        return f"pictures/{name}.jpg"


def errors(pixels: np.ndarray, truth: Truth) -> dict[str, object]:
    """PSNR, SSIM, FLIP, and PSNR where the picture is sharp, blurred in front of and behind the focus."""
    zones = metrics.blur_zones(truth.coc)
    found: dict[str, object] = {
        "psnr": _finite(metrics.psnr(pixels, truth.pixels)), "ssim": round(metrics.ssim(pixels, truth.pixels), 5)
    }  # fmt: skip
    try:
        found["flip"] = round(metrics.flip(pixels, truth.pixels), 5)
    except InputError:
        found["flip"] = None
    for name, mask in zones._asdict().items():
        found[f"psnr_{name}"] = _finite(metrics.psnr(pixels, truth.pixels, mask)) if mask.any() else None
    return found


def machine(gpu: Gpu) -> dict[str, str]:
    """What a figure was measured on."""
    return {
        "renderer": gpu.renderer, "gl": gpu.ctx.info["GL_VERSION"], "python": platform.python_version(),
        "system": f"{platform.system()} {platform.machine()}", "processor": _processor(),
        "cores": str(os.cpu_count()), "threads": os.environ.get("LP_NUM_THREADS", "") if gpu.software else "",
        "date": date.today().isoformat(), "moderngl": _version("moderngl"), "numpy": np.__version__,
        "dofview": dofview.__version__,
    }  # fmt: skip


def _processor() -> str:
    """The processor's name, as the system tells it."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.processor()
    return next((line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")), "")


def _version(package: str) -> str:
    try:
        return version(package)
    except PackageNotFoundError:
        return ""


def _lens_of_mean_coc(pipeline: Pipeline, settings: Settings) -> Lens:
    """The opening lens with the radius that makes the mean CoC diameter over the picture one pixel."""
    frame = pipeline.frame(settings.with_(lens=settings.lens.model_copy(update={"radius": 1.0})), guard=False)
    coc = np.abs(frame.coc.radius_px(frame.pinhole().inverse_depth.pixels()))
    mean = 2.0 * float(coc.mean())
    return settings.lens.model_copy(update={"radius": 1.0 / mean if mean > 0.0 else 0.0})


def _finite(decibels: float) -> float | None:
    return round(decibels, 3) if math.isfinite(decibels) else None
