"""Small scenes that say one thing each, for tests of pictures."""

from __future__ import annotations

import numpy as np

from dofview.lens import Distribution
from dofview.scene.demo import view
from dofview.scene.model import Instance, Material, Picture, Primitive, Scene, Texture
from dofview.settings import ImageSettings, Settings, apply_view


def quad(
    center: tuple[float, float, float], half: tuple[float, float], material: int = 0, repeat: float = 1.0
) -> Primitive:
    """A rectangle facing +z."""
    x, y, z = center
    corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]], np.float32)
    positions = np.column_stack([corners * np.float32(half) + np.float32([x, y]), np.full(4, z, np.float32)])
    texcoords = (corners * [0.5, -0.5] + 0.5).astype(np.float32) * np.float32(repeat)
    triangles = np.array([[0, 1, 2], [0, 2, 3]], np.uint32)
    normals = np.tile(np.float32([0, 0, 1]), (4, 1))
    return Primitive(positions, triangles, normals, (texcoords, None), None, material)


def scene_of(primitives: list[Primitive], materials: list[Material]) -> Scene:
    """Every primitive once, where it is."""
    instances = tuple(Instance(index, np.eye(4)) for index in range(len(primitives)))
    return Scene("test", tuple(primitives), instances, tuple(materials))


def unlit(*rgb: float) -> Material:
    """A surface that is exactly this linear colour."""
    return Material(name="unlit", base_color=(*rgb, 1.0), unlit=True, double_sided=True)


def noise_material(seed: int = 0, cells: int = 64, contrast: float = 1.0) -> Material:
    """Unlit smooth-ish coloured noise, 256 px square."""
    generator = np.random.default_rng(seed)
    coarse = generator.random((cells // 4, cells // 4, 3)).repeat(4, 0).repeat(4, 1)
    fine = generator.random((cells, cells, 3))
    mixed = 0.5 + contrast * (0.65 * coarse + 0.35 * fine - 0.5)
    pixels = np.full((256, 256, 4), 255, np.uint8)
    repeat = 256 // cells
    pixels[..., :3] = (255 * mixed.clip(0, 1)).repeat(repeat, 0).repeat(repeat, 1)
    return Material(name="noise", unlit=True, double_sided=True, base_color_texture=Texture(Picture("noise", pixels)))


def three_planes() -> Scene:
    """A wall at z = −5 behind a panel at z = 0 and two bars at z = 2, all textured; seen from z = 5."""
    walls = [quad((0, 0, -5), (12, 9), 0, 6.0), quad((0.4, 0.2, 0), (0.9, 0.7), 1), quad((-0.6, 0, 2), (0.12, 1.6), 2),
             quad((0, -0.75, 2.2), (1.8, 0.1), 0)]  # fmt: skip
    return scene_of(walls, [noise_material(1), noise_material(2), noise_material(3)])


def constant(value: float = 0.5) -> Scene:
    """The same shapes, all of one colour: whatever blurs them must leave it."""
    planes = three_planes()
    return Scene("constant", planes.primitives, planes.instances, (unlit(value, value, value),) * 3)


def empty() -> Scene:
    """Nothing at all."""
    return Scene("empty", (), ())


def demo_through_gaussian(name: str, method: str, size: tuple[int, int] = (512, 384)) -> Settings:
    """The demo scene's own view by `method`, through the lens that methods with Gaussian blur are made for."""
    settings = apply_view(Settings(), view(name), name).with_(method=method, image=ImageSettings(size=size))
    return settings.with_(lens=settings.lens.model_copy(update={"distribution": Distribution.GAUSSIAN}))
