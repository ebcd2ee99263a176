"""What our OBJ reader makes of the format and of the ways it is written in practice."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from gltf_files import png

from dofview.errors import ModelError
from dofview.scene.load import load
from dofview.scene.model import Primitive, Scene
from dofview.scene.normals import smooth_normals

SQUARE = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
CUBE = """
v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1
f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 2 3 7 6\nf 4 1 5 8
"""


@pytest.fixture
def loaded(tmp_path: Path):
    """Write OBJ text, and other files by name, and load it."""

    def load_text(text: str | bytes, **files: str | bytes) -> Scene:
        for name, content in {"model.obj": text, **files}.items():
            path = tmp_path / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return load(tmp_path / "model.obj")

    return load_text


def corners(primitive: Primitive) -> np.ndarray:
    return primitive.positions[primitive.triangles]


def area(scene: Scene) -> float:
    edges = [np.diff(corners(p).astype(np.float64), axis=1) for p in scene.primitives]
    return float(sum(np.linalg.norm(np.cross(e[:, 0], e[:, 1]), axis=1).sum() / 2 for e in edges))


def test_positions_texture_coordinates_and_normals(loaded) -> None:
    scene = loaded(SQUARE + "vt 0 0\nvt 1 0.25\nvn 0 0 2\nvn 0 1 0\nf 1/1/1 2/2/1 3/2/2\n")
    (primitive,) = scene.primitives
    np.testing.assert_array_equal(corners(primitive)[0], [[0, 0, 0], [1, 0, 0], [1, 1, 0]])
    order = primitive.triangles[0]
    np.testing.assert_array_equal(primitive.texcoords[0][order], [[0, 1], [1, 0.75], [1, 0.75]])  # v downwards
    np.testing.assert_array_equal(primitive.normals[order], [[0, 0, 1], [0, 0, 1], [0, 1, 0]])


@pytest.mark.parametrize("pattern", ["{0}", "{0}/{0}", "{0}//{0}", "{0}/{0}/{0}"])
@pytest.mark.parametrize("relative", [False, True])
def test_index_patterns(loaded, pattern: str, relative: bool) -> None:
    text = SQUARE + "vt 0 0\n" * 4 + "vn 0 0 1\n" * 4
    numbers = (-4, -3, -2) if relative else (1, 2, 3)
    scene = loaded(text + "f " + " ".join(pattern.format(n) for n in numbers))
    np.testing.assert_array_equal(corners(scene.primitives[0])[0], [[0, 0, 0], [1, 0, 0], [1, 1, 0]])
    assert scene.warnings == ()


def test_relative_indices_count_from_where_they_stand(loaded) -> None:
    scene = loaded("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 5 0 0\nv 6 0 0\nv 5 1 0\nf -3 -2 -1\n")
    np.testing.assert_array_equal(corners(scene.primitives[0])[:, 0], [[0, 0, 0], [5, 0, 0]])


def test_patterns_may_differ_from_face_to_face(loaded) -> None:
    """A face without texture coordinates costs the others nothing."""
    scene = loaded(SQUARE + "vt 0.5 0.5\nvn 0 0 1\nf 1/1 2/1 3/1\nf 1//1 3//1 4//1\nf 1 2 4\n")
    (primitive,) = scene.primitives
    assert scene.triangle_count == 3
    np.testing.assert_array_equal(primitive.texcoords[0][primitive.triangles[0]], [[0.5, 0.5]] * 3)
    assert scene.warnings == ("6 vertices of a partly textured material without texture coordinates",)


@pytest.mark.parametrize(
    ("change", "name"),
    [
        (lambda text: b"\xef\xbb\xbf" + text.encode(), "byte-order mark"),
        (lambda text: text.replace("\n", "\r\n").encode(), "CRLF"),
        (lambda text: text.replace("\n", "\r").encode(), "CR"),
        (lambda text: text.replace(" ", "\t ").encode(), "tabs"),
        (lambda text: text.replace("\n", "\n \t").encode(), "indented"),
        (lambda text: text.replace("1 2 6", "1 2\\\n 6").encode(), "continued"),
        (lambda text: ("# gr\xfcn\n" + text).encode("latin-1"), "Latin-1"),
        (lambda text: text.encode("utf-16"), "UTF-16"),
        (lambda text: text.replace("\n", "\n\n# c\n").encode() + b"f 1 2 3 # end", "comments"),
    ],
)
def test_ways_to_write_the_same_text(loaded, change, name: str) -> None:
    assert loaded(change(CUBE)).triangle_count == 12 + (name == "comments")


# The arrowhead of area 10 that a fan from its first corner covers with 14.
ARROWHEAD = [(0, 0), (4, 3), (0, 6), (1, 3)]


def polygon(points: list[tuple[float, float]]) -> str:
    return "".join(f"v {x} {y} 0\n" for x, y in points) + "f " + " ".join(str(i + 1) for i in range(len(points)))


def shoelace(points: list[tuple[float, float]]) -> float:
    x, y = np.array(points, float).T
    return abs(float((x * np.roll(y, -1) - np.roll(x, -1) * y).sum())) / 2


def star(count: int) -> list[tuple[float, float]]:
    angles = np.arange(2 * count) * np.pi / count
    radius = np.where(np.arange(2 * count) % 2, 0.3, 1.0)
    return list(zip((radius * np.cos(angles)).tolist(), (radius * np.sin(angles)).tolist(), strict=True))


@pytest.mark.parametrize("shift", range(4))
@pytest.mark.parametrize("backwards", [False, True])
@pytest.mark.parametrize(
    "points",
    [ARROWHEAD, star(5), star(40), [(0, 0), (3, 0), (3, 3), (2, 3), (2, 1), (1, 1), (1, 3), (0, 3)]],
    ids=["arrowhead", "star", "large star", "U"],
)
def test_concave_faces_keep_their_area(loaded, points, backwards: bool, shift: int) -> None:
    points = points[shift:] + points[:shift]
    points = points[::-1] if backwards else points
    scene = loaded(polygon(points))
    assert scene.triangle_count == len(points) - 2
    assert area(scene) == pytest.approx(shoelace(points), rel=1e-6)
    facing = smooth_normals(scene.primitives[0].positions, scene.primitives[0].triangles)[:, 2]
    assert (np.sign(facing) == (-1 if backwards else 1)).all()


def test_a_face_that_crosses_itself_ends(loaded) -> None:
    rng = np.random.default_rng(5)
    points = [tuple(p) for p in rng.random((60, 2)).tolist()]
    assert loaded(polygon(points)).triangle_count == 58


def test_normals_are_smooth_and_do_not_depend_on_how_faces_are_cut(loaded) -> None:
    """The corners of a cube point along its diagonals, though each face brings one or two triangles to a corner."""
    (primitive,) = loaded(CUBE).primitives
    expected = primitive.positions / np.sqrt(3)
    assert len(primitive.positions) == 8
    np.testing.assert_allclose(primitive.normals, expected, atol=1e-6)


def test_smoothing_off_and_groups(loaded) -> None:
    assert len(loaded("s off\n" + CUBE).primitives[0].positions) == 24
    roof = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\n"
    same = loaded(roof + "s 1\nf 1 2 3 4\nf 5 6 2 1\n").primitives[0]
    other = loaded(roof + "s 1\nf 1 2 3 4\ns 2\nf 5 6 2 1\n").primitives[0]
    assert (len(same.positions), len(other.positions)) == (6, 8)


MTL = """
newmtl red paint
Kd 0.8 0.1 0.2
Ns 98
newmtl light
Kd 0 0 0
Ke 5 4 3
newmtl metal
Pr 0.25
Pm 1
d 0.5
map_Ks shine.png
newmtl bare
illum 0
"""


def test_materials_and_groups(loaded) -> None:
    text = "mtllib a.mtl\n" + SQUARE
    names = ("red paint", "light", "metal", "bare", "red paint")
    text += "".join(f"g part {i}\nusemtl {name}\nf 1 2 3\n" for i, name in enumerate(names))
    scene = loaded(text, **{"a.mtl": MTL})
    red, light, metal, bare = scene.materials
    assert [len(p.triangles) for p in scene.primitives] == [2, 1, 1, 1]  # one primitive for each material
    assert (red.name, red.base_color, red.metallic) == ("red paint", (0.8, 0.1, 0.2, 1), 0)
    assert red.roughness == pytest.approx(0.02**0.25)
    assert light.emissive == (5, 4, 3)
    assert (metal.roughness, metal.metallic, metal.alpha_mode, metal.base_color[3]) == (0.25, 1, "BLEND", 0.5)
    assert all(material.double_sided for material in scene.materials)  # the format knows no back
    assert bare.unlit and bare.base_color == (1, 1, 1, 1)
    assert set(scene.warnings) == {
        "1 map_Ks texture not shown",
        "1 blended material blurred as what is behind where less than half opaque",
    }


TEXTURED = SQUARE + "vt 0 0\nvt 1 0\nvt 1 1\nmtllib m.mtl\nusemtl a\nf 1/1 2/2 3/3\n"
PIXELS = np.arange(2 * 2 * 3, dtype=np.uint8).reshape(2, 2, 3)


@pytest.mark.parametrize(
    ("statement", "file"),
    [
        ("map_Kd t.png", "t.png"),
        ("map_Kd  my  texture 01.png ", "my  texture 01.png"),
        (r"map_Kd .\images\t.png", "images/t.png"),
        ("map_Kd -bm 2 -mm 0 1 -blendu on -imfchan l -s 1 1 1 t 1.png", "t 1.png"),
    ],
)
def test_texture_names_and_options(loaded, statement: str, file: str) -> None:
    scene = loaded(TEXTURED, **{"m.mtl": f"newmtl a\n{statement}\n", file: png(PIXELS)})
    texture = scene.materials[0].base_color_texture
    np.testing.assert_array_equal(texture.picture.pixels[..., :3], PIXELS)
    assert scene.warnings == ()


def test_texture_scale_offset_and_clamp(loaded) -> None:
    """The MTL transform works on v upwards; ours must give the same place of the picture."""
    scene = loaded(TEXTURED, **{"m.mtl": "newmtl a\nmap_Kd -clamp on -o 0.1 0.2 -s 2 3 t.png\n", "t.png": png(PIXELS)})
    texture = scene.materials[0].base_color_texture
    uv = np.array([0.3, 0.4])
    u, v = texture.transform @ [uv[0], 1 - uv[1], 1]
    np.testing.assert_allclose([u, 1 - v], uv * [2, 3] + [0.1, 0.2])
    assert texture.sampler.wrap_s == texture.sampler.wrap_t == "clamp"


def test_textures_beside_the_library(loaded) -> None:
    text = TEXTURED.replace("m.mtl", "materials\\m.mtl")
    files = {"materials/m.mtl": "newmtl a\nmap_Ke t.png\nnorm n.png\n", "materials/t.png": png(PIXELS)}
    scene = loaded(text, **files, **{"n.png": png(PIXELS)})
    (material,) = scene.materials
    assert material.emissive == (1, 1, 1) and material.emissive_texture is not None
    assert material.normal_texture is not None  # found beside the .obj
    assert scene.warnings == ()


def test_masks_and_packed_channels(loaded) -> None:
    mask = np.uint8([[255, 0], [0, 255]])
    library = "newmtl a\nmap_Kd t.png\nmap_d d.png\nmap_Pr r.png\nmap_Pm d.png\n"
    files = {"m.mtl": library, "t.png": png(PIXELS), "d.png": png(mask), "r.png": png(mask // 5)}
    (material,) = loaded(TEXTURED, **files).materials
    assert material.alpha_mode == "MASK"
    np.testing.assert_array_equal(material.base_color_texture.picture.pixels[..., 3], mask)
    packed = material.metallic_roughness_texture.picture.pixels
    np.testing.assert_array_equal(packed[..., 1], mask // 5)
    np.testing.assert_array_equal(packed[..., 2], mask)
    assert (material.roughness, material.metallic) == (1, 1)


def test_several_libraries_also_with_spaces(loaded) -> None:
    text = "mtllib a b.mtl c.mtl\nmtllib d e.mtl\n" + SQUARE
    text += "".join(f"usemtl {name}\nf 1 2 3\n" for name in "xyz")
    files = {f"{file}.mtl": f"newmtl {name}\nKd 0 0 1\n" for file, name in (("a b", "x"), ("c", "y"), ("d e", "z"))}
    scene = loaded(text, **files)
    assert [m.base_color for m in scene.materials] == [(0, 0, 1, 1)] * 3 and scene.warnings == ()


def test_missing_files_are_warnings(loaded) -> None:
    scene = loaded(SQUARE + "mtllib no.mtl\nmtllib m.mtl\nusemtl a\nf 1 2 3\nusemtl b\nf 1 3 4\n", **{
        "m.mtl": "newmtl a\nmap_Kd no.png\n"
    })  # fmt: skip
    assert scene.triangle_count == 2
    assert [text.split(":")[0] for text in scene.warnings] == [
        "material library 'no.mtl' cannot be opened",
        "texture 'no.png'",
        "material 'b' is in no library that was read; shown plain",
    ]


def test_opacity_and_its_slips(loaded) -> None:
    library = "newmtl a\nTr 0.25\nnewmtl b\nTr 1\nnewmtl c\nKd 0 0 0\nmap_Kd t.png\n"
    text = SQUARE + "mtllib m.mtl\n" + "".join(f"usemtl {name}\nf 1 2 3\n" for name in "abc")
    a, b, c = loaded(text, **{"m.mtl": library, "t.png": png(PIXELS)}).materials
    assert (a.base_color[3], a.alpha_mode) == (0.75, "BLEND")
    assert (b.base_color[3], b.alpha_mode) == (1, "OPAQUE")
    assert c.base_color == (1, 1, 1, 1)


def test_vertex_colours(loaded) -> None:
    scene = loaded("v 0 0 0 1 0.5 0\nv 1 0 0 0 1 0\nv 0 1 0\nv 1 1 0 nan nan nan\nf 1 2 3\nf 2 4 3\n")
    (primitive,) = scene.primitives
    order = np.lexsort(primitive.positions.T)
    np.testing.assert_array_equal(primitive.colors[order, :3], [[1, 0.5, 0], [0, 1, 0], [1, 1, 1], [1, 1, 1]])


def test_weights_after_the_position_are_no_colours(loaded) -> None:
    assert loaded("v 0 0 0 1\nv 1 0 0 1\nv 0 1 0 1\nf 1 2 3\n").primitives[0].colors is None


def test_lines_points_and_surfaces_are_listed(loaded) -> None:
    scene = loaded(SQUARE + "l 1 2 3\nl 1 2\np 4\ncurv 0 1 1 2\nf 1 2 3\nwhatever 1\n")
    assert scene.triangle_count == 1
    assert set(scene.warnings) == {
        "2 line statements not shown",
        "1 point statement not shown",
        "1 free-form curve or surface not shown",
        "1 line of no known kind ignored",
    }


def test_bad_faces_are_left_out_and_counted(loaded) -> None:
    scene = loaded(SQUARE + "v nan 0 0\nv 1e999 0 0\nv 1 2\nf 1 2 3\nf 0 1 2\nf 1 2 99\nf 1 2 x\nf 1 2 5\nf 1 6 2\n"
                   "f 1 2 7\nf 1 2\nf -9 1 2\nf 1 2 99999999999999999999\n")  # fmt: skip
    assert scene.triangle_count == 1 and np.isfinite(scene.bounds).all()
    assert scene.warnings == (
        "5 faces with a vertex index out of range left out",
        "3 faces with NaN or infinite positions left out",
        "1 face of fewer than three corners left out",
    )


def test_quarter_metres_a_thousand_kilometres_away(loaded) -> None:
    """float32 has steps of 0.0625 m and more out there; the origin goes into the instance's matrix."""
    base = np.array([1e6, -2e6, 1e6])
    local = np.array([[0.25, 0, 0], [100.75, 0.5, 0], [0, 50.25, 12.25]])
    scene = loaded("".join("v {:.2f} {:.2f} {:.2f}\n".format(*row) for row in local + base) + "f 1 2 3\n")
    (primitive,), (instance,) = scene.primitives, scene.instances
    world = corners(primitive)[0].astype(np.float64) + instance.matrix[:3, 3]
    np.testing.assert_array_equal(world, local + base)
    assert (instance.matrix[:3, 3] != 0).all()
    np.testing.assert_array_equal(loaded(CUBE).instances[0].matrix, np.eye(4))  # near ones stay where they are


