"""Focus by click, wheel and keys, the band in focus, and gaze: with the mouse, frozen, recorded, and replayed twice."""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np
from host import Context, Host, drive, press, until
from imgui_bundle import imgui
from scenes import three_planes

from dofview import focus
from dofview.focus import GazeSettings, Look, Pull, Row, Trace
from dofview.gl.context import create_headless
from dofview.lens import focal_px
from dofview.pipeline import Pipeline
from dofview.render.display import show
from dofview.scene.camera import Camera
from dofview.settings import Settings
from dofview.viewer.app import App
from dofview.viewer.focusing import Focusing
from dofview.viewer.gaze import Gaze

PANEL, BAR, WALL = (0.6, 0.4, 0.0), (-0.6, 0.6, 2.0), (-0.1, 2.5, -5.0)
CAMERA = Camera()
replayed: dict[str, object] = {}


def place(app: App, point: tuple[float, float, float]) -> tuple[float, float]:
    """Where a point of the world stands in the picture, as shares."""
    width, height = app.settings.image.size
    pixels = focal_px(height, CAMERA.vfov_deg) / (5.0 - point[2])
    return 0.5 + point[0] * pixels / width, 0.5 - point[1] * pixels / height


def on_screen(app: App, point: tuple[float, float, float]) -> tuple[float, float]:
    """The same in imgui's coordinates; the picture fills its window."""
    window = imgui.internal.find_window_by_name("picture")
    x, y = place(app, point)
    return window.pos.x + x * window.size.x, window.pos.y + y * window.size.y


def use(context: Context, app: App, host: Host) -> None:
    context.yield_(3)
    app.settings = app.settings.with_(camera=CAMERA)
    context.yield_(3)
    by_click(context, app)
    by_wheel_and_keys(context, app)
    lenses(context, app)
    band(context, app, host)
    by_gaze(context, app)
    replay(context, app, host)


def by_click(context: Context, app: App) -> None:
    for point in (PANEL, BAR, WALL):
        context.mouse_move_to_pos(on_screen(app, point))
        context.key_down(imgui.Key.mod_ctrl)
        context.mouse_click(0)
        context.key_up(imgui.Key.mod_ctrl)
        context.yield_(2)
        assert abs(app.settings.lens.focus_distance - (5.0 - point[2])) < 1e-3, point
    assert app.settings.camera == CAMERA
    context.mouse_move_to_pos(on_screen(app, BAR))
    context.key_down(imgui.Key.f)
    context.mouse_click(0)
    context.key_up(imgui.Key.f)
    context.yield_(3)
    assert abs(app.settings.lens.focus_distance - 3.0) < 1e-3
    assert app.settings.camera == CAMERA, "F held for a click does not fit the view"
    press(context, "f")
    assert app.settings.camera != CAMERA, "F alone does"
    app.settings = app.settings.with_(camera=CAMERA.model_copy(update={"target": (0.0, 60.0, 5.0)}))
    context.yield_(2)
    context.key_down(imgui.Key.mod_ctrl)
    context.mouse_click(0)
    context.key_up(imgui.Key.mod_ctrl)
    context.yield_(2)
    assert abs(app.settings.lens.focus_distance - 3.0) < 1e-3 and "nothing there" in app.message
    app.settings = app.settings.with_(camera=CAMERA)
    context.yield_(2)


def by_wheel_and_keys(context: Context, app: App) -> None:
    before = app.settings.lens.focus_distance
    context.key_down(imgui.Key.mod_ctrl)
    context.mouse_wheel_y(-2.0)
    context.yield_(2)
    context.key_up(imgui.Key.mod_ctrl)
    context.yield_(2)
    assert abs(app.settings.lens.focus_distance / before - 1.04**2) < 1e-6 and app.settings.camera == CAMERA
    press(context, "left_bracket")
    press(context, "left_bracket")
    assert abs(app.settings.lens.focus_distance - before) < 1e-6
    press(context, "period")
    assert abs(app.settings.lens.focus_distance - 5.0) < 1e-3, "the panel stands in the middle"
    radius = app.settings.lens.radius
    press(context, "equal")
    assert app.settings.lens.radius > radius
    press(context, "minus")
    assert abs(app.settings.lens.radius - radius) < 1e-9


def lenses(context: Context, app: App) -> None:
    """The eye of the paper, whose screen decides the angle, and a camera."""
    context.set_ref("settings")
    context.item_close("Lens")
    context.item_close("Method")
    context.item_open("**/Real lenses")
    context.item_click("**/Human eye before a screen")
    context.yield_(2)
    assert abs(app.settings.lens.radius - 0.5 * 4e-3 * 17.0 / 24.0) < 1e-9
    height = app.settings.image.size[1]
    assert abs(focal_px(height, app.settings.camera.vfov_deg) - 0.32 * 3000.0) < 1e-6
    context.item_check("**/keep view##keep_view")
    angle = app.settings.camera.vfov_deg
    context.item_click("**/Portrait, 85 mm f\\/1.4")
    context.yield_(2)
    assert app.settings.camera.vfov_deg == angle and abs(app.settings.lens.radius - 0.085 / 2.8) < 1e-9
    context.item_uncheck("**/keep view##keep_view")
    context.item_close("**/Real lenses")
    context.item_open("Method")
    context.item_open("Lens")
    context.set_ref("")
    app.settings = app.settings.with_(camera=CAMERA)
    context.yield_(2)
    press(context, "period")


