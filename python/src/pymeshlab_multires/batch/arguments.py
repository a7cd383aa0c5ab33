"""The command line, and the files it means."""

import argparse
import glob
import importlib.util
import os
import pathlib
from collections.abc import Sequence

from .._filters import FILTERS
from .chain import Step, find_filter, numbered, read_script, set_value, similar
from .mesh import Job
from .run import Batch
from .work import Settings

# What pymeshlab 2025.7 reads and writes; it has no list of these.
READS = {".3ds", ".3mf", ".apts", ".asc", ".bre", ".ctm", ".dae", ".e57", ".glb", ".gltf", ".gts", ".obj", ".off",
         ".pdb", ".ply", ".ptx", ".pts", ".qobj", ".stl", ".tri", ".txt", ".vmi", ".wrl", ".x3d", ".x3dv", ".xyz"}  # fmt: skip
WRITES = {".3ds", ".3mf", ".bre", ".ctm", ".dae", ".dxf", ".gts", ".idtf", ".json", ".obj", ".off", ".ply", ".stl",
          ".u3d", ".wrl", ".x3d", ".xyz"}  # fmt: skip

USAGE = "python -m pymeshlab_multires FILTER [NAME=VALUE ...] [FILTER ...] INPUT [INPUT ...] -o FOLDER [options]"

WORDS = """Applies filters to many meshes.

FILTER is a function of this package (denoise, low_pass), a filter of pymeshlab by its name there
(meshing_remove_duplicate_vertices), or a filter script (.mlx); several are applied one after the other. NAME=VALUE is a
parameter of the filter before it. For filters of pymeshlab a length is 1%% (of the box's diagonal) or abs:0.5.

INPUT is a file, a pattern in quotes ("scans/**/*.ply"), a folder (every mesh below it), or @LIST, a file that names one a
line. The folders below the one that all inputs share are kept in FOLDER.

In FOLDER, journal.jsonl notes what is done with, for --resume; reports.csv has a row for each mesh, with what the filters
returned; errors.log says what failed. The exit code is 0 if nothing did, 1 if a mesh did, 2 for a mistake here."""


class Mistake(Exception):
    """In what the command line asks for."""


def parser() -> argparse.ArgumentParser:
    p = argparse.ArgumentParser("python -m pymeshlab_multires", USAGE, WORDS, fromfile_prefix_chars="@",
                                formatter_class=argparse.RawDescriptionHelpFormatter)  # fmt: skip
    p.add_argument("words", nargs="+", metavar="FILTER, NAME=VALUE, INPUT", help=argparse.SUPPRESS)
    p.add_argument("-o", "--output", required=True, type=pathlib.Path, metavar="FOLDER", help="where results go")
    p.add_argument("-j", "--jobs", type=int, default=0, metavar="N", help="processes; default: one for each core")
    p.add_argument("--format", metavar="EXT", help="write this format (ply); default: the input's, or ply")
    p.add_argument("--attribute", action="append", default=[], metavar="NAME",
                   help="write this custom vertex attribute (.ply only); may be given several times")  # fmt: skip
    p.add_argument("--no-meshes", action="store_true", help="write the table of reports only")
    p.add_argument("--table", type=pathlib.Path, metavar="FILE",
                   help="the table: .csv or, with pyarrow, .parquet; default: reports.csv in FOLDER")  # fmt: skip
    p.add_argument("--resume", action="store_true", help="leave out what is done and has not changed since")
    p.add_argument("--scheduler", default="", metavar="ADDRESS", help="use the Dask cluster of this scheduler")
    p.add_argument("--memory", type=float, metavar="GB",
                   help="for all meshes at once, on each machine or worker; default: 80 %% of what is free")  # fmt: skip
    p.add_argument("--timeout", type=float, metavar="SECONDS", help="give a mesh up after this time")
    p.add_argument("--retries", type=int, default=1, metavar="N", help="for meshes whose process died; default: 1")
    p.add_argument("-q", "--quiet", action="store_true", help="no progress and no errors on the terminal")
    return p


