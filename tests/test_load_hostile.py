"""Files that are broken or mean harm: one class of error or success, nothing outside the folder, no memory unpaid."""

from __future__ import annotations

import json
import os
import random
import struct
import tracemalloc
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from gltf_files import SQUARE, TRIANGLE, GltfFile, glb, png
from hypothesis import given, settings
from hypothesis import strategies as st
from mutations import mutated_bytes, mutated_json, mutated_text

from dofview.errors import ModelError
from dofview.scene import gltf
from dofview.scene.info import describe
from dofview.scene.limits import Limits
from dofview.scene.load import PAUSES, load
from dofview.scene.model import Scene
from dofview.scene.notes import one_line

WHITE = np.full((4, 4, 3), 255, np.uint8)
NOISE = np.random.default_rng(4).integers(0, 256, (32, 32, 3), np.uint8)
OBJ = b"""mtllib m.mtl
v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0 0 0 1\nv 0 1 0 1 1 1\nv 0.2 0.5 0\nvt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1
usemtl a\ns 1\nf 1/1/1 2/2/1 3/3/1\nusemtl b\ns off\nf -5//1 -4//1 -3//1 -2//1\nf 1 2 3 4 5\nl 1 2
"""


def rich() -> GltfFile:
    """A file that uses most of what the reader reads."""
    file = GltfFile()
    texture = {"index": file.add_texture(WHITE, {"wrapS": 33071, "minFilter": 9987}), "texCoord": 1}
    texture["extensions"] = {"KHR_texture_transform": {"offset": [0, 1], "rotation": 1, "scale": [2, 2]}}
    material = {"pbrMetallicRoughness": {"baseColorTexture": texture, "baseColorFactor": [1, 1, 1, 1]}, "name": "m"}
    extensions = {"KHR_materials_emissive_strength": {"emissiveStrength": 2}}
    file.append("materials", {**material, "emissiveFactor": [1, 0, 0], "alphaMode": "MASK", "extensions": extensions})
    uv = SQUARE[:, :2].copy()
    indices = np.uint16([0, 1, 2, 0, 2, 3])
    primitive = file.add_primitive(indices, POSITION=SQUARE, TEXCOORD_0=uv, TEXCOORD_1=uv, COLOR_0=SQUARE + 0.5)
    primitive |= {"material": 0, "mode": 4, "targets": [{"POSITION": primitive["attributes"]["POSITION"]}]}
    child = file.add_mesh(primitive, translation=[0, 1, 0], rotation=[0, 0, 0, 1], scale=[1, 2, 1])
    file.json["meshes"][0]["weights"] = [0.5]
    sparse_indices = {"bufferView": file.add_view(bytes([1])), "componentType": 5121}
    sparse = {"count": 1, "indices": sparse_indices, "values": {"bufferView": file.add_view(TRIANGLE[:1].tobytes())}}
    accessor = file.add_accessor(TRIANGLE, sparse=sparse)
    file.add_mesh(file.add_primitive(POSITION=accessor, NORMAL=TRIANGLE + 1), matrix=np.eye(4).ravel().tolist())
    lens = {"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}
    file.append("nodes", {"camera": file.append("cameras", lens), "children": [child]})
    file.json["scenes"][0]["nodes"] = [2, 1]
    return file


def check_scene(scene: Scene) -> None:
    """Everything the scene model promises: finite numbers, indices in range, arrays of the right shape."""
    json.dumps(describe(scene), allow_nan=False).encode()
    for primitive in scene.primitives:
        count = len(primitive.positions)
        assert count > 0 and primitive.triangles.dtype == np.uint32 and primitive.triangles.shape[1:] == (3,)
        assert int(primitive.triangles.max()) < count
        parts = {3: [primitive.positions, primitive.normals], 2: primitive.texcoords, 4: [primitive.colors]}
        for width, arrays in parts.items():
            for array in arrays:
                if array is not None:
                    assert array.shape == (count, width) and array.dtype == np.float32 and np.isfinite(array).all()
        np.testing.assert_allclose(np.linalg.norm(primitive.normals, axis=1), 1, atol=1e-4)
        assert 0 <= primitive.material < len(scene.materials)
    assert all(np.isfinite(i.matrix).all() and i.primitive < len(scene.primitives) for i in scene.instances)
    assert np.isfinite(scene.bounds).all()


def load_or_refuse(path: Path, limits: Limits | None = None) -> Scene | None:
    """Load, check what came out, and hold the one promise about failures: ModelError, in one printable line."""
    try:
        scene = load(path, limits)
    except ModelError as error:
        text = str(error)
        assert one_line(path, 100)[:99] in text and "\n" not in text
        text.encode()
        return None
    check_scene(scene)
    return scene


def write(path: Path, change: dict[str, Any] | None = None, file: GltfFile | None = None) -> Path:
    """Write the rich file, or `file`, with some top-level values replaced."""
    file = file or rich()
    file.json |= change or {}
    return file.write(path)


def test_the_files_that_are_broken_below_are_sound(tmp_path: Path) -> None:
    scene = load_or_refuse(write(tmp_path / "a.glb"))
    assert scene is not None and scene.triangle_count == 3 and len(scene.cameras) == 1
    (tmp_path / "a.obj").write_bytes(OBJ)
    scene = load_or_refuse(tmp_path / "a.obj")
    assert scene is not None and scene.triangle_count == 6


def outside_names(tmp_path: Path) -> dict[str, str]:
    inside, secret = tmp_path / "models", tmp_path / "secret.bin"
    inside.mkdir()
    secret.write_bytes(TRIANGLE.tobytes() * 100)
    (inside / "link.bin").symlink_to(secret)
    (inside / "way").symlink_to(tmp_path)
    (inside / "folder.bin").mkdir()
    os.mkfifo(inside / "pipe.bin")
    return {
        "parent": "../secret.bin",
        "encoded": "%2e%2e%2fsecret.bin",
        "backslash": "..\\secret.bin",
        "absolute": str(secret),
        "file scheme": f"file://{secret}",
        "http": "http://127.0.0.1:9/x.bin",
        "drive": "C:/secret.bin",
        "symbolic link": "link.bin",
        "linked folder": "way/secret.bin",
        "folder": "folder.bin",
        "pipe": "pipe.bin",
        "device": "/dev/zero",
        "missing": "none.bin",
        "empty": "",
        "NUL": "a%00b",
        "long": "x" * 5000,
        "deep": "x/" * 3000,
        "surrogate": "\ud800.bin",
        "not UTF-8": "%ff.bin",
    }


def test_nothing_outside_the_folder_is_read(tmp_path: Path) -> None:
    for what, name in outside_names(tmp_path).items():
        path = tmp_path / "models" / "a.gltf"
        file = rich()
        path.write_bytes(file.document(name))
        assert load_or_refuse(path) is None, what
        (tmp_path / "models" / "m.mtl").write_text("newmtl a\nmap_Kd " + name.replace("\ud800", "?") + "\n")
        obj = tmp_path / "models" / "a.obj"
        obj.write_bytes(OBJ + b"mtllib " + name.encode("utf-8", "replace"))
        scene = load_or_refuse(obj)
        assert scene is not None and scene.materials[0].base_color_texture is None, what


def test_a_picture_that_may_not_be_read_is_a_warning(tmp_path: Path) -> None:
    for what, name in outside_names(tmp_path).items():
        path = write(tmp_path / "models" / "a.glb", {"images": [{"uri": name}]})
        scene = load_or_refuse(path)
        assert scene is not None and scene.materials[0].base_color_texture is None, what
        assert any(text.startswith("images[0]") for text in scene.warnings), what


def test_a_link_that_stays_inside_the_folder_is_followed(tmp_path: Path) -> None:
    path = write(tmp_path / "a.gltf")
    (tmp_path / "a.bin").rename(tmp_path / "b.bin")
    (tmp_path / "a.bin").symlink_to("b.bin")
    assert load_or_refuse(path) is not None


@pytest.mark.parametrize("kind", ["missing", "folder", "pipe", "device", "long", "NUL", "format", "empty"])
def test_model_paths_that_are_no_models(tmp_path: Path, kind: str) -> None:
    path = tmp_path / "a.gltf"
    if kind == "folder":
        path.mkdir()
    elif kind == "pipe":
        os.mkfifo(path)
    elif kind == "format":
        path = tmp_path / "a.stl"
        path.write_bytes(b"solid")
    elif kind == "empty":
        path.write_bytes(b"")
    path = {"device": Path("/dev/zero"), "long": tmp_path / ("x" * 3000), "NUL": tmp_path / "a\0b"}.get(kind, path)
    assert load_or_refuse(path) is None


def test_unknown_demo_scenes_are_refused() -> None:
    with pytest.raises(ModelError, match="accepted"):
        load("demo:nothing")


@pytest.mark.parametrize(
    "text",
    [
        b"[" * 100_000,
        b'{"asset":' * 50_000,
        b'{"asset": {"version": "2.0"}, "scene": ' + b"9" * 10_000 + b"}",
        b'{"asset": {"version": "2.0"}, "scene": NaN, "scenes": [{}]}',
        b'{"asset": {"version": "2.0"}, "scene": 1e999, "scenes": [{}]}',
        b'{"asset": {"version": "1.0"}}',
        b'{"asset": {"version": "2.0", "minVersion": "2.1"}}',
        b'{"name": "a package", "version": "2.0"}',
        b"\xff\xfe{\x00}\x00",
        b"null",
        b'"text"',
    ],
    ids=range(11),
)
def test_json_that_is_no_gltf(tmp_path: Path, text: bytes) -> None:
    for name, data in (("a.gltf", text), ("a.glb", glb(text, b""))):
        (tmp_path / name).write_bytes(data)
        assert load_or_refuse(tmp_path / name) is None


@pytest.mark.parametrize("index", [-1, 2**31, 1e999, 0.5, "0", True, [], {}])
@pytest.mark.parametrize(
    "place",
    [
        ("scene",),
        ("scenes", 0, "nodes", 0),
        ("nodes", 0, "mesh"),
        ("nodes", 2, "camera"),
        ("nodes", 2, "children", 0),
        ("meshes", 0, "primitives", 0, "material"),
        ("meshes", 0, "primitives", 0, "indices"),
        ("meshes", 0, "primitives", 0, "attributes", "POSITION"),
        ("meshes", 0, "primitives", 0, "mode"),
        ("accessors", 0, "bufferView"),
        ("accessors", 0, "componentType"),
        ("accessors", 0, "count"),
        ("bufferViews", 1, "buffer"),
        ("bufferViews", 1, "byteLength"),
        ("textures", 0, "source"),
        ("textures", 0, "sampler"),
        ("materials", 0, "pbrMetallicRoughness", "baseColorTexture", "index"),
    ],
    ids=lambda place: ".".join(map(str, place)),
)
def test_indices_are_integers_in_range(tmp_path: Path, place: tuple, index: Any) -> None:
    file = rich()
    holder: Any = file.json
    for key in place[:-1]:
        holder = holder[key]
    holder[place[-1]] = index
    path = tmp_path / "a.glb"
    path.write_bytes(glb(json.dumps(file.json | {"buffers": [{"byteLength": len(file.binary)}]}).encode(), file.binary))
    assert load_or_refuse(path) is None


HUGE = 2**31 - 1


@pytest.mark.parametrize(
    "accessor",
    [
        {"count": HUGE},
        {"bufferView": 0, "count": HUGE},
        {"bufferView": 0, "count": 3, "byteOffset": HUGE},
        {"bufferView": 0, "count": 4},
        {"bufferView": 1, "count": 3},
        {"bufferView": 2, "count": 3},
        {"bufferView": 3, "count": 3},
        {"bufferView": 0, "count": 3, "sparse": {"count": HUGE}},
        {"bufferView": 0, "count": 3, "sparse": {"count": HUGE, "indices": {"bufferView": 0}, "values": {}}},
        {
            "count": HUGE,
            "sparse": {
                "count": 1,
                "indices": {"bufferView": 0, "componentType": 5121},
                "values": {"bufferView": 0},
            },
        },
        {
            "bufferView": 0,
            "count": 3,
            "sparse": {
                "count": 1,
                "indices": {"bufferView": 0, "componentType": 5121, "byteOffset": 15},
                "values": {"bufferView": 0},
            },
        },
    ],
    ids=range(11),
)
def test_counts_without_bytes_allocate_nothing(tmp_path: Path, accessor: dict[str, Any]) -> None:
    file = GltfFile()
    file.add_view(TRIANGLE.tobytes())
    file.append("bufferViews", {"buffer": 0, "byteLength": HUGE})
    file.append("bufferViews", {"buffer": 0, "byteOffset": HUGE, "byteLength": 36})
    file.append("bufferViews", {"buffer": 0, "byteLength": 36, "byteStride": 4})
    file.append("accessors", {"componentType": 5126, "type": "VEC3", **accessor})
    file.add_mesh({"attributes": {"POSITION": 0}})
    path = file.write(tmp_path / "a.glb")
    tracemalloc.start()
    assert load_or_refuse(path) is None
    assert tracemalloc.get_traced_memory()[1] < 5_000_000
    tracemalloc.stop()


def test_overlapping_accessors_cannot_multiply_a_file(tmp_path: Path) -> None:
    """300 kB of indices read by 400 primitives at as many offsets would become a gigabyte of flat triangles."""
    file = GltfFile()
    position = file.add_accessor(np.random.default_rng(1).random((255, 3), np.float32))
    view = file.add_view(np.random.default_rng(2).integers(0, 255, 300_000).astype(np.uint8).tobytes())
    accessor = {"bufferView": view, "componentType": 5121, "type": "SCALAR", "count": 45_000}
    for offset in range(400):
        indices = file.append("accessors", {**accessor, "byteOffset": offset})
        file.add_mesh({"attributes": {"POSITION": position}, "indices": indices})
    with pytest.raises(ModelError, match="limit growth"):
        load(file.write(tmp_path / "a.glb"))


@pytest.mark.parametrize("what", ["triangles", "draws", "buffer_bytes"])
def test_limits_refuse_and_can_be_raised(tmp_path: Path, what: str) -> None:
    path = write(tmp_path / "a.glb")
    tight = Limits(**{what: 1})
    with pytest.raises(ModelError, match=f"limit {what}"):
        load(path, tight)
    (tmp_path / "a.obj").write_bytes(OBJ)
    with pytest.raises(ModelError, match=f"limit {what}"):
        load(tmp_path / "a.obj", tight)
    assert load(path).triangle_count == 3


def png_header(width: int, height: int) -> bytes:
    """A PNG that claims a size and holds almost nothing."""

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(b"")) + chunk(b"IEND", b"")


