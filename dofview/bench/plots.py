"""The report's diagrams; one colour a method, the same in all."""

from __future__ import annotations

import math
import statistics
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from dofview.bench.pareto import front, quality
from dofview.bench.plan import is_default
from dofview.export import write_whole
from dofview.methods import METHODS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure

# Okabe and Ito 2008: colours that stay apart for colour-blind readers; grey for the pinhole, black for the reference.
COLORS = {
    "pinhole": "#999999", "mipmap": "#E69F00", "splatting": "#009E73", "multiview": "#0072B2", "layered": "#D55E00",
    "pyramid": "#CC79A7", "accumulation": "#000000",
}  # fmt: skip
MOST_DB = 60.0
PANEL = (4.3, 3.4)
DPI = 110


def color(method: str) -> str:
    """The method's colour."""
    return COLORS.get(method, "#56B4E9")


def error_against_time(panels: dict[str, list[dict]]) -> Figure:
    """A panel a scene: time across, PSNR up, a line through the settings of each method, the Pareto front in grey.

    Filled: judged through a disc; hollow: through a Gaussian lens, as the method is made for.
    """
    figure, row = _figure(len(panels))
    for axes, (title, records) in zip(row, panels.items(), strict=True):
        _label(axes, title, "time of a frame, ms", "PSNR, dB")
        best = front(records)
        axes.step([r["ms"] for r in best], [_height(r) for r in best], where="post", color="#BBBBBB", lw=4, zorder=1,
                  solid_capstyle="round", label="front")  # fmt: skip
        for name, lens in _kinds(records):
            points = sorted((r for r in records if (r["method"], r["distribution"]) == (name, lens)), key=_time)
            disc = lens != "gaussian"
            label = name if disc or name != "accumulation" else None
            axes.plot([r["ms"] for r in points], [_height(r) for r in points], color=color(name), lw=1, marker="o",
                      ms=5, mfc=color(name) if disc else "white", label=label, zorder=3,
                      ls="-" if disc or name != "accumulation" else ":")  # fmt: skip
        axes.set_xscale("log")
        _ticks(axes.xaxis)
    _legend(figure, row)
    return figure


def cost_against(panels: dict[str, list[dict]], across: str, label: str) -> Figure:
    """A panel a title: milliseconds of each method's default over the field `across`, both axes logarithmic."""
    figure, row = _figure(len(panels))
    for axes, (title, records) in zip(row, panels.items(), strict=True):
        _cost(axes, title, records, across, label)
    _legend(figure, row)
    return figure


def cost_against_each(panels: dict[str, tuple[str, list[dict]]]) -> Figure:
    """A panel a field: title and records."""
    figure, row = _figure(len(panels))
    for axes, (across, (title, records)) in zip(row, panels.items(), strict=True):
        _cost(axes, title, records, across, across)
    _legend(figure, row)
    return figure


def _cost(axes: Axes, title: str, records: list[dict], across: str, label: str) -> None:
    _label(axes, title, label, "time of a frame, ms")
    for name in (name for name in METHODS if any(r["method"] == name for r in records)):
        found: dict[float, list[float]] = {}
        for record in records:
            if record["method"] == name and is_default(record):
                found.setdefault(value_of(record, across), []).append(record["ms"])
        xs = sorted(found)
        shown = f"{name}, 64 views" if name == "accumulation" else name
        axes.plot(xs, [statistics.median(found[x]) for x in xs], marker="o", ms=4, lw=1.2, color=color(name),
                  label=shown)  # fmt: skip
    axes.set_yscale("log")
    _ticks(axes.yaxis)
    axes.set_xscale("log")
    ticks = sorted({value_of(r, across) for r in records})
    axes.set_xticks(ticks, [_short(x) for x in ticks])
    axes.minorticks_off()


