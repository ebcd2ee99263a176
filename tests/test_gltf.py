"""What our glTF reader makes of valid files, feature by feature."""

from __future__ import annotations

import io
import math
from pathlib import Path

import numpy as np
import pytest
from gltf_files import SQUARE, TRIANGLE, GltfFile, glb
from PIL import Image

from dofview.errors import ModelError
from dofview.scene.gltf import draco
from dofview.scene.load import load
from dofview.scene.model import Primitive, Scene

PIXELS = np.arange(4 * 2 * 4, dtype=np.uint8).reshape(2, 4, 4)


@pytest.fixture
def loaded(tmp_path: Path):
    """Write a file as .glb and load it."""

    def load_file(file: GltfFile) -> Scene:
        return load(file.write(tmp_path / "file.glb"))

    return load_file


def corners(primitive: Primitive) -> np.ndarray:
    """(m, 3, 3): the positions of every triangle's corners."""
    return primitive.positions[primitive.triangles]


def simple(**attributes: np.ndarray) -> GltfFile:
    file = GltfFile()
    file.add_mesh(file.add_primitive(POSITION=TRIANGLE, **attributes))
    return file


@pytest.mark.parametrize("form", ["external", "embedded", "binary", "spaces"])
def test_the_same_scene_from_every_container(tmp_path: Path, form: str) -> None:
    file = simple(NORMAL=np.tile(np.float32([0, 0, 1]), (3, 1)))
    path = tmp_path / {"binary": "a.glb", "spaces": "a b.gltf"}.get(form, "a.gltf")
    if form == "embedded":
        path.write_bytes(file.gltf())
    else:
        file.write(path)
    scene = load(path)
    assert scene.triangle_count == scene.mesh_triangles == 1 and scene.warnings == ()
    np.testing.assert_array_equal(corners(scene.primitives[0])[0], TRIANGLE)
    assert scene.source == str(path) and scene.name == path.stem


def test_glb_is_recognised_by_content(tmp_path: Path) -> None:
    path = tmp_path / "model.dat"
    path.write_bytes(simple().glb())
    assert load(path).triangle_count == 1


@pytest.mark.parametrize("dtype", ["uint8", "uint16", "uint32"])
def test_indices_of_every_type(loaded, dtype: str) -> None:
    file = GltfFile()
    file.add_mesh(file.add_primitive(np.array([2, 1, 0, 0, 2, 3], dtype), POSITION=SQUARE))
    np.testing.assert_array_equal(corners(loaded(file).primitives[0]), SQUARE[[[2, 1, 0], [0, 2, 3]]])


# Triangles of the modes, from glTF 2.0 §3.7.2.1, over five vertices.
MODES = {
    4: [[0, 1, 2]],
    5: [[0, 1, 2], [1, 3, 2], [2, 3, 4]],
    6: [[1, 2, 0], [2, 3, 0], [3, 4, 0]],
}


@pytest.mark.parametrize("indexed", [False, True])
@pytest.mark.parametrize("mode", MODES)
def test_modes_that_make_triangles(loaded, mode: int, indexed: bool) -> None:
    rng = np.random.default_rng(1)
    positions = rng.random((5, 3), np.float32)
    file = GltfFile()
    order = np.arange(5, dtype=np.uint16)
    primitive = file.add_primitive(order if indexed else None, POSITION=positions)
    file.add_mesh(primitive | {"mode": mode})
    scene = loaded(file)
    np.testing.assert_array_equal(corners(scene.primitives[0]), positions[MODES[mode]])
    assert scene.mesh_triangles == len(MODES[mode])


def test_lines_and_points_are_listed(loaded) -> None:
    file = GltfFile()
    primitive = file.add_primitive(POSITION=TRIANGLE)
    file.add_mesh(*({**primitive, "mode": mode} for mode in (0, 1, 1, 2, 3)))
    scene = loaded(file)
    assert scene.triangle_count == 0
    assert set(scene.warnings) == {
        "1 point primitive not shown",
        "2 line primitives not shown",
        "1 line loop primitive not shown",
        "1 line strip primitive not shown",
    }


