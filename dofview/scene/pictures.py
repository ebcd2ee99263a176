"""Decoding pictures from untrusted bytes: five formats, recognised by content, sized before they are decoded.

Pillow alone would offer some forty decoders and one that starts Ghostscript; here its plug-in classes are called
directly. PNG chunks other than the image itself are cut away first: they change nothing we show, and compressed text is
a way to burn time.
"""

from __future__ import annotations

import contextlib
import io
import struct
from collections.abc import Iterator

import numpy as np

from dofview.errors import ModelError
from dofview.scene.limits import MEGA, Account
from dofview.scene.model import Picture

ACCEPTED = "PNG, JPEG, WebP, BMP or TGA"
MOST_SCAN_PIXELS = 2_000 * MEGA  # progressive JPEG: scans times pixels, about the work of ten seconds
WEBP_MEMORY = 3  # its decoder holds two canvases and a copy besides the picture: 16 bytes a pixel, measured
_PNG = b"\x89PNG\r\n\x1a\n"
_MOST_CHUNKS = 50_000
_PNG_CHUNKS = {b"IHDR", b"PLTE", b"tRNS", b"IDAT", b"IEND"}


def decode(data: bytes | memoryview, name: str, account: Account, suffix: str = "") -> Picture:
    """Decode to 8-bit RGBA, row 0 on top, as stored (no orientation or gamma applied); ModelError says why not.

    `suffix` (".tga") is needed for TGA alone, which has no signature.
    """
    image = open_picture(data, account, suffix)
    with _one_error_class():
        return Picture(name, _rgba(image))


def open_picture(data: bytes | memoryview, account: Account, suffix: str = ""):
    """Decode to a Pillow image in the mode it is stored in; ModelError says why not."""
    data = bytes(data)
    with _one_error_class():
        image = _open(data, suffix)
        width, height = image.size
        account.charge_picture(width, height, WEBP_MEMORY if image.format == "WEBP" else 1)
        _check_scans(data, width * height)
        image.load()
        return image


@contextlib.contextmanager
def _one_error_class() -> Iterator[None]:
    try:
        yield
    except ModelError:
        raise
    except MemoryError as error:
        raise ModelError("needs more memory than there is") from error
    except Exception as error:  # Pillow's parsers raise whatever broken bytes lead them to
        raise ModelError(f"is not a readable picture ({type(error).__name__})") from error


def _open(data: bytes, suffix: str):
    from PIL import BmpImagePlugin, JpegImagePlugin, PngImagePlugin, TgaImagePlugin, WebPImagePlugin

    if data.startswith(_PNG):
        return PngImagePlugin.PngImageFile(io.BytesIO(_PNG + b"".join(_needed_chunks(data))))
    if data.startswith(b"\xff\xd8\xff"):
        return JpegImagePlugin.JpegImageFile(io.BytesIO(data))
    if data[:4] == b"RIFF" and data[8:12] == b"WEBP":
        return WebPImagePlugin.WebPImageFile(io.BytesIO(data))
    if data.startswith(b"BM"):
        return BmpImagePlugin.BmpImageFile(io.BytesIO(data))
    if suffix.lower() == ".tga":
        return TgaImagePlugin.TgaImageFile(io.BytesIO(data))
    raise ModelError(f"is in no accepted picture format; accepted: {ACCEPTED}")


def _needed_chunks(data: bytes) -> Iterator[bytes]:
    position = len(_PNG)
    for _ in range(_MOST_CHUNKS):
        if position + 12 > len(data):
            return
        (length,) = struct.unpack_from(">I", data, position)
        if data[position + 4 : position + 8] in _PNG_CHUNKS:
            yield data[position : position + 12 + length]
        position += 12 + length
    raise ModelError(f"is a PNG of more than {_MOST_CHUNKS} chunks")


def _check_scans(data: bytes, pixels: int) -> None:
    if data.startswith(b"\xff\xd8") and data.count(b"\xff\xda") * pixels > max(MOST_SCAN_PIXELS, 12 * pixels):
        raise ModelError("is a progressive JPEG with more scans than any encoder writes")


def _rgba(image) -> np.ndarray:
    """(height, width, 4) uint8, converted in bands so that the picture is held twice at most."""
    width, height = image.size
    pixels = np.empty((height, width, 4), np.uint8)
    rows = max(1, 2 * MEGA // max(width, 1))
    for top in range(0, height, rows):
        band = image.crop((0, top, width, min(top + rows, height)))
        if band.mode.startswith("I"):  # 16-bit grey; Pillow's own conversion would clip it
            grey = (np.asarray(band).astype(np.int64) >> 8).clip(0, 255)
            pixels[top : top + rows, :, :3] = grey[..., None]
            pixels[top : top + rows, :, 3] = 255
        else:
            pixels[top : top + rows] = np.asarray(band.convert("RGBA"))
    return pixels
