"""The bar on standard error."""

import sys
import time


class Progress:
    """A bar that is drawn over on a terminal, and a line for every tenth of the meshes elsewhere."""

    def __init__(self, total: int, quiet: bool) -> None:
        self._total, self._quiet = total, quiet
        self._terminal = sys.stderr.isatty()
        self._start = time.monotonic()
        self._done = self._failed = self._drawn = 0

    def _line(self) -> str:
        share = self._done / self._total
        left = (time.monotonic() - self._start) * (1 / share - 1)
        time_left = f"{left / 60:.0f} min" if left >= 90 else f"{left:.0f} s"
        failed = f", {self._failed} failed" if self._failed else ""
        bar = "#" * round(30 * share)
        return f"[{bar:.<30}] {self._done} of {self._total}{failed}, {time_left} left"

    def add(self, failure: str = "") -> None:
        """One more mesh is done with; a failure is said."""
        self._done += 1
        self._failed += bool(failure)
        if self._quiet:
            return
        if failure:
            print(("\r\033[K" if self._terminal else "") + failure, file=sys.stderr)
        tenth = 10 * self._done // self._total
        if self._terminal:
            print(f"\r\033[K{self._line()}", end="", file=sys.stderr, flush=True)
        elif tenth > self._drawn:
            print(self._line(), file=sys.stderr, flush=True)
        self._drawn = tenth

    def close(self) -> None:
        if self._terminal and not self._quiet:
            print(file=sys.stderr)
