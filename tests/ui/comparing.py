"""Wipe, flip, grid, error map and zoom, as a person uses them."""

from __future__ import annotations

import gc

import moderngl
import numpy as np
from host import Context, Host, drive, press, until
from imgui_bundle import imgui

from dofview.gl.compose import Part
from dofview.methods import METHODS
from dofview.scene.camera import Camera
from dofview.seen.headless import picture
from dofview.seen.model import Arrangement, Difference
from dofview.viewer.app import App
from dofview.viewer.browser import Browser, groups
from dofview.viewer.compare import Compare
from dofview.viewer.focusing import Focusing
from dofview.viewer.heat import Heat
from dofview.viewer.inspect import Channel
from dofview.viewer.loupe import Loupe
from dofview.viewer.pictures import Pictures
from dofview.viewer.screen import seen_of
from dofview.viewer.truth import Truth

kept: dict[str, np.ndarray] = {}


def read(context: Context, host: Host, name: str) -> np.ndarray:
    """Pixels of the image `name` of the pool, (h, w, c)."""
    kept.clear()

    def keep(app: App) -> None:
        for image in app.gpu.targets.named(name):
            if image.name == name:
                kept[name] = image.pixels().astype(float)

    host.after = keep
    until(context, lambda: name in kept, f"image {name}")
    host.after = lambda app: None
    return kept[name]


def rests(context: Context, app: App, what: str) -> None:
    """Nothing is rendered once everything is up to date."""
    until(context, lambda: not app.busy, f"{what} comes to rest", 120.0)
    context.yield_(2)
    renders = app.scene_renders
    context.yield_(8)
    assert app.scene_renders == renders, what


def use(context: Context, app: App, host: Host) -> None:
    context.yield_(3)
    lens = app.settings.lens.model_copy(update={"radius": 0.1, "focus_distance": 5.0})
    app.settings = app.settings.with_(method="mipmap", lens=lens, camera=Camera())
    wipe(context, app, host)
    flip(context, app)
    error_map(context, app, host)
    grid(context, app, host)
    loupe(context, app, host)
    as_without_a_window(context, app, host)
    nothing_grows(context, app, host)
    browser(context, app, host)


def wipe(context: Context, app: App, host: Host) -> None:
    compare = app.tool(Compare)
    compare.other = "pinhole"
    press(context, "w")
    assert compare.mode is Arrangement.WIPE
    rests(context, app, "a wipe")
    assert [placed.label for placed in app.placed] == ["mipmap", "pinhole"]
    other = read(context, host, "compare/pinhole")
    assert np.abs(other - read(context, host, "picture")).max() > 0.01, "two pictures, not one twice"
    camera, renders, rect = app.settings.camera, app.scene_renders, app.placed[0].rect
    context.mouse_move_to_pos((rect.left + 0.5 * rect.width, rect.top + 0.3 * rect.height))
    context.mouse_down(0)
    context.mouse_move_to_pos((rect.left + 0.25 * rect.width, rect.top + 0.4 * rect.height))
    context.mouse_up(0)
    context.yield_(2)
    assert abs(compare.split - 0.25) < 0.02 and app.settings.camera == camera, "the line moves, the camera does not"
    assert app.scene_renders == renders, "moving the line renders nothing"
    app.settings = app.settings.with_(lens=app.settings.lens.model_copy(update={"radius": 0.05}))
    context.yield_(3)
    assert app.scene_renders == renders + 2, "another lens: each of the two once"
    press(context, "n")
    assert compare.other == METHODS[METHODS.index("pinhole") + 2], "the next, but for the one in use"
    before = compare.other
    press(context, "u")
    assert app.settings.method == before and compare.other == "mipmap"
    press(context, "u")
    press(context, "w")
    assert compare.mode is Arrangement.ONE


def flip(context: Context, app: App) -> None:
    app.tool(Compare).other = "pinhole"
    rests(context, app, "one picture")
    context.key_down(imgui.Key.v)
    context.yield_(3)
    assert [placed.label for placed in app.placed] == ["pinhole"]
    context.key_up(imgui.Key.v)
    context.yield_(3)
    assert [placed.label for placed in app.placed] == ["mipmap"], (app.placed, app.tool(Browser).on)
    renders = app.scene_renders
    context.key_down(imgui.Key.v)
    context.yield_(3)
    context.key_up(imgui.Key.v)
    context.yield_(2)
    assert app.scene_renders == renders, "flipping back and forth renders nothing anew"


