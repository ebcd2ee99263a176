"""The row across devices: the same command with the machine's driver and with Mesa's slow, simple one, softpipe.

Softpipe shares little with other drivers: one pixel at a time, OpenGL 3.3 and no more. Each picture is rendered by a
process of its own, since a driver is chosen when the library is loaded.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

import dofview
from dofview.errors import InputError
from dofview.metrics import flip
from dofview.stress.bench import Bench
from dofview.stress.row import Measured, Row, Skipped, bounds

SCENES = ("demo:foreground", "demo:background", "demo:rail", "demo:highlights", "demo:crossing")
SOFTPIPE = {"GALLIUM_DRIVER": "softpipe", "LIBGL_ALWAYS_SOFTWARE": "1"}
SIZE = "64x48"
VIEWS = 16
MOST_S = 120.0


def across_drivers(bench: Bench, method: str, random: np.random.Generator) -> list[Measured]:
    """A demo scene by this machine's driver and by softpipe: mean FLIP."""
    scene = str(random.choice(SCENES))
    with tempfile.TemporaryDirectory() as folder:
        here, _ = _rendered(scene, method, Path(folder) / "here.npy", {})
        there, renderer = _rendered(scene, method, Path(folder) / "there.npy", SOFTPIPE)
    if "softpipe" not in renderer:
        raise Skipped(f"softpipe is not to be had here: {renderer}")
    try:
        return [Measured("mean FLIP", flip(np.clip(there, 0, 1), np.clip(here, 0, 1)))]
    except InputError as error:
        raise Skipped(str(error)) from error


def _rendered(scene: str, method: str, path: Path, environment: dict[str, str]) -> tuple[np.ndarray, str]:
    """The picture (h, w, 3), and who drew it, as the command's last line says."""
    command = [sys.executable, "-m", "dofview", "render", scene, "-o", str(path), "--method", method, "--size", SIZE]
    command += ["--views", str(VIEWS)] if method == "accumulation" else []
    root = Path(dofview.__file__).parents[1]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(root), os.environ.get("PYTHONPATH", "")]),
                   **environment}  # fmt: skip
    done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=MOST_S, check=False)
    if done.returncode == 4:
        raise Skipped(done.stderr.strip().splitlines()[-1])
    if done.returncode:
        raise AssertionError(f"{' '.join(command)} with {environment}: {done.stderr.strip()}")
    return np.load(path), json.loads(done.stdout.splitlines()[-1])["renderer"]


ROWS = (
    Row(21, "across drivers", bounds(0.01, 0.02, 0.02, 0.02, 0.02, 0.02), across_drivers, rarely=True),
)  # fmt: skip