def split_words(words: Sequence[str]) -> tuple[list[Step], list[str]]:
    """The steps, and the inputs behind them."""
    steps: list[Step] = []
    for at, word in enumerate(words):
        path = pathlib.Path(word)
        if path.suffix.lower() == ".mlx":
            if not path.is_file():
                raise Mistake(f"there is no script {word}")
            steps += read_script(path)
        elif (step := find_filter(word)) is not None:
            steps.append(step)
        elif word.partition("=")[0].isidentifier() and "=" in word and not path.exists():
            if not steps or steps[-1].script:
                raise Mistake(f"{word} follows no filter")
            set_value(steps[-1], word)
        else:
            return numbered(steps), list(words[at:])
    return numbered(steps), []


def expand(words: Sequence[str], steps: Sequence[Step]) -> list[pathlib.Path]:
    """The files that are meant, each once. A file that was named is kept even if it is not there: it fails later."""
    files: list[pathlib.Path] = []
    for word in words:
        path = pathlib.Path(word)
        if path.is_dir():
            found = sorted(f for f in path.rglob("*") if f.suffix.lower() in READS and not f.name.startswith("."))
        elif not path.exists() and glob.has_magic(word):
            found = sorted(pathlib.Path(f) for f in glob.glob(word, recursive=True) if os.path.isfile(f))
        elif not path.exists() and not path.suffix:
            raise Mistake(f"{word} is neither a filter nor a file{similar(word, FILTERS)}")
        else:
            found = [path]
        if not found:
            raise Mistake(f"there are no meshes in {word}")
        files += found
    if not files:
        raise Mistake("no input")
    return list(dict.fromkeys(f.resolve() for f in files))


def _output(file: pathlib.Path, base: pathlib.Path, folder: pathlib.Path, extension: str | None) -> pathlib.Path:
    wanted = f".{extension.lower().lstrip('.')}" if extension else file.suffix.lower()
    if extension and wanted not in WRITES:
        raise Mistake(f"pymeshlab does not write {wanted}; it writes {' '.join(sorted(WRITES))}")
    return folder / file.relative_to(base).with_suffix(wanted if wanted in WRITES else ".ply")


def jobs(args: argparse.Namespace) -> list[Job]:
    """A job for each input; no two may have one output, and none its own input."""
    steps, words = split_words(args.words)
    if not steps:
        raise Mistake(f"{args.words[0]} is neither a filter nor a script{similar(args.words[0], FILTERS)}")
    files = expand(words, steps)
    base = pathlib.Path(os.path.commonpath([f.parent for f in files]))
    made: dict[pathlib.Path, pathlib.Path] = {}
    for file in [] if args.no_meshes else files:
        output = _output(file, base, args.output.resolve(), args.format)
        if output in made:
            raise Mistake(f"{made[output]} and {file} would both become {output}")
        if output in files:
            raise Mistake(f"{output} would replace an input")
        if args.attribute and output.suffix != ".ply":
            raise Mistake(f"{output}: only .ply holds custom attributes; add --format ply")
        made[output] = file
    outputs = {file: str(output) for output, file in made.items()}
    return [Job(str(file), outputs.get(file), steps, args.attribute) for file in files]


def _check_modules(batch: Batch) -> None:
    wanted = {"pyarrow": batch.table.suffix == ".parquet", "distributed": bool(batch.scheduler)}
    for module, needed in wanted.items():
        if needed and importlib.util.find_spec(module) is None:
            raise Mistake(f"this needs the package {module}: pip install {module}")


def batch(words: Sequence[str] | None = None) -> Batch:
    """What the command line asks for. A mistake in it ends the program with code 2, before anything is done."""
    p = parser()
    args = p.parse_intermixed_args(words)
    try:
        if args.jobs < 0 or args.retries < 0:
            raise Mistake("--jobs and --retries must not be negative")
        memory = None if args.memory is None else int(args.memory * 1e9)
        settings = Settings(memory=memory, timeout=args.timeout, retries=args.retries)
        table = (args.table or args.output / "reports.csv").resolve()
        if table.suffix not in (".csv", ".parquet"):
            raise Mistake(f"{table.name}: a table is .csv or .parquet")
        asked = Batch(jobs(args), args.output.resolve(), table, settings, args.jobs, args.scheduler, args.resume, args.quiet)
        _check_modules(asked)
    except (Mistake, ValueError) as mistake:
        p.error(str(mistake))
    return asked
