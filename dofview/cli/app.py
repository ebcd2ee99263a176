"""The commands and what each takes."""

from __future__ import annotations

import difflib
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

from cyclopts import App, CycloptsError, Group, Parameter
from cyclopts.exceptions import UnknownOptionError, UnusedCliTokensError

import dofview
from dofview.cli import flags
from dofview.cli.beside import Beside
from dofview.cli.flags import Given
from dofview.cli.runs import Comparing, Timing
from dofview.errors import InputError
from dofview.methods import METHODS, method

OPENS_WITH = "demo:foreground"
PACE = Group("Timing", sort_key=4)
BESIDE = Group("Comparison", sort_key=5)
COMMANDS = ("render", "record", "compare", "methods", "info", "doctor", "bench", "pick", "stress")

Spec = Annotated[str, Parameter(name="SCENE", help="A .gltf, .glb, .obj, .ply, .stl or .off file, or demo:NAME.")]
View = Annotated[
    Path | None, Parameter(name=("--view", "--lens"), help="JSON file with camera, lens, image and background.")
]
MethodName = Annotated[str | None, Parameter(name=("--method", "-m"), help=f"One of {', '.join(METHODS)}.")]
CameraName = Annotated[str | None, Parameter(name="--camera", help="A camera of the file, by name or number from 0.")]
Safe = Annotated[bool, Parameter(name="--safe", negative="", help="Read and change nothing that was saved.")]
LogFile = Annotated[Path | None, Parameter(name="--log", help="Write what is said, done and changed into this file.")]
Json = Annotated[bool, Parameter(name="--json", negative="", help="As JSON.")]


def run(tokens: Sequence[str]) -> None:
    """Run one command; every complaint comes out as a DofviewError."""
    chosen = flags.named_method(tokens)
    app = make_app(chosen)
    try:
        app(flags.joined_switches(tokens, chosen), exit_on_error=False, print_error=False)
    except UnknownOptionError as error:
        raise InputError(_unknown(error, chosen)) from error
    except UnusedCliTokensError as error:
        raise InputError(_too_many(error, tokens)) from error
    except CycloptsError as error:
        error.verbose = False
        raise InputError(f"{error}".strip().rstrip(".") + _hint(tokens)) from error


def make_app(chosen: str | None) -> App:
    """The command line in which the parameters of the method `chosen` are flags."""
    app = App(
        name="dofview", help=(dofview.__doc__ or "").splitlines()[0], version=dofview.__version__,
        result_action="return_value", help_format="plaintext", suppress_keyboard_interrupt=False,
    )  # fmt: skip
    picture = flags.of_settings(chosen)
    app.default(flags.with_flags(view, picture))
    beside = flags.of_model("beside", Beside, BESIDE)
    app.command(flags.with_flags(render, [*flags.of_model("timing", Timing, PACE), *picture, *beside]))
    app.command(flags.with_flags(record, [*picture, *beside]))
    app.command(flags.with_flags(compare, [*flags.of_model("comparing", Comparing, PACE), *flags.of_settings(None)]))
    for command in (methods, info, doctor, bench, pick, stress):
        app.command(command)
    return app


def view(
    scene: Spec = OPENS_WITH, /, *, view: View = None, method: MethodName = None, camera: CameraName = None,
    safe: Safe = False, log: LogFile = None, given: Given,
) -> None:  # fmt: skip
    """Open the viewer. Without a scene it shows a demo."""
    from dofview.cli.window import open_window

    open_window(scene, given, view=view, method=method, camera=camera, safe=safe, log=log)


def render(
    scene: Spec | None = None, /, *, output: Annotated[Path, Parameter(name=("--output", "-o"))], view: View = None,
    method: MethodName = None, camera: CameraName = None, like: Path | None = None, preset: Path | None = None,
    images: Path | None = None, given: Given,
) -> None:  # fmt: skip
    """Render one picture without a screen. The last line printed is a JSON object with its time and counts.

    Parameters
    ----------
    output
        .png (sRGB), .exr or .npy (float32 linear RGB).
    like
        A PNG or EXR saved by dofview: its scene and settings are taken, flags override them.
    preset
        A TOML preset of lens, method and parameters.
    images
        A folder for the images that the method makes on its way, every step of it, as PNG.
    """
    from dofview.cli.picture import render_to

    render_to(
        scene, output, given, view=view, method=method, camera=camera, like=like, preset=preset, images=images
    )  # fmt: skip


def record(
    scene: Spec, /, *, output: Annotated[Path, Parameter(name=("--output", "-o"))], view: View = None,
    method: MethodName = None, camera: CameraName = None, path: str = "turntable",
    seconds: float | None = None, fps: float = 30.0, focus_from: float | None = None, focus_to: float | None = None,
    keyframes: Path | None = None, gaze: Path | None = None, given: Given,
) -> None:  # fmt: skip
    """Render a film without a screen. Time is frame / fps: two runs give the same film.

    Parameters
    ----------
    output
        .mp4, .webm, .gif, or a pattern for pictures as frames/%04d.png or .exr.
    path
        turntable, rack (focus), keyframes, gaze or still.
    seconds
        Length of the film; 4, or as long as the gaze.
    keyframes
        A JSON list of views, passed through at equal times.
    gaze
        A CSV file with time_s, x, y: where somebody looked. The focus follows.
    """
    from dofview.cli.recording import record_to

    record_to(
        scene, output, given, view=view, method=method, camera=camera, kind=path, seconds=seconds, fps=fps,
        focus_from=focus_from, focus_to=focus_to, keys=keyframes, trace=gaze,
    )  # fmt: skip


