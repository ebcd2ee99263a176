"""The command line: files and JSON that it gives, and one line with the right status when it refuses."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from PIL import Image

from dofview.cli import flags, main
from dofview.cli.runs import Comparing
from dofview.gl.context import Gpu
from dofview.lens import Lens, Photographic
from dofview.methods import METHODS, method
from dofview.pipeline import Pipeline
from dofview.scene.load import load
from dofview.settings import ImageSettings, Settings, read_view

DEMO = "demo:crossing"
SMALL = ("--size", "48x36")
VIEW = {
    "camera": {"position": [0, 1, 6], "target": [0, 1, 0], "vfov_deg": 35, "near": 0.1, "far": 50, "roll": 3},
    "lens": {"radius": 0.05, "focus_distance": 4, "distribution": "gaussian", "maker": "unknown"},
    "image": {"size": [48, 36], "dpi": 300},
    "background_linear": [0.1, 0.2, 0.3],
    "comment": "unknown keys are ignored",
}


class Done(NamedTuple):
    status: int
    out: str
    err: str

    @property
    def facts(self) -> dict:
        """The JSON object in the last line."""
        return json.loads(self.out.splitlines()[-1])


Run = Callable[..., Done]


@pytest.fixture
def run(session_gpu: Gpu, capfd: pytest.CaptureFixture[str]) -> Run:
    """Run the command line in this process; its own OpenGL context gives way to the session's after each run."""

    def run(*arguments: str) -> Done:
        try:
            status = main([str(a) for a in arguments])
        finally:
            session_gpu.ctx.__enter__()
        return Done(status, *capfd.readouterr())

    return run


@pytest.fixture
def view(tmp_path: Path) -> Path:
    path = tmp_path / "view.json"
    path.write_text(json.dumps(VIEW))
    return path


def refused(done: Done, status: int, *words: str) -> None:
    """The command said one line, no traceback, and nothing on standard output."""
    assert done.status == status, done
    assert done.out == "" and done.err.count("\n") == 1 and done.err.startswith("dofview: "), done
    assert "Traceback" not in done.err and len(done.err) < 1000
    for word in words:
        assert word in done.err, (word, done.err)


@pytest.mark.parametrize(
    "name, steps",
    [("layered", ["frame_pinhole", "frame_peel1", "layered_front_00_layer", "layered_front_00_joined",
                  "layered_front_01_blurred", "layered_front_buffer"]),
     ("pyramid", [f"pyramid_sub-image_-1_{step}" for step in ("culled", "filled", "matte", "blurred")])],
)  # fmt: skip
def test_every_step_of_a_method_is_written_to_be_looked_at(run: Run, tmp_path: Path, name: str, steps: list[str]):
    """Whatever `inspect` keeps, beside the picture, which stays the same."""
    plain, folder = tmp_path / "plain.npy", tmp_path / "steps" / name
    common = ("render", "demo:foreground", "--method", name, "--size", "64x48")
    assert run(*common, "-o", str(plain)).status == 0
    done = run(*common, "-o", str(tmp_path / "again.npy"), "--images", str(folder))
    assert done.status == 0 and set(done.facts["images"]) == {path.name for path in folder.iterdir()}
    assert {f"{step}.png" for step in steps} <= set(done.facts["images"])
    assert np.array_equal(np.load(plain), np.load(tmp_path / "again.npy"))
    shown, step = (np.asarray(Image.open(folder / f"{name}.png")) for name in ("frame_pinhole", steps[-1]))
    assert shown[..., :3].std() > 10 and step.shape[2] == 4 and step[..., 3].min() == 0 < step[..., 3].max()
    assert run(*common, "-o", str(plain), "--images", str(plain)).status == 3


def test_render_gives_the_pipelines_picture_and_its_facts(run: Run, view: Path, tmp_path: Path, gpu: Gpu):
    """Headless equals interactive by construction: the file holds what Pipeline.render gives for the same settings."""
    out = tmp_path / "a.npy"
    done = run("render", DEMO, "--view", view, "--method", "accumulation", "--views", "4", "-o", out, "--frames", "2")
    assert done.status == 0 and done.err == ""
    pixels = np.load(out)
    assert pixels.shape == (36, 48, 3) and pixels.dtype == np.float32
    facts = done.facts
    assert facts["method"] == "accumulation" and facts["size"] == [48, 36] and facts["renderer"] == gpu.renderer
    assert facts["frames"] == 2 and facts["ms"] > 0 and facts["clock"] == "wall"
    assert facts["counts"]["geometry passes"] == 4, "the second frame keeps nothing from the first"

    settings = read_view(view, Settings()).with_(method="accumulation").with_params(views=4)
    pipeline = Pipeline(gpu, load(DEMO))
    assert np.array_equal(pipeline.render(settings).pixels(), pixels)
    pipeline.release()


