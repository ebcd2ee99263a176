"""The values that decide what is seen besides the settings of the picture: a comparison, a map, an overlay, a zoom."""

from __future__ import annotations

from enum import StrEnum

from pydantic import BaseModel, ConfigDict, Field, field_validator

from dofview.gl.compose import WHOLE, Part
from dofview.methods import METHODS

REFERENCE = "accumulation"


class Arrangement(StrEnum):
    """How pictures share the screen."""

    ONE = "one picture"
    WIPE = "wipe"
    GRID = "grid of all"


class Difference(StrEnum):
    """Kinds of difference, of sRGB values 0…1 as they are measured; mean over the channels."""

    ABSOLUTE = "absolute"
    SQUARED = "squared"
    RELATIVE = "relative"
    SIGNED = "signed"


class HeatSettings(BaseModel):
    """How an error is shown."""

    model_config = ConfigDict(frozen=True, allow_inf_nan=False)

    difference: Difference = Field(
        default=Difference.ABSOLUTE, description="|a - b|, (a - b)², |a - b| / b, or a - b, of sRGB values 0 to 1."
    )
    gain: float = Field(default=4.0, ge=0.25, le=1024.0, description="The colour scale ends at 1 / gain.")


class Band(BaseModel):
    """What counts as in focus."""

    model_config = ConfigDict(frozen=True, allow_inf_nan=False)

    blur_px: float = Field(
        default=0.5, ge=0.05, le=8.0, json_schema_extra={"unit": "px"},
        description="Largest blur that still counts as sharp: radius of the circle of confusion, pixels.",
    )  # fmt: skip


class Seen(BaseModel):
    """What is seen of the settings' picture; as it stands, the whole picture and nothing else."""

    model_config = ConfigDict(frozen=True, allow_inf_nan=False)

    arrangement: Arrangement = Field(default=Arrangement.ONE, description="How pictures share the screen.")
    other: str = Field(default=REFERENCE, description="The method beside the one in use, in a wipe.")
    split: float = Field(default=0.5, ge=0.0, le=1.0, description="Where the line of a wipe is, share of the width.")
    part: Part = Field(default=WHOLE, description="The part of each picture: left, top, width, height as shares.")
    error_map: bool = Field(default=False, description="Show each picture as its difference from the reference.")
    heat: HeatSettings = HeatSettings()
    in_focus: bool = Field(default=False, description="Tint what is in focus.")
    band: Band = Band()
    text_px: float = Field(default=15.0, ge=4.0, le=256.0, description="Height of names and legends.")

    @field_validator("other")
    @classmethod
    def _known(cls, other: str) -> str:
        if other not in METHODS:
            raise ValueError(f"accepted: {', '.join(METHODS)}")
        return other

    def covers(self, name: str) -> bool:
        """Whether the picture of a method is shown as a map of its error."""
        return self.error_map and name != REFERENCE

    def names(self, own: str) -> tuple[str, ...]:
        """The methods whose pictures are seen when `own` is in use, in their order."""
        if self.arrangement is Arrangement.GRID:
            return METHODS
        return (own, self.other) if self.arrangement is Arrangement.WIPE and self.other != own else (own,)
