"""`python -m dofview`."""

from __future__ import annotations

import sys

from dofview.cli import main

sys.exit(main())
