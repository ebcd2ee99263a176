"""Times one case and judges it by the matched reference."""

from __future__ import annotations

import math
import platform
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

import dofview
from dofview import metrics
from dofview.bench.plan import Case, Sweep
from dofview.bench.timing import pass_times, spread, timed
from dofview.framing import opening
from dofview.gl.context import Gpu, create_headless
from dofview.lens import Distribution, Lens
from dofview.pipeline import Pipeline
from dofview.render.reference import Reference
from dofview.scene.load import load
from dofview.settings import Settings


@dataclass(frozen=True)
class Truth:
    """The reference of some cases: linear RGB, what it vouches for, and the signed CoC of its pixels."""

    pixels: np.ndarray
    self_psnr: float
    views: int
    coc: np.ndarray


class Bench:
    """One context; scenes and references are kept while consecutive cases share them."""

    def __init__(self, sweep: Sweep, folder: Path | None = None):
        self.sweep = sweep
        self.gpu: Gpu = create_headless()
        self._folder = folder
        self._pipeline: Pipeline | None = None
        self._scene = ""
        self._truths: dict[object, Truth] = {}
        self._lenses: dict[object, tuple[Settings, Lens]] = {}

    def run(self, case: Case) -> dict[str, object]:
        """Return the record of a case: what it is, what it cost, how far it is from the truth."""
        pipeline = self._load(case.scene)
        settings = self.settings(case)
        result, milliseconds = timed(pipeline, settings, self.sweep.frames)
        pixels = result.pixels()
        counts = result.counts
        truth = self.truth(case)
        time = spread(milliseconds)
        passes = pass_times(pipeline, settings)
        record = {
            **asdict(case), "size": list(case.size), "parameters": dict(case.parameters), "ms": round(time.median, 3),
            "ms_lower": round(time.lower, 3), "ms_upper": round(time.upper, 3), "clock": pipeline.gpu.profile.clock,
            "guard_px": result.frame.guard, "triangles": pipeline.scene.scene.triangle_count, "counts": counts,
            "passes_ms": {name: round(value, 3) for name, value in passes.items()},
            "reference_views": truth.views, "reference_self_psnr": _finite(truth.self_psnr), **machine(pipeline.gpu),
        }  # fmt: skip
        record |= errors(pixels, truth)
        if self._folder is not None:
            record["picture"] = self._keep(case, pixels)
        return record

    def settings(self, case: Case) -> Settings:
        """The settings of a case: the scene's own view, its lens opened until the mean CoC is the case's."""
        key = (case.scene, case.size)
        if key not in self._lenses:
            pipeline = self._load(case.scene)
            base = opening(pipeline.scene.scene, case.scene)
            base = base.with_(image=base.image.model_copy(update={"size": case.size}))
            self._lenses[key] = base, _lens_of_mean_coc(pipeline, base)
        base, per_px = self._lenses[key]
        radius = per_px.radius * case.coc_px
        lens = per_px.model_copy(update={"radius": radius, "distribution": Distribution(case.distribution)})
        return base.with_(lens=lens, method=case.method).with_params(**dict(case.parameters))

    def truth(self, case: Case) -> Truth:
        """The reference of a case, without antialiasing as the methods are."""
        if case.truth_key not in self._truths:
            pipeline = self._load(case.scene)
            settings = self.settings(case).with_(method="pinhole")
            frame = pipeline.frame(settings, guard=False)
            reference = Reference(frame, antialias=False)
            reference.add(self.sweep.views)
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

    def _load(self, spec: str) -> Pipeline:
        if self._scene != spec or self._pipeline is None:
            scene = load(spec)
            if self._pipeline is None:
                self._pipeline = Pipeline(self.gpu, scene)
            else:
                self._pipeline.load(scene)
            self._scene = spec
        return self._pipeline

    def _keep(self, case: Case, pixels: np.ndarray) -> str:
        from dofview import export

        assert self._folder is not None
        folder = self._folder / "pictures"
        folder.mkdir(exist_ok=True)
        words = [
            case.scene.replace("demo:", ""),
            case.method,
            case.distribution,
            f"{case.coc_px:g}",
            "x".join(map(str, case.size)),
        ]
        words += [f"{name}-{value}" for name, value in case.parameters]
        name = "_".join("".join(c if c.isalnum() or c in "-." else "-" for c in str(word)) for word in words) + ".png"
        export.save(folder / name, pixels)
        return f"pictures/{name}"


def errors(pixels: np.ndarray, truth: Truth) -> dict[str, object]:
    """PSNR, SSIM, and PSNR where the picture is sharp, blurred in front of and behind the focus."""
    zones = metrics.blur_zones(truth.coc)
    found = {"psnr": _finite(metrics.psnr(pixels, truth.pixels)), "ssim": round(metrics.ssim(pixels, truth.pixels), 5)}
    for name, mask in zones._asdict().items():
        found[f"psnr_{name}"] = _finite(metrics.psnr(pixels, truth.pixels, mask)) if mask.any() else None
    return found


def machine(gpu: Gpu) -> dict[str, str]:
    """What a figure was measured on."""
    return {
        "renderer": gpu.renderer, "gl": gpu.ctx.info["GL_VERSION"], "python": platform.python_version(),
        "system": f"{platform.system()} {platform.machine()}", "dofview": dofview.__version__,
    }  # fmt: skip


def _lens_of_mean_coc(pipeline: Pipeline, settings: Settings) -> Lens:
    """The opening lens with the radius that makes the mean CoC diameter over the picture one pixel."""
    frame = pipeline.frame(settings.with_(lens=settings.lens.model_copy(update={"radius": 1.0})), guard=False)
    coc = np.abs(frame.coc.radius_px(frame.pinhole().inverse_depth.pixels()))
    mean = 2.0 * float(coc.mean())
    return settings.lens.model_copy(update={"radius": 1.0 / mean if mean > 0.0 else 0.0})


def _finite(decibels: float) -> float | None:
    return round(decibels, 3) if math.isfinite(decibels) else None
