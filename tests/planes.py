"""Textured planes told twice: as a dofview scene, and as rectangles for the ray caster."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from raycaster import Rectangle, ThinLensCamera, bilinear, cast, disc, gaussian, picture, polygon

from dofview import bokeh
from dofview.lens import Distribution, Lens
from dofview.scene.camera import Camera
from dofview.scene.model import Instance, Material, Picture, Primitive, Sampler, Scene, Texture

SHARP_SAMPLER = Sampler(minify="LINEAR")  # no mipmaps: the ray caster has none either
ROLLED = Camera(position=(1.4, 0.9, 3.1), target=(0.3, -0.2, -1.0), up=(0.35, 1.0, 0.1), vfov_deg=40.0)
FOCUS = 3.0


class Plane(NamedTuple):
    """Corner, sides (each (3,), scene units) and picture of a rectangle, (h, w, 3) uint8 sRGB."""

    origin: np.ndarray
    across: np.ndarray
    down: np.ndarray
    texels: np.ndarray


class Planes(NamedTuple):
    """One scene for both renderers."""

    scene: Scene
    camera: Camera
    lens: Lens
    rectangles: list[Rectangle]

    def truth(self, width: int, height: int, lens: Lens | None = None, **options) -> np.ndarray:
        """What the ray caster sees, (height, width, 3) linear light."""
        return cast(thin_lens(self.camera, lens or self.lens), self.rectangles, width, height, **options)


def planes_scene() -> Planes:
    """A plane in focus between one in front and one behind, seen off axis and rolled; CoC −5.9, 0, 4.7 px at 64 px."""
    return build(
        [
            facing(ROLLED, 5.0, (-3.6, 2.6), (7.2, 5.2), pattern(1, 48)),
            facing(ROLLED, FOCUS, (-0.9, 0.75), (1.35, 1.2), pattern(2, 40)),
            facing(ROLLED, 2.0, (-0.1, 0.35), (0.75, 0.95), pattern(3, 32), tilt=0.25),
        ],
        ROLLED,
        Lens(radius=0.4, focus_distance=FOCUS),
    )


def build(planes: list[Plane], camera: Camera, lens: Lens) -> Planes:
    """Tell `planes` both ways."""
    materials = tuple(
        Material(
            unlit=True, double_sided=True, base_color_texture=Texture(Picture(f"p{k}", opaque(p.texels)), SHARP_SAMPLER)
        )
        for k, p in enumerate(planes)
    )
    primitives = tuple(primitive(p, k) for k, p in enumerate(planes))
    instances = tuple(Instance(k, np.eye(4)) for k in range(len(planes)))
    rectangles = [Rectangle(p.origin, p.across, p.down, bilinear(linear(p.texels))) for p in planes]
    return Planes(Scene("planes", primitives, instances, materials), camera, lens, rectangles)


def primitive(plane: Plane, material: int) -> Primitive:
    corners = [plane.origin + u * plane.across + v * plane.down for u, v in ((0, 0), (0, 1), (1, 1), (1, 0))]
    normal = np.cross(plane.down, plane.across)
    return Primitive(
        positions=np.array(corners, dtype=np.float32),
        triangles=np.array([[0, 1, 2], [0, 2, 3]], dtype=np.uint32),
        normals=np.tile(normal / np.linalg.norm(normal), (4, 1)).astype(np.float32),
        texcoords=(np.array([[0, 0], [0, 1], [1, 1], [1, 0]], dtype=np.float32), None),
        material=material,
    )


def facing(
    camera: Camera, depth: float, corner: tuple[float, float], size: tuple[float, float], texels: np.ndarray,
    tilt: float = 0.0,
) -> Plane:  # fmt: skip
    """A plane facing `camera` at `depth`: its top left corner and size in scene units right and up of the view axis.

    `tilt` pushes its right side away by that part of its width.
    """
    forward = np.subtract(camera.target, camera.position)
    forward = forward / np.linalg.norm(forward)
    right = np.cross(forward, camera.up)
    right = right / np.linalg.norm(right)
    up = np.cross(right, forward)
    origin = np.array(camera.position) + depth * forward + corner[0] * right + corner[1] * up
    return Plane(origin, size[0] * (right + tilt * forward), -size[1] * up, texels)


def pattern(seed: int, size: int) -> np.ndarray:
    """A smooth picture (size, size, 3) uint8 that is unlike all its mirrorings: soft noise and a bright F."""
    rng = np.random.default_rng(seed)
    frequency = np.fft.fftfreq(size)
    low_pass = np.exp(-(np.add.outer(frequency**2, frequency**2)) / (2 * 0.12**2))
    noise = np.stack(
        [np.fft.ifft2(np.fft.fft2(rng.standard_normal((size, size))) * low_pass).real for _ in range(3)], -1
    )
    letter = np.zeros((size, size))
    s = size // 8
    letter[s : 7 * s, 2 * s : 3 * s] = letter[s : 2 * s, 2 * s : 6 * s] = letter[3 * s : 4 * s, 2 * s : 5 * s] = 1.0
    value = 0.35 + 0.14 * noise / noise.std() + 0.5 * letter[..., None] * np.array([1.0, 0.8, 0.3])
    return np.round(np.clip(value, 0.02, 0.98) * 255).astype(np.uint8)


def opaque(texels: np.ndarray) -> np.ndarray:
    return np.dstack([texels, np.full(texels.shape[:2], 255, np.uint8)])


def linear(texels: np.ndarray) -> np.ndarray:
    """8-bit sRGB to linear light, after IEC 61966-2-1."""
    value = texels / 255.0
    return np.where(value <= 0.04045, value / 12.92, ((value + 0.055) / 1.055) ** 2.4)


def thin_lens(camera: Camera, lens: Lens) -> ThinLensCamera:
    """The ray caster's camera of a dofview camera and lens."""
    transmission, extent = disc, 1.0
    match lens.distribution:
        case Distribution.GAUSSIAN:
            sigma = lens.gaussian_sigma / lens.radius if lens.gaussian_sigma else 0.5
            transmission, extent = gaussian(sigma), 4.5 * sigma
        case Distribution.POLYGON:
            transmission = polygon(lens.blades, lens.rotation_deg)
        case Distribution.IMAGE:
            assert lens.rotation_deg == 0.0
            transmission = picture(bokeh.load(lens.image).weights)
    return ThinLensCamera(
        camera.position,
        camera.target,
        camera.up,
        camera.vfov_deg,
        lens.radius,
        lens.focus_distance,
        transmission,
        extent,
    )
