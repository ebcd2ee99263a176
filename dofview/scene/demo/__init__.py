"""Procedural demo scenes, each made to ask one question of a depth-of-field method, with the view to ask it from.

`build("foreground")` gives the scene, `build("foreground@216k")` the same shapes cut into about 216,000 triangles,
and `view("foreground")` its view file. Every scene is the same on every run. The circle of confusion (CoC) that each
promises is a signed radius in pixels at 512×384, and the tests hold it.
"""

from __future__ import annotations

import copy
import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from dofview.errors import ModelError
from dofview.scene.camera import Camera
from dofview.scene.demo import background, foreground, highlights, rail, studies
from dofview.scene.demo.parts import Part, assemble
from dofview.scene.model import Scene


@dataclass(frozen=True)
class Demo:
    """What a demo scene shows, the CoC radius (lowest, highest) in its picture, its view file and its parts."""

    about: str
    coc: tuple[float, float]
    view: dict[str, Any]
    parts: Callable[[], list[Part]]


DEMOS: dict[str, Demo] = {
    "foreground": Demo(
        "Strings of beads far in front of a tiled wall that is in focus.", (-14, 0.5), foreground.VIEW, foreground.parts
    ),
    "background": Demo(
        "A still life in focus, with tables, balls and a wall of books behind it.",
        (0, 10),
        background.VIEW,
        background.parts,
    ),
    "rail": Demo("A toy railway that runs through the focal plane.", (-21, 6), rail.VIEW, rail.parts),
    "highlights": Demo(
        "Lamps 50 times as bright as white behind a lantern in focus.", (0, 14), highlights.VIEW, highlights.parts
    ),
    "crossing": Demo(
        "Two thin bars that cross, one before and one behind focus.", (-9, 10), studies.CROSSING, studies.crossing
    ),
    "glossy": Demo(
        "Polished metal whose look depends on where it is seen from.", (-9, 7), studies.GLOSSY, studies.glossy
    ),
}
_NAME = re.compile(r"(?P<name>[^@]*)(@(?P<count>\d{1,9}(\.\d{1,6})?)(?P<unit>[km]?))?")


def _parse(name: str) -> tuple[str, int | None]:
    match = _NAME.fullmatch(name)
    if match is None or match["name"] not in DEMOS:
        names = ", ".join(DEMOS)
        raise ModelError(f"unknown demo scene {name!r}; accepted: {names}, or with a triangle count, as rail@216k")
    if match["count"] is None:
        return match["name"], None
    return match["name"], round(float(match["count"]) * {"": 1, "k": 1_000, "m": 1_000_000}[match["unit"]])


def build(name: str) -> Scene:
    """Make the demo scene `name`, cut into about n triangles when called `name@n`, `name@nk` or `name@nm`.

    Raises ModelError for a name or a count that there is not.
    """
    base, triangles = _parse(name)
    demo = DEMOS[base]
    return assemble(name, demo.parts(), Camera(**demo.view["camera"]), triangles)


def view(name: str) -> dict[str, Any]:
    """Return the view file of the demo scene `name` as a dict; a triangle count in the name makes no difference."""
    return copy.deepcopy(DEMOS[_parse(name)[0]].view)
