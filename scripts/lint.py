#!/usr/bin/env python3
"""Runs clang-tidy over our sources, as they are compiled in the given build folders, on all cores.

    scripts/lint.py BUILD...

A source that passed is not looked at again until it, a header of ours that it includes, its compile command or
.clang-tidy changes: what passed is noted in .cache/lint/ under the hash of all these.
"""

import concurrent.futures
import hashlib
import json
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PASSED = ROOT / ".cache/lint"
FOLDERS = ("common", "plugins", "meshes")


def sources(build):
    """Our sources that are compiled in the build folder, with their commands."""
    for entry in json.loads((build / "compile_commands.json").read_text()):
        path = pathlib.Path(entry["directory"], entry["file"]).resolve()
        if path.is_relative_to(ROOT) and path.relative_to(ROOT).parts[0] in FOLDERS:
            yield path, entry["command"]


def headers(build):
    """Our own headers that each object of the build was made from, as ninja noted them."""
    found, current = {}, None
    for line in subprocess.check_output(["ninja", "-C", build, "-t", "deps"], text=True).splitlines():
        if line and not line.startswith(" "):
            current = found.setdefault(line.split(":")[0], set())
        elif line.strip():
            path = pathlib.Path(build, line.strip()).resolve()
            if path.is_relative_to(ROOT) and path.relative_to(ROOT).parts[0] in FOLDERS:
                current.add(path)
    return found


def key(path, command, included):
    digest = hashlib.sha256(command.replace(str(ROOT), ".").encode())  # the same in every clone
    for file in [ROOT / ".clang-tidy", path, *sorted(included)]:
        digest.update(file.read_bytes())
    return digest.hexdigest()


def jobs(builds):
    """(source, build folder, key) of what has to be looked at, each source once."""
    seen = set()
    for build in builds:
        deps = headers(build)
        for path, command in sources(build):
            if path in seen:
                continue
            seen.add(path)
            words = command.split()
            included = deps.get(words[words.index("-o") + 1], set())
            k = key(path, command, included)
            if not (PASSED / k).exists():
                yield path, build, k


def check(job):
    path, build, k = job
    done = subprocess.run(
        ["clang-tidy", "--quiet", "-p", build, path], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    )
    if done.returncode == 0:
        (PASSED / k).touch()
        return ""
    return f"{path.relative_to(ROOT)}\n{done.stdout}"


def main():
    PASSED.mkdir(parents=True, exist_ok=True)
    todo = list(jobs([pathlib.Path(b).resolve() for b in sys.argv[1:]]))
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        faults = [fault for fault in pool.map(check, todo) if fault]
    print(*faults, sep="\n")
    print(f"clang-tidy: looked at {len(todo)} sources, {len(faults)} with faults")
    return 1 if faults else 0


sys.exit(main())
