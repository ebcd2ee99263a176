"""The node hierarchy (glTF 2.0 §3.5): an iterative walk that visits every node once, whatever the file claims."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from dofview.scene.gltf.container import Document
from dofview.scene.gltf.fields import Fields
from dofview.scene.model import SceneCamera
from dofview.scene.normals import unit
from dofview.scene.notes import Notes
from dofview.scene.repair import LARGEST


def walk(document: Document, notes: Notes) -> Iterator[tuple[Fields, np.ndarray]]:
    """Yield each node of the default scene with its (4, 4) float64 world matrix, parents before children."""
    seen = bytearray(len(document.entries("nodes")))
    stack = [(index, np.eye(4)) for index in reversed(_roots(document, notes))]
    while stack:
        index, parent = stack.pop()
        if seen[index]:
            notes.count("node", "nodes", "reached by more than one path, shown once (a cycle or two parents)")
            continue
        seen[index] = 1
        fields = document.entry("nodes", index)
        world = _placed(fields, parent, notes)
        if not (np.abs(world) <= LARGEST).all():
            notes.count("node", "nodes", "with a transform beyond 1e18 left out, and all below")
            continue
        yield fields, world
        stack.extend((child, world) for child in reversed(document.references(fields, "children", "nodes")))


def _roots(document: Document, notes: Notes) -> list[int]:
    scenes = document.entries("scenes")
    if not scenes:
        return _parentless(document, notes)
    chosen = document.reference(document.root, "scene", "scenes") or 0
    others = [document.entry("scenes", i).name(str(i)) for i in range(min(len(scenes), 20)) if i != chosen]
    if others:
        listed = ", ".join(f"'{name}'" for name in others)
        notes.count(f"further scene not shown: {listed}", f"further scenes not shown: {listed}", "", len(scenes) - 1)
    return document.references(document.entry("scenes", chosen), "nodes", "nodes")


def _parentless(document: Document, notes: Notes) -> list[int]:
    count = len(document.entries("nodes"))
    children: set[int] = set()
    for index in range(count):
        children.update(document.references(document.entry("nodes", index), "children", "nodes"))
    if count:
        notes.say("the file names no scene; all its nodes are shown")
    return [index for index in range(count) if index not in children]


def _placed(fields: Fields, parent: np.ndarray, notes: Notes) -> np.ndarray:
    data = fields.data
    if data.get("matrix") is not None:
        local = np.array(fields.numbers("matrix", 16)).reshape(4, 4).T
        if not np.array_equal(local[3], (0.0, 0.0, 0.0, 1.0)):
            notes.count("node", "nodes", "with a projective matrix, its last row taken as 0 0 0 1")
            local[3] = (0.0, 0.0, 0.0, 1.0)
    elif data.get("translation") is None and data.get("rotation") is None and data.get("scale") is None:
        return parent
    else:
        local = _composed(fields)
    with np.errstate(over="ignore", invalid="ignore"):
        return parent @ local


def _composed(fields: Fields) -> np.ndarray:
    """Translation · rotation · scale; the quaternion is x, y, z, w and is normalised (all zero means no rotation)."""
    x, y, z, w = fields.numbers("rotation", 4, (0.0, 0.0, 0.0, 1.0))
    length = math.hypot(x, y, z, w)
    x, y, z, w = (x / length, y / length, z / length, w / length) if 0 < length < math.inf else (0.0, 0.0, 0.0, 1.0)
    sx, sy, sz = fields.numbers("scale", 3, (1.0, 1.0, 1.0))
    tx, ty, tz = fields.numbers("translation", 3, (0.0, 0.0, 0.0))
    return np.array(
        [
            [(1 - 2 * (y * y + z * z)) * sx, 2 * (x * y - z * w) * sy, 2 * (x * z + y * w) * sz, tx],
            [2 * (x * y + z * w) * sx, (1 - 2 * (x * x + z * z)) * sy, 2 * (y * z - x * w) * sz, ty],
            [2 * (x * z - y * w) * sx, 2 * (y * z + x * w) * sy, (1 - 2 * (x * x + y * y)) * sz, tz],
            [0.0, 0.0, 0.0, 1.0],
        ]
    )


def camera(fields: Fields, world: np.ndarray, notes: Notes) -> SceneCamera | None:
    """Make the perspective camera of a node; scale and shear of its transform are taken out (§3.10)."""
    name = fields.name(fields.where)
    lens = fields.inside("perspective")
    if lens is None:
        notes.say(f"{fields.where} '{name}' is not a perspective camera; not offered")
        return None
    vfov, near, far = lens.number("yfov"), max(lens.number("znear", 0.0), 0.0), lens.number("zfar", None)
    backward = unit(world[:3, 2])
    right = unit(np.cross(world[:3, 1], backward))
    if not 0 < vfov < math.radians(179) or not backward.any() or not right.any():
        notes.say(f"{fields.where} '{name}' has no usable field of view or direction; not offered")
        return None
    matrix = np.eye(4)
    matrix[:3, :3] = np.stack([right, np.cross(backward, right), backward], axis=1)
    matrix[:3, 3] = world[:3, 3]
    if far is not None and not far > near:
        far = None
    return SceneCamera(name, matrix, math.degrees(vfov), near, far)
