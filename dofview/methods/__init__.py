"""The list of methods. Adding one is a module here, a folder in shaders/methods and a word in `METHODS`."""

from __future__ import annotations

from importlib import import_module

from dofview.errors import SettingsError
from dofview.methods.method import Method

METHODS = ("pinhole", "mipmap", "splatting", "multiview", "layered", "pyramid", "accumulation")


def method(name: str) -> Method:
    """Return the method called `name`."""
    if name not in METHODS:
        raise SettingsError(f"no method {name!r}; accepted: {', '.join(METHODS)}")
    return import_module(f"dofview.methods.{name}")  # type: ignore[return-value]
