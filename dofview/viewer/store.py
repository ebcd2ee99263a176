"""What the viewer remembers from one day to the next: recent files, the last view of each, how the interface looks.

One JSON file in the folder that the system keeps for such things, replaced whole. What cannot be read or written is
left out with a message; nothing depends on it.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from enum import StrEnum
from pathlib import Path
from typing import Any

import platformdirs
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from dofview.errors import OutputError
from dofview.export import write_whole
from dofview.settings import explain

MOST_RECENT, MOST_VIEWS = 12, 200
MOST_BYTES = 4 << 20


class Theme(StrEnum):
    """Colours of the interface."""

    DARK = "dark"
    LIGHT = "light"


class Interface(BaseModel):
    """How the interface looks and moves."""

    model_config = ConfigDict(frozen=True, allow_inf_nan=False)

    scale: float = Field(
        default=1.0, ge=0.5, le=3.0, description="Size of text and controls, times what the screen asks for."
    )
    theme: Theme = Field(default=Theme.DARK, description="Colours of the interface.")
    reduced_motion: bool = Field(
        default=False, description="Views change at once and the focus jumps, where both would glide."
    )


class Saved(BaseModel):
    """The content of the file; `views` are view files by the scene they belong to, the last used last."""

    model_config = ConfigDict(frozen=True)

    recent: tuple[str, ...] = ()
    views: dict[str, dict[str, Any]] = {}
    interface: Interface = Interface()

    def opened(self, spec: str) -> Saved:
        """With `spec` as the most recent scene."""
        recent = (spec, *(other for other in self.recent if other != spec))
        return self.model_copy(update={"recent": recent[:MOST_RECENT]})

    def seen(self, spec: str, view: dict[str, Any]) -> Saved:
        """With `view` as the last view of `spec`."""
        views = {name: other for name, other in self.views.items() if name != spec} | {spec: view}
        return self.model_copy(update={"views": dict(list(views.items())[-MOST_VIEWS:])})


class Store:
    """The file, or nothing when `path` is None; `problem` says in one line what last went wrong."""

    def __init__(self, path: Path | None):
        self.path = path
        self.problem = ""
        self.saved = self._read()

    def change(self, change: Callable[[Saved], Saved]) -> None:
        """Apply `change` to what is saved by now, which another window may have changed, and save that."""
        if self.path is None:
            self.saved = change(self.saved)
            return
        self.saved = change(self._read())
        text = json.dumps(self.saved.model_dump(mode="json"), indent=1)
        try:
            self.path.parent.mkdir(parents=True, exist_ok=True)
            write_whole(self.path, lambda part: part.write_text(text, encoding="utf-8"))
        except OutputError as error:
            self.problem = str(error)
        except OSError as error:
            self.problem = f"cannot save {self.path}: {(error.strerror or str(error)).lower()}"

    def _read(self) -> Saved:
        try:
            if self.path is None or not self.path.exists():
                return Saved()
            if self.path.stat().st_size > MOST_BYTES:
                raise ValueError(f"more than {MOST_BYTES >> 20} MiB")
            found = json.loads(self.path.read_text(encoding="utf-8"))
            return self._valid(found if isinstance(found, dict) else {})
        except OSError as error:
            self.problem = f"{self.path}: cannot read: {(error.strerror or str(error)).lower()}"
        except (ValueError, RecursionError) as error:
            self.problem = f"{self.path}: begun anew: {error}"
        return Saved()

    def _valid(self, found: dict[str, Any]) -> Saved:
        """What is right in `found`; the rest is as on the first day."""
        saved = Saved()
        for name in Saved.model_fields.keys() & found.keys():
            try:
                saved = Saved.model_validate({**dict(saved), name: found[name]})
            except ValidationError as error:
                self.problem = f"{self.path}: {explain(error, Saved)}"
        return saved


def default_path() -> Path:
    """Where the system keeps the state of programs."""
    return platformdirs.user_state_path("dofview", appauthor=False) / "viewer.json"
