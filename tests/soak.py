"""Use the real window for some minutes and count what it holds: python tests/soak.py [MINUTES]; not part of the tests.

Every round drags, zooms, moves the focus, goes through all methods, reloads the scene, hides the panels and resizes the
window at random, then comes back to the same window and scene, where memory, open files and threads are read, and the
processor time of a fixed drag. Needs Xvfb and xdotool; Linux only.
"""

from __future__ import annotations

import os
import random
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))
from dofview.methods import METHODS  # noqa: E402

HOME_SIZE = (700, 500)


class Soaked:
    """A window on a screen of its own."""

    def __init__(self, folder: Path):
        read, write = os.pipe()
        self.server = subprocess.Popen(
            ["Xvfb", "-displayfd", str(write), "-screen", "0", "1000x700x24", "-nolisten", "tcp"],
            pass_fds=(write,), stderr=subprocess.DEVNULL,
        )  # fmt: skip
        os.close(write)
        with os.fdopen(read) as stream:
            number = stream.readline().strip()
        self.environment = {
            **os.environ, "DISPLAY": f":{number}", "HOME": str(folder), "LP_NUM_THREADS": "0",
            "PYTHONPATH": str(Path(__file__).parents[1]),
            # What the C library keeps for later would hide a leak, or look like one.
            "MALLOC_ARENA_MAX": "1", "MALLOC_TRIM_THRESHOLD_": "131072", "MALLOC_MMAP_THRESHOLD_": "131072",
        }  # fmt: skip
        self.process = subprocess.Popen(
            [sys.executable, "-m", "dofview", "demo:crossing", "--method", "mipmap", "--safe"],
            cwd=folder, env=self.environment,
        )  # fmt: skip
        self.window = self.xdo("search", "--sync", "--onlyvisible", "--name", "dofview").split()[0]

    def xdo(self, *arguments: object) -> str:
        command = ["xdotool", *map(str, arguments)]
        return subprocess.run(command, env=self.environment, capture_output=True, text=True, timeout=120).stdout

    def drag(self, steps: int) -> None:
        self.xdo("mousemove", 150, 250, "sleep", 0.2, "mousedown", 1)
        for step in range(steps):
            self.xdo("mousemove", 150 + 5 * (step % 20), 250 + 2 * (step % 10), "sleep", 0.03)
        self.xdo("mouseup", 1)

    def resize(self, width: int, height: int) -> None:
        self.xdo("windowsize", self.window, width, height, "sleep", 0.3)

    def round(self) -> None:
        """A bit of everything, and back."""
        for _ in range(3):
            self.resize(random.randint(80, 1000), random.randint(60, 700))
        self.resize(*HOME_SIZE)
        self.drag(10)
        self.xdo("mousemove", 200, 250, "click", 4, "click", 5, "keydown", "ctrl", "click", 1, "click", 4, "click", 5,
                 "keyup", "ctrl")  # fmt: skip
        for _ in METHODS:
            self.xdo("key", "m", "sleep", 0.4)
        self.xdo("key", "h", "sleep", 0.4, "key", "h", "sleep", 0.4, "key", "ctrl+r", "sleep", 1, "key", "Home")
        time.sleep(2.0)

    def seconds(self) -> float:
        """Processor time so far."""
        fields = Path(f"/proc/{self.process.pid}/stat").read_text().rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def held(self) -> tuple[float, int, int, float]:
        """Memory in MB, open files, threads, seconds of a drag."""
        before = self.seconds()
        self.drag(20)
        time.sleep(1.0)
        spent = self.seconds() - before
        folder = Path(f"/proc/{self.process.pid}")
        memory = int((folder / "statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 2**20
        return memory, len(os.listdir(folder / "fd")), len(os.listdir(folder / "task")), spent


def main(minutes: float) -> int:
    random.seed(1)
    with tempfile.TemporaryDirectory() as folder:
        soaked = Soaked(Path(folder))
        try:
            soaked.resize(*HOME_SIZE)
            time.sleep(5.0)
            deadline, found = time.monotonic() + 60.0 * minutes, []
            while time.monotonic() < deadline:
                soaked.round()
                found.append(soaked.held())
                print("{:.1f} MB, {} files, {} threads, {:.2f} s a drag".format(*found[-1]), flush=True)
            for _ in range(5):
                soaked.xdo("key", "ctrl+q", "sleep", 2)
                if soaked.process.poll() is not None:
                    break
            status = soaked.process.wait(timeout=30)
        finally:
            if soaked.process.poll() is None:
                soaked.process.terminate()
            soaked.server.terminate()
            soaked.server.wait(timeout=10)
    third = max(len(found) // 3, 1)
    first, last = ([statistics.median(column) for column in zip(*part, strict=True)]
                   for part in (found[1 : 1 + third], found[-third:]))  # fmt: skip
    print(f"{len(found)} rounds, exit status {status}: memory {last[0] - first[0]:+.1f} MB, "
          f"files {last[1] - first[1]:+g}, "
          f"threads {last[2] - first[2]:+g}, a drag {100.0 * (last[3] / first[3] - 1.0):+.1f} %")  # fmt: skip
    return status


if __name__ == "__main__":
    sys.exit(main(float(sys.argv[1]) if len(sys.argv) > 1 else 5.0))
