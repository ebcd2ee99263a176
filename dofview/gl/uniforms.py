"""A GLSL std140 block and its bytes from a declaration in Python, so that no number is declared twice.

Fields that a shader can hold are taken in order: float, int, bool, an enum (its index) and tuples of 2–4 floats or
ints. Others (paths, text, optional values) stay in Python.
"""

from __future__ import annotations

import struct
from enum import Enum
from functools import cache, lru_cache
from typing import get_args, get_origin

from pydantic import BaseModel

# GLSL type: (std140 alignment, struct format)
_LAYOUT = {
    "float": (4, "f"), "int": (4, "i"), "vec2": (8, "2f"), "ivec2": (8, "2i"),
    "vec3": (16, "3f"), "ivec3": (16, "3i"), "vec4": (16, "4f"), "ivec4": (16, "4i"),
}  # fmt: skip


def _glsl_type(annotation: object) -> str | None:
    if annotation is float:
        return "float"
    if annotation in (int, bool) or (isinstance(annotation, type) and issubclass(annotation, Enum)):
        return "int"
    if get_origin(annotation) is tuple:
        kinds = set(get_args(annotation))
        count = len(get_args(annotation))
        if 2 <= count <= 4 and kinds in ({float}, {int}):
            return ("vec" if kinds == {float} else "ivec") + str(count)
    return None


@cache
def _fields(model: type[BaseModel]) -> tuple[tuple[str, str, int], ...]:
    """(name, GLSL type, byte offset) of every field a shader can hold."""
    found, offset = [], 0
    for name, info in model.model_fields.items():
        kind = _glsl_type(info.annotation)
        if kind is not None:
            alignment, code = _LAYOUT[kind]
            offset = -(-offset // alignment) * alignment
            found.append((name, kind, offset))
            offset += struct.calcsize("<" + code)
    return tuple(found)


@cache
def block_glsl(model: type[BaseModel], name: str) -> str:
    """GLSL text of `model` as the std140 block `name`, its instance named in lower case; enums become defines."""
    fields = _fields(model)
    if not fields:
        return ""
    lines = []
    for field, info in model.model_fields.items():
        if isinstance(info.annotation, type) and issubclass(info.annotation, Enum):
            for index, member in enumerate(info.annotation):
                lines.append(f"#define {field.upper()}_{member.name} {index}")
    members = "".join(f"    {kind} {field};\n" for field, kind, _ in fields)
    return "\n".join([*lines, f"layout(std140) uniform {name}\n{{\n{members}}} {name.lower()};"])


@lru_cache(maxsize=256)
def block_bytes(values: BaseModel) -> bytes:
    """The bytes of `values`, which is frozen, in the layout of `block_glsl`, padded to 16."""
    fields = _fields(type(values))
    if not fields:
        return b""
    _, kind, offset = fields[-1]
    size = offset + struct.calcsize("<" + _LAYOUT[kind][1])
    data = bytearray(-(-size // 16) * 16)
    for name, kind, offset in fields:
        value = getattr(values, name)
        if isinstance(value, Enum):
            value = list(type(value)).index(value)
        struct.pack_into("<" + _LAYOUT[kind][1], data, offset, *(value if isinstance(value, tuple) else (value,)))
    return bytes(data)
