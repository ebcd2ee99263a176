"""What surrounds a scene and lights it: an equirectangular picture, or a built-in studio drawn as one.

It stands in the world, +y up, its middle towards −z. A picture becomes one mipmapped texture, each level blurred as a
rougher surface reflects it (split-sum prefiltering, Karis 2013: GGX around the normal, seen along it), once.
"""

from __future__ import annotations

import functools
import re
from pathlib import Path

import moderngl
import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from dofview.errors import InputError, ModelError
from dofview.gl.context import Gpu
from dofview.gl.passes import draw
from dofview.metrics import srgb_decode
from dofview.reading import silent
from dofview.scene.limits import Account, Limits
from dofview.scene.pictures import open_picture

SKY, STUDIO = "sky", "studio"
LEVELS = 6
"""Levels of roughness 0, 1/5 … 1."""
HEIGHT = 512
BRIGHTEST = 1e4
_ACCEPTED = f"{SKY}, {STUDIO}, or an equirectangular picture (.hdr, .exr, .png, .jpg)"
_RESOLUTION = re.compile(rb"-Y (\d{1,6}) \+X (\d{1,6})\n")


class Lighting(BaseModel):
    """What lights the scene, as a person chooses it."""

    model_config = ConfigDict(frozen=True)

    environment: str = Field(default=SKY, description=f"What lights the scene: {_ACCEPTED}.")

    def stamp(self) -> tuple[object, ...]:
        """A value that changes when another environment, or another content of the same file, would be loaded."""
        if self.environment in (SKY, STUDIO):
            return (self.environment,)
        try:
            found = Path(self.environment).stat()
            return (self.environment, found.st_size, found.st_mtime_ns)
        except (OSError, ValueError):
            return (self.environment,)


class Environment:
    """A surrounding on the GPU: `texture` (2·HEIGHT, HEIGHT) linear radiance, row 0 towards −y, `LEVELS` mip levels."""

    def __init__(self, gpu: Gpu, pixels: np.ndarray):
        """`pixels` (h, w, 3) linear radiance, row 0 on top."""
        source = _texture(gpu, _resized(pixels))
        levels = []
        for level in range(1, LEVELS):
            image = gpu.targets.image(f"environment/{level}", (2 * HEIGHT >> level, HEIGHT >> level))
            values = {"roughness": level / (LEVELS - 1), "extent": image.size}
            draw(gpu, "render/environment.frag", image, textures={"environment": source}, values=values)
            levels.append(image.pixels()[::-1])
        for level, blurred in enumerate(levels, 1):
            source.write(blurred.astype(np.float16).tobytes(), level=level, alignment=1)
        self.texture = source

    def release(self) -> None:
        self.texture.release()


def load(gpu: Gpu, lighting: Lighting) -> Environment | None:
    """Read and prefilter what `lighting` names; None for the sky, which is a formula. InputError for a bad picture."""
    return None if lighting.environment == SKY else Environment(gpu, prepare(lighting))


def prepare(lighting: Lighting) -> np.ndarray:
    """Read the picture that `lighting` names, (HEIGHT, 2·HEIGHT, 3) linear radiance; InputError for a bad one.

    The last ones are kept, so that a thread may call this before the one that draws needs them.
    """
    return _prepared(lighting.stamp())


@functools.lru_cache(maxsize=2)
def _prepared(stamp: tuple[object, ...]) -> np.ndarray:
    name = str(stamp[0])
    return _resized(studio() if name == STUDIO else read(Path(name)))


def read(path: Path) -> np.ndarray:
    """Read a picture as linear radiance, (h, w, 3) float32, row 0 on top; InputError says why not."""
    try:
        if not path.is_file():
            raise InputError(f"environment {str(path)!r} is not a file; accepted: {_ACCEPTED}")
        account = Account(Limits())
        account.charge_bytes(path.stat().st_size)
        match path.suffix.lower():
            case ".hdr":
                pixels = _read_hdr(path.read_bytes())
            case ".exr":
                pixels = _read_exr(path)
            case suffix:
                image = open_picture(path.read_bytes(), account, suffix)
                pixels = srgb_decode(np.asarray(image.convert("RGB")) / 255.0)
    except (ModelError, ValueError) as error:
        raise InputError(f"environment {str(path)!r} {error}") from error
    except OSError as error:
        raise InputError(f"environment {str(path)!r} cannot be read: {(error.strerror or 'error').lower()}") from error
    return np.nan_to_num(pixels, nan=0.0, posinf=BRIGHTEST, neginf=0.0).clip(0.0, BRIGHTEST).astype(np.float32)


