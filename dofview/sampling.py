"""Where the reference samples the lens and the pixel: low-discrepancy points carried to the lens's distribution.

Two point sets, the better for each use (RMS error of a half-covered lens at 64 and at 1024 points, and its exponent:
random 0.047, 0.011, −0.50; Sobol 0.015, 0.0019, −0.75; spiral 0.013, 0.0013, −0.78):

* progressive: an Owen-scrambled Sobol sequence with the concentric map. It has no end and every prefix is good, so a
  window can keep adding views. Sample 0 is the middle of the lens and of the pixel: the first view is the pinhole's.
* fixed: exactly N points on a Fibonacci (Vogel) spiral, centred to the last bit.

Lens and pixel are sampled jointly, in four dimensions: where the blur is about a pixel wide the two add up, and pairing
two good plane sets carelessly doubles the error there.
"""

from __future__ import annotations

import math

import numpy as np

from dofview.bokeh import load
from dofview.lens import Distribution, Lens
from dofview.rings import rings

GOLDEN = (math.sqrt(5.0) - 1.0) / 2.0
# Steps of the pixel positions of the fixed set. With 1 and the golden ratio they span the integers of Q(√3, √5), so the
# spiral and the pixel are badly approximable together, as the golden ratio is alone: of some 1,900 pairs tried on
# edges blurred by 0 to 8 px the best, up to a third better than R2 and than Sobol.
PIXEL_STEPS = (math.sqrt(3.0) - GOLDEN, math.sqrt(3.0) * (1.0 + GOLDEN) - GOLDEN)
_BITS = 32
_MASK = 0xFFFFFFFF


def lens_samples(
    lens: Lens, count: int, *, progressive: bool, start: int = 0, seed: int = 0, symmetric: bool = False
) -> np.ndarray:  # fmt: skip
    """Return `count` points on the lens, (count, 2) float64 in lens radii, x right and y up as seen from the camera.

    Progressive sets are samples `start` to `start + count` of one endless sequence; a fixed set is made for its count.
    A polygon has its first corner at +x, an aperture picture has its top at +y, both turned counter-clockwise by
    `lens.rotation_deg`. A Gaussian is not cut off; a picture reaches to ±1 and, turned, to √2. A `symmetric` fixed set
    is one of rings (`dofview.rings`) from four points on; no pixel positions go with it.
    """
    _check(count, start, progressive)
    if progressive:
        return on_lens(lens, _sobol_points((0, 1), count, start, seed))
    if lens.distribution == Distribution.IMAGE:
        return on_lens(lens, _lattice(count, seed))
    points = _warp(rings(count) if symmetric and count >= 4 else spiral(count, seed), lens)
    return points - points.mean(axis=0) if lens.distribution == Distribution.GAUSSIAN else points


def on_lens(lens: Lens, square: np.ndarray) -> np.ndarray:
    """Carry points of the unit square to the lens, so that even ones follow its distribution, (n, 2) to (n, 2)."""
    if lens.distribution == Distribution.IMAGE:
        return _turn(load(lens.image).place(square), lens.rotation_deg)
    return _warp(concentric(square), lens)


def halton(count: int) -> np.ndarray:
    """The first `count` points of the Halton sequence in bases 2 and 3, in the open unit square, (count, 2)."""
    points = np.zeros((count, 2))
    for column, base in enumerate((2, 3)):
        left, digit = np.arange(1, count + 1), 1.0 / base
        while left.any():
            points[:, column] += left % base * digit
            left, digit = left // base, digit / base
    return points


def pixel_jitter(count: int, *, progressive: bool, start: int = 0, seed: int = 0) -> np.ndarray:
    """Return positions in the pixel that go with `lens_samples` of the same arguments, (count, 2) in [−0.5, 0.5)."""
    _check(count, start, progressive)
    if progressive:
        return _sobol_points((2, 3), count, start, seed) - 0.5
    # Counted from the middle, so that the points lie in opposite pairs and their mean is the pixel centre.
    index = np.arange(count) - 0.5 * (count - 1)
    points = (np.outer(index, PIXEL_STEPS) + 0.5) % 1.0 - 0.5
    return points if seed == 0 else np.roll(points, _hash(seed) % count, axis=0)


