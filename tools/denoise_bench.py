"""How well and how fast the denoising filter works, beside MeshLab's own smoothing filters in the same process.

    .venv/bin/python tools/denoise_bench.py [--build BUILD] [--quick]

Quality: noisy meshes whose truth is known, those of ../shared/meshes/noisy if they are there, and shapes made here (CAD
and organic) with Gaussian and impulsive noise of three sizes, along the normals and in all directions. The filter runs
without a parameter; MeshLab's Taubin and two-step smoothing with each setting of a grid, of which the best is shown:
the best for that mesh, which nobody knows who has no truth.

Speed: medians of alternating runs on a generated scan of 135,000 vertices.

Tables go to bench-output/ (.md and .csv) and are printed: denoise (every method), denoise-summary (one line a mesh;
volume, folded faces before and after, and seconds are the filter's), denoise-speed.
"""

import argparse
import csv
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

import numpy as np
import pymeshlab
from demo import table

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAIRS = ROOT.parent / "shared/meshes/noisy"
DENOISE = "apply_coord_multires_denoise"

TAUBIN = [
    ("apply_coord_taubin_smoothing", {"lambda_": 0.5, "mu": -0.53, "stepsmoothnum": n}) for n in (5, 10, 20, 50, 100)
]
TWO_STEPS = [
    ("apply_coord_two_steps_smoothing", {"stepsmoothnum": n, "normalthr": angle})
    for n in (1, 3, 6) for angle in (30, 60)
]  # fmt: skip
LAPLACIAN = [("apply_coord_laplacian_smoothing", {"stepsmoothnum": 20, "cotangentweight": True})]
ROY = [(DENOISE, {"method": "soft threshold", "scheme": "Roy", "operator": "cotangent", "presmooth": 0})]
METHODS = {"multires, default": [(DENOISE, {})], "Taubin, best": TAUBIN, "two-step, best": TWO_STEPS,
           "Laplacian, 20": LAPLACIAN}  # fmt: skip
HEADER = ["mesh", "noise", "method", "setting", "angle", "rms", "volume", "folded", "seconds"]


# ---- meshes ----------------------------------------------------------------------------------------------------------


def document(vertices=None, faces=None):
    ms = pymeshlab.MeshSet(verbose=False)
    if vertices is not None:
        ms.add_mesh(pymeshlab.Mesh(vertices, faces))
    return ms


def arrays(mesh):
    return mesh.vertex_matrix(), mesh.face_matrix()


def read(path):
    ms = document()
    ms.load_new_mesh(str(path))
    return arrays(ms.current_mesh())


def part():
    """CAD: a cube with a hole through it, evenly meshed along its edges."""
    ms = document()
    ms.create_cube(size=2)
    v, f = arrays(ms.current_mesh())
    ms = document(v - (v.min(axis=0) + v.max(axis=0)) / 2, f)
    ms.create_cone(r0=0.6, r1=0.6, h=4, subdiv=96)
    ms.generate_boolean_difference(first_mesh=0, second_mesh=1)
    ms.meshing_isotropic_explicit_remeshing(targetlen=pymeshlab.PureValue(0.07), featuredeg=30, iterations=8)
    return arrays(ms.current_mesh())


def bumps():
    """Organic: a sphere with smooth bumps of three wavelengths."""
    ms = document()
    ms.create_sphere(radius=1, subdiv=5)
    v, f = arrays(ms.current_mesh())
    random = np.random.default_rng(7)
    radius = np.ones(len(v))
    for k, size in ((3, 0.05), (7, 0.02), (14, 0.006)):
        for _ in range(4):
            direction = random.normal(size=3)
            radius += size * np.cos(k * v @ (direction / np.linalg.norm(direction)) + random.uniform(0, 7)) / 2
    return v * radius[:, None], f


def scan(build, vertices):
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([build / "meshes/make_meshes", folder, str(vertices)], check=True)
        return read(pathlib.Path(folder) / f"scan_{vertices}.ply")


