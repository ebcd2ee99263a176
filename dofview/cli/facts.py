"""`dofview methods`, `info` and `doctor`: facts, as a table to read or as JSON to check."""

from __future__ import annotations

import json as jsonlib
import os
import platform
import sys
from typing import Any

from rich import box
from rich.console import Console
from rich.markup import escape
from rich.table import Table

import dofview
from dofview import fields
from dofview.errors import GLError
from dofview.methods import METHODS, method


def show_methods(name: str | None, json: bool) -> None:
    """Print all methods, or one with its parameters."""
    facts = [method_facts(one) for one in ([name] if name else METHODS)]
    if json:
        print(jsonlib.dumps(facts[0] if name else facts, indent=2, ensure_ascii=False))
    elif name:
        _show_method(facts[0])
    else:
        table = _table("method", "title", "parameters")
        for one in facts:
            table.add_row(one["name"], escape(one["title"]), ", ".join(row["flag"] for row in one["parameters"]))
        Console().print(table)


def method_facts(name: str) -> dict[str, Any]:
    """Everything a method declares about itself."""
    chosen = method(name)
    return {
        "name": name,
        "title": chosen.TITLE,
        "citation": chosen.CITATION,
        "opengl": _version(chosen.REQUIRES_GL),
        "parameters": fields.rows(chosen.Params),
    }


def show_scene(spec: str, json: bool) -> None:
    """Print what is in a scene."""
    from dofview.scene.info import describe
    from dofview.scene.load import load

    facts = describe(load(spec))
    if json:
        print(jsonlib.dumps(facts, indent=2))
        return
    table = _table("", "")
    for key, value in facts.items():
        if key != "warnings":
            table.add_row(key, escape(_short(value)))
    Console().print(table)
    for warning in facts.get("warnings", []):
        print(f"warning: {warning}")


def show_doctor(json: bool) -> None:
    """Print what OpenGL there is; GLError with the remedy when there is none that is enough."""
    facts = machine_facts()
    if json:
        print(jsonlib.dumps(facts, indent=2))
    else:
        table = _table("", "")
        for key, value in facts.items():
            table.add_row(key.replace("_", " "), escape(_short(value)))
        Console().print(table)
    if facts["problem"]:
        raise GLError(facts["problem"])


def machine_facts() -> dict[str, Any]:
    """Versions, what OpenGL offers without a screen, and whether a window could open."""
    facts: dict[str, Any] = {
        "dofview": dofview.__version__,
        "python": platform.python_version(),
        "system": f"{platform.system()} {platform.release()} {platform.machine()}",
        "screen": screen() or "none: the window needs one, everything else does not",
        "problem": None,
    }
    try:
        return {**facts, **_gl_facts()}
    except GLError as error:
        return {**facts, "problem": str(error)}


def screen() -> str | None:
    """The display a window would open on, None when there is none."""
    if not sys.platform.startswith("linux"):
        return platform.system()
    for name in ("WAYLAND_DISPLAY", "DISPLAY"):
        if os.environ.get(name):
            return f"{name}={os.environ[name]}"
    return None


def _gl_facts() -> dict[str, Any]:
    from dofview.gl.context import create_headless

    gpu = create_headless()
    try:
        info = gpu.ctx.info
        return {
            "opengl": info["GL_VERSION"],
            "renderer": gpu.renderer,
            "software": gpu.software,
            "max_texture_size": gpu.max_size,
            "max_array_layers": gpu.max_layers,
            "max_anisotropy": gpu.ctx.max_anisotropy,
            "max_samples": gpu.ctx.max_samples,
            "max_color_attachments": info["GL_MAX_COLOR_ATTACHMENTS"],
            "methods": [name for name in METHODS if gpu.version_code >= method(name).REQUIRES_GL],
            "methods_missing": {
                name: f"needs OpenGL {_version(method(name).REQUIRES_GL)}"
                for name in METHODS
                if gpu.version_code < method(name).REQUIRES_GL
            },
        }
    finally:
        gpu.release()
        gpu.ctx.release()


def _show_method(facts: dict[str, Any]) -> None:
    console = Console()
    console.print(f"[bold]{facts['name']}[/bold]: {escape(facts['title'])} (OpenGL {facts['opengl']})")
    console.print(escape(facts["citation"]), soft_wrap=True)
    table = _table("flag", "symbol", "default", "accepted", "what it does")
    for row in facts["parameters"]:
        table.add_row(*(escape(row[key]) for key in ("flag", "symbol", "default", "accepted", "description")))
    if facts["parameters"]:
        console.print(table)


def _table(*columns: str) -> Table:
    table = Table(box=box.SIMPLE_HEAD if any(columns) else None, show_header=any(columns), pad_edge=False)
    for number, column in enumerate(columns):
        table.add_column(column, no_wrap=number == 0, overflow="fold")
    return table


def _short(value: Any) -> str:
    if isinstance(value, dict):
        return ", ".join(f"{key}: {_short(item)}" for key, item in value.items()) or "–"
    if isinstance(value, list) and value and isinstance(value[0], dict):
        return f"{len(value)}: " + _short([item.get("name") or "unnamed" for item in value])
    if isinstance(value, list):
        more = f" … {len(value) - 8} more" if len(value) > 8 else ""
        return ", ".join(_short(item) for item in value[:8]) + more if value else "–"
    return fields.shown(value)


def _version(code: int) -> str:
    return f"{code // 100}.{code % 100 // 10}"
