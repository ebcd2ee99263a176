"""The panels of settings: each takes settings and returns them as the person left them."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
from imgui_bundle import imgui

from dofview.lens import Lens, Photographic, depth_of_field, focal_px, hyperfocal_distance
from dofview.methods import METHODS, method
from dofview.metrics import srgb_decode, srgb_encode
from dofview.render.environment import SKY, STUDIO, Lighting
from dofview.scene.model import Scene
from dofview.settings import Settings
from dofview.viewer.widgets import edit, plain

SENSOR_HEIGHT_MM = 24.0


def method_panel(settings: Settings) -> Settings:
    """Choose the method and set its parameters."""
    for name in METHODS:
        if imgui.radio_button(f"{method(name).TITLE}##{name}", settings.method == name):
            settings = settings.with_(method=name)
        if imgui.is_item_hovered(imgui.HoveredFlags_.for_tooltip):
            imgui.set_tooltip(method(name).CITATION)
    imgui.separator_text("parameters")
    params = edit(settings.method_params)
    if params != settings.method_params:
        settings = settings.with_(params=settings.params.model_copy(update={settings.method: params}))
    return settings


def lens_panel(settings: Settings, scene_bounds: np.ndarray) -> Settings:
    """Focus and aperture in scene units, and the same in a photographer's terms."""
    size = float(np.linalg.norm(scene_bounds[1] - scene_bounds[0])) or 1.0
    distance = max(settings.camera.distance, size * 1e-3)
    ranges = {
        "focus_distance": (distance / 50.0, max(distance, size) * 4.0),
        "radius": (0.0, max(size / 20.0, settings.lens.radius)),
        "rotation_deg": (0.0, 360.0),
    }
    shape = {"polygon": ("blades", "rotation_deg"), "image": ("rotation_deg",)}.get(settings.lens.distribution, ())
    lens = edit(settings.lens, only=("focus_distance", "radius", "distribution", *shape), ranges=ranges)
    photo = Photographic.of(lens, settings.camera.vfov_deg, SENSOR_HEIGHT_MM)
    changed, f_number = imgui.slider_float(
        "f-number##f_number", min(photo.f_number, 64.0), 0.01, 64.0, "f/%.2f",
        imgui.SliderFlags_.logarithmic | imgui.SliderFlags_.always_clamp,
    )  # fmt: skip
    if imgui.is_item_hovered(imgui.HoveredFlags_.for_tooltip):
        sensor = f"{photo.focal_length_mm:.1f} mm on a sensor {SENSOR_HEIGHT_MM:g} mm high"
        imgui.set_tooltip(f"Focal length {sensor}; a scene unit is a metre.")
    if changed:
        lens = lens.model_copy(update={"radius": photo.model_copy(update={"f_number": f_number}).radius()})
    _depth_of_field_text(lens, settings)
    return settings.with_(lens=lens) if lens != settings.lens else settings


def _depth_of_field_text(lens: Lens, settings: Settings) -> None:
    pixels = focal_px(settings.image.size[1], settings.camera.vfov_deg)
    near, far = depth_of_field(lens, pixels)
    farthest = "infinity" if math.isinf(far) else f"{far:.4g}"
    imgui.text_disabled(f"sharp within half a pixel from {near:.4g} to {farthest}")
    imgui.text_disabled(f"hyperfocal distance {hyperfocal_distance(lens, pixels):.4g}")


def picture_panel(settings: Settings) -> Settings:
    """Resolution, display, light and background."""
    image = edit(settings.image, only=("scale",))
    display = edit(settings.display, ranges={"exposure_ev": (-6.0, 6.0)})
    if image != settings.image or display != settings.display:
        settings = settings.with_(image=image, display=display)
    return _background(_light(settings))


def _light(settings: Settings) -> Settings:
    """What lights the scene: the built-in ones, and the picture that was dropped."""
    now = settings.light.environment
    choices = [SKY, STUDIO, *([now] if now not in (SKY, STUDIO) else [])]
    names = [plain(Path(choice).name) for choice in choices]
    chosen = choices[imgui.combo("light##environment", choices.index(now), names)[1]]
    if imgui.is_item_hovered(imgui.HoveredFlags_.for_tooltip):
        imgui.set_tooltip("A picture all around is dropped on the window: .hdr or .exr.")
    return settings if chosen == now else settings.with_(light=Lighting(environment=chosen))


def _background(settings: Settings) -> Settings:
    """The colour where nothing is, as it is seen; brighter than white is what a view file may say."""
    shown = [float(x) for x in srgb_encode(np.asarray(settings.background_linear))]
    changed, colour = imgui.color_edit3("background##background", shown, imgui.ColorEditFlags_.float)
    if imgui.is_item_hovered(imgui.HoveredFlags_.for_tooltip):
        imgui.set_tooltip("Colour where nothing is.")
    if not changed:
        return settings
    return settings.with_(background_linear=tuple(float(x) for x in srgb_decode(np.clip(colour, 0.0, 1.0))))


def scene_panel(scene: Scene) -> None:
    """What was loaded, and what of it is not shown."""
    imgui.text_wrapped(f"{scene.name}: {scene.triangle_count} triangles")
    for warning in scene.warnings:
        imgui.bullet()
        imgui.text_wrapped(warning)