def normals(v, f):
    """Unit normals of the faces, and of the vertices."""
    n = np.cross(v[f[:, 1]] - v[f[:, 0]], v[f[:, 2]] - v[f[:, 0]])
    at = np.zeros_like(v)
    for k in range(3):
        np.add.at(at, f[:, k], n)
    return tuple(m / np.maximum(np.linalg.norm(m, axis=1, keepdims=True), 1e-300) for m in (n, at))


def edge_length(v, f):
    return np.mean([np.linalg.norm(v[f[:, k]] - v[f[:, k - 1]], axis=1).mean() for k in range(3)])


def with_noise(v, f, kind, deviation, seed):
    """Noise with this deviation in edge lengths; impulsive noise has it at one vertex in seven."""
    random = np.random.default_rng(seed)
    size = deviation * edge_length(v, f)
    if kind == "all directions":
        return v + size * random.normal(size=v.shape)
    amount = size * random.normal(size=len(v))
    if kind == "impulsive":
        amount[random.random(len(v)) > 1 / 7] = 0
    return v + amount[:, None] * normals(v, f)[1]


def cases(build, quick):
    """(mesh, noise, truth's vertices, faces, noisy vertices)."""
    for truth in sorted(PAIRS.glob("*_truth.ply")):
        v, f = read(truth)
        name, noise = truth.stem.removesuffix("_truth").rsplit("_", 1)
        yield name, noise, v, f, read(truth.with_name(truth.name.replace("_truth", "_noisy")))[0]
    shapes = {"part": part(), "bumps": bumps(), "scan": scan(build, 10000)}
    for name, (v, f) in shapes.items():
        for kind, sizes in {"normals": (0.1, 0.2, 0.3), "all directions": (0.1, 0.2, 0.3),
                            "impulsive": (0.2, 0.4, 0.6)}.items():  # fmt: skip
            for size in sizes[1:2] if quick else sizes:
                yield name, f"{kind} {size:g}", v, f, with_noise(v, f, kind, size, seed=int(100 * size))


# ---- measures --------------------------------------------------------------------------------------------------------


def volume(v, f):
    a, b, c = (v[f[:, k]] - v.mean(axis=0) for k in range(3))
    return np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6


def rms_distance(v, truth, f):
    """Both ways, mesh units."""
    ms = document(truth, f)
    ms.add_mesh(pymeshlab.Mesh(v, f))
    ways = [ms.get_hausdorff_distance(sampledmesh=a, targetmesh=1 - a, samplevert=True, sampleface=False,
                                      samplenum=len(v), maxdist=pymeshlab.PercentageValue(50))["RMS"]
            for a in (0, 1)]  # fmt: skip
    return np.sqrt(np.mean(np.square(ways)))


def closed(f):
    edges = np.sort(np.concatenate([f[:, [0, 1]], f[:, [1, 2]], f[:, [2, 0]]]), axis=1)
    return (np.unique(edges, axis=0, return_counts=True)[1] == 2).all()


def measures(v, truth, f):
    cosine = np.einsum("ij,ij->i", normals(v, f)[0], normals(truth, f)[0])
    change = 100 * (volume(v, f) / volume(truth, f) - 1) if closed(f) else float("nan")
    return {"angle": np.degrees(np.arccos(np.clip(cosine, -1, 1))).mean(),
            "rms": rms_distance(v, truth, f) / edge_length(truth, f), "volume": change,
            "folded": int((cosine < 0).sum())}  # fmt: skip


def run(name, parameters, v, f):
    """(vertices, seconds)"""
    ms = document(v, f)
    start = time.perf_counter()
    ms.apply_filter(name, **parameters)
    seconds = time.perf_counter() - start
    return ms.current_mesh().vertex_matrix(), seconds


