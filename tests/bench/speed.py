"""All that is promised about speed and memory, measured: ours beside MeshLab's own and others, as ratios.

    .venv/bin/python tests/bench/speed.py [--runs 7] [--quick] [--store] [MESH ...]

Contestants take turns in one pymeshlab process, on a fresh document each; medians of 7 runs count, of 3 for files above
20 MB. Without meshes: bunny and horse of ../shared if they are there, and a generated scan of 1,000,000 vertices; the
parts (Google Benchmark) and the memory are measured on generated scans of up to 10,000,000. --quick leaves out what is
larger than 1,000,000 vertices.

Writes bench-output/speed.md and speed.csv, and compares the ratios with those stored in tests/bench/speed.csv: says
which moved by more than a fifth, and fails if one got worse by that. --store makes this run's ratios the stored ones.
Ratios are "how many times better than the other", so larger is always better. A build of the pymeshlab preset must be
there.
"""

import argparse
import csv
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

import numpy as np
import pymeshlab

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = ROOT / "build" / "pymeshlab-2025.07"
STORED = ROOT / "tests" / "bench" / "speed.csv"
MOVED = 1.2

ROY = {"scheme": "Roy", "operator": "cotangent clamped", "presmooth": 0.0}
DECIMATION = "meshing_decimation_quadric_edge_collapse"


def load_plugins():
    for path in sorted((BUILD / "plugins").glob("libfilter_multires_*.so")):
        pymeshlab.load_plugin(str(path))


def fresh(path):
    ms = pymeshlab.MeshSet()
    ms.load_new_mesh(str(path))
    return ms


def in_host(name, **parameters):
    """A contestant: a filter on a fresh document. Only the call is timed."""

    def run(path):
        ms = fresh(path)
        start = time.perf_counter()
        ms.apply_filter(name, **parameters)
        return time.perf_counter() - start

    return run


class OnKeptPyramid:
    """What a slider does: another gain, from the original, with the pyramid that stayed with the mesh."""

    def __init__(self):
        self.document, self.path, self.gain = None, None, 1.5

    def __call__(self, path):
        if self.path != path:
            self.document, self.path = fresh(path), path
            self.document.apply_filter("apply_coord_multires_enhance", gain=self.gain)
        self.gain += 0.01
        start = time.perf_counter()
        report = self.document.apply_filter("apply_coord_multires_enhance", gain=self.gain, relative_to="original")
        seconds = time.perf_counter() - start
        assert report["pyramid_reused"]
        return seconds


