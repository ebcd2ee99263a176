"""Aperture pictures: what shape a bright point takes out of focus, from a built-in shape or a file.

Brightness is transmission, as stored (no gamma), so that a picture at a tenth of its brightness is the same aperture.
A picture spans the square around the lens, row 0 at the top, its longer side from −1 to 1 lens radii. Points behind the
focus show it upright, points in front of it turned by 180°.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from dofview.errors import InputError, ModelError
from dofview.lens import Distribution, Lens
from dofview.scene.limits import Account, Limits
from dofview.scene.pictures import open_picture

LARGEST = 1024
_FINER = 4
_LUMINANCE = (0.2126, 0.7152, 0.0722)
Shape = Callable[[np.ndarray, np.ndarray], np.ndarray]  # transmission at x and y in lens radii, y up


@dataclass(frozen=True, eq=False)
class Aperture:
    """Transmission over the lens: `weights` (n, n) float64, row 0 at +y, sum 1, spanning ±`extent` lens radii."""

    name: str
    weights: np.ndarray
    extent: float = 1.0

    def place(self, square: np.ndarray) -> np.ndarray:
        """Map points of the unit square to the lens so that their density is the transmission, (n, 2) to (n, 2).

        Inverts the distribution over the rows, then over the columns of the row; within a texel it is uniform.
        """
        size = len(self.weights)
        rows = self._cumulative[::size]
        row, down = _invert(rows, square[:, 1] * rows[-1])
        along = rows[row] + square[:, 0] * (rows[row + 1] - rows[row])
        texel, right = _invert(self._cumulative, np.minimum(along, np.nextafter(rows[row + 1], 0.0)))
        unit = np.stack([texel - row * size + right, size - row - down], axis=1) / size
        return (2.0 * unit - 1.0) * self.extent

    @functools.cached_property
    def _cumulative(self) -> np.ndarray:
        return np.concatenate([[0.0], np.cumsum(self.weights)])


def of_lens(lens: Lens, size: int = 256) -> Aperture:
    """Draw the distribution of any lens, turned as it is, `size` texels square; a picture not turned keeps its own."""
    match lens.distribution:
        case Distribution.UNIFORM_DISC:
            return built_in("disc", size)
        case Distribution.POLYGON:
            return draw("polygon", polygon(lens.blades, lens.rotation_deg), size)
        case Distribution.GAUSSIAN:
            variance = lens.sigma_fraction**2
            return draw("gaussian", lambda x, y: np.exp((x * x + y * y) / (-2.0 * variance)), size, 4.0 * variance**0.5)
    picture = load(lens.image)
    if lens.rotation_deg % 360.0 == 0.0:
        return picture
    return draw(picture.name, _turned(picture, lens.rotation_deg), size, math.sqrt(2.0))


def load(image: str | Path | None) -> Aperture:
    """Return a built-in shape by name, or read a picture file; InputError when it cannot be an aperture."""
    if image is None:
        raise InputError(f"the lens names no aperture picture; accepted: a picture file or one of {', '.join(SHAPES)}")
    if str(image) in SHAPES:
        return built_in(str(image))
    path = Path(image)
    try:
        if not path.is_file():
            raise InputError(
                f"aperture picture {str(image)!r} is not a file; accepted: a picture file or one of {', '.join(SHAPES)}"
            )
        stamp = path.stat()
    except (OSError, ValueError) as error:
        raise InputError(f"aperture picture {str(image)!r} cannot be used as a path") from error
    return _read(path, stamp.st_size, stamp.st_mtime_ns)


@functools.lru_cache(maxsize=16)
def built_in(name: str, size: int = 256) -> Aperture:
    """Draw a built-in shape, antialiased, `size` texels square."""
    return draw(name, SHAPES[name], size)


def draw(name: str, shape: Shape, size: int = 256, extent: float = 1.0) -> Aperture:
    """Draw `shape` over ±`extent` lens radii, antialiased, `size` texels square."""
    fine = ((np.arange(size * _FINER) + 0.5) * (2.0 / (size * _FINER)) - 1.0) * extent
    values = np.asarray(shape(fine[None, :], -fine[:, None]), dtype=np.float64)
    return normalised(name, values.reshape(size, _FINER, size, _FINER).mean(axis=(1, 3)), extent)


def normalised(name: str, transmission: np.ndarray, extent: float = 1.0) -> Aperture:
    """Make an aperture of any picture (h, w) ≥ 0: centred in a square, with sum 1; InputError when it is all black."""
    height, width = transmission.shape
    size = max(height, width)
    top, left = (size - height) // 2, (size - width) // 2
    weights = np.zeros((size, size))
    weights[top : top + height, left : left + width] = transmission
    total = weights.sum()
    if not total > 0.0 or not math.isfinite(total):
        raise InputError(
            f"aperture picture {name!r} lets no light through; accepted: one that is not all black or clear"
        )
    return Aperture(name, weights / total, extent)


@functools.lru_cache(maxsize=4)
def _read(path: Path, size: int, modified_ns: int) -> Aperture:
    del modified_ns  # only part of the key, so that a changed file is read again
    try:
        account = Account(Limits())
        account.charge_bytes(size)
        image = open_picture(path.read_bytes(), account, path.suffix)
    except ModelError as error:
        raise InputError(f"aperture picture {str(path)!r} {error}") from error
    except OSError as error:
        raise InputError(
            f"aperture picture {str(path)!r} cannot be read: {(error.strerror or 'error').lower()}"
        ) from error
    return normalised(str(path), _transmission(image))


def _transmission(image) -> np.ndarray:
    """Brightness times alpha of a Pillow image, box-reduced until its longer side is at most `LARGEST`, (h, w)."""
    width, height = image.size
    factor = -(-max(width, height) // LARGEST)
    columns = np.arange(0, width, factor)
    rows = []
    for top in range(0, height, factor):
        band = image.crop((0, top, width, min(top + factor, height)))
        if band.mode.startswith("I"):  # 16-bit grey; Pillow's own conversion would clip it
            values = np.asarray(band, dtype=np.float64)
        else:
            pixels = np.asarray(band.convert("RGBA"), dtype=np.float64)
            values = (pixels[..., :3] @ _LUMINANCE) * pixels[..., 3]
        rows.append(np.add.reduceat(values.sum(axis=0), columns))
    return np.maximum(np.stack(rows), 0.0)


def _invert(cumulative: np.ndarray, target: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Find the step of a rising sequence that holds each target, and how far along it, in [0, 1)."""
    step = np.clip(np.searchsorted(cumulative, target, side="right") - 1, 0, len(cumulative) - 2)
    span = cumulative[step + 1] - cumulative[step]
    return step, (target - cumulative[step]) / np.where(span > 0.0, span, 1.0)


