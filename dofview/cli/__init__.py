"""The command line: what a person types to settings and back to one line of complaint.

Exit status: 0 done, 2 bad input, 3 cannot write, 4 no usable OpenGL, 130 interrupted. A bug keeps its traceback.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence

from dofview.errors import DofviewError

CANNOT_WRITE, INTERRUPTED = 3, 130


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command in `arguments` (those of the process when None) and return its exit status."""
    # Mesa's loader complains on its own about what `GLError` then says once, with the remedy.
    os.environ.setdefault("EGL_LOG_LEVEL", "fatal")
    try:
        from dofview.cli.app import run

        run(list(sys.argv[1:] if arguments is None else arguments))
        sys.stdout.flush()
        return 0
    except DofviewError as error:
        return _complain(str(error), error.exit_status)
    except MemoryError:
        return _complain("needs more memory than there is; accepted: a smaller picture or scene", 2)
    except KeyboardInterrupt:
        return _complain("interrupted", INTERRUPTED)
    except BrokenPipeError:
        return _closed_output()
    except OSError as error:
        # Only standard output is written outside of export.py, which raises errors of its own.
        if error.filename is not None or sys.stdout is None:
            raise
        _closed_output()
        return _complain(f"cannot write to standard output: {(error.strerror or str(error)).lower()}", CANNOT_WRITE)


def _complain(message: str, status: int) -> int:
    from dofview.scene.notes import one_line

    print(f"dofview: {one_line(' '.join(message.split()), 2000)}", file=sys.stderr)
    return status


def _closed_output() -> int:
    """Nobody reads on; hand the interpreter an output that it can flush when it ends."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    return CANNOT_WRITE
