"""Puts a scene together: walks the nodes and gathers the primitives, instances, materials and cameras they lead to."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace

import numpy as np

from dofview.errors import ModelError
from dofview.scene.files import Folder
from dofview.scene.gltf import features, nodes
from dofview.scene.gltf.accessors import Accessors
from dofview.scene.gltf.container import Document
from dofview.scene.gltf.fields import Fields
from dofview.scene.gltf.geometry import LINES_AND_POINTS, TRIANGLES, Geometry, has_positions
from dofview.scene.gltf.materials import Materials
from dofview.scene.model import Instance, Material, Primitive, Scene, SceneCamera, instance_bounds
from dofview.scene.notes import Notes
from dofview.scene.repair import LARGEST

MOST_CAMERAS = 1000
_MORPHS = ("primitive with morph targets", "primitives with morph targets", "shown at the default weights")


class SceneReader:
    """Reads one document, once."""

    def __init__(self, document: Document, folder: Folder) -> None:
        self._document, self._account, self._notes = document, folder.account, Notes()
        accessors = Accessors(document, folder, self._notes)
        self._geometry = Geometry(document, accessors, folder.account, self._notes)
        self._materials = Materials(document, accessors, folder, self._notes)
        self._primitives: list[Primitive] = []
        self._places: dict[tuple[int, int, tuple[float, ...]], int | None] = {}
        self._counts: dict[int, list[int]] = {}
        self._drawable: dict[int, list[tuple[int, Fields, int]]] = {}
        self._instances: list[Instance] = []
        self._cameras: list[SceneCamera] = []

    def read(self, name: str) -> Scene:
        """Walk the default scene and return it."""
        features.check_extensions(self._document, self._notes)
        for node, world in nodes.walk(self._document, self._notes):
            self._add_mesh(node, world)
            self._add_camera(node, world)
        features.note_unread(self._document, self._notes)
        return Scene(
            name=name,
            primitives=tuple(self._primitives),
            instances=tuple(self._instances),
            materials=tuple(self._materials.made) or (Material(),),
            cameras=tuple(self._cameras),
            warnings=self._notes.texts(),
            mesh_triangles=self._mesh_triangles(),
        )

    def _mesh_triangles(self) -> int:
        """Triangles of every mesh in the file, shown or not, as the Khronos validator counts them."""
        total = 0
        for index in range(len(self._document.entries("meshes"))):
            with suppress(ModelError):  # a mesh that nothing shows may be as broken as it likes
                total += sum(self._triangle_counts(index))
        return total

    def _triangle_counts(self, mesh: int) -> list[int]:
        """The triangles that each primitive of a mesh declares."""
        if mesh not in self._counts:
            primitives = self._document.entry("meshes", mesh).objects("primitives")
            self._counts[mesh] = list(map(self._geometry.triangle_count, primitives))
        return self._counts[mesh]

    def _add_camera(self, node: Fields, world: np.ndarray) -> None:
        index = self._document.reference(node, "camera", "cameras")
        if index is not None and len(self._cameras) >= MOST_CAMERAS:
            self._notes.say(f"more than {MOST_CAMERAS} cameras; the others not offered")
        elif index is not None:
            made = nodes.camera(self._document.entry("cameras", index), world, self._notes)
            self._cameras.extend([made] if made else [])

    def _add_mesh(self, node: Fields, world: np.ndarray) -> None:
        index = self._document.reference(node, "mesh", "meshes")
        if index is None:
            return
        mesh = self._document.entry("meshes", index)
        weights = _weights(node) or _weights(mesh)
        if index not in self._drawable:
            self._drawable[index] = self._drawable_of(mesh, self._triangle_counts(index))
        for number, fields, triangles in self._drawable[index]:
            self._account.charge_draw(triangles)
            key = (index, number, weights)
            if key not in self._places:
                self._places[key] = self._decode(fields, weights, mesh.name(f"mesh {index}"))
            place = self._places[key]
            if place is not None:
                self._place(place, world)

    def _drawable_of(self, mesh: Fields, counts: list[int]) -> list[tuple[int, Fields, int]]:
        """Number, fields and triangle count of the primitives that can be drawn; the others are noted."""
        found = []
        for number, (fields, triangles) in enumerate(zip(mesh.objects("primitives"), counts, strict=True)):
            if triangles and has_positions(fields):
                found.append((number, fields, triangles))
            else:
                self._note_left_out(fields)
        return found

    def _decode(self, fields: Fields, weights: tuple[float, ...], name: str) -> int | None:
        slot = self._materials.slot(fields)
        made = self._geometry.read(fields, weights, slot, self._materials.made[slot].unlit)
        if fields.array("targets"):
            self._notes.count(*_MORPHS)
        if made is None:
            return None
        self._primitives.append(replace(made, name=name))
        return len(self._primitives) - 1

    def _place(self, place: int, world: np.ndarray) -> None:
        bounds = instance_bounds(self._primitives[place], world)
        if bounds is not None and (np.abs(bounds) <= LARGEST).all():
            self._instances.append(Instance(place, world))
        else:
            self._notes.count("mesh", "meshes", "farther away than 1e18 left out")

    def _note_left_out(self, fields: Fields) -> None:
        mode = fields.integer("mode", TRIANGLES, high=6)
        kind = LINES_AND_POINTS.get(mode)
        if kind:
            self._notes.count(f"{kind} primitive", f"{kind} primitives", "not shown")
        else:
            self._notes.count("primitive", "primitives", "without a triangle not shown")


def _weights(owner: Fields) -> tuple[float, ...]:
    """The default morph weights of a mesh or node."""
    count = len(owner.array("weights"))
    return owner.numbers("weights", count) if count else ()