def test_flags_override_the_view_file(run: Run, view: Path, tmp_path: Path):
    picture = tmp_path / "a.png"
    same = ("--method", "pinhole", "-o", picture)
    assert run("render", DEMO, "--lens", view, *same, "--size", "20x10", "--scale", "2", "--guard", "3").status == 0
    from PIL import Image

    assert Image.open(picture).size == (20, 10)
    done = run("render", DEMO, "--view", view, *same, "--guard", "3", "--scale", "0.5")
    assert done.facts["guard_px"] == 3 and done.facts["scale"] == 0.5 and done.facts["size"] == [48, 36]


def test_a_photographers_settings_are_the_same_lens(run: Run, tmp_path: Path):
    same = ("render", DEMO, *SMALL, "--method", "accumulation", "--views", "3", "--focus", "3", "-o")
    photo = Photographic(focal_length_mm=85, f_number=1.4, sensor_height_mm=24)
    assert run(*same, tmp_path / "a.npy", "--focal-length", "85", "--f-number", "1.4").status == 0
    assert run(*same, tmp_path / "b.npy", "--focal-length", "85", "--radius", repr(photo.radius())).status == 0
    assert run(*same, tmp_path / "c.npy", "--radius", repr(photo.radius())).status == 0
    a, b, c = (np.load(tmp_path / f"{name}.npy") for name in "abc")
    assert np.array_equal(a, b) and not np.array_equal(a, c)


def test_exr_and_png_are_the_same_picture(run: Run, tmp_path: Path):
    OpenEXR = pytest.importorskip("OpenEXR")
    for suffix in ("npy", "exr"):
        assert run("render", DEMO, *SMALL, "--method", "pinhole", "-o", tmp_path / f"a.{suffix}").status == 0
    with OpenEXR.File(str(tmp_path / "a.exr")) as file:
        assert np.array_equal(file.channels()["RGB"].pixels, np.load(tmp_path / "a.npy"))


@pytest.mark.parametrize(
    ("value", "words"),
    [("nan", "from 1 to 65536"), ("-1", "from 1 to 65536"), ("", "from 1 to 65536"), ("1e999", "from 1 to 65536"),
     ("9" * 100_000, "from 1 to 65536"), ("0", "from 1 to 65536"), ("three", "a whole number"), ("2.5", "a whole")],
)  # fmt: skip
def test_a_wrong_parameter_is_refused_with_its_range(run: Run, tmp_path: Path, value: str, words: str):
    done = run("render", DEMO, "--method", "accumulation", "--views", value, "-o", tmp_path / "a.png")
    refused(done, 2, "views", "accepted:", words)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("flag", ["--radius", "--focus", "--f-number", "--scale", "--gaussian-sigma", "--rotation"])
@pytest.mark.parametrize("value", ["nan", "-1e999", "", "1e", "0x10", "true", "9" * 100_000 + "x"])
def test_a_wrong_number_is_refused(run: Run, tmp_path: Path, flag: str, value: str):
    refused(run("render", DEMO, flag, value, "-o", tmp_path / "a.png"), 2, "accepted:")


@pytest.mark.parametrize(
    "size", ["0x100", "100x0", "100000x10", "10x16385", "10", "x", "", "1.5x2", "axb", "9" * 100_000 + "x1", "٣x٣"]
)
def test_a_wrong_size_is_refused(run: Run, tmp_path: Path, size: str):
    refused(run("render", DEMO, "--size", size, "-o", tmp_path / "a.png"), 2, "size", "16384")


