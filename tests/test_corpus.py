"""Scene files from elsewhere, where a copy is at hand: `DOFVIEW_CORPUS`, or `../shared/corpus` beside the checkout."""

from __future__ import annotations

import json
import os
from contextlib import suppress
from pathlib import Path

import pytest
from test_load_hostile import check_scene, load_or_refuse

from dofview.scene.info import describe
from dofview.scene.load import load

CORPUS = Path(os.environ.get("DOFVIEW_CORPUS") or Path(__file__).resolve().parents[2] / "shared" / "corpus")
pytestmark = pytest.mark.skipif(not CORPUS.is_dir(), reason="no corpus of scene files here")


def files(*patterns: str) -> list[Path]:
    return sorted(path for pattern in patterns for path in CORPUS.glob(pattern)) if CORPUS.is_dir() else []


def declared_triangles(path: Path) -> int:
    """Triangles by the counts in the JSON alone, every mesh once."""
    data = path.read_bytes()
    text = data[20 : 20 + int.from_bytes(data[12:16], "little")] if path.suffix == ".glb" else data
    document = json.loads(text)
    total = 0
    for primitive in (p for mesh in document.get("meshes", []) for p in mesh["primitives"]):
        accessor = primitive.get("indices", primitive["attributes"].get("POSITION"))
        count = document["accessors"][accessor]["count"]
        mode = primitive.get("mode", 4)
        total += count // 3 if mode == 4 else max(count - 2, 0) if mode in (5, 6) else 0
    return total


# Counts of the Khronos validator (npm gltf-validator 2.0.0-dev.3.10, info.totalTriangleCount).
VALIDATED = {
    "AlphaBlendModeTest": 61,
    "AnimatedMorphCube": 12,
    "Avocado": 682,
    "Box": 12,
    "Box With Spaces": 12,
    "BoxInterleaved": 12,
    "BoxVertexColors": 12,
    "Cameras": 2,
    "Lantern": 5394,
    "MeshPrimitiveModes": 16,
    "MetalRoughSpheresNoTextures": 1040409,
    "MultiUVTest": 12,
    "MultipleScenes": 3,
    "NegativeScaleTest": 3884,
    "OrientationTest": 524,
    "SimpleSparseAccessor": 12,
    "TextureSettingsTest": 72,
    "TextureTransformTest": 18,
    "ToyCar": 108936,
    "TriangleWithoutIndices": 1,
    "VertexColorTest": 36,
    "WaterBottle": 4510,
}


@pytest.mark.parametrize("path", files("khronos/*/*.gl*", "asset-generator/*/*.gltf"), ids=lambda path: path.stem)
def test_valid_gltf_has_the_triangles_it_should(path: Path) -> None:
    scene = load(path)
    check_scene(scene)
    facts = describe(scene)
    assert facts["triangles"] == declared_triangles(path) == VALIDATED.get(path.stem, facts["triangles"])


@pytest.mark.parametrize("path", files("obj/**/*.obj"), ids=lambda path: path.stem)
def test_valid_obj_has_the_triangles_it_should(path: Path) -> None:
    scene = load(path)
    check_scene(scene)
    text = path.read_text("latin-1").replace("\\\n", " ")
    faces = [line.split("#")[0].split()[1:] for line in text.splitlines() if line.strip().startswith("f ")]
    # The two files with faces on no or infinite vertices say so instead.
    broken = {"issue-140-zero-face-idx": 1, "test-nan": 2}.get(path.stem, 0)
    assert scene.triangle_count == sum(len(face) - 2 for face in faces) - broken
    assert broken == 0 or any("left out" in text for text in scene.warnings)


@pytest.mark.parametrize("path", files("broken/**/*.gl*", "broken/**/*.obj"), ids=lambda path: path.stem)
def test_broken_files_are_refused_or_read(path: Path) -> None:
    load_or_refuse(path)


def test_every_picture_of_pngsuite_is_decoded_or_refused(tmp_path: Path) -> None:
    from PIL import Image

    from dofview.errors import ModelError
    from dofview.scene.limits import Account, Limits
    from dofview.scene.pictures import decode

    paths = files("broken/pngsuite/*.png")
    for path in paths:
        if path.stem.startswith("x"):  # PngSuite's own mark of broken files
            with suppress(ModelError):
                decode(path.read_bytes(), path.name, Account(Limits()))
            continue
        picture = decode(path.read_bytes(), path.name, Account(Limits()))
        with Image.open(path) as image:
            assert picture.pixels.shape == (image.height, image.width, 4)
    assert paths
