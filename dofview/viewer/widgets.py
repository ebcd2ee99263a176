"""Controls made from declarations: one function turns a field of a pydantic model into the control it deserves."""

from __future__ import annotations

import math
from collections.abc import Mapping
from enum import Enum
from typing import Any, TypeVar

from imgui_bundle import imgui
from pydantic import BaseModel
from pydantic.fields import FieldInfo

from dofview import fields

M = TypeVar("M", bound=BaseModel)
LOGARITHMIC_FROM = 1000.0


def edit(model: M, *, only: tuple[str, ...] = (), ranges: Mapping[str, tuple[float, float]] | None = None) -> M:
    """Show a control for every field (or `only` some) and return the model as the person left it.

    `only` also orders them. `ranges` gives sliders a range that suits the scene where the declared one is far wider.
    Double-click types a value, right-click goes back to the default.
    """
    changes: dict[str, Any] = {}
    for name in only or type(model).model_fields:
        info = type(model).model_fields[name]
        before = getattr(model, name)
        after = _control(name, info, before, (ranges or {}).get(name))
        if imgui.is_item_hovered(imgui.HoveredFlags_.for_tooltip):
            imgui.set_tooltip(tooltip(name, info))
        if imgui.begin_popup_context_item(f"{name}##reset"):
            if imgui.menu_item_simple(f"Back to {fields.shown(info.default)}"):
                after = info.default
            imgui.end_popup()
        if after != before:
            changes[name] = after
    return model.model_validate({**model.model_dump(), **changes}) if changes else model


UNITS = {"deg": "°", "px": "px", "mm": "mm", "ev": "EV", "ms": "ms", "s": "s", "hz": "Hz", "m": "m"}
"""What the last word of a name says of its unit."""

WORDS = {
    "radius": "lens radius", "distribution": "shape of the lens", "vfov_deg": "angle of view", "tonemap": "tone curve",
    "dots_per_mm": "dots a millimetre", "unit_m": "scene unit", "blur_px": "largest blur", "dwell_s": "dwell time",
}  # fmt: skip
"""Names that say more where they stand alone."""


def label(name: str, info: FieldInfo) -> str:
    """What stands beside the control: the name in words, and the paper's symbol."""
    symbol = fields.extra(info, "symbol")
    head, _, last = name.rpartition("_")
    words = WORDS.get(name, (head if head and last in UNITS else name).replace("_", " "))
    return f"{words} ({symbol})##{name}" if symbol else f"{words}##{name}"


def unit(name: str, info: FieldInfo) -> str:
    """The unit that is written after a value; empty where there is none or it needs more words."""
    head, _, last = name.rpartition("_")
    found = fields.extra(info, "unit") or (UNITS.get(last, "") if head else "")
    return found if len(found) <= 3 and "_per_" not in name else ""


def plain(text: str) -> str:
    """Text from a file, safe in a label: imgui takes what follows ## for an identifier."""
    return text.replace("#", "\uff03")


def tooltip(name: str, info: FieldInfo) -> str:
    """Description, what is accepted, and the default of a field."""
    lines = [info.description or name.replace("_", " "), f"default {fields.shown(info.default)}"]
    accepted = fields.accepted(info)
    return "\n".join([lines[0], f"{accepted}; {lines[1]}" if accepted else lines[1]])


def _control(name: str, info: FieldInfo, value: Any, wanted: tuple[float, float] | None) -> Any:
    text = label(name, info)
    if isinstance(value, bool):
        return imgui.checkbox(text, value)[1]
    if isinstance(value, Enum):
        members = list(type(value))
        words = [fields.shown(m.value).replace("_", " ") for m in members]
        chosen = imgui.combo(text, members.index(value), words)[1]
        return members[chosen]
    low, high = wanted or fields.bounds(info)[:2]
    if isinstance(value, int):
        return _int_slider(text, value, int(low or 0), int(high or 100), unit(name, info))
    if isinstance(value, float):
        return _float_slider(text, value, low, high, unit(name, info))
    imgui.label_text(text, fields.shown(value))
    return value


def _int_slider(text: str, value: int, low: int, high: int, after: str) -> int:
    flags = imgui.SliderFlags_.always_clamp
    if high - low >= LOGARITHMIC_FROM:
        flags |= imgui.SliderFlags_.logarithmic
    return imgui.slider_int(text, value, low, high, f"%d {after}".strip(), flags)[1]


def _float_slider(text: str, value: float, low: float | None, high: float | None, after: str) -> float:
    low, high = low if low is not None else 0.0, high if high is not None else max(2.0 * abs(value), 1.0)
    flags = imgui.SliderFlags_.always_clamp
    spread = high / low if low > 0.0 else (high / 1e-3 if low == 0.0 else 1.0)
    if spread >= LOGARITHMIC_FROM:
        flags |= imgui.SliderFlags_.logarithmic
    shown = value if math.isfinite(value) else high
    format_ = f"%.{_decimals(shown, high)}f {after}".strip() if math.isfinite(value) else "infinity"
    changed, chosen = imgui.slider_float(text, shown, low, high, format_, flags)
    return chosen if changed else value


def _decimals(value: float, high: float) -> int:
    """As many as show four digits of the value; zero has as many as the end of its range."""
    size = abs(value) or abs(high)
    return max(0, min(6, 3 - math.floor(math.log10(max(size, 1e-6)))))
