"""What `make view` does with and without a screen, with a stand-in for the installed command."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]

pytestmark = pytest.mark.skipif(
    shutil.which("make") is None or not sys.platform.startswith("linux"), reason="needs make and a POSIX shell"
)


def view(folder: Path, display: str, window_status: int) -> tuple[int, list[str], str]:
    """Run `make view` in a checkout that is set up, where the window ends with `window_status`: what was called."""
    shutil.copy(ROOT / "Makefile", folder)
    (folder / "pyproject.toml").touch()
    stand_in = folder / ".venv" / "bin" / "dofview"
    stand_in.parent.mkdir(parents=True)
    stand_in.write_text(f'#!/bin/sh\necho "$@" >> calls\n[ "$1" = compare ] || exit {window_status}\n')
    stand_in.chmod(0o755)
    for stamp in ("packages", "screen"):
        (folder / ".venv" / stamp).touch()
    env = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY", "MAKEFLAGS", "MAKELEVEL")}
    done = subprocess.run(
        ["make", "view"], cwd=folder, env={**env, **({"DISPLAY": display} if display else {})},
        capture_output=True, text=True,
    )  # fmt: skip
    return done.returncode, (folder / "calls").read_text().splitlines(), done.stdout


def test_with_a_screen_the_window_opens(tmp_path: Path):
    assert view(tmp_path, ":0", 0) == (0, [""], "")


def test_without_a_screen_every_method_is_rendered_and_it_says_so(tmp_path: Path):
    status, calls, said = view(tmp_path, "", 0)
    assert status == 0 and calls == ["compare --out out"] and "no screen" in said


def test_a_screen_that_cannot_be_used_is_no_screen(tmp_path: Path):
    status, calls, said = view(tmp_path, ":0", 4)
    assert status == 0 and calls == ["", "compare --out out"] and "no screen" in said


def test_any_other_failure_of_the_window_is_a_failure(tmp_path: Path):
    status, calls, _ = view(tmp_path, ":0", 1)
    assert status != 0 and calls == [""]


def test_ci_runs_make_test():
    lines = (ROOT / ".ci" / "run").read_text().splitlines()
    assert os.access(ROOT / ".ci" / "run", os.X_OK) and lines[-1].endswith("make test")
