"""Reading what a person names on the command line: only regular files, and none larger than it can sensibly be.

A pipe or a device would be waited for without end.
"""

from __future__ import annotations

import os
import stat
import threading
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stdout
from pathlib import Path

from dofview.errors import InputError

_STDERR = 2
_silent = threading.Lock()


def check_regular(path: Path, what: str, most_bytes: int | None = None) -> None:
    """Raise InputError when `path`, which is to be `what`, is no regular file or has more than `most_bytes`."""
    try:
        found = path.stat()
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or "not a usable path"
        raise InputError(f"{path}: cannot read {what}: {reason.lower()}") from error
    if not stat.S_ISREG(found.st_mode):
        raise InputError(f"{path}: cannot read {what}: not a regular file")
    if most_bytes is not None and found.st_size > most_bytes:
        raise InputError(f"{path}: too large for {what}; accepted: up to {most_bytes >> 20} MiB")


def read_small(path: Path, what: str, most_bytes: int) -> str:
    """Return the UTF-8 text of a file of at most `most_bytes`; ValueError when it is not UTF-8, else InputError."""
    check_regular(path, what, most_bytes)
    try:
        return path.read_text(encoding="utf-8-sig")
    except OSError as error:
        raise InputError(f"{path}: cannot read {what}: {(error.strerror or str(error)).lower()}") from error


@contextmanager
def silent() -> Iterator[None]:
    """Keep a library from writing to standard output and error what its exception says as well (OpenEXR does both)."""
    with _silent, open(os.devnull, "w", encoding="utf-8") as nowhere, redirect_stdout(nowhere):
        kept = os.dup(_STDERR)
        try:
            os.dup2(nowhere.fileno(), _STDERR)
            yield
        finally:
            os.dup2(kept, _STDERR)
            os.close(kept)
