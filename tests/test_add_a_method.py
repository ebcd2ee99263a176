"""A sixth method is one Python file, one folder of shaders and one word: those of docs/add-a-method.md, in a copy."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from dofview.methods import METHODS

ROOT = Path(__file__).parents[1]
FILE = re.compile(r"<!-- file: (\S+) -->\n```\w+\n(.*?)```\n", re.DOTALL)


@pytest.fixture(scope="module")
def copy(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The project with the method of the documentation added as the documentation says."""
    copy = tmp_path_factory.mktemp("copy")
    for tree in ("dofview", "shaders", "tests", "docs"):
        shutil.copytree(ROOT / tree, copy / tree, ignore=shutil.ignore_patterns("__pycache__"))
    for path, text in FILE.findall((ROOT / "docs" / "add-a-method.md").read_text(encoding="utf-8")):
        (copy / path).parent.mkdir(exist_ok=True)
        assert not (copy / path).exists()
        (copy / path).write_text(text, encoding="utf-8")
    listing = copy / "dofview" / "methods" / "__init__.py"
    text = listing.read_text(encoding="utf-8")
    assert text.count('"accumulation"') == 1
    listing.write_text(text.replace('"accumulation"', '"gather", "accumulation"'), encoding="utf-8")
    return copy


def python(copy: Path, *arguments: str, status: int = 0) -> subprocess.CompletedProcess[str]:
    env = {**os.environ, "PYTHONPATH": str(copy), "LP_NUM_THREADS": "1"}
    done = subprocess.run([sys.executable, *arguments], cwd=copy, env=env, capture_output=True, text=True)
    assert done.returncode == status, done.stdout + done.stderr
    return done


def test_it_is_listed_with_its_parameters(copy: Path):
    listed = json.loads(python(copy, "-m", "dofview", "methods", "--json").stdout)
    assert [one["name"] for one in listed] == [*METHODS[:-1], "gather", METHODS[-1]]
    (gather,) = [one for one in listed if one["name"] == "gather"]
    assert [row["flag"] for row in gather["parameters"]] == ["--taps", "--leak"]
    assert gather["parameters"][0]["accepted"] == "a whole number from 1 to 512"


def test_its_flags_reach_its_shader(copy: Path):
    render = ("-m", "dofview", "render", "demo:crossing", "--size", "64x48", "--method", "gather", "-o")
    python(copy, *render, "a.npy")
    python(copy, *render, "b.npy", "--taps", "1")
    python(copy, *render, "c.npy", "--leak", "1")
    pictures = [np.load(copy / f"{name}.npy") for name in "abc"]
    assert all(np.abs(pictures[0] - other).max() > 0.01 for other in pictures[1:])
    refused = python(copy, *render, "d.npy", "--taps", "0", status=2)
    assert refused.stderr == "dofview: gather: taps is '0'; accepted: a whole number from 1 to 512\n"
    assert "--taps" in python(copy, "-m", "dofview", "render", "--method", "gather", "--help").stdout


def test_its_parameters_are_settings(copy: Path):
    code = (
        "from dofview.settings import Settings\n"
        "s = Settings.model_validate({'method': 'gather', 'params': {'gather': {'taps': 8}}})\n"
        "assert s.method_params.taps == 8 and s.with_params(leak=0.5) != s"
    )
    python(copy, "-c", code)


def test_its_documentation_table_is_written(copy: Path):
    python(copy, "docs/parameters.py")
    page = (copy / "docs" / "methods" / "gather.md").read_text(encoding="utf-8")
    assert page.startswith("# Gather\n") and "| `--taps` | N | 64 | a whole number from 1 to 512 |" in page


def test_it_is_held_to_the_contract(copy: Path):
    done = python(
        copy, "-m", "pytest", "-p", "no:cacheprovider", "--rootdir", ".", "tests/test_methods.py", "-k", "gather"
    )
    assert int(re.search(r"(\d+) passed", done.stdout)[1]) >= 15


def test_nothing_of_it_is_in_the_project():
    assert "gather" not in METHODS and not (ROOT / "dofview" / "methods" / "gather.py").exists()
