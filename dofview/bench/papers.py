"""What the papers report of their methods, and whether these results reproduce it.

Absolute times belong to other machines and scenes; what is compared is PSNR, ratios within one run, and orderings.
"""

from __future__ import annotations

import statistics
from collections.abc import Callable
from dataclasses import dataclass

from dofview.bench.pareto import quality

Records = list[dict]


@dataclass(frozen=True)
class Claim:
    """A published figure, and how it is read off results: None when the results do not hold what it needs."""

    source: str
    what: str
    published: float
    unit: str
    read: Callable[[Records], float | None]


@dataclass(frozen=True)
class Verdict:
    """A claim beside what was measured."""

    claim: Claim
    measured: float | None

    @property
    def word(self) -> str:
        """ "better", "reproduced" (within 3 % below), "not", or "not measured"."""
        if self.measured is None:
            return "not measured"
        if self.measured > self.claim.published * 1.03:
            return "better"
        return "reproduced" if self.measured >= self.claim.published * 0.97 else "not"


def _chosen(records: Records, **wanted: object) -> Records:
    return [r for r in records if all(r.get(name) == value for name, value in wanted.items())]


def _psnr(method: str, scene: str, most_coc: float = 16.0) -> Callable[[Records], float | None]:
    """Best PSNR of `method` on `scene` at the largest mean CoC up to `most_coc`, under the lens it is made for."""

    def read(records: Records) -> float | None:
        found = [r for r in _chosen(records, method=method, scene=scene) if r["coc_px"] <= most_coc]
        if not found:
            return None
        largest = max(r["coc_px"] for r in found)
        return max(quality(r) for r in found if r["coc_px"] == largest)

    return read


def _speed_up(method: str, views: int, coc: float) -> Callable[[Records], float | None]:
    """Time of accumulation with `views` over that of the method's default, median over scenes, at mean CoC `coc`.

    Accumulation's time is proportional to its views: that of the nearest number measured is scaled.
    """

    def read(records: Records) -> float | None:
        ratios = []
        for record in _chosen(records, method=method, coc_px=coc, parameters={}):
            others = _chosen(records, method="accumulation", coc_px=coc, scene=record["scene"], size=record["size"])
            if others:
                nearest = min(others, key=lambda r: abs(r["parameters"]["views"] - views))
                ratios.append(nearest["ms"] * views / nearest["parameters"]["views"] / record["ms"])
        return statistics.median(ratios) if ratios else None

    return read


CLAIMS = (
    Claim("Lee, Kim, Choi 2008", "splatting with the hidden image, foreground blur", 36.33, "dB",
          _psnr("splatting", "demo:foreground")),
    Claim("Lee, Kim, Choi 2008", "accelerated over accumulation, mean CoC 8, 24 views", 5.6, "times",
          _speed_up("splatting", 24, 8.0)),
    Claim("Lee, Kim, Choi 2008", "accelerated over accumulation, mean CoC 16, 96 views", 17.0, "times",
          _speed_up("splatting", 96, 16.0)),
    Claim("Lee, Kim, Choi 2008", "accelerated over accumulation, mean CoC 32, 384 views", 44.0, "times",
          _speed_up("splatting", 384, 32.0)),
    Claim("Lee, Eisemann, Seidel 2009", "multiview, 32 rays", 30.84, "dB", _psnr("multiview", "demo:foreground")),
    Claim("Schedl, Wimmer 2012", "layered over accumulation of 256 views", 47.0, "times",
          _speed_up("layered", 256, 16.0)),
    Claim("Lee, Kim, Choi 2009", "mipmap, background blur", 37.66, "dB", _psnr("mipmap", "demo:background")),
    Claim("Lee, Kim, Choi 2009", "mipmap, foreground blur", 35.41, "dB", _psnr("mipmap", "demo:foreground")),
    Claim("Lee, Kim, Choi 2009", "pyramid as measured there, background blur", 25.89, "dB",
          _psnr("pyramid", "demo:background")),
    Claim("Lee, Kim, Choi 2009", "pyramid as measured there, foreground blur", 24.43, "dB",
          _psnr("pyramid", "demo:foreground")),
)  # fmt: skip


def verdicts(records: Records) -> list[Verdict]:
    """Every claim beside its measurement."""
    return [Verdict(claim, claim.read(records)) for claim in CLAIMS]
