"""Results on disk: a line of JSON a case, written as soon as it is measured, so that nothing measured is lost."""

from __future__ import annotations

import csv
import io
import json
from functools import partial
from pathlib import Path

from dofview.bench.plan import Case
from dofview.errors import InputError, OutputError
from dofview.export import write_whole


class Store:
    """The results in a folder; opening it again goes on where a sweep was broken off."""

    def __init__(self, folder: Path):
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise OutputError(
                f"cannot make the folder {str(folder)!r}: {(error.strerror or str(error)).lower()}"
            ) from error
        self.folder = folder
        self._lines = folder / "results.jsonl"
        self.records: list[dict] = self._read()
        self._known = {record["key"] for record in self.records}

    def has(self, case: Case) -> bool:
        """Whether the case was measured before."""
        return case.key in self._known

    def add(self, case: Case, record: dict) -> None:
        """Append a record; it is on disk when this returns."""
        record = {"key": case.key, **record}
        try:
            with self._lines.open("a", encoding="utf-8") as stream:
                stream.write(json.dumps(record) + "\n")
        except OSError as error:
            raise OutputError(f"{self._lines}: cannot write: {(error.strerror or str(error)).lower()}") from error
        self.records.append(record)
        self._known.add(case.key)

    def write_tables(self) -> None:
        """Write all records as results.json and, flat, as results.csv."""
        write_whole(self.folder / "results.json", lambda part: part.write_text(json.dumps(self.records, indent=1)))
        columns: dict[str, None] = {}
        flat = []
        for record in self.records:
            row = {
                name: json.dumps(value) if isinstance(value, dict | list) else value for name, value in record.items()
            }
            row.pop("key", None)
            flat.append(row)
            columns |= dict.fromkeys(row)
        text = io.StringIO()
        writer = csv.DictWriter(text, list(columns))
        writer.writeheader()
        writer.writerows(flat)
        write_whole(self.folder / "results.csv", lambda part: part.write_text(text.getvalue(), newline=""))

    def _read(self) -> list[dict]:
        if not self._lines.exists():
            return []
        records = []
        lines = self._lines.read_text(encoding="utf-8").splitlines()
        for number, line in enumerate(lines, 1):
            try:
                records.append(json.loads(line))
            except ValueError as error:
                # A run that was killed while writing leaves its last line cut: it goes. Any other is damage.
                if number == len(lines):
                    write_whole(self._lines, partial(_write_lines, lines[:-1]))
                    break
                raise InputError(f"{self._lines}:{number}: not a result: {error}") from error
        return records


def _write_lines(lines: list[str], part: Path) -> None:
    part.write_text("".join(line + "\n" for line in lines), encoding="utf-8")
