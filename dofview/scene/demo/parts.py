"""From a list of shapes with materials to a `Scene` of about as many triangles as asked for."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from dofview.errors import ModelError
from dofview.scene.camera import Camera
from dofview.scene.demo.shapes import Patch, Shape
from dofview.scene.model import Instance, Material, Picture, Primitive, Scene, SceneCamera, Texture

MOST_TRIANGLES = 8_000_000


@dataclass(frozen=True, eq=False)
class Part:
    """A shape and what it is made of."""

    shape: Shape
    material: Material


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
    patches = [patch for part in parts for patch in part.shape]
    scale = 1.0 if triangles is None else _scale_for(name, patches, triangles)
    materials: list[Material] = []
    grouped: dict[int, list[Patch]] = {}
    for part in parts:
        if part.material not in materials:
            materials.append(part.material)
        grouped.setdefault(materials.index(part.material), []).extend(part.shape)
    primitives = [_join(group, scale, index, materials[index].name) for index, group in grouped.items()]
    return Scene(
        name=name,
        primitives=tuple(primitives),
        instances=tuple(Instance(index, np.eye(4)) for index in range(len(primitives))),
        materials=tuple(materials),
        cameras=(_scene_camera(camera),),
        source=f"demo:{name}",
    )


def _scale_for(name: str, patches: list[Patch], triangles: int) -> float:
    least = sum(patch.count(0.0) for patch in patches)
    if not least <= triangles <= MOST_TRIANGLES:
        raise ModelError(f"demo scene {name!r} with {triangles} triangles; accepted: {least} to {MOST_TRIANGLES}")
    low, high = 0.0, 1.0
    while sum(patch.count(high) for patch in patches) < triangles:
        high *= 2
    for _ in range(40):
        middle = (low + high) / 2
        low, high = (middle, high) if sum(patch.count(middle) for patch in patches) < triangles else (low, middle)
    return high


def _join(patches: list[Patch], scale: float, material: int, name: str) -> Primitive:
    meshes = [patch.mesh(scale) for patch in patches]
    offsets = np.cumsum([0] + [len(mesh[0]) for mesh in meshes])
    positions, normals, texcoords = (np.concatenate([m[k] for m in meshes]).astype(np.float32) for k in range(3))
    triangles = np.concatenate([mesh[3] + offset for mesh, offset in zip(meshes, offsets, strict=False)])
    return Primitive(
        positions, triangles.astype(np.uint32), normals, (texcoords, None), material=material, name=name
    )  # fmt: skip


def _scene_camera(camera: Camera) -> SceneCamera:
    matrix = np.eye(4)
    matrix[:3, :3] = camera.axes().T
    matrix[:3, 3] = camera.position
    return SceneCamera("view", matrix, camera.vfov_deg, camera.near or 0.1, camera.far)
