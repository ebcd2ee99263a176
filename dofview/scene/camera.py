"""The pinhole camera everything is rendered from: a position, a target and a vertical field of view."""

from __future__ import annotations

import math
from typing import Annotated

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, model_validator

# Squares of what is farther away would be infinite in a shader.
FARTHEST = 1e18
NEAREST = 1e-12
"""What a camera looks at is at least this far away, and this share of where it stands: nearer, it would have no
direction."""
Coordinate = Annotated[float, Field(ge=-FARTHEST, le=FARTHEST)]
Vector = tuple[Coordinate, Coordinate, Coordinate]


class Camera(BaseModel):
    """A perspective camera in scene units; `near` and `far` are hints, the renderer fits both to the scene."""

    model_config = ConfigDict(frozen=True, allow_inf_nan=False)

    position: Vector = Field(default=(0.0, 0.0, 5.0), description="Where the lens centre is, scene units.")
    target: Vector = Field(default=(0.0, 0.0, 0.0), description="A point on the view axis, scene units.")
    up: Vector = Field(default=(0.0, 1.0, 0.0), description="Which way is up in the picture.")
    vfov_deg: float = Field(default=45.0, ge=1e-3, lt=179.0, description="Vertical field of view, degrees.")
    near: float | None = Field(default=None, description="Nearest depth asked for, scene units; a hint.")
    far: float | None = Field(default=None, description="Farthest depth asked for, scene units; a hint.")

    @model_validator(mode="after")
    def _has_a_direction(self) -> Camera:
        if self.distance < 1e-18 or np.allclose(self.position, self.target, rtol=1e-12, atol=0.0):
            raise ValueError("camera position and target are the same point; accepted: two different points")
        return self

    @property
    def distance(self) -> float:
        """From position to target, scene units."""
        return math.dist(self.position, self.target)

    def axes(self) -> np.ndarray:
        """(3, 3) float64, rows right, up and backward of the camera in world space, orthonormal."""
        backward = np.subtract(self.position, self.target, dtype=np.float64)
        backward /= np.linalg.norm(backward)
        up = np.asarray(self.up, dtype=np.float64)
        right = np.cross(up, backward)
        if np.linalg.norm(right) <= 1e-9 * max(float(np.linalg.norm(up)), 1e-300):
            # Looking straight along `up`: any perpendicular will do, taken from the axis least aligned with the view.
            right = np.cross(np.eye(3)[np.argmin(np.abs(backward))], backward)
        right /= np.linalg.norm(right)
        return np.array([right, np.cross(backward, right), backward])

    def view_matrix(self, origin: np.ndarray | None = None) -> np.ndarray:
        """(4, 4) float64, world to camera; `origin` is subtracted from the world first, exactly."""
        axes = self.axes()
        position = np.asarray(self.position, dtype=np.float64)
        if origin is not None:
            position = position - origin
        matrix = np.eye(4)
        matrix[:3, :3] = axes
        matrix[:3, 3] = -axes @ position
        return matrix

    @classmethod
    def from_matrix(cls, matrix: np.ndarray, vfov_deg: float, distance: float = 1.0) -> Camera:
        """Make a camera from a camera-to-world `matrix` (4, 4) looking along −z, aimed `distance` units ahead."""
        backward = matrix[:3, 2] / np.linalg.norm(matrix[:3, 2])
        position = _within(matrix[:3, 3])
        target = position - backward * _apart(position, distance)
        return cls(position=tuple(position), target=tuple(target), up=tuple(matrix[:3, 1]), vfov_deg=vfov_deg)

    @classmethod
    def fitting(cls, bounds: np.ndarray, vfov_deg: float = 45.0, direction: Vector = (0.4, 0.35, 1.0)) -> Camera:
        """Make a camera that sees the whole box `bounds` (2, 3) from `direction`."""
        center = _within(bounds.mean(axis=0))
        radius = math.dist(*bounds) / 2
        toward = np.asarray(direction) / np.linalg.norm(direction)
        distance = (radius if radius > NEAREST else 1.0) / math.sin(math.radians(vfov_deg) / 2)
        position = center + toward * _apart(center, distance)
        return cls(position=tuple(position), target=tuple(center), vfov_deg=vfov_deg)


def _within(point: np.ndarray) -> np.ndarray:
    """`point` with room for another one at most that far away."""
    return np.clip(point, -0.25 * FARTHEST, 0.25 * FARTHEST)


def _apart(point: np.ndarray, distance: float) -> float:
    """`distance`, such that what is so far from `point` is another point and within bounds."""
    least = 4.0 * NEAREST * max(1.0, float(np.abs(point).max()))
    return min(max(distance, least), 0.5 * FARTHEST)
