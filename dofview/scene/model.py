"""A scene in memory: frozen dataclasses of numpy arrays, independent of any file format and of OpenGL.

Right-handed, y up, scene units as in the file. Every number here is finite and every index in range:
readers refuse or repair, so nothing downstream has to check again.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal

import numpy as np

Wrap = Literal["repeat", "clamp", "mirror"]
AlphaMode = Literal["OPAQUE", "MASK", "BLEND"]
MIN_FILTERS = (
    "NEAREST", "LINEAR",
    "NEAREST_MIPMAP_NEAREST", "LINEAR_MIPMAP_NEAREST", "NEAREST_MIPMAP_LINEAR", "LINEAR_MIPMAP_LINEAR",
)  # fmt: skip


@dataclass(frozen=True, eq=False)
class Picture:
    """A decoded image: `pixels` is (height, width, 4) uint8, row 0 on top, as stored in the file (not linearised)."""

    name: str
    pixels: np.ndarray


@dataclass(frozen=True)
class Sampler:
    """How a texture is looked up (glTF 2.0 §3.8.4)."""

    wrap_s: Wrap = "repeat"
    wrap_t: Wrap = "repeat"
    magnify: Literal["NEAREST", "LINEAR"] = "LINEAR"
    minify: str = "LINEAR_MIPMAP_LINEAR"


@dataclass(frozen=True, eq=False)
class Texture:
    """A picture with its sampler, texture-coordinate set (0 or 1) and (2, 3) uv transform (KHR_texture_transform).

    A primitive that lacks the set is looked up at (0, 0).
    """

    picture: Picture
    sampler: Sampler = Sampler()
    texcoord: int = 0
    transform: np.ndarray | None = None


@dataclass(frozen=True, eq=False)
class Material:
    """Metallic-roughness material (glTF 2.0 §3.9). Colours are linear; `emissive` includes the emissive strength."""

    name: str = "default"
    base_color: tuple[float, float, float, float] = (1.0, 1.0, 1.0, 1.0)
    base_color_texture: Texture | None = None
    metallic: float = 1.0
    roughness: float = 1.0
    metallic_roughness_texture: Texture | None = None
    normal_texture: Texture | None = None
    normal_scale: float = 1.0
    occlusion_texture: Texture | None = None
    occlusion_strength: float = 1.0
    emissive: tuple[float, float, float] = (0.0, 0.0, 0.0)
    emissive_texture: Texture | None = None
    unlit: bool = False
    double_sided: bool = False
    alpha_mode: AlphaMode = "OPAQUE"
    alpha_cutoff: float = 0.5


@dataclass(frozen=True, eq=False)
class Primitive:
    """Indexed triangles with one material.

    `positions` (n, 3) float32, `normals` (n, 3) float32 of unit length, `texcoords` two sets of (n, 2) float32 with
    v = 0 at the top row of the picture (glTF), `colors` (n, 4) float32 linear, `triangles` (m, 3) uint32.
    """

    positions: np.ndarray
    triangles: np.ndarray
    normals: np.ndarray
    texcoords: tuple[np.ndarray | None, np.ndarray | None] = (None, None)
    colors: np.ndarray | None = None
    material: int = 0
    name: str = ""

    @cached_property
    def box(self) -> np.ndarray:
        """(2, 3) float64 lowest and highest corner of all positions (there must be one), worked out once."""
        return np.array([self.positions.min(axis=0), self.positions.max(axis=0)], dtype=np.float64)


@dataclass(frozen=True, eq=False)
class Instance:
    """A primitive placed in the world; `matrix` is (4, 4) float64, column vectors.

    It is finite; it may mirror (negative determinant: front faces then wind clockwise) or flatten (singular).
    """

    primitive: int
    matrix: np.ndarray


@dataclass(frozen=True, eq=False)
class SceneCamera:
    """A perspective camera found in the file; `matrix` (4, 4) float64 is camera to world, looking along −z."""

    name: str
    matrix: np.ndarray
    vfov_deg: float
    near: float
    far: float | None = None


@dataclass(frozen=True, eq=False)
class Scene:
    """All that was read from a file, and in `warnings` all that was not."""

    name: str
    primitives: tuple[Primitive, ...]
    instances: tuple[Instance, ...]
    materials: tuple[Material, ...] = (Material(),)
    cameras: tuple[SceneCamera, ...] = ()
    warnings: tuple[str, ...] = ()
    source: str = ""
    files: tuple[str, ...] = ()  # all that were read for it
    mesh_triangles: int | None = None  # in all meshes of the file, each counted once; None: not from a file with meshes
    _bounds: list[np.ndarray] = field(default_factory=list, repr=False)

    @property
    def triangle_count(self) -> int:
        """Triangles drawn, instances counted each time."""
        return sum(len(self.primitives[i.primitive].triangles) for i in self.instances)

    @property
    def bounds(self) -> np.ndarray:
        """(2, 3) float64: the lowest and highest corner in world space; zeros for an empty scene."""
        if not self._bounds:
            boxes = [instance_bounds(self.primitives[i.primitive], i.matrix) for i in self.instances]
            corners = [c for c in boxes if c is not None]
            lowest = np.min([c[0] for c in corners], axis=0) if corners else np.zeros(3)
            highest = np.max([c[1] for c in corners], axis=0) if corners else np.zeros(3)
            self._bounds.append(np.array([lowest, highest]))
        return self._bounds[0]


def instance_bounds(primitive: Primitive, matrix: np.ndarray) -> np.ndarray | None:
    """(2, 3) float64 corners of the primitive's box carried through `matrix`; None when it has no triangles."""
    if len(primitive.positions) == 0 or len(primitive.triangles) == 0:
        return None
    low, high = primitive.box
    center, half = (low + high) / 2, (high - low) / 2
    world_center = matrix[:3, :3] @ center + matrix[:3, 3]
    world_half = np.abs(matrix[:3, :3]) @ half
    return np.array([world_center - world_half, world_center + world_half])
