"""Every shader, as it is really compiled, through the reference compiler: what one driver forgives another refuses."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Iterator, Mapping
from dataclasses import replace
from enum import Enum
from pathlib import Path

import pytest
from scenes import quad, scene_of, three_planes, unlit

from dofview.data import SHADERS
from dofview.gl.context import Gpu
from dofview.gl.pyramids import Analysis, blur, pyramid
from dofview.gl.shaders import ShaderLibrary, flatten
from dofview.lens import Lens
from dofview.methods import METHODS, method
from dofview.pipeline import Pipeline
from dofview.render.display import Display, show
from dofview.render.environment import STUDIO, Lighting
from dofview.seen import headless
from dofview.seen.model import Arrangement, Seen
from dofview.settings import ImageSettings, Settings

STAGES = {".vert": "vert", ".frag": "frag", ".geom": "geom"}
FILES = sorted(p.relative_to(SHADERS).as_posix() for p in SHADERS.rglob("*") if p.suffix in STAGES)
LENS = Lens(radius=1.0, focus_distance=5.0)

pytestmark = pytest.mark.skipif(shutil.which("glslangValidator") is None, reason="needs glslangValidator")


def variants(name: str) -> Iterator[Settings]:
    """The defaults of a method, and each value of each switch: where its shaders differ by defines."""
    base = Settings(method=name, lens=LENS, image=ImageSettings(size=(48, 36)))
    base = base.with_params(views=2) if name == "accumulation" else base
    yield base
    for field, info in method(name).Params.model_fields.items():
        if info.annotation is bool:
            yield base.with_params(**{field: not info.default})
        elif isinstance(info.annotation, type) and issubclass(info.annotation, Enum):
            yield from (base.with_params(**{field: value}) for value in info.annotation)


@pytest.fixture(scope="module")
def compiled(session_gpu: Gpu) -> dict[tuple[str, str], str]:
    """(file, flat text) of every stage that rendering with every method compiles."""
    found: dict[tuple[str, str], str] = {}
    build = ShaderLibrary._build

    def spy(library: ShaderLibrary, paths: tuple[str, ...], defines: Mapping, blocks: Mapping):
        for path in paths:
            found[(path, flatten(path, defines, blocks, 330).text)] = path
        return build(library, paths, defines, blocks)

    fresh = Gpu(session_gpu.ctx)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(ShaderLibrary, "_build", spy)
        pipeline = Pipeline(fresh, three_planes())
        for name in METHODS:
            for settings in variants(name):
                if fresh.version_code >= method(name).REQUIRES_GL:
                    result = pipeline.render(settings)
        glass = replace(unlit(1.0, 1.0, 1.0), base_color=(1.0, 1.0, 1.0, 0.5), alpha_mode="BLEND")
        seen_through = Pipeline(fresh, scene_of([quad((0, 0, 0), (1, 1))], [glass]))
        seen_through.render(Settings(method="multiview", lens=LENS, image=ImageSettings(size=(48, 36))))
        seen_through.release()
        pipeline.compare(result, settings)
        # What is left to a GPU to decide, software decides for itself.
        patch.setattr(fresh, "software", False)
        pipeline.render(Settings(method="splatting", lens=LENS, image=ImageSettings(size=(48, 36))))
        pipeline.render(settings.with_(light=Lighting(environment=STUDIO)))
        show(fresh, result.image, Display(), "shown")
        values = Seen(arrangement=Arrangement.GRID, error_map=True, in_focus=True)
        for linear in (False, True):
            headless.picture(pipeline, settings, values, linear=linear)
        for analysis in Analysis:
            blur(fresh, pyramid(fresh, "levels", (64, 48), 3), analysis)
        pipeline.release()
    fresh.release()
    return found


def lint(folder: Path, path: str, text: str) -> str:
    """What glslangValidator says of one stage; empty when it has nothing against it."""
    stage = STAGES[Path(path).suffix]
    source = folder / f"stage.{stage}"
    source.write_text(text, encoding="utf-8")
    done = subprocess.run(["glslangValidator", "-S", stage, source], capture_output=True, text=True)
    return "" if done.returncode == 0 else f"{path}\n{done.stdout}"


def test_what_is_compiled_is_legal(compiled: dict[tuple[str, str], str], tmp_path: Path):
    complaints = [lint(tmp_path, path, text) for path, text in compiled]
    assert len(complaints) > 20 and not "".join(complaints)


def test_every_file_is_compiled_by_something(compiled: dict[tuple[str, str], str]):
    """A file that no method, comparison or display needs is dead, except for what the window alone draws."""
    assert not [path for path in FILES if path not in compiled.values() and not path.startswith("viewer/")]
