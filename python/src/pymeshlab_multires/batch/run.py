"""Works on all meshes, here or over Dask."""

import collections
import concurrent.futures
import contextlib
import dataclasses
import importlib
import os
import pathlib
import shutil
from collections.abc import Callable, Iterator, Sequence
from typing import Any

from .journal import Journal, Record, fingerprint, write_errors, write_table
from .memory import available
from .mesh import PART, Job
from .progress import Progress
from .work import Settings, stop_children, work

AHEAD = 4  # jobs that wait at the scheduler for each thread of the cluster


@dataclasses.dataclass
class Batch:
    """What is to be done, and how."""

    jobs: list[Job]
    folder: pathlib.Path
    table: pathlib.Path
    settings: Settings
    processes: int = 0
    """0: one for each core."""
    scheduler: str = ""
    """Address of a Dask scheduler; empty: this machine."""
    resume: bool = False
    quiet: bool = False


Result = tuple[Job, Record]


def here(jobs: Sequence[Job], batch: Batch) -> Iterator[Result]:
    """Each job with its record, as they are done, by processes of this machine."""
    cores = os.cpu_count() or 1
    count = batch.processes or cores
    free = available()
    memory = batch.settings.memory or (free * 8 // 10 if free else None)
    settings = dataclasses.replace(batch.settings, threads=max(1, cores // count), memory=memory)
    pool = concurrent.futures.ThreadPoolExecutor(count)
    try:
        futures = {pool.submit(work, job, settings): job for job in jobs}
        for future in concurrent.futures.as_completed(futures):
            yield futures.pop(future), future.result()
    finally:
        pool.shutdown(wait=False, cancel_futures=True)
        stop_children()
        pool.shutdown()


# ---- Dask ------------------------------------------------------------------------------------------------------------


def work_on_worker(job: Job, settings: Settings) -> Record:
    """On a worker: its memory and cores are shared by its threads."""
    worker = importlib.import_module("distributed").get_worker()
    limit = worker.memory_manager.memory_limit
    threads = max(1, (os.cpu_count() or 1) // worker.state.nthreads)
    memory = settings.memory or (limit * 8 // 10 if limit else None)
    return work(job, dataclasses.replace(settings, threads=threads, memory=memory))


def _outcome(future: Any) -> Record:
    error = future.exception()
    return dict(future.result()) if error is None else {"status": "failed", "values": {}, "error": str(error)}


def over_dask(jobs: Sequence[Job], batch: Batch) -> Iterator[Result]:
    """The same by the workers of a cluster, which see the same files. Dask gives what a dead worker had to another."""
    distributed = importlib.import_module("distributed")
    with distributed.Client(batch.scheduler, set_as_default=False) as client:
        threads = sum(client.nthreads().values())
        waiting = collections.deque(jobs)
        running: dict[Any, Job] = {}
        done = distributed.as_completed(loop=client.loop)
        while waiting or running:
            while waiting and len(running) < max(8, AHEAD * threads):
                job = waiting.popleft()
                future = client.submit(work_on_worker, job, batch.settings, pure=False)
                running[future] = job
                done.add(future)
            future = next(done)
            yield running.pop(future), _outcome(future)
            threads = max(threads, sum(client.nthreads().values())) if len(waiting) % 100 == 0 else threads


# ---- all of it -------------------------------------------------------------------------------------------------------


def _remove_leftovers(jobs: Sequence[Job]) -> None:
    """What a run that was killed was writing."""
    names = collections.defaultdict(set)
    for job in jobs:
        if job.output is not None:
            path = pathlib.Path(job.output)
            names[path.parent].add(path.name)
    for folder, outputs in names.items():
        for part in folder.glob(f".*{PART}") if folder.is_dir() else []:
            if part.name[1 : -len(PART)].rpartition(".")[0] in outputs:
                shutil.rmtree(part, ignore_errors=True)


def _largest_first(jobs: Sequence[Job]) -> list[Job]:
    """Small ones fill the gaps at the end. Those that are not there come first, to fail at once."""

    def size(job: Job) -> float:
        with contextlib.suppress(OSError):
            return os.stat(job.input).st_size
        return float("inf")

    return sorted(jobs, key=size, reverse=True)


def run(batch: Batch) -> list[Record]:
    """The records of all jobs, in their order. Table and log are written also if the run is interrupted.

    An input that cannot be worked on is a record that says so; it does not stop the others.
    """
    batch.folder.mkdir(parents=True, exist_ok=True)
    journal = Journal(batch.folder / "journal.jsonl", batch.resume)
    marks: dict[str, str] = {}
    records: dict[str, Record] = {}
    for job in batch.jobs:
        with contextlib.suppress(OSError):
            marks[job.input] = fingerprint(job)
            finished = journal.finished(job, marks[job.input])
            if finished:
                records[job.input] = finished
    todo = _largest_first([job for job in batch.jobs if job.input not in records])
    _remove_leftovers(todo)
    progress = Progress(len(todo), batch.quiet)
    source: Callable[[Sequence[Job], Batch], Iterator[Result]] = over_dask if batch.scheduler else here
    results = source(todo, batch)
    try:
        for job, record in results:
            record |= {"input": job.input, "output": job.output or "", "fingerprint": marks.get(job.input, "")}
            records[job.input] = record
            journal.add(record)
            progress.add("" if record["status"] == "ok" else f"{job.input}: {record['error']}")
    finally:
        results.close()  # type: ignore[attr-defined]
        progress.close()
        journal.close()
        _remove_leftovers(todo)
        known = [records[job.input] for job in batch.jobs if job.input in records]
        write_table(batch.table, known)
        write_errors(batch.folder / "errors.log", known)
    return known
