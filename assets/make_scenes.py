"""Make the scene files in assets/scenes: four demo scenes as .glb, one chess scene as .obj, and the view files of all.

    python assets/make_scenes.py [FOLDER]

Everything in that folder is made here, by this script, out of `dofview.scene.demo`; nothing comes from elsewhere. The
.glb files hold the demo scenes cut into about 10,000 triangles, with their pictures at half size and in 64 colours, so
that a checkout stays small. `dofview demo:NAME` shows the scene as it is meant.
"""

from __future__ import annotations

import io
import json
import struct
import sys
from pathlib import Path

import numpy as np
from PIL import Image

from dofview.scene import demo
from dofview.scene.camera import Camera
from dofview.scene.demo import patterns as paint
from dofview.scene.demo.parts import Part, assemble, painted
from dofview.scene.demo.shapes import box, lathe, place, sheet
from dofview.scene.demo.studies import PAWN
from dofview.scene.model import Material, Picture, Scene

FOLDER = Path(__file__).resolve().parent / "scenes"
GLB_SCENES = ("foreground", "background", "rail", "highlights")
GLB_TRIANGLES = "@10k"
FLOAT, UNSIGNED_BYTE, UNSIGNED_SHORT, UNSIGNED_INT = 5126, 5121, 5123, 5125
CHESS_VIEW = {
    "camera": {
        "position": [0.0, 2.1, 4.6], "target": [0.0, 0.55, 0.0], "up": [0.0, 1.0, 0.0],
        "vfov_deg": 32.0, "near": 2.0, "far": 16.0,
    },
    "lens": {"radius": 0.09, "focus_distance": 4.35, "distribution": "uniform_disc"},
    "image": {"size": [512, 384]},
    "background_linear": [0.12, 0.11, 0.1],
}  # fmt: skip
KING = (
    (0.0, 0.0), (0.4, 0.0), (0.42, 0.07), (0.3, 0.18), (0.2, 0.34), (0.14, 0.8), (0.13, 1.15), (0.26, 1.22),
    (0.14, 1.28), (0.24, 1.56), (0.26, 1.6), (0.1, 1.66), (0.09, 1.78), (0.055, 1.83), (0.0, 1.84),
)  # fmt: skip


