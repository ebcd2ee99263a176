"""Counts what shaders really fetch: every call of a texture function also adds one to a counter of its shader.

A count beside a formula says whether loops end where they are thought to end and tiles are left out; a clock does not.
The counters are shader storage, so OpenGL 4.3 is needed. The picture is the same; it takes longer.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import NamedTuple

import moderngl
import numpy as np

from dofview.errors import GLError
from dofview.gl.shaders import Defines, ShaderLibrary, Source

REQUIRED = 430
MOST_SHADERS = 1024
BINDING = 0
_CALL = re.compile(r"\b(?:texture(?:Lod|Grad|Gather|Offset|LodOffset)?|texelFetch(?:Offset)?)\s*\(")
_MAIN = re.compile(r"void\s+main\s*\(\s*\)\s*\{")


class Count(NamedTuple):
    """Of one shader with one set of defines: fragments it ran for, and fetches made by all of them. A bilinear fetch is
    one, a gather of four texels too."""

    shader: str
    defines: dict[str, object]
    fragments: int
    fetches: int


class CountingLibrary(ShaderLibrary):
    """Compiles the shaders of full-screen passes so that they count; those that draw the scene are as they were."""

    def __init__(self, ctx: moderngl.Context):
        if ctx.version_code < REQUIRED:
            raise GLError(f"counting fetches needs OpenGL {REQUIRED // 100}.{REQUIRED % 100 // 10}")
        super().__init__(ctx)
        self._version = REQUIRED
        self._slots: dict[tuple[str, tuple], int] = {}
        self._counters = ctx.buffer(reserve=MOST_SHADERS * 8)
        self.clear()

    def clear(self) -> None:
        """Begin at 0."""
        self._ctx.finish()
        self._counters.clear()
        self._counters.bind_to_storage_buffer(BINDING)

    def counts(self) -> list[Count]:
        """What was counted since `clear`."""
        self._ctx.finish()
        found = np.frombuffer(self._counters.read(), np.uint32).reshape(-1, 2).tolist()
        return [
            Count(path, dict(defines), *found[slot])
            for (path, defines), slot in self._slots.items() if found[slot][0]
        ]  # fmt: skip

    def release(self) -> None:
        super().release()
        self._counters.release()

    def _source(self, path: str, defines: Defines, blocks: Mapping[str, str]) -> Source:
        source = super()._source(path, defines, blocks)
        if not path.endswith(".frag") or path.startswith("render/scene"):
            return source
        slot = self._slots.setdefault((path, tuple(defines.items())), len(self._slots))
        if slot >= MOST_SHADERS:
            raise GLError(f"more than {MOST_SHADERS} shaders to count in")
        return Source(counting(source.text, slot), [*source.origins[:1], *[("counting", 0)] * 2, *source.origins[1:]])


def counting(text: str, slot: int) -> str:
    """`text` with its fragments and fetches counted in `slot`; after the first line there are two more."""
    counter = f"counted_[{slot}]"
    parts, at, closing = [], 0, []
    # A call becomes (atomicAdd(…), call): the comma evaluates both and is worth the call.
    for match in re.finditer(rf"{_CALL.pattern}|[()]", text):
        token = match[0]
        if len(token) > 1:
            parts += [text[at : match.start()], f"(atomicAdd({counter}.y, 1u), ", token]
            closing.append("))")
        elif token == "(":
            parts += [text[at : match.end()]]
            closing.append(")")
        else:
            parts += [text[at : match.start()], closing.pop()]
        at = match.end()
    text = "".join([*parts, text[at:]])
    text = _MAIN.sub(lambda found: f"{found[0]} atomicAdd({counter}.x, 1u);", text)
    version, _, rest = text.partition("\n")
    # The word is reserved from 4.3 on, and a name in shaders of 4.1.
    declared = f"layout(std430, binding = {BINDING}) buffer Counted {{ uvec2 counted_[]; }};\n#define buffer buffer_"
    return f"{version}\n{declared}\n{rest}"