def test_nothing_that_looks_like_a_model_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "a.obj"
    for data in (b"", b"# only a comment\n", b"\x4c\x01\x02\x00 a COFF object file", b"o name\ng group\n"):
        path.write_bytes(data)
        with pytest.raises(ModelError, match="no vertex and no face"):
            load(path)
    path.write_bytes(b"v 0 0 0\n")
    assert load(path).triangle_count == 0


def test_large_regular_files_equal_trimesh(loaded, tmp_path: Path) -> None:
    """Where trimesh reads OBJ exactly (regular triangles, v/vt/vn), both agree to the last digit."""
    trimesh = pytest.importorskip("trimesh")
    rng = np.random.default_rng(2)
    positions, uv = rng.normal(size=(3000, 3)), rng.random((500, 2))
    faces = rng.integers(1, 3001, (9000, 3))
    lines = ["v {!r} {!r} {!r}".format(*row) for row in positions.tolist()]
    lines += ["vt {!r} {!r}".format(*row) for row in uv.tolist()]
    lines += [" ".join(["f", *(f"{v}/{v % 500 + 1}" for v in face)]) for face in faces.tolist()]
    (primitive,) = loaded("\n".join(lines)).primitives
    other = trimesh.load(tmp_path / "model.obj", process=False, force="mesh")
    np.testing.assert_array_equal(corners(primitive), other.vertices[other.faces].astype(np.float32))
    theirs = other.visual.uv[other.faces] * [1, -1] + [0, 1]
    np.testing.assert_allclose(primitive.texcoords[0][primitive.triangles], theirs, atol=1e-7)
