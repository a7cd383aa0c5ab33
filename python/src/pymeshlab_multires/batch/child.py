"""The process a mesh is worked on in. What crashes pymeshlab then costs that mesh alone.

A child reads a job a line from its standard input and writes a record a line; it ends with its input.
"""

import contextlib
import dataclasses
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import threading
from typing import Any

from .mesh import Job, process

STATUS = pathlib.Path("/proc/self/status")
REFS = pathlib.Path("/proc/self/clear_refs")


class ChildDied(Exception):
    """The process ended while it worked on a mesh, or was ended."""


class Child:
    """A process for meshes, one after the other, started with the first.

    threads: for each filter; limit: bytes it may take, beyond which filters fail for lack of memory. None: no limit.
    """

    def __init__(self, threads: int, limit: int | None) -> None:
        self._settings = {"MULTIRES_THREADS": str(threads), "MULTIRES_BATCH_LIMIT": str(limit or 0)}
        self._process: subprocess.Popen[str] | None = None
        self._errors = tempfile.TemporaryFile()

    def _started(self) -> "subprocess.Popen[str]":
        if self._process is None:
            package = str(pathlib.Path(__file__).parents[2])  # also if it lies where only this process looks
            path = os.pathsep.join([package, *filter(None, [os.environ.get("PYTHONPATH")])])
            self._errors.truncate(0)
            self._process = subprocess.Popen(
                [sys.executable, "-c", f"from {__name__} import serve; serve()"], text=True, encoding="utf-8", bufsize=1,
                stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self._errors,
                env=os.environ | self._settings | {"PYTHONPATH": path})  # fmt: skip
        return self._process

    def run(self, job: Job, timeout: float | None) -> dict[str, Any]:
        """The record of the job.

        Raises ChildDied, with what is known of the reason; the next job gets a new process.
        """
        child = self._started()
        assert child.stdin and child.stdout
        late = threading.Event()

        def give_up() -> None:
            late.set()
            child.kill()

        timer = threading.Timer(timeout or 0, give_up)
        if timeout is not None:
            timer.start()
        try:
            with contextlib.suppress(BrokenPipeError):
                child.stdin.write(json.dumps(dataclasses.asdict(job)) + "\n")
            line = child.stdout.readline()
        finally:
            timer.cancel()
        if line.endswith("\n"):
            return dict(json.loads(line))
        reason = f"took longer than {timeout:g} s" if late.is_set() else self._reason(child.wait())
        self.stop()
        raise ChildDied(reason)

    def _reason(self, code: int) -> str:
        self._errors.seek(0)
        said = self._errors.read().decode(errors="replace").strip().splitlines()[-1:]
        how = f"signal {-code}" if code < 0 else f"exit code {code}"
        return ": ".join([f"the process ended with {how}", *said])

    def stop(self) -> None:
        """Ends the process, whatever it is doing."""
        if self._process is not None:
            self._process.kill()
            self._process.communicate()
            self._process = None


def _set_limit(limit: int) -> None:
    if limit > 0:
        with contextlib.suppress(ImportError, ValueError, OSError):  # not everywhere
            import resource

            resource.setrlimit(resource.RLIMIT_DATA, (limit, limit))


def _peak() -> int | None:
    """Bytes this process had at most since the last call; None where that is not told."""
    try:
        line = next(line for line in STATUS.read_text().splitlines() if line.startswith("VmHWM"))
        REFS.write_text("5")  # begins anew
    except (OSError, StopIteration):
        return None
    return int(line.split()[1]) * 1024


def serve() -> None:
    """What a child does. What libraries print goes nowhere: standard output is for records."""
    _set_limit(int(os.environ.get("MULTIRES_BATCH_LIMIT", "0")))
    records = os.fdopen(os.dup(1), "w", encoding="utf-8", buffering=1)
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    base = _peak()
    for line in sys.stdin:
        record = process(Job.from_dict(json.loads(line)))
        peak = _peak()
        record["peak_bytes"] = peak
        record["mesh_bytes"] = peak - base if peak is not None and base is not None else None
        records.write(json.dumps(record) + "\n")
