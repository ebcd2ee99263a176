"""The textures of the demo scenes: periodic pictures made of 1/f noise and hard edges, the same on every run.

Depth of field is judged where detail meets blur, so every picture has energy at all scales and some sharp contours.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from dofview.scene.demo.texels import SIZE, cells, grid, inside, mix, noise, picture, ramp, rgb
from dofview.scene.model import Picture


def azulejo() -> Picture:
    """Four by four glazed wall tiles, blue and ochre on cream, two motifs in turn, with grout and crazing."""
    x, y = (axis * 4 for axis in grid())
    column, row = np.floor(x).astype(int), np.floor(y).astype(int)
    px, py = 2 * (x - column) - 1, 2 * (y - row) - 1
    odd = (column + row) % 2
    radius, angle, pixel = np.hypot(px, py), np.arctan2(py, px), 8.0 / SIZE
    corner = np.hypot(1 - np.abs(px), 1 - np.abs(py))
    color = mix(
        ramp(noise(11, 1.1), ("dfd8c6", "f4efe2", "fbf8ef")), rgb("2c5a9b"), inside(np.abs(corner - 0.62) - 0.1, pixel)
    )
    color = mix(color, rgb("d9942f"), inside(corner - 0.3, pixel))
    color = mix(color, rgb("f4efe2"), inside(corner - 0.16, pixel))
    petals = radius - (0.52 + 0.16 * np.cos(8 * angle))
    flower = mix(color, rgb("1d3f7a"), inside(petals, pixel))
    flower = mix(flower, rgb("7fb2d9"), inside(radius - (0.3 + 0.1 * np.cos(8 * angle)), pixel))
    flower = mix(flower, rgb("d9942f"), inside(radius - 0.14, pixel))
    diamond = np.abs(px) + np.abs(py)
    star = mix(color, rgb("7fb2d9"), inside(diamond - 0.72, pixel))
    star = mix(star, rgb("1d3f7a"), inside(np.maximum(np.abs(px), np.abs(py)) - 0.34, pixel))
    star = mix(star, rgb("f4efe2"), inside(diamond - 0.3, pixel))
    color = mix(star, flower, odd.astype(float))
    tint = 0.9 + 0.14 * np.random.default_rng(5).random((4, 4))[row % 4, column % 4]
    _, gap = cells(17, 24)
    color = color * (tint * (0.86 + 0.28 * noise(12, 1.2)))[..., None] - 0.1 * inside(gap - 0.0006)[..., None]
    color = mix(color, ramp(noise(13), ("8d8474", "b5ab98")), inside(0.965 - np.maximum(np.abs(px), np.abs(py)), pixel))
    return picture("azulejo", color)


def wood(seed: int, codes: Sequence[str], planks: int = 4, size: int = SIZE) -> Picture:
    """Boards along x with grain, a dark joint between boards and a butt joint in each."""
    x, y = grid(size)
    rng = np.random.default_rng(seed)
    board = np.floor(y * planks).astype(int)
    shift = rng.random(planks)[board]
    grain = noise(seed + 1, 1.0, 12.0, size)
    wave = noise(seed + 2, 1.6, 5.0, size)
    rings = 0.5 + 0.5 * np.sin(2 * np.pi * (y * planks * 3 + 5 * wave + 7 * shift))
    color = ramp(np.clip(0.1 + 0.5 * grain + 0.25 * rings + 0.3 * (shift - 0.4), 0, 1), codes)
    across = np.abs((y * planks + 0.5) % 1.0 - 0.5) / planks
    along = np.abs((x + shift + 0.5) % 1.0 - 0.5)
    joint = np.maximum(inside(across - 1.2 / size, 1 / size), inside(along - 1.0 / size, 1 / size))
    return picture("wood", mix(color, rgb(codes[0]) * 0.35, joint * (0.9 if planks > 1 else 0.0)))


def terrazzo(seed: int, ground: Sequence[str], chips: Sequence[str], size: int = SIZE) -> Picture:
    """Polished stone chips of three sizes in a speckled ground."""
    color = ramp(noise(seed, 0.6, 1.0, size), ground)
    grain = 0.85 + 0.3 * noise(seed + 9, 0.8, 1.0, size)
    for level, (count, keep) in enumerate(((34, 0.45), (15, 0.5), (7, 0.4))):
        owner, gap = cells(seed + 3 * level + 1, count, size)
        rng = np.random.default_rng(seed + level)
        chosen = rng.random(count * count) < keep
        palette = np.array([rgb(code) for code in chips])[rng.integers(0, len(chips), count * count)]
        width = (0.1 + 0.16 * rng.random(count * count)) / count
        cover = inside(width[owner] - gap, 1 / size) * chosen[owner]
        color = mix(color, palette[owner] * grain[..., None], cover)
    return picture("terrazzo", color)


def books(seed: int, shelves: int = 3) -> Picture:
    """Rows of book spines with bands and lettering, on dark shelves."""
    rng = np.random.default_rng(seed)
    palette = ("7d2a26", "a8482c", "c98a3b", "e3d2a8", "3f5a43", "2c4a63", "1e2b3f", "6b4a63", "b9a58a", "54301f")
    color = np.broadcast_to(rgb("17110d"), (SIZE, SIZE, 3)).copy()
    row = SIZE // shelves
    for shelf in range(shelves):
        floor, x = (shelf + 1) * row - 14, 0
        while x < SIZE:
            width = min(int(rng.integers(9, 27)), SIZE - x)
            top = floor - int(row * (0.66 + 0.24 * rng.random()))
            cover = rgb(palette[int(rng.integers(len(palette)))]) * (0.8 + 0.35 * rng.random())
            light = rgb("ead9a6") if cover.mean() < 0.5 else rgb("3a2418")
            shade = 0.72 + 0.36 * np.sin(np.pi * (np.arange(width) + 0.5) / width)
            spine = cover * shade[None, :, None] * np.ones((floor - top, 1, 1))
            height = floor - top
            for band in (0.1, 0.14, 0.84, 0.9)[: int(rng.integers(1, 5))]:
                spine[int(band * height) : int(band * height) + 2] = light * shade[:, None]
            if width > 10:
                letters = rng.random((height // 2, 3)) < 0.55
                lines = np.repeat(np.repeat(letters, 2, axis=0), max(1, (width - 6) // 3), axis=1)
                first, last = int(0.24 * height), int(0.74 * height)
                block = spine[first:last, 3 : 3 + lines.shape[1]]
                block[lines[first : first + len(block), : block.shape[1]]] = light * 0.9
            color[top:floor, x : x + width] = spine
            x += width + (0 if rng.random() < 0.85 else int(rng.integers(2, 14)))
        color[floor : floor + 14] = rgb("6e4a2c")
    board = np.clip(noise(seed + 4, 1.0, 6.0) * 0.5 + 0.75, 0, 1.2)[..., None]
    return picture("books", color * board)


def kilim(seed: int, codes: Sequence[str], bands: int = 8, size: int = 256) -> Picture:
    """A woven strip: bands of zigzags, diamonds and stripes between lines, with the thread showing."""
    x, y = grid(size)
    rng = np.random.default_rng(seed)
    band = np.floor(y * bands).astype(int)
    t = y * bands - band
    kind, first = rng.integers(0, 4, bands), rng.integers(0, len(codes), bands)
    step = rng.integers(1, len(codes), bands)
    palette = np.array([rgb(code) for code in codes])
    ground, ink = palette[first[band]], palette[((first + step) % len(codes))[band]]
    saw = np.abs((x * 8) % 1.0 - 0.5) * 2
    shapes = (saw - t, np.abs(t - 0.5) * 2 + saw - 0.9, np.abs(np.abs(t - 0.5) - 0.22) - 0.09, 0.25 - np.abs(saw - 0.5))
    cover = np.choose(kind[band], [inside(shape, 12 / size) for shape in shapes])
    color = mix(ground, ink, cover)
    color = mix(color, rgb("efe6d2"), inside(np.abs(t - 0.5) * -1 + 0.455, 12 / size))
    thread = 0.9 + 0.1 * np.sin(2 * np.pi * x * 64) * np.sin(2 * np.pi * y * 64)
    return picture("kilim", color * (thread * (0.8 + 0.4 * noise(seed + 1, 0.9, 1.0, size)))[..., None])


def marble(seed: int, codes: Sequence[str], size: int = 256) -> Picture:
    """Stone with fine dark veins."""
    field, veins = noise(seed, 1.3, 1.0, size), noise(seed + 1, 1.5, 1.0, size)
    color = ramp(field, codes[1:])
    vein = np.clip(1.0 - np.abs(veins - 0.5) / 0.02, 0.0, 1.0) + 0.5 * np.clip(1 - np.abs(field - 0.42) / 0.012, 0, 1)
    return picture("marble", mix(color, rgb(codes[0]), np.clip(vein, 0, 1) * 0.8))


def checker(seed: int, codes: tuple[str, str], squares: int = 8, size: int = 256) -> Picture:
    """Two colours in squares, each with its own grain."""
    x, y = grid(size)
    odd = (np.floor(x * squares) + np.floor(y * squares)) % 2
    color = mix(np.broadcast_to(rgb(codes[0]), (size, size, 3)), rgb(codes[1]), odd)
    return picture("checker", color * (0.72 + 0.5 * noise(seed, 0.9, 1.0, size))[..., None])


def stripes(seed: int, codes: Sequence[str], count: int = 8, size: int = 256) -> Picture:
    """Bands of even width along v, worn through to bone in places."""
    _, y = grid(size)
    palette = np.array([rgb(code) for code in codes])
    color = palette[np.floor(y * count).astype(int) % len(codes)]
    worn = np.clip((noise(seed, 1.0, 1.0, size) - 0.72) * 6, 0, 0.7)
    grain = 0.75 + 0.45 * noise(seed + 1, 0.8, 1.0, size)
    return picture("stripes", mix(color, rgb("d8cbb2"), worn) * grain[..., None])


def plaster(seed: int, codes: Sequence[str], exponent: float = 1.0, stretch: float = 1.0, size: int = 256) -> Picture:
    """Plain 1/f mottling between colours: plaster, felt, leaves, brushed metal with `stretch`."""
    return picture("plaster", ramp(np.clip(noise(seed, exponent, stretch, size) * 1.3 - 0.15, 0, 1), codes))


def bricks(seed: int, codes: Sequence[str], rows: int = 8) -> Picture:
    """Running bond with mortar, every brick its own shade."""
    x, y = grid()
    row = np.floor(y * rows).astype(int)
    shifted = x * rows / 2 + 0.5 * (row % 2)
    column = np.floor(shifted).astype(int) % (rows // 2)
    shade = np.random.default_rng(seed).random((rows, rows // 2))[row, column]
    color = ramp(np.clip(0.65 * shade + 0.5 * (noise(seed + 1, 0.8) - 0.3), 0, 1), codes)
    edge = np.minimum(np.abs((y * rows + 0.5) % 1 - 0.5) / rows, np.abs((shifted + 0.5) % 1 - 0.5) * 2 / rows)
    ragged = 0.004 + 0.004 * (noise(seed + 2, 0.8) - 0.5)
    return picture("bricks", mix(color, ramp(noise(seed + 3), ("857a6b", "b8ad9b")), inside(edge - ragged)))


def facade(seed: int, columns: int = 4, rows: int = 4) -> Picture:
    """A house front at night: brick, and sash windows of which some are lit, with curtains."""
    rng = np.random.default_rng(seed)
    x, y = grid()
    column, row = np.floor(x * columns).astype(int), np.floor(y * rows).astype(int)
    px, py = (x * columns - column - 0.5) * 2, (y * rows - row - 0.5) * 2
    pixel = 2 * rows / SIZE
    color = bricks(seed + 1, ("24140f", "3a1e18", "552d22"), 32).pixels[..., :3] / 255.0
    color *= 0.75 - 0.45 * (color.min(axis=-1, keepdims=True) > 0.3)  # mortar is as dark as the brick
    lit = rng.random((rows, columns)) < 0.45
    lamps = np.array([rgb(code) for code in ("ffca7a", "ffdf9e", "e8a552", "9fc4d8")])[
        rng.integers(0, 4, (rows, columns))
    ]
    glow = lamps[row, column] * (0.75 + 0.25 * np.cos(1.3 * px) * (1 - 0.3 * py))[..., None]
    curtain = 0.62 + 0.2 * np.sin(42 * px)
    glow = mix(glow, glow * 0.45, inside(0.26 - np.abs(px), pixel) * (curtain > 0.6))
    pane = np.where(lit[row, column][..., None], glow, rgb("10151f") + 0.06 * noise(seed + 2)[..., None])
    frame = np.maximum(np.abs(px) - 0.48, np.abs(py) - 0.66)
    bars = np.minimum(np.abs(px), np.abs(py + 0.05)) - 0.025
    color = mix(color, rgb("4a4036"), inside(frame - 0.09, pixel))
    color = mix(color, pane, inside(frame, pixel))
    return picture("facade", mix(color, rgb("3a3028"), inside(np.maximum(bars, frame), pixel)))
