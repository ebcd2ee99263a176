"""What can be opened: scenes, environments, aperture pictures, views, text; recent files, last views, reload."""

from __future__ import annotations

import json
import os
import tempfile
import time
from pathlib import Path

import numpy as np
from host import Context, Host, drive, press, until
from imgui_bundle import imgui
from PIL import Image

from dofview.lens import Distribution
from dofview.viewer.app import App
from dofview.viewer.opening import Opening
from dofview.viewer.store import Store

FOLDER = Path(tempfile.mkdtemp(prefix="dofview-opening-"))
SAVED = FOLDER / "state" / "viewer.json"


def triangle(size: float) -> bytes:
    """A .glb with one triangle."""
    from gltf_files import TRIANGLE, GltfFile

    file = GltfFile()
    file.add_mesh(file.add_primitive(POSITION=TRIANGLE * np.float32(size)))
    return file.glb()


def use(context: Context, app: App, host: Host) -> None:
    context.yield_(3)
    dropped(context, app)
    views_as_text(context, app)
    scenes(context, app)
    by_dialog(context, app)
    recent(context, app)


def dropped(context: Context, app: App) -> None:
    ring = np.zeros((32, 32), np.uint8)
    ring[4:28, 4:28] = 255
    Image.fromarray(ring).save(FOLDER / "square.png")
    app.open_any(str(FOLDER / "square.png"))
    context.yield_(2)
    assert app.settings.lens.distribution == Distribution.IMAGE and app.settings.lens.image == str(
        FOLDER / "square.png"
    )

    sky = b"#?RADIANCE\n\n-Y 2 +X 4\n" + bytes([200, 100, 50, 130]) * 8
    (FOLDER / "sky.hdr").write_bytes(sky)
    app.open_any(str(FOLDER / "sky.hdr"))
    until(context, lambda: app.settings.light.environment.endswith("sky.hdr"), "the environment is read beside")
    context.yield_(2)
    good = app.settings

    (FOLDER / "broken.hdr").write_bytes(b"#?RADIANCE\n\n-Y 2 +X 4\n")
    app.open_any(str(FOLDER / "broken.hdr"))
    until(context, lambda: "broken.hdr" in app.message and "early" in app.message, "said in one line")
    (FOLDER / "black.png").write_bytes(b"no picture")
    app.open_any(str(FOLDER / "black.png"))
    assert "black.png" in app.message and "\n" not in app.message
    context.yield_(3)
    assert app.settings == good, "the last good state stays"

    view = {"lens": {"focus_distance": 7.0, "distribution": "uniform_disc"}, "light": {"environment": "sky"}}
    (FOLDER / "view.json").write_text(json.dumps(view))
    app.open_any(str(FOLDER / "view.json"))
    context.yield_(2)
    assert app.settings.lens.focus_distance == 7.0 and app.settings.light.environment == "sky"
    (FOLDER / "view.json").write_text('{"lens": {"focus_distance": -1}}')
    app.open_any(str(FOLDER / "view.json"))
    assert "focus_distance is -1" in app.message and app.settings.lens.focus_distance == 7.0


def views_as_text(context: Context, app: App) -> None:
    press(context, "c", "ctrl")
    text = imgui.get_clipboard_text()
    assert json.loads(text)["lens"]["focus_distance"] == 7.0
    before = app.settings
    app.settings = app.settings.with_(lens=app.settings.lens.model_copy(update={"focus_distance": float("inf")}))
    press(context, "x")
    context.yield_(2)
    infinite = app.settings
    press(context, "v", "ctrl")
    assert app.settings == before
    app.settings = infinite
    press(context, "c", "ctrl")
    app.settings = before
    press(context, "v", "ctrl")
    assert app.settings == infinite, "infinity is a distance"
    for wrong in ("hello", "[1]", '{"camera": {"vfov_deg": 400}}', "{" * 10000):
        imgui.set_clipboard_text(wrong)
        press(context, "v", "ctrl")
        assert app.settings == infinite and app.message
    app.settings = before


