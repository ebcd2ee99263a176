"""Use the real window for some minutes and count what it holds: python tests/soak.py [MINUTES] [--trace]; not a test.

Every round drags, zooms, moves the focus, goes through all methods, reloads the scene, hides the panels and resizes the
window at random, then comes back to the same window and scene. There the program counts what is alive in it, and the
processor time of the frames of a fixed drag is read from its log, so that neither what the C library keeps nor what
else the machine does is taken for growth. `--trace` says which lines of Python hold more at the end than after a third
(and is slow). Needs Xvfb and xdotool; Linux only.
"""

from __future__ import annotations

import gc
import json
import random
import signal
import statistics
import sys
import tempfile
import time
import tracemalloc
from collections.abc import Callable
from pathlib import Path

ROOT = Path(__file__).parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "tests")]
from real_window import Window, screen  # noqa: E402

from dofview.gl.context import Gpu  # noqa: E402
from dofview.methods import METHODS  # noqa: E402
from dofview.stress.living import alive, live_objects  # noqa: E402

HOME_SIZE = (700, 500)
MOST_MB, MOST_DRIFT = 20.0, 0.05
WARM_UP = 3
"""Rounds in which panels come up for the first time; before them, every method at every size."""
random.seed(1)
SIZES = tuple((random.randint(80, 1000), random.randint(60, 700)) for _ in range(12))
DRAGGED = tuple((150 + 7 * step, 250 + 3 * step) for step in range(1, 16))


class Soaked(Window):
    """A window that answers a signal with what is alive in it."""

    def __init__(self, environment: dict[str, str], folder: Path, trace: bool):
        self.answer = folder / "alive.json"
        self.program = (str(Path(__file__)), "--window", str(self.answer), *(("--trace",) if trace else ()))
        super().__init__(environment, folder, HOME_SIZE, "demo:crossing", "--method", "mipmap", "--safe")
        self.name = self.xdo("search", "--sync", "--onlyvisible", "--name", "dofview").split()[0]

    def resize(self, width: int, height: int) -> None:
        self.xdo("windowsize", self.name, width, height, "sleep", 0.3)

    def warm_up(self) -> None:
        """Every method at every size: the shaders that they need are kept, each with some of the driver's memory."""
        for size in SIZES:
            self.resize(*size)
            self.every_method()
        self.resize(*HOME_SIZE)

    def every_method(self) -> None:
        """All of them in turn, from mipmap to mipmap."""
        for name in (*METHODS[METHODS.index("mipmap") + 1 :], *METHODS[: METHODS.index("mipmap") + 1]):
            what = "settings: method accumulation" if name == "accumulation" else f"^rendered {name} "
            self.after(lambda: self.key("m"), what, again_s=60.0)

    def turn(self, steps: int) -> None:
        self.xdo("mousemove", 150, 250, "sleep", 0.2, "mousedown", 1)
        for step in range(steps):
            self.xdo("mousemove", 150 + 5 * (step % 20), 250 + 2 * (step % 10), "sleep", 0.05)
        self.xdo("mouseup", 1)

    def round(self) -> None:
        """A bit of everything, and back."""
        for size in random.sample(SIZES, 3):
            self.resize(*size)
        self.resize(*HOME_SIZE)
        self.turn(10)
        self.xdo("mousemove", 200, 250, "click", 4, "click", 5, "keydown", "ctrl", "click", 1, "click", 4, "click", 5,
                 "keyup", "ctrl")  # fmt: skip
        self.every_method()
        self.xdo("key", "h", "sleep", 0.4, "key", "h", "sleep", 0.4)
        self.after(lambda: self.key("ctrl+r"), r"^demo:crossing: \d+ triangles")
        self.after(lambda: self.key("Home"), "^rendered mipmap", again_s=60.0)

    def frames_ms(self) -> list[float]:
        """Processor time of the frames of a drag: the next place is moved to when the picture of the last is there, so
        that they are the same frames each time."""
        self.xdo("mousemove", 150, 250, "sleep", 0.2, "mousedown", 1, "sleep", 0.2)
        found = [
            self.after(lambda place=place: self.xdo("mousemove", *place), r"^rendered mipmap .*, ([\d.]+) of the")
            for place in DRAGGED
        ]
        self.xdo("mouseup", 1)
        return [float(match[1]) for match in found]

    def held(self) -> dict:
        """What is alive, as the program counts it."""
        self.answer.unlink(missing_ok=True)
        self.process.send_signal(signal.SIGUSR1)
        deadline = time.monotonic() + 60.0
        while not self.answer.exists():
            assert self.process.poll() is None and time.monotonic() < deadline, "no answer"
            time.sleep(0.1)
        return json.loads(self.answer.read_text())


