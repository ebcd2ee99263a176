"""The report of a sweep: Markdown with its pictures beside it, and HTML with everything in one file."""

from __future__ import annotations

import base64
import html
import re
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

from dofview.bench import plots, tables
from dofview.bench.pareto import quality
from dofview.bench.pictures import sheet
from dofview.bench.plan import is_default, natural, own_view
from dofview.bench.store import Store
from dofview.bench.tables import Table
from dofview.export import write_whole
from dofview.methods import METHODS

TITLE = "Run time against error"
STYLE = (
    "body{font:15px/1.5 system-ui,sans-serif;margin:2em auto;max-width:1180px;padding:0 1em;color:#222}"
    "img{max-width:100%}table{border-collapse:collapse;font-size:12px;margin:1em 0;display:block;overflow-x:auto}"
    "td,th{padding:3px 9px;border-bottom:1px solid #e2e2e2;text-align:left;white-space:nowrap}"
    "th{background:#f6f6f6}.n{text-align:right}td:last-child{white-space:normal}"
)
_NUMBER = re.compile(r"$|–|equal|[-+*]*\d")
"""How a cell of figures begins; a column of them stands to the right."""
Block = str | Table | tuple[str, Path]
"""A paragraph or heading in Markdown, a table, or a picture with what it shows."""


def write_report(store: Store) -> None:
    """Write report.md, report.html and the pictures they show beside the results of `store`."""
    for name in ("plots", "sheets"):
        (store.folder / name).mkdir(exist_ok=True)
    blocks = list(_blocks(store))
    markdown = "\n\n".join(_markdown(block, store.folder) for block in blocks) + "\n"
    write_whole(store.folder / "report.md", lambda part: part.write_text(markdown, encoding="utf-8"))
    body = "\n".join(_html(block) for block in blocks)
    page = f"<!doctype html><meta charset=utf-8><title>dofview: {TITLE.lower()}</title><style>{STYLE}</style>{body}\n"
    write_whole(store.folder / "report.html", lambda part: part.write_text(page, encoding="utf-8"))


def _blocks(store: Store) -> Iterator[Block]:
    yield f"# {TITLE}"
    yield _head(store.records)
    records = list(filter(own_view, store.records))
    yield tables.summary([r for r in records if _usual(r, records)])
    yield "## Error against time"
    yield from _pareto(store, records)
    yield "## What a frame costs"
    yield from _costs(store, records)
    yield "## Pictures"
    yield "Above, what each method makes; below, how far it is from the reference through the same lens."
    yield from _sheets(store, records)
    yield tables.beside_the_papers(store.records)
    yield tables.lenses(records)
    yield from tables.all_rows(store.records)


def _head(records: list[dict]) -> str:
    if not records:
        return "Nothing was measured."
    machines = Counter(
        f"{r['renderer']}, OpenGL {r['gl']}, {r['processor']} ({r['cores']} cores), Python {r['python']}, "
        f"moderngl {r['moderngl']}, {r['system']}"
        for r in records
    )
    clocks = {r["clock"] for r in records}
    said = {
        "wall": "Frame times are wall time around `glFinish`.",
        "processor": "Frame times are the process's own processor time around `glFinish`: with LP_NUM_THREADS=0 the "
        "rasteriser runs in the calling thread, so this is the whole cost on one core, and it repeats within a few "
        "percent whatever else the machine does. With a thread for every core, pixels would take less time on the "
        "wall, geometry would not.",
    }  # fmt: skip
    dates = sorted({r["date"] for r in records})
    days = " to ".join(dict.fromkeys((dates[0], dates[-1])))
    return (
        f"{days}, dofview {records[0]['dofview']}, {len(records)} cases on {'; '.join(machines)}. "
        f"{' '.join(said[clock] for clock in sorted(clocks))} Medians over whole frames after a warm-up, in which "
        "nothing is kept from the frame before. Errors are against the reference through the same lens, not "
        "antialiased, as the methods are not; PSNR, SSIM and FLIP are of sRGB pictures. The reference vouches for the "
        "PSNR in the last column of the tables (the change since half as many views, which is on the safe side).\n\n"
        "Made by `LP_NUM_THREADS=0 dofview bench --out FOLDER`, which goes on where it was broken off and, with all "
        "results there, only makes these pages anew. Results: [results.csv](results.csv), [results.json](results.json)."
    )


