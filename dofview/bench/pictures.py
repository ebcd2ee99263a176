"""Small pictures for the report: what a method made, beside a heat map of how far it is from the truth."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

from dofview.export import write_whole
from dofview.metrics import srgb_encode

MOST_WIDTH = 256
HEAT_WHITE = 0.1
"""The difference, of white in sRGB, from which the heat map is at its brightest."""

# Matplotlib's inferno at nine equal steps.
_INFERNO = np.array(
    [(0, 0, 4), (31, 12, 72), (85, 15, 109), (136, 34, 106), (186, 54, 85), (227, 89, 51), (249, 140, 10),
     (249, 201, 50), (252, 255, 164)], float,
)  # fmt: skip


def heat_map(pixels: np.ndarray, truth: np.ndarray) -> np.ndarray:
    """Mean absolute difference over the channels in sRGB, 0 to `HEAT_WHITE`, as (h, w, 3) uint8 from black to white."""
    error = np.abs(srgb_encode(pixels) - srgb_encode(truth)).mean(axis=2)
    place = np.clip(error / HEAT_WHITE, 0.0, 1.0) * (len(_INFERNO) - 1)
    channels = [np.interp(place, np.arange(len(_INFERNO)), _INFERNO[:, i]) for i in range(3)]
    return np.round(np.stack(channels, axis=2)).astype(np.uint8)


def side_by_side(path: Path, pixels: np.ndarray, truth: np.ndarray) -> None:
    """Write `path`, a JPEG: the truth, the picture and its heat map, each at most `MOST_WIDTH` wide; linear RGB in."""
    shown = [np.round(255.0 * srgb_encode(p)).astype(np.uint8) for p in (truth, pixels)]
    tiles = [_small(Image.fromarray(p)) for p in (*shown, heat_map(pixels, truth))]
    whole = Image.new("RGB", (sum(t.width for t in tiles), tiles[0].height))
    for number, tile in enumerate(tiles):
        whole.paste(tile, (number * tile.width, 0))
    write_whole(path, lambda part: whole.save(part, format="JPEG", quality=88))


def sheet(path: Path, rows: list[tuple[Path, str]], columns: int = 4) -> None:
    """Write `path`, a JPEG of a scene: the truth, then each of `rows`' pictures above its heat map, with its words."""
    thirds = [_thirds(source) for source, _ in rows]
    width, height = thirds[0][0].size
    band = 16
    cells: list[tuple[Image.Image, Image.Image | None, str]] = [(thirds[0][0], None, "reference")]
    cells += [(tiles[1], tiles[2], words) for tiles, (_, words) in zip(thirds, rows, strict=True)]
    lines = -(-len(cells) // columns)
    whole = Image.new("RGB", (columns * width, lines * (2 * height + band)), "white")
    draw = ImageDraw.Draw(whole)
    for number, (picture, heat, words) in enumerate(cells):
        x, y = number % columns * width, number // columns * (2 * height + band)
        draw.text((x + 3, y + 2), words, fill="black")
        whole.paste(picture, (x, y + band))
        if heat is not None:
            whole.paste(heat, (x, y + band + height))
        else:
            _scale(draw, whole, x, y + band + height, width)
    write_whole(path, lambda part: whole.save(part, format="JPEG", quality=85))


def _thirds(path: Path) -> list[Image.Image]:
    with Image.open(path) as whole:
        width = whole.width // 3
        return [whole.crop((i * width, 0, (i + 1) * width, whole.height)) for i in range(3)]


def _scale(draw: ImageDraw.ImageDraw, whole: Image.Image, x: int, y: int, width: int) -> None:
    """What the colours of a heat map mean."""
    ramp = np.linspace(0.0, HEAT_WHITE, width - 20)[None, :, None].repeat(12, axis=0).repeat(3, axis=2)
    place = ramp[..., 0] / HEAT_WHITE * (len(_INFERNO) - 1)
    colors = np.stack([np.interp(place, np.arange(len(_INFERNO)), _INFERNO[:, i]) for i in range(3)], axis=2)
    whole.paste(Image.fromarray(np.round(colors).astype(np.uint8)), (x + 10, y + 30))
    draw.text((x + 10, y + 14), "heat maps: difference from the reference", fill="black")
    draw.text((x + 10, y + 46), "0", fill="black")
    draw.text((x + width - 70, y + 46), f"{HEAT_WHITE:g} of white", fill="black")


def _small(picture: Image.Image) -> Image.Image:
    scale = min(MOST_WIDTH / picture.width, 1.0)
    size = max(round(picture.width * scale), 1), max(round(picture.height * scale), 1)
    return picture.resize(size, Image.Resampling.BOX) if size != picture.size else picture
