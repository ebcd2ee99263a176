"""Camera: flying, axis views, the file's cameras, pivot by double click, keys, gliding."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from host import Context, Host, drive, press, until
from imgui_bundle import imgui

from dofview.scene.camera import Camera
from dofview.scene.model import SceneCamera
from dofview.viewer.app import App
from dofview.viewer.cameras import AXES, Cameras
from dofview.viewer.store import Interface

CAMERA = Camera()


def use(context: Context, app: App, host: Host) -> None:
    context.yield_(3)
    flying(context, app)
    by_key(context, app)
    pivot(context, app)
    cameras_of_the_file(context, app)
    gliding(context, app, host)


def back_home(context: Context, app: App) -> None:
    app.settings = app.settings.with_(camera=CAMERA)
    context.yield_(2)


def flying(context: Context, app: App) -> None:
    back_home(context, app)
    context.mouse_move_to_pos((150, 220))
    context.mouse_down(1)
    context.key_down(imgui.Key.w)
    until(context, lambda: app.settings.camera.position[2] < 4.0, "W flies forward")
    context.key_up(imgui.Key.w)
    ahead = app.settings.camera
    assert np.allclose(np.subtract(ahead.position, ahead.target), (0, 0, 5)) and not app.tool(Cameras).busy(app)
    context.key_down(imgui.Key.d)
    until(context, lambda: app.settings.camera.position[0] > 0.3, "D flies right")
    context.key_up(imgui.Key.d)
    before = app.settings.camera
    context.mouse_move_to_pos((190, 220))
    turned = app.settings.camera
    assert turned.position == before.position and turned.target[0] > before.target[0], "the mouse looks around"
    method = app.settings.method
    press(context, "m")
    assert app.settings.method == method, "keys are for flying while the button is held"
    context.mouse_up(1)
    context.yield_(2)
    press(context, "m")
    assert app.settings.method != method
    press(context, "m", "shift")


def by_key(context: Context, app: App) -> None:
    for name, _, direction, key, modifier in AXES:
        press(context, key.name, *(("shift",) if modifier else ()))
        assert np.allclose(app.settings.camera.axes()[2], direction, atol=1e-6), name
    back_home(context, app)
    press(context, "left_arrow", "ctrl")
    assert app.settings.camera.position[0] < 0.0 and abs(app.settings.camera.distance - 5.0) < 1e-9
    press(context, "right_arrow", "ctrl")
    assert np.allclose(app.settings.camera.position, CAMERA.position)
    press(context, "up_arrow", "ctrl")
    assert app.settings.camera.position[1] > 0.0
    press(context, "down_arrow", "ctrl")
    press(context, "right_arrow", "ctrl", "shift")
    assert app.settings.camera.target[0] > 0.0
    press(context, "left_arrow", "ctrl", "shift")
    press(context, "page_up", "ctrl")
    assert abs(app.settings.camera.distance - 4.5) < 1e-6
    press(context, "page_down", "ctrl")
    assert np.allclose(app.settings.camera.position, CAMERA.position)
    press(context, "home")
    assert app.settings.camera == app.home.camera


def pivot(context: Context, app: App) -> None:
    back_home(context, app)
    window = imgui.internal.find_window_by_name("picture")
    middle = window.pos.x + 0.6 * window.size.x, window.pos.y + 0.45 * window.size.y
    context.mouse_move_to_pos(middle)
    context.mouse_double_click(0)
    context.yield_(2)
    camera = app.settings.camera
    assert camera.position == CAMERA.position
    assert abs(camera.target[2]) < 1e-4 and camera.target[0] > 0.1 and camera.target[1] > 0.05, "on the panel at z = 0"
    back_home(context, app)
    press(context, "p")
    assert np.allclose(app.settings.camera.target, (0, 0, 0), atol=0.02)


def cameras_of_the_file(context: Context, app: App) -> None:
    press(context, "c")
    assert "no cameras" in app.message
    above = np.eye(4)
    above[:3, :3] = [[1, 0, 0], [0, 0, 1], [0, -1, 0]]
    above[:3, 3] = (0, 9, 0)
    ahead = np.eye(4)
    ahead[:3, 3] = (0, 0, 7)
    cameras = (SceneCamera("above", above, 30.0, 0.1), SceneCamera("one ## two", ahead, 50.0, 0.1))
    app.pipeline.scene.scene = replace(app.scene, cameras=cameras)
    press(context, "c")
    assert np.allclose(app.settings.camera.position, (0, 9, 0)) and app.settings.camera.vfov_deg == 30.0
    press(context, "c")
    assert np.allclose(app.settings.camera.position, (0, 0, 7)) and app.settings.camera.vfov_deg == 50.0
    context.set_ref("settings")
    context.item_open("**/Camera")
    context.item_click("**/above##filecamera0")
    context.yield_(2)
    assert app.settings.camera.vfov_deg == 30.0
    context.item_click("**/back##view")
    context.item_input_value("**/angle of view##vfov_deg", 60.0)
    context.yield_(2)
    assert app.settings.camera.vfov_deg == 60.0 and np.allclose(app.settings.camera.axes()[2], (0, 0, -1), atol=1e-6)
    context.item_close("**/Camera")
    context.set_ref("")
    app.pipeline.scene.scene = replace(app.scene, cameras=())


def gliding(context: Context, app: App, host: Host) -> None:
    back_home(context, app)
    app.interface = Interface()
    between: list[float] = []
    host.after = lambda app: between.append(round(float(app.settings.camera.axes()[2][0]), 9))
    next(action for action in app.actions if action.name == "View from right").run(app)
    until(context, lambda: between[-1:] == [1.0], "the view from the right")
    host.after = lambda app: None
    assert between == sorted(between) and any(0.01 < x < 0.99 for x in between), "it glides there"
    context.key_press(int(imgui.Key.z))
    context.yield_(2)
    app.settings = app.settings.with_(camera=CAMERA)
    context.yield_(30)
    assert app.settings.camera == CAMERA, "who takes the camera meanwhile keeps it"
    app.interface = Interface(reduced_motion=True)


if __name__ == "__main__":
    drive(use)
    print("used the camera")
