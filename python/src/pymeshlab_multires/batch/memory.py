"""How much memory a mesh will take, and room for only as many at once as fit."""

import contextlib
import os
import pathlib
import threading
from collections.abc import Iterator

PROCESS = 250 << 20  # bytes of Python and pymeshlab with all plugins
FIRST_RATE = 60.0  # bytes of memory a byte of a file of a kind not met yet: above what is measured for binary .ply


def available() -> int | None:
    """Bytes of memory that are free here; None where that is not told."""
    with contextlib.suppress(OSError, StopIteration):
        lines = pathlib.Path("/proc/meminfo").read_text().splitlines()
        return int(next(line for line in lines if line.startswith("MemAvailable")).split()[1]) * 1024
    with contextlib.suppress(OSError, ValueError, AttributeError):
        return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    return None


class Room:
    """Memory for meshes. Who asks for more than is left waits; a mesh too large for all of it has it to itself.

    What a mesh needs is estimated from the size of its file by what files of the same kind took before.
    """

    def __init__(self, total: int | None) -> None:
        self.total = total
        self._used = 0
        self._changed = threading.Condition()
        self._rate: dict[str, float] = {}

    def estimate(self, path: str, size: int) -> int:
        return PROCESS + int(size * self._rate.get(pathlib.Path(path).suffix.lower(), FIRST_RATE))

    def learn(self, path: str, size: int, mesh_bytes: int | None) -> None:
        """Notes what a mesh took. The largest rate counts, from files that are large enough to tell."""
        if mesh_bytes is not None and size >= 1 << 20:
            kind = pathlib.Path(path).suffix.lower()
            with self._changed:
                self._rate[kind] = max(self._rate.get(kind, 0.0), mesh_bytes / size)

    @contextlib.contextmanager
    def take(self, path: str, size: int) -> Iterator[None]:
        """Room for the mesh in that file, as long as the context lasts."""
        with self._changed:
            self._changed.wait_for(lambda: self._fits(self.estimate(path, size)))
            taken = self.estimate(path, size)
            self._used += taken
        try:
            yield
        finally:
            with self._changed:
                self._used -= taken
                self._changed.notify_all()

    def _fits(self, bytes_wanted: int) -> bool:
        return self.total is None or self._used == 0 or self._used + bytes_wanted <= self.total
