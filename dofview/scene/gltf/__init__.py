"""Our own glTF 2.0 reader: .gltf with external or embedded data, and .glb, into the scene model.

    container   the shell: .glb chunks, JSON, version           → Document
    fields      JSON values by key, with type and range
    features    extensions: refused, honoured or listed
    nodes       transforms, cameras
    accessors   buffers → arrays, every bound checked first
    draco       compressed arrays
    geometry    primitives → indexed triangles
    materials   factors, textures, samplers, pictures

Everything is decoded when the default scene first needs it, so unused parts of a file cost nothing.
"""

from __future__ import annotations

from dofview.scene.files import Folder
from dofview.scene.gltf.container import parse
from dofview.scene.gltf.reader import SceneReader
from dofview.scene.model import Scene


def read(data: bytes, name: str, folder: Folder) -> Scene:
    """Read the bytes of a .gltf or .glb file whose references are taken in `folder`; ModelError says why not."""
    return SceneReader(parse(data), folder).read(name)
