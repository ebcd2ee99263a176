"""Shader files to programs: includes, defines, errors that name the file and line, and reload that keeps what worked.

Text is flattened here rather than by `#line`, which drivers treat differently: every flat line remembers the file and
line it came from, so a driver's message can be pointed at the right place.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import moderngl

from dofview.data import SHADERS
from dofview.errors import ShaderError

_INCLUDE = re.compile(r'^\s*#include\s+(?:"(?P<path>[^"]+)"|<(?P<name>\w+)>)')
_UNIFORM = re.compile(r"^\s*uniform\s+(?:(?:lowp|mediump|highp)\s+)?(?P<type>\w+)\s+(?P<name>\w+)", re.MULTILINE)
_BLOCK = re.compile(r"^\s*layout\s*\(\s*std140\s*\)\s*uniform\s+(?P<name>\w+)", re.MULTILINE)
_MESSAGE_LINE = re.compile(r"\b0[:(](\d+)\)?")
_STAGES = {".vert": "vertex_shader", ".geom": "geometry_shader", ".frag": "fragment_shader"}

Defines = Mapping[str, object]


@dataclass
class Source:
    """Flat shader text with the origin of each of its lines."""

    text: str
    origins: list[tuple[str, int]]


def flatten(path: str, defines: Defines, blocks: Mapping[str, str], version: int) -> Source:
    """Return `path` (relative to shaders/) with its includes in place.

    `#include "file"` takes a file; `#include <NAME>` takes the text of `blocks[NAME]`, or the file that the define NAME
    names, or nothing when it is neither: the hook by which a pass hands the scene shader a test of its own.
    """
    lines = [f"#version {version} core"]
    origins = [(path, 0)]
    for name, value in defines.items():
        if not isinstance(value, str):
            lines.append(f"#define {name} {int(value) if isinstance(value, bool) else value}")
            origins.append(("defines", 0))
    seen: set[str] = set()

    def add_text(text: str, origin: str) -> None:
        for number, line in enumerate(text.splitlines(), 1):
            match = _INCLUDE.match(line)
            if match is None:
                lines.append(line)
                origins.append((origin, number))
            elif match["path"]:
                add_file(match["path"], f"{origin}:{number}")
            elif match["name"] in blocks:
                if match["name"] not in seen:
                    seen.add(match["name"])
                    add_text(blocks[match["name"]], f"<{match['name']}>")
            elif isinstance(defines.get(match["name"]), str):
                add_file(str(defines[match["name"]]), f"{origin}:{number}")

    def add_file(name: str, where: str) -> None:
        if name in seen:
            return
        seen.add(name)
        try:
            text = (SHADERS / name).read_text(encoding="utf-8")
        except OSError as error:
            raise ShaderError(f"{where}: cannot read shader {name}: {error.strerror}") from error
        add_text(text, name)

    add_file(path, "program")
    return Source("\n".join(lines) + "\n", origins)


def explain(message: str, source: Source) -> str:
    """Point a driver's compile message at file:line, with the line quoted."""
    match = _MESSAGE_LINE.search(message)
    first = next((line for line in message.splitlines() if _MESSAGE_LINE.search(line)), message.strip())
    if match is None or not 0 < int(match[1]) <= len(source.origins):
        return first
    index = int(match[1]) - 1
    file, number = source.origins[index]
    return f"{file}:{number}: {first.strip()}\n    {source.text.splitlines()[index].strip()}"


@dataclass
class Program:
    """A linked program with the names its source declares, so that a misspelt one is told from an unused one."""

    gl: Any  # moderngl.Program, whose members have one type for uniforms, blocks and attributes
    samplers: frozenset[str]
    values: frozenset[str]
    blocks: frozenset[str]
    members: Mapping[str, Any]
    """Uniforms, blocks and attributes that the compiler left, by name; `gl` would search for them every time."""
    arrays: dict[int, moderngl.VertexArray] = field(default_factory=dict)

    def release(self) -> None:
        for array in self.arrays.values():
            array.release()
        self.arrays.clear()
        self.gl.release()


class ShaderLibrary:
    """Compiles each combination of files and defines once."""

    def __init__(self, ctx: moderngl.Context):
        self._ctx = ctx
        self._version = 410 if ctx.version_code >= 410 else 330
        self._programs: dict[tuple, Program] = {}
        self._requests: dict[tuple, tuple] = {}
        self._stamp = self._newest()
        self.error: str | None = None

    def program(self, *paths: str, defines: Defines | None = None, blocks: Mapping[str, str] | None = None) -> Program:
        """Return the program of these stages; suffixes .vert, .geom and .frag say which is which."""
        defines, blocks = dict(defines or {}), dict(blocks or {})
        key = (paths, tuple(defines.items()), tuple(blocks.items()))
        if key not in self._programs:
            self._programs[key] = self._build(paths, defines, blocks)
            self._requests[key] = (paths, defines, blocks)
        return self._programs[key]

    def reload(self) -> bool:
        """Rebuild every program when a shader file has changed; one that fails keeps its last working version."""
        stamp = self._newest()
        if stamp == self._stamp:
            return False
        self._stamp = stamp
        self.error = None
        for key, request in self._requests.items():
            try:
                fresh = self._build(*request)
            except ShaderError as error:
                self.error = str(error)
                continue
            self._programs[key].release()
            self._programs[key] = fresh
        return True

    def release(self) -> None:
        for program in self._programs.values():
            program.release()
        self._programs.clear()
        self._requests.clear()

    def _build(self, paths: tuple[str, ...], defines: Defines, blocks: Mapping[str, str]) -> Program:
        sources = {Path(p).suffix: self._source(p, defines, blocks) for p in paths}
        stages = {_STAGES[suffix]: source.text for suffix, source in sources.items()}
        try:
            program = self._ctx.program(**stages)  # type: ignore[arg-type]
        except moderngl.Error as error:
            message = str(error)
            suffix = next((s for s, stage in _STAGES.items() if stage in message), Path(paths[-1]).suffix)
            raise ShaderError(explain(message, sources.get(suffix, next(iter(sources.values()))))) from error
        text = "\n".join(source.text for source in sources.values())
        declared = [(m["type"], m["name"]) for m in _UNIFORM.finditer(text)]
        samplers = frozenset(name for kind, name in declared if "sampler" in kind)
        values = frozenset(name for kind, name in declared if "sampler" not in kind)
        names = frozenset(m["name"] for m in _BLOCK.finditer(text))
        return Program(program, samplers, values, names, {name: program[name] for name in program})

    def _source(self, path: str, defines: Defines, blocks: Mapping[str, str]) -> Source:
        """The text of one stage."""
        return flatten(path, defines, blocks, self._version)

    @staticmethod
    def _newest() -> float:
        return max((p.stat().st_mtime for p in SHADERS.rglob("*") if p.is_file()), default=0.0)
