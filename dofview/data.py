"""Where the shaders and assets are: inside the installed package, or beside it in a checkout."""

from __future__ import annotations

from pathlib import Path

_PACKAGE = Path(__file__).resolve().parent
ROOT = _PACKAGE if (_PACKAGE / "shaders").is_dir() else _PACKAGE.parent
SHADERS = ROOT / "shaders"
ASSETS = ROOT / "assets"