def spiral(count: int, seed: int = 0) -> np.ndarray:
    """`count` points spread evenly over the unit disc (Vogel 1979), (count, 2); `seed` turns them.

    As Vogel has it the spiral is off centre by 0.5/N, which would shift what is blurred; centred it also errs less.
    """
    index = np.arange(count)
    radius = np.sqrt((index + 0.5) / count)
    angle = 2.0 * np.pi * (index * GOLDEN + _fraction(seed))
    points = radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return points - points.mean(axis=0)


def concentric(square: np.ndarray) -> np.ndarray:
    """Map the unit square to the unit disc, keeping area and neighbours (Shirley and Chiu 1997), (n, 2) to (n, 2)."""
    x, y = (2.0 * square - 1.0).T
    wide = np.abs(x) > np.abs(y)
    radius = np.where(wide, x, y)
    across = np.where(wide, y, x) / np.where(radius == 0.0, 1.0, radius)
    angle = np.where(wide, across * (np.pi / 4.0), np.pi / 2.0 - across * (np.pi / 4.0))
    return radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def polygonal(disc: np.ndarray, blades: int) -> np.ndarray:
    """Map the unit disc to the regular polygon inscribed in it, keeping area ratios, (n, 2) to (n, 2).

    Circles go to polygons, and equal angles to equal lengths along an edge: the triangle that a step spans with the
    centre then has the same area anywhere along the edge. For four blades it undoes the concentric map.
    """
    radius = np.hypot(disc[:, 0], disc[:, 1])
    turn = np.arctan2(disc[:, 1], disc[:, 0]) * (blades / (2.0 * np.pi))
    edge = np.floor(turn)
    corners = np.exp(2j * np.pi / blades * np.stack([edge, edge + 1.0]))
    point = radius * (corners[0] + (turn - edge) * (corners[1] - corners[0]))
    return np.stack([point.real, point.imag], axis=1)


def gaussian(disc: np.ndarray, sigma: float) -> np.ndarray:
    """Map the unit disc to a Gaussian of `sigma` per axis by its radius's inverse distribution, (n, 2) to (n, 2)."""
    squared = np.minimum(np.sum(disc * disc, axis=1), 1.0 - 2.0**-_BITS)
    radius = sigma * np.sqrt(-2.0 * np.log1p(-squared))
    return disc * (radius / np.sqrt(np.where(squared == 0.0, 1.0, squared)))[:, None]


def _warp(disc: np.ndarray, lens: Lens) -> np.ndarray:
    match lens.distribution:
        case Distribution.GAUSSIAN:
            return gaussian(disc, lens.sigma_fraction)
        case Distribution.POLYGON:
            return _turn(polygonal(disc, lens.blades), lens.rotation_deg)
    return disc


def _turn(points: np.ndarray, degrees: float) -> np.ndarray:
    angle = math.radians(degrees % 360.0)
    cosine, sine = math.cos(angle), math.sin(angle)
    return points @ np.array([[cosine, sine], [-sine, cosine]])


def _lattice(count: int, seed: int) -> np.ndarray:
    """`count` points of a Fibonacci lattice in the unit square: the spiral before it is bent to a disc."""
    index = np.arange(count)
    return np.stack([(index * GOLDEN + 0.5 + _fraction(seed)) % 1.0, (index + 0.5) / count], axis=1)


def _check(count: int, start: int, progressive: bool) -> None:
    if count < 1 or start < 0 or start + count > 2**_BITS:
        raise ValueError(f"samples {start} to {start + count}; accepted: at least one, 0 to 2^32")
    if start and not progressive:
        raise ValueError("a fixed set has no samples beyond its count; start must be 0")


