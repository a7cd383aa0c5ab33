#!/usr/bin/env python3
"""Runs clang-tidy over our sources, as they are compiled in the given build folders, on all cores; and checks the workflows.

    scripts/lint.py BUILD...

A source that passed is not looked at again until it, a header of ours that it includes, its compile command or
.clang-tidy changes: what passed is noted in .cache/lint/ under the hash of all these. Workflows are held against GitHub's
schema, every action in them must be pinned by a commit's hash, and actionlint checks them where it is installed.

Sources of one folder that are compiled alike are looked at as one, which takes a third of the time, for most of it goes
into the headers; those in which a name is that of another one are so as a second one. If anything is found each is looked
at alone: what counts is that.
"""

import collections
import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile

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
    """(source, command, key) of what has to be looked at, each source once."""
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
                yield path, command, k


def batches(todo):
    """Jobs whose sources are in one folder and have the same flags, by the flags."""
    found = collections.defaultdict(list)
    for path, command, k in todo:
        words = shlex.split(command)
        output = words.index("-o")
        flags = [w for w in words[1:output] + words[output + 2 :] if w not in ("-c", str(path))]
        if "-Winvalid-pch" in flags:  # GCC's precompiled header, which clang takes for a damaged one of its own
            first = flags.index("-Winvalid-pch")
            del flags[first : first + 3]
        found[path.parent, tuple(flags)].append((path, k))
    return [(flags, jobs) for (_, flags), jobs in found.items()]


def tidy(path, flags, *options):
    return subprocess.run(
        [ROOT / ".venv/bin/clang-tidy", "--quiet", f"--config-file={ROOT}/.clang-tidy", *options, path, "--", *flags],
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )


def tidy_as_one(paths, flags):
    with tempfile.NamedTemporaryFile("w", suffix=".cpp") as together:
        together.writelines(f'#include "{path}"\n' for path in paths)
        together.flush()
        sources_too = r"--header-filter=/(common|plugins|meshes)/[^.]*\.(h|cpp)$"
        return tidy(together.name, [*flags, "-ferror-limit=0"], sources_too, "--checks=-bugprone-suspicious-include")


def check(batch):
    """What is wrong with the sources of a batch, a text for each that has faults."""
    flags, jobs = batch
    as_one = tidy_as_one([path for path, _ in jobs], flags) if len(jobs) > 1 else None
    if as_one and as_one.returncode:  # perhaps because the same name is in two of them
        errors = re.findall(r"^(.*?):\d+:\d+: error: .*\[clang-diagnostic-error\]$", as_one.stdout, re.MULTILINE)
        apart = [job for job in jobs if str(job[0]) in errors]
        if 0 < len(apart) < len(jobs):
            return check((flags, [job for job in jobs if job not in apart])) + check((flags, apart))
    faults = []
    for path, k in jobs:
        done = None if as_one and not as_one.returncode else tidy(path, flags)
        if done and done.returncode:
            faults.append(f"{path.relative_to(ROOT)}\n{done.stdout}")
        else:
            (PASSED / k).touch()
    return faults


def workflow_faults():
    """What is wrong with .github/workflows/."""
    faults = []
    files = sorted((ROOT / ".github/workflows").glob("*.yml"))
    for file in files:
        for line in file.read_text().splitlines():
            action = re.match(r"\s*(?:- )?uses:\s*(\S+)", line)
            if action and not re.fullmatch(r"[\w./-]+@[0-9a-f]{40}", action[1]):
                faults.append(f"{file.relative_to(ROOT)}: {action[1]} is not pinned by a commit's hash")
    checks = [[ROOT / ".venv/bin/check-jsonschema", "--builtin-schema", "vendor.github-workflows"]]
    checks += [["actionlint"]] if shutil.which("actionlint") else []
    for check in checks if files else []:
        done = subprocess.run([*check, *files], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        faults += [done.stdout] if done.returncode else []
    return faults


def main():
    PASSED.mkdir(parents=True, exist_ok=True)
    todo = list(jobs([pathlib.Path(b).resolve() for b in sys.argv[1:]]))
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        faults = [fault for found in pool.map(check, batches(todo)) for fault in found]
    workflows = workflow_faults()
    print(*faults, *workflows, sep="\n")
    print(f"clang-tidy: looked at {len(todo)} sources, {len(faults)} with faults; workflows: {len(workflows)} faults")
    return 1 if faults or workflows else 0


sys.exit(main())