def meshoptimizer_simplify(path):
    import meshoptimizer

    ms = fresh(path)
    ms.meshing_remove_unreferenced_vertices()
    mesh = ms.current_mesh()
    vertices = np.ascontiguousarray(mesh.vertex_matrix(), dtype=np.float32)
    indices = np.ascontiguousarray(mesh.face_matrix(), dtype=np.uint32).ravel()
    out = np.zeros_like(indices)
    start = time.perf_counter()
    meshoptimizer.simplify(out, indices, vertices, target_index_count=len(indices) // 10, target_error=1.0)
    return time.perf_counter() - start


def adaptive(path):
    ms = fresh(path)
    faces = ms.current_mesh().face_number() // 10
    start = time.perf_counter()
    ms.apply_filter("generate_multires_adaptive_reconstruction", target="faces", faces=faces, measure=False)
    return time.perf_counter() - start


def contests():
    """(the other, our contestants against it)"""
    yield (
        ("quadric decimation to 200 faces", in_host(DECIMATION, targetfacenum=200)),
        [
            ("whole pyramid", in_host("compute_multires_pyramid")),
            ("whole pyramid, Roy's scheme", in_host("compute_multires_pyramid", **ROY)),
        ],
    )
    yield (
        (
            "20 cotangent Laplacian steps",
            in_host("apply_coord_laplacian_smoothing", stepsmoothnum=20, cotangentweight=True),
        ),
        [("low pass with its pyramid", in_host("apply_coord_multires_low_pass"))],
    )
    yield (
        ("10 Taubin steps", in_host("apply_coord_taubin_smoothing", stepsmoothnum=10)),
        [("enhance on a kept pyramid", OnKeptPyramid())],
    )
    yield ("meshoptimizer", meshoptimizer_simplify), [("adaptive reconstruction to 10 %", adaptive)]


def warm_memory(size):
    """Uses and frees as much memory as a contestant may need: in a virtual machine, pages that nobody has used for some
    seconds cost whoever comes first more than the work."""
    np.ones(size, dtype=np.uint8)


def contest(path, other, ours, runs):
    """Rows (mesh, what, ours, the other's, ratio), seconds."""
    if path.stat().st_size > 20e6:
        runs = min(runs, 3)  # MeshLab takes half a minute for a million vertices
    times = {name: [] for name, _ in [other, *ours]}
    for _ in range(runs):
        for name, run in [*ours, other]:
            warm_memory(20 * path.stat().st_size)
            times[name].append(run(path))
    reference = statistics.median(times[other[0]])
    for name, _ in ours:
        median = statistics.median(times[name])
        yield path.stem, f"{name} / {other[0]}", median, reference, reference / median


def benchmark(pattern, threads=None, repetitions=5):
    """Median of each Google Benchmark that matches, as its JSON object."""
    env = dict(os.environ, **({"MULTIRES_THREADS": str(threads)} if threads else {}))
    command = [
        BUILD / "tests/multires_benchmarks",
        f"--benchmark_filter={pattern}",
        "--benchmark_format=json",
        f"--benchmark_repetitions={repetitions}",
        "--benchmark_report_aggregates_only=true",
    ]
    out = subprocess.run(command, env=env, check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL).stdout
    return {b["run_name"]: b for b in json.loads(out)["benchmarks"] if b["aggregate_name"] == "median"}


def parts(quick, runs):
    """Rows of the parts: costs against what was asked of them, threads, operators."""
    sizes = [48485, 1000000] + ([] if quick else [10000000])
    one, two = (benchmark("(WholePyramid|Synthesis)/(48485|1000000)/", t, runs) for t in (1, 2))
    large = {} if quick else benchmark("(WholePyramid|Synthesis)/10000000/", 2, 3)
    schemes = {1: "default", 0: "Roy"}
    for what, wanted in (("WholePyramid", {48485: 1.2e-6, 1000000: 1.8e-6, 10000000: 1.8e-6}), ("Synthesis", {})):
        for size in sizes:
            for scheme, name in schemes.items():
                key = f"{what}/{size}/{scheme}/real_time"
                cost = (large if size == 10000000 else two)[key]["per_vertex"]
                label = f"scan {size:,}"
                if size in wanted:
                    asked = wanted[size]
                    yield label, f"{what}, {name}: per vertex / {asked * 1e6:.1f} us", cost, asked, asked / cost
                if size < 10000000:
                    single = one[key]["per_vertex"]
                    yield label, f"{what}, {name}: two threads / one", cost, single, single / cost
    sweep = benchmark("RelaxationSweep|CopyOfAsManyBytes", None, runs)
    a, b = (sweep[f"{name}/real_time"]["real_time"] / 1e3 for name in ("RelaxationSweep", "CopyOfAsManyBytes"))
    yield "scan 1,000,000", "relaxation sweep / copy of as many bytes", a, b, b / a
    weights = benchmark("Weights/(cotangent|second_difference_flaps)$", 1, runs)
    a, b = (weights[f"Weights/{name}"]["per_row"] for name in ("second_difference_flaps", "cotangent"))
    yield "scan 200,000", "weights of second differences with flaps / cotangent", a, b, b / a


MEMORY = """
import glob, sys, pymeshlab
for path in glob.glob(sys.argv[1] + "/libfilter_multires_*.so"): pymeshlab.load_plugin(path)
def status(key):
    return next(int(l.split()[1]) * 1024 for l in open("/proc/self/status") if l.startswith(key))
ms = pymeshlab.MeshSet()
ms.load_new_mesh(sys.argv[2])
n = ms.current_mesh().vertex_number()
open("/proc/self/clear_refs", "w").write("5")  # the peak starts anew
before = status("VmRSS")
ms.apply_filter("compute_multires_pyramid", **eval(sys.argv[3]))
print((status("VmHWM") - before) / n, (status("VmRSS") - before) / n)
"""


def memory(path):
    """Rows of bytes per vertex that a pyramid needs beyond the host's mesh: at the peak of building it and checking its
    reconstruction, and kept with the mesh."""
    for scheme, parameters in (("default", {}), ("Roy", ROY)):
        for storage, wanted in (("double", 400), ("float", 300)):
            command = [sys.executable, "-c", MEMORY, BUILD / "plugins", path, repr({**parameters, "storage": storage})]
            out = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout.split()[-2:]
            for what, bytes_per_vertex in zip(("peak", "kept"), map(float, out), strict=True):
                label = f"bytes per vertex, {what}, {scheme}, {storage} / {wanted}"
                yield path.stem, label, bytes_per_vertex, wanted, wanted / bytes_per_vertex


def default_meshes(folder):
    scans = [ROOT.parent / "shared/meshes/scans" / name for name in ("bunny.ply", "horse.ply")]
    return [p for p in scans if p.exists()] + [scan(folder, 1_000_000)]


def scan(folder, vertices):
    subprocess.run([BUILD / "meshes/make_meshes", folder, str(vertices)], check=True, stdout=subprocess.DEVNULL)
    return pathlib.Path(folder) / f"scan_{vertices}.ply"


def line(row):
    mesh, what, ours, other, ratio = row
    return f"| {mesh} | {what} | {ours:.3g} | {other:.3g} | {ratio:.2f} |"


def moved(rows):
    """Prints which ratios differ from the stored ones; true if one is worse."""
    if not STORED.exists():
        return False
    with open(STORED, newline="") as f:
        stored = {(r["mesh"], r["what"]): float(r["ratio"]) for r in csv.DictReader(f)}
    worse = False
    for mesh, what, _, _, ratio in rows:
        before = stored.get((mesh, what))
        if before is None or 1 / MOVED <= ratio / before <= MOVED:
            continue
        print(f"{'better' if ratio > before else 'WORSE'}: {mesh}, {what}: {before:.2f} is now {ratio:.2f}")
        worse |= ratio < before
    return worse


def write_csv(path, rows):
    with open(path, "w", newline="") as f:
        writer = csv.writer(f, lineterminator="\n")
        writer.writerow(("mesh", "what", "ours", "other", "ratio"))
        writer.writerows((m, w, f"{a:.4g}", f"{b:.4g}", f"{r:.3g}") for m, w, a, b, r in rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("meshes", nargs="*", type=pathlib.Path)
    parser.add_argument("--runs", type=int, default=7)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--store", action="store_true")
    parser.add_argument("--output", type=pathlib.Path, default=ROOT / "bench-output")
    arguments = parser.parse_args()
    load_plugins()
    header = "| mesh | what / other | ours | other | times better |\n|---|---|---|---|---|"
    print(header)
    rows = []

    def add(new):
        for row in new:
            rows.append(row)
            print(line(row), flush=True)

    with tempfile.TemporaryDirectory() as folder:
        for path in arguments.meshes or default_meshes(folder):
            for other, ours in contests():
                add(contest(path, other, ours, arguments.runs))
        if not arguments.meshes:
            add(memory(scan(folder, 1_000_000)))
            add(parts(arguments.quick, arguments.runs))
    arguments.output.mkdir(parents=True, exist_ok=True)
    (arguments.output / "speed.md").write_text("\n".join([header, *map(line, rows)]) + "\n")
    write_csv(arguments.output / "speed.csv", rows)
    worse = moved(rows)
    if arguments.store:
        write_csv(STORED, rows)
    return 1 if worse else 0


if __name__ == "__main__":
    sys.exit(main())
