"""Random scenes for stress: textured cards, boxes and walls, scattered in front of and behind a focus."""

from __future__ import annotations

import numpy as np

from dofview.scene.model import Instance, Material, Picture, Primitive, Scene, Texture


def card(center: np.ndarray, across: np.ndarray, up: np.ndarray, material: int = 0) -> Primitive:
    """A rectangle of half-axes `across` and `up`, seen from both sides."""
    center, across, up = (np.asarray(v, dtype=np.float64) for v in (center, across, up))
    corners = np.array([center - across - up, center + across - up, center + across + up, center - across + up])
    normal = np.cross(across, up)
    normal /= np.linalg.norm(normal)
    texcoords = np.array([[0, 1], [1, 1], [1, 0], [0, 0]], np.float32)
    return Primitive(
        corners.astype(np.float32), np.array([[0, 1, 2], [0, 2, 3]], np.uint32),
        np.tile(normal, (4, 1)).astype(np.float32), (texcoords, None), None, material,
    )  # fmt: skip


def facing(x: float, y: float, z: float, half_width: float, half_height: float, material: int = 0) -> Primitive:
    """A rectangle that faces +z."""
    return card(np.array([x, y, z]), np.array([half_width, 0, 0]), np.array([0, half_height, 0]), material)


def unlit(rgb: tuple[float, float, float], name: str = "unlit") -> Material:
    """Exactly this linear colour."""
    return Material(name=name, base_color=(*rgb, 1.0), unlit=True, double_sided=True)


def textured(random: np.random.Generator, cells: int = 64) -> Material:
    """Unlit noise with structure at several scales, mid-grey on average."""
    total = np.zeros((256, 256, 3))
    size, weight = cells, 1.0
    while size >= 4:
        total += weight * (random.random((size, size, 3)) - 0.5).repeat(256 // size, 0).repeat(256 // size, 1)
        size, weight = size // 2, weight * 1.2
    pixels = np.full((256, 256, 4), 255, np.uint8)
    pixels[..., :3] = (255 * (0.5 + 0.35 * total / total.std() / 2).clip(0, 1)).astype(np.uint8)
    return Material("noise", unlit=True, double_sided=True, base_color_texture=Texture(Picture("noise", pixels)))


def scene(primitives: list[Primitive], materials: list[Material], matrix: np.ndarray | None = None) -> Scene:
    """Every primitive once, placed by `matrix`."""
    placed = np.eye(4) if matrix is None else matrix
    return Scene(
        "stress", tuple(primitives), tuple(Instance(i, placed) for i in range(len(primitives))), tuple(materials)
    )


def scattered(random: np.random.Generator, materials: int = 4, cards: int = 14) -> list[Primitive]:
    """A wall at z = −6 that fills the view and cards of all kinds between it and z = 3; the camera stands at z = 5."""
    found = [facing(0, 0, -6, 14, 10, 0)]
    for _ in range(cards):
        z = random.uniform(-5, 3)
        spread = 0.35 * (5.5 - z)
        center = np.array([random.uniform(-spread, spread), random.uniform(-spread, spread), z])
        turn = np.linalg.qr(random.normal(size=(3, 3)))[0] if random.random() < 0.4 else np.eye(3)
        size = random.uniform(0.02, 0.25, 2) * (5.5 - z)
        found.append(card(center, turn[0] * size[0], turn[1] * size[1], int(random.integers(materials))))
    return found
