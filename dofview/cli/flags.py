"""Flags made from the declarations of lens, image and method parameters.

A flag hands over the text that was typed; pydantic reads it and checks its range, so that the command line, a view file
and a slider refuse the same values in the same words.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any

from cyclopts import Group, Parameter
from pydantic import BaseModel

from dofview import fields
from dofview.lens import Lens, Photographic
from dofview.methods import METHODS, method
from dofview.render.environment import Lighting
from dofview.settings import LARGEST_SIDE, ImageSettings

Given = dict[str, dict[str, Any]]
"""What was typed: by group ("lens", "params", …) and field."""

NAMES = {
    "radius": ("--radius", "--lens-radius"),
    "focus_distance": ("--focus", "--focus-distance"),
    "rotation_deg": ("--rotation",),
    "image": ("--aperture-image",),
    "focal_length_mm": ("--focal-length",),
    "sensor_height_mm": ("--sensor-height",),
    "size": ("--size",),
    "scale": ("--scale",),
    "guard_px": ("--guard",),
}
"""Flags of lens and image that are not named as their field."""
METAVARS = {int: "INT", float: "NUMBER", Path: "FILE", str: "NAME"}
SIZE_HELP = f"Width and height, as 1024x768 [sides from 1 to {LARGEST_SIDE} px]."


def of_settings(chosen: str | None) -> list[inspect.Parameter]:
    """The flags of every command that makes a picture: lens, image, and the parameters of the method `chosen`."""
    found = [
        *of_model("image", ImageSettings, Group("Picture", sort_key=2), NAMES),
        *of_model("lens", Lens, Group("Lens", sort_key=3), NAMES),
        *of_model("light", Lighting, Group("Light", sort_key=4), NAMES),
        *of_model("photo", Photographic, Group("Lens", sort_key=3), NAMES),
    ]
    if chosen is not None:
        found += of_model("params", method(chosen).Params, Group(f"Parameters of {chosen}", sort_key=1), defaults=True)
    return found


def of_model(
    title: str, model: type[BaseModel], group: Group, names: Mapping[str, Sequence[str]] | None = None,
    defaults: bool = False,
) -> list[inspect.Parameter]:  # fmt: skip
    """One keyword parameter a field, called title__field; its value is None when the flag is not given."""
    found = []
    for name, field in model.model_fields.items():
        kind = fields.kind(field) or str
        notes = [fields.accepted(field), f"default {fields.shown(field.default)}" if defaults else ""]
        how = Parameter(
            name=tuple((names or {}).get(name, (fields.flag(name),))),
            help=SIZE_HELP if name == "size" else " ".join(filter(None, [field.description, *_bracketed(notes)])),
            metavar=None if kind is bool else "WxH" if name == "size" else METAVARS.get(kind, "CHOICE"),
            group=group, show_default=False,
        )  # fmt: skip
        # Text as it was typed, except for a switch, which is there or not.
        typed: Any = bool if kind is bool else str
        found.append(
            inspect.Parameter(
                f"{title}__{name}",
                inspect.Parameter.KEYWORD_ONLY,
                default=None,
                annotation=Annotated[typed | None, how],
            )
        )
    return found


def with_flags(function: Callable[..., Any], flags: Iterable[inspect.Parameter]) -> Callable[..., Any]:
    """`function(…, given)` as a command that takes `flags` and hands those that were typed over as `given`."""
    signature = inspect.signature(function, eval_str=True)
    own = [p for p in signature.parameters.values() if p.name != "given"]
    flags = list(flags)

    def command(*args: Any, **typed: Any) -> Any:
        given: Given = {}
        for flag in flags:
            value = typed.pop(flag.name, None)
            if value is not None:
                title, _, name = flag.name.partition("__")
                given.setdefault(title, {})[name] = value
        return function(*args, **typed, given=given)

    command.__name__, command.__doc__ = function.__name__, function.__doc__
    command.__signature__ = signature.replace(parameters=[*own, *flags])  # type: ignore[attr-defined]
    command.__annotations__ = {p.name: p.annotation for p in [*own, *flags]}
    return command


def named_method(tokens: Sequence[str]) -> str | None:
    """The method that `tokens` name, before they are parsed: its parameters decide which flags there are."""
    for position, token in enumerate(tokens):
        name, equals, value = token.partition("=")
        if name in ("--method", "-m"):
            value = value if equals else next(iter(tokens[position + 1 :]), "")
            return value if value in METHODS else None
    return None


def joined_switches(tokens: Sequence[str], chosen: str | None) -> list[str]:
    """`--antialias true` as `--antialias=true`, so that a switch may be set like any other parameter."""
    model = method(chosen).Params if chosen else None
    switches = {fields.flag(n) for n, f in model.model_fields.items() if fields.kind(f) is bool} if model else set()
    found: list[str] = []
    for token in tokens:
        if found and found[-1] in switches and token.lower() in ("true", "false"):
            found[-1] += f"={token}"
        else:
            found.append(token)
    return found


def owners(flag: str) -> list[str]:
    """The methods that have a parameter of this flag."""
    return [name for name in METHODS if flag in map(fields.flag, method(name).Params.model_fields)]


def _bracketed(notes: Sequence[str]) -> list[str]:
    text = "; ".join(filter(None, notes))
    return [f"[{text}]"] if text else []