def test_a_size_beyond_memory_is_refused_before_it_is_rendered(run: Run, tmp_path: Path):
    done = run("render", DEMO, "--method", "pinhole", "--size", "16384x16384", "-o", tmp_path / "a.png")
    refused(done, 2, "too large", "accepted:")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("arguments", "words"),
    [(("render", DEMO, "--method", "bokeh"), [*METHODS]),
     (("methods", "bokeh"), [*METHODS]),
     (("render", DEMO, "--method", ""), [*METHODS]),
     (("render", DEMO, "--distribution", "square"), ["uniform_disc", "polygon"]),
     (("render", DEMO, "--method", "pinhole", "--views", "3"), ["unknown flag --views", "accumulation", "--radius"]),
     (("render", DEMO, "--no-such-flag"), ["unknown flag --no-such-flag", "--focus"]),
     (("render", DEMO, "--frames", "0"), ["frames", "1 to 100000"]),
     (("render", DEMO, "--radius", "1", "--f-number", "2"), ["radius and f_number"]),
     (("render", DEMO, "--camera", "7"), ["no camera '7'"]),
     (("render", "no/such.glb"), ["no/such.glb", "no such file"]),
     (("render", ""), ["not a regular file"]),
     (("render", DEMO, "--size", "-5x5"), ["--size"]),
     (("render", "demo:nothing"), ["foreground"]),
     (("render",), ["SCENE"]),
     (("info", "no/such.glb"), ["no/such.glb"]),
     (("compare", DEMO, "--methods", "pinhole,bokeh"), [*METHODS]),
     (("compare", DEMO, "--views", "0"), ["1 to 65536"])],
)  # fmt: skip
def test_bad_input_is_one_line_that_says_what_is_accepted(run: Run, tmp_path: Path, arguments: tuple, words: list):
    output = {"render": ("-o", tmp_path / "a.png"), "compare": ("--out", tmp_path / "out")}.get(arguments[0], ())
    refused(run(*arguments, *output), 2, *words)
    assert not [p for p in tmp_path.rglob("*") if p.is_file()]


@pytest.mark.parametrize(
    ("content", "words"),
    [(b"", "not a JSON"), (b"[1]", "one JSON object"), (b"\xff\xfe\x00", "not a JSON"), (b"[" * 100_000, "not a JSON"),
     (b'{"lens": 3}', "lens"), (b'{"lens": {"radius": -1}}', "radius"), (b'{"lens": {"radius": NaN}}', "radius"),
     (b'{"lens": {"radius": 1e999}}', "radius"), (b'{"lens": {"radius": "wide"}}', "radius"),
     (b'{"lens": {"distribution": "star"}}', "uniform_disc"), (b'{"lens": {"focus_distance": 0}}', "at least 1e-12"),
     (b'{"camera": {"position": [0, 1]}}', "position"), (b'{"camera": {"vfov_deg": 180}}', "below 179"),
     (b'{"camera": {"position": [1, 1, 1], "target": [1, 1, 1]}}', "same point"),
     (b'{"image": {"size": [0, 5]}}', "size"), (b'{"image": {"size": [100000, 5]}}', "size"),
     (b'{"background_linear": [1, 2]}', "background_linear"), (b'{"background_linear": "red"}', "background_linear"),
     (b'{"lens": {"radius": ' + b"9" * 1_000_000 + b"}}", "view.json")],
)  # fmt: skip
def test_a_wrong_view_file_is_refused_by_name(run: Run, tmp_path: Path, content: bytes, words: str):
    path = tmp_path / "view.json"
    path.write_bytes(content)
    refused(run("render", DEMO, "--view", path, "-o", tmp_path / "a.png"), 2, "view.json", words)


def test_a_missing_view_file_or_a_folder_is_refused(run: Run, tmp_path: Path):
    for path in (tmp_path / "none.json", tmp_path, "nul\0.json", "/dev/zero"):
        refused(run("render", DEMO, "--view", path, "-o", tmp_path / "a.png"), 2, "view file")


def test_a_truncated_glb_is_refused(run: Run, tmp_path: Path):
    (tmp_path / "cut.glb").write_bytes(b"glTF\x02\x00\x00\x00\xff\xff\x00\x00\x20")
    refused(run("render", tmp_path / "cut.glb", "-o", tmp_path / "a.png"), 2, "cut.glb")
    assert not (tmp_path / "a.png").exists()


def test_what_cannot_be_written_is_said_first(run: Run, tmp_path: Path):
    """Before the scene is read: status 3 although there is no such scene."""
    refused(run("render", "no/such.glb", "-o", tmp_path), 3, "folder")
    refused(run("render", "no/such.glb", "-o", tmp_path / "none" / "a.png"), 3, "no folder")
    (tmp_path / "file").write_text("")
    refused(run("compare", "no/such.glb", "--out", tmp_path / "file" / "out"), 3, "cannot make the folder")
    refused(run("render", "no/such.glb", "-o", tmp_path / "a.jpeg"), 2, ".exr")