@pytest.mark.parametrize(
    ("picture", "reason"),
    [
        (png_header(50_000, 50_000), "accepted: up to 67108864 (limit picture_pixels)"),
        (png(NOISE)[:500], "not a readable picture"),
        (png(WHITE).replace(b"IDAT", b"IDAX"), "not a readable picture"),
        (b"GIF89a\1\0\1\0\0\0\0;", "accepted: PNG, JPEG, WebP, BMP or TGA"),
        (b"%!PS-Adobe-3.0 EPSF-3.0\n%%BoundingBox: 0 0 9 9\n", "accepted: PNG, JPEG, WebP, BMP or TGA"),
        (b"\xff\xd8\xff\xe0" + b"\0" * 40, "not a readable picture"),
        (b"RIFF\x20\0\0\0WEBPVP8 " + b"\0" * 30, "not a readable picture"),
        (b"BM" + b"\xff" * 60, "not a readable picture"),
        (b"", "accepted: PNG, JPEG, WebP, BMP or TGA"),
    ],
    ids=["huge", "cut", "no data", "GIF", "EPS", "JPEG", "WebP", "BMP", "empty"],
)
def test_bad_pictures_leave_a_plain_material(tmp_path: Path, picture: bytes, reason: str) -> None:
    file = rich()
    file.json["images"] = [{"bufferView": file.add_view(picture)}]
    scene = load_or_refuse(file.write(tmp_path / "a.glb"))
    assert scene is not None and scene.materials[0].base_color_texture is None
    (warning,) = (text for text in scene.warnings if text.startswith("images[0]"))
    assert reason in warning


