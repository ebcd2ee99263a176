"""What a picture or film shows besides the method in use: another method, all of them, the error, what is in focus."""

from __future__ import annotations

from pydantic import BaseModel, ConfigDict, Field

from dofview.cli.flags import Given
from dofview.errors import SettingsError
from dofview.seen.model import REFERENCE, Arrangement, Difference, Seen
from dofview.settings import checked


class Beside(BaseModel):
    """Flags of what is seen."""

    model_config = ConfigDict(frozen=True, allow_inf_nan=False)

    beside: str | None = Field(default=None, description="Another method, to the right of a line.")
    wipe: float | None = Field(
        default=None, ge=0.0, le=1.0, description="Where that line is, share of the width; beside the reference."
    )
    grid: bool = Field(default=False, description="All methods at once.")
    error_map: Difference | None = Field(default=None, description="The error against the reference in colours.")
    gain: float | None = Field(default=None, ge=0.25, le=1024.0, description="The colours end at 1 / gain.")
    in_focus: bool = Field(default=False, description="Tint what is in focus.")


def seen_for(given: Given, size: tuple[int, int], base: Seen | None = None) -> Seen | None:
    """What the flags ask for on top of `base`; None when that is nothing but the picture."""
    typed = given.get("beside", {})
    if not typed:
        return base
    flags = checked(Beside, typed)
    if flags.grid and (flags.beside is not None or flags.wipe is not None):
        raise SettingsError("--grid shows all methods; accepted: --grid, or --beside with --wipe")
    if flags.gain is not None and flags.error_map is None:
        raise SettingsError("--gain is that of an error map; accepted: with --error-map")
    base = base or Seen(text_px=max(round(size[1] / 40.0), 10))
    values = base.model_dump()
    if flags.grid:
        values["arrangement"] = Arrangement.GRID
    elif flags.beside is not None or flags.wipe is not None:
        split = 0.5 if flags.wipe is None else flags.wipe
        values |= {"arrangement": Arrangement.WIPE, "other": flags.beside or REFERENCE, "split": split}
    if flags.error_map is not None:
        heat = {"difference": flags.error_map} | ({} if flags.gain is None else {"gain": flags.gain})
        values |= {"error_map": True, "heat": {**values["heat"], **heat}}
    if flags.in_focus:
        values["in_focus"] = True
    return checked(Seen, values, "beside" if flags.beside else "")
