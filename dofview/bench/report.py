"""The report of a sweep: Markdown for reading in place, HTML with diagrams and pictures in one file."""

from __future__ import annotations

import base64
import html
import math
from collections import Counter
from collections.abc import Iterator
from datetime import date
from pathlib import Path

from dofview.bench import plots
from dofview.bench.papers import verdicts
from dofview.bench.pareto import front, quality
from dofview.bench.plan import is_default
from dofview.bench.store import Store
from dofview.export import write_whole

Table = tuple[str, list[str], list[list[str]]]


def write_report(store: Store) -> None:
    """Write report.md and report.html beside the results of `store`."""
    tables = list(_tables(store.records))
    head = _head(store.records)
    markdown = "\n\n".join([f"# Run time against error\n\n{head}", *(_markdown(*table) for table in tables)]) + "\n"
    write_whole(store.folder / "report.md", lambda part: part.write_text(markdown, encoding="utf-8"))
    page = _page(head, tables, store)
    write_whole(store.folder / "report.html", lambda part: part.write_text(page, encoding="utf-8"))


def _head(records: list[dict]) -> str:
    machines = Counter(f"{r['renderer']}, OpenGL {r['gl']}, Python {r['python']}, {r['system']}" for r in records)
    clocks = ", ".join(sorted({r["clock"] for r in records}))
    return (
        f"{date.today().isoformat()}, dofview {records[0]['dofview'] if records else ''}: {len(records)} cases on "
        f"{'; '.join(machines)}. Frame times are wall time around finish, medians over whole frames; passes are "
        f"timed by the {clocks} clock. Errors are against the reference with the same lens, not antialiased."
    )


def _tables(records: list[dict]) -> Iterator[Table]:
    for scene in dict.fromkeys(r["scene"] for r in records):
        chosen = [r for r in records if r["scene"] == scene]
        best = {id(r) for group in _lenses(chosen) for r in front(group)}
        yield f"Error and time: {scene}", COLUMNS, [_row(r, id(r) in best) for r in sorted(chosen, key=_order)]
    rows = []
    for verdict in verdicts(records):
        measured = "–" if verdict.measured is None else f"{verdict.measured:.2f}"
        claim = verdict.claim
        rows.append([claim.source, claim.what, f"{claim.published:g} {claim.unit}", measured, verdict.word])
    yield "Beside the papers", ["source", "figure", "published", "here", ""], rows


COLUMNS = ["mean CoC px", "size", "lens", "method", "settings", "ms", "quartiles", "PSNR", "SSIM", "in focus", "front",
           "behind", "reference", "front?"]  # fmt: skip


def _row(record: dict, on_front: bool) -> list[str]:
    settings = ", ".join(f"{name} {value}" for name, value in record["parameters"].items()) or "default"
    zones = [_decibels(record, name) for name in ("psnr_focus", "psnr_foreground", "psnr_background")]
    return [
        f"{record['coc_px']:g}", "x".join(map(str, record["size"])), record["distribution"], record["method"], settings,
        f"{record['ms']:.1f}", f"{record['ms_lower']:.1f}–{record['ms_upper']:.1f}", _decibels(record, "psnr"),
        f"{record['ssim']:.4f}", *zones, f"{record['reference_views']} views, {record['reference_self_psnr']} dB",
        "●" if on_front else "",
    ]  # fmt: skip


def _decibels(record: dict, name: str) -> str:
    value = record.get(name, math.nan)
    return "" if value is None and name != "psnr" else "equal" if value is None else f"{value:.2f}"


def _order(record: dict) -> tuple:
    return record["size"], record["coc_px"], record["distribution"], record["method"], record["ms"]


def _lenses(records: list[dict]) -> list[list[dict]]:
    """Records of one scene under one lens and size: what a Pareto front is drawn over."""
    groups: dict[tuple, list[dict]] = {}
    for record in records:
        groups.setdefault((record["distribution"], record["coc_px"], tuple(record["size"])), []).append(record)
    return list(groups.values())


def _markdown(title: str, columns: list[str], rows: list[list[str]]) -> str:
    lines = [f"## {title}", "", "| " + " | ".join(columns) + " |", "|" + "---|" * len(columns)]
    return "\n".join([*lines, *("| " + " | ".join(row) + " |" for row in rows)])


def _page(head: str, tables: list[Table], store: Store) -> str:
    records = store.records
    parts = [f"<h1>Run time against error</h1><p>{html.escape(head)}</p>"]
    for scene in dict.fromkeys(r["scene"] for r in records):
        chosen = [r for r in records if r["scene"] == scene]
        for group in _lenses(chosen):
            first = group[0]
            title = f"{scene}, mean CoC {first['coc_px']:g} px, {first['distribution']}"
            parts.append(plots.error_against_time(group, title))
        middle = sorted({r["coc_px"] for r in chosen})[len({r["coc_px"] for r in chosen}) // 2]
        defaults = [r for r in chosen if r["coc_px"] == middle and is_default(r)]
        parts.append(plots.pass_bars(defaults, f"{scene}: time by pass, mean CoC {middle:g} px"))
    for across, label in (("coc_px", "mean CoC diameter, px"), ("pixels", "pixels"), ("triangles", "triangles")):
        if len({plots._across(r, across) for r in records}) > 1:
            parts.append(plots.cost_against(records, across, f"Cost against {label}", label))
    parts += [_html_table(*table) for table in tables]
    parts.append(_thumbnails(store))
    style = (
        "body{font:14px sans-serif;margin:2em;max-width:1100px}table{border-collapse:collapse;font-size:12px}"
        "td,th{padding:2px 8px;border-bottom:1px solid #ddd;text-align:right}figure{display:inline-block;margin:4px}"
        "figcaption{font-size:11px}"
    )
    return f"<!doctype html><meta charset=utf-8><title>dofview</title><style>{style}</style>" + "\n".join(parts)


def _html_table(title: str, columns: list[str], rows: list[list[str]]) -> str:
    head = "".join(f"<th>{html.escape(c)}</th>" for c in columns)
    body = "".join("<tr>" + "".join(f"<td>{html.escape(cell)}</td>" for cell in row) + "</tr>" for row in rows)
    return f"<h2>{html.escape(title)}</h2><table><tr>{head}</tr>{body}</table>"


def _thumbnails(store: Store) -> str:
    found = []
    for record in sorted(store.records, key=_order):
        path = store.folder / record.get("picture", "")
        if record.get("picture") and path.is_file():
            caption = f"{record['scene']} {record['method']} CoC {record['coc_px']:g}: {quality(record):.1f} dB"
            image = f"<img width=200 src='{_inline(path)}'>"
            found.append(f"<figure>{image}<figcaption>{html.escape(caption)}</figcaption></figure>")
    return "<h2>Pictures</h2>" + "".join(found)


def _inline(path: Path) -> str:
    """The picture as a small JPEG inside the page."""
    import io

    from PIL import Image

    stream = io.BytesIO()
    picture = Image.open(path).convert("RGB")
    picture.thumbnail((200, 200))
    picture.save(stream, format="JPEG", quality=80)
    return "data:image/jpeg;base64," + base64.b64encode(stream.getvalue()).decode()
