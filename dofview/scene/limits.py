"""What a scene file may cost: caps that a person can raise, and the account of one file against them.

A file of a few kilobytes can ask for gigabytes (a picture header, an accessor count, a thousand views of the same
bytes), so every size is charged here before anything of that size is allocated.
"""

from __future__ import annotations

from dataclasses import dataclass

from dofview.errors import ModelError

MEGA = 2**20
FREE_GEOMETRY = 200 * MEGA


@dataclass(frozen=True)
class Limits:
    """Caps on one scene, to be raised by whoever trusts a file.

    Beyond a picture cap the picture is left out with a warning; beyond any other the file is refused.
    """

    picture_pixels: int = 64 * MEGA
    total_pixels: int = 256 * MEGA
    triangles: int = 20_000_000
    draws: int = 100_000
    buffer_bytes: int = 1_000_000_000
    growth: float = 12.0  # bytes of decoded geometry for each byte of file, beyond the first 200 MB


class Account:
    """What one file has used of its `limits` so far; every `charge` raises ModelError when a cap would be passed."""

    def __init__(self, limits: Limits) -> None:
        self.limits = limits
        self.pixels = self.triangles = self.draws = self.bytes = self.geometry = 0

    def charge_picture(self, width: int, height: int, memory: int = 1) -> None:
        """Charge a picture before it is decoded; a picture that then fails stays charged, so that failing costs too.

        `memory` is how many times the usual its decoder needs; the cap on one picture falls by as much.
        """
        each, total = self.limits.picture_pixels // memory, self.limits.total_pixels
        if width * height > each:
            raise ModelError(f"has {width}x{height} pixels; accepted: up to {each} (limit picture_pixels)")
        if self.pixels + width * height > total:
            raise ModelError(f"would bring all pictures beyond {total} pixels (limit total_pixels)")
        self.pixels += width * height

    def charge_draw(self, triangles: int) -> None:
        """Charge one drawn instance of `triangles` triangles."""
        self.draws += 1
        if self.draws > self.limits.draws:
            raise ModelError(f"more than {self.limits.draws} draw items (limit draws)")
        self.charge_triangles(triangles)

    def charge_triangles(self, triangles: int) -> None:
        """Charge triangles that are not draw items of their own."""
        if self.triangles + triangles > self.limits.triangles:
            raise ModelError(f"more than {self.limits.triangles} triangles (limit triangles)")
        self.triangles += triangles

    def charge_bytes(self, size: int) -> None:
        """Charge bytes about to be read from a file or decoded from a data URI."""
        if self.bytes + size > self.limits.buffer_bytes:
            raise ModelError(f"more than {self.limits.buffer_bytes} bytes of data (limit buffer_bytes)")
        self.bytes += size

    def charge_geometry(self, size: int) -> None:
        """Charge decoded geometry: overlapping or empty accessors may not multiply the file without end."""
        allowed = int(FREE_GEOMETRY + self.limits.growth * self.bytes)
        if self.geometry + size > allowed:
            raise ModelError(f"{self.bytes} bytes would grow to more than {allowed} bytes of geometry (limit growth)")
        self.geometry += size