def test_all_pictures_together_are_limited_and_failing_ones_count(tmp_path: Path) -> None:
    file = rich()
    broken = file.add_view(png_header(9, 9))
    file.json["images"] = [{"bufferView": broken} for _ in range(3)]
    file.json["textures"] = [{"source": i} for i in range(3)]
    file.json["materials"][0]["normalTexture"] = {"index": 1}
    file.json["materials"][0]["emissiveTexture"] = {"index": 2}
    scene = load_or_refuse(file.write(tmp_path / "a.glb"), Limits(total_pixels=170))
    assert scene is not None
    assert sum("limit total_pixels" in text for text in scene.warnings) == 1


def test_names_are_made_fit_to_be_shown(tmp_path: Path) -> None:
    name = "a\x1b[31mred\n\u202e\ud800" + "x" * 500
    file = rich()
    file.json["materials"][0]["name"] = name
    file.json["cameras"][0]["name"] = name
    scene = load_or_refuse(file.write(tmp_path / "a.glb"))
    assert scene is not None
    for shown in (scene.materials[0].name, scene.cameras[0].name):
        assert shown.startswith("a\ufffd[31mred \ufffd\ufffdxxx") and len(shown) == 100


def test_a_file_that_changes_while_it_is_read_is_read_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = write(tmp_path / "a.gltf")
    read, changes = gltf.read, [len(PAUSES)]

    def changing(*args: Any) -> Scene:
        scene = read(*args)
        if changes[0]:
            changes[0] -= 1
            (tmp_path / "a.bin").write_bytes((tmp_path / "a.bin").read_bytes() + b"\0")
        return scene

    monkeypatch.setattr(gltf, "read", changing)
    with pytest.raises(ModelError, match="changed while it was read"):
        load(path)
    changes[0] = len(PAUSES) - 1
    assert load(path).triangle_count == 3


