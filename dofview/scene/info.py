"""The facts of a scene as plain values, for `dofview info` and for anyone who wants to check what was read."""

from __future__ import annotations

from typing import Any

import numpy as np

from dofview.scene.model import Material, Picture, Scene, Texture

TEXTURES = (
    "base_color_texture", "metallic_roughness_texture", "normal_texture", "occlusion_texture", "emissive_texture",
)  # fmt: skip


MOST_TURNED = 20_000_000  # vertices, some seconds


def describe(scene: Scene) -> dict[str, Any]:
    """Facts of a scene, ready for JSON: every number finite, every text printable.

    `triangles` counts each mesh of the file once, as the Khronos glTF validator does; `triangles_drawn` and `draws`
    count what the scene shows, each instance again.
    """
    drawn = scene.triangle_count
    low, high = exact_bounds(scene)
    return {
        "name": scene.name,
        "source": scene.source,
        "triangles": drawn if scene.mesh_triangles is None else scene.mesh_triangles,
        "triangles_drawn": drawn,
        "draws": len(scene.instances),
        "primitives": len(scene.primitives),
        "vertices": sum(len(primitive.positions) for primitive in scene.primitives),
        "bounds": {"low": low.tolist(), "high": high.tolist()},
        "materials": [_material(material) for material in scene.materials],
        "textures": [
            {"name": picture.name, "width": picture.pixels.shape[1], "height": picture.pixels.shape[0]}
            for picture in pictures(scene)
        ],
        "cameras": [
            {
                "name": camera.name,
                "position": camera.matrix[:3, 3].tolist(),
                "direction": (-camera.matrix[:3, 2]).tolist(),
                "vfov_deg": camera.vfov_deg,
                "near": camera.near,
                "far": camera.far,
            }
            for camera in scene.cameras
        ],
        "warnings": list(scene.warnings),
    }


def exact_bounds(scene: Scene) -> np.ndarray:
    """(2, 3) float64 corners around the vertices themselves.

    `Scene.bounds` carries boxes through the transforms, which is quick and never too small, but too large for turned
    instances. Scenes of very many turned vertices keep that answer.
    """
    corners, work = [], 0
    for instance in scene.instances:
        primitive, linear = scene.primitives[instance.primitive], instance.matrix[:3, :3]
        turned = (np.count_nonzero(linear, axis=1) > 1).any()
        work += len(primitive.positions) if turned else 0
        if work > MOST_TURNED:
            return scene.bounds
        points = primitive.positions if turned else primitive.box
        placed = points.astype(np.float64) @ linear.T + instance.matrix[:3, 3]
        corners.append((placed.min(axis=0), placed.max(axis=0)))
    if not corners:
        return scene.bounds
    lows, highs = zip(*corners, strict=True)
    return np.array([np.min(lows, axis=0), np.max(highs, axis=0)])


def pictures(scene: Scene) -> list[Picture]:
    """The distinct pictures of a scene, in the order its materials use them."""
    found: dict[int, Picture] = {}
    for material in scene.materials:
        for slot in TEXTURES:
            texture: Texture | None = getattr(material, slot)
            if texture is not None:
                found.setdefault(id(texture.picture), texture.picture)
    return list(found.values())


def _material(material: Material) -> dict[str, Any]:
    return {
        "name": material.name,
        "base_color": list(material.base_color),
        "metallic": material.metallic,
        "roughness": material.roughness,
        "emissive": list(material.emissive),
        "unlit": material.unlit,
        "double_sided": material.double_sided,
        "alpha_mode": material.alpha_mode,
        "textures": {
            slot.removesuffix("_texture"): getattr(material, slot).picture.name
            for slot in TEXTURES
            if getattr(material, slot) is not None
        },
    }
