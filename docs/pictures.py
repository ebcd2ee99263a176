"""Make the picture on top of README.md, every method beside the reference: part of `make docs`.

It is a golden image as well: a test makes it again and compares.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from PIL import Image, ImageDraw, ImageFont

from dofview.export import to_srgb8
from dofview.framing import opening
from dofview.gl.context import Gpu, create_headless
from dofview.methods import METHODS, method
from dofview.pipeline import Pipeline
from dofview.scene.load import load

PICTURE = Path(__file__).parent / "images" / "methods.png"
SCENE = "demo:highlights"
TILE = (288, 216)
COLUMNS = 3
LABEL_PX = 18
VIEWS = 1024
"""Of the reference: fewer show as dots in the blur of lamps this bright."""
NAMES = ("accumulation", *(name for name in METHODS if name not in ("accumulation", "pinhole")))


def tiles(gpu: Gpu, names: Sequence[str] = NAMES) -> dict[str, Image.Image]:
    """The scene by each method, 8-bit sRGB."""
    scene = load(SCENE)
    settings = opening(scene, SCENE).with_(image={"size": TILE})
    ways = {name: settings.with_(method=name) for name in names}
    if "accumulation" in ways:
        ways["accumulation"] = ways["accumulation"].with_params(views=VIEWS)
    pipeline = Pipeline(gpu, scene)
    found = {name: Image.fromarray(to_srgb8(pipeline.render(way).pixels())) for name, way in ways.items()}
    pipeline.release()
    return found


def place(number: int) -> tuple[int, int]:
    """Upper left corner of a tile in the sheet."""
    return number % COLUMNS * TILE[0], number // COLUMNS * (TILE[1] + LABEL_PX)


def sheet(pictures: dict[str, Image.Image]) -> Image.Image:
    """The pictures in rows, each with its name below."""
    rows = -(-len(pictures) // COLUMNS)
    whole = Image.new("RGB", (COLUMNS * TILE[0], rows * (TILE[1] + LABEL_PX)), "white")
    text, font = ImageDraw.Draw(whole), ImageFont.load_default(12)
    for number, (name, picture) in enumerate(pictures.items()):
        x, y = place(number)
        whole.paste(picture, (x, y))
        text.text((x + 4, y + TILE[1] + 2), method(name).TITLE, fill="black", font=font)
    return whole


if __name__ == "__main__":
    gpu = create_headless()
    sheet(tiles(gpu)).save(PICTURE, optimize=True)
    print(f"wrote: {PICTURE}")
    gpu.release()
