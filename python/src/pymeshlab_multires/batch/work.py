"""Work on one mesh from the thread that asks for it: room in memory, a child process of its own, retries."""

import dataclasses
import pathlib
import platform
import threading
from typing import Any

from .child import Child, ChildDied
from .memory import Room
from .mesh import Job


@dataclasses.dataclass
class Settings:
    """How meshes are worked on in one process of this program, or in one worker of a cluster."""

    threads: int = 1
    """Of each filter."""
    memory: int | None = None
    """Bytes for all meshes that are worked on at once. None: no limit."""
    timeout: float | None = None
    """Seconds for one mesh."""
    retries: int = 1
    """How often a mesh is tried again whose process died. A filter that fails would fail again."""


_lock = threading.Lock()
_rooms: dict[int | None, Room] = {}
_children: list[Child] = []
_of_thread = threading.local()


def _room(total: int | None) -> Room:
    with _lock:
        return _rooms.setdefault(total, Room(total))


def _child(settings: Settings) -> Child:
    """The child of this thread."""
    wanted = settings.threads, settings.memory
    if getattr(_of_thread, "settings", None) != wanted:
        _of_thread.settings, _of_thread.child = wanted, Child(*wanted)
        with _lock:
            _children.append(_of_thread.child)
    return _of_thread.child  # type: ignore[no-any-return]


def stop_children() -> None:
    """Ends all of them, whatever they are doing."""
    with _lock:
        for child in _children:
            child.stop()


def work(job: Job, settings: Settings) -> dict[str, Any]:
    """What became of the mesh, for the journal."""
    room = _room(settings.memory)
    record: dict[str, Any] = {"status": "failed", "values": {}}
    try:
        size = pathlib.Path(job.input).stat().st_size
        with room.take(job.input, size):
            for attempt in range(settings.retries + 1):
                try:
                    record = _child(settings).run(job, settings.timeout)
                    room.learn(job.input, size, record.pop("mesh_bytes", None))
                    break
                except ChildDied as died:
                    record["error"] = str(died)
    except OSError as error:
        record["error"] = str(error)
    return record | {"host": platform.node()}
