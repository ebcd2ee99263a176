"""The one direction: what may import what, held by reading the source."""

from __future__ import annotations

import ast
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

import dofview

PACKAGE = Path(dofview.__file__).parent

PAGE = (PACKAGE.parent / "docs" / "architecture.md").read_text(encoding="utf-8")

# The table of docs/architecture.md, from the bottom up; a module imports its own line and those above it.
LAYERS = [re.findall(r"`(\w+)/?`", row) for row in re.findall(r"^\| (`.*?) \|", PAGE, re.MULTILINE)]
LEVEL = {name: number for number, names in enumerate(LAYERS) for name in names}
WINDOW_LIBRARIES = {"imgui_bundle", "imgui", "moderngl_window", "glfw", "pyglet"}
HEAVY_LIBRARIES = {"trimesh", "matplotlib", "scipy", "skimage", "OpenEXR", "av", "flip_evaluator", "DracoPy"}
GL_LAYERS = ("gl", "render", "methods", "pipeline", "seen", "viewer", "bench", "record", "stress")


def modules() -> Iterator[tuple[str, ast.Module]]:
    """Every module below the package's root, by its path, with its syntax tree."""
    for path in sorted(PACKAGE.rglob("*.py")):
        relative = path.relative_to(PACKAGE)
        if relative.as_posix() not in ("__init__.py", "__main__.py"):
            yield relative.as_posix(), ast.parse(path.read_text(encoding="utf-8"))


def imports(tree: ast.AST) -> Iterator[str]:
    """Dotted names of everything imported anywhere in `tree`; `from a import b` gives a.b."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"relative import of {node.module}"
            yield from (f"{node.module}.{alias.name}" for alias in node.names)


def layer(path: str) -> str:
    return path.split("/")[0].removesuffix(".py")


def test_imports_go_one_way():
    wrong = []
    for path, tree in modules():
        assert layer(path) in LEVEL, f"{path} has no place in LAYERS"
        for name in imports(tree):
            parts = name.split(".")
            # The root holds the version and the docstring, which anything may read.
            if parts[0] == "dofview" and len(parts) > 1 and LEVEL[parts[1]] > LEVEL[layer(path)]:
                wrong.append(f"{path} imports {name}")
    assert not wrong


def test_the_documented_layers_are_those_there_are():
    there = {layer(path) for path, _ in modules()}
    assert set(LEVEL) == there


def test_only_the_viewer_knows_of_windows():
    assert not [
        f"{path} imports {name}"
        for path, tree in modules()
        for name in imports(tree)
        if name.split(".")[0] in WINDOW_LIBRARIES and layer(path) != "viewer"
    ]


def test_only_what_draws_knows_of_opengl():
    assert not [
        f"{path} imports {name}"
        for path, tree in modules()
        for name in imports(tree)
        if name.split(".")[0] == "moderngl" and layer(path) not in GL_LAYERS
    ]


def test_heavy_libraries_are_imported_where_they_are_used():
    assert not [
        f"{path} imports {name} at its top"
        for path, tree in modules()
        for statement in tree.body
        if isinstance(statement, ast.Import | ast.ImportFrom)
        for name in imports(statement)
        if name.split(".")[0] in HEAVY_LIBRARIES
    ]


@pytest.mark.parametrize(
    "statement",
    ["import dofview", "import dofview.cli.app, dofview.pipeline, dofview.framing, dofview.export; dofview.METHODS"],
)
def test_importing_pulls_nothing_heavy(statement: str):
    code = f"{statement}\nimport sys; print(*sorted({{name.split('.')[0] for name in sys.modules}}))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert not (HEAVY_LIBRARIES | WINDOW_LIBRARIES) & set(done.stdout.split())


def test_the_public_names_are_functions_whatever_was_imported_first():
    code = (
        "import dofview.render.frame, dofview\nfrom dofview.pipeline import Pipeline\n"
        "assert callable(dofview.render) and callable(dofview.load) and 'pinhole' in dofview.METHODS"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
