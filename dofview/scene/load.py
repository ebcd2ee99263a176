"""Opening a scene: one ordered list of readers, one class of error, whatever the bytes are.

demo:NAME[@SIZE]   a procedural scene of dofview/scene/demo.py
.glb .gltf         our own glTF 2.0 reader, recognised by content first
.obj               Wavefront OBJ with its .mtl
.ply .stl .off     one mesh, through trimesh
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

from dofview.errors import ModelError
from dofview.scene.files import Folder
from dofview.scene.limits import Account, Limits
from dofview.scene.model import Scene
from dofview.scene.notes import one_line

DEMO = "demo:"
PAUSES = (0.0, 0.05, 0.2, 0.5)
"""Seconds to wait before each attempt to read files that are being written: exporters need a moment."""
ACCEPTED = f"a .gltf, .glb, .obj, .ply, .stl or .off file, or {DEMO}NAME"


@dataclass(frozen=True)
class Reader:
    """A file format: `accepts(suffix, first bytes)` says whether `read(bytes, name, folder)` is the one to call."""

    name: str
    accepts: Callable[[str, bytes], bool]
    read: Callable[[bytes, str, Folder], Scene]


def _read_gltf(data: bytes, name: str, folder: Folder) -> Scene:
    from dofview.scene import gltf

    return gltf.read(data, name, folder)


def _read_obj(data: bytes, name: str, folder: Folder) -> Scene:
    from dofview.scene import obj

    return obj.read(data, name, folder)


def _mesh_reader(suffix: str) -> Reader:
    def read(data: bytes, name: str, folder: Folder) -> Scene:
        from dofview.scene import mesh

        return mesh.read(data, name, folder, suffix)

    return Reader(suffix[1:].upper(), lambda found, head: found == suffix, read)


READERS = (
    Reader("glTF binary", lambda suffix, head: head[:4] == b"glTF", _read_gltf),
    Reader("Wavefront OBJ", lambda suffix, head: suffix == ".obj", _read_obj),
    *map(_mesh_reader, (".ply", ".stl", ".off")),
    Reader(
        "glTF",
        lambda suffix, head: suffix in (".gltf", ".glb") or head.lstrip(b"\xef\xbb\xbf \t\r\n")[:1] == b"{",
        _read_gltf,
    ),
)


def load(spec: str | Path, limits: Limits | None = None) -> Scene:
    """Load a scene from a file or a `demo:` name.

    Raises ModelError with one line that names the file, the object in it and the reason; no other exception. What could
    not be read or was repaired is listed in `Scene.warnings`.
    """
    text = str(spec)
    if text.startswith(DEMO):
        from dofview.scene import demo

        return demo.build(text[len(DEMO) :])
    path = Path(spec)
    try:
        return _load_stable(path, limits or Limits())
    except ModelError as error:
        raise ModelError(one_line(f"{path}: {error}", 600)) from error
    except MemoryError as error:
        raise ModelError(one_line(f"{path}: needs more memory than there is")) from error


def _load_stable(path: Path, limits: Limits) -> Scene:
    """Load, and again if a file was being written meanwhile, so that a scene is never a mix of two states."""
    for pause in PAUSES:
        time.sleep(pause)
        folder = Folder(path.parent, Account(limits))
        try:
            scene = _load_once(path, folder)
        except ModelError:
            if not folder.changed():
                raise
            continue
        if not folder.changed():
            return replace(scene, source=str(path), files=folder.files)
    raise ModelError("changed while it was read; try again when it is written")


def _load_once(path: Path, folder: Folder) -> Scene:
    data = folder.read_model(path)
    for reader in READERS:
        if reader.accepts(path.suffix.lower(), data[:64]):
            return reader.read(data, one_line(path.stem, 100), folder)
    raise ModelError(f"is in no known format; accepted: {ACCEPTED}")
