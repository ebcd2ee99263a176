"""A scene on the GPU: one vertex buffer and one index buffer, baked in world space around the scene's own origin.

Positions are carried to the world in float64 and stored relative to where most of the scene is, so one a million metres
away, or with a sky that far, keeps its detail in float32. Draws of one material are merged, in pieces small enough to
cull.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import moderngl
import numpy as np

from dofview.gl.context import Gpu
from dofview.render.blended import Blended
from dofview.render.materials import MaterialSet
from dofview.scene.model import Instance, Primitive, Scene, instance_bounds

VERTEX_FORMAT = "3f 3f 2f 2f 4f"
VERTEX_NAMES = ("in_position", "in_normal", "in_texcoord0", "in_texcoord1", "in_color")
_FLOATS = 14
PIECE_TRIANGLES = 2048
"""Pieces are this large to be left out of a picture one by one; those in it that lie together are drawn at once."""


@dataclass(frozen=True, eq=False)
class Draw:
    """A range of the index buffer with one material; `bounds` (2, 3) float64 in the scene's local space."""

    material: int
    first: int
    count: int
    bounds: np.ndarray


class GpuScene:
    """Buffers, materials and draws of one scene; `origin` (3,) float64 is what local space is relative to."""

    def __init__(self, gpu: Gpu, scene: Scene):
        self.scene = scene
        self.origin = _origin(scene)
        self.materials = MaterialSet(gpu, scene.materials, _translucent_colors(scene))
        vertices, triangles, self.draws = _bake(scene, self.origin)
        self.blended = self._blended(gpu, vertices, triangles)
        self._vertices = gpu.ctx.buffer(vertices.tobytes()) if len(vertices) else None
        self._indices = gpu.ctx.buffer(triangles.tobytes()) if len(triangles) else None
        self.culling = True
        """Whether draws are left out that cannot reach a picture; without, to show that they cannot."""
        self._corners = _corners(self.draws)
        self._ranges = np.array([(d.material, d.first, d.count) for d in self.draws], np.int64).reshape(-1, 3)
        self._ctx = gpu.ctx
        self._arrays: dict[tuple[moderngl.Program, bool], moderngl.VertexArray] = {}

    @property
    def local_bounds(self) -> np.ndarray:
        """(2, 3) float64 corners relative to `origin`."""
        return self.scene.bounds - self.origin

    def visible(self, *clips_from_local: np.ndarray) -> np.ndarray:
        """Numbers of the draws whose boxes can reach one of the pictures: not all corners lie beyond one clip plane.

        Of several (4, 4) matrices every view between them counts too: a box beyond the same plane in all of them.
        """
        if not self.culling:
            return np.arange(len(self.draws))
        beyond = np.ones((5, len(self.draws)), bool)
        for clip_from_local in clips_from_local:
            x, y, _, w = np.moveaxis(self._corners @ clip_from_local.T, 2, 0)
            beyond &= [side.all(axis=1) for side in (x > w, x < -w, y > w, y < -w, w <= 0.0)]
        return np.flatnonzero(~beyond.any(axis=0))

    def depths(self, numbers: np.ndarray, clip_from_local: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Depths of the nearest and the farthest corner of the boxes of the draws `numbers`, and whether all corners
        are inside the picture."""
        x, y, _, w = np.moveaxis(self._corners[numbers] @ clip_from_local.T, 2, 0)
        return w.min(axis=1), w.max(axis=1), ((abs(x) <= w) & (abs(y) <= w)).all(axis=1)

    def runs(self, numbers: np.ndarray) -> list[tuple[int, int, int]]:
        """Material, first index and count of the draws `numbers`, ascending, those that lie together joined."""
        if not len(numbers):
            return []
        material, first, count = self._ranges[numbers].T
        starts = np.flatnonzero(np.r_[True, (np.diff(material) != 0) | (first[1:] != first[:-1] + count[:-1])])
        return list(
            zip(*(x.tolist() for x in (material[starts], first[starts], np.add.reduceat(count, starts))), strict=True)
        )

    def array(self, program: moderngl.Program, blended: bool = False) -> moderngl.VertexArray:
        """Return the scene's vertex array for `program`, which may use any subset of the attributes; or that of its
        `blended` triangles, in the order in which they were sorted last."""
        # By identity, not by OpenGL's name for it: names are used again after a shader is reloaded.
        if (program, blended) not in self._arrays:
            names = [name if name in program else None for name in VERTEX_NAMES]
            widths = VERTEX_FORMAT.split()
            layout = " ".join(w if n else f"{int(w[0]) * 4}x" for w, n in zip(widths, names, strict=True))
            content = [(self._vertices, layout, *[n for n in names if n])]
            indices = self.blended.indices if blended else self._indices
            self._arrays[program, blended] = self._ctx.vertex_array(program, content, indices, index_element_size=4)
        return self._arrays[program, blended]

    def release(self) -> None:
        for array in self._arrays.values():
            array.release()
        self._arrays.clear()
        for buffer in (self._vertices, self._indices):
            if buffer is not None:
                buffer.release()
        self.blended.release()
        self.materials.release()

    def _blended(self, gpu: Gpu, vertices: np.ndarray, triangles: np.ndarray) -> Blended:
        """Triangles of materials that are seen through, of all `triangles` (n, 3) into `vertices`."""
        materials = np.repeat([d.material for d in self.draws], [d.count // 3 for d in self.draws]).astype(np.int64)
        translucent = np.array([item.translucent for item in self.materials.items], bool)
        chosen = np.flatnonzero(translucent[materials]) if translucent.any() else np.zeros(0, np.int64)
        return Blended(gpu, materials[chosen], triangles[chosen], vertices[:, :3])


def _translucent_colors(scene: Scene) -> frozenset[int]:
    return frozenset(p.material for p in scene.primitives if p.colors is not None and (p.colors[:, 3] < 1.0).any())


def _corners(draws: tuple[Draw, ...]) -> np.ndarray:
    """(n, 8, 4) float64 homogeneous corners of all boxes."""
    corners = np.ones((len(draws), 8, 4))
    for number, draw in enumerate(draws):
        corners[number, :, :3] = np.stack(np.meshgrid(*draw.bounds.T, indexing="ij"), axis=-1).reshape(8, 3)
    return corners


def _origin(scene: Scene) -> np.ndarray:
    """(3,) the median of the middles of all instances: one large one far away does not move it."""
    boxes = [instance_bounds(scene.primitives[i.primitive], i.matrix) for i in scene.instances]
    middles = [box.mean(axis=0) for box in boxes if box is not None]
    return np.median(middles, axis=0) if middles else np.zeros(3)


def _bake(scene: Scene, origin: np.ndarray) -> tuple[np.ndarray, np.ndarray, tuple[Draw, ...]]:
    vertices: list[np.ndarray] = []
    triangles: list[np.ndarray] = []
    draws: list[Draw] = []
    base = first = 0
    drawn = [i for i in scene.instances if len(scene.primitives[i.primitive].triangles)]
    drawn.sort(key=lambda i: scene.primitives[i.primitive].material)
    for instance in drawn:
        primitive = scene.primitives[instance.primitive]
        vertices.append(_bake_vertices(primitive, instance, origin))
        corners = _bake_triangles(primitive, instance)
        triangles.append(corners + np.uint32(base))
        for draw in _pieces(primitive.material, first, vertices[-1], corners):
            _append_draw(draws, draw)
        base += len(primitive.positions)
        first += triangles[-1].size
    empty = np.zeros((0, _FLOATS), np.float32), np.zeros((0, 3), np.uint32)
    if not draws:
        return *empty, ()
    return np.concatenate(vertices), np.concatenate(triangles), tuple(draws)


def _pieces(material: int, first: int, vertices: np.ndarray, triangles: np.ndarray) -> Iterator[Draw]:
    """`triangles` in pieces of at most `PIECE_TRIANGLES`, in their order, with the box of each."""
    for start in range(0, len(triangles), PIECE_TRIANGLES):
        piece = triangles[start : start + PIECE_TRIANGLES]
        positions = vertices[piece.reshape(-1), :3]
        bounds = np.array([positions.min(axis=0), positions.max(axis=0)], np.float64)
        yield Draw(material, first + 3 * start, piece.size, bounds)


def _append_draw(draws: list[Draw], draw: Draw) -> None:
    """Add `draw`, merged into the last one while they share a material and the piece stays small."""
    last = draws[-1] if draws else None
    if last is not None and last.material == draw.material and last.count + draw.count <= 3 * PIECE_TRIANGLES:
        lowest = np.minimum(last.bounds[0], draw.bounds[0])
        highest = np.maximum(last.bounds[1], draw.bounds[1])
        draws[-1] = Draw(last.material, last.first, last.count + draw.count, np.array([lowest, highest]))
    else:
        draws.append(draw)


def _bake_vertices(primitive: Primitive, instance: Instance, origin: np.ndarray) -> np.ndarray:
    linear, offset = instance.matrix[:3, :3], instance.matrix[:3, 3] - origin
    count = len(primitive.positions)
    baked = np.zeros((count, _FLOATS), np.float32)
    baked[:, 0:3] = primitive.positions.astype(np.float64) @ linear.T + offset
    # The cofactor matrix carries normals like the inverse transpose, and also exists where a scale is zero.
    cofactor = np.stack(
        [np.cross(linear[1], linear[2]), np.cross(linear[2], linear[0]), np.cross(linear[0], linear[1])]
    )
    cofactor *= np.sign(np.linalg.det(linear)) or 1.0
    cofactor /= np.abs(cofactor).max() or 1.0
    normals = primitive.normals.astype(np.float64) @ cofactor.T
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    baked[:, 3:6] = np.where(length > 0.0, normals / np.where(length > 0.0, length, 1.0), (0.0, 0.0, 1.0))
    for column, texcoords in ((6, primitive.texcoords[0]), (8, primitive.texcoords[1])):
        if texcoords is not None:
            baked[:, column : column + 2] = texcoords
    baked[:, 10:14] = 1.0 if primitive.colors is None else primitive.colors
    return baked


def _bake_triangles(primitive: Primitive, instance: Instance) -> np.ndarray:
    triangles = primitive.triangles.astype(np.uint32)
    mirrored = np.linalg.det(instance.matrix[:3, :3]) < 0.0
    return np.ascontiguousarray(triangles[:, ::-1]) if mirrored else triangles
