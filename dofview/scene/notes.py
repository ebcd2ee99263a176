"""What a reader left out or repaired, collected while reading and handed over as `Scene.warnings`."""

from __future__ import annotations

import unicodedata

MOST_WARNINGS = 200
MOST_CHARACTERS = 300


def one_line(text: object, length: int = MOST_CHARACTERS) -> str:
    """Make any text safe for a terminal, a window and a log: one line, no control characters or lone surrogates."""
    clipped = str(text)[: length + 1]
    clean = "".join(" " if c in "\t\r\n" else c if _printable(c) else "\ufffd" for c in clipped)
    return clean if len(clean) <= length else clean[: length - 1] + "…"


def _printable(character: str) -> bool:
    # Cc control, Cs surrogate, Cf direction overrides and the like, Zl and Zp line separators.
    return character.isascii() and character.isprintable() or unicodedata.category(character) not in _HIDDEN


_HIDDEN = {"Cc", "Cs", "Cf", "Zl", "Zp", "Cn"}


class Notes:
    """Warnings in the order they first came up, each said once; repeated ones are counted instead."""

    def __init__(self) -> None:
        self._counts: dict[tuple[str, str, str], int] = {}

    def say(self, text: str) -> None:
        """Note something once."""
        self._add((one_line(text), "", ""), 1)

    def count(self, one: str, many: str, what: str, times: int = 1) -> None:
        """Count something: ("node", "nodes", "not shown") becomes "1 node not shown" or "3 nodes not shown"."""
        self._add((one, many, what), times)

    def _add(self, key: tuple[str, str, str], times: int) -> None:
        if times > 0 and (key in self._counts or len(self._counts) <= MOST_WARNINGS):
            self._counts[key] = self._counts.get(key, 0) + times

    def texts(self) -> tuple[str, ...]:
        """All warnings as sentences without a full stop."""
        lines = [
            one if not many else f"{times} {one if times == 1 else many} {what}".rstrip()
            for (one, many, what), times in self._counts.items()
        ]
        return tuple(lines[:MOST_WARNINGS] + ["further warnings not listed"] * (len(lines) > MOST_WARNINGS))
