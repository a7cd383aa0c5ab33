"""One mesh: loaded, filtered, written beside its place and renamed."""

import dataclasses
import os
import pathlib
import shutil
import tempfile
import time
from typing import Any

import numpy as np

from .._call import forget_failed_document
from .chain import Step, Value

PART = ".part"  # what is being written lies in folders whose names end so


@dataclasses.dataclass
class Job:
    """One mesh to be worked on."""

    input: str
    output: str | None
    """None: only the reports are wanted."""
    steps: list[Step]
    attributes: list[str]
    """Custom vertex attributes to be written; only .ply holds them."""

    @staticmethod
    def from_dict(values: dict[str, Any]) -> "Job":
        return Job(**values | {"steps": [Step(**step) for step in values["steps"]]})


def _argument(value: Value) -> Any:
    import pymeshlab  # type: ignore[import-untyped, unused-ignore]

    if isinstance(value, dict):
        kind, number = next(iter(value.items()))
        return {"percent": pymeshlab.PercentageValue, "absolute": pymeshlab.PureValue}[kind](number)
    return np.array(value) if isinstance(value, list) else value


def _plain(value: Any) -> Any:
    """As JSON has it."""
    return value.tolist() if isinstance(value, (np.ndarray, np.generic)) else value


def _apply(ms: Any, step: Step) -> dict[str, Any]:
    """Applies the step to the current mesh; its report, as JSON has it."""
    if step.script:
        with tempfile.TemporaryDirectory() as folder:
            script = pathlib.Path(folder, "filter.mlx")
            script.write_text(step.script, encoding="utf-8")
            ms.load_filter_script(str(script))
            ms.apply_filter_script()
        return {}
    returned = ms.apply_filter(step.filter, **{name: _argument(value) for name, value in step.values.items()})
    return {f"{step.label}.{key}": _plain(value) for key, value in dict(returned or {}).items()}


def _write(ms: Any, job: Job, path: pathlib.Path) -> None:
    """Writes into a folder of its own beside the path, then renames: nobody ever sees half a file there.

    Textures and materials are renamed before the mesh that names them.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    options = {f"__ca_vs__{name.lower()}": True for name in job.attributes}
    folder = pathlib.Path(tempfile.mkdtemp(PART, f".{path.name}.", path.parent))
    try:
        ms.save_current_mesh(str(folder / path.name), **options)
        for file in sorted(folder.iterdir(), key=lambda file: file.name == path.name):
            with file.open("rb") as written:
                os.fsync(written.fileno())
            file.replace(path.parent / file.name)
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def _size(ms: Any) -> tuple[int, int]:
    return ms.current_mesh().vertex_number(), ms.current_mesh().face_number()


def process(job: Job) -> dict[str, Any]:
    """Works on one mesh; what became of it, for the journal. No exception leaves it but those that end a process.

    A file that holds several meshes becomes one mesh.
    """
    import pymeshlab

    start = time.perf_counter()
    record: dict[str, Any] = {"status": "failed", "error": "", "values": {}}
    try:
        ms = pymeshlab.MeshSet(verbose=False)
        ms.load_new_mesh(job.input)
        if ms.mesh_number() > 1:
            ms.apply_filter("generate_by_merging_visible_meshes", mergevertices=False)
        record["vertices_before"], record["faces_before"] = _size(ms)
        for step in job.steps:
            record["values"] |= _apply(ms, step)
        record["vertices"], record["faces"] = _size(ms)
        if job.output is not None:
            _write(ms, job, pathlib.Path(job.output))
        record["status"] = "ok"
    except Exception as error:
        said = "not enough memory" if isinstance(error, MemoryError) else " ".join(str(error).split())
        record["error"] = said or type(error).__name__
        forget_failed_document()
    record["seconds"] = round(time.perf_counter() - start, 4)
    return record
