"""PLY, STL and OFF through trimesh: one mesh, with the colours of its vertices where the file has them."""

from __future__ import annotations

import io
from typing import Any

import numpy as np

from dofview.errors import ModelError
from dofview.metrics import srgb_decode
from dofview.scene.files import Folder
from dofview.scene.model import Instance, Material, Primitive, Scene
from dofview.scene.normals import smooth_normals
from dofview.scene.notes import Notes
from dofview.scene.repair import LARGEST, origin_for, used_rows

_CLAY = Material(name="clay", base_color=(0.6, 0.58, 0.55, 1.0), metallic=0.0, roughness=0.6, double_sided=True)
_PAINTED = Material(name="painted", metallic=0.0, roughness=0.6, double_sided=True)


def read(data: bytes, name: str, folder: Folder, suffix: str) -> Scene:
    """Read the bytes of a `suffix` file; ModelError says why not. Corners that are one in the file share a normal."""
    notes = Notes()
    mesh = _parse(data, suffix)
    positions, triangles = np.asarray(mesh.vertices, np.float64), np.asarray(mesh.faces, np.int64)
    if len(triangles) == 0:
        raise ModelError("has no faces; accepted: a mesh")
    if triangles.min() < 0 or triangles.max() >= len(positions):
        raise ModelError(f"has a face that names a vertex it has not; accepted: 0 to {len(positions) - 1}")
    folder.account.charge_draw(len(triangles))
    finite = (np.abs(positions[triangles]) <= LARGEST).all(axis=(1, 2))
    notes.count("face", "faces", "with a corner that is not finite, left out", int((~finite).sum()))
    rows, triangles = used_rows(triangles[finite].astype(np.uint32))
    positions = positions[rows]
    origin, colors = origin_for(positions), _colors(mesh, rows)
    local = (positions - origin).astype(np.float32)
    parts = [Primitive(local, triangles, smooth_normals(local, triangles), colors=colors)] if len(triangles) else []
    matrix = np.eye(4)
    matrix[:3, 3] = origin
    return Scene(
        name=name,
        primitives=tuple(parts),
        instances=tuple(Instance(index, matrix) for index in range(len(parts))),
        materials=(_CLAY if colors is None else _PAINTED,),
        warnings=notes.texts(),
    )


def _parse(data: bytes, suffix: str) -> Any:
    import trimesh

    try:
        return trimesh.load_mesh(io.BytesIO(data), file_type=suffix[1:], process=False, maintain_order=True)
    except MemoryError:
        raise
    except Exception as error:  # the parsers raise whatever broken bytes lead them to
        raise ModelError(f"is not a readable {suffix[1:].upper()} file ({type(error).__name__})") from error


def _colors(mesh: Any, rows: slice | np.ndarray) -> np.ndarray | None:
    """(n, 4) float32 linear; files hold 8-bit sRGB."""
    if mesh.visual.kind != "vertex":
        return None
    encoded = np.asarray(mesh.visual.vertex_colors, np.float64)[rows] / 255.0
    return np.concatenate([srgb_decode(encoded[:, :3]), encoded[:, 3:]], axis=1).astype(np.float32)
