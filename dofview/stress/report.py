"""What a stress run found as Markdown: each invariant with its worst value beside its bound, method by method."""

from __future__ import annotations

from collections.abc import Sequence

from dofview.stress.long import MOST_KB, Growth
from dofview.stress.row import COLUMNS, Row
from dofview.stress.run import Report


def rows_table(report: Report, rows: Sequence[Row]) -> str:
    """One line a value that is measured, one column a method: the worst value, and its bound in brackets."""
    lines = ["| row | invariant | value | " + " | ".join(COLUMNS) + " |", "|" + "---|" * (3 + len(COLUMNS))]
    for row in sorted(rows, key=lambda row: row.number):
        values = dict.fromkeys(what for number, _, what in report.worst if number == row.number)
        for place, what in enumerate(values):
            cells = [_cell(report.worst.get((row.number, method, what))) for method in COLUMNS]
            first = (str(row.number), row.name) if place == 0 else ("", "")
            lines.append(f"| {first[0]} | {first[1]} | {what} | " + " | ".join(cells) + " |")
        if row.number in report.skipped:
            left_out = f"left out: {report.skipped[row.number]}"
            lines.append(f"| {row.number} | {row.name} | {left_out} |" + " |" * len(COLUMNS))
    return "\n".join(lines)


def _cell(found: tuple[float, float] | None) -> str:
    return "–" if found is None else f"{_number(found[0])} ({found[1]:g})"


def _number(value: float) -> str:
    return "0" if value == 0.0 else f"{value:.3g}"


def long_table(found: Sequence[Growth]) -> str:
    """One line a long run: what it left over."""
    lines = [
        f"| what | cycles | OpenGL objects | kB a cycle (at most {MOST_KB:g}) | files | threads | children |",
        "|---|---|---|---|---|---|---|",
    ]
    for run in found:
        lines.append(
            f"| {run.name} | {run.cycles} | {run.objects:+d} | {run.kb_per_cycle:.2f} | {run.files:+d} | "
            f"{run.threads:+d} | {run.children} |"
        )
    return "\n".join(lines)


def convergence_table(errors: Sequence[dict[int, float]]) -> str:
    """RMS error by number of views: the worst and the mean of several scenes, and what N^-1/2 makes of the first."""
    counts = list(errors[0])
    worst = [max(one[count] for one in errors) for count in counts]
    lines = ["| views | worst RMSE | mean RMSE | N^-1/2 of the worst at 16 |", "|---|---|---|---|"]
    for count, most in zip(counts, worst, strict=True):
        mean = sum(one[count] for one in errors) / len(errors)
        lines.append(f"| {count} | {most:.2g} | {mean:.2g} | {worst[0] * (counts[0] / count) ** 0.5:.2g} |")
    return "\n".join(lines)
