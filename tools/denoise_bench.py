"""How well and how fast the denoising filter works, beside MeshLab's own smoothing filters in the same process.

    .venv/bin/python tools/denoise_bench.py [--build BUILD] [--quick] [--clean SEEDS]

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

import numpy as np
import pymeshlab
from measuring import (BUILD, DENOISE, LAPLACIAN_20, ROOT, Setting, TAUBIN, TWO_STEPS, arrays, document, load_plugins,
                       measures, read, run, table, with_noise)  # fmt: skip

MESHES = ROOT.parent / "shared/meshes"
PAIRS = MESHES / "noisy"
# Clean meshes that the automatic method was not developed on, then those it was: the split of docs/denoising.md.
CHECKING = ("scans/horse", "scans/elephant25k", "scans/bunny", "clean/cheburashka", "clean/arm", "clean/camelhead")
CHOOSING = ("scans/cow2903", "scans/mannequin689", "scans/fandisk", "clean/cactus", "clean/lion", "clean/homer",
            "clean/decimated-max", "clean/screwdriver")

ROY = Setting(DENOISE, {"method": "soft threshold", "scheme": "Roy", "operator": "cotangent", "presmooth": 0})
FIELD = Setting(DENOISE, {"method": "normal field"})
METHODS = {"multires, default": [Setting(DENOISE)], "normal field": [FIELD],
           "Taubin, best": TAUBIN, "two-step, best": TWO_STEPS,
           "Laplacian, 20": [LAPLACIAN_20]}  # fmt: skip
HEADER = ["mesh", "noise", "method", "setting", "angle", "rms", "volume", "folded", "seconds"]


# ---- meshes ----------------------------------------------------------------------------------------------------------


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


def clean_cases(seeds):
    """The same of the clean meshes of ../shared, all noise models: those for checking first."""
    for path in (MESHES / f"{name}.ply" for name in CHECKING + CHOOSING):
        if not path.exists():
            continue
        v, f = read(path)
        for kind in ("normals", "all directions", "impulsive", "one axis", "quantised"):
            for size in (0.02, 0.05, 0.1, 0.2, 0.3, 0.5):
                for seed in range(1, seeds + 1):
                    yield path.stem, f"{kind} {size:g} seed {seed}", v, f, with_noise(v, f, kind, size, seed)


# ---- methods --------------------------------------------------------------------------------------------------------


def compare(mesh, noise, truth, f, noisy, repeats):
    """A row for the noisy mesh and one for each method, at the setting with the least angle."""
    rows = [{"mesh": mesh, "noise": noise, "method": "(noisy)", "setting": "", "seconds": float("nan"),
             **measures(noisy, f, truth, f)}]  # fmt: skip
    for method, settings in METHODS.items():
        tried = []
        for setting in settings:
            v, seconds = run(setting, noisy, f)
            tried.append({"mesh": mesh, "noise": noise, "method": method, "setting": setting.words(),
                          "seconds": seconds, "filter": setting, **measures(v, f, truth, f)})  # fmt: skip
        best = min(tried, key=lambda row: row["angle"])
        used = best.pop("filter")
        again = [run(used, noisy, f)[1] for _ in range(repeats - 1)]
        best["seconds"] = statistics.median([best["seconds"], *again])
        best["rms"] = min(row["rms"] for row in tried)  # its best, too, even with another setting
        rows.append(best)
    return rows


def speed(build, vertices, repeats):
    v, f = scan(build, vertices)
    noisy = with_noise(v, f, "normals", 0.2, 1)
    methods = {"multires, default": METHODS["multires, default"][0],
               "two-step smoothing, defaults": Setting("apply_coord_two_steps_smoothing"),
               "Roy's soft threshold": ROY, "20 cotangent Laplacian steps": LAPLACIAN_20}  # fmt: skip
    seconds = {name: [] for name in methods}
    for _ in range(repeats):
        for name, method in methods.items():
            seconds[name].append(run(method, noisy, f)[1])
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
    parser.add_argument("--build", type=pathlib.Path, default=BUILD)
    parser.add_argument("--output", type=pathlib.Path, default=ROOT / "bench-output")
    parser.add_argument("--repeats", type=int, default=3, help="runs for the times of the quality table")
    parser.add_argument("--speed-repeats", type=int, default=7)
    parser.add_argument("--quick", action="store_true", help="one size of each noise, no speed")
    parser.add_argument("--clean", type=int, metavar="SEEDS", help="instead: the clean meshes of ../shared, all models")
    arguments = parser.parse_args()

    load_plugins(arguments.build / "plugins")
    arguments.output.mkdir(parents=True, exist_ok=True)

    rows = []
    chosen = clean_cases(arguments.clean) if arguments.clean else cases(arguments.build, arguments.quick)
    for case in chosen:
        print(*case[:2], file=sys.stderr)
        rows += compare(*case, arguments.repeats)
    lines = [cells(row) for row in rows]
    write(arguments.output, "denoise", lines, HEADER)
    write(arguments.output, "denoise-summary", *summary(lines))
    if not arguments.quick and not arguments.clean:
        header = ["method", "median s", "least s", "most s"]
        write(arguments.output, "denoise-speed", speed(arguments.build, 135000, arguments.speed_repeats), header)


if __name__ == "__main__":
    main()