def _usual(record: dict, records: list[dict]) -> bool:
    """Whether a record is of a whole scene at the size that most have, through the lens that the method is made for."""
    sizes = Counter(tuple(r["size"]) for r in records)
    usual = tuple(record["size"]) == sizes.most_common(1)[0][0] and "@" not in record["scene"]
    return usual and (record["method"] == "accumulation" or record["distribution"] == natural(record["method"]))


def _pareto(store: Store, records: list[dict]) -> Iterator[Block]:
    found = [r for r in records if _usual(r, records)]
    for coc in sorted({r["coc_px"] for r in found if not is_default(r)} or {r["coc_px"] for r in found}):
        panels = _by_scene([r for r in found if r["coc_px"] == coc])
        title = (
            f"PSNR over time, mean CoC {coc:g} px; to the upper left is better, the grey line is the Pareto front; "
            "filled points through a disc, hollow ones through a Gaussian lens"
        )
        yield _saved(store, f"pareto-{coc:g}px", plots.error_against_time(panels), title)


def _costs(store: Store, records: list[dict]) -> Iterator[Block]:
    usual = [r for r in records if _usual(r, records)]
    if len({r["coc_px"] for r in usual}) > 1:
        figure = plots.cost_against(_by_scene(usual), "coc_px", "mean CoC diameter, px")
        yield _saved(store, "coc", figure, "Cost against blur, every method with its defaults")
    middle = _middle(usual)
    varied = {}
    for across in ("pixels", "triangles"):
        if chosen := _varied(records, across, middle):
            scene = chosen[0]["scene"].split("@")[0].removeprefix("demo:")
            varied[across] = (f"{scene}, mean CoC {middle:g} px", chosen)
    if varied:
        yield _saved(store, "size", plots.cost_against_each(varied), f"Cost against {' and '.join(varied)}")
    bars = {
        scene: sorted((r for r in found if is_default(r) and r["coc_px"] == middle), key=_by_method)
        for scene, found in _by_scene([r for r in usual if r["method"] != "accumulation"]).items()
    }
    yield _saved(store, "passes", plots.pass_bars(bars), f"Shares of the passes, ms, mean CoC {middle:g} px")


def _varied(records: list[dict], across: str, coc: float) -> list[dict]:
    """The defaults of one scene that differ in pixels, or in triangles, and in nothing else."""
    best: list[dict] = []
    for scene in sorted({r["scene"].split("@")[0] for r in records}):
        found = [
            r for r in records
            if is_default(r) and r["coc_px"] == coc and r["scene"].split("@")[0] == scene
            and r["distribution"] == natural(r["method"])
        ]  # fmt: skip
        if across == "pixels":
            found = [r for r in found if "@" not in r["scene"]]
        else:
            sizes = Counter(tuple(r["size"]) for r in found)
            found = [r for r in found if tuple(r["size"]) == sizes.most_common(1)[0][0]]
        if len({plots.value_of(r, across) for r in found}) > len({plots.value_of(r, across) for r in best}):
            best = found
    return best if len({plots.value_of(r, across) for r in best}) > 1 else []


