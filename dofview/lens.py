"""The thin lens: one model for the reference and all methods.

With lens radius `a` and focus distance `s` (scene units), and `f_px` the focal length in pixels, a point at view
depth `z` is blurred to a circle of confusion of signed radius

    c(z) = B · (1/s − 1/z)    [px],    B = a · f_px

negative in front of the focus, positive behind (Lee 2008 eq 2–3, Lee 2009 multiview eq 3, Schedl 2012 eq 1, Kraus 2007
eq 5 and 8, Lee 2009 mipmap eq 3–4 are this formula with other symbols). It is affine in 1/z, so it needs neither a
singular a·F/(s−F) nor a linearised depth, `s = ∞` is 1/s = 0, and background at infinity is 1/z = 0. Depth images
therefore hold 1/z. `include/lens.glsl` says the same in GLSL; a test holds the two equal.
"""

from __future__ import annotations

import math
from enum import StrEnum
from pathlib import Path
from typing import NamedTuple

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, field_validator

# The Gaussian that best replaces a uniform disc has σ = 0.55 of its radius, 1.1 times the disc's RMS width per axis
# (measured over textures and edges, radii 8–32 px: 0.55 at each).
DISC_RMS = 0.5
MATCHED_SIGMA = 1.1
LARGEST_LENS = 1e12
"""Radius, scene units."""


class Distribution(StrEnum):
    """How light is distributed over the lens."""

    UNIFORM_DISC = "uniform_disc"
    GAUSSIAN = "gaussian"
    POLYGON = "polygon"
    IMAGE = "image"


class Lens(BaseModel):
    """A thin lens in scene units."""

    model_config = ConfigDict(frozen=True)

    radius: float = Field(
        default=0.0, ge=0.0, le=LARGEST_LENS, allow_inf_nan=False, description="Lens radius, scene units."
    )
    focus_distance: float = Field(
        default=5.0, ge=1e-12, description="Distance in focus along the view axis, scene units; may be infinite."
    )
    distribution: Distribution = Field(
        default=Distribution.UNIFORM_DISC, description="How light is distributed over the lens."
    )
    gaussian_sigma: float | None = Field(
        default=None, gt=0.0, le=1e12, allow_inf_nan=False,
        description="σ of the Gaussian distribution, scene units; half the radius when not given.",
    )  # fmt: skip
    blades: int = Field(default=6, ge=3, le=32, description="Corners of the polygon distribution.")
    rotation_deg: float = Field(
        default=0.0, allow_inf_nan=False, description="Polygon or image turned counter-clockwise, degrees."
    )
    image: Path | str | None = Field(
        default=None, description="Picture of the aperture, brightness is transmission: a file, or a built-in shape."
    )

    @field_validator("focus_distance")
    @classmethod
    def _not_nan(cls, value: float) -> float:
        if math.isnan(value):
            raise ValueError("focus_distance is nan; accepted: a number of at least 1e-12, or inf")
        return value

    @property
    def sigma_fraction(self) -> float:
        """σ of the Gaussian distribution as a fraction of the lens radius."""
        if self.gaussian_sigma is None or self.radius == 0.0:
            return DISC_RMS
        # A lens of almost no radius blurs nothing, however wide; what a shader is given must be a float32.
        return min(self.gaussian_sigma / self.radius, 1e6)

    @property
    def matched_sigma_fraction(self) -> float:
        """σ as a fraction of the radius that a Gaussian method must use to come nearest to this lens."""
        match self.distribution:
            case Distribution.GAUSSIAN:
                return self.sigma_fraction
            case Distribution.POLYGON:
                # RMS width per axis of a regular n-gon with circumradius 1: √((2 + cos(2π/n)) / 12).
                return MATCHED_SIGMA * math.sqrt((2.0 + math.cos(2.0 * math.pi / self.blades)) / 12.0)
        return MATCHED_SIGMA * DISC_RMS

    @property
    def radius_as_sigma_fraction(self) -> float:
        """σ over the radius by the convention of Kraus 2007 and Lee 2009 (mipmap), whose lens is a Gaussian with the
        radius as σ. A Gaussian lens says its own."""
        return self.sigma_fraction if self.distribution == Distribution.GAUSSIAN else 1.0

    def coc(self, focal_px: float) -> CocLaw:
        """Return this lens's circle-of-confusion law for a picture with `focal_px`."""
        return CocLaw(scale=self.radius * focal_px, inverse_focus=1.0 / self.focus_distance)


class CocLaw(NamedTuple):
    """c = scale · (inverse_focus − 1/z): what shaders need of a lens, and the only place the formula stands in Python.

    `scale` is in px · scene units, `inverse_focus` in 1 / scene unit.
    """

    scale: float
    inverse_focus: float

    def radius_px(self, inverse_depth: float | np.ndarray) -> float | np.ndarray:
        """Signed CoC radius in pixels at 1/z = `inverse_depth`."""
        return self.scale * (self.inverse_focus - inverse_depth)

    def inverse_depth(self, radius_px: float | np.ndarray) -> float | np.ndarray:
        """1/z at which the signed CoC radius is `radius_px`; ≤ 0 where no depth has it. Infinite for a pinhole."""
        if self.scale == 0.0:
            return np.full_like(np.asarray(radius_px, dtype=float), np.inf)
        return self.inverse_focus - radius_px / self.scale

    @property
    def at_infinity(self) -> float:
        """CoC radius in pixels at infinite depth; no blur behind the focus is larger."""
        return self.scale * self.inverse_focus


