"""Which settings are worth their time, and which to take for a budget."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

from dofview.errors import InputError


def quality(record: dict) -> float:
    """PSNR in dB; equal pictures are infinitely good."""
    return math.inf if record["psnr"] is None else float(record["psnr"])


def front(records: Iterable[dict]) -> list[dict]:
    """Those records that no other beats in time and in PSNR, fastest first."""
    best: list[dict] = []
    for record in sorted(records, key=lambda r: (r["ms"], -quality(r))):
        if not best or quality(record) > quality(best[-1]):
            best.append(record)
    return best


def pick(records: Sequence[dict], *, budget_ms: float | None = None, min_psnr: float | None = None) -> dict:
    """The best record within `budget_ms`, or the fastest of at least `min_psnr` dB, or under both.

    Raises InputError that says how near the records come when none fits.
    """
    fitting = [r for r in front(records) if budget_ms is None or r["ms"] <= budget_ms]
    if not fitting:
        fastest = min(records, key=lambda r: r["ms"])
        raise InputError(
            f"nothing within {budget_ms:g} ms; the fastest is {fastest['method']} with {fastest['ms']:g} ms"
        )
    if min_psnr is None:
        return fitting[-1]
    good = [r for r in fitting if quality(r) >= min_psnr]
    if not good:
        best = fitting[-1]
        raise InputError(f"nothing of {min_psnr:g} dB; the best is {best['method']} with {quality(best):.1f} dB")
    return good[0]
