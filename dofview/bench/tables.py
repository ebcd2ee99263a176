"""The report's tables, as rows of text, from the records of a sweep."""

from __future__ import annotations

import math
from typing import NamedTuple

from dofview.bench.papers import verdicts
from dofview.bench.pareto import front, quality
from dofview.bench.plan import OWN, is_default, natural
from dofview.methods import METHODS

SHORT = {"uniform_disc": "disc", "gaussian": "Gaussian"}
MOST_VIEWS = 65536.0


class Table(NamedTuple):
    """Title, a line under it, the columns and the rows."""

    title: str
    text: str
    columns: list[str]
    rows: list[list[str]]


def summary(records: list[dict]) -> Table:
    """Every method's defaults against the reference at equal PSNR, scene by scene."""
    rows = []
    for record in sorted(filter(is_default, records), key=_order):
        found = equal(record, records) if record["method"] != "accumulation" else None
        if found is None:
            continue
        sharp = [_decibels(record, f"psnr_{zone}") for zone in ("focus", "foreground", "background")]
        rows.append([
            _scene(record), record["method"], SHORT[record["distribution"]], f"{record['coc_px']:g}",
            f"{record['ms']:.0f}", _decibels(record, "psnr"), f"{record['ssim']:.3f}", _flip(record), *sharp,
            f"{found.views:.0f}", f"{found.ms:.0f}", f"**{found.ms / record['ms']:.1f}**",
        ])  # fmt: skip
    columns = ["scene", "method", "lens", "mean CoC px", "ms", "PSNR dB", "SSIM", "FLIP", "in focus", "in front",
               "behind", "views as good", "their ms", "times faster"]  # fmt: skip
    text = (
        "*Views as good* is how many views of the accumulation buffer reach the same PSNR, read off the curve through "
        "its own rows below (PSNR over the logarithm of the views); *times faster* is their time over the method's."
    )
    return Table("Every method against the reference at equal PSNR", text, columns, rows)


class Equal(NamedTuple):
    """Accumulation that is as good as a record: how many views, and their milliseconds."""

    views: float
    ms: float


def equal(record: dict, records: list[dict]) -> Equal | None:
    """The accumulation as good as `record` under the same lens; None without two numbers of views to go by."""
    same = ("scene", "distribution", "coc_px", "size")
    found = sorted(
        (r for r in records if r["method"] == "accumulation" and all(r[n] == record[n] for n in same)),
        key=lambda r: r["parameters"]["views"],
    )
    if len(found) < 2:
        return None
    # Straight lines through neighbours, the outermost carried on.
    upper = next((i for i, r in enumerate(found) if i and quality(r) >= quality(record)), len(found) - 1)
    low, high = found[upper - 1], found[upper]
    slope = (quality(high) - quality(low)) / math.log(high["parameters"]["views"] / low["parameters"]["views"])
    views = low["parameters"]["views"] * math.exp((quality(record) - quality(low)) / slope)
    views = min(max(views, 1.0), MOST_VIEWS)
    return Equal(views, views * found[-1]["ms"] / found[-1]["parameters"]["views"])


def beside_the_papers(records: list[dict]) -> Table:
    """Published figures beside those measured."""
    rows = []
    for claim, measured, word, reason in verdicts(records):
        here = "–" if measured is None else f"{measured:.1f} {claim.unit}"
        rows.append([claim.source, claim.what, f"{claim.published:g} {claim.unit}", here, f"**{word}**", reason])
    text = "Absolute times belong to other machines; compared are PSNR, ratios within one run, and orderings."
    return Table(
        "Beside the papers", text, ["source", "figure", "published", "here", "", "why, and how it is read"], rows
    )


def lenses(records: list[dict]) -> Table:
    """Each method judged through the lens that it is not made for, beside the one that it is."""
    rows = []
    for record in sorted(filter(is_default, records), key=_order):
        if record["method"] == "accumulation" or record["distribution"] != natural(record["method"]):
            continue
        same = ("scene", "method", "coc_px", "size", "parameters")
        for other in records:
            if all(other[n] == record[n] for n in same) and other["distribution"] != record["distribution"]:
                rows.append([
                    _scene(record), f"{record['coc_px']:g}", record["method"],
                    SHORT[record["distribution"]], _decibels(record, "psnr"), f"{record['ms']:.0f}",
                    SHORT[other["distribution"]], _decibels(other, "psnr"), f"{other['ms']:.0f}",
                ])  # fmt: skip
    columns = ["scene", "mean CoC px", "method", "made for", "PSNR dB", "ms", "also through", "PSNR dB", "ms"]
    text = "A blur that is Gaussian by nature is matched to a disc by its width (0.55 of the radius), not by its shape."
    return Table("The other lens", text, columns, rows)


def all_rows(records: list[dict]) -> list[Table]:
    """Every case, a table a scene."""
    tables = []
    for title in dict.fromkeys(map(_circumstances, records)):
        chosen = [r for r in records if _circumstances(r) == title]
        best = {id(r) for group in groups(chosen) for r in front(group)}
        rows = [_row(r, id(r) in best) for r in sorted(chosen, key=_order)]
        tables.append(Table(f"All cases: {title}", "", COLUMNS, rows))
    return tables


def _circumstances(record: dict) -> str:
    """The scene, and how it is seen where that is not its own way."""
    focus = "" if record.get("focus", OWN) == OWN else ", the farthest surface in focus"
    return record["scene"] + focus + ("" if record.get("guard") is None else f", guard band of {record['guard']} px")


COLUMNS = ["mean CoC px", "size", "lens", "method", "settings", "ms", "quartiles", "PSNR", "SSIM", "FLIP", "in focus",
           "in front", "behind", "reference", "on the front"]  # fmt: skip


def _row(record: dict, on_front: bool) -> list[str]:
    settings = ", ".join(f"{name} {value}" for name, value in record["parameters"].items()) or "default"
    zones = [_decibels(record, name) for name in ("psnr_focus", "psnr_foreground", "psnr_background")]
    vouched = "" if record["reference_self_psnr"] is None else f", {record['reference_self_psnr']:.1f} dB"
    return [
        f"{record['coc_px']:g}", "×".join(map(str, record["size"])), SHORT[record["distribution"]], record["method"],
        settings, f"{record['ms']:.1f}", f"{record['ms_lower']:.1f}–{record['ms_upper']:.1f} of {record['frames']}",
        _decibels(record, "psnr"), f"{record['ssim']:.4f}", _flip(record), *zones,
        f"{record['reference_views']} views{vouched}", "●" if on_front else "",
    ]  # fmt: skip


def groups(records: list[dict]) -> list[list[dict]]:
    """Records of one scene under one lens and size: what a Pareto front is drawn over."""
    found: dict[tuple, list[dict]] = {}
    for record in records:
        found.setdefault((record["distribution"], record["coc_px"], tuple(record["size"])), []).append(record)
    return list(found.values())


def _scene(record: dict) -> str:
    return record["scene"].removeprefix("demo:")


def _flip(record: dict) -> str:
    return "" if record.get("flip") is None else f"{record['flip']:.3f}"


def _decibels(record: dict, name: str) -> str:
    value = record.get(name, math.nan)
    return "" if value is None and name != "psnr" else "equal" if value is None else f"{value:.1f}"


def _order(record: dict) -> tuple:
    return (record["size"], record["coc_px"], record["scene"], METHODS.index(record["method"]), record["distribution"],
            record["ms"])  # fmt: skip
