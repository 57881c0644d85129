"""One line on a terminal that says how far a run is."""

import sys
import time

_EVERY_S = 0.2


class Progress:
    """Jobs done, jobs a second; nothing where stderr is no terminal or `quiet` is set."""

    def __init__(self, quiet: bool) -> None:
        """Start the clock."""
        self._shown = not quiet and sys.stderr.isatty()
        self._begin = time.monotonic()
        self._last = self._begin

    def show(self, done: int) -> None:
        """Say that `done` jobs are done."""
        now = time.monotonic()
        if self._shown and now - self._last >= _EVERY_S:
            self._last = now
            rate = done / (now - self._begin)
            sys.stderr.write(f"\r\033[K{done} jobs done, {rate:.1f} a second")
            sys.stderr.flush()

    def clear(self) -> None:
        """Take the line away."""
        if self._shown:
            sys.stderr.write("\r\033[K")
            sys.stderr.flush()
