"""The layer that knows nothing of depth of field: blocks, shaders, targets, passes."""

from __future__ import annotations

from enum import StrEnum

import numpy as np
import pytest
from pydantic import BaseModel, ConfigDict

from dofview.errors import ShaderError
from dofview.gl.context import Gpu
from dofview.gl.filters import mean, reduce_blocks
from dofview.gl.passes import ADD, bind, draw
from dofview.gl.shaders import flatten
from dofview.gl.uniforms import block_bytes, block_glsl
from dofview.lens import Lens
from dofview.render.frame import LensBlock
from dofview.stress.living import live_objects


class Mode(StrEnum):
    FAST = "fast"
    EXACT = "exact"


class Mixed(BaseModel):
    """Every kind of field, in an order that needs padding."""

    model_config = ConfigDict(frozen=True)

    first: float = 1.5
    pair: tuple[float, float] = (2.5, 3.5)
    flag: bool = True
    direction: tuple[float, float, float] = (4.5, 5.5, 6.5)
    last: float = 7.5
    mode: Mode = Mode.EXACT
    name: str = "stays in Python"


@pytest.fixture
def shader_folder(tmp_path, monkeypatch):
    monkeypatch.setattr("dofview.gl.shaders.SHADERS", tmp_path)
    (tmp_path / "pass").mkdir()
    (tmp_path / "pass/fullscreen.vert").write_text(
        "void main(){gl_Position=vec4(gl_VertexID==1?3:-1,gl_VertexID==2?3:-1,0,1);}"
    )
    return tmp_path


def test_a_block_arrives_in_the_shader_as_it_was_declared(gpu: Gpu, shader_folder):
    (shader_folder / "read.frag").write_text(
        "#include <Mixed>\nout vec4 o;\nvoid main(){ int x = int(gl_FragCoord.x);\n"
        "o = x == 0 ? vec4(mixed.first, mixed.pair, mixed.flag) : x == 1 ? vec4(mixed.direction, mixed.last)"
        " : vec4(mixed.mode == MODE_EXACT, mixed.mode == MODE_FAST, 0, 0); }"
    )
    image = gpu.targets.image("test/block", (3, 1))
    draw(gpu, "read.frag", image, blocks={"Mixed": Mixed()})
    assert image.pixels()[0].tolist() == [[1.5, 2.5, 3.5, 1.0], [4.5, 5.5, 6.5, 7.5], [1.0, 0.0, 0.0, 0.0]]


def test_block_bytes_are_as_long_as_the_driver_says(gpu: Gpu):
    program = gpu.ctx.program(
        vertex_shader="#version 330 core\nvoid main(){gl_Position=vec4(0);}",
        fragment_shader="#version 330 core\n" + block_glsl(Mixed, "Mixed")
        + "\nout vec4 o;void main(){o=vec4(mixed.first, mixed.pair, mixed.last);}",
    )  # fmt: skip
    assert program["Mixed"].size == len(block_bytes(Mixed()))
    program.release()


def test_the_lens_is_the_same_in_glsl_and_python(gpu: Gpu, shader_folder):
    from dofview.data import SHADERS

    (shader_folder / "lens.glsl").write_text((SHADERS / "include/lens.glsl").read_text())
    (shader_folder / "ramp.frag").write_text(
        '#include "lens.glsl"\nuniform float step_;\nout float o;\n'
        "void main(){o=coc_radius(floor(gl_FragCoord.x)*step_);}"
    )
    image = gpu.targets.image("test/ramp", (256, 1), components=1)
    for lens in (Lens(radius=0.3, focus_distance=2.0), Lens(radius=0.1, focus_distance=float("inf")), Lens()):
        law = lens.coc(500.0)
        block = LensBlock(scale=law.scale, inverse_focus=law.inverse_focus, sigma=0.5)
        draw(gpu, "ramp.frag", image, blocks={"Lens": block}, values={"step_": 0.01})
        expected = law.radius_px(np.arange(256) * 0.01)
        assert np.allclose(image.pixels()[0, :, 0], expected, rtol=1e-5, atol=1e-4)


def test_a_shader_error_names_file_and_line(gpu: Gpu, shader_folder):
    (shader_folder / "part.glsl").write_text("float fine() { return 1.0; }\nfloat broken() { return undeclared; }\n")
    (shader_folder / "whole.frag").write_text('#include "part.glsl"\nout vec4 o;\nvoid main(){o=vec4(broken());}\n')
    with pytest.raises(ShaderError, match=r"part\.glsl:2: .*undeclared"):
        draw(gpu, "whole.frag", gpu.targets.image("test/error", (1, 1)))


def test_a_missing_include_says_who_asked_for_it(shader_folder):
    (shader_folder / "lonely.frag").write_text('\n#include "nowhere.glsl"\n')
    with pytest.raises(ShaderError, match=r"lonely\.frag:2: cannot read shader nowhere\.glsl"):
        flatten("lonely.frag", {}, {}, 330)