def test_names_cannot_steer_the_terminal(run: Run, tmp_path: Path):
    done = run("render", "\x1b[31mred\udcff\n\u202e.glb", "-o", tmp_path / "a.png")
    refused(done, 2)
    assert done.err.rstrip("\n").isprintable() or "\ufffd" in done.err
    assert "\x1b" not in done.err and "\u202e" not in done.err


@pytest.mark.parametrize("name", METHODS)
def test_every_parameter_is_a_flag_that_arrives(name: str):
    """Each field at a value that is not its default, as text, through the parser and pydantic."""
    model = method(name).Params
    kinds = flags.fields.kind
    for field, info in model.model_fields.items():
        if kinds(info) is bool:
            text, value = str(not info.default).lower(), not info.default
        elif kinds(info) in (int, float):
            low, high, *_ = flags.fields.bounds(info)
            value = low if info.default != low else high
            text = str(value)
        else:
            value = next(member for member in kinds(info) if member != info.default)
            text = str(value.value)
        tokens = ["render", DEMO, "-o", "a.png", "--method", name, flags.fields.flag(field), text]
        assert parsed(tokens)["params"] == {field: not info.default if kinds(info) is bool else text}
        assert getattr(Settings(method=name).with_params(**parsed(tokens)["params"]).method_params, field) == value


def parsed(tokens: list[str]) -> flags.Given:
    """What was typed, without running the command."""
    from dofview.cli.app import make_app

    chosen = flags.named_method(tokens)
    _, bound, _ = make_app(chosen).parse_args(flags.joined_switches(tokens, chosen), print_error=False)
    given: flags.Given = {}
    for name, value in bound.arguments["typed"].items() if "typed" in bound.arguments else bound.arguments.items():
        title, separator, field = name.partition("__")
        if separator and value is not None:
            given.setdefault(title, {})[field] = value
    return given


def test_no_two_flags_share_a_name():
    common = [Lens, Photographic, ImageSettings, Comparing]
    taken = {"--output", "--view", "--lens", "--method", "--camera", "--out", "--methods", "--json", "--help"}
    for model in common:
        names = {n for f in model.model_fields for n in flags.NAMES.get(f, (flags.fields.flag(f),))}
        assert not names & (taken - {"--views"})
        taken |= names
    for name in METHODS:
        own = set(map(flags.fields.flag, method(name).Params.model_fields))
        assert not own & (taken - {"--views"}), name


def test_methods_lists_everything_declared(run: Run):
    listed = json.loads(run("methods", "--json").out)
    assert [one["name"] for one in listed] == list(METHODS)
    text = " ".join(run("methods").out.split())
    for one in listed:
        assert one["citation"] and one["title"]
        fields = method(one["name"]).Params.model_fields
        assert [row["name"] for row in one["parameters"]] == list(fields)
        for row in one["parameters"]:
            assert row["flag"] in text
            assert row["description"] and row["accepted"], (one["name"], row)
    assert "1 to 65536" in " ".join(run("methods", "accumulation").out.split())


def test_doctor_says_what_there_is(run: Run, gpu: Gpu):
    facts = json.loads(run("doctor", "--json").out)
    assert facts["renderer"] == gpu.renderer and facts["max_texture_size"] >= 1024 and facts["problem"] is None
    assert facts["methods"] == [name for name in METHODS if gpu.version_code >= method(name).REQUIRES_GL]
    assert gpu.renderer.split()[0] in run("doctor").out


def test_info_says_what_is_in_a_scene(run: Run):
    facts = json.loads(run("info", DEMO, "--json").out)
    assert facts["triangles"] == load(DEMO).triangle_count and facts["warnings"] == []
    assert str(facts["triangles"]) in run("info", DEMO).out


def test_compare_prints_one_table_and_writes_the_pictures(run: Run, tmp_path: Path):
    out = tmp_path / "out"
    same = ("compare", DEMO, "--size", "128x96", "--views", "16", "--methods", "pinhole,mipmap", "--out", out)
    table = run(*same).out
    assert [line.split()[0] for line in table.splitlines()[:4]] == ["method", "accumulation", "pinhole", "mipmap"]
    rows = json.loads(run(*same, "--json").out)["rows"]
    assert {p.name for p in out.iterdir()} == {Path(row["picture"]).name for row in rows}
    reference, pinhole, mipmap = rows
    assert reference["psnr"] is None and pinhole["psnr"] < mipmap["psnr"] and pinhole["ssim"] < mipmap["ssim"] <= 1