def pass_bars(panels: dict[str, list[dict]]) -> Figure:
    """A panel a scene, a bar a method: the shares of its passes, with their milliseconds where there is room, and the
    sum behind it."""
    from matplotlib.figure import Figure

    bars = sum(map(len, panels.values()))
    figure = Figure(figsize=(3.0 * PANEL[0], 0.55 * len(panels) + 0.27 * bars))
    for number, (title, records) in enumerate(panels.items(), 1):
        axes = figure.add_subplot(len(panels), 1, number)
        _label(axes, title, "", "")
        for place, record in enumerate(records):
            _bar(axes, place, record)
        axes.set_yticks(range(len(records)), [r["method"] for r in records], fontsize=8)
        axes.set_xlim(0.0, 1.08)
        axes.set_xticks([])
        axes.invert_yaxis()
        axes.grid(visible=False)
        axes.spines["bottom"].set_visible(False)
    figure.tight_layout()
    return figure


def _bar(axes: Axes, place: int, record: dict) -> None:
    whole, left = max(sum(record["passes_ms"].values()), 1e-9), 0.0
    for rank, (name, value) in enumerate(sorted(record["passes_ms"].items(), key=lambda item: -item[1])):
        share, text = value / whole, f"{name.split('/')[-1].replace('_', ' ')} {value:.0f}"
        axes.barh(place, share, 0.86, left=left, color=color(record["method"]), lw=0.6, edgecolor="white",
                  alpha=max(0.7 - 0.13 * rank, 0.12))  # fmt: skip
        if share > 0.0065 * len(text):
            axes.text(left + share / 2, place, text, ha="center", va="center", fontsize=7)
        left += share
    axes.text(1.005, place, f"{whole:.0f} ms", ha="left", va="center", fontsize=8)


def save(figure: Figure, path: Path) -> None:
    """Write `figure` as a PNG."""
    write_whole(path, lambda part: figure.savefig(part, format="png", dpi=DPI, metadata={"Software": None}))


def value_of(record: dict, name: str) -> float:
    """The field of a record, or its number of pixels."""
    return float(math.prod(record["size"])) if name == "pixels" else float(record[name])


def _kinds(records: Iterable[dict]) -> list[tuple[str, str]]:
    found = {(r["method"], r["distribution"]) for r in records}
    return sorted(found, key=lambda kind: (METHODS.index(kind[0]), kind[1] == "gaussian"))


def _height(record: dict) -> float:
    return min(quality(record), MOST_DB)


def _time(record: dict) -> float:
    return record["ms"]


def _short(value: float) -> str:
    for unit, name in ((1e6, "M"), (1e3, "k")):
        if value >= unit:
            return f"{value / unit:.3g}{name}"
    return f"{value:g}"


def _ticks(axis: Axis) -> None:
    """Plain numbers at 1, 2 and 5 of every decade of a logarithmic axis."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

    axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_locator(NullLocator())


def _figure(count: int, height: float = 1.0) -> tuple[Figure, list[Axes]]:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(PANEL[0] * max(count, 1), PANEL[1] * height))
    return figure, [figure.add_subplot(1, count, number + 1) for number in range(count)]


def _label(axes: Axes, title: str, across: str, up: str) -> None:
    axes.set_title(title, fontsize=10)
    axes.set_xlabel(across, fontsize=8)
    axes.set_ylabel(up, fontsize=8)
    axes.tick_params(labelsize=7)
    axes.grid(alpha=0.25, lw=0.5)
    axes.set_axisbelow(True)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)


def _legend(figure: Figure, row: list[Axes]) -> None:
    """One legend under all panels."""
    entries = {label: handle for axes in row for handle, label in zip(*axes.get_legend_handles_labels(), strict=True)}
    columns = min(len(entries), 4 * len(row))
    figure.tight_layout(rect=(0, 0.07 * -(-len(entries) // columns) + 0.02, 1, 1))
    figure.legend(entries.values(), entries.keys(), loc="lower center", ncols=columns, fontsize=8, frameon=False)