def test_reload_keeps_what_worked(gpu: Gpu, shader_folder):
    import os

    path = shader_folder / "live.frag"

    def write(value: str, stamp: int) -> None:
        path.write_text(f"out vec4 o;\nvoid main(){{o=vec4({value});}}")
        os.utime(path, (stamp, stamp))

    def shown() -> float:
        image = gpu.targets.image("test/live", (1, 1))
        draw(gpu, "live.frag", image)
        return float(image.pixels()[0, 0, 0])

    write("0.25", 2_000_000_001)
    gpu.shaders._stamp = gpu.shaders._newest()
    assert shown() == 0.25
    write("0.5", 2_000_000_002)
    assert gpu.shaders.reload() and shown() == 0.5
    write("oops", 2_000_000_003)
    assert gpu.shaders.reload() and shown() == 0.5 and "oops" in (gpu.shaders.error or "")
    gpu.shaders.release()


def test_misspelt_names_are_bugs_and_unused_ones_are_not(gpu: Gpu, shader_folder):
    (shader_folder / "names.frag").write_text(
        "uniform float used; uniform float unused;\nout vec4 o;\nvoid main(){o=vec4(used);}"
    )
    (shader_folder / "names.frag").write_text(
        "uniform float used;\nuniform float unused;\nout vec4 o;\nvoid main(){o=vec4(used);}"
    )
    program = gpu.shaders.program("pass/fullscreen.vert", "names.frag")
    bind(gpu, program, {}, {}, {"used": 1.0, "unused": 1.0})
    with pytest.raises(KeyError, match="no uniform 'usedd'"):
        bind(gpu, program, {}, {}, {"usedd": 1.0})


def test_pixels_and_write_are_inverse_with_row_0_on_top(gpu: Gpu):
    image = gpu.targets.image("test/rows", (3, 2), components=1)
    pixels = np.arange(6, dtype=np.float32).reshape(2, 3, 1)
    image.write(pixels)
    assert np.array_equal(image.pixels(), pixels)
    assert np.frombuffer(image.texture.read(), "f4")[0] == 3.0, "OpenGL's first row is the picture's last"


@pytest.mark.parametrize("size", [(1, 1), (7, 5), (64, 64), (333, 77)])
def test_reductions_are_exact_at_every_size(gpu: Gpu, size):
    values = np.random.default_rng(1).random((size[1], size[0], 4), dtype=np.float32)
    image = gpu.targets.image("test/source", size)
    image.write(values)
    assert np.allclose(mean(gpu, image), values.mean(axis=(0, 1)), rtol=1e-5)
    depth = gpu.targets.image("test/depth", size, components=1)
    inverse = np.where(values[..., :1] < 0.3, 0.0, values[..., :1])
    depth.write(inverse)
    least, greatest, empty, _ = reduce_blocks(gpu, depth, "render/depth_range.frag", "test/range")
    assert greatest == inverse.max() and bool(empty) == bool((inverse == 0).any())
    if inverse.max() > 0:
        assert least == inverse[inverse > 0].min()


def test_one_hundred_resizes_leave_nothing_behind(gpu: Gpu):
    gpu.targets.collect(keep_frames=-1)

    def frame(size):
        image, other = gpu.targets.image("test/a", size), gpu.targets.image("test/b", size, components=1)
        gpu.targets.framebuffer((image, other), depth=True).clear()
        draw(gpu, "pass/copy.frag", image, textures={"source": other}, blend=ADD)
        gpu.targets.collect()

    for step in range(4):
        frame((64 + step, 64))
    before = live_objects(gpu.ctx)
    for step in range(100):
        frame((65 + step * 7 % 50, 33 + step))
    assert live_objects(gpu.ctx) == before


def test_a_released_pool_is_no_longer_bound(gpu: Gpu):
    """moderngl binds what was bound again after it has made a framebuffer; a name that is gone would be an error."""
    other = Gpu(gpu.ctx)
    image = other.targets.image("test/other", (2, 2))
    draw(other, "pass/copy.frag", image, textures={"source": image})
    other.release()
    made = gpu.targets.framebuffer((gpu.targets.image("test/after", (3, 2)),))
    assert gpu.ctx.error == "GL_NO_ERROR" and made.size == (3, 2)


def test_display_is_srgb_of_linear_light(gpu: Gpu):
    from dofview.metrics import srgb_encode
    from dofview.render.display import Display, Tonemap, show

    ramp = np.linspace(0.0, 1.2, 64, dtype=np.float32).reshape(1, 64, 1).repeat(4, 2)
    image = gpu.targets.image("test/ramp", (64, 1))
    image.write(ramp)
    shown = show(gpu, image, Display(), "test/shown").pixels()[0, :, 0]
    assert np.abs(shown - 255.0 * srgb_encode(ramp[0, :, 0])).max() <= 0.51
    brighter = show(gpu, image, Display(exposure_ev=1.0), "test/shown").pixels()[0, :, 0]
    assert np.abs(brighter - 255.0 * srgb_encode(2.0 * ramp[0, :, 0])).max() <= 0.51
    for tonemap in Tonemap:
        curve = show(gpu, image, Display(tonemap=tonemap), "test/shown").pixels()[0, :, 0].astype(int)
        assert (np.diff(curve) >= 0).all() and curve[0] == 0, tonemap