def focal_px(height_px: float, vfov_deg: float) -> float:
    """Focal length in pixels of a picture `height_px` high: H / (2·tan(fov/2))."""
    return height_px / (2.0 * math.tan(math.radians(vfov_deg) / 2.0))


class Photographic(BaseModel):
    """The same lens as a photographer sets it; linked to `Lens` and the camera's field of view by two functions."""

    model_config = ConfigDict(frozen=True, allow_inf_nan=False)

    focal_length_mm: float = Field(default=50.0, gt=0.0, le=1e5, description="Focal length, mm.")
    f_number: float = Field(default=2.8, gt=0.0, le=1e6, description="Focal length over aperture diameter.")
    sensor_height_mm: float = Field(default=24.0, gt=0.0, le=1e5, description="Height of the sensor, mm.")

    def radius(self, unit_m: float = 1.0) -> float:
        """Lens radius F / (2N) in scene units of `unit_m` metres."""
        return self.focal_length_mm * 1e-3 / (2.0 * self.f_number) / unit_m

    def vfov_deg(self) -> float:
        """Vertical field of view, degrees, with the sensor at the focal length (no focus breathing)."""
        return math.degrees(2.0 * math.atan(self.sensor_height_mm / (2.0 * self.focal_length_mm)))

    @classmethod
    def of(cls, lens: Lens, vfov_deg: float, sensor_height_mm: float = 24.0, unit_m: float = 1.0) -> Photographic:
        """Say `lens` under a field of view in photographic terms; a pinhole becomes the smallest aperture, N = 1e6."""
        focal_length_mm = sensor_height_mm / (2.0 * math.tan(math.radians(vfov_deg) / 2.0))
        diameter_mm = 2.0 * lens.radius * unit_m * 1e3
        f_number = min(focal_length_mm / diameter_mm, 1e6) if diameter_mm > 0.0 else 1e6
        return cls(focal_length_mm=focal_length_mm, f_number=f_number, sensor_height_mm=sensor_height_mm)


class HumanEye(BaseModel):
    """An eye before a screen (Lee 2009 mipmap §8): what a picture must blur so that it looks as it would to the eye.

    Its eq 3–4 give the CoC diameter on the screen, DPI · (d_s / d_r) · E·F·|d − d_f| / (d·(d_f − F)). Divided by the
    focal length in pixels that a picture on this screen has for this eye, DPI · d_s, that is the thin lens of radius
    ½·E·F / d_r, but for the factor d_f / (d_f − F), which is 1.02 at a metre.
    """

    model_config = ConfigDict(frozen=True, allow_inf_nan=False)

    focal_length_mm: float = Field(default=17.0, gt=0.0, le=1e3, description="Focal length of the eye, F, mm.")
    pupil_mm: float = Field(default=4.0, ge=0.0, le=1e3, description="Diameter of the pupil, E, mm.")
    retina_mm: float = Field(default=24.0, gt=0.0, le=1e3, description="From the lens to the retina, d_r, mm.")
    screen_distance_mm: float = Field(default=3000.0, gt=0.0, le=1e6, description="From eye to screen, d_s, mm.")
    dots_per_mm: float = Field(default=0.32, gt=0.0, le=1e3, description="Pixels of the screen per mm, DPI.")

    def radius(self, unit_m: float = 1.0) -> float:
        """Lens radius in scene units of `unit_m` metres."""
        return 0.5 * self.pupil_mm * self.focal_length_mm / self.retina_mm * 1e-3 / unit_m

    def vfov_deg(self, height_px: float) -> float:
        """Vertical field of view of a picture `height_px` high on this screen, degrees."""
        return math.degrees(2.0 * math.atan(height_px / (2.0 * self.dots_per_mm * self.screen_distance_mm)))


CAMERAS: dict[str, Photographic] = {
    "Wide, 24 mm f/2.8": Photographic(focal_length_mm=24.0, f_number=2.8),
    "Standard, 50 mm f/1.8": Photographic(focal_length_mm=50.0, f_number=1.8),
    "Portrait, 85 mm f/1.4": Photographic(focal_length_mm=85.0, f_number=1.4),
    "Tele, 200 mm f/2.8": Photographic(focal_length_mm=200.0, f_number=2.8),
    "Telephone, 6.9 mm f/1.8": Photographic(focal_length_mm=6.9, f_number=1.8, sensor_height_mm=7.3),
}
"""Lenses to begin with, by name."""


def hyperfocal_distance(lens: Lens, focal_px: float, blur_px: float = 0.5) -> float:
    """Nearest focus distance that keeps infinity within `blur_px` CoC radius, scene units: B / blur."""
    return lens.radius * focal_px / blur_px


def depth_of_field(lens: Lens, focal_px: float, blur_px: float = 0.5) -> tuple[float, float]:
    """Nearest and farthest depth, scene units, whose CoC radius stays within `blur_px`; the far one may be infinite."""
    if lens.radius == 0.0:
        return 0.0, math.inf
    law = lens.coc(focal_px)
    near = 1.0 / float(law.inverse_depth(-blur_px))
    far_inverse = float(law.inverse_depth(blur_px))
    return near, 1.0 / far_inverse if far_inverse > 0.0 else math.inf
