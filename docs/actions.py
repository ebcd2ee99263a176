"""Write the tables of docs/viewer.md from the viewer's own entries: `make docs`.

A table stands between <!-- NAME --> and <!-- /NAME -->. With `--check` nothing is written, and the exit status is 1
when a table is old.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

from dofview import fields
from dofview.focus import GazeSettings
from dofview.viewer import viewport
from dofview.viewer.actions import ACTIONS
from dofview.viewer.tools import TOOLS

PAGE = Path(__file__).parent / "viewer.md"


def tables() -> dict[str, str]:
    """Every table by its name."""
    tools = [tool() for tool in TOOLS]
    actions = [*ACTIONS, *(action for tool in tools for action in tool.actions())]
    gestures = [*viewport.GESTURES, *(gesture for tool in tools for gesture in tool.gestures())]
    for tool in tools:
        tool.release()
    by_menu = [a for menu in dict.fromkeys(a.menu for a in actions) for a in actions if a.menu == menu]
    return {
        "gestures": _table(("mouse over the picture", "what it does"), gestures),
        "actions": _table(
            ("menu", "action", "key", "what it does"),
            [(a.menu, a.name, f"`{a.key_text}`" if a.key_text else "", a.help) for a in by_menu],
        ),
        "gaze": _table(
            ("setting", "default", "accepted", "what it does"),
            [(row["name"], row["default"], row["accepted"], row["description"]) for row in fields.rows(GazeSettings)],
        ),
    }


def page(text: str) -> str:
    """`text` with every table in its place."""
    for name, table in tables().items():
        marks = rf"(<!-- {name} -->\n).*?(<!-- /{name} -->)"
        text, found = re.subn(marks, lambda match, table=table: f"{match[1]}{table}\n{match[2]}", text, flags=re.DOTALL)
        if not found:
            raise ValueError(f"{PAGE.name} has no place for the table {name}")
    return text


def _table(head: tuple[str, ...], rows: list[tuple[str, ...]]) -> str:
    lines = [" | ".join(head), " | ".join("---" for _ in head)]
    lines += [" | ".join(cell.replace("|", "\\|") for cell in row) for row in rows]
    return "\n".join(f"| {line} |" for line in lines)


def main(check: bool) -> int:
    """Write the page, or say that it is not current."""
    text = PAGE.read_text(encoding="utf-8")
    fresh = page(text)
    if fresh == text:
        return 0
    print(f"{'not current' if check else 'wrote'}: {PAGE}")
    if not check:
        PAGE.write_text(fresh, encoding="utf-8")
    return int(check)


if __name__ == "__main__":
    sys.exit(main("--check" in sys.argv[1:]))
