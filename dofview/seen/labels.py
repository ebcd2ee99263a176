"""Words on pictures: lines of text on a dark ground, drawn into one image from which each is placed."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from dofview.gl.compose import Box

GROUND, INK = (16, 16, 16, 176), (255, 255, 255, 255)
PADDING = 0.3
"""Around a line, shares of the text's height."""


@lru_cache(maxsize=64)
def drawn(lines: tuple[str, ...], text_px: float) -> tuple[np.ndarray, tuple[Box, ...]]:
    """`lines` below one another, (h, w, 4) uint8, and the box of each in it. Plain letters: the font has no others."""
    from PIL import Image, ImageDraw, ImageFont

    font = ImageFont.load_default(text_px)
    gap, height = round(PADDING * text_px), line_height(text_px)
    widths = [round(font.getlength(line)) + 2 * gap for line in lines]
    whole = Image.new("RGBA", (max(widths), height * len(lines)))
    brush = ImageDraw.Draw(whole)
    for row, (line, width) in enumerate(zip(lines, widths, strict=True)):
        brush.rectangle((0, row * height, width - 1, (row + 1) * height - 1), fill=GROUND)
        # Letters blend with their ground here; the canvas sees the two as one.
        brush.text((gap, (row + 0.5) * height), line, fill=INK, font=font, anchor="lm")
    return np.asarray(whole), tuple(Box(0, row * height, width, height) for row, width in enumerate(widths))


def line_height(text_px: float) -> int:
    """Pixels that a line with its ground takes."""
    return round((1.0 + 2.0 * PADDING) * text_px)
