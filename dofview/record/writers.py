"""Film files, by suffix. A film is written beside its name as `name.part.mp4` and takes its name when it is whole.

MP4 and WebM are written in pieces that are flushed as they come, so that what a killed recording leaves still plays to
within a second of its end: whole-file MP4 left nothing playable.
"""

from __future__ import annotations

import contextlib
import os
import tempfile
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Protocol, cast

import numpy as np

from dofview.errors import InputError, OutputError
from dofview.export import save, to_srgb8, write_png8, write_whole

if TYPE_CHECKING:
    import av

PIECE_FRAMES = 30
BT709, SRGB_CURVE, LIMITED = 1, 13, 1
"""Numbers of ITU-T H.273."""


class Writer(Protocol):
    """Takes frames (h, w, 3) of one size, uint8 as shown or float32 linear light, then is closed."""

    def add(self, pixels: np.ndarray) -> None: ...
    def close(self) -> None: ...
    def abandon(self) -> None: ...


def writer(path: Path, size: tuple[int, int], fps: float) -> Writer:
    """Return the writer for `path`: .mp4, .webm or .gif, or a pattern as frames/%04d.png or .exr."""
    suffix = path.suffix.lower()
    if "%" in path.name:
        return Sequence(path)
    if suffix in _CODECS:
        return Video(path, size, fps)
    if suffix == ".gif":
        return Gif(path, fps)
    raise InputError(f"{path}: unknown kind of film; accepted: .mp4, .webm, .gif, or a pattern as frames/%04d.png")


def check(path: Path) -> None:
    """Say now, before anything is rendered, whether a film could be written under `path`."""
    if "%" not in path.name and path.suffix.lower() not in (*_CODECS, ".gif"):
        writer(path, (2, 2), 1.0)
    if "%" in path.name:
        Sequence(path)
    elif not path.parent.is_dir():
        raise OutputError(f"{path}: no folder {str(path.parent)!r}")
    elif path.is_dir() or not os.access(path.parent, os.W_OK):
        raise OutputError(f"{path}: cannot write the film here")


_CODECS = {
    ".mp4": ("libx264", "mp4", {"crf": "16", "preset": "veryfast", "tune": "zerolatency", "threads": "1"},
             {"movflags": "frag_keyframe+empty_moov+default_base_moof", "flush_packets": "1"}),
    ".webm": ("libvpx-vp9", "webm", {"crf": "24", "b": "0", "cpu-used": "6", "deadline": "realtime", "threads": "1"},
              {"flush_packets": "1", "cluster_time_limit": "1000"}),
}  # fmt: skip


class Video:
    """A film through PyAV; odd sizes are padded by a row or column of the edge."""

    def __init__(self, path: Path, size: tuple[int, int], fps: float):
        import av

        codec, container, options, muxing = _CODECS[path.suffix.lower()]
        self._path, self._part = path, path.with_name(f"{path.stem}.part{path.suffix}")
        self._size = (size[0] + size[0] % 2, size[1] + size[1] % 2)
        self._frames = 0
        self._rate = Fraction(fps).limit_denominator(100000)
        try:
            with self._part.open("wb"):
                pass
            self._file = av.open(str(self._part), "w", format=container, options=muxing)
        except (OSError, av.FFmpegError) as error:
            raise OutputError(f"{path}: cannot write the film: {_reason(error)}") from error
        self._stream = cast("av.VideoStream", self._file.add_stream(codec, rate=self._rate, options=options))
        self._stream.width, self._stream.height = self._size
        self._stream.pix_fmt = "yuv420p"
        self._stream.gop_size = PIECE_FRAMES
        self._stream.codec_context.time_base = 1 / self._rate
        # Said in the file, so that no player has to guess from the height which matrix was meant.
        context = self._stream.codec_context
        context.colorspace = context.color_primaries = BT709
        context.color_trc, context.color_range = SRGB_CURVE, LIMITED

    def add(self, pixels: np.ndarray) -> None:
        """Append a frame; OutputError when it cannot be written, with what was written kept."""
        import av

        encoded = as_shown(pixels)
        pad = ((0, self._size[1] - encoded.shape[0]), (0, self._size[0] - encoded.shape[1]), (0, 0))
        whole = av.VideoFrame.from_ndarray(np.ascontiguousarray(np.pad(encoded, pad, mode="edge")), format="rgb24")
        frame = whole.reformat(format="yuv420p", dst_colorspace=BT709, dst_color_range=LIMITED)
        frame.pts = self._frames
        self._frames += 1
        try:
            self._file.mux(self._stream.encode(frame))
        except (OSError, av.FFmpegError) as error:
            raise OutputError(f"{self._path}: cannot go on writing the film: {_reason(error)}") from error

    def close(self) -> None:
        """Finish the film and give it its name."""
        import av

        try:
            self._file.mux(self._stream.encode(None))
            self._file.close()
            os.replace(self._part, self._path)
        except (OSError, av.FFmpegError) as error:
            raise OutputError(
                f"{self._path}: cannot finish the film: {_reason(error)}; see {self._part.name}"
            ) from error

    def abandon(self) -> None:
        """Leave what there is under the name of a part."""
        import av

        # The reason was reported when it happened; closing the same broken file may only repeat it.
        with contextlib.suppress(OSError, av.FFmpegError):
            self._file.close()


class Gif:
    """An animated GIF of 256 colours a frame, in memory until it is closed."""

    def __init__(self, path: Path, fps: float):
        self._path = path
        self._duration_ms = 1000.0 / fps
        self._frames: list = []

    def add(self, pixels: np.ndarray) -> None:
        """Append a frame."""
        from PIL import Image

        self._frames.append(Image.fromarray(as_shown(pixels)).quantize(256))

    def close(self) -> None:
        """Write all frames."""
        if self._frames:
            write_whole(self._path, lambda part: self._frames[0].save(
                part, format="GIF", save_all=True, append_images=self._frames[1:], duration=self._duration_ms, loop=0,
            ))  # fmt: skip

    def abandon(self) -> None:
        """Keep nothing."""
        self._frames.clear()


class Sequence:
    """A picture a frame, PNG or EXR, named by the pattern."""

    def __init__(self, path: Path):
        self._path = path
        self._frames = 0
        try:
            path.name % 0
        except (TypeError, ValueError) as error:
            raise InputError(f"{path}: not a pattern of names; accepted: one number, as %04d") from error
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            tempfile.TemporaryFile(dir=path.parent).close()
        except OSError as error:
            raise OutputError(f"{path}: cannot write: {_reason(error)}") from error

    def add(self, pixels: np.ndarray) -> None:
        """Write the next picture."""
        path = self._path.with_name(self._path.name % self._frames)
        if pixels.dtype == np.uint8:
            write_whole(path, lambda part: write_png8(part, pixels))
        else:
            save(path, pixels)
        self._frames += 1

    def close(self) -> None:
        """Everything is written already."""

    def abandon(self) -> None:
        """What is written is whole."""


def as_shown(pixels: np.ndarray) -> np.ndarray:
    """8-bit sRGB of a frame that may be linear light."""
    return pixels if pixels.dtype == np.uint8 else to_srgb8(pixels)


def _reason(error: BaseException) -> str:
    return (getattr(error, "strerror", None) or str(error)).lower()
