"""JSON objects of a glTF file, read by key with the type and range the specification asks for.

All the suspicion about JSON lives here: whatever stands in the file, a getter returns a value of the promised type and
range or raises ModelError naming the place.
"""

from __future__ import annotations

import json
import math
from typing import Any

from dofview.errors import ModelError
from dofview.scene.notes import one_line

REQUIRED: Any = object()
LARGEST_INTEGER = 2**53


class Fields:
    """A JSON object together with where it stands in the file, for messages such as `accessors[3].count`."""

    __slots__ = ("data", "where")

    def __init__(self, data: Any, where: str) -> None:
        if not isinstance(data, dict):
            raise ModelError(f"{where or 'the file'} is {_shown(data)}; accepted: a JSON object")
        self.data: dict[str, Any] = data
        self.where = where

    def fail(self, key: str, accepted: str) -> ModelError:
        """Make the error for a bad or missing value."""
        return ModelError(f"{self._place(key)} is {_shown(self.data.get(key))}; accepted: {accepted}")

    def integer(self, key: str, default: Any = REQUIRED, low: int = 0, high: int = LARGEST_INTEGER) -> Any:
        """An integer in [low, high]; 3.0 counts as 3."""
        value = self._get(key, default)
        if value is default:
            return value
        value = as_integer(value)
        if value is None or not low <= value <= high:
            raise self.fail(key, f"an integer from {low}" + (f" to {high}" if high < LARGEST_INTEGER else ""))
        return value

    def number(self, key: str, default: Any = REQUIRED) -> Any:
        """A finite number."""
        value = self._get(key, default)
        if value is default:
            return value
        if not _is_number(value):
            raise self.fail(key, "a finite number")
        return float(value)

    def numbers(self, key: str, count: int, default: Any = REQUIRED) -> Any:
        """A tuple of `count` finite numbers."""
        value = self._get(key, default)
        if value is default:
            return value
        if not isinstance(value, list) or len(value) != count or not all(map(_is_number, value)):
            raise self.fail(key, f"{count} finite numbers")
        return tuple(map(float, value))

    def flag(self, key: str, default: bool = False) -> bool:
        """A boolean."""
        value = self._get(key, default)
        if not isinstance(value, bool):
            raise self.fail(key, "true or false")
        return value

    def text(self, key: str, default: Any = REQUIRED) -> Any:
        """A string, as it stands."""
        value = self._get(key, default)
        if value is not default and not isinstance(value, str):
            raise self.fail(key, "a string")
        return value

    def name(self, default: str = "") -> str:
        """The object's name, fit to be shown; a name of the wrong type is no name."""
        value = self.data.get("name")
        return one_line(value, 100) if isinstance(value, str) and value else default

    def inside(self, key: str) -> Fields | None:
        """The object under `key`, None when there is none."""
        value = self.data.get(key)
        return None if value is None else Fields(value, self._place(key))

    def extension(self, name: str) -> Fields | None:
        """The object of an extension, None when it is not there."""
        extensions = self.inside("extensions")
        return None if extensions is None else extensions.inside(name)

    def array(self, key: str) -> list[Any]:
        """The array under `key`, empty when there is none."""
        value = self.data.get(key)
        if value is None:
            return []
        if not isinstance(value, list):
            raise self.fail(key, "an array")
        return value

    def objects(self, key: str) -> list[Fields]:
        """The array of objects under `key`."""
        place = self._place(key)
        return [Fields(value, f"{place}[{i}]") for i, value in enumerate(self.array(key))]

    def strings(self, key: str) -> list[str]:
        """The array of strings under `key`."""
        values = self.array(key)
        if not all(isinstance(value, str) for value in values):
            raise self.fail(key, "an array of strings")
        return values

    def _place(self, key: str) -> str:
        return f"{self.where}.{key}" if self.where else key

    def _get(self, key: str, default: Any) -> Any:
        value = self.data.get(key)
        if value is not None:
            return value
        if default is REQUIRED:
            raise ModelError(f"{self._place(key)} is missing")
        return default


def as_integer(value: Any) -> int | None:
    """The integer that a JSON value is, None when it is none; 3.0 counts as 3, true does not count."""
    if isinstance(value, float) and value.is_integer():
        return int(value)
    return value if type(value) is int else None


def _is_number(value: Any) -> bool:
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return False
    return abs(value) < 1e300 if isinstance(value, int) else math.isfinite(value)


def _shown(value: Any) -> str:
    if isinstance(value, dict):
        return "an object"
    if isinstance(value, list):
        return f"an array of {len(value)}"
    if isinstance(value, str):
        return f"'{one_line(value, 40)}'"
    if type(value) is int and abs(value) > LARGEST_INTEGER:
        return "a huge integer"  # Python refuses to print those of more than 4300 digits
    return json.dumps(value)
