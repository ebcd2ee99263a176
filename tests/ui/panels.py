"""Every panel of the viewer, used as a person would through imgui's test engine."""

from __future__ import annotations

import numpy as np
from host import Context, Host, drive
from imgui_bundle import imgui

from dofview.methods import METHODS
from dofview.viewer.app import App
from dofview.viewer.browser import Browser
from dofview.viewer.heat import Heat
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

    light_and_background(context, app, host)
    what_is_asked_for_comes_into_view(context, app)

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


def light_and_background(context: Context, app: App, host: Host) -> None:
    """The scene is lit by another light, and stands before another colour, as chosen in the panel."""
    before, sky = app.settings, host.pixels(context)
    for folded in ("Lens", "Method"):
        context.item_close(folded)
    renders = app.scene_renders
    _choose(context, "Picture/light##environment", "down_arrow")
    assert app.settings.light.environment == "studio", (app.message, list(app.said)[-3:])
    assert app.scene_renders > renders, "these planes shine by themselves: it is rendered, and looks the same"
    _choose(context, "Picture/light##environment", "up_arrow")
    assert (host.pixels(context) == sky).all()
    for channel in range(3):
        context.item_input_value(f"Picture/background##background/##{'XYZ'[channel]}", (0.8, 0.4, 0.2)[channel])
    context.yield_(3)
    shown = host.pixels(context)
    assert np.abs(shown - np.array([204.0, 102.0, 51.0])).max(axis=2).min() <= 1.0, "it is shown as it was chosen"
    app.settings = before
    for folded in ("Lens", "Method"):
        context.item_open(folded)
    context.yield_(2)


def what_is_asked_for_comes_into_view(context: Context, app: App) -> None:
    """A key that shows what has settings opens the panel of them and scrolls to it, and back when it is not wanted."""
    context.set_ref("settings")
    inside = {Heat: "gain##gain", Browser: "in place of the picture##inspect"}
    for key, tool in (("e", Heat), ("i", Browser)):
        context.scroll_to_top("")
        context.item_close(tool.title)
        context.scroll_to_top("")
        context.key_press(_key(key))
        context.yield_(4)
        assert context.item_info(f"{tool.title}/{inside[tool]}").rect_clipped.get_height() > 5.0, tool.title
        assert context.item_info("Lens").rect_clipped.get_height() <= 0.0
        context.key_press(_key(key))
        context.yield_(4)
        assert context.item_info("Lens").rect_clipped.get_height() > 5.0, "and back"
        context.item_close(tool.title)
    context.scroll_to_top("")
    context.yield_(2)


def _choose(context: Context, combo: str, arrow: str) -> None:
    """Take the next or the last choice of a combo, by keyboard."""
    context.item_click(combo)
    context.yield_(4)
    for key in (arrow, "enter"):
        context.key_press(_key(key))
        context.yield_(3)


def _title(name: str) -> str:
    from dofview.methods import method

    return method(name).TITLE


def _key(name: str) -> int:
    return int(getattr(imgui.Key, name))


if __name__ == "__main__":
    drive(use)
    print("used every panel")
