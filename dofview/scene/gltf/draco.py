"""KHR_draco_mesh_compression through DracoPy, and what is said where that has no build for a machine."""

from __future__ import annotations

import importlib.util
from dataclasses import dataclass

import numpy as np

from dofview.errors import ModelError
from dofview.scene.gltf.fields import Fields
from dofview.scene.limits import Account

EXTENSION = "KHR_draco_mesh_compression"


@dataclass(frozen=True, eq=False)
class Mesh:
    """A decoded Draco mesh: `corners` (3 m,) uint32, and (n, width) attributes by glTF name."""

    corners: np.ndarray
    attributes: dict[str, np.ndarray]


def available() -> bool:
    """Tell whether the decoder is installed."""
    return importlib.util.find_spec("DracoPy") is not None


def decode(data: memoryview, extension: Fields, account: Account) -> Mesh:
    """Decode the compressed bytes of one primitive."""
    import DracoPy

    try:
        mesh = DracoPy.decode(bytes(data))
    except Exception as error:  # the wrapper raises several classes of its own, and plain ones
        raise ModelError(f"{extension.where} is not valid Draco data") from error
    faces = getattr(mesh, "faces", None)
    if faces is None:
        raise ModelError(f"{extension.where} is a Draco point cloud; accepted: a mesh")
    found = {attribute["unique_id"]: np.asarray(attribute["data"]) for attribute in mesh.attributes}
    names = extension.inside("attributes") or Fields({}, extension.where)
    attributes = {}
    for name in names.data:
        values = found.get(names.integer(name))
        if values is None or values.dtype.kind not in "iuf":
            raise ModelError(f"{extension.where} has no attribute for {name}")
        attributes[name] = values.reshape(len(values), -1)
        account.charge_geometry(values.nbytes)
    return Mesh(np.asarray(faces, np.uint32).reshape(-1), attributes)
