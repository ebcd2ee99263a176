"""The numbers of a command that are not settings of a picture: how often it is rendered, how good the reference is."""

from __future__ import annotations

from pydantic import BaseModel, ConfigDict, Field


class Timing(BaseModel):
    """How a picture is timed."""

    model_config = ConfigDict(frozen=True)

    frames: int | None = Field(default=None, ge=1, le=100000, description="Time this many frames after a warm-up.")


class Comparing(Timing):
    """How methods are compared."""

    views: int = Field(default=256, ge=1, le=65536, description="Views of the reference.")