NORMALISED = {"uint8": ([0, 51, 255], [0, 0.2, 1]), "uint16": ([0, 13107, 65535], [0, 0.2, 1])}


@pytest.mark.parametrize("dtype", NORMALISED)
def test_normalised_texture_coordinates(loaded, dtype: str) -> None:
    stored, expected = NORMALISED[dtype]
    file = GltfFile()
    padded = np.array([[v, v, 0, 0] for v in stored], dtype)
    view = file.add_view(padded.tobytes(), byteStride=padded.strides[0])
    accessor = {"bufferView": view, "componentType": 5121 if dtype == "uint8" else 5123, "count": 3, "type": "VEC2"}
    uv = file.append("accessors", {**accessor, "normalized": True})
    file.add_mesh(file.add_primitive(POSITION=TRIANGLE, TEXCOORD_0=uv))
    np.testing.assert_allclose(loaded(file).primitives[0].texcoords[0][:, 0], expected, atol=1e-6)


def test_quantised_positions(loaded) -> None:
    """KHR_mesh_quantization: plain integers keep their value, signed normalised ones reach −1 twice."""
    file = GltfFile()
    file.json["extensionsRequired"] = file.json["extensionsUsed"] = ["KHR_mesh_quantization"]
    values = np.array([[-128, 127, 0, 0], [0, 5, 1, 0], [-127, 1, 2, 0]], np.int8)
    view = file.add_view(values.tobytes(), byteStride=4)
    plain = {"bufferView": view, "componentType": 5120, "count": 3, "type": "VEC3"}
    for normalized in (False, True):
        index = file.append("accessors", {**plain, "normalized": normalized})
        file.add_mesh(file.add_primitive(POSITION=index))
    first, second = loaded(file).primitives
    np.testing.assert_array_equal(corners(first)[0], values[:, :3])
    np.testing.assert_allclose(corners(second)[0], np.maximum(values[:, :3] / 127, -1), atol=1e-6)


def test_interleaved_attributes(loaded) -> None:
    file = GltfFile()
    rows = np.concatenate([TRIANGLE, np.tile(np.float32([0, 1, 0]), (3, 1)), TRIANGLE[:, :2]], axis=1)
    view = file.add_view(np.ascontiguousarray(rows).tobytes(), byteStride=32)
    base = {"bufferView": view, "componentType": 5126, "count": 3}
    attributes = {
        name: file.append("accessors", {**base, "type": kind, "byteOffset": offset})
        for name, kind, offset in (("POSITION", "VEC3", 0), ("NORMAL", "VEC3", 12), ("TEXCOORD_0", "VEC2", 24))
    }
    file.add_mesh({"attributes": attributes})
    primitive = loaded(file).primitives[0]
    np.testing.assert_array_equal(primitive.positions, TRIANGLE)
    np.testing.assert_array_equal(primitive.normals, np.tile([0, 1, 0], (3, 1)))
    np.testing.assert_array_equal(primitive.texcoords[0], TRIANGLE[:, :2])


@pytest.mark.parametrize("with_base", [True, False])
def test_sparse_accessors(loaded, with_base: bool) -> None:
    file = GltfFile()
    sparse = {
        "count": 2,
        "indices": {"bufferView": file.add_view(np.uint16([1, 2]).tobytes()), "componentType": 5123},
        "values": {"bufferView": file.add_view(np.float32([[7, 7, 7], [8, 9, 8]]).tobytes())},
    }
    accessor = {"componentType": 5126, "count": 3, "type": "VEC3", "sparse": sparse}
    if with_base:
        accessor["bufferView"] = file.add_view((TRIANGLE + 1).tobytes())
    file.add_mesh(file.add_primitive(POSITION=file.append("accessors", accessor)))
    first = [1, 1, 1] if with_base else [0, 0, 0]
    np.testing.assert_array_equal(corners(loaded(file).primitives[0])[0], [first, [7, 7, 7], [8, 9, 8]])


