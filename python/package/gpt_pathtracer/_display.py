"""What is seen of a render while it goes on, in a terminal or in a notebook."""

from __future__ import annotations

import importlib
import sys
import time
from typing import Any, Optional, TextIO, TypeVar

Shown = TypeVar("Shown")

#: Columns of a bar.
_COLUMNS = 30


class Bar:
    """A line that tells how far a render is. In a notebook it is an output that is written anew, elsewhere a line of standard error."""

    def __init__(self, stream: Optional[TextIO] = None) -> None:
        self._start = time.monotonic()
        self._stream = stream or sys.stderr
        self._handle: Any = _notebook()
        self._ended = False

    def __call__(self, done: int, total: int) -> None:
        line = self.line(done, total, time.monotonic() - self._start)
        if self._handle is not None:
            self._handle.update({"text/plain": line}, raw=True)
        else:
            self._stream.write(f"\r{line}")
            self._stream.flush()

    def close(self) -> None:
        """Ends the line, once."""
        if self._handle is None and not self._ended:
            self._stream.write("\n")
        self._ended = True

    @staticmethod
    def line(done: int, total: int, seconds: float) -> str:
        """Share, bar, and the seconds that passed and that are left."""
        share = done / total if total else 1.0
        filled = int(_COLUMNS * share)
        left = f", {seconds / share - seconds:.0f} s left" if 0 < share < 1 else ""
        return f"{share:4.0%} [{'#' * filled}{'.' * (_COLUMNS - filled)}] {seconds:.0f} s{left}   "


class Canvas:
    """An output of a notebook that shows one picture after the other in one place."""

    def __init__(self, handle: Any) -> None:
        self._handle = handle

    @staticmethod
    def of_notebook() -> Optional[Canvas]:
        """One where a notebook runs; None elsewhere."""
        handle = _notebook()
        return None if handle is None else Canvas(handle)

    def show(self, picture: Shown) -> Shown:
        """Shows the picture in place of the one before, and gives it back."""
        self._handle.update(picture)
        return picture


def _notebook() -> Any:
    """A display of a running notebook; None elsewhere. IPython is asked only where it is loaded already."""
    shell = sys.modules.get("IPython")
    get = getattr(shell, "get_ipython", None)
    running = get() if get else None
    if running is None or not hasattr(running, "kernel"):
        return None
    # Types of IPython differ from version to version, and are missing where it is.
    display: Any = importlib.import_module("IPython.display")
    return display.display({"text/plain": ""}, raw=True, display_id=True)