def studio(height: int = HEIGHT) -> np.ndarray:
    """Draw a photographer's studio, (height, 2·height, 3): dark room, soft boxes, a window of six panes."""
    azimuth = ((np.arange(2 * height) + 0.5) / height - 1.0)[None, :] * 180.0
    elevation = (0.5 - (np.arange(height) + 0.5) / height)[:, None] * 180.0
    rise = np.clip(elevation / 90.0, -1.0, 1.0)[..., None]
    room = np.where(rise > 0.0, 0.16 + 0.1 * rise, 0.1 + 0.06 * rise) * [1.0, 0.97, 0.92]
    room = np.repeat(room, 2 * height, axis=1)

    def panel(azimuths: tuple[float, float], elevations: tuple[float, float], radiance: tuple[float, float, float]):
        inside = (azimuth > azimuths[0]) & (azimuth < azimuths[1])
        room[inside & (elevation > elevations[0]) & (elevation < elevations[1])] = radiance

    panel((-70, -25), (5, 60), (5.5, 5.2, 4.8))
    panel((35, 47), (-25, 65), (3.2, 3.6, 4.4))
    panel((70, 82), (-25, 65), (3.2, 3.6, 4.4))
    for column in range(3):
        for row in range(2):
            left, low = 130 + 17 * column, 5 + 22 * row
            panel((left, left + 14), (low, low + 18), (2.6, 3.0, 3.6))
    for column in range(5):
        for row in range(4):
            panel((-20 + 11 * column, -14 + 11 * column), (6 + 9 * row, 12 + 9 * row), (3.4, 3.2, 2.9))
    for stripe in range(-180, 180, 20):
        panel((stripe, stripe + 10), (-12, -4), (0.5, 0.32, 0.2))
    panel((-150, -110), (-30, 35), (1.6, 1.3, 0.9))
    room[(elevation > 68.0)[:, 0]] = (4.2, 4.2, 4.2)
    return room.astype(np.float32)


def _texture(gpu: Gpu, pixels: np.ndarray) -> moderngl.Texture:
    texels = np.ones((*pixels.shape[:2], 4), np.float16)
    texels[..., :3] = pixels[::-1]
    texture = gpu.ctx.texture((texels.shape[1], texels.shape[0]), 4, texels.tobytes(), dtype="f2", alignment=1)
    texture.build_mipmaps(0, LEVELS - 1)
    texture.filter = (moderngl.LINEAR_MIPMAP_LINEAR, moderngl.LINEAR)
    texture.repeat_x, texture.repeat_y = True, False
    return texture


def _resized(pixels: np.ndarray) -> np.ndarray:
    """(HEIGHT, 2·HEIGHT, 3): the mean of what falls into a texel, or the nearest where the picture is smaller."""
    if pixels.shape[:2] == (HEIGHT, 2 * HEIGHT):
        return pixels
    for axis, size in ((0, HEIGHT), (1, 2 * HEIGHT)):
        edges = np.arange(size) * pixels.shape[axis] // size
        if pixels.shape[axis] < size:
            pixels = np.take(pixels, edges, axis)
            continue
        counts = np.diff(np.append(edges, pixels.shape[axis]))
        pixels = np.add.reduceat(pixels, edges, axis, np.float64) / np.expand_dims(counts, (1 - axis, 2))
    return pixels


def _read_exr(path: Path) -> np.ndarray:
    import OpenEXR

    # The library says everything that is wrong with a file by RuntimeError.
    try:
        with silent(), OpenEXR.File(str(path), header_only=True) as file:
            low, high = file.header()["dataWindow"]
        _check_size(int(high[0] - low[0]) + 1, int(high[1] - low[1]) + 1)
        with silent(), OpenEXR.File(str(path), separate_channels=True) as file:
            channels = file.channels()
            found = [channels[name].pixels for name in "RGB" if name in channels]
    except RuntimeError as error:
        raise ValueError("is not a readable OpenEXR picture") from error
    if len(found) != 3:
        raise ValueError("has no channels R, G and B")
    return np.stack(found, axis=-1).astype(np.float32)


def _read_hdr(data: bytes) -> np.ndarray:
    """Decode Radiance RGBE, flat or run-length coded by scanline."""
    head = _RESOLUTION.search(data[:65536])
    if not data.startswith(b"#?") or head is None:
        raise ValueError("is not a Radiance picture stored from top left")
    height, width = int(head[1]), int(head[2])
    _check_size(width, height)
    position, rows = head.end(), np.zeros((height, 4, width), np.uint8)
    if not (8 <= width < 32768 and data[position : position + 2] == b"\2\2"):
        flat = np.frombuffer(data, np.uint8, offset=position, count=min(len(data) - position, 4 * width * height))
        if flat.size < 4 * width * height:
            raise ValueError("ends too early")
        rows = flat.reshape(height, width, 4).swapaxes(1, 2)
    else:
        for row in rows:
            position = _read_scanline(data, position + 4, row)
    exponent = rows[:, 3].astype(np.int32)
    scale = np.where(exponent > 0, np.ldexp(1.0, exponent - 136), 0.0)
    return (rows[:, :3] * scale[:, None]).swapaxes(1, 2)


def _read_scanline(data: bytes, position: int, row: np.ndarray) -> int:
    """Decode one scanline, (4, width) uint8; return where the next begins."""
    for channel in row:
        filled = 0
        while filled < len(channel):
            if position + 1 >= len(data) or data[position] == 0:
                raise ValueError("ends too early or is damaged")
            count = data[position]
            run = count > 128
            count = count - 128 if run else count
            values = data[position + 1 : position + 2] * count if run else data[position + 1 : position + 1 + count]
            if filled + count > len(channel) or len(values) < count:
                raise ValueError("has a scanline that is too long")
            channel[filled : filled + count] = np.frombuffer(values, np.uint8)
            filled += count
            position += 2 if run else 1 + count
    return position


def _check_size(width: int, height: int) -> None:
    if width < 1 or height < 1 or width * height > Limits().picture_pixels:
        raise ValueError(f"has {width}x{height} pixels; accepted: 1 to {Limits().picture_pixels}")
