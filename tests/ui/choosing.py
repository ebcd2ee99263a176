"""The method by a budget: offered, taken, kept while the view changes little, measured anew when it changes much."""

from __future__ import annotations

from host import Context, Host, drive, press, until

from dofview.bench.pareto import front
from dofview.scene.camera import Camera
from dofview.viewer.app import App
from dofview.viewer.auto import Auto
from dofview.viewer.survey import Survey
from dofview.viewer.truth import Truth


def use(context: Context, app: App, host: Host) -> None:
    context.yield_(3)
    auto, survey = app.tool(Auto), app.tool(Survey)
    lens = app.settings.lens.model_copy(update={"radius": 0.05, "focus_distance": 5.0})
    image = app.settings.image.model_copy(update={"guard_px": 8})
    app.settings = app.settings.with_(method="pinhole", lens=lens, image=image, camera=Camera())
    context.yield_(3)
    assert auto.stale(app)
    auto.budget = auto.budget.model_copy(update={"budget_ms": 10000.0})
    press(context, "a")
    until(context, lambda: survey.running, "it measures when the view rests")
    enough(context, app)
    until(context, lambda: not survey.running, "all are measured", 170.0)
    context.yield_(3)
    records = [point.record() for point in survey.points]
    assert app.settings.method == front(records)[-1]["method"], "without a limit the best is taken"
    assert not auto.stale(app)

    fastest = min(records, key=lambda record: record["ms"])
    auto.budget = auto.budget.model_copy(update={"budget_ms": 0.1})
    context.yield_(3)
    assert app.settings.method == fastest["method"] and "nothing is within" in app.message
    limit = sorted(record["ms"] for record in front(records))[-1] * 0.999
    auto.budget = auto.budget.model_copy(update={"budget_ms": limit})
    context.yield_(3)
    assert app.settings.method == front(records)[-2]["method"], "the best within the budget"

    points = survey.points
    app.settings = app.settings.with_(lens=lens.model_copy(update={"radius": 0.06}))
    context.yield_(3)
    assert not auto.stale(app), "a little more blur is still the same view"
    app.settings = app.settings.with_(lens=lens.model_copy(update={"radius": 0.01}))
    context.yield_(2)
    assert auto.stale(app)
    until(context, lambda: survey.running, "measured anew")
    enough(context, app)
    until(context, lambda: not survey.running, "all are measured", 170.0)
    assert survey.points is not points
    press(context, "a")
    assert not auto.on
    app.settings = app.settings.with_(lens=lens)
    context.yield_(3)
    assert not app.busy, "nothing is measured that nobody asked for"


def enough(context: Context, app: App) -> None:
    """Be content with the reference so far."""
    until(context, lambda: app.tool(Truth).quality.views >= 8, "the reference grows")
    for work in app.tool(Truth).work(app):
        assert work.button == "Enough"
        work.cancel()


if __name__ == "__main__":
    drive(use)
    print("chosen")