def band(context: Context, app: App, host: Host) -> None:
    plain = host.pixels(context)
    seen: dict[str, np.ndarray] = {}

    def read(app: App) -> None:
        overlay = app.gpu.targets.named("focus band")
        if overlay:
            seen["overlay"] = overlay[0].pixels()

    host.after = read
    press(context, "b")
    until(context, lambda: "overlay" in seen, "the band is drawn")
    context.yield_(2)
    host.after = lambda app: None
    height, width = seen["overlay"].shape[:2]

    def alpha(point: tuple[float, float, float]) -> int:
        x, y = place(app, point)
        return int(seen["overlay"][int(y * height), int(x * width), 3])

    assert alpha(PANEL) > 0 and alpha(BAR) == 0 and alpha(WALL) == 0, "the panel is in focus, the rest is not"
    assert np.array_equal(host.pixels(context), plain), "what is saved does not hold the overlay"
    renders = app.scene_renders
    context.yield_(5)
    assert app.scene_renders == renders
    press(context, "b")
    assert not app.tool(Focusing).shown


def by_gaze(context: Context, app: App) -> None:
    gaze = app.tool(Gaze)
    context.mouse_move_to_pos(on_screen(app, WALL))
    press(context, "g")
    assert gaze.on
    until(context, lambda: abs(app.settings.lens.focus_distance - 10.0) < 1e-3, "the focus follows to the wall")
    context.yield_(3)
    renders = app.scene_renders
    assert not app.busy
    context.yield_(10)
    assert app.scene_renders == renders, "a gaze at rest renders nothing"
    press(context, "g", "shift")
    context.mouse_move_to_pos(on_screen(app, BAR))
    context.yield_(15)
    assert abs(app.settings.lens.focus_distance - 10.0) < 1e-3, "frozen"
    press(context, "g", "shift")
    until(context, lambda: abs(app.settings.lens.focus_distance - 3.0) < 1e-3, "and free again")
    context.set_ref("settings")
    context.mouse_move("**/focus distance##focus_distance")
    context.yield_(15)
    assert abs(app.settings.lens.focus_distance - 3.0) < 1e-3, "over the interface nobody looks"
    context.set_ref("")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "trace.csv"
        gaze.record(app, True)
        context.mouse_move_to_pos(on_screen(app, PANEL))
        until(context, lambda: abs(app.settings.lens.focus_distance - 5.0) < 1e-3, "recording follows the gaze")
        gaze.record(app, False, path)
        trace = focus.read_trace(path)
        assert trace.rows == gaze.trace.rows and len(trace.rows) > 3 and abs(trace.start.distance - 3.0) < 1e-3
        context.mouse_move_to_pos(on_screen(app, WALL))
        app.open_any(str(path))
        assert gaze.replaying
        until(context, lambda: not gaze.on, "the replay ends")
    assert abs(app.settings.lens.focus_distance - 5.0) < 1e-3 and len(gaze.pulls) == trace.ticks(gaze.settings)


def replay(context: Context, app: App, host: Host) -> None:
    """Thirty frames over near and far, kept for the comparison with the same without a window."""
    gaze = app.tool(Gaze)
    gaze.settings = GazeSettings(rate_hz=30)
    gaze.trace = Trace(Row(n / 3, Look(place(app, p))) for n, p in enumerate((BAR, WALL, PANEL)))
    gaze.trace = Trace([*gaze.trace.rows, Row(29 / 30, gaze.trace.rows[-1].look, None)])
    app.settings = app.settings.with_(method="mipmap")
    app.settings = app.settings.with_(lens=app.settings.lens.model_copy(update={"focus_distance": 4.0, "radius": 0.1}))
    context.yield_(3)
    pictures: dict[float, np.ndarray] = {}

    def keep(app: App) -> None:
        pictures[app.result.frame.lens.focus_distance] = app.shown.pixels()

    host.after = keep
    gaze.replay(app)
    until(context, lambda: not gaze.on, "thirty frames", 120.0)
    context.yield_(2)
    host.after = lambda app: None
    replayed.update(
        settings=app.settings, trace=gaze.trace, how=gaze.settings, pulls=list(gaze.pulls), pictures=pictures
    )


def without_a_window() -> None:
    """The same replay headless: distances to 1e-9, pictures to the bit."""
    settings, trace, how = replayed["settings"], replayed["trace"], replayed["how"]
    assert isinstance(settings, Settings) and isinstance(trace, Trace) and isinstance(how, GazeSettings)
    gpu = create_headless()
    pipeline = Pipeline(gpu, three_planes())
    width, height = settings.image.size
    now = settings.with_(lens=settings.lens.model_copy(update={"focus_distance": 4.0}))
    pull, worst, picture = Pull.at(4.0), 0.0, 0
    for tick in range(30):
        depth_at = lambda x, y, now=now: pipeline.inverse_depth(now, x, y, how.depth_radius)  # noqa: E731
        pull = focus.step(pull, trace.at(tick / 30), tick, depth_at, how, width / height)
        worst = max(worst, abs(pull.distance - replayed["pulls"][tick].distance))
        now = now.with_(lens=now.lens.model_copy(update={"focus_distance": pull.distance}))
        shown = show(gpu, pipeline.render(now).image, now.display, "shown").pixels()
        picture = max(picture, int(np.abs(shown.astype(int) - replayed["pictures"][pull.distance]).max()))
    distances = [p.distance for p in replayed["pulls"]]
    assert len(distances) == 30 and min(distances) < 3.4 and max(distances) > 4.5, "the focus went near and far"
    assert worst <= 1e-9 and picture == 0, (worst, picture)
    print(f"30 frames: focus within {worst:g}, pictures within {picture} of 255")


if __name__ == "__main__":
    drive(use)
    without_a_window()
    print("used focus and gaze")
