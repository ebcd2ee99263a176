"""Moving the camera: pure functions from a camera and a gesture to a camera."""

from __future__ import annotations

import math

import numpy as np

from dofview.scene.camera import Camera

STEEPEST_DEG = 89.9


def orbit(camera: Camera, right_deg: float, up_deg: float) -> Camera:
    """Turn around the target; the horizon stays level and the pole is not crossed."""
    up = np.asarray(camera.up) / np.linalg.norm(camera.up)
    arm = np.subtract(camera.position, camera.target, dtype=np.float64)
    arm = _rotated(arm, up, -math.radians(right_deg))
    elevation = math.degrees(math.asin(np.clip(arm @ up / np.linalg.norm(arm), -1.0, 1.0)))
    step = np.clip(elevation + up_deg, -STEEPEST_DEG, STEEPEST_DEG) - elevation
    side = np.cross(up, arm)
    if np.linalg.norm(side) > 0.0:
        arm = _rotated(arm, side / np.linalg.norm(side), -math.radians(step))
    return _moved(camera, position=np.asarray(camera.target) + arm)


def pan(camera: Camera, right: float, up: float) -> Camera:
    """Shift camera and target in the picture plane; 1 is the height of the picture at the target."""
    height = 2.0 * camera.distance * math.tan(math.radians(camera.vfov_deg) / 2.0)
    axes = camera.axes()
    shift = (right * axes[0] + up * axes[1]) * height
    return _moved(camera, position=np.asarray(camera.position) + shift, target=np.asarray(camera.target) + shift)


def zoom(camera: Camera, steps: float) -> Camera:
    """Come nearer (positive) or go away; each step changes the distance by a tenth and never reaches the target."""
    arm = np.subtract(camera.position, camera.target, dtype=np.float64) * 0.9**steps
    if np.linalg.norm(arm) <= 1e-6 * max(np.abs(camera.target).max(), 1e-3):
        return camera
    return _moved(camera, position=np.asarray(camera.target) + arm)


def fly(camera: Camera, right: float, up: float, forward: float) -> Camera:
    """Move camera and target together along the camera's axes, scene units."""
    shift = np.array([right, up, -forward]) @ camera.axes()
    return _moved(camera, position=np.asarray(camera.position) + shift, target=np.asarray(camera.target) + shift)


def look(camera: Camera, right_deg: float, up_deg: float) -> Camera:
    """Turn the view in place."""
    mirrored = camera.model_copy(update={"position": camera.target, "target": camera.position})
    return _moved(camera, target=np.asarray(orbit(mirrored, right_deg, up_deg).position))


def fit(camera: Camera, bounds: np.ndarray) -> Camera:
    """See the whole box `bounds` (2, 3) from the present direction."""
    backward = tuple(camera.axes()[2])
    fitted = Camera.fitting(bounds, camera.vfov_deg, backward)
    return _moved(camera, position=np.asarray(fitted.position), target=np.asarray(fitted.target))


def toward(camera: Camera, bounds: np.ndarray, direction: tuple[float, float, float]) -> Camera:
    """See the whole box from `direction`: the axis views."""
    up = (0.0, 0.0, -1.0) if abs(direction[1]) > 0.9 else (0.0, 1.0, 0.0)
    return Camera.fitting(bounds, camera.vfov_deg, direction).model_copy(update={"up": up})


def _rotated(vector: np.ndarray, axis: np.ndarray, angle: float) -> np.ndarray:
    """Rodrigues' rotation of `vector` around unit `axis`, radians."""
    cos, sin = math.cos(angle), math.sin(angle)
    return vector * cos + np.cross(axis, vector) * sin + axis * (axis @ vector) * (1.0 - cos)


def _moved(camera: Camera, **points: np.ndarray) -> Camera:
    return camera.model_copy(update={name: tuple(float(x) for x in point) for name, point in points.items()})


def between(a: Camera, b: Camera, share: float) -> Camera:
    """The camera at `share` of the way from `a` to `b`: turning where both stand, else around the target."""
    if share >= 1.0:
        return b
    vfov_deg = a.vfov_deg + (b.vfov_deg - a.vfov_deg) * share
    up = _swung(np.asarray(a.up, float), np.asarray(b.up, float), share)
    start, end = (np.subtract(c.position, c.target, dtype=np.float64) for c in (a, b))
    arm = _swung(start, end, share)
    position, target = (
        np.asarray(x) + np.subtract(y, x) * share for x, y in ((a.position, b.position), (a.target, b.target))
    )
    if a.position == b.position:
        target = position - arm
    else:
        position = target + arm
    return _moved(a.model_copy(update={"vfov_deg": vfov_deg}), position=position, target=target, up=up)


def _swung(a: np.ndarray, b: np.ndarray, share: float) -> np.ndarray:
    """Turn `a` towards `b`, its length growing in proportion."""
    lengths = np.linalg.norm(a), np.linalg.norm(b)
    a, b = a / lengths[0], b / lengths[1]
    angle = math.acos(np.clip(a @ b, -1.0, 1.0))
    axis = np.cross(a, b)
    if np.linalg.norm(axis) < 1e-9:
        axis = np.cross(a, np.eye(3)[np.argmin(np.abs(a))])
    length = lengths[0] * (lengths[1] / lengths[0]) ** share
    return _rotated(a, axis / np.linalg.norm(axis), angle * share) * length
