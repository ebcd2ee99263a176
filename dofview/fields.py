"""What a declared field says of itself in words: its range, unit, default and flag.

The command line, the error messages, the window and the docs all describe a parameter from here, so they cannot differ.
"""

from __future__ import annotations

import types
from enum import Enum
from pathlib import Path
from typing import Any, Union, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo


def kind(field: FieldInfo) -> type | None:
    """The plain type of a field, without "or nothing": float, int, bool, an enum, Path, tuple."""
    annotation: Any = field.annotation
    if get_origin(annotation) in (Union, types.UnionType):
        annotation = next(a for a in get_args(annotation) if a is not type(None))
    return get_origin(annotation) or annotation


def bounds(field: FieldInfo) -> tuple[float | None, float | None, bool, bool]:
    """(lowest, highest, lowest is excluded, highest is excluded); None where there is no bound."""
    low = high = None
    open_low = open_high = False
    for rule in field.metadata:
        if getattr(rule, "ge", None) is not None:
            low = rule.ge
        if getattr(rule, "gt", None) is not None:
            low, open_low = rule.gt, True
        if getattr(rule, "le", None) is not None:
            high = rule.le
        if getattr(rule, "lt", None) is not None:
            high, open_high = rule.lt, True
    return low, high, open_low, open_high


def extra(field: FieldInfo, key: str) -> str:
    """The field's "unit" or "symbol", empty when it has none."""
    values = field.json_schema_extra
    return str(values.get(key, "")) if isinstance(values, dict) else ""


def accepted(field: FieldInfo) -> str:
    """What a field accepts: "0 to 1 px", "a whole number from 1 to 64", "true or false", "hard, smooth"."""
    plain = kind(field)
    if plain is bool:
        return "true or false"
    if isinstance(plain, type) and issubclass(plain, Enum):
        return ", ".join(str(member.value) for member in plain)
    if plain is Path:
        return "a file"
    if plain not in (int, float):
        return ""
    return " ".join(filter(None, [_range(field, plain), extra(field, "unit")]))


def shown(value: object) -> str:
    """A value as it is typed and read: 0.5, true, uniform_disc, and a dash for nothing."""
    if value is None:
        return "–"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, Enum):
        return str(value.value)
    return f"{value:g}" if isinstance(value, float) else str(value)


def flag(name: str) -> str:
    """The command-line flag of a field."""
    return "--" + name.replace("_", "-")


def rows(model: type[BaseModel]) -> list[dict[str, str]]:
    """One row a field: name, flag, symbol, default, accepted, description."""
    return [
        {
            "name": name,
            "flag": flag(name),
            "symbol": extra(field, "symbol"),
            "default": shown(field.default),
            "accepted": accepted(field),
            "description": field.description or "",
        }
        for name, field in model.model_fields.items()
    ]


def _range(field: FieldInfo, plain: type) -> str:
    low, high, open_low, open_high = bounds(field)
    noun = "a whole number" if plain is int else "a number"
    below = "below " if open_high else ""
    if low is None and high is None:
        return noun
    if high is None:
        return f"{noun} above {low:g}" if open_low else f"{noun} of at least {low:g}"
    if low is None:
        return f"{noun} below {high:g}" if open_high else f"{noun} of at most {high:g}"
    if open_low:
        return f"{noun} above {low:g}, {below or 'up to '}{high:g}"
    return f"{noun} from {low:g} to {below}{high:g}"