def compare(mesh, noise, truth, f, noisy, repeats):
    """A row for the noisy mesh and one for each method, at the setting with the least angle."""
    rows = [{"mesh": mesh, "noise": noise, "method": "(noisy)", "setting": "", "seconds": float("nan"),
             **measures(noisy, truth, f)}]  # fmt: skip
    for method, settings in METHODS.items():
        tried = []
        for name, parameters in settings:
            v, seconds = run(name, parameters, noisy, f)
            varied = [parameters[key] for key in ("stepsmoothnum", "normalthr") if key in parameters]
            setting = " ".join(f"{value:g}" for value in varied)
            tried.append({"mesh": mesh, "noise": noise, "method": method, "setting": setting, "seconds": seconds,
                          "filter": (name, parameters), **measures(v, truth, f)})  # fmt: skip
        best = min(tried, key=lambda row: row["angle"])
        used = best.pop("filter")
        again = [run(*used, noisy, f)[1] for _ in range(repeats - 1)]
        best["seconds"] = statistics.median([best["seconds"], *again])
        best["rms"] = min(row["rms"] for row in tried)  # its best, too, even with another setting
        rows.append(best)
    return rows


def speed(build, vertices, repeats):
    v, f = scan(build, vertices)
    noisy = with_noise(v, f, "normals", 0.2, 1)
    methods = {"multires, default": METHODS["multires, default"][0],
               "two-step smoothing, defaults": ("apply_coord_two_steps_smoothing", {}),
               "Roy's soft threshold": ROY[0], "20 cotangent Laplacian steps": LAPLACIAN[0]}  # fmt: skip
    seconds = {name: [] for name in methods}
    for _ in range(repeats):
        for name, method in methods.items():
            seconds[name].append(run(*method, noisy, f)[1])
    return [(name, f"{statistics.median(s):.2f}", f"{min(s):.2f}", f"{max(s):.2f}") for name, s in seconds.items()]


# ---- output ----------------------------------------------------------------------------------------------------------


def cells(row):
    def number(key, form):
        return "" if row[key] != row[key] else format(row[key], form)

    return [row["mesh"], row["noise"], row["method"], row["setting"], number("angle", ".2f"), number("rms", ".3f"),
            number("volume", "+.2f"), str(row["folded"]), number("seconds", ".2f")]  # fmt: skip


def summary(rows):
    """One line a mesh: angle and, in brackets, distance of each method; the least angle in bold."""
    lines = []
    for start in range(0, len(rows), 1 + len(METHODS)):
        group = rows[start : start + 1 + len(METHODS)]
        least = min(float(row[4]) for row in group)
        shown = [f"**{row[4]}** ({row[5]})" if float(row[4]) == least else f"{row[4]} ({row[5]})" for row in group]
        ours = group[1]
        lines.append([*group[0][:2], *shown, ours[6], f"{group[0][7]} / {ours[7]}", ours[8]])
    header = ["mesh", "noise", "noisy", *METHODS, "volume %", "folded", "seconds"]
    return lines, header


def write(folder, name, rows, header):
    (folder / f"{name}.md").write_text(table(rows, header))
    with open(folder / f"{name}.csv", "w", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([header, *rows])
    print(table(rows, header))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/pymeshlab-2025.07")
    parser.add_argument("--output", type=pathlib.Path, default=ROOT / "bench-output")
    parser.add_argument("--repeats", type=int, default=3, help="runs for the times of the quality table")
    parser.add_argument("--speed-repeats", type=int, default=7)
    parser.add_argument("--quick", action="store_true", help="one size of each noise, no speed")
    arguments = parser.parse_args()

    plugin = next((arguments.build / "plugins").glob("*multires_denoise.so"), None)
    if plugin is None:
        sys.exit(f"No denoising plugin in {arguments.build}: build the pymeshlab preset first.")
    pymeshlab.load_plugin(str(plugin))
    arguments.output.mkdir(parents=True, exist_ok=True)

    rows = []
    for case in cases(arguments.build, arguments.quick):
        print(*case[:2], file=sys.stderr)
        rows += compare(*case, arguments.repeats)
    lines = [cells(row) for row in rows]
    write(arguments.output, "denoise", lines, HEADER)
    write(arguments.output, "denoise-summary", *summary(lines))
    if not arguments.quick:
        header = ["method", "median s", "least s", "most s"]
        write(arguments.output, "denoise-speed", speed(arguments.build, 135000, arguments.speed_repeats), header)


if __name__ == "__main__":
    main()
