"""Every failure a person can cause or meet, in one tree; anything else that is raised is a bug.

DofviewError             one line: what, where, what would be accepted
├── InputError           exit status 2: a file, flag, preset or view that cannot be used
│   ├── ModelError       a scene file: names the file, the object in it and the reason
│   └── SettingsError    a view, preset or parameter: names the key, the value and the range
├── OutputError          exit status 3: a result that cannot be written
└── GLError              exit status 4: no usable OpenGL, with the remedy
    └── ShaderError      a shader that does not compile, with file:line and an excerpt
"""

from __future__ import annotations


class DofviewError(Exception):
    """A failure that is reported in one line and ends a command with `exit_status`."""

    exit_status = 1


class InputError(DofviewError):
    """Something handed in cannot be used."""

    exit_status = 2


class ModelError(InputError):
    """A scene file cannot be loaded."""


class SettingsError(InputError):
    """A setting is unknown or out of range."""


class OutputError(DofviewError):
    """A result cannot be written; nothing half-written is left behind."""

    exit_status = 3


class GLError(DofviewError):
    """OpenGL is missing or too old."""

    exit_status = 4


class ShaderError(GLError):
    """A shader does not compile or link."""