def small(picture: Picture, half: bool = True) -> bytes:
    """PNG of a picture at half its size, averaged as stored, in 64 colours."""
    pixels = picture.pixels[..., :3].astype(np.float64)
    if half:
        height, width = pixels.shape[:2]
        pixels = pixels.reshape(height // 2, 2, width // 2, 2, 3).mean(axis=(1, 3))
    image = Image.fromarray(np.round(pixels).astype(np.uint8))
    stored = io.BytesIO()
    palette = image.quantize(64, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE)
    palette.save(stored, "PNG", optimize=True)
    return stored.getvalue()


class Glb:
    """A binary glTF file in the making: the JSON document and the bytes that it points into."""

    def __init__(self, scene: Scene):
        self.blob = bytearray()
        self.document: dict = {
            "asset": {"version": "2.0", "generator": "dofview assets/make_scenes.py"},
            "scene": 0, "scenes": [{"name": scene.name.partition("@")[0], "nodes": []}], "nodes": [], "meshes": [],
            "materials": [], "accessors": [], "bufferViews": [], "cameras": [],
            "samplers": [{"magFilter": 9729, "minFilter": 9987, "wrapS": 10497, "wrapT": 10497}],
            "textures": [], "images": [],
        }  # fmt: skip
        self._pictures: dict[int, int] = {}
        for material in scene.materials:
            self.document["materials"].append(self._material(material))
        for instance in scene.instances:
            self._mesh(scene, instance.primitive)
        for camera in scene.cameras:
            self.document["cameras"].append({"name": camera.name, "type": "perspective", "perspective": {
                "yfov": float(np.radians(camera.vfov_deg)), "znear": camera.near, "zfar": camera.far}})  # fmt: skip
            self._node({"name": camera.name, "camera": 0, "matrix": camera.matrix.T.ravel().tolist()})

    def _node(self, node: dict) -> None:
        self.document["scenes"][0]["nodes"].append(len(self.document["nodes"]))
        self.document["nodes"].append(node)

    def _view(self, data: bytes, target: int | None = None) -> int:
        self.blob += b"\0" * (-len(self.blob) % 4)
        view = {"buffer": 0, "byteOffset": len(self.blob), "byteLength": len(data)}
        self.document["bufferViews"].append(view | ({"target": target} if target else {}))
        self.blob += data
        return len(self.document["bufferViews"]) - 1

    def _accessor(self, array: np.ndarray, component: int, kind: str, target: int = 34962, **more: object) -> int:
        view = self._view(np.ascontiguousarray(array).tobytes(), target)
        accessor = {"bufferView": view, "componentType": component, "count": len(array), "type": kind, **more}
        self.document["accessors"].append(accessor)
        return len(self.document["accessors"]) - 1

    def _mesh(self, scene: Scene, index: int) -> None:
        primitive = scene.primitives[index]
        low, high = primitive.positions.min(axis=0).tolist(), primitive.positions.max(axis=0).tolist()
        attributes = {
            "POSITION": self._accessor(primitive.positions, FLOAT, "VEC3", min=low, max=high),
            "NORMAL": self._accessor(primitive.normals, FLOAT, "VEC3"),
            "TEXCOORD_0": self._accessor(primitive.texcoords[0], FLOAT, "VEC2"),
        }
        if primitive.colors is not None:
            colors = np.round(primitive.colors * 255).astype(np.uint8)
            attributes["COLOR_0"] = self._accessor(colors, UNSIGNED_BYTE, "VEC4", normalized=True)
        wide = len(primitive.positions) > 65535
        indices = primitive.triangles.ravel().astype(np.uint32 if wide else np.uint16)
        made = {
            "attributes": attributes, "material": primitive.material,
            "indices": self._accessor(indices, UNSIGNED_INT if wide else UNSIGNED_SHORT, "SCALAR", 34963),
        }  # fmt: skip
        self._node({"name": primitive.name, "mesh": len(self.document["meshes"])})
        self.document["meshes"].append({"name": primitive.name, "primitives": [made]})

    def _texture(self, picture: Picture) -> dict:
        if id(picture) not in self._pictures:
            self._pictures[id(picture)] = len(self.document["textures"])
            image = {"name": picture.name, "mimeType": "image/png", "bufferView": self._view(small(picture))}
            self.document["textures"].append({"sampler": 0, "source": len(self.document["images"])})
            self.document["images"].append(image)
        return {"index": self._pictures[id(picture)]}

    def _material(self, material: Material) -> dict:
        surface = {
            "baseColorFactor": list(material.base_color),
            "metallicFactor": material.metallic, "roughnessFactor": material.roughness,
        }  # fmt: skip
        if material.base_color_texture:
            surface["baseColorTexture"] = self._texture(material.base_color_texture.picture)
        made: dict = {"name": material.name, "pbrMetallicRoughness": surface}
        extensions: dict = {"KHR_materials_unlit": {}} if material.unlit else {}
        strength = max(material.emissive)
        if strength > 0:
            made["emissiveFactor"] = [value / max(strength, 1.0) for value in material.emissive]
            if material.emissive_texture:
                made["emissiveTexture"] = self._texture(material.emissive_texture.picture)
        if strength > 1:
            extensions["KHR_materials_emissive_strength"] = {"emissiveStrength": strength}
        if extensions:
            made["extensions"] = extensions
            self.document["extensionsUsed"] = sorted({*self.document.get("extensionsUsed", ()), *extensions})
        return made

    def bytes(self) -> bytes:
        """The finished file: header, JSON chunk, binary chunk."""
        self.document["buffers"] = [{"byteLength": len(self.blob)}]
        text = json.dumps(self.document, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        binary = bytes(self.blob) + b"\0" * (-len(self.blob) % 4)
        header = struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(binary))
        return (
            header
            + struct.pack("<I4s", len(text), b"JSON")
            + text
            + struct.pack("<I4s", len(binary), b"BIN\0")
            + binary
        )


def chess() -> Scene:
    """Pawns and a king on a board, for the OBJ file."""
    board = painted("board", paint.checker(181, ("d8c199", "4a2e1c"), 8), 0.7)
    frame = painted("frame", paint.wood(182, ("2f1a0e", "55311a", "7a4b29"), 1, 256), 0.6)
    cloth = painted("cloth", paint.kilim(185, ("26404f", "c9b98f", "5d2a24", "3a5a58"), 8), 0.9)
    light = painted("boxwood", paint.wood(183, ("b98d52", "d3aa6c", "e7c78d"), 1, 256), 0.4)
    dark = painted("ebony", paint.wood(184, ("24140d", "3d2216", "573322"), 1, 256), 0.4)
    pawn, king = lathe(PAWN, (13, 16), (2, 1)), lathe(KING, (13, 22), (2, 1))
    pale = [(-1.25, 0.25), (-0.25, 1.25), (1.75, 0.25), (-1.75, -2.75)]
    black = [(0.75, -0.75), (-0.75, -1.75), (1.25, -2.75)]
    white = sum((place(pawn, (x, 0, z), scale=0.85) for x, z in pale), ()) + place(king, (0.25, 0, 0.25), scale=0.8)
    other = sum((place(pawn, (x, 0, z), scale=0.85) for x, z in black), ()) + place(king, (-2.25, 0, -3.25), scale=0.8)
    parts = [
        Part(sheet((-4, 0, 2.5), (8, 0, 0), (0, 0, -8), (8, 8), 4.0), board),
        Part(place(box((8.6, 0.2, 8.6), 0.0, 1, 4.0), (0, -0.11, -1.5)), frame),
        Part(sheet((-12, -0.2, 6), (24, 0, 0), (0, 0, -16), (8, 8), 3.0), cloth),
        Part(sheet((-12, -0.2, -10), (24, 0, 0), (0, 8, 0), (8, 4), 4.0), cloth),
        Part(white, light),
        Part(other, dark),
    ]
    return assemble("chess", parts, Camera(**CHESS_VIEW["camera"]))


def write_obj(scene: Scene, folder: Path) -> None:
    """Write `scene` as NAME.obj, NAME.mtl and a PNG for each material, every line of coordinates once."""
    lines, faces, library = [f"mtllib {scene.name}.mtl"], [], []
    numbers: dict[str, dict[str, int]] = {"v": {}, "vt": {}, "vn": {}}

    def number(kind: str, row: np.ndarray, digits: int) -> int:
        line = " ".join([kind, *(f"{value:.{digits}f}" for value in row + 0.0)])
        return numbers[kind].setdefault(line, len(numbers[kind]) + 1)

    for primitive in scene.primitives:
        material = scene.materials[primitive.material]
        faces += [f"g {primitive.name}", f"usemtl {material.name}"]
        texcoords = primitive.texcoords[0] * (1, -1) + (0, 1)
        rows = zip(primitive.positions, texcoords, primitive.normals, strict=True)
        corners = [f"{number('v', v, 4)}/{number('vt', t, 4)}/{number('vn', n, 3)}" for v, t, n in rows]
        faces += ["f " + " ".join(corners[i] for i in triangle) for triangle in primitive.triangles]
        picture = f"{scene.name}-{material.name}.png"
        (folder / picture).write_bytes(small(material.base_color_texture.picture))
        library += [f"newmtl {material.name}", "Kd 1 1 1", f"map_Kd {picture}", f"Pr {material.roughness}", "Pm 0", ""]
    lines += [line for kind in numbers.values() for line in kind] + faces
    (folder / f"{scene.name}.obj").write_text("\n".join(lines) + "\n", newline="\n")
    (folder / f"{scene.name}.mtl").write_text("\n".join(library), newline="\n")


def main(folder: Path) -> None:
    """Write every file."""
    folder.mkdir(parents=True, exist_ok=True)
    for name in GLB_SCENES:
        (folder / f"{name}.glb").write_bytes(Glb(demo.build(name + GLB_TRIANGLES)).bytes())
    write_obj(chess(), folder)
    for name, view in {**{name: demo.view(name) for name in demo.DEMOS}, "chess": CHESS_VIEW}.items():
        (folder / f"{name}.json").write_text(json.dumps(view, indent=2) + "\n", newline="\n")
    for path in sorted(folder.iterdir()):
        print(f"{path.stat().st_size:>9,}  {path.name}")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else FOLDER)