def _turned(picture: Aperture, degrees: float) -> Shape:
    """`picture` turned counter-clockwise, as a shape; nothing beyond its square."""
    size, angle = len(picture.weights), math.radians(degrees)

    def transmission(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        column = (x * math.cos(angle) + y * math.sin(angle) + 1.0) * (size / 2.0)
        row = (1.0 - y * math.cos(angle) + x * math.sin(angle)) * (size / 2.0)
        inside = (column >= 0.0) & (column < size) & (row >= 0.0) & (row < size)
        index = np.clip(row, 0, size - 1).astype(np.intp), np.clip(column, 0, size - 1).astype(np.intp)
        return picture.weights[index] * inside

    return transmission


def _disc(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    return x * x + y * y <= 1.0


def _gaussian(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """σ is half the radius, ending at the rim of the lens."""
    return np.exp(-2.0 * (x * x + y * y)) * _disc(x, y)


def _ring(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """A mirror lens: the inner two thirds of the radius are blocked."""
    return _disc(x, y) & (x * x + y * y >= 4.0 / 9.0)


def _heart(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """(x² + y² − 1)³ = x²·y³, scaled into the lens and placed with its centroid in the middle."""
    x, y = x * 1.3, y * 1.3 + 0.2935
    return (x * x + y * y - 1.0) ** 3 <= x * x * y**3


def polygon(blades: int, rotation_deg: float = 0.0) -> Shape:
    """Return the regular polygon inscribed in the lens, first corner at +x turned counter-clockwise, for `draw`."""
    turn = math.radians(rotation_deg)

    def inside(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        angles = (np.arange(blades) + 0.5) * (2.0 * math.pi / blades) + turn
        return np.all([x * math.cos(a) + y * math.sin(a) <= math.cos(math.pi / blades) for a in angles], axis=0)

    return inside


SHAPES: dict[str, Shape] = {
    "disc": _disc,
    "gaussian": _gaussian,
    "triangle": polygon(3, 90.0),
    "square": polygon(4, 45.0),
    "pentagon": polygon(5, 90.0),
    "hexagon": polygon(6),
    "octagon": polygon(8, 22.5),
    "ring": _ring,
    "heart": _heart,
}