def test_a_window_without_a_screen_is_refused_with_the_way_out(run: Run, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    if sys.platform.startswith("linux"):
        refused(run(DEMO), 4, "no screen", "dofview render")


def command(*arguments: object, **variables: str) -> subprocess.CompletedProcess[str]:
    """Run `dofview` in a process of its own."""
    return subprocess.run(
        [sys.executable, "-m", "dofview", *map(str, arguments)], capture_output=True, text=True, timeout=120,
        env={**os.environ, "LP_NUM_THREADS": "1", **variables},
    )  # fmt: skip


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="Mesa's variables")
@pytest.mark.parametrize(
    ("variable", "value", "words"),
    [("__EGL_VENDOR_LIBRARY_FILENAMES", "/dev/null", "no usable OpenGL"),
     ("LIBGL_DRIVERS_PATH", "/nonexistent", "no usable OpenGL"),
     ("MESA_GL_VERSION_OVERRIDE", "2.1", "3.3")],
)  # fmt: skip
def test_without_usable_opengl_the_remedy_is_told(tmp_path: Path, variable: str, value: str, words: str):
    """The situations of a machine without a vendor library, without a driver, and with one that is too old."""
    done = command("render", DEMO, *SMALL, "-o", tmp_path / "a.png", **{variable: value})
    if done.returncode == 0:
        pytest.skip(f"this OpenGL does not heed {variable}")
    refused(Done(done.returncode, done.stdout, done.stderr), 4, words, "install")
    assert not list(tmp_path.iterdir())


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="needs a limit on memory")
def test_memory_that_is_not_there_is_one_line(tmp_path: Path, gpu: Gpu):
    """Images of 0.6 GiB each with 1.5 GiB to be had in all."""
    if not gpu.software:
        pytest.skip("limits the memory of a software rasteriser")
    import resource

    done = subprocess.run(
        [sys.executable, "-m", "dofview", "render", DEMO, "--method", "mipmap", "--size", "6000x6000",
         "-o", str(tmp_path / "a.png")], capture_output=True, text=True,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (3 << 29, 3 << 29)),
    )  # fmt: skip
    refused(Done(done.returncode, done.stdout, done.stderr), done.returncode, "memory", "smaller")
    assert done.returncode in (2, 4) and not list(tmp_path.iterdir())


def test_an_interrupt_leaves_nothing_and_says_so(tmp_path: Path):
    process = subprocess.Popen(
        [sys.executable, "-m", "dofview", "render", DEMO, "--method", "accumulation", "--views", "60000",
         "-o", str(tmp_path / "a.png")],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env={**os.environ, "LP_NUM_THREADS": "1"},
    )  # fmt: skip
    time.sleep(3.0)
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=60)
    assert process.returncode == 130 and out == "" and err == "dofview: interrupted\n"
    assert not list(tmp_path.iterdir())


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="needs /dev/full")
def test_an_output_that_cannot_be_printed_is_said():
    with open("/dev/full", "w") as full:
        done = subprocess.run(
            [sys.executable, "-m", "dofview", "methods"], stdout=full, stderr=subprocess.PIPE, text=True
        )
    assert done.returncode == 3 and done.stderr.count("\n") == 1 and "standard output" in done.stderr


def test_pick_names_a_command_that_is_understood(capsys, tmp_path):
    """Through the scene's own lens, and of its own results alone, whatever else the folder holds."""
    ask = ["pick", "demo:crossing", "--size", "32x24", "--out", str(tmp_path)]
    assert main([*ask, "--min-psnr", "10", "--coc", "2"]) == 0
    assert main([*ask, "--budget", "100000ms", "--coc", "3"]) == 0
    said, command = capsys.readouterr().out.splitlines()[-2:]
    assert "uniform disc" in said and command.startswith("dofview demo:crossing --method ")
    kept = [json.loads(line) for line in (tmp_path / "results.jsonl").read_text().splitlines()]
    best = max((r for r in kept if r["coc_px"] == 3.0), key=lambda r: r["psnr"])
    assert f"--method {best['method']} " in command and f"{best['psnr']:.1f} dB" in said
    output = str(tmp_path / "picture.png")
    assert main(["render", *command.split()[1:], "-o", output, "--size", "32x24"]) == 0