def answering(path: Path, trace: bool) -> Callable[[int, object], None]:
    """A handler that writes what is alive to `path`; Python calls it between frames, where the context is current."""
    snapshots: list[tracemalloc.Snapshot] = []

    def answer(number: int, stack: object) -> None:
        gpu = next(thing for thing in gc.get_objects() if isinstance(thing, Gpu))
        kinds = live_objects(gpu.ctx) or {}
        shaders = kinds.get("Program", 0) + kinds.get("VertexArray", 0)
        found = {**alive(gpu.ctx)._asdict(), "kinds": kinds, "blocks": sys.getallocatedblocks()}
        # Shader variants are kept on purpose, each with its vertex array; that they end, the kinds show.
        found["objects"] -= shaders
        if trace:
            snapshots.append(tracemalloc.take_snapshot())
            then = snapshots[len(snapshots) // 3]
            found["lines"] = [str(line) for line in snapshots[-1].compare_to(then, "lineno")[:12]]
        part = path.with_suffix(".part")
        part.write_text(json.dumps(found))
        part.rename(path)

    if trace:
        tracemalloc.start()
    return answer


def soak(minutes: float, trace: bool) -> int:
    rounds = []
    with tempfile.TemporaryDirectory() as name, screen(Path(name), (1000, 700)) as environment:
        # What the C library keeps for later would hide a leak, or look like one.
        environment |= {"MALLOC_ARENA_MAX": "1", "MALLOC_MMAP_THRESHOLD_": "131072"}
        window = Soaked(environment, Path(name), trace)
        try:
            window.warm_up()
            deadline = time.monotonic() + 60.0 * minutes
            while time.monotonic() < deadline or len(rounds) < WARM_UP + 2:
                window.round()
                frames = window.frames_ms()
                rounds.append({**window.held(), "ms": statistics.median(frames)})
                print("{memory_kb:.0f} kB, {objects} objects, {blocks} blocks, {files} files, {threads} threads, "
                      "{ms:.1f} ms, {kinds}".format(**rounds[-1]), flush=True)  # fmt: skip
            status = window.quit()
            complaints = window.complaints()
        finally:
            window.close()
    print(*rounds[-1].get("lines", []), sep="\n")
    return judged(rounds[WARM_UP:], status, complaints)


def judged(rounds: list[dict], status: int, complaints: str) -> int:
    """Compare the first and the last third: exit status 1 when something grew."""
    third = max(len(rounds) // 3, 1)
    first, last = rounds[:third], rounds[-third:]

    def change(what: str, of: Callable = statistics.median) -> float:
        return of(r[what] for r in last) - of(r[what] for r in first)

    megabytes = change("memory_kb") / 1024.0
    drift = change("ms") / statistics.median(r["ms"] for r in first)
    counts = {what: change(what, min) for what in ("objects", "files", "threads", "children")}
    print(f"{len(rounds)} rounds, exit status {status}: memory {megabytes:+.1f} MB, "
          f"{', '.join(f'{what} {grown:+g}' for what, grown in counts.items())}, a frame {100.0 * drift:+.1f} % "
          f"of processor time {complaints}")  # fmt: skip
    held = megabytes <= MOST_MB and drift <= MOST_DRIFT and max(counts.values()) <= 0 and not complaints
    return status or int(not held)


if __name__ == "__main__":
    if sys.argv[1] == "--window":
        answer, *rest = sys.argv[2:]
        traced = rest[0] == "--trace"
        signal.signal(signal.SIGUSR1, answering(Path(answer), traced))
        from dofview.cli import main

        sys.exit(main(rest[traced:]))
    given = [float(word) for word in sys.argv[1:] if not word.startswith("-")]
    sys.exit(soak(given[0] if given else 5.0, "--trace" in sys.argv))