def test_missing_normals_become_flat(loaded) -> None:
    """Two triangles that share an edge at a right angle: each keeps its own face normal."""
    file = GltfFile()
    positions = np.float32([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    file.add_mesh(file.add_primitive(np.uint8([0, 1, 2, 0, 2, 3]), POSITION=positions))
    primitive = loaded(file).primitives[0]
    assert len(primitive.positions) == 6
    np.testing.assert_array_equal(primitive.normals[primitive.triangles][:, 0], [[0, 0, 1], [1, 0, 0]])


def test_normals_are_made_unit_and_broken_ones_replaced(loaded) -> None:
    scene = loaded(simple(NORMAL=np.float32([[0, 0, 3], [0, 0, 0], [np.nan, 0, 0]])))
    np.testing.assert_array_equal(scene.primitives[0].normals, np.tile([0, 0, 1], (3, 1)))
    assert scene.warnings == ("2 normals without a direction replaced",)


@pytest.mark.parametrize("width", [3, 4])
def test_vertex_colours(loaded, width: int) -> None:
    colors = np.uint8([[0, 51, 255, 102]] * 3)[:, :width]
    file = GltfFile()
    padded = np.concatenate([colors, np.zeros((3, 4 - width), np.uint8)], axis=1)
    accessor = {"bufferView": file.add_view(padded.tobytes(), byteStride=4), "componentType": 5121, "count": 3}
    index = file.append("accessors", {**accessor, "type": f"VEC{width}", "normalized": True})
    file.add_mesh(file.add_primitive(POSITION=TRIANGLE, COLOR_0=index))
    expected = [0, 0.2, 1, 0.4 if width == 4 else 1]
    np.testing.assert_allclose(loaded(file).primitives[0].colors, [expected] * 3, atol=1e-6)


def test_only_the_vertices_in_use_are_kept(loaded) -> None:
    file = GltfFile()
    positions = np.concatenate([np.full((9, 3), 99, np.float32), SQUARE])
    file.add_mesh(file.add_primitive(np.uint16([9, 10, 12]), POSITION=positions))
    scene = loaded(file)
    assert len(scene.primitives[0].positions) == 3
    np.testing.assert_array_equal(scene.bounds, [[0, 0, 0], [1, 1, 0]])


def test_a_mesh_shown_twice_is_stored_once(loaded) -> None:
    file = simple()
    file.json["nodes"].append({"mesh": 0, "translation": [5, 0, 0]})
    file.json["scenes"][0]["nodes"].append(1)
    scene = loaded(file)
    assert (len(scene.primitives), len(scene.instances)) == (1, 2)
    assert (scene.triangle_count, scene.mesh_triangles) == (2, 1)


def test_nested_transforms_and_camera(loaded) -> None:
    """A turned and scaled parent moves its child's mesh and camera; the camera keeps no scale."""
    file = simple()
    turn = [0, math.sin(math.pi / 4), 0, math.cos(math.pi / 4)]  # a quarter turn about y: x → −z, z → x
    lens = {"type": "perspective", "perspective": {"yfov": math.pi / 3, "znear": 0.5, "zfar": 9}}
    camera = file.append("cameras", {**lens, "name": "eye"})
    child = file.append("nodes", {"mesh": 0, "camera": camera, "translation": [1, 0, 0]})
    parent = file.append("nodes", {"rotation": turn, "scale": [2, 2, 2], "translation": [0, 3, 0], "children": [child]})
    file.json["scenes"][0]["nodes"] = [parent]
    scene = loaded(file)
    matrix = scene.instances[0].matrix
    np.testing.assert_allclose(matrix @ [0, 0, 0, 1], [0, 3, -2, 1], atol=1e-12)
    np.testing.assert_allclose(matrix @ [1, 0, 0, 1], [0, 3, -4, 1], atol=1e-12)
    (eye,) = scene.cameras
    assert eye.name == "eye" and eye.vfov_deg == pytest.approx(60) and (eye.near, eye.far) == (0.5, 9)
    np.testing.assert_allclose(eye.matrix, [[0, 0, 1, 0], [0, 1, 0, 3], [-1, 0, 0, -2], [0, 0, 0, 1]], atol=1e-12)


def test_matrix_is_column_major_and_may_mirror(loaded) -> None:
    file = simple()
    file.json["nodes"][0]["matrix"] = [-1, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1, 0, 4, 5, 6, 1]
    matrix = loaded(file).instances[0].matrix
    np.testing.assert_array_equal(matrix, [[-1, 0, 0, 4], [0, 2, 0, 5], [0, 0, 1, 6], [0, 0, 0, 1]])
    assert np.linalg.det(matrix[:3, :3]) < 0


def test_cycles_and_second_parents_are_cut(loaded) -> None:
    file = simple()
    file.json["nodes"] = [{"mesh": 0, "children": [1]}, {"children": [0, 1]}]
    scene = loaded(file)
    assert len(scene.instances) == 1
    assert scene.warnings == ("2 nodes reached by more than one path, shown once (a cycle or two parents)",)


def test_the_default_scene_is_shown_and_others_named(loaded) -> None:
    file = simple()
    file.json["scenes"].append({"name": "other", "nodes": []})
    file.json["scene"] = 1
    scene = loaded(file)
    assert scene.triangle_count == 0 and scene.mesh_triangles == 1
    assert scene.warnings == ("1 further scene not shown: '0'",)


def test_material_factors(loaded) -> None:
    file = simple()
    file.json["materials"] = [
        {
            "name": "m",
            "pbrMetallicRoughness": {
                "baseColorFactor": [0.1, 0.2, 0.3, 0.4],
                "metallicFactor": 0.5,
                "roughnessFactor": 0.6,
            },
            "emissiveFactor": [1, 0.5, 0],
            "alphaMode": "MASK",
            "alphaCutoff": 0.3,
            "doubleSided": True,
            "extensions": {"KHR_materials_unlit": {}, "KHR_materials_emissive_strength": {"emissiveStrength": 8}},
        }
    ]
    file.json["meshes"][0]["primitives"][0]["material"] = 0
    (material,) = loaded(file).materials
    assert material.name == "m" and material.base_color == (0.1, 0.2, 0.3, 0.4)
    assert (material.metallic, material.roughness) == (0.5, 0.6)
    assert material.emissive == (8, 4, 0) and material.unlit and material.double_sided
    assert (material.alpha_mode, material.alpha_cutoff) == ("MASK", 0.3)


def test_without_a_material_the_defaults_of_the_specification_hold(loaded) -> None:
    scene = loaded(simple())
    (material,) = scene.materials
    assert material.base_color == (1, 1, 1, 1) and (material.metallic, material.roughness) == (1, 1)
    assert not material.double_sided and material.alpha_mode == "OPAQUE"


def textured(info: dict, sampler: dict | None = None, **material) -> GltfFile:
    file = GltfFile()
    uv = TRIANGLE[:, :2].copy()
    primitive = file.add_primitive(POSITION=TRIANGLE, TEXCOORD_0=uv, TEXCOORD_1=1 - uv)
    info = {"index": file.add_texture(PIXELS, sampler), **info}
    index = file.append("materials", {"pbrMetallicRoughness": {"baseColorTexture": info}, **material})
    file.add_mesh(primitive | {"material": index})
    return file


def test_textures_with_sampler_and_second_set(loaded) -> None:
    file = textured({"texCoord": 1}, {"wrapS": 33071, "wrapT": 33648, "magFilter": 9728, "minFilter": 9985})
    scene = loaded(file)
    texture = scene.materials[0].base_color_texture
    np.testing.assert_array_equal(texture.picture.pixels, PIXELS)
    sampler = texture.sampler
    assert (sampler.wrap_s, sampler.wrap_t) == ("clamp", "mirror")
    assert (sampler.magnify, sampler.minify) == ("NEAREST", "LINEAR_MIPMAP_NEAREST")
    assert texture.texcoord == 1 and texture.transform is None
    np.testing.assert_array_equal(scene.primitives[0].texcoords[1][:, 0], 1 - TRIANGLE[:, 0])


def test_texture_transform(loaded) -> None:
    """KHR_texture_transform turns uv so that the picture turns clockwise; its own texCoord wins."""
    moved = {"offset": [0.5, 0.25], "rotation": math.pi / 2, "scale": [2, 3], "texCoord": 0}
    file = textured({"texCoord": 1, "extensions": {"KHR_texture_transform": moved}})
    texture = loaded(file).materials[0].base_color_texture
    assert texture.texcoord == 0
    np.testing.assert_allclose(texture.transform, [[0, 3, 0.5], [-2, 0, 0.25]], atol=1e-12)


def test_other_texture_slots(loaded) -> None:
    file = textured(
        {},
        normalTexture={"index": 0, "scale": 0.5},
        occlusionTexture={"index": 0, "strength": 0.25},
        emissiveTexture={"index": 0},
    )
    material = loaded(file).materials[0]
    pictures = {material.normal_texture.picture, material.occlusion_texture.picture, material.emissive_texture.picture}
    assert pictures == {material.base_color_texture.picture}  # decoded once
    assert (material.normal_scale, material.occlusion_strength) == (0.5, 0.25)


@pytest.mark.parametrize("kind", ["JPEG", "WEBP", "BMP"])
def test_picture_formats(loaded, kind: str) -> None:
    file = textured({})
    stream = io.BytesIO()
    Image.fromarray(np.full((8, 16, 3), (200, 30, 60), np.uint8)).save(stream, kind)
    file.json["images"][0] = {"bufferView": file.add_view(stream.getvalue())}
    pixels = loaded(file).materials[0].base_color_texture.picture.pixels
    assert pixels.shape == (8, 16, 4)
    np.testing.assert_allclose(pixels.reshape(-1, 4), [(200, 30, 60, 255)] * 128, atol=4)


def test_sixteen_bit_grey_keeps_its_high_byte(loaded) -> None:
    file = textured({})
    stream = io.BytesIO()
    Image.fromarray(np.array([[0, 0x1234], [0x80FF, 0xFFFF]], np.uint16)).save(stream, "PNG")
    file.json["images"][0] = {"bufferView": file.add_view(stream.getvalue())}
    pixels = loaded(file).materials[0].base_color_texture.picture.pixels
    np.testing.assert_array_equal(pixels[..., 0], [[0, 0x12], [0x80, 0xFF]])


def test_what_is_not_shown_is_listed(loaded) -> None:
    file = textured({}, alphaMode="BLEND")
    file.json["extensionsUsed"] = ["KHR_lights_punctual", "KHR_texture_transform"]
    file.json["animations"] = [{}, {}]
    file.json["skins"] = [{}]
    file.json["cameras"] = [{"type": "orthographic", "name": "ortho"}]
    file.json["nodes"][0]["camera"] = 0
    scene = loaded(file)
    assert scene.materials[0].alpha_mode == "BLEND" and scene.cameras == ()
    assert set(scene.warnings) == {
        "extension KHR_lights_punctual not honoured",
        "2 animations not shown",
        "1 skin not applied: shown as modelled",
        "1 blended material blurred as what is behind where less than half opaque",
        "cameras[0] 'ortho' is not a perspective camera; not offered",
    }


def test_required_extensions_are_refused_by_name(tmp_path: Path) -> None:
    file = simple()
    file.json["extensionsRequired"] = file.json["extensionsUsed"] = ["EXT_meshopt_compression"]
    with pytest.raises(ModelError, match="EXT_meshopt_compression"):
        load(file.write(tmp_path / "a.gltf"))


def test_morph_targets_at_their_default_weights(loaded) -> None:
    file = GltfFile()
    primitive = file.add_primitive(POSITION=TRIANGLE)
    shift = file.add_accessor(np.tile(np.float32([0, 0, 4]), (3, 1)))
    primitive["targets"] = [{"POSITION": shift}]
    file.add_mesh(primitive)
    file.json["meshes"][0]["weights"] = [0.5]
    file.json["nodes"].append({"mesh": 0, "weights": [0.25]})
    file.json["scenes"][0]["nodes"].append(1)
    scene = loaded(file)
    heights = [scene.primitives[i.primitive].positions[0, 2] for i in scene.instances]
    assert heights == [2, 1]
    assert scene.warnings == ("2 primitives with morph targets shown at the default weights",)


def test_nan_positions_drop_their_triangles(loaded) -> None:
    file = GltfFile()
    positions = np.concatenate([SQUARE, np.float32([[np.nan, 0, 0], [np.inf, 1, 1]])])
    file.add_mesh(file.add_primitive(np.uint8([0, 1, 2, 0, 2, 4, 3, 5, 0]), POSITION=positions))
    scene = loaded(file)
    assert scene.triangle_count == 1 and np.isfinite(scene.bounds).all()
    assert scene.warnings == ("2 triangles with NaN or infinite positions left out",)


def test_broken_attributes_are_repaired(loaded) -> None:
    uv = np.float32([[0, 0], [np.nan, 1], [np.inf, 0]])
    colors = np.float32([[1, 1, 1], [np.nan, 0, 0], [1e9, -1, 0.5]])
    scene = loaded(simple(TEXCOORD_0=uv, COLOR_0=colors))
    primitive = scene.primitives[0]
    np.testing.assert_array_equal(primitive.texcoords[0], [[0, 0], [0, 1], [0, 0]])
    np.testing.assert_array_equal(primitive.colors[:, :3], [[1, 1, 1], [1, 0, 0], [65504, 0, 0.5]])


def test_draco(loaded) -> None:
    import DracoPy

    rng = np.random.default_rng(3)
    faces = np.uint32([[0, 1, 2], [0, 2, 3], [1, 4, 2]])
    points = rng.random((5, 3)).astype(np.float32)
    file = GltfFile()
    data = DracoPy.encode(points, faces, quantization_bits=16, preserve_order=True)
    accessor = {"componentType": 5126, "count": 5, "type": "VEC3"}
    indices = file.append("accessors", {"componentType": 5125, "count": 9, "type": "SCALAR"})
    extension = {"bufferView": file.add_view(data), "attributes": {"POSITION": 0}}
    file.json["extensionsRequired"] = file.json["extensionsUsed"] = [draco.EXTENSION]
    position = file.append("accessors", accessor)
    primitive = {"attributes": {"POSITION": position}, "indices": indices}
    file.add_mesh({**primitive, "extensions": {draco.EXTENSION: extension}})
    scene = loaded(file)
    assert scene.triangle_count == 3 and scene.warnings == ()
    found = {tuple(sorted(map(tuple, np.round(t, 3)))) for t in corners(scene.primitives[0]).astype(np.float64)}
    expected = {tuple(sorted(map(tuple, np.round(t, 3)))) for t in points[faces].astype(np.float64)}
    assert found == expected


def test_padding_and_unknown_chunks_after_the_data_are_ignored(tmp_path: Path) -> None:
    file = simple()
    path = tmp_path / "a.glb"
    path.write_bytes(glb(file.document(None), bytes(file.binary)) + b"trailing bytes")
    assert load(path).triangle_count == 1


def test_a_primitive_without_positions_is_counted_as_the_validator_does_and_not_shown(tmp_path: Path) -> None:
    file = GltfFile()
    file.add_mesh(file.add_primitive(NORMAL=TRIANGLE + 1))
    scene = load(file.write(tmp_path / "a.gltf"))
    assert (scene.mesh_triangles, scene.triangle_count) == (1, 0)
    assert scene.warnings == ("1 primitive without a triangle not shown",)
