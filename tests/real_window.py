"""The real program in a real window on a screen of its own, used by mouse and keyboard.

What has come of it is read from the log that the viewer writes: nothing waits longer than it must, and a slow machine
is only slow.
"""

from __future__ import annotations

import contextlib
import os
import re
import shutil
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
from PIL import Image

ROOT = Path(__file__).parents[1]
PATIENCE_S = 300.0


def tools_missing() -> str:
    """What this machine lacks for a window that is used by a program; empty when nothing."""
    return ", ".join(name for name in ("Xvfb", "xdotool") if not shutil.which(name))


@contextlib.contextmanager
def screen(home: Path, size: tuple[int, int] = (1400, 900)) -> Iterator[dict[str, str]]:
    """The environment of a screen of our own, so that nothing touches the one a person is using."""
    read, write = os.pipe()
    server = subprocess.Popen(
        ["Xvfb", "-displayfd", str(write), "-screen", "0", f"{size[0]}x{size[1]}x24", "-nolisten", "tcp"],
        pass_fds=(write,), stderr=subprocess.DEVNULL,
    )  # fmt: skip
    os.close(write)
    try:
        with os.fdopen(read) as stream:
            number = stream.readline().strip()
        away = ("WAYLAND_DISPLAY", "XDG_STATE_HOME", "XDG_CONFIG_HOME")
        kept = {name: value for name, value in os.environ.items() if name not in away}
        yield {**kept, "DISPLAY": f":{number}", "HOME": str(home), "PYTHONPATH": str(ROOT), "LP_NUM_THREADS": "0"}
    finally:
        server.terminate()
        server.wait(timeout=10)


class Window:
    """A running viewer. It works in `folder`, where what it saves is found."""

    program: tuple[str, ...] = ("-m", "dofview")

    def __init__(self, environment: dict[str, str], folder: Path, size: tuple[int, int], *arguments: str):
        self.environment, self.folder, self.size = environment, folder, size
        self.errors = (folder / "errors.txt").open("w+")
        self.log = folder / "viewer.log"
        command = [sys.executable, *self.program, *arguments]
        self.process = subprocess.Popen(
            [*command, "--size", f"{size[0]}x{size[1]}", "--log", str(self.log)],
            cwd=folder, env=environment, stderr=self.errors, text=True,
        )  # fmt: skip
        self.wait("rendered|reference")
        self.move(0.3, 0.5)

    def xdo(self, *arguments: object) -> str:
        command = ["xdotool", *map(str, arguments)]
        return subprocess.run(command, env=self.environment, capture_output=True, text=True, timeout=60).stdout

    def key(self, *chords: str) -> None:
        """Press keys, one after another."""
        self.xdo("key", "--delay", 60, *chords)

    def place(self, x: float, y: float) -> tuple[int, int]:
        """Pixels of the screen of a share of the window."""
        return round(x * self.size[0]), round(y * self.size[1])

    def move(self, x: float, y: float) -> None:
        """Move the mouse to a share of the window."""
        self.xdo("mousemove", *self.place(x, y))

    def click(self, x: float, y: float, *keys: str) -> None:
        """Click at a share of the window while `keys` are held; a hand is slower than a program."""
        held = [word for key in keys for word in ("keydown", key)]
        free = [word for key in keys for word in ("keyup", key)]
        where = ("mousemove", *self.place(x, y), "sleep", 0.2)
        self.xdo(*where, *held, "sleep", 0.1, "mousedown", 1, "sleep", 0.2, "mouseup", 1, "sleep", 0.2, *free)

    def drag(self, start: tuple[float, float], *through: tuple[float, float], button: int = 1) -> None:
        """Press a button at a share of the window, move, release."""
        self.xdo("mousemove", *self.place(*start), "sleep", 0.2, "mousedown", button, "sleep", 0.2)
        for point in through:
            self.xdo("mousemove", *self.place(*point), "sleep", 0.1)
        self.xdo("mouseup", button)

    def type_path(self, path: str) -> None:
        """Open a file by typing its path."""
        self.key("ctrl+shift+o")
        time.sleep(1.0)
        self.key("ctrl+a")
        self.xdo("type", "--delay", "20", path)
        self.key("Return")

    def said(self) -> list[str]:
        """The log so far."""
        lines = self.log.read_text(encoding="utf-8").splitlines() if self.log.exists() else []
        return [line[11:] for line in lines]

    def wait(
        self, pattern: str, *, since: int = 0, act: Callable[[], object] = lambda: None, again_s: float = 12.0,
        good: Callable[[re.Match[str]], bool] = lambda match: True,
    ) -> re.Match[str]:  # fmt: skip
        """Wait until a line of the log from number `since` on matches, and return the last match that is `good`.

        `act` is what brings it about, and is done again when nothing comes of it: a key may be lost on a busy machine.
        """
        deadline, act_at = time.monotonic() + PATIENCE_S, 0.0
        while True:
            found = [m for m in (re.search(pattern, line) for line in self.said()[since:]) if m and good(m)]
            if found:
                return found[-1]
            if self.process.poll() is not None or time.monotonic() > deadline:
                raise AssertionError(f"not seen: {pattern}\n" + "\n".join(self.said()[-15:]) + self.complaints())
            if time.monotonic() > act_at:
                act()
                act_at = time.monotonic() + again_s
            time.sleep(0.1)

    def after(self, act: Callable[[], object], pattern: str, **how: object) -> re.Match[str]:
        """Do `act` and wait for a line that it brings about."""
        return self.wait(pattern, since=len(self.said()), act=act, **how)  # type: ignore[arg-type]

    def saved(self, chord: str, kind: str = r"dofview-\d") -> Path:
        """Press a key that saves a file, and return its path; a slow one may come after the next of another `kind`."""
        return Path(self.after(lambda: self.key(chord), rf"^saved (\S*{kind}\S*)")[1].rstrip(":"))

    def seen(self) -> np.ndarray:
        """What the window shows, (h, w, 3) float 0 to 255."""
        return np.asarray(Image.open(self.saved("F12", "dofview-window")).convert("RGB")).astype(float)

    def complaints(self) -> str:
        """What it wrote to its standard error."""
        self.errors.flush()
        return Path(self.errors.name).read_text()

    def quit(self) -> int:
        """Press Ctrl+Q until the program has ended, and return its exit status."""
        for _ in range(9):
            self.key("ctrl+q")
            with contextlib.suppress(subprocess.TimeoutExpired):
                return self.process.wait(timeout=10)
        raise AssertionError("the window did not close")

    def close(self) -> None:
        """End it in any way."""
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait(timeout=10)
        self.errors.close()
