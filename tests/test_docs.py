"""Documentation that is made from the code is made from this code."""

from __future__ import annotations

import importlib.util
import json
import re
import shutil
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from PIL import Image

from dofview.bench.plan import full
from dofview.bench.report import write_report
from dofview.bench.run import missing
from dofview.bench.skip_page import skip_page
from dofview.bench.store import Store
from dofview.gl.context import Gpu
from dofview.methods import METHODS, method

ROOT = Path(__file__).parents[1]
PAGES = sorted([*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md")])


def script(name: str) -> ModuleType:
    """A script of docs/ as a module."""
    spec = importlib.util.spec_from_file_location(name, ROOT / "docs" / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def generator() -> ModuleType:
    return script("parameters")


@pytest.fixture(scope="module")
def pictures() -> ModuleType:
    return script("pictures")


@pytest.mark.parametrize("name", METHODS)
def test_the_parameter_table_is_current(generator: ModuleType, name: str):
    """`make docs` writes it."""
    text = (ROOT / "docs" / "methods" / f"{name}.md").read_text(encoding="utf-8")
    assert generator.page(name, text) == text


def test_the_tables_of_the_viewer_are_current():
    """`make docs` writes them."""
    actions = script("actions")
    text = actions.PAGE.read_text(encoding="utf-8")
    assert actions.page(text) == text
    assert text.count("| View |") >= 3 and "Ctrl+Shift+P" in text and "dwell_s" in text


@pytest.mark.parametrize("name", METHODS)
def test_a_table_has_a_row_for_every_parameter(generator: ModuleType, name: str):
    for field, info in method(name).Params.model_fields.items():
        row = next(line for line in generator.table(name).splitlines() if f"`--{field.replace('_', '-')}`" in line)
        assert info.description.replace("|", "\\|") in row


def test_a_table_replaces_the_old_one_and_nothing_else(generator: ModuleType):
    text = "# A\n\nBefore.\n\n<!-- parameters -->\nold\n<!-- /parameters -->\n\nAfter.\n"
    fresh = generator.page("pinhole", text)
    assert "old" not in fresh and fresh.startswith("# A\n\nBefore.\n") and fresh.endswith("\nAfter.\n")
    assert generator.page("pinhole", fresh) == fresh


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_links_lead_somewhere(page: Path):
    for target in re.findall(r"\]\(([^)#\s]+)", page.read_text(encoding="utf-8")):
        if not target.startswith(("http://", "https://")):
            assert (page.parent / target).exists(), f"{page.name} links to {target}"


@pytest.mark.parametrize("name", [name for name in METHODS if name != "pinhole"])
def test_the_picture_in_the_readme_is_what_is_rendered(gpu: Gpu, pictures: ModuleType, name: str):
    """A golden image, from Mesa's llvmpipe: at most 1 % of the pixels may be off by more than 4 of 255."""
    (x, y), (width, height) = pictures.place(pictures.NAMES.index(name)), pictures.TILE
    golden = np.asarray(Image.open(pictures.PICTURE).crop((x, y, x + width, y + height)), dtype=int)
    fresh = np.asarray(pictures.tiles(gpu, [name])[name], dtype=int)
    off = (np.abs(fresh - golden).max(axis=2) > 4).mean()
    assert off <= 0.01, f"{off:.1%} of the pixels changed; if they should, `make docs` makes the picture anew"


@pytest.mark.parametrize("name", ["layered", "mipmap", "multiview", "pyramid"])
def test_a_comparison_shows_the_method_as_it_is(gpu: Gpu, name: str):
    """The left third of a page's picture, made again; a different driver may round differently."""
    comparisons = script("comparisons")
    scene, distribution, size = comparisons.COMPARED[name]
    kept = np.asarray(Image.open(comparisons.IMAGES / f"{name}.png")).astype(float)
    pipeline = comparisons.Pipeline(gpu, comparisons.load(scene))
    fresh = comparisons.rendered(pipeline, comparisons.seen(scene, distribution, size), name).astype(float)
    pipeline.release()
    assert kept.shape == (size[1], 3 * size[0], 3)
    assert np.mean(np.abs(kept[:, : size[0]] - fresh) > 4.0) < 0.01


def test_the_python_of_the_readme_runs(capsys: pytest.CaptureFixture) -> None:
    """As it stands there, on a small scene and picture with few views."""
    blocks = re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text(encoding="utf-8"), flags=re.S)
    names: dict = {}
    for block in blocks:
        smaller = (
            block.replace('"scene.glb"', '"demo:crossing@3k"').replace("(640, 480)", "(48, 36)").replace("256", "8")
        )
        exec(smaller, names)
    names["pipeline"].release()
    assert names["picture"].shape[2] == 3 and len(capsys.readouterr().out.splitlines()) == 4


def test_the_report_is_what_its_results_say(tmp_path: Path):
    """`dofview bench --out docs/benchmark` writes it, and measures nothing that is there."""
    kept = ROOT / "docs" / "benchmark"
    shutil.copy(kept / "results.jsonl", tmp_path)
    shutil.copytree(kept / "sheets", tmp_path / "sheets")
    store = Store(tmp_path)
    assert not missing(full(), store)
    write_report(store)
    assert (tmp_path / "report.md").read_text(encoding="utf-8") == (kept / "report.md").read_text(encoding="utf-8")


def test_the_page_of_skips_is_what_its_results_say():
    kept = ROOT / "docs" / "benchmark"
    content = json.loads((kept / "skips.json").read_text(encoding="utf-8"))
    assert skip_page(content) == (kept / "skips.md").read_text(encoding="utf-8")
