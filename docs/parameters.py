"""Write the parameter tables of docs/methods/*.md from the declarations in the code: `make docs`.

A table stands between <!-- parameters --> and <!-- /parameters -->. With `--check` nothing is written,
and the exit status is 1 when a table is old.
"""

from __future__ import annotations

import sys
from pathlib import Path

from dofview import fields
from dofview.methods import METHODS, method

PAGES = Path(__file__).parent / "methods"
BEGIN, END = "<!-- parameters -->", "<!-- /parameters -->"


def table(name: str) -> str:
    """The parameters of the method `name` as a Markdown table."""
    rows = fields.rows(method(name).Params)
    if not rows:
        return "None."
    lines = ["| name, flag | symbol | default | accepted | what it does |", "|---|---|---|---|---|"]
    for row in rows:
        cells = (f"`{row['flag']}`", row["symbol"], row["default"], row["accepted"], row["description"])
        lines.append("| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |")
    return "\n".join(lines)


def page(name: str, text: str) -> str:
    """`text` with the table of the method `name` in its place, at the end when it has none yet."""
    head, begin, rest = text.partition(BEGIN)
    if not begin:
        head = text.rstrip() + "\n\n## Parameters\n\n"
    tail = rest.partition(END)[2] if END in rest else rest
    return f"{head}{BEGIN}\n{table(name)}\n{END}\n{tail.lstrip()}"


def new_page(name: str) -> str:
    """The least a page says: what the method is called and where it comes from."""
    return f"# {method(name).TITLE}\n\n{method(name).CITATION}\n"


def main(check: bool) -> int:
    """Write every page that is not current, or name them; the number of those."""
    PAGES.mkdir(exist_ok=True)
    old = 0
    for name in METHODS:
        path = PAGES / f"{name}.md"
        text = path.read_text(encoding="utf-8") if path.exists() else new_page(name)
        fresh = page(name, text)
        if not path.exists() or fresh != text:
            old += 1
            print(f"{'not current' if check else 'wrote'}: {path}")
            if not check:
                path.write_text(fresh, encoding="utf-8")
    return old


if __name__ == "__main__":
    wrong = main("--check" in sys.argv[1:])
    sys.exit(1 if wrong and "--check" in sys.argv[1:] else 0)
