"""SSIM, FLIP and the figures of each zone of blur, worked out beside the window; pictures are read back once."""

from __future__ import annotations

import math
import threading
from collections.abc import Iterable
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
from imgui_bundle import imgui

from dofview import metrics
from dofview.errors import DofviewError
from dofview.render.reference import Quality
from dofview.viewer.actions import Action
from dofview.viewer.measurement import Measurement
from dofview.viewer.tool import Tool, Work
from dofview.viewer.truth import NO_VIEWS, REFERENCE, Truth

if TYPE_CHECKING:
    from dofview.viewer.app import App

ZONES = {"picture": "whole picture", "focus": "in focus", "foreground": "blurred foreground",
         "background": "blurred background"}  # fmt: skip
COLUMNS = ("", "PSNR", "SSIM", "FLIP", "pixels")


@dataclass(frozen=True)
class Row:
    """Figures of one zone: dB, 0…1, 0…1, and its share of the picture; nan where it is empty."""

    psnr: float
    ssim: float
    flip: float
    share: float


@dataclass(frozen=True)
class Verdict:
    """What was found, for which picture and against which reference."""

    of: object = None
    method: str = ""
    quality: Quality = NO_VIEWS
    rows: dict[str, Row] = field(default_factory=dict)


class Judge(Tool):
    """Judges the picture in use on demand."""

    title = "SSIM, FLIP and zones"

    def __init__(self) -> None:
        self.verdict = Verdict()
        self.wanted = False
        self.done = 0
        self._worker = ThreadPoolExecutor(max_workers=1, thread_name_prefix="judge")
        self._running: Future[Verdict] | None = None
        self._stop = threading.Event()

    def actions(self) -> tuple[Action, ...]:
        return (
            Action("SSIM, FLIP and zones", int(imgui.Key.j), "J",
                   "Judge the picture once the reference is good enough, as a whole and by zones of blur.",
                   lambda app: self.ask(app), "Compare"),
        )  # fmt: skip

    @property
    def running(self) -> bool:
        """Whether the worker is at it, or the reference is still awaited."""
        return self.wanted or self._running is not None

    def ask(self, app: App) -> None:
        """Judge the picture as soon as the reference vouches for its target."""
        if app.settings.method == REFERENCE:
            app.report("the reference is not judged by itself; choose another method")
        elif not self.running:
            self.wanted, self.done = True, 0
            app.sought = self.title

    def cancel(self) -> None:
        """Leave it."""
        self.wanted = False
        self._stop.set()

    def update(self, app: App) -> None:
        if self._running is not None and self._running.done():
            self._finish(app)
        if not self.wanted:
            return
        truth = app.tool(Truth)
        truth.advance(app)
        if app.settings.method == REFERENCE:
            self.cancel()
        elif truth.done(app):
            self._start(app, truth)

    def work(self, app: App) -> Iterable[Work]:
        if self._running is not None:
            yield Work("judging", self.done / len(ZONES), self.cancel)

    def busy(self, app: App) -> bool:
        return self.wanted or (self._running is not None and self._running.done())

    def panel(self, app: App) -> None:
        if self.running:
            share = app.tool(Truth).progress if self.wanted else self.done / len(ZONES)
            imgui.progress_bar(share, (-6.0 * imgui.get_font_size(), 0.0), "reference" if self.wanted else "judging")
            imgui.same_line()
            if imgui.button("cancel##judge"):
                self.cancel()
        elif imgui.button("judge the picture##judge"):
            self.ask(app)
        if self.verdict.rows:
            self._table(app)

    def release(self) -> None:
        self._stop.set()
        self._worker.shutdown(wait=False, cancel_futures=True)

    def supported(self, app: App) -> bool:
        """Whether the verdict is of what is shown now, and the reference bears its PSNR."""
        verdict = self.verdict
        bears = Measurement(verdict.rows["picture"].psnr, verdict.quality).trustworthy
        return bears and verdict.of == _key(app)

    def _start(self, app: App, truth: Truth) -> None:
        """Read the arrays back and hand them to the worker."""
        assert app.result is not None
        frame = app.result.frame
        inverse = frame.pinhole().inverse_depth.pixels()[..., 0]
        # The CoC at the picture's own pixels: the guard band left off, the nearest sample where it was rendered larger.
        width, height = app.settings.image.size
        rows = (np.arange(height) + 0.5) * frame.inner_size[1] / height + frame.guard
        columns = (np.arange(width) + 0.5) * frame.inner_size[0] / width + frame.guard
        coc = np.asarray(frame.coc.radius_px(inverse[np.ix_(rows.astype(int), columns.astype(int))]))
        coc = coc * (height / frame.inner_size[1])
        pixels, reference = app.result.pixels(), np.ascontiguousarray(truth.picture(app).pixels()[..., :3])
        start = Verdict(_key(app), app.settings.method, truth.quality)
        self.wanted, self._stop = False, threading.Event()
        self._running = self._worker.submit(self._work, start, pixels, reference, coc, self._stop)
        self._running.add_done_callback(lambda _: app.wake())

    def _work(
        self, verdict: Verdict, pixels: np.ndarray, reference: np.ndarray, coc: np.ndarray, stop: threading.Event
    ) -> Verdict:
        """Runs in the worker: one row after another, until told to stop."""
        zones: dict[str, np.ndarray | None] = {"picture": None, **metrics.blur_zones(coc)._asdict()}
        for name, mask in zones.items():
            if stop.is_set():
                break
            verdict.rows[name] = judge(pixels, reference, mask)
            self.done = len(verdict.rows)
        return verdict

    def _finish(self, app: App) -> None:
        assert self._running is not None
        running, self._running = self._running, None
        try:
            verdict = running.result()
        except DofviewError as error:
            app.report(str(error))
            return
        if len(verdict.rows) == len(ZONES) and not self._stop.is_set():
            self.verdict = verdict

    def _table(self, app: App) -> None:
        supported = self.supported(app)
        write = imgui.text if supported else imgui.text_disabled
        write(f"{self.verdict.method}{'' if self.verdict.of == _key(app) else ', of another view or setting'}")
        if imgui.begin_table("##figures", len(COLUMNS), imgui.TableFlags_.sizing_stretch_prop):
            for title in COLUMNS:
                imgui.table_setup_column(title)
            imgui.table_headers_row()
            for name, row in self.verdict.rows.items():
                for text in (ZONES[name], *texts(row)):
                    imgui.table_next_column()
                    write(text)
            imgui.end_table()
        imgui.text_disabled(Measurement(0.0, self.verdict.quality).reference_text())


def judge(pixels: np.ndarray, reference: np.ndarray, mask: np.ndarray | None = None) -> Row:
    """Figures of a picture, (h, w, 3) linear, or of the pixels that `mask` (h, w) names."""
    if mask is not None and not mask.any():
        return Row(math.nan, math.nan, math.nan, 0.0)
    return Row(
        metrics.psnr(pixels, reference, mask), metrics.ssim(pixels, reference, mask),
        metrics.flip(pixels, reference, mask), 1.0 if mask is None else float(mask.mean()),
    )  # fmt: skip


def texts(row: Row) -> tuple[str, str, str, str]:
    """The figures as they are shown."""
    if row.share == 0.0:
        return "", "", "", "none"
    psnr = "equal" if math.isinf(row.psnr) else f"{row.psnr:.2f}"
    return psnr, f"{row.ssim:.4f}", f"{row.flip:.4f}", f"{row.share:.0%}"


def _key(app: App) -> object:
    return app.picture_key, app.tool(Truth).key(app)
