"""A session in the real window, by mouse and keyboard: what a person does all day, each step with its result checked.

A test goes through it in a small window; `docs/session.py` in a large one, and keeps what is seen.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path

import av
import numpy as np
from PIL import Image
from real_window import Window

from dofview.gl.compose import Box
from dofview.gl.context import Gpu
from dofview.methods import METHODS
from dofview.pipeline import Pipeline
from dofview.remember import Remembered, read_note
from dofview.scene.load import load
from dofview.seen.layout import cells
from dofview.settings import Settings

Place = tuple[float, float]


class Session:
    """Goes through the steps in order. `near` and `far` are places of the window where the scene is at different
    depths; `keep` is given the window's picture after a step, by a name, for which a `patient` session lets the
    reference grow."""

    def __init__(
        self, window: Window, gpu: Gpu, scene: str, near: Place, far: Place,
        keep: Callable[[str, np.ndarray], None] = lambda name, pixels: None, patient: bool = False,
    ):  # fmt: skip
        self.window, self.scene, self.keep = window, scene, keep
        self.near, self.far, self.patient = near, far, patient
        self.pipeline = Pipeline(gpu, load(scene))
        self.settings = Settings()

    def run(self) -> None:
        """All of it."""
        self.open()
        self.focus_by_click()
        self.gaze()
        self.every_method()
        self.compare()
        self.grid()
        self.error_map()
        self.measure_all()
        self.record()
        self.reopen()
        self.without_panels()

    def picture(self) -> tuple[np.ndarray, Remembered, Path]:
        """The picture as it is saved, (h, w, 3), what it says of itself, and its path."""
        path = self.window.saved("ctrl+s")
        return np.asarray(Image.open(path)).astype(float), read_note(path), path

    def depth_at(self, share: tuple[float, float], radius: float = 0.006) -> float:
        """Distance of what is at a share of the window, by the same scene without a window."""
        width, height = self.settings.image.size
        x, y = self.window.place(*share)
        point = (x + 0.5) / width, (y + 0.5 - (self.window.size[1] - height)) / height
        return 1.0 / self.pipeline.inverse_depth(self.settings, *point, radius=radius)

    def headless(self, **changes: object) -> np.ndarray:
        """The same picture without a window, 0 to 255."""
        settings = self.settings.with_(**changes)
        return self.pipeline.shown(self.pipeline.render(settings), settings).astype(float)

    def open(self) -> None:
        self.window.after(lambda: self.window.type_path(self.scene), rf"^{self.scene}: \d+ triangles")
        seen, note, _ = self.picture()
        self.settings = note.settings
        assert note.spec == self.scene and note.settings.method == "mipmap"
        assert np.abs(seen - self.headless()).max() <= 1.0, "the window shows what is rendered without it"
        self.keep("opened", self.window.seen())

    def focus_by_click(self) -> None:
        distances = {}
        for place in (self.far, self.near):
            wanted = self.depth_at(place)
            self.window.after(
                lambda place=place: self.window.click(*place, "ctrl"), FOCUS, good=lambda m, w=wanted: near(m, w)
            )
            distances[place] = wanted
        assert abs(distances[self.near] / distances[self.far] - 1.0) > 0.05, "two distances"
        self.window.after(lambda: self.window.key("b"), "action: Show what is in focus")
        self.keep("focus", self.window.seen())
        self.window.after(lambda: self.window.key("b"), "action: Show what is in focus")

    def gaze(self) -> None:
        self.window.after(lambda: self.window.key("g"), "action: Gaze mode")
        for place in (self.far, self.near):
            wanted = self.depth_at(place)
            self.window.after(lambda place=place: self.window.move(*place), FOCUS, good=lambda m, w=wanted: near(m, w))
        self.keep("gaze", self.window.seen())
        self.window.after(lambda: self.window.key("g"), "action: Gaze mode")
        _, note, _ = self.picture()
        self.settings = note.settings
        assert abs(self.settings.lens.focus_distance / self.depth_at(self.near) - 1.0) < 1e-3

    def every_method(self) -> None:
        names = [*METHODS[METHODS.index("mipmap") + 1 :], *METHODS[: METHODS.index("mipmap") + 1]]
        for name in names:
            what = "settings: method accumulation" if name == "accumulation" else f"^rendered {name} "
            self.window.after(lambda: self.window.key("m"), what, again_s=60.0)
        seen, note, _ = self.picture()
        self.settings = note.settings
        assert note.settings.method == "mipmap" and np.abs(seen - self.headless()).max() <= 1.0

    def compare(self) -> None:
        """The reference beside the method; pinhole is the next of the others, and the line is dragged to the left."""
        width, height = self.settings.image.size
        split = width / self.window.size[0]
        start = len(self.window.said())
        self.window.after(lambda: self.window.key("w"), "action: Wipe")
        if self.patient:
            self.window.wait(r"^reference: \d+ views", since=start)
        self.keep("wipe", self.window.seen())
        self.window.after(lambda: self.window.key("n"), "action: Next other picture")
        self.window.drag((0.5 * split, 0.3), (0.4 * split, 0.35), (0.25 * split, 0.4))
        own, other = self.headless(), self.headless(method="pinhole")
        seen = self.window.seen()[-height:, :width]
        middle = slice(round(0.3 * height), round(0.7 * height))
        left, right = (middle, slice(4, round(0.2 * width))), (middle, slice(round(0.3 * width), width - 4))
        for part, same, unlike in ((left, own, other), (right, other, own)):
            assert np.abs(seen[part] - same[part]).mean() < 1.0 < np.abs(seen[part] - unlike[part]).mean(), part
        assert all((seen[part] == self.saved_as_seen()[part]).all() for part in (left, right)), "saved as it is shown"
        self.window.after(lambda: self.window.key("w"), "action: Wipe")

    def grid(self) -> None:
        """Every method has its picture in its cell."""
        self.window.after(lambda: self.window.key("k"), "action: Grid of all")
        width, height = self.settings.image.size
        boxes = cells(len(METHODS), Box(0, 0, width, height))[: len(METHODS)]
        for _ in range(60):
            seen = self.saved_as_seen()
            spread = [seen[b.top : b.top + b.height // 2, b.left : b.left + b.width].std() for b in boxes]
            if min(spread) > 10.0:
                break
        assert min(spread) > 10.0, spread
        self.keep("grid", seen)
        self.window.after(lambda: self.window.key("k"), "action: Grid of all")

    def saved_as_seen(self) -> np.ndarray:
        """What is seen without the interface, as it is saved, (h, w, 3)."""
        return np.asarray(Image.open(self.window.saved("ctrl+alt+s", "dofview-seen"))).astype(float)

    def error_map(self) -> None:
        width, height = self.settings.image.size
        middle = (slice(round(0.3 * height), round(0.7 * height)), slice(4, width - 4))
        plain = self.headless()
        self.window.after(lambda: self.window.key("e"), "action: Error map")
        seen = self.window.seen()
        self.keep("errors", seen)
        assert np.abs(seen[-height:, :width][middle] - plain[middle]).mean() > 20.0, "colours in place of the picture"
        self.window.after(lambda: self.window.key("e"), "action: Error map")
        assert np.abs(self.window.seen()[-height:, :width][middle] - plain[middle]).mean() < 1.0, "and back"

    def measure_all(self) -> None:
        """The reference is enough after a while: its button stands over that of the measuring itself."""
        window = self.window
        width = self.settings.image.size[0]
        enough = (width - 49.0) / window.size[0], 1.0 - 109.0 / window.size[1]
        start = len(window.said())
        window.after(lambda: window.key("F7"), "action: Measure all", again_s=60.0)
        # Once: to a slow window two clicks are a double click.
        window.wait("action: Measure all", since=start)
        if not self.patient:
            time.sleep(2.0)
            window.click(*enough)
        found = window.wait("^measured all: (.*)", since=start)[1]
        points = {name: (float(ms), float(db)) for name, ms, _, db, _ in (part.split() for part in found.split(", "))}
        assert list(points) == [name for name in METHODS if name != "accumulation"]
        assert all(ms > 0.0 and 5.0 < db < 100.0 for ms, db in points.values()), points
        assert points["multiview"][1] > points["pinhole"][1], "depth of field is nearer to the reference than none"
        window.after(lambda: window.key("t"), "action: Plots")
        for _ in range(4 if self.patient else 0):
            window.after(lambda: window.key("bracketright"), "^rendered", again_s=60.0)
            window.after(lambda: window.key("bracketleft"), "^rendered", again_s=60.0)
        self.keep("plots", window.seen())
        window.after(lambda: window.key("t"), "action: Plots")

    def record(self) -> None:
        """Two seconds of a wipe, with another focus and another method on the way."""
        window = self.window
        window.after(lambda: window.key("w"), "action: Wipe", again_s=60.0)
        begins = self.saved_as_seen()
        window.after(lambda: window.key("ctrl+m"), "action: Record", again_s=60.0)
        window.wait("^film: 1 s", act=lambda: None)
        window.after(lambda: window.key("bracketright"), "settings: lens.focus_distance", again_s=60.0)
        window.after(lambda: window.key("m"), "^rendered splatting", again_s=60.0)
        window.wait("^film: 2 s", act=lambda: None)
        found = window.after(lambda: window.key("ctrl+m"), r"^saved (\S+\.mp4): (\d+) frames", again_s=60.0)
        film, count = Path(found[1]), int(found[2])
        with av.open(str(film)) as opened:
            frames = [frame.to_ndarray(format="rgb24").astype(float) for frame in opened.decode(video=0)]
        assert len(frames) == count >= 60
        width, height = self.settings.image.size
        begun = psnr(frames[0][:height, :width], begins)
        assert begun > 35.0, f"it begins with what was seen: {begun:.1f} dB"
        assert psnr(begins, self.headless()) < 30.0, "which is two pictures"
        ends = self.saved_as_seen()
        assert psnr(frames[-1][:height, :width], ends) > 35.0 > psnr(ends, begins), "and ends with it"
        window.after(lambda: window.key("w"), "action: Wipe", again_s=60.0)

    def reopen(self) -> None:
        """The settings and pixels of a picture come back after everything was changed."""
        window = self.window
        before, note, path = self.picture()
        assert note.settings.method == "splatting"
        window.after(lambda: window.key("m"), "settings: method multiview", again_s=60.0)
        window.drag((0.2, 0.5), (0.25, 0.52), (0.3, 0.55))
        window.after(lambda: window.key("equal"), "settings: .*lens.radius", again_s=60.0)
        _, changed, _ = self.picture()
        assert changed.settings.camera != note.settings.camera
        window.after(lambda: window.type_path(str(path)), "settings: .*method splatting", again_s=30.0)
        again, restored, _ = self.picture()
        assert restored == note and np.abs(again - before).max() <= 1.0

    def without_panels(self) -> None:
        """A slider is dragged, then the panels make room for the picture."""
        window, width = self.window, self.settings.image.size[0]
        left, right = ((width + x) / window.size[0] for x in (30.0, 120.0))
        y = 63.0 / window.size[1]
        window.after(lambda: window.drag((left, y), (right, y)), FOCUS)
        window.after(lambda: window.key("h"), "action: Interface", again_s=60.0)
        for _ in range(10):
            # The place of the menus is given up a frame later.
            _, note, _ = self.picture()
            if note.settings.image.size == window.size:
                return
        raise AssertionError(f"the picture does not fill the window: {note.settings.image.size}")


FOCUS = r"settings: .*lens\.focus_distance ([\d.e+-]+)"


def near(match, wanted: float) -> bool:
    """Whether the log says this distance."""
    return abs(float(match[1]) / wanted - 1.0) < 1e-3


def psnr(a: np.ndarray, b: np.ndarray) -> float:
    """Of brightness, BT.709 of values 0 to 255, dB: a film holds colour at half the size."""
    apart = (a - b) @ [0.2126, 0.7152, 0.0722]
    return float(10.0 * np.log10(255.0**2 / max(np.mean(apart**2), 1e-9)))
