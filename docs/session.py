"""Make the pictures of docs/viewer.md: a session in the real window under a virtual screen, by mouse and keyboard.

Run it where Xvfb and xdotool are; it takes minutes without a GPU. `tests/test_session.py` goes the same way.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image

sys.path[:0] = [str(Path(__file__).parents[1]), str(Path(__file__).parents[1] / "tests")]

import real_window  # noqa: E402
from real_window import Window, screen, tools_missing  # noqa: E402
from session import Session  # noqa: E402

from dofview.gl.context import create_headless  # noqa: E402

IMAGES = Path(__file__).parent / "images"
SIZE, SCENE = (1280, 800), "demo:foreground"
BALL, BOWL = (0.168, 0.24), (0.375, 0.76)
MOST_BYTES = 300_000


def keep(name: str, pixels: np.ndarray) -> None:
    """Write docs/images/window-NAME.jpg, as fine as its size allows."""
    path = IMAGES / f"window-{name}.jpg"
    for quality in (88, 82, 76, 70, 60):
        Image.fromarray(pixels.astype(np.uint8)).save(path, quality=quality, optimize=True, subsampling=0)
        if path.stat().st_size <= MOST_BYTES:
            break
    print(f"wrote: {path}")


def main() -> None:
    """Go through the session."""
    if tools_missing():
        raise SystemExit(f"this needs {tools_missing()}")
    real_window.PATIENCE_S = 1200.0  # a large picture's reference without a GPU, beside whatever else is running
    gpu = create_headless()
    with tempfile.TemporaryDirectory() as folder, screen(Path(folder)) as environment:
        work = Path(folder) / "work"
        work.mkdir()
        window = Window(environment, work, SIZE, "demo:rail", "--method", "mipmap")
        try:
            Session(window, gpu, SCENE, BALL, BOWL, keep, patient=True).run()
            window.quit()
        finally:
            window.close()
    gpu.release()


if __name__ == "__main__":
    main()