def _direction_numbers(degree: int, coefficients: int, *initial: int) -> np.ndarray:
    """Direction numbers of one Sobol dimension by the recurrence of its primitive polynomial, (32,) uint32."""
    numbers = list(initial)
    for k in range(degree, _BITS):
        value = numbers[k - degree] ^ numbers[k - degree] << degree
        for j in range(1, degree):
            if coefficients >> (degree - 1 - j) & 1:
                value ^= numbers[k - j] << j
        numbers.append(value)
    return np.array([number << (_BITS - 1 - k) for k, number in enumerate(numbers)], dtype=np.uint32)


# Dimension 1 is van der Corput's; 2 to 4 are Joe and Kuo's (2008, new-joe-kuo-6). 1 and 2 are the best pair: the lens.
_DIRECTIONS = (
    np.array([1 << (_BITS - 1 - k) for k in range(_BITS)], dtype=np.uint32),
    _direction_numbers(1, 0, 1),
    _direction_numbers(2, 1, 1, 3),
    _direction_numbers(3, 1, 1, 3, 1),
)


def _sobol_points(dimensions: tuple[int, ...], count: int, start: int, seed: int) -> np.ndarray:
    """Scrambled Sobol points `start` to `start + count`, (count, len(dimensions)) in the open unit interval."""
    index = np.concatenate([[0], np.arange(start, start + count)]).astype(np.uint32)
    columns = []
    for dimension in dimensions:
        bits = _owen_scramble(_sobol(index, dimension), _hash(4 * seed + dimension + 1))
        # A digital shift keeps all that scrambling gives, and puts sample 0 in the middle.
        bits = bits[1:] ^ bits[0] ^ np.uint32(1 << (_BITS - 1))
        columns.append((bits + 0.5) / 2.0**_BITS)
    return np.stack(columns, axis=1)


def _sobol(index: np.ndarray, dimension: int) -> np.ndarray:
    """Points `index` (n,) uint32 of one Sobol dimension, as 32-bit fractions."""
    point = np.zeros_like(index)
    for bit in range(int(index.max()).bit_length()):
        point ^= (index >> np.uint32(bit) & np.uint32(1)) * _DIRECTIONS[dimension][bit]
    return point


def _owen_scramble(x: np.ndarray, seed: int) -> np.ndarray:
    """Flip each bit by a hash of the bits above it (Owen 1995), (n,) uint32.

    Laine and Karras's (2011) hash, in which a bit affects only higher ones, between two reversals of the bits (Burley
    2020), with Vegdahl's (2021) constants.
    """
    x = _reverse_bits(x)
    x = x ^ x * np.uint32(0x3D20ADEA)
    x = x + np.uint32(seed)
    x = x * np.uint32(seed >> 16 | 1)
    x = x ^ x * np.uint32(0x05526C56)
    x = x ^ x * np.uint32(0x53A22864)
    return _reverse_bits(x)


def _reverse_bits(x: np.ndarray) -> np.ndarray:
    for shift, mask in ((1, 0x55555555), (2, 0x33333333), (4, 0x0F0F0F0F), (8, 0x00FF00FF)):
        s, m = np.uint32(shift), np.uint32(mask)
        x = (x >> s & m) | (x & m) << s
    return x >> np.uint32(16) | x << np.uint32(16)


def _hash(value: int) -> int:
    """Mix the bits of an integer to 32 (lowbias32, Wellons 2018)."""
    value &= _MASK
    value = (value ^ value >> 16) * 0x7FEB352D & _MASK
    value = (value ^ value >> 15) * 0x846CA68B & _MASK
    return value ^ value >> 16


def _fraction(seed: int) -> float:
    """Seed 0 is 0, any other a number in [0, 1)."""
    return _hash(seed) / 2.0**_BITS
