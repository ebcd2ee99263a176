"""From a scene and the flags that were typed to settings: opening view, view file, flags, in this order."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

from dofview.cli.flags import Given
from dofview.errors import SettingsError
from dofview.framing import opening
from dofview.lens import Lens, Photographic
from dofview.remember import read_preset
from dofview.render.environment import Lighting
from dofview.scene.model import Scene
from dofview.settings import LARGEST_SIDE, ImageSettings, Settings, checked, read_view

_SIZE = re.compile(r"\s*(\d{1,9})\s*[xX×]\s*(\d{1,9})\s*", re.ASCII)


def settings_for(
    scene: Scene, spec: str, given: Given, *, view: Path | None = None, method: str | None = None,
    camera: str | None = None, preset: Path | None = None,
) -> Settings:  # fmt: skip
    """Settings for `scene`, loaded from `spec`: its opening view, a preset, a view file, what was typed."""
    settings = opening(scene, spec, camera=camera)
    if preset is not None:
        settings, _ = read_preset(preset, settings)
    return applied(settings, given, view=view, method=method)


def applied(
    settings: Settings, given: Given, *, view: Path | None = None, method: str | None = None
) -> Settings:  # fmt: skip
    """`settings` with the view file and then what was typed; SettingsError names the first value of no use.

    Called before a scene is loaded too, so that a typing mistake does not cost the wait.
    """
    if view is not None:
        settings = read_view(view, settings)
    if method is not None:
        settings = settings.with_(method=method)
    settings = settings.with_(image=_image(settings.image, given.get("image", {})))
    if "light" in given:
        settings = settings.with_(light=checked(Lighting, {**settings.light.model_dump(), **given["light"]}, "light"))
    settings = _with_lens(settings, given.get("lens", {}), given.get("photo", {}))
    params = given.get("params", {})
    return settings.with_params(**params) if params else settings


def read_size(text: str) -> tuple[int, int]:
    """Width and height of "1024x768"."""
    match = _SIZE.fullmatch(text)
    size = (int(match[1]), int(match[2])) if match else (0, 0)
    if min(size) < 1 or max(size) > LARGEST_SIDE:
        raise SettingsError(f"size is {text[:40]!r}; accepted: WIDTHxHEIGHT with sides from 1 to {LARGEST_SIDE} pixels")
    return size


def _image(image: ImageSettings, given: dict[str, Any]) -> ImageSettings:
    values = {**image.model_dump(), **given}
    if "size" in given:
        values["size"] = read_size(given["size"])
    return checked(ImageSettings, values, "picture")


def _with_lens(settings: Settings, given: dict[str, Any], photo: dict[str, Any]) -> Settings:
    lens = checked(Lens, {**settings.lens.model_dump(), **given}, "lens")
    if not photo:
        return settings.with_(lens=lens)
    if "f_number" in photo and "radius" in given:
        raise SettingsError("radius and f_number both set the aperture; accepted: one of them")
    now = Photographic.of(lens, settings.camera.vfov_deg)
    if "sensor_height_mm" in photo:
        height = checked(Photographic, {"sensor_height_mm": photo["sensor_height_mm"]}, "lens").sensor_height_mm
        now = Photographic.of(lens, settings.camera.vfov_deg, height)
    camera_as = checked(Photographic, {**now.model_dump(), **photo}, "lens")
    if "focal_length_mm" in photo:
        settings = settings.with_(camera=settings.camera.model_copy(update={"vfov_deg": camera_as.vfov_deg()}))
    if "f_number" in photo:
        lens = lens.model_copy(update={"radius": camera_as.radius()})
    return settings.with_(lens=lens)
