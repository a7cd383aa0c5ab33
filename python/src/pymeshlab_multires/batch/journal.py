"""What became of each mesh: a journal to resume from, the table of the reports, the log of errors."""

import contextlib
import csv
import hashlib
import json
import os
import pathlib
import tempfile
from collections.abc import Iterable, Iterator, Sequence
from typing import Any, TextIO

from .mesh import Job

Record = dict[str, Any]

COLUMNS = ("input", "output", "status", "error", "seconds", "vertices_before", "faces_before", "vertices", "faces",
           "peak_bytes", "host")  # fmt: skip


def fingerprint(job: Job) -> str:
    """Equal for jobs that would give the same: input as it is now, steps, output and attributes.

    Raises OSError if there is no such input.
    """
    at = os.stat(job.input)
    steps = [vars(step) for step in job.steps]
    what = json.dumps([job.input, at.st_size, at.st_mtime_ns, job.output, steps, job.attributes], sort_keys=True)
    return hashlib.sha256(what.encode()).hexdigest()[:32]


class Journal:
    """A line of JSON for each mesh that is done with, written at once, so that nothing is lost with the process."""

    def __init__(self, path: pathlib.Path, resume: bool) -> None:
        self.done: dict[str, Record] = {}
        if resume and path.exists():
            for line in path.read_text(encoding="utf-8").splitlines():
                with contextlib.suppress(ValueError, KeyError):  # the last line may be torn
                    record = json.loads(line)
                    self.done[record["fingerprint"]] = record
        self._file: TextIO = path.open("a" if resume else "w", encoding="utf-8")
        if self._file.tell() > 0:
            self._file.write("\n")  # behind a torn line

    def finished(self, job: Job, mark: str) -> Record | None:
        """The record of that job if it need not be done again."""
        record = self.done.get(mark)
        missing = job.output is not None and not pathlib.Path(job.output).exists()
        return None if record is None or record["status"] != "ok" or missing else record

    def add(self, record: Record) -> None:
        self._file.write(json.dumps(record) + "\n")
        self._file.flush()

    def close(self) -> None:
        self._file.close()


@contextlib.contextmanager
def replacing(path: pathlib.Path) -> Iterator[pathlib.Path]:
    """A path beside the given one, which it replaces if all goes well."""
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, beside = tempfile.mkstemp(path.suffix, f".{path.stem}.", path.parent)
    os.close(handle)
    try:
        yield pathlib.Path(beside)
        os.chmod(beside, 0o666 & ~_umask())
        os.replace(beside, path)
    finally:
        with contextlib.suppress(FileNotFoundError):
            os.unlink(beside)


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask


def _columns(records: Iterable[Record]) -> list[str]:
    return [*COLUMNS, *dict.fromkeys(name for record in records for name in record["values"])]


def _cell(record: Record, column: str) -> Any:
    return record.get(column, "") if column in COLUMNS else record["values"].get(column)


def _write_csv(path: pathlib.Path, records: Sequence[Record]) -> None:
    """Lists as JSON."""
    columns = _columns(records)
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(columns)
        for record in records:
            cells = [_cell(record, column) for column in columns]
            writer.writerow([json.dumps(cell) if isinstance(cell, (list, bool)) else cell for cell in cells])


def _write_parquet(path: pathlib.Path, records: Sequence[Record]) -> None:
    import pyarrow  # type: ignore[import-not-found, import-untyped, unused-ignore]
    import pyarrow.parquet  # type: ignore[import-not-found, import-untyped, unused-ignore]

    def column(name: str) -> list[Any]:
        cells = [_cell(record, name) for record in records]
        cells = [None if cell == "" else cell for cell in cells]
        mixed = {type(cell) for cell in cells} >= {int, float}
        return [float(cell) if mixed and isinstance(cell, int) else cell for cell in cells]

    table = pyarrow.table({name: column(name) for name in _columns(records)})
    pyarrow.parquet.write_table(table, path)


def write_table(path: pathlib.Path, records: Sequence[Record]) -> None:
    """A row for each mesh: what became of it and what every filter returned, as NAME_OF_FILTER.NAME_OF_VALUE."""
    with replacing(path) as beside:
        (_write_parquet if path.suffix == ".parquet" else _write_csv)(beside, records)


def write_errors(path: pathlib.Path, records: Iterable[Record]) -> None:
    """A line for each mesh that failed; no file if none did."""
    lines = [f"{record['input']}: {record['error']}\n" for record in records if record["status"] != "ok"]
    if lines:
        with replacing(path) as beside:
            beside.write_text("".join(lines), encoding="utf-8")
    else:
        path.unlink(missing_ok=True)