def test_a_glb_cut_anywhere(tmp_path: Path) -> None:
    data = rich().glb()
    path = tmp_path / "a.glb"
    for length in [*range(40), *range(40, len(data), 37)]:
        path.write_bytes(data[:length])
        assert load_or_refuse(path) is None


FOLDER_FILES = {"m.mtl": b"newmtl a\nKd 1 0 0\nmap_Kd t.png\nnewmtl b\nd 0.5\nNs 10\n", "t.png": png(WHITE)}
seeds = st.integers(0, 2**32)
quick = settings(max_examples=150, deadline=None, derandomize=True)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("mutated")
    for name, data in FOLDER_FILES.items():
        (path / name).write_bytes(data)
    return path


@quick
@given(seed=seeds)
def test_mutated_glb(folder: Path, seed: int) -> None:
    (folder / "a.glb").write_bytes(mutated_bytes(rich().glb(), random.Random(seed)))
    load_or_refuse(folder / "a.glb")


@quick
@given(seed=seeds)
def test_mutated_gltf_json(folder: Path, seed: int) -> None:
    document = json.loads(rich().gltf())
    (folder / "a.gltf").write_bytes(mutated_json(document, random.Random(seed)))
    load_or_refuse(folder / "a.gltf")


@quick
@given(seed=seeds)
def test_mutated_obj_and_mtl(folder: Path, seed: int) -> None:
    rng = random.Random(seed)
    change = rng.choice((mutated_text, mutated_bytes))
    (folder / "a.obj").write_bytes(change(OBJ, rng))
    (folder / "m.mtl").write_bytes(change(FOLDER_FILES["m.mtl"], rng))
    load_or_refuse(folder / "a.obj")


@quick
@given(seed=seeds)
def test_mutated_pictures(folder: Path, seed: int) -> None:
    rng = random.Random(seed)
    file = rich()
    noise = np.frombuffer(rng.randbytes(16 * 16 * 3), np.uint8).reshape(16, 16, 3)
    file.json["images"] = [{"bufferView": file.add_view(mutated_bytes(png(noise), rng))}]
    file.write(folder / "p.glb")
    assert load_or_refuse(folder / "p.glb") is not None
