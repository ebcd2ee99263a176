"""What the viewer says and what it is at: message and running work over the picture, all messages in a panel."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from imgui_bundle import imgui

from dofview.viewer.tool import Rect, Tool, Work
from dofview.viewer.viewport import BACKDROP

if TYPE_CHECKING:
    from dofview.viewer.app import App

MESSAGE_S = 8.0
LONGEST_EM, LEGEND_EM = 60.0, 24.0
BAR_EM = 14.0
FLOATING = (
    imgui.WindowFlags_.no_title_bar | imgui.WindowFlags_.no_move | imgui.WindowFlags_.no_saved_settings
    | imgui.WindowFlags_.always_auto_resize | imgui.WindowFlags_.no_focus_on_appearing
)  # fmt: skip


class Messages(Tool):
    """Shows the last message at the foot of the picture for a while, and above it what can be stopped."""

    title = "Messages"

    def __init__(self) -> None:
        self._written = False
        self._second = 0
        self._foot = Rect(0.0, 0.0, 1.0, 1.0)

    def over_picture(self, app: App, rect: Rect, hovered: bool) -> bool:
        place, extent = imgui.get_window_pos(), imgui.get_window_size()
        self._foot = Rect(place.x, place.y, extent.x, extent.y)
        self._written = _fresh(app)
        if self._written:
            _write(app.message, self._foot)
        return False

    def windows(self, app: App) -> None:
        self._second = int(time.monotonic())
        running = _running(app)
        if not running:
            return
        size = imgui.get_font_size()
        corner = self._foot.left + self._foot.width - 0.8 * size, self._foot.top + self._foot.height - 4.5 * size
        imgui.set_next_window_pos(corner, imgui.Cond_.always, (1.0, 1.0))
        imgui.begin("work", None, FLOATING)
        for number, work in enumerate(running):
            _row(work, number, min(BAR_EM * size, 0.5 * self._foot.width))
        imgui.end()

    def busy(self, app: App) -> bool:
        """Once more when the message has had its time; once a second for work that cannot say how far it is."""
        ticking = self._second != int(time.monotonic()) and any(work.share is None for work in _running(app))
        return ticking or (self._written and not _fresh(app))

    def panel(self, app: App) -> None:
        if not app.said:
            imgui.text_disabled("nothing yet")
        for message in reversed(app.said):
            imgui.text_wrapped(message)


def _fresh(app: App) -> bool:
    return bool(app.message) and time.monotonic() < app.said_at + MESSAGE_S


def _running(app: App) -> list[Work]:
    return [work for tool in app.tools for work in tool.work(app)]


def _row(work: Work, number: int, width: float) -> None:
    """A bar that says what it is and how far, and a button."""
    text = work.what if work.share is None else f"{work.what} {work.share:.0%}"
    imgui.progress_bar(work.share or 0.0, (width, 0.0), text)
    imgui.same_line()
    if imgui.button(f"{work.button}##work{number}"):
        work.cancel()


def _write(message: str, foot: Rect) -> None:
    """At the foot, to the right of where legends are, in as many lines as it needs."""
    size, draw_list = imgui.get_font_size(), imgui.get_window_draw_list()
    room = foot.width - (LEGEND_EM if foot.width > 2.0 * LEGEND_EM * size else 2.0) * size
    widest = max(min(LONGEST_EM * size, room), 4.0 * size)
    extent = imgui.calc_text_size(message, False, widest)
    left = foot.left + foot.width - 1.4 * size - extent.x
    top = foot.top + foot.height - 2.0 * size - extent.y
    draw_list.add_rect_filled(
        (left - 0.6 * size, top - 0.4 * size), (left + extent.x + 0.6 * size, top + extent.y + 0.4 * size),
        BACKDROP | 0xE0000000, 0.3 * size,
    )  # fmt: skip
    draw_list.add_text(imgui.get_font(), size, (left, top), 0xFFFFFFFF, message, widest)