def error_map(context: Context, app: App, host: Host) -> None:
    heat, truth = app.tool(Heat), app.tool(Truth)
    press(context, "e")
    assert heat.on
    until(context, lambda: truth.quality.views > 16, "the reference grows")
    maps = {}
    for difference in Difference:
        heat.settings = heat.settings.model_copy(update={"difference": difference})
        context.yield_(2)
        maps[difference] = read(context, host, "compare/mipmap shown")
        legend = read(context, host, "seen/scale")
        assert np.ptp(legend[0].sum(axis=1)) > 200, "the legend runs from one end to the other"
    for a in Difference:
        assert maps[a].std() > 0.5, a
        assert all(np.abs(maps[a] - maps[b]).max() > 3 for b in Difference if b is not a), a
    heat.settings = heat.settings.model_copy(update={"gain": 1000.0, "difference": Difference.ABSOLUTE})
    context.yield_(2)
    assert read(context, host, "compare/mipmap shown").mean() > maps[Difference.ABSOLUTE].mean(), "gain shows more"
    app.settings = app.settings.with_(method="accumulation")
    context.yield_(2)
    assert [placed.label for placed in app.placed] == ["accumulation"], "the reference is shown as it is"
    app.settings = app.settings.with_(method="mipmap")
    press(context, "e")


def grid(context: Context, app: App, host: Host) -> None:
    press(context, "k")
    rests(context, app, "a grid")
    assert [placed.label for placed in app.placed] == list(METHODS)
    rects = [placed.rect for placed in app.placed]
    assert len({(rect.left, rect.top) for rect in rects}) == len(METHODS)
    pictures, renders = app.tool(Pictures), app.scene_renders
    app.settings = app.settings.with_(lens=app.settings.lens.model_copy(update={"radius": 0.08}))
    context.yield_(1)
    until(context, lambda: not any(pictures.outdated(app, name) for name in METHODS), "every picture follows")
    assert app.scene_renders - renders >= len(METHODS) - 1
    assert len(app.gpu.targets.named("compare/")) >= 2 * (len(METHODS) - 2)
    press(context, "e")
    until(context, lambda: app.tool(Truth).quality.views > 4, "maps of all")
    for _ in range(2):
        # The window is another size: no picture of the old one is used.
        press(context, "h")
        context.yield_(8)
    until(context, lambda: not any(pictures.outdated(app, name) for name in METHODS), "every picture in the new size")
    context.yield_(2)
    assert [placed.label for placed in app.placed] == list(METHODS)
    press(context, "e")
    press(context, "k")
    rests(context, app, "after the grid")


def loupe(context: Context, app: App, host: Host) -> None:
    tool, compare = app.tool(Loupe), app.tool(Compare)
    compare.other = "pinhole"
    press(context, "w")
    rests(context, app, "a wipe again")
    camera, renders, rect = app.settings.camera, app.scene_renders, app.placed[0].rect
    place = (float(int(rect.left + 0.6 * rect.width)), float(int(rect.top + 0.4 * rect.height)))
    context.mouse_move_to_pos(place)
    before = rect.share(imgui.ImVec2(*place))
    context.key_down(imgui.Key.mod_alt)
    context.mouse_wheel_y(4.0)
    context.yield_(2)
    assert np.isclose(app.part.width, 1.25**-4) and np.isclose(app.part.height, app.part.width)
    after = app.placed[0].rect.share(imgui.ImVec2(*place))
    assert np.allclose(before, after, atol=1e-6), "what is under the cursor stays there"
    left = app.part.left
    context.mouse_down(0)
    context.mouse_move_to_pos((place[0] - 30.0, place[1]))
    context.mouse_up(0)
    context.key_up(imgui.Key.mod_alt)
    context.yield_(2)
    assert np.isclose(app.part.left - left, 30.0 / rect.width * app.part.width, rtol=0.2), "dragging shifts it"
    assert app.settings.camera == camera and app.scene_renders == renders, "the camera stays, nothing is rendered"
    press(context, "home", "alt")
    assert app.part == Part()
    context.mouse_move_to_pos(place)
    press(context, "l")
    until(context, lambda: len(tool.lines) == 4, "pixel, two pictures and the surface")
    picture = read(context, host, "picture")
    x, y = (
        int(s * n) for s, n in zip(app.placed[0].rect.share(imgui.ImVec2(*place)), picture.shape[1::-1], strict=True)
    )
    assert tool.lines[0] == f"pixel {x}, {y}"
    found = [float(word) for word in tool.lines[1].removeprefix("mipmap: ").split()]
    assert np.allclose(found, picture[y, x, :3], rtol=1e-3)
    distance = float(tool.lines[3].split()[1].rstrip(","))
    wanted = 1.0 / app_inverse_depth(context, app, host, app.placed[0].rect.share(imgui.ImVec2(*place)))
    assert abs(distance / wanted - 1.0) < 1e-2
    press(context, "l")
    assert app.part == Part()
    press(context, "w")