def _sheets(store: Store, records: list[dict]) -> Iterator[Block]:
    """A sheet a scene at the middle blur, made anew while the pictures of the cases are there."""
    usual = [r for r in records if _usual(r, records) and is_default(r)]
    middle = _middle(usual)
    for scene in dict.fromkeys(r["scene"] for r in usual):
        rows = []
        for record in sorted((r for r in usual if r["scene"] == scene and r["coc_px"] == middle), key=_by_method):
            path = store.folder / record.get("picture", "")
            if path.is_file() and (record["method"] != "accumulation" or record["distribution"] != "gaussian"):
                rows.append((path, f"{record['method']}, {quality(record):.1f} dB, {record['ms']:.0f} ms"))
        target = store.folder / "sheets" / f"{_plain(scene)}.jpg"
        if rows:
            sheet(target, rows)
        if target.is_file():
            yield f"{scene}, mean CoC {middle:g} px", target


def _middle(records: list[dict]) -> float:
    """The blur of the middle: where every quality was measured, or half way up the list."""
    found = sorted({r["coc_px"] for r in records if not is_default(r)} or {r["coc_px"] for r in records})
    return found[len(found) // 2]


def _saved(store: Store, name: str, figure, title: str) -> Block:
    path = store.folder / "plots" / f"{name}.png"
    plots.save(figure, path)
    return title, path


def _by_scene(records: list[dict]) -> dict[str, list[dict]]:
    found: dict[str, list[dict]] = {}
    for record in records:
        found.setdefault(record["scene"].removeprefix("demo:"), []).append(record)
    return dict(sorted(found.items()))


def _by_method(record: dict) -> int:
    return METHODS.index(record["method"])


def _plain(text: str) -> str:
    return re.sub(r"[^A-Za-z0-9.-]", "-", text.removeprefix("demo:"))


def _markdown(block: Block, folder: Path) -> str:
    if isinstance(block, str):
        return block
    if isinstance(block, Table):
        lines = [f"## {block.title}", "", *([block.text, ""] if block.text else [])]
        lines += ["| " + " | ".join(block.columns) + " |", "|" + "---|" * len(block.columns)]
        return "\n".join([*lines, *("| " + " | ".join(row) + " |" for row in block.rows)])
    title, path = block
    return f"{title}:\n\n![{title}]({path.relative_to(folder).as_posix()})"


def _html(block: Block) -> str:
    if isinstance(block, str):
        level = len(block) - len(block.lstrip("#"))
        return f"<h{level}>{_inline(block.lstrip('# '))}</h{level}>" if level else "".join(
            f"<p>{_inline(part)}</p>" for part in block.split("\n\n")
        )  # fmt: skip
    if isinstance(block, Table):
        numbers = [all(_NUMBER.match(row[place]) for row in block.rows) for place in range(len(block.columns))]
        kinds = [" class=n" if number else "" for number in numbers]
        head = "".join(f"<th{kind}>{html.escape(name)}</th>" for kind, name in zip(kinds, block.columns, strict=True))
        rows = (
            "".join(f"<td{k}>{_inline(cell)}</td>" for k, cell in zip(kinds, row, strict=True)) for row in block.rows
        )
        body = "".join(f"<tr>{cells}</tr>" for cells in rows)
        return f"<h2>{html.escape(block.title)}</h2><p>{_inline(block.text)}</p><table><tr>{head}</tr>{body}</table>"
    title, path = block
    kind = "png" if path.suffix == ".png" else "jpeg"
    data = base64.b64encode(path.read_bytes()).decode()
    return f"<figure><figcaption>{html.escape(title)}</figcaption><img src='data:image/{kind};base64,{data}'></figure>"


def _inline(text: str) -> str:
    """Bold, code and links of Markdown, as far as this report uses them."""
    text = html.escape(text, quote=False)
    for pattern, tag in ((r"\*\*(.+?)\*\*", "b"), (r"\*(.+?)\*", "i"), (r"`(.+?)`", "code")):
        text = re.sub(pattern, rf"<{tag}>\1</{tag}>", text)
    return re.sub(r"\[(.+?)\]\((.+?)\)", r"<a href='\2'>\1</a>", text)
