"""The wheel and the source archive: built here, installed into an empty folder, and used from another one."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).parents[1]


def build(source: Path, kind: str, into: Path) -> Path:
    """Build without a network and without an environment of its own; return the file."""
    into.mkdir()
    subprocess.run([sys.executable, "-m", "hatchling", "build", "-t", kind, "-d", into], cwd=source, check=True,
                   capture_output=True)  # fmt: skip
    (built,) = into.iterdir()
    return built


@pytest.fixture(scope="module")
def archive(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return build(ROOT, "sdist", tmp_path_factory.mktemp("sdist") / "built")


@pytest.fixture(scope="module")
def wheel(archive: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Built from the unpacked source archive, so that what is missing there is missing here."""
    folder = tmp_path_factory.mktemp("wheel")
    with tarfile.open(archive) as tar:
        tar.extractall(folder / "source")
    (source,) = (folder / "source").iterdir()
    return build(source, "wheel", folder / "built")


@pytest.fixture(scope="module")
def installed(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An empty folder with the wheel in it; what it depends on comes from this environment."""
    target = tmp_path_factory.mktemp("installed")
    subprocess.run([sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--no-index", "--target", target,
                    wheel], check=True, capture_output=True)  # fmt: skip
    return target


def python(installed: Path, folder: Path, *arguments: str) -> str:
    """Run Python on the installed package from `folder`; nothing of the checkout is on its path."""
    env = {**os.environ, "PYTHONPATH": str(installed), "LP_NUM_THREADS": "1"}
    done = subprocess.run([sys.executable, *arguments], cwd=folder, env=env, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_the_installed_package_renders_from_any_folder(installed: Path, tmp_path: Path):
    where = python(
        installed, tmp_path, "-c", "import dofview, dofview.data; print(dofview.__file__, dofview.data.ROOT)"
    )
    assert [Path(path).is_relative_to(installed) for path in where.split()] == [True, True]
    render = ("-m", "dofview", "render", "demo:crossing", "--method", "mipmap", "--size", "64x48", "-o", "a.npy")
    facts = json.loads(python(installed, tmp_path, *render).splitlines()[-1])
    assert facts["method"] == "mipmap" and np.load(tmp_path / "a.npy").std() > 0.01


def test_the_command_is_installed(installed: Path, tmp_path: Path):
    (script,) = [path for path in (installed / "bin").iterdir() if path.stem == "dofview"]
    assert "mipmap" in python(installed, tmp_path, str(script), "methods")


def test_the_public_names_work_when_installed(installed: Path, tmp_path: Path):
    code = "import dofview; print(dofview.render(dofview.load('demo:crossing'), method='pinhole').shape)"
    assert python(installed, tmp_path, "-c", code).strip() == "(384, 512, 3)"


def test_the_wheel_holds_every_shader_and_asset_and_no_script(wheel: Path):
    names = set(zipfile.ZipFile(wheel).namelist())
    for tree in ("shaders", "assets"):
        here = {p for p in (ROOT / tree).rglob("*") if p.is_file() and p.suffix != ".py" and p.name[0] != "."}
        here = {p for p in here if "__pycache__" not in p.parts}
        assert {f"dofview/{p.relative_to(ROOT).as_posix()}" for p in here} <= names
        assert not [name for name in names if name.startswith(f"dofview/{tree}/") and name.endswith(".py")]
    assert {name.split("/")[0] for name in names} == {"dofview", f"{wheel.name.split('-py3')[0]}.dist-info"}


def test_the_source_archive_holds_tests_and_docs(archive: Path):
    with tarfile.open(archive) as tar:
        names = {name.partition("/")[2] for name in tar.getnames()}
    assert {"README.md", "LICENSE", "CHANGELOG.md", "Makefile", "tests/conftest.py", "docs/parameters.py"} <= names
    assert not [name for name in names if ".venv" in name or "__pycache__" in name]
