"""How well and how fast the denoising filter works, beside MeshLab's own smoothing filters and those of the literature.

    .venv/bin/python tools/denoise_bench.py [clean] [pairs] [speed] [--build BUILD] [--quick] [--seeds N]

clean: clean meshes (those of ../shared/meshes that are there, and shapes made here) with noise of every model. Ours run
without a parameter; competitors with each setting of a grid, of which the one with the least angle is taken, which
nobody can who has no truth: MeshLab's six smoothing filters, and bilateral normals, guided normals and L0 from
reference_denoisers.py. Angles are means over the faces, distances root mean squares, vertex by vertex, in edge lengths.
Meshes that constants were chosen on come after those that they were not. What is done is kept in
bench-output/denoise-clean.csv: a run that was stopped goes on where it was. The whole takes many hours, --quick (small
meshes, two sizes of noise, one seed, fewer settings) forty minutes of processor time.

pairs: noisy meshes of the literature, and shapes made here, with volumes, folded faces and times. speed: medians of
alternating runs on a generated scan of 135,000 vertices. Tables go to bench-output/ (.md and .csv) and are printed.
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
import reference_denoisers as reference
from measuring import (BUILD, DENOISE, LAPLACIAN_20, ROOT, SMOOTHERS, Setting, TAUBIN, TWO_STEPS, arrays, document,
                       edge_length, load_plugins, measures, normal_angles, read, referenced, run, table, with_noise)  # fmt: skip

MESHES = ROOT.parent / "shared/meshes"
PAIRS = MESHES / "noisy"
# Clean meshes that no constant was chosen on, then those that some were, and shapes made here.
CHECKING = ("scans/horse", "scans/elephant25k", "scans/bunny", "clean/cheburashka", "clean/arm", "clean/camelhead",
            "clean/beetle-alt")
CHOOSING = ("scans/cow2903", "scans/mannequin689", "scans/fandisk", "clean/cactus", "clean/lion", "clean/homer",
            "clean/decimated-max", "clean/screwdriver")
KINDS = ("normals", "all directions", "impulsive", "one axis", "quantised")
SIZES = (0.02, 0.05, 0.1, 0.2, 0.3, 0.5)

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


def clean_meshes(build, quick):
    """(split, name, vertices, faces), those for checking first."""
    shapes = {"part": part, "bumps": bumps, "scan": lambda: scan(build, 10000)}
    for split, names in (("checking", CHECKING), ("choosing", CHOOSING)):
        for path in (MESHES / f"{name}.ply" for name in names):
            if path.exists():
                v, f = referenced(*read(path))
                if not quick or len(v) < 12000:
                    yield split, path.stem, v, f
    for name, make in shapes.items():
        yield "choosing", name, *make()


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


# ---- clean meshes ----------------------------------------------------------------------------------------------------


def ours(**parameters):
    return [lambda v, f: run(Setting(DENOISE, parameters), v, f)[0]]


def theirs(settings):
    return [lambda v, f, s=s: run(s, v, f)[0] for s in settings]


def tuned(function, *grid):
    return [lambda v, f, g=g: function(v, f, *g) for g in grid]


def competitors(quick):
    """Name -> what is tried, functions of vertices and faces; ours first."""
    found = {"automatic": ours(), "soft threshold": ours(method="soft threshold"),
             "hard threshold": ours(method="hard threshold"), "normal field": ours(method="normal field")}  # fmt: skip
    found |= {name: theirs(settings) for name, settings in SMOOTHERS.items()}
    if quick:
        return found | {"bilateral normals": tuned(reference.bilateral_normals, (0.35, 5), (0.35, 20)),
                        "guided normals": tuned(reference.guided_normals, (0.35, 8)),
                        "L0": tuned(reference.l0, (20,))}  # fmt: skip
    tolerances = (0.25, 0.35, 0.5)
    return found | {
        "bilateral normals": tuned(reference.bilateral_normals, *[(t, n) for t in tolerances for n in (2, 5, 20)]),
        "guided normals": tuned(reference.guided_normals, *[(t, n) for t in tolerances for n in (5, 20)]),
        "L0": tuned(reference.l0, (1,), (5,), (20,), (60,)),
    }


OURS = 4  # the first of them
CLEAN = ["split", "mesh", "kind", "size", "seed", "method", "angle", "rms"]


def errors(v, truth, f):
    """Mean angle between normals, degrees; RMS distance, edge lengths."""
    return (normal_angles(v, f, truth, f).mean(),
            np.sqrt(np.square(v - truth).sum(axis=1).mean()) / edge_length(truth, f))  # fmt: skip


def run_clean(build, path, quick, seeds):
    """Adds rows to the file for what is not in it yet."""
    done = set()
    if path.exists():
        with open(path, newline="") as file:
            done = {tuple(row[1:6]) for row in csv.reader(file)}
    else:
        path.write_text(",".join(CLEAN) + "\n")
    methods = {"(noisy)": [lambda v, f: v], **competitors(quick)}
    for split, name, truth, f in clean_meshes(build, quick):
        for kind in KINDS:
            for size in (0.05, 0.2) if quick else SIZES:
                for seed in range(1, seeds + 1):
                    noisy = with_noise(truth, f, kind, size, seed)
                    for method, settings in methods.items():
                        key = (name, kind, f"{size:g}", str(seed), method)
                        if key in done:
                            continue
                        tried = [errors(setting(noisy, f), truth, f) for setting in settings]
                        angle, rms = min((e for e in tried if np.isfinite(e).all()), default=(180, np.inf))
                        with open(path, "a", newline="") as file:
                            csv.writer(file, lineterminator="\n").writerow([split, *key, f"{angle:.4f}", f"{rms:.5f}"])
                    print(name, kind, size, seed, file=sys.stderr)


def geometric_mean(values):
    return float(np.exp(np.mean(np.log(values)))) if len(values) else float("nan")


def clean_summary(path):
    """{name: (rows, header)} of the tables, from all that is in the file."""
    cases = {}
    with open(path, newline="") as file:
        for row in csv.DictReader(file):
            case = cases.setdefault((row["split"], row["kind"], row["mesh"], row["size"], row["seed"]), {})
            case[row["method"]] = (float(row["angle"]), float(row["rms"]))
    methods = [m for m in competitors(False) if any(m in case for case in cases.values())]
    cases = {key: case for key, case in cases.items() if all(m in case for m in ["(noisy)", *methods])}
    means, harms = [], []
    for split in ("checking", "choosing"):
        for kind in KINDS:
            group = [case for key, case in cases.items() if key[:2] == (split, kind)]
            if not group:
                continue
            ratios = [[case[m][0] / case["(noisy)"][0] for case in group] for m in methods]
            means.append([split, kind, str(len(group)), *[f"{geometric_mean(r):.2f} ({max(r):.2f})" for r in ratios]])
            distances = [[case[m][1] / case["(noisy)"][1] for case in group] for m in methods[:OURS]]
            harms.append([split, kind, str(len(group)), *[f"{geometric_mean(r):.2f} ({max(r):.2f})" for r in distances]])
    worst = []
    for key, case in cases.items():
        best = min(methods[OURS:], key=lambda m: case[m][0])
        worst.append((case["automatic"][0] / case[best][0], key, case, best))
    worst.sort(key=lambda w: (w[1][0] != "checking", -w[0]))
    lines = []
    for split in ("checking", "choosing"):
        for ratio, key, case, best in [w for w in worst if w[1][0] == split][:6]:
            shown = [f"{case[m][0]:.2f} ({case[m][1]:.3f})" for m in ("(noisy)", "automatic", best)]
            lines.append([split, key[2], f"{key[1]} {key[3]}", *shown, best, f"{ratio:.2f}"])
    start = ["split", "noise", "cases"]
    return {"denoise-clean-angle": (means, [*start, *methods]),
            "denoise-clean-distance": (harms, [*start, *methods[:OURS]]),
            "denoise-clean-worst": (lines, ["split", "mesh", "noise", "noisy", "automatic", "best", "which", "ratio"])}  # fmt: skip


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
    parser.add_argument("what", nargs="*", choices=["clean", "pairs", "speed", []], default=[], metavar="clean|pairs|speed")
    parser.add_argument("--build", type=pathlib.Path, default=BUILD)
    parser.add_argument("--output", type=pathlib.Path, default=ROOT / "bench-output")
    parser.add_argument("--seeds", type=int, help="of the clean meshes' noise; 3, or 1 with --quick")
    parser.add_argument("--repeats", type=int, default=3, help="runs for the times of the pairs")
    parser.add_argument("--speed-repeats", type=int, default=7)
    parser.add_argument("--quick", action="store_true", help="a small part of it; see above")
    arguments = parser.parse_args()
    what = arguments.what or ["clean", "pairs", "speed"]

    load_plugins(arguments.build / "plugins")
    arguments.output.mkdir(parents=True, exist_ok=True)
    if "clean" in what:
        kept = arguments.output / ("denoise-clean-quick.csv" if arguments.quick else "denoise-clean.csv")
        run_clean(arguments.build, kept, arguments.quick, arguments.seeds or (1 if arguments.quick else 3))
        for name, (rows, header) in clean_summary(kept).items():
            write(arguments.output, name, rows, header)
    if "pairs" in what:
        rows = []
        for case in cases(arguments.build, arguments.quick):
            print(*case[:2], file=sys.stderr)
            rows += compare(*case, arguments.repeats)
        lines = [cells(row) for row in rows]
        write(arguments.output, "denoise", lines, HEADER)
        write(arguments.output, "denoise-summary", *summary(lines))
    if "speed" in what:
        header = ["method", "median s", "least s", "most s"]
        write(arguments.output, "denoise-speed", speed(arguments.build, 135000, arguments.speed_repeats), header)


if __name__ == "__main__":
    main()
