"""Wavefront OBJ with MTL libraries, into the scene model.

statements   text → flat arrays of numbers and indices
polygons     faces of any number of corners → triangles
mesh         welding, normals, one primitive for each material
library      MTL text → entries
materials    entries and pictures → materials
"""

from __future__ import annotations

import numpy as np

from dofview.scene.files import Folder
from dofview.scene.model import Instance, Material, Scene
from dofview.scene.notes import Notes
from dofview.scene.obj.materials import Materials
from dofview.scene.obj.mesh import primitives, slots_of, triangles_of
from dofview.scene.obj.statements import scan
from dofview.scene.repair import origin_for


def read(data: bytes, name: str, folder: Folder) -> Scene:
    """Read the bytes of an .obj file whose libraries and textures are taken in `folder`; ModelError says why not."""
    notes = Notes()
    made = scan(data, folder.account, notes)
    triangles = triangles_of(made, notes)
    materials = Materials(folder, notes)
    materials.read_libraries(made.libraries)
    slots = slots_of(made, triangles, materials.slot)
    used = np.zeros(len(made.positions), bool)
    used[triangles.place] = True
    origin = origin_for(made.positions[used])
    parts = []
    for part in primitives(made, triangles, slots, origin, notes):
        folder.account.charge_draw(0)  # its triangles are charged already
        parts.append(part)
    matrix = np.eye(4)
    matrix[:3, 3] = origin
    return Scene(
        name=name,
        primitives=tuple(parts),
        instances=tuple(Instance(index, matrix) for index in range(len(parts))),
        materials=tuple(materials.made) or (Material(),),
        warnings=notes.texts(),
    )
