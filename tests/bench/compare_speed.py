"""Our filters beside MeshLab's own, in one pymeshlab process, alternating; medians, as a table.

    .venv/bin/python tests/bench/compare_speed.py [--runs 7] [--output bench-output] [MESH ...]

Without meshes: bunny and horse of ../shared if they are there, and generated scans of 50,000 and 1,000,000 vertices.
Ratios are MeshLab's time over ours: 2 means twice as fast. A build of the pymeshlab preset must be there.
"""
import argparse
import csv
import pathlib
import statistics
import subprocess
import tempfile
import time

import pymeshlab

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = ROOT / "build" / "pymeshlab-2025.07"


def load_plugins():
    for path in sorted((BUILD / "plugins").glob("libfilter_multires_*.so")):
        pymeshlab.load_plugin(str(path))


def default_meshes(folder):
    """The scans of ../shared, and generated ones."""
    meshes = [p for p in (ROOT.parent / "shared/meshes/scans" / n for n in ("bunny.ply", "horse.ply")) if p.exists()]
    for vertices in (50_000, 1_000_000):
        out = pathlib.Path(folder) / str(vertices)
        subprocess.run([BUILD / "meshes/make_meshes", out, str(vertices)], check=True, stdout=subprocess.DEVNULL)
        meshes.append((out / "scan.ply").rename(out / f"scan {vertices:,}.ply"))
    return meshes


def timed(prepare, run):
    """Seconds of run(prepare()); only run counts."""
    state = prepare()
    start = time.perf_counter()
    run(state)
    return time.perf_counter() - start


def pairs(path):
    """(what, ours, MeshLab's): each a prepare and a run; the cheapest fair one first."""
    def fresh():
        ms = pymeshlab.MeshSet()
        ms.load_new_mesh(str(path))
        return ms

    kept = fresh()
    kept.apply_filter("compute_multires_pyramid")
    original = kept.current_mesh().vertex_matrix().copy()

    def with_pyramid():
        # What a slider does: the original positions come back, the pyramid has stayed with the mesh.
        if not (kept.current_mesh().vertex_matrix() == original).all():
            kept.clear()
            kept.load_new_mesh(str(path))
            kept.apply_filter("compute_multires_pyramid")
        return kept

    def filter_call(name, **parameters):
        return lambda ms: ms.apply_filter(name, **parameters)

    roy = dict(scheme="Roy", operator="cotangent clamped", presmooth=0.0)
    decimate = filter_call("meshing_decimation_quadric_edge_collapse", targetfacenum=200)
    return [
        ("pyramid, default / quadric decimation to 200 faces",
         (fresh, filter_call("compute_multires_pyramid")), (fresh, decimate)),
        ("pyramid, Roy / quadric decimation to 200 faces",
         (fresh, filter_call("compute_multires_pyramid", **roy)), (fresh, decimate)),
        ("low pass with build / 20 cotangent Laplacian steps",
         (fresh, filter_call("apply_coord_multires_low_pass")),
         (fresh, filter_call("apply_coord_laplacian_smoothing", stepsmoothnum=20, cotangentweight=True))),
        ("enhance on a kept pyramid / 10 Taubin steps",
         (with_pyramid, filter_call("apply_coord_multires_enhance")),
         (fresh, filter_call("apply_coord_taubin_smoothing", stepsmoothnum=10))),
    ]


def measure(path, runs):
    rows = []
    for what, ours, theirs in pairs(path):
        times = ([], [])
        for _ in range(runs):
            for side, (prepare, run) in enumerate((ours, theirs)):
                times[side].append(timed(prepare, run))
        a, b = (statistics.median(t) for t in times)
        rows.append((path.stem, what, a, b, b / a))
        print(f"| {path.stem} | {what} | {a:.3f} | {b:.3f} | {b / a:.1f} |", flush=True)
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("meshes", nargs="*", type=pathlib.Path)
    parser.add_argument("--runs", type=int, default=7)
    parser.add_argument("--output", type=pathlib.Path, default=ROOT / "bench-output")
    arguments = parser.parse_args()
    load_plugins()
    header = "| mesh | ours / MeshLab's | ours, s | MeshLab's, s | ratio |\n|---|---|---|---|---|"
    print(header)
    with tempfile.TemporaryDirectory() as folder:
        rows = [row for path in arguments.meshes or default_meshes(folder) for row in measure(path, arguments.runs)]
    arguments.output.mkdir(parents=True, exist_ok=True)
    lines = [f"| {m} | {w} | {a:.3f} | {b:.3f} | {r:.1f} |" for m, w, a, b, r in rows]
    (arguments.output / "speed.md").write_text("\n".join([header, *lines]) + "\n")
    with open(arguments.output / "speed.csv", "w", newline="") as f:
        csv.writer(f).writerows([("mesh", "what", "ours_s", "meshlab_s", "ratio"), *rows])


if __name__ == "__main__":
    main()
