"""Every panel of the viewer, used as a person would through imgui's test engine."""

from __future__ import annotations

import numpy as np
from host import Context, Host, drive

from dofview.methods import METHODS
from dofview.viewer.app import App
from dofview.viewer.measure import Measure


def use(context: Context, app: App, host: Host) -> None:
    context.yield_(4)
    assert app.shown is not None and app.scene_renders >= 1
    renders = app.scene_renders
    context.yield_(10)
    assert app.scene_renders == renders, "a window in which nothing changes renders nothing"

    before = host.pixels(context)
    context.set_ref("settings")
    for name in METHODS:
        context.item_click(f"**/{_title(name)}##{name}")
        context.yield_(2)
        assert app.settings.method == name
    context.item_click(f"**/{_title('pinhole')}##pinhole")

    context.item_input_value("**/focus distance##focus_distance", 3.5)
    context.yield_(2)
    assert abs(app.settings.lens.focus_distance - 3.5) < 1e-3
    context.item_input_value("**/f-number##f_number", 1.5)
    context.yield_(2)
    assert app.settings.lens.radius > 0.0

    context.item_input_value("**/exposure##exposure_ev", 2.0)
    brighter = host.pixels(context)
    renders = app.scene_renders
    assert brighter.mean() > before.mean() + 10, "exposure brightens what is shown"
    context.item_input_value("**/exposure##exposure_ev", 0.0)
    context.yield_(3)
    assert app.scene_renders == renders, "exposure renders no scene"

    context.item_check("**/compare with the reference##measuring")
    context.yield_(30)
    quality = app.tool(Measure).measurement.quality
    assert quality.views > 0 and np.isfinite(quality.self_psnr)
    context.item_uncheck("**/compare with the reference##measuring")

    camera = app.settings.camera
    context.set_ref("")
    context.mouse_move_to_pos((150, 200))
    context.mouse_down(0)
    context.mouse_move_to_pos((200, 210))
    context.mouse_up(0)
    context.yield_(2)
    assert app.settings.camera != camera, "dragging orbits"
    assert abs(app.settings.camera.distance - camera.distance) < 1e-6 * camera.distance
    context.key_press(_key("home"))
    context.yield_(2)
    assert app.settings.camera == camera, "Home goes back"
    context.key_press(_key("h"))
    context.yield_(2)
    assert not app.panels_shown
    context.key_press(_key("h"))

    app.open("no such file.glb")
    context.yield_(20)
    assert "no such file.glb" in app.message and app.scene.triangle_count == 8, "the last good scene stays"


def _title(name: str) -> str:
    from dofview.methods import method

    return method(name).TITLE


def _key(name: str) -> int:
    from imgui_bundle import imgui

    return int(getattr(imgui.Key, name))


if __name__ == "__main__":
    drive(use)
    print("used every panel")
