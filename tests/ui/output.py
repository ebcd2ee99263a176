"""Saving, restoring, recording, undo and redo, used through imgui's test engine in a folder of their own."""

from __future__ import annotations

import math
import os
import sys
from pathlib import Path

from host import Context, Host, drive
from imgui_bundle import imgui

from dofview.remember import read_note, read_preset
from dofview.settings import Settings
from dofview.viewer.app import App
from dofview.viewer.output import Output


def use(context: Context, app: App, host: Host) -> None:
    folder = Path.cwd()
    context.yield_(6)
    output = app.tool(Output)

    context.key_press(int(imgui.Key.mod_ctrl) | int(imgui.Key.s))
    context.yield_(4)
    (shot,) = folder.glob("dofview-*.png")
    assert read_note(shot).settings == app.settings

    before = app.settings
    lens = before.lens.model_copy(update={"focus_distance": before.lens.focus_distance * 2.0})
    app.settings = before.with_(lens=lens)
    context.yield_(4)
    context.key_press(int(imgui.Key.mod_ctrl) | int(imgui.Key.z))
    context.yield_(4)
    assert app.settings.lens == before.lens, "undo"
    context.key_press(int(imgui.Key.mod_ctrl) | int(imgui.Key.mod_shift) | int(imgui.Key.z))
    context.yield_(4)
    assert app.settings.lens == lens, "redo"

    app.open_any(str(shot))
    for _ in range(200):
        context.yield_()
        if app.settings.lens == before.lens:
            break
    assert app.settings.lens == before.lens and app.settings.method == before.method, "restored from the picture"

    context.key_press(int(imgui.Key.mod_ctrl) | int(imgui.Key.mod_shift) | int(imgui.Key.s))
    context.yield_(4)
    (preset,) = folder.glob("preset-*.toml")
    restored, complaints = read_preset(preset, Settings())
    assert not complaints and restored.lens == app.settings.lens

    output.path, output.seconds, output.fps = 1, 0.5, 10
    output.toggle(app)
    for _ in range(400):
        context.yield_()
        if not output.recording:
            break
    (film,) = folder.glob("dofview-*.mp4")
    import av

    with av.open(str(film)) as opened:
        assert sum(1 for _ in opened.decode(video=0)) == 5
    assert math.isfinite(app.settings.lens.radius) and app.settings.lens == before.lens, "a film changes no settings"


if __name__ == "__main__":
    os.chdir(sys.argv[1])
    drive(use)
    print("used every output")
