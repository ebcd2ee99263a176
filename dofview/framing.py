"""The picture a scene opens with: its own view, its first camera or one that fits it, and a lens that visibly blurs."""

from __future__ import annotations

import math

import numpy as np

from dofview.errors import InputError
from dofview.lens import LARGEST_LENS, Lens, focal_px
from dofview.scene.camera import Camera
from dofview.scene.load import DEMO
from dofview.scene.model import Scene, SceneCamera
from dofview.settings import Settings, apply_view

OPENING_BLUR = 0.025
"""Largest CoC radius of the opening lens, as a share of the picture's height: plain to see, within reach of all."""


def opening(scene: Scene, spec: str = "", base: Settings | None = None, camera: str | None = None) -> Settings:
    """Settings to show `scene` with. `spec` is what it was loaded from; a demo scene brings its own view.

    `camera` picks one of the file's cameras by name or number from 0; InputError when there is none such.
    """
    base = base or Settings()
    if spec.startswith(DEMO) and camera is None:
        from dofview.scene import demo

        return apply_view(base, demo.view(spec[len(DEMO) :]), spec)
    if scene.cameras or camera is not None:
        seen = _camera_of(_chosen(scene, camera), scene)
    else:
        seen = Camera.fitting(scene.bounds)
    return base.with_(camera=seen, lens=visible_lens(scene, seen, base.image.size[1]))


def visible_lens(scene: Scene, camera: Camera, height_px: int) -> Lens:
    """A lens focused on the camera's target whose largest CoC in the scene is `OPENING_BLUR` of the height."""
    focus = camera.distance
    low, high = scene.bounds
    corners = np.array([[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])])
    depths = (np.asarray(camera.position) - corners) @ camera.axes()[2]
    near, far = max(float(depths.min()), focus / 3.0), max(float(depths.max()), focus)
    spread = max(abs(1.0 / focus - 1.0 / near), abs(1.0 / focus - 1.0 / far))
    per_radius = focal_px(height_px, camera.vfov_deg) * spread
    radius = OPENING_BLUR * height_px / per_radius if per_radius > 0.0 else 0.0
    # A flat scene has nothing out of focus; the lens then stays well smaller than the distance it looks across.
    return Lens(radius=min(radius, focus / 20.0, LARGEST_LENS), focus_distance=focus)


def _chosen(scene: Scene, name: str | None) -> SceneCamera:
    if name is None:
        return scene.cameras[0]
    for number, camera in enumerate(scene.cameras):
        if name in (camera.name, str(number)):
            return camera
    names = ", ".join(f"{n} ({c.name})" if c.name else str(n) for n, c in enumerate(scene.cameras[:20]))
    raise InputError(f"no camera {name!r} in this scene; accepted: {names or 'none, the file has no camera'}")


def _camera_of(camera: SceneCamera, scene: Scene) -> Camera:
    """The file's camera, aimed at the depth of the scene's middle."""
    position, backward = camera.matrix[:3, 3], camera.matrix[:3, 2] / np.linalg.norm(camera.matrix[:3, 2])
    depth = float((position - scene.bounds.mean(axis=0)) @ backward)
    size = math.dist(*scene.bounds) or 1.0
    return Camera.from_matrix(camera.matrix, min(camera.vfov_deg, 178.0), depth if depth > size * 1e-3 else size / 2)
