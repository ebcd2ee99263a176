"""Figures on demand, and the plots, as a person uses them."""

from __future__ import annotations

import math

import numpy as np
from host import Context, Host, drive, press, until

from dofview import metrics
from dofview.methods import METHODS
from dofview.scene.camera import Camera
from dofview.viewer.app import App
from dofview.viewer.judge import Judge
from dofview.viewer.plots import Plots, work
from dofview.viewer.survey import Survey
from dofview.viewer.truth import Truth


def use(context: Context, app: App, host: Host) -> None:
    context.yield_(3)
    lens = app.settings.lens.model_copy(update={"radius": 0.1, "focus_distance": 5.0})
    image = app.settings.image.model_copy(update={"guard_px": 8})
    app.settings = app.settings.with_(method="pinhole", lens=lens, image=image, camera=Camera())
    judging(context, app, host)
    matching(context, app)
    plots(context, app)
    measure_all(context, app)


def judging(context: Context, app: App, host: Host) -> None:
    judge, truth = app.tool(Judge), app.tool(Truth)
    press(context, "j")
    judge.cancel()
    context.yield_(2)
    assert not judge.running and not judge.verdict.rows
    press(context, "j")
    until(context, lambda: bool(judge.verdict.rows), "the verdict", 120.0)
    rows = judge.verdict.rows
    assert list(rows) == ["picture", "focus", "foreground", "background"]
    assert abs(sum(row.share for name, row in rows.items() if name != "picture") - 1.0) < 1e-9, "zones share it out"
    assert rows["focus"].psnr > rows["foreground"].psnr, "without blur, what is sharp errs least"
    found: dict[str, np.ndarray] = {}

    def keep(app: App) -> None:
        found.update(picture=app.result.pixels(), reference=truth.picture(app).pixels()[..., :3])

    host.after = keep
    until(context, lambda: bool(found), "the pictures")
    host.after = lambda app: None
    whole = rows["picture"]
    assert np.isclose(whole.psnr, metrics.psnr(found["picture"], found["reference"]), atol=0.05)
    assert np.isclose(whole.flip, metrics.flip(found["picture"], found["reference"]), atol=1e-3)
    assert judge.supported(app)
    app.settings = app.settings.with_(lens=app.settings.lens.model_copy(update={"radius": 0.12}))
    context.yield_(3)
    assert not judge.supported(app), "figures of another lens are grey"


def matching(context: Context, app: App) -> None:
    app.settings = app.settings.with_(method="mipmap")
    truth = app.tool(Truth)
    context.set_ref("settings")
    context.item_check("**/antialiased reference##antialias")
    assert truth.antialias
    context.yield_(2)
    context.item_click("**/match the antialiasing##matchscale")
    context.yield_(2)
    assert app.settings.image.scale == 2.0, "an antialiased reference wants antialiased methods"
    context.item_uncheck("**/antialiased reference##antialias")
    context.yield_(2)
    context.item_click("**/match the antialiasing##matchscale")
    context.yield_(2)
    assert app.settings.image.scale == 1.0
    key = truth.key(app)
    context.item_check("**/reference of the other lens##otherlens")
    context.yield_(2)
    assert truth.settings(app).lens.distribution != app.settings.lens.distribution
    assert truth.key(app) != key, (key, truth.key(app))
    context.item_uncheck("**/reference of the other lens##otherlens")
    context.yield_(2)
    context.item_click("**/the method's own lens##ownlens")
    context.yield_(2)
    assert app.settings.lens.distribution == "gaussian", "mipmaps blur like a Gaussian lens"
    context.set_ref("")


def plots(context: Context, app: App) -> None:
    tool = app.tool(Plots)
    assert not app.timing and not app.passes
    press(context, "t")
    for radius in (0.05, 0.06, 0.07):
        app.settings = app.settings.with_(lens=app.settings.lens.model_copy(update={"radius": radius}))
        context.yield_(3)
    assert len(tool.history) == 3 and any(name.startswith("mipmap/") for name in tool.history[-1])
    assert all(milliseconds >= 0.0 for frame in tool.history for milliseconds in frame.values())
    renders = app.scene_renders
    context.yield_(5)
    assert app.scene_renders == renders and len(tool.history) == 3, "plots render nothing"
    context.item_open("//Plots/Work done and left out##work")
    context.yield_(2)
    lines = work(app.result)
    assert "guard band of 8 px" in lines[0] and any(line.endswith(" passes") for line in lines)


def measure_all(context: Context, app: App) -> None:
    survey = app.tool(Survey)
    press(context, "f7")
    assert survey.running
    survey.cancel()
    context.yield_(2)
    assert not survey.running and not survey.points
    press(context, "f7")
    app.settings = app.settings.with_(lens=app.settings.lens.model_copy(update={"radius": 0.05}))
    context.yield_(3)
    assert not survey.running and "stopped" in app.message, "another view is another survey"
    press(context, "f7")
    until(context, lambda: not survey.running, "measure all", 170.0)
    assert [point.method for point in survey.points] == [name for name in METHODS if name != "accumulation"]
    assert all(point.ms > 0.0 and math.isfinite(point.psnr) for point in survey.points)
    psnr = {point.method: point.psnr for point in survey.points}
    assert psnr["multiview"] > psnr["pinhole"], "depth of field is nearer to the reference than none"
    context.yield_(3)
    assert not survey.outdated(app)
    press(context, "t")
    until(context, lambda: not app.timing, "nothing is timed without the plot")


if __name__ == "__main__":
    drive(use)
    print("judged")