def scenes(context: Context, app: App) -> None:
    one, two = FOLDER / "one.glb", FOLDER / "two.glb"
    one.write_bytes(triangle(1.0))
    two.write_bytes(triangle(2.0))
    app.open_any(str(one))
    until(context, lambda: app.spec == str(one), "a scene is opened")
    assert app.scene.triangle_count == 1
    opened = app.settings
    press(context, "left_arrow", "ctrl")
    seen = app.settings.camera
    assert seen != opened.camera
    app.open_any(str(two))
    until(context, lambda: app.spec == str(two), "another scene")
    assert app.settings.camera != seen
    app.open_any(str(one))
    until(context, lambda: app.spec == str(one), "the first again")
    context.yield_(2)
    assert app.settings.camera == seen, "as it was last seen"
    press(context, "home")
    assert app.settings.camera == opened.camera, "Home is how it opens"

    app.settings = app.settings.with_(camera=seen)
    context.yield_(4)
    again_at = 0.0

    def changed() -> bool:
        """Whether the file was read anew; it is replaced again in case the watch did not stand yet."""
        nonlocal again_at
        if time.monotonic() > again_at:
            again_at = time.monotonic() + 4.0
            (FOLDER / "part").write_bytes(triangle(5.0))
            os.replace(FOLDER / "part", one)
        return app.scene.bounds[1].max() > 4.0

    until(context, changed, "a changed file is read anew")
    assert app.settings.camera == seen, "and the view stays"
    one.write_bytes(b"glTF no more")
    until(context, lambda: "one.glb" in app.message and "triangles" not in app.message, "a broken file is named")
    assert app.scene.bounds[1].max() > 4.0, "and the last good scene stays"


def by_dialog(context: Context, app: App) -> None:
    """A desktop's dialog that answers after a while; meanwhile frames are drawn."""
    program = FOLDER / "zenity"
    program.write_text(f"#!/bin/sh\nsleep 1\necho {FOLDER / 'two.glb'}\n")
    program.chmod(0o755)
    path = os.environ["PATH"]
    os.environ["PATH"] = f"{FOLDER}{os.pathsep}{path}"
    press(context, "o", "ctrl")
    began, frames = time.monotonic(), 0
    while not app.spec.endswith("two.glb") and time.monotonic() < began + 30.0:
        context.yield_()
        frames += 1
    os.environ["PATH"] = path
    assert app.spec.endswith("two.glb") and frames > 5
    app.open_any(str(FOLDER / "one.glb"))
    app.loader.cancel()
    context.yield_(5)
    assert app.spec.endswith("two.glb") and not app.loader.spec
    (FOLDER / "one.glb").write_bytes(triangle(1.0))
    app.open_any(str(FOLDER / "one.glb"))
    until(context, lambda: app.spec.endswith("one.glb"), "and back")


def recent(context: Context, app: App) -> None:
    names = [Path(spec).name for spec in app.store.saved.recent]
    assert names == ["one.glb", "two.glb", "demo:begin"], names
    assert Store(SAVED).saved.recent == app.store.saved.recent
    context.set_ref("##MainMenuBar")
    context.menu_click("File/Open recent/" + f"{FOLDER / 'two.glb'}##recent1".replace("/", "\\/"))
    until(context, lambda: app.spec.endswith("two.glb"), "opened from the menu")
    context.menu_click("File/Forget recent files")
    context.yield_(2)
    assert Store(SAVED).saved.recent == ()
    assert app.tool(Opening) is app.tools[-1]


if __name__ == "__main__":
    drive(use, store=Store(SAVED), spec="demo:begin")
    left = Store(SAVED)
    assert not left.problem and {Path(name).name for name in left.saved.views} == {"one.glb", "two.glb", "demo:begin"}
    print("opened everything")
