"""Settings that travel: inside a picture's metadata, so that the picture can be made again, and as presets in TOML."""

from __future__ import annotations

import json
import tomllib
from pathlib import Path
from typing import NamedTuple

from pydantic import BaseModel, ValidationError

import dofview
from dofview.errors import InputError, SettingsError
from dofview.export import NOTE, write_whole
from dofview.methods import METHODS
from dofview.reading import check_regular, read_small, silent
from dofview.seen.model import Seen
from dofview.settings import Settings, checked, explain

MOST_BYTES = 1 << 20
PRESET_PARTS = ("lens", "method", "params", "image", "display", "background_linear")
"""What a preset says: how a scene is looked at, not which nor from where."""


class Remembered(NamedTuple):
    """What a picture says of itself: the scene it shows, the settings it was made with, and what of them is seen."""

    spec: str
    settings: Settings
    seen: Seen | None = None


def note(spec: str, settings: Settings, seen: Seen | None = None) -> str:
    """The text that `read_note` understands."""
    values = {NOTE: dofview.__version__, "scene": spec, "settings": settings.model_dump(mode="json")}
    return json.dumps(values | ({} if seen is None else {"seen": seen.model_dump(mode="json")}))


def read_note(path: Path) -> Remembered:
    """Return what the PNG or EXR `path` says of itself; InputError when it says nothing or cannot be read."""
    text = _note_of(path)
    try:
        found = json.loads(text)
        spec, values = str(found["scene"]), found["settings"]
    except (ValueError, RecursionError, KeyError, TypeError) as error:
        raise InputError(f"{path}: its settings cannot be read; accepted: a picture saved by dofview") from error
    seen = checked(Seen, found["seen"], f"{path}: seen") if "seen" in found else None
    return Remembered(spec, checked(Settings, values, str(path)), seen)


def _note_of(path: Path) -> str:
    kind = path.suffix.lower()
    check_regular(path, "the picture")
    try:
        if kind == ".exr":
            import OpenEXR

            with silent(), OpenEXR.File(str(path), header_only=True) as file:
                text = file.header().get(NOTE)
        else:
            from PIL import Image

            with Image.open(path, formats=["PNG"]) as picture:
                picture.load()
                text = picture.info.get(NOTE)
    except (OSError, RuntimeError, ValueError, SyntaxError) as error:
        raise InputError(f"{path}: cannot read the picture: {error}") from error
    if not isinstance(text, str) or len(text) > MOST_BYTES:
        raise InputError(f"{path}: no settings in this picture; accepted: a PNG or EXR saved by dofview")
    return text


def write_preset(path: Path, settings: Settings) -> None:
    """Write lens, method, parameters, size and display of `settings` as TOML, whole or not at all."""
    import tomlkit

    values = settings.model_dump(mode="json", include=set(PRESET_PARTS), exclude_none=True)
    values["image"].pop("size")
    text = tomlkit.dumps(values)
    write_whole(path, lambda part: part.write_text(text, encoding="utf-8"))


def read_preset(path: Path, base: Settings) -> tuple[Settings, list[str]]:
    """Return `base` with what the preset says, and a line for each value that is of no use; the rest is kept.

    SettingsError only when the file cannot be read or is not TOML.
    """
    try:
        values = tomllib.loads(read_small(path, "preset", MOST_BYTES))
    except InputError as error:
        raise SettingsError(str(error)) from error
    except (ValueError, RecursionError) as error:
        raise SettingsError(f"{path}: not a TOML preset: {error}") from error
    complaints: list[str] = []
    settings = base
    for name in values.keys() - set(PRESET_PARTS):
        complaints.append(f"{path}: {name[:40]!r} is not part of a preset; accepted: {', '.join(PRESET_PARTS)}")
    for name in PRESET_PARTS:
        if name in values:
            settings = _with_part(settings, name, values[name], str(path), complaints)
    return settings, complaints


def _with_part(settings: Settings, name: str, value: object, where: str, complaints: list[str]) -> Settings:
    before = getattr(settings, name)
    if name == "params":
        if not isinstance(value, dict):
            complaints.append(f"{where}: params is {str(value)[:40]!r}; accepted: a table for each method")
            return settings
        changed = {
            m: _kept(getattr(before, m), value[m], f"{where}: params.{m}", complaints) for m in METHODS if m in value
        }
        complaints += [f"{where}: no method {m[:40]!r}" for m in value.keys() - set(METHODS)]
        return settings.with_(params=before.model_copy(update=changed))
    if isinstance(before, BaseModel):
        return settings.with_(**{name: _kept(before, value, f"{where}: {name}", complaints)})
    try:
        if name == "method" and value not in METHODS:
            raise SettingsError(f"no method {str(value)[:40]!r}; accepted: {', '.join(METHODS)}")
        return settings.with_(**{name: value})
    except SettingsError as error:
        complaints.append(f"{where}: {error}")
        return settings


def _kept(before: BaseModel, values: object, where: str, complaints: list[str]) -> BaseModel:
    """`before` with each of `values` that is accepted; a line for each other one."""
    if not isinstance(values, dict):
        complaints.append(f"{where} is {str(values)[:40]!r}; accepted: a table")
        return before
    kept = before.model_dump()
    for name, value in values.items():
        if name not in type(before).model_fields:
            complaints.append(f"{where}: no {name[:40]!r}; accepted: {', '.join(type(before).model_fields)}")
            continue
        try:
            type(before).model_validate({**kept, name: value})
            kept[name] = value
        except ValidationError as error:
            complaints.append(explain(error, type(before), where))
    return type(before).model_validate(kept)
