"""Reading the files a model refers to, and nothing else on the machine.

A reference is decoded once, taken relative to the model's folder, resolved through symbolic links, and must then be a
regular file inside that folder. No look-up by base name, no other scheme than `data:`, no devices or pipes (files are
opened without blocking).
"""

from __future__ import annotations

import base64
import binascii
import os
import re
import stat
import urllib.parse
from pathlib import Path

from dofview.errors import ModelError
from dofview.scene.limits import Account
from dofview.scene.notes import one_line

_SCHEME = re.compile(r"[A-Za-z][A-Za-z0-9+.-]*:")
_OPEN_FLAGS = os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0) | getattr(os, "O_CLOEXEC", 0)


class Folder:
    """The folder of a model file: reads files inside it and can tell whether they have changed since."""

    def __init__(self, root: Path, account: Account) -> None:
        self.root = Path(os.path.realpath(root))
        self.account = account
        self._read: dict[Path, tuple[int, int]] = {}
        self._contents: dict[Path, bytes] = {}

    def read_model(self, path: Path) -> bytes:
        """Read the model file itself, wherever it is."""
        return self._read_regular(path, "the file")

    def read_uri(self, uri: str) -> bytes:
        """Read a glTF URI: `data:` or a percent-encoded relative path."""
        if uri[:5].lower() == "data:":
            return self._decode_data_uri(uri)
        if _SCHEME.match(uri):
            raise ModelError(f"'{one_line(uri, 60)}' has a scheme; accepted: a relative path or data:")
        return self.read_relative(urllib.parse.unquote(uri, errors="surrogateescape"))

    def read_relative(self, name: str, start: Path | None = None) -> bytes:
        """Read the file `name`, relative to `start` (default: this folder), with the separators of both systems."""
        path = self.find(name, start)
        if path not in self._contents:  # named a thousand times, it is read and held once
            self._contents[path] = self._read_regular(path, f"'{one_line(name, 80)}'")
        return self._contents[path]

    def find(self, name: str, start: Path | None = None) -> Path:
        """Resolve `name` inside this folder; ModelError when it leads out of it. It need not exist."""
        shown = one_line(name, 80)
        relative = name.replace("\\", "/")
        if not relative or "\0" in relative or relative.startswith("/") or re.match(r"[A-Za-z]:", relative):
            raise ModelError(f"'{shown}' is not a relative path; accepted: a file inside the model's folder")
        try:
            resolved = Path(os.path.realpath((start or self.root) / relative))
        except (OSError, ValueError) as error:
            raise ModelError(f"'{shown}' cannot be used as a path") from error
        if not resolved.is_relative_to(self.root):
            raise ModelError(f"'{shown}' leads out of the model's folder; accepted: a file inside it")
        return resolved

    @property
    def files(self) -> tuple[str, ...]:
        """Paths of all files read so far."""
        return tuple(map(str, self._read))

    def changed(self) -> bool:
        """Tell whether a file that was read has changed since, or gone."""
        return any(_stamp_of(path) != stamp for path, stamp in self._read.items())

    def _read_regular(self, path: Path, shown: str) -> bytes:
        try:
            handle = os.open(path, _OPEN_FLAGS)
        except (OSError, ValueError) as error:
            reason = getattr(error, "strerror", None) or "not a usable path"
            raise ModelError(f"{shown} cannot be opened: {reason.lower()}") from error
        try:
            status = os.fstat(handle)
            if not stat.S_ISREG(status.st_mode):
                raise ModelError(f"{shown} is not a regular file")
            self.account.charge_bytes(status.st_size)
            self._read[path] = (status.st_size, status.st_mtime_ns)
            with os.fdopen(handle, "rb", closefd=False) as file:
                # One byte more than announced shows that a file is growing; it is not read without end.
                return file.read(status.st_size + 1)
        except OSError as error:
            raise ModelError(f"{shown} cannot be read: {(error.strerror or 'error').lower()}") from error
        finally:
            os.close(handle)

    def _decode_data_uri(self, uri: str) -> bytes:
        header, comma, payload = uri.partition(",")
        if not comma:
            raise ModelError("a data: URI has no comma before its data")
        self.account.charge_bytes(len(payload) * 3 // 4)
        if not header.lower().endswith(";base64"):
            return urllib.parse.unquote_to_bytes(payload.encode("utf-8", "replace"))
        try:
            return base64.b64decode(payload, validate=True)
        except (binascii.Error, ValueError) as error:
            raise ModelError("a data: URI is not valid base64") from error


def _stamp_of(path: Path) -> tuple[int, int] | None:
    try:
        status = os.stat(path)
    except OSError:
        return None
    return status.st_size, status.st_mtime_ns