def as_without_a_window(context: Context, app: App, host: Host) -> None:
    """Wipe, overlay, zoom and grid: the window's image is the one made without it, byte for byte."""
    compare, focusing = app.tool(Compare), app.tool(Focusing)
    compare.other, compare.split, focusing.shown = "pinhole", 0.3, True
    for mode in (Arrangement.WIPE, Arrangement.ONE, Arrangement.WIPE):
        compare.mode = mode
        rests(context, app, mode)
        found: dict[str, np.ndarray] = {}

        def both(app: App, found: dict[str, np.ndarray] = found) -> None:
            found["window"] = app.screen.image(app).pixels()
            found["without"] = picture(app.pipeline, app.settings, seen_of(app)).pixels()

        host.inside(context, both)
        assert (found["window"] == found["without"]).all(), mode
        app.part = Part(0.2, 0.3, 0.4, 0.4)
    app.part, focusing.shown, compare.mode = Part(), False, Arrangement.ONE
    rests(context, app, "one picture again")


def nothing_grows(context: Context, app: App, host: Host) -> None:
    """The same round of comparisons again leaves no object of OpenGL behind."""
    compare, heat, focusing, counts = app.tool(Compare), app.tool(Heat), app.tool(Focusing), []
    for _ in range(3):
        for mode in (Arrangement.WIPE, Arrangement.GRID, Arrangement.ONE):
            compare.mode, heat.on, focusing.shown = mode, mode is Arrangement.GRID, mode is Arrangement.WIPE
            press(context, "h")
            until(context, lambda: not any(app.tool(Pictures).outdated(app, n) for n in compare.names(app)), mode)
            press(context, "h")
        for radius in (0.05, 0.06, 0.08, 0.1):
            app.settings = app.settings.with_(lens=app.settings.lens.model_copy(update={"radius": radius}))
            context.yield_(3)
        host.inside(context, lambda app: counts.append(living(app)))
    assert counts[-1] == counts[-2] and counts[-1] > 20, counts
    rests(context, app, "after the rounds")


def living(app: App) -> int:
    """Objects of OpenGL that Python holds and that were not released."""
    app.gpu.ctx.gc()
    kinds = (moderngl.Texture, moderngl.TextureArray, moderngl.Framebuffer, moderngl.Renderbuffer, moderngl.Buffer,
             moderngl.VertexArray, moderngl.Program)  # fmt: skip
    found = (thing for thing in gc.get_objects() if isinstance(thing, kinds))
    return sum(not isinstance(thing.mglo, moderngl.InvalidObject) for thing in found)


def app_inverse_depth(context: Context, app: App, host: Host, share: tuple[float, float]) -> float:
    found: list[float] = []
    host.after = lambda app: found.append(app.pipeline.inverse_depth(app.settings, *share))
    until(context, lambda: bool(found), "a depth")
    host.after = lambda app: None
    return found[0]


def browser(context: Context, app: App, host: Host) -> None:
    tool = app.tool(Browser)
    assert groups(["a/level 10", "a/level 9", "b"]) == {"a/level": ["a/level 9", "a/level 10"], "b": ["b"]}
    press(context, "i")
    for name in METHODS:
        app.settings = app.settings.with_(method=name)
        until(context, lambda: not app.busy, f"{name} is rendered", 120.0)
        context.yield_(2)
        # The pool is only looked at here, between two frames.
        images = list(tool.images(app))
        assert len(images) >= 2, name
        for image in images:
            tool.choose(image)
            context.yield_(2)
            assert app.placed[0].label == image and tool.inspect.high > tool.inspect.low, (
                image,
                name,
                app.placed,
                tool.inspect,
            )
    rests(context, app, "the browser")
    app.settings = app.settings.with_(method="mipmap")
    until(context, lambda: app.settings.method == "mipmap" and not app.busy, "back")
    tool.choose("frame/pinhole")
    context.yield_(3)
    wide = read(context, host, "inspected")
    tool.inspect = tool.inspect.model_copy(update={"channel": Channel.ALPHA})
    context.yield_(3)
    alpha = read(context, host, "inspected")
    assert np.abs(alpha - wide).max() > 20 and np.allclose(alpha[..., 0], alpha[..., 1])
    press(context, "i")
    until(context, lambda: [placed.label for placed in app.placed] == ["mipmap"], "the picture is back")


if __name__ == "__main__":
    drive(use)
    print("compared")
