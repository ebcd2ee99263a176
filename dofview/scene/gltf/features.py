"""What a glTF file asks for beyond what is read: refused by name when required, listed as a warning when not."""

from __future__ import annotations

from dofview.errors import ModelError
from dofview.scene.gltf import draco
from dofview.scene.gltf.container import Document
from dofview.scene.notes import Notes, one_line

HONOURED = {
    "KHR_materials_unlit",
    "KHR_materials_emissive_strength",
    "KHR_texture_transform",
    "KHR_mesh_quantization",
    "EXT_texture_webp",
}
WITHOUT_EFFECT = {
    "KHR_xmp",
    "KHR_xmp_json_ld",
    "KHR_materials_variants",
}  # nothing in the default picture depends on them


def check_extensions(document: Document, notes: Notes) -> None:
    """Refuse required extensions that are not honoured; note the others."""
    honoured = HONOURED | {draco.EXTENSION} if draco.available() else HONOURED
    required = document.root.strings("extensionsRequired")
    refused = [name for name in dict.fromkeys(required) if name not in honoured]
    if refused == [draco.EXTENSION]:
        raise ModelError(f"needs {draco.EXTENSION}; install DracoPy for it: pip install DracoPy")
    if refused:
        names = ", ".join(one_line(name, 60) for name in refused[:5])
        raise ModelError(f"needs {names}, which dofview does not read; accepted: {', '.join(sorted(honoured))}")
    for name in dict.fromkeys(document.root.strings("extensionsUsed")):
        if name not in honoured and name not in WITHOUT_EFFECT:
            notes.say(f"extension {one_line(name, 60)} not honoured")


def note_unread(document: Document, notes: Notes) -> None:
    """Note the animations and skins of the file."""
    notes.count("animation", "animations", "not shown", len(document.entries("animations")))
    notes.count("skin", "skins", "not applied: shown as modelled", len(document.entries("skins")))
