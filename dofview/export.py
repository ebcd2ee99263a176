"""Pictures to files: PNG in sRGB, EXR and NPY in linear light. A file appears whole or not at all."""

from __future__ import annotations

import errno
import os
import tempfile
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np

from dofview.errors import InputError, OutputError
from dofview.metrics import srgb_encode

NOTE = "dofview"
"""Name of the text chunk of a PNG and of the attribute of an EXR that say how the picture was made."""


def check_writable(path: Path) -> None:
    """Say now, before anything is rendered, whether `save` could write `path`.

    Raises OutputError for a folder, a missing folder, a read-only or special file; InputError for an unknown suffix.
    """
    target = _target(path)
    _writer(path)
    try:
        with tempfile.NamedTemporaryFile(dir=target.parent, prefix=f".{target.name[:40]}."):
            pass
    except OSError as error:
        raise _failure(path, error) from error


def save(path: Path, pixels: np.ndarray, note: str = "") -> None:
    """Write linear RGB `pixels` (height, width, 3), row 0 on top, in the format that the suffix of `path` names.

    A PNG or EXR carries `note` in its metadata (`dofview.remember` says what it is).
    """
    write = _writer(path)
    write_whole(path, lambda part: write(part, pixels, note))


def save_parts(path: Path, parts: Mapping[str, np.ndarray], note: str = "") -> None:
    """Write a multi-part EXR: each of `parts` (height, width, 3) as RGB or (height, width) as Y, float32."""
    if path.suffix.lower() != ".exr":
        raise InputError(f"{path}: pictures of several parts are EXR; accepted: a name that ends in .exr")
    write_whole(path, lambda part: _write_exr_parts(part, parts, note))


def write_whole(path: Path, write: Callable[[Path], object]) -> None:
    """Let `write` make a file beside `path`, then put it in its place; on any failure `path` is as it was."""
    target = _target(path)
    part: Path | None = None
    try:
        handle, name = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name[:40]}.", suffix=target.suffix)
        part = Path(name)
        os.close(handle)
        write(part)
        with part.open("rb+") as stream:
            os.fsync(stream.fileno())
        part.chmod(_mode())
        part.replace(target)
    except OSError as error:
        raise _failure(path, error) from error
    finally:
        if part is not None:
            part.unlink(missing_ok=True)


def to_srgb8(pixels: np.ndarray) -> np.ndarray:
    """Linear light to 8-bit sRGB, rounded; a value that is not a number is black."""
    return np.rint(srgb_encode(np.nan_to_num(pixels, nan=0.0, posinf=1.0, neginf=0.0)) * 255.0).astype(np.uint8)


def _write_png(path: Path, pixels: np.ndarray, note: str) -> None:
    write_png8(path, to_srgb8(pixels), note)


def write_png8(path: Path, pixels: np.ndarray, note: str = "") -> None:
    """Write (height, width, 3 or 4) uint8 `pixels` as they are, with `note` as a text chunk."""
    from PIL import Image
    from PIL.PngImagePlugin import PngInfo

    info = PngInfo()
    if note:
        info.add_itxt(NOTE, note, zip=True)
    Image.fromarray(pixels).save(path, "PNG", pnginfo=info)


def _write_npy(path: Path, pixels: np.ndarray, note: str) -> None:
    with path.open("wb") as stream:
        np.save(stream, np.ascontiguousarray(pixels, dtype=np.float32), allow_pickle=False)


def _write_exr(path: Path, pixels: np.ndarray, note: str) -> None:
    _write_exr_parts(path, {"": pixels}, note)


def _write_exr_parts(path: Path, parts: Mapping[str, np.ndarray], note: str) -> None:
    import OpenEXR

    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    if note:
        header[NOTE] = note
    written = []
    for name, pixels in parts.items():
        channel = "RGB" if pixels.ndim == 3 else "Y"
        channels = {channel: np.ascontiguousarray(pixels, dtype=np.float32)}
        written.append(OpenEXR.Part({**header, "name": name} if name else dict(header), channels, name))
    # The library says everything that goes wrong with a file, a full disk too, by RuntimeError.
    try:
        with OpenEXR.File(written) as file:
            file.write(str(path))
    except RuntimeError as error:
        raise OSError(errno.EIO, str(error)) from error


WRITERS: dict[str, Callable[[Path, np.ndarray, str], None]] = {
    ".png": _write_png,
    ".exr": _write_exr,
    ".npy": _write_npy,
}


def _writer(path: Path) -> Callable[[Path, np.ndarray, str], None]:
    writer = WRITERS.get(path.suffix.lower())
    if writer is None:
        raise InputError(f"{path}: unknown picture format {path.suffix!r}; accepted: {', '.join(WRITERS)}")
    return writer


def _target(path: Path) -> Path:
    """The file that `path` means, links followed; it must be absent or a regular file that may be written."""
    try:
        target = path.resolve()
        if target.is_dir():
            raise OutputError(f"cannot write {path}: it is a folder; accepted: a file name")
        if target.exists() and not target.is_file():
            raise OutputError(f"cannot write {path}: it is not a regular file")
        if target.exists() and not os.access(target, os.W_OK):
            raise OutputError(f"cannot write {path}: it is read-only")
        if not target.parent.is_dir():
            raise OutputError(f"cannot write {path}: there is no folder {target.parent}")
    except OSError as error:
        raise _failure(path, error) from error
    except (ValueError, RuntimeError) as error:
        raise OutputError(f"cannot write {str(path)!r}: {error}") from error
    return target


def _failure(path: Path, error: OSError) -> OutputError:
    return OutputError(f"cannot write {path}: {(error.strerror or str(error)).lower()}")


def _mode() -> int:
    """What a file made by `open` would get; `mkstemp` makes them private."""
    mask = os.umask(0)
    os.umask(mask)
    return 0o666 & ~mask
