"""Where somebody looks, and the focus that follows.

A gaze source says for a moment where in the picture the eye looks: the mouse, a recorded trace, an eye tracker. `step`
carries the focus from one moment to the next as an eye does it. A look must rest within the fixation radius for the
dwell delay; then the focus nears the depth there exponentially in dioptres (1 / distance), in which near and far feel
alike. Where there is no depth it stays what it was.

Time is tick / rate, never a clock: the focus is a function of the looks and of the depths alone, so a trace replays to
the same distances in a window and without one, on any machine.
"""

from __future__ import annotations

import csv
import io
import math
from bisect import bisect_right
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple, Protocol

from pydantic import BaseModel, ConfigDict, Field

from dofview.errors import InputError
from dofview.reading import read_small

Point = tuple[float, float]
DepthAt = Callable[[float, float], float]
"""1/z at a point of the picture (shares of width and height from the upper left); 0 where nothing is."""

ARRIVED = 1e-4
"""Within this share of its target the focus is there: thousandths of a pixel of blur."""

MOST_BYTES, MOST_ROWS = 64 << 20, 1_000_000
COLUMNS = ("time_s", "x", "y", "frozen", "focus_distance")


class GazeSettings(BaseModel):
    """How the focus follows the gaze."""

    model_config = ConfigDict(frozen=True, allow_inf_nan=False)

    fixation_radius: float = Field(
        default=0.03, ge=0.0, le=0.5, json_schema_extra={"unit": "of the height"},
        description="How far a look may wander and still be one fixation, share of the picture's height.",
    )  # fmt: skip
    dwell_s: float = Field(
        default=0.1, ge=0.0, le=5.0, json_schema_extra={"unit": "s"},
        description="How long a look must rest before the focus follows, seconds.",
    )  # fmt: skip
    speed: float = Field(
        default=6.0, gt=0.0, le=1000.0, json_schema_extra={"unit": "1/s"},
        description="Speed of the focus: after t seconds e^(−speed·t) of the way is left, in dioptres.",
    )  # fmt: skip
    depth_radius: float = Field(
        default=0.006, ge=0.0, le=0.05, json_schema_extra={"unit": "of the height"},
        description="The depth looked at is the median within this radius, share of the picture's height.",
    )  # fmt: skip
    rate_hz: float = Field(
        default=60.0, ge=1.0, le=1000.0, json_schema_extra={"unit": "1/s"},
        description="Steps of the focus a second; a replay shows each of them.",
    )  # fmt: skip


class Look(NamedTuple):
    """Where the eye looks, shares of width and height from the upper left; `point` is None where it looks elsewhere.

    `frozen` keeps the focus where it is, be it on its way.
    """

    point: Point | None
    frozen: bool = False


class GazeSource(Protocol):
    """Anything that knows where somebody looks."""

    def at(self, time_s: float) -> Look:
        """The look at a time, in seconds from the start."""


@dataclass(frozen=True)
class Pull:
    """A focus on its way, in 1 / scene unit: where it is, where it goes, and the look that sent it there."""

    inverse_distance: float
    target: float
    anchor: Point | None = None
    since_s: float = 0.0
    fixated: bool = False

    @classmethod
    def at(cls, distance: float) -> Pull:
        """A focus that rests at `distance`, scene units, which may be infinite."""
        return cls(1.0 / distance, 1.0 / distance)

    @property
    def distance(self) -> float:
        """The distance in focus, scene units."""
        return 1.0 / self.inverse_distance if self.inverse_distance > 0.0 else math.inf

    @property
    def settled(self) -> bool:
        """Whether the same look would change nothing any more."""
        return self.inverse_distance == self.target and (self.anchor is None or self.fixated)


def step(pull: Pull, look: Look, tick: int, depth_at: DepthAt, settings: GazeSettings, aspect: float) -> Pull:
    """The focus one step of 1 / rate on, at time tick / rate; `aspect` is the picture's width over its height.

    `depth_at` is asked while a look is a fixation, at its place.
    """
    if look.frozen:
        return replace(pull, anchor=None, fixated=False)
    time_s = tick / settings.rate_hz
    anchor, since_s, fixated, target = pull.anchor, pull.since_s, pull.fixated, pull.target
    if look.point is None:
        anchor, fixated = None, False
    else:
        if anchor is None or _apart(anchor, look.point, aspect) > settings.fixation_radius:
            anchor, since_s, fixated = look.point, time_s, False
        if not fixated and time_s - since_s >= settings.dwell_s:
            # A look swings in before it rests: what counts is where it came to rest.
            anchor, fixated = look.point, True
        if fixated:
            target = depth_at(*anchor) or target
    return Pull(_eased(pull.inverse_distance, target, settings), target, anchor, since_s, fixated)