def compare(
    scene: Spec = OPENS_WITH, /, *, out: Annotated[Path, Parameter(help="Folder for the pictures.")] = Path("out"),
    view: View = None, camera: CameraName = None,
    methods: Annotated[str | None, Parameter(help="Names with commas between; all when not given.")] = None,
    json: Json = False, given: Given,
) -> None:  # fmt: skip
    """Render every method and the reference into a folder, and print PSNR, SSIM and milliseconds of each."""
    from dofview.cli.comparing import compare_into

    compare_into(scene, out, given, view=view, camera=camera, methods=methods, json=json)


def methods(name: str | None = None, /, *, json: Json = False) -> None:
    """List the methods, or the parameters, ranges and source of one."""
    from dofview.cli.facts import show_methods

    show_methods(name, json)


def info(scene: Spec, /, *, json: Json = False) -> None:
    """Say what is in a scene: triangles, draws, bounds, textures, cameras, and what could not be read."""
    from dofview.cli.facts import show_scene

    show_scene(scene, json)


def doctor(*, json: Json = False) -> None:
    """Say which OpenGL there is, what it can do, and what to install when it is not enough."""
    from dofview.cli.facts import show_doctor

    show_doctor(json)


def stress(
    *, minutes: float | None = None, row: int | None = None, method: MethodName = None, seed: int = 1,
    size: int = 128, views: int = 256, rounds: int = 1, long: Annotated[bool, Parameter(negative="")] = False,
    cycles: int = 500, what: str | None = None,
) -> None:  # fmt: skip
    """Try every method under random and cornered settings and judge the pictures by invariants with stated bounds.

    Parameters
    ----------
    minutes
        How long; without it each row is tried `rounds` times.
    row
        Only this invariant, by its number.
    seed
        The first seed; each round takes the next.
    long
        Instead, do the same thing again and again, and count what is left over.
    cycles
        How often, with --long.
    what
        With --long, only this: resize, switch, reload, reload a broken file, record, screenshot.
    """
    from dofview.cli.stressing import run_long, run_stress

    if long:
        sys.exit(run_long(cycles, what, seed))
    sys.exit(run_stress(minutes, row, method, seed, size, views, rounds))


def bench(
    *, out: Path = Path("bench"), quick: Annotated[bool, Parameter(negative="")] = False, scenes: str | None = None,
    methods: str | None = None, coc: str | None = None, sizes: str | None = None, frames: int | None = None,
    views: int | None = None, scheduler: str | None = None, skips: Annotated[bool, Parameter(negative="")] = False,
    fetches: Annotated[bool, Parameter(negative="")] = False,
) -> None:  # fmt: skip
    """Measure run time against error over scenes, methods, lenses and sizes, and write a report.

    A sweep that was broken off goes on where it was. Lists are written with commas between.

    Parameters
    ----------
    out
        Folder for results and report.
    quick
        A small sweep of a few minutes.
    coc
        Mean CoC diameters, pixels.
    scheduler
        Address of a Dask scheduler whose workers measure.
    skips
        Measure instead what is left out of frames that do not need it, with and without.
    fetches
        Count instead what every method fetches, beside what its page derives.
    """
    from dofview.cli.benching import run_bench, run_fetches, run_skips

    if skips or fetches:
        (run_skips if skips else run_fetches)(out)
        return
    run_bench(
        out, small=quick, scenes=scenes, methods=methods, coc=coc, sizes=sizes, frames=frames, views=views,
        scheduler=scheduler,
    )  # fmt: skip


def pick(
    scene: Spec = OPENS_WITH, /, *, budget: str | None = None, min_psnr: float | None = None, coc: float = 16.0,
    size: str = "512x384", out: Path | None = None,
) -> None:  # fmt: skip
    """Name the method and settings to take on this machine: the best within a budget, the fastest of a quality.

    Parameters
    ----------
    budget
        Milliseconds a frame may take, as 8ms.
    coc
        Mean CoC diameter, pixels.
    """
    from dofview.cli.benching import run_pick

    run_pick(scene, budget, min_psnr, coc, size, out)


def _unknown(error: UnknownOptionError, chosen: str | None) -> str:
    flag = str(error.token.keyword or error.token.value) if error.token else str(error)
    names = [n for a in error.argument_collection or () for n in a.names if n.startswith("--")]
    having = [name for name in flags.owners(flag) if name != chosen]
    belongs = f" (a parameter of {', '.join(having)})" if having else ""
    first = [flags.fields.flag(n) for n in method(chosen).Params.model_fields] if chosen else []
    others = [n for n in dict.fromkeys(names) if n not in first and not n.startswith("--no-")]
    meant = difflib.get_close_matches(flag, [*first, *others], 1, 0.7) if not belongs else []
    asked = f", did you mean {meant[0]}?" if meant else ""
    return f"unknown flag {flag[:60]}{belongs}{asked}; accepted: {', '.join([*first, *others])}"


def _too_many(error: UnusedCliTokensError, tokens: Sequence[str]) -> str:
    """A word too many; the first one is then most often a command that is misspelt."""
    left = ", ".join(repr(token[:60]) for token in error.unused_tokens or ())
    if tokens and tokens[0] not in COMMANDS and not Path(tokens[0]).exists():
        meant = difflib.get_close_matches(tokens[0], COMMANDS, 1)
        asked = f", did you mean {meant[0]}?" if meant else ""
        return f"{tokens[0][:60]!r} is no command{asked}; accepted: {', '.join(COMMANDS)}, or one scene to view"
    return f"too much was given: {left}{_hint(tokens)}"


def _hint(tokens: Sequence[str]) -> str:
    command = next((t for t in tokens if t in COMMANDS), "")
    return f"; see dofview {command + ' ' if command else ''}--help"
