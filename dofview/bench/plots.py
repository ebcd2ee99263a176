"""The report's diagrams, as SVG text; one colour a method, the same in all."""

from __future__ import annotations

import io
import math

from dofview.bench.pareto import front, quality
from dofview.bench.plan import is_default
from dofview.methods import METHODS

# Okabe and Ito 2008: eight colours that stay apart for colour-blind readers.
COLORS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#999999", "#F0E442")
MOST_DB = 70.0


def color(method: str) -> str:
    """The method's colour."""
    return COLORS[METHODS.index(method) % len(COLORS)] if method in METHODS else "#000000"


def error_against_time(records: list[dict], title: str) -> str:
    """One point a setting, time across on a logarithmic scale, PSNR up, the Pareto front as a line."""
    figure, axes = _axes(title, "ms a frame", "PSNR, dB")
    for name in sorted({r["method"] for r in records}):
        points = [r for r in records if r["method"] == name]
        heights = [min(quality(r), MOST_DB) for r in points]
        axes.scatter([r["ms"] for r in points], heights, color=color(name), label=name, s=22, zorder=3)
    best = front(records)
    axes.step([r["ms"] for r in best], [min(quality(r), MOST_DB) for r in best], where="post", color="#444444", lw=0.8)
    axes.set_xscale("log")
    axes.legend(fontsize=7, frameon=False)
    return _svg(figure)


def cost_against(records: list[dict], across: str, title: str, label: str) -> str:
    """Median milliseconds of each method's default over the field `across`."""
    figure, axes = _axes(title, label, "ms a frame")
    for name in sorted({r["method"] for r in records}):
        found: dict[float, list[float]] = {}
        for record in records:
            if record["method"] == name and is_default(record):
                found.setdefault(_across(record, across), []).append(record["ms"])
        xs = sorted(found)
        if len(xs) > 1:
            axes.plot(xs, [_median(found[x]) for x in xs], marker="o", ms=3, color=color(name), label=name)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.legend(fontsize=7, frameon=False)
    return _svg(figure)


def pass_bars(records: list[dict], title: str) -> str:
    """Time by pass, stacked, one bar a method."""
    figure, axes = _axes(title, "", "ms")
    for number, record in enumerate(records):
        bottom = 0.0
        shades = sorted(record["passes_ms"].items(), key=lambda item: -item[1])
        for rank, (name, value) in enumerate(shades):
            axes.bar(number, value, bottom=bottom, color=color(record["method"]), alpha=max(1.0 - 0.12 * rank, 0.15),
                     edgecolor="white", lw=0.4)  # fmt: skip
            if value > 0.12 * sum(record["passes_ms"].values()):
                axes.text(number, bottom + value / 2, name.split("/")[-1], ha="center", va="center", fontsize=5)
            bottom += value
    axes.set_xticks(range(len(records)), [r["method"] for r in records], fontsize=7, rotation=20)
    return _svg(figure)


def _across(record: dict, name: str) -> float:
    return float(math.prod(record["size"])) if name == "pixels" else float(record[name])


def _median(values: list[float]) -> float:
    ordered = sorted(values)
    middle = len(ordered) // 2
    return ordered[middle] if len(ordered) % 2 else 0.5 * (ordered[middle - 1] + ordered[middle])


def _axes(title: str, across: str, up: str):
    import matplotlib

    matplotlib.use("svg")
    from matplotlib.figure import Figure

    figure = Figure(figsize=(5.2, 3.6))
    axes = figure.add_subplot()
    axes.set_title(title, fontsize=9)
    axes.set_xlabel(across, fontsize=8)
    axes.set_ylabel(up, fontsize=8)
    axes.tick_params(labelsize=7)
    axes.grid(alpha=0.25, lw=0.5)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    return figure, axes


def _svg(figure) -> str:
    text = io.StringIO()
    figure.tight_layout()
    figure.savefig(text, format="svg", metadata={"Date": None})
    return text.getvalue()[text.getvalue().index("<svg") :]