def replay(
    source: GazeSource, start: Pull, ticks: int, depth_at: DepthAt, settings: GazeSettings, aspect: float
) -> Iterator[Pull]:
    """The focus at each of the first `ticks` steps of `source`, beginning with time 0."""
    for tick in range(ticks):
        start = step(start, source.at(tick / settings.rate_hz), tick, depth_at, settings, aspect)
        yield start


class Row(NamedTuple):
    """One moment of a trace; `focus_distance` is what the focus was then, if known."""

    time_s: float
    look: Look
    focus_distance: float | None = None


class Trace:
    """A recorded gaze: each look holds until the next."""

    def __init__(self, rows: Iterable[Row]):
        self.rows = tuple(rows)
        self._times = [row.time_s for row in self.rows]

    @property
    def duration_s(self) -> float:
        """Time of the last row."""
        return self._times[-1] if self._times else 0.0

    @property
    def start(self) -> Pull | None:
        """The focus it began with, if the trace says so."""
        distance = self.rows[0].focus_distance if self.rows else None
        return Pull.at(distance) if distance else None

    def ticks(self, settings: GazeSettings) -> int:
        """How many steps it lasts."""
        return math.floor(self.duration_s * settings.rate_hz + 1e-6) + 1

    def at(self, time_s: float) -> Look:
        """The look at `time_s`; before the first row nobody looks."""
        # Times written as decimals of tick / rate must be found at that tick.
        index = bisect_right(self._times, time_s + 1e-9) - 1
        return self.rows[index].look if index >= 0 else Look(None)

    def text(self) -> str:
        """The trace as CSV, every number exact."""
        out = io.StringIO()
        writer = csv.writer(out, lineterminator="\n")
        writer.writerow(COLUMNS)
        for time_s, (point, frozen), distance in self.rows:
            writer.writerow([repr(time_s), *(map(repr, point) if point else ("", "")), int(frozen), distance or ""])
        return out.getvalue()


def read_trace(path: Path) -> Trace:
    """Read a gaze trace: CSV with the columns time_s, x, y and, if known, frozen and focus_distance.

    x and y are shares of the picture from its upper left corner; empty or outside of 0 to 1 is a look elsewhere.
    InputError names file, line and value.
    """
    try:
        return Trace(_rows(read_small(path, "gaze trace", MOST_BYTES)))
    except (ValueError, csv.Error) as error:
        raise InputError(f"{path}: not a gaze trace: {error}") from error


def _rows(text: str) -> Iterator[Row]:
    reader = csv.DictReader(io.StringIO(text, newline=""))
    missing = [name for name in COLUMNS[:3] if name not in (reader.fieldnames or ())]
    if missing:
        raise ValueError(f"no column {', '.join(missing)}; accepted: a first line with {','.join(COLUMNS)}")
    last = -math.inf
    for number, row in enumerate(reader):
        if number >= MOST_ROWS:
            raise ValueError(f"more than {MOST_ROWS} rows")
        where = f"line {reader.line_num}"
        time_s = _number(row["time_s"], f"{where}: time_s")
        if time_s is None or time_s < last or time_s > 1e6:
            raise ValueError(
                f"{where}: time_s is {(row['time_s'] or '')[:20]!r}; accepted: seconds that never decrease"
            )
        last = time_s
        x, y = (_number(row[name], f"{where}: {name}") for name in ("x", "y"))
        seen = (x, y) if x is not None and y is not None and 0.0 <= x <= 1.0 and 0.0 <= y <= 1.0 else None
        distance = _number(row.get("focus_distance"), f"{where}: focus_distance", finite=False)
        if distance is not None and not distance > 0.0:
            raise ValueError(f"{where}: focus_distance is {distance}; accepted: a number above 0, or inf")
        frozen = bool(_number(row.get("frozen"), f"{where}: frozen"))
        yield Row(time_s, Look(seen, frozen), distance)


def _number(text: str | None, where: str, finite: bool = True) -> float | None:
    if text is None or not text.strip():
        return None
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if math.isnan(value) or (finite and math.isinf(value)):
        raise ValueError(f"{where} is {text[:20]!r}; accepted: a number")
    return value


def _eased(inverse_distance: float, target: float, settings: GazeSettings) -> float:
    left = (inverse_distance - target) * math.exp(-settings.speed / settings.rate_hz)
    return target if abs(left) <= ARRIVED * max(inverse_distance, target) else target + left


def _apart(a: Point, b: Point, aspect: float) -> float:
    """Distance of two points in shares of the picture's height."""
    return math.hypot((a[0] - b[0]) * aspect, a[1] - b[1])
