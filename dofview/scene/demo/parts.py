"""From a list of shapes with materials to a `Scene` of about as many triangles as asked for."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from dofview.errors import ModelError
from dofview.scene.camera import Camera
from dofview.scene.demo.shapes import Shape
from dofview.scene.model import Instance, Material, Picture, Primitive, Scene, SceneCamera, Texture

MOST_TRIANGLES = 8_000_000


# Positions and unit normals (n, 3) to the share of the light (n,) that reaches them; stored as vertex colours.
Shade = Callable[[np.ndarray, np.ndarray], np.ndarray]


@dataclass(frozen=True, eq=False)
class Part:
    """A shape, what it is made of, and how it lies in shade."""

    shape: Shape
    material: Material
    shade: Shade | None = None


def near(*balls: tuple[float, float, float, float], strength: float = 0.75) -> Shade:
    """Shade from balls (x, y, z, radius): how much of the sky over the surface each of them covers.

    The share of a cosine-weighted hemisphere that a ball of radius r at distance d covers is (n·d̂)(r/d)².
    """

    def shade(positions: np.ndarray, normals: np.ndarray) -> np.ndarray:
        light = np.ones(len(positions))
        for *center, radius in balls:
            toward = np.array(center) - positions
            distance = np.maximum(np.linalg.norm(toward, axis=1), radius)
            facing = np.maximum(np.sum(toward * normals, axis=1), 0.0) / distance
            light *= 1.0 - strength * facing * (radius / distance) ** 2
        return light

    return shade


def standing(floor: float = 0.0, reach: float = 0.3) -> Shade:
    """Shade of things on a floor: what faces down is dark, the more so near the floor."""

    def shade(positions: np.ndarray, normals: np.ndarray) -> np.ndarray:
        height = np.maximum(positions[:, 1] - floor, 0.0)
        return 1.0 - (0.25 + 0.5 * np.exp(-height / reach)) * np.clip(0.6 - 0.7 * normals[:, 1], 0, 1)

    return shade


def both(first: Shade, second: Shade) -> Shade:
    """One shade over the other."""
    return lambda positions, normals: first(positions, normals) * second(positions, normals)


def painted(name: str, picture: Picture, roughness: float = 0.7, metallic: float = 0.0, tint: float = 1.0) -> Material:
    """A textured surface; `tint` scales the picture's linear colour."""
    base = (tint, tint, tint, 1.0)
    return Material(name, base, Texture(picture), metallic=metallic, roughness=roughness)


def lamp(name: str, light: tuple[float, float, float]) -> Material:
    """A black body that only sends out `light`, linear, 1 = white."""
    return Material(name, (0.0, 0.0, 0.0, 1.0), metallic=0.0, roughness=1.0, emissive=light, unlit=False)


def assemble(name: str, parts: Sequence[Part], camera: Camera, triangles: int | None = None) -> Scene:
    """Cut every part and join those of one material into one primitive.

    With `triangles` the cells of all patches are scaled alike until the total comes closest to it. Raises ModelError
    where the shapes cannot be cut that coarsely, or the count is beyond what is sensible.
    """
    scale = 1.0 if triangles is None else _scale_for(name, parts, triangles)
    grouped: dict[Material, list[Part]] = {}
    for part in parts:
        grouped.setdefault(part.material, []).append(part)
    primitives = [_join(group, scale, index) for index, group in enumerate(grouped.values())]
    return Scene(
        name=name,
        primitives=tuple(primitives),
        instances=tuple(Instance(index, np.eye(4)) for index in range(len(primitives))),
        materials=tuple(grouped),
        cameras=(_scene_camera(camera),),
        source=f"demo:{name}",
    )


def _scale_for(name: str, parts: Sequence[Part], triangles: int) -> float:
    patches = [patch for part in parts for patch in part.shape]
    least = sum(patch.count(0.0) for patch in patches)
    if not least <= triangles <= MOST_TRIANGLES:
        raise ModelError(f"demo scene {name!r} has {triangles} triangles; accepted: {least} to {MOST_TRIANGLES}")
    low, high = 0.0, 1.0
    while sum(patch.count(high) for patch in patches) < triangles:
        high *= 2
    for _ in range(40):
        middle = (low + high) / 2
        low, high = (middle, high) if sum(patch.count(middle) for patch in patches) < triangles else (low, middle)
    return high


def _join(parts: list[Part], scale: float, material: int) -> Primitive:
    meshes = [(*patch.mesh(scale), part.shade) for part in parts for patch in part.shape]
    offsets = np.cumsum([0] + [len(mesh[0]) for mesh in meshes])
    positions, normals, texcoords = (np.concatenate([m[k] for m in meshes]).astype(np.float32) for k in range(3))
    triangles = np.concatenate([mesh[3] + offset for mesh, offset in zip(meshes, offsets, strict=False)])
    colors = None
    if any(part.shade for part in parts):
        light = np.concatenate([m[4](m[0], m[1]) if m[4] else np.ones(len(m[0])) for m in meshes])
        colors = np.ones((len(positions), 4), dtype=np.float32)
        colors[:, :3] = np.round(np.clip(light, 0.0, 1.0) * 255)[:, None] / 255  # as a file with 8 bit stores them
    return Primitive(
        positions, triangles.astype(np.uint32), normals, (texcoords, None), colors, material, parts[0].material.name
    )


def _scene_camera(camera: Camera) -> SceneCamera:
    matrix = np.eye(4)
    matrix[:3, :3] = camera.axes().T
    matrix[:3, 3] = camera.position
    return SceneCamera("view", matrix, camera.vfov_deg, camera.near or 0.1, camera.far)
