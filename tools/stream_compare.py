#!/usr/bin/env python3
"""Sizes of progressive files beside Draco's at the same number of bits, and how near their prefixes are: the root mean
square distance of the vertices from the decoded surface, in % of the box diagonal, beside MeshLab's quadric decimation
followed by Draco, which is not progressive (the best of 9 to 12 bits and of several vertex counts).

    .venv/bin/python tools/stream_compare.py MESH ... [--bits 12] [--picture docs/pictures/stream.svg]

Draco is DracoPy from PyPI; without it (it is not in requirements.txt) its columns stay empty.
"""

import argparse
import pathlib
import tempfile
import time

import numpy as np
import pymeshlab

import measuring

RATES = [0.5, 1, 2, 4]  # bits per vertex of the input
try:
    import DracoPy
except ImportError:
    DracoPy = None


def root_mean_square(vertices, surface):
    """Of the distances of the vertices from a surface, in % of the vertices' box diagonal."""
    ms = measuring.document(*surface)
    ms.add_mesh(pymeshlab.Mesh(vertices))
    found = ms.get_hausdorff_distance(sampledmesh=1, targetmesh=0, samplevert=True, sampleedge=False, sampleface=False,
                                      samplenum=len(vertices), maxdist=pymeshlab.PercentageValue(100))  # fmt: skip
    return 100 * found["RMS"] / np.linalg.norm(np.ptp(vertices, axis=0))


def draco(vertices, faces, bits):
    """Bytes of the mesh at its highest compression."""
    cells = {"quantization_bits": bits, "compression_level": 10}
    return DracoPy.encode(vertices.astype(np.float64), faces.astype(np.uint32), **cells)


def decimated_draco(vertices, faces, rate):
    """The least error of decimation and Draco in so many bits per vertex of the input."""
    least = np.inf
    for bits in (9, 10, 11, 12):
        for share in np.geomspace(rate / 50, rate / 12, 7):
            ms = measuring.document(vertices, faces)
            ms.meshing_decimation_quadric_edge_collapse(targetfacenum=int(share * len(faces)), preservenormal=True)
            data = draco(*measuring.arrays(ms.current_mesh()), bits)
            if 8 * len(data) > rate * len(vertices):
                break
            mesh = DracoPy.decode(data)
            least = min(least, root_mean_square(vertices, (np.asarray(mesh.points, float), np.asarray(mesh.faces))))
    return least


def measure(path, bits):
    """Rates, prefixes and times of one mesh."""
    v, f = measuring.read(path)
    ms = measuring.document(v, f)
    row = {"name": path.stem, "vertices": len(v), "prefixes": [], "decimated": []}
    with tempfile.TemporaryDirectory() as folder:
        file = str(pathlib.Path(folder) / "mesh.mrm")
        start = time.process_time()
        ms.save_current_mesh(file, bits=bits, save_vertex_color=False, save_vertex_quality=False)
        row["save"] = time.process_time() - start
        size = pathlib.Path(file).stat().st_size
        row["rate"] = 8 * size / len(v)
        start = time.process_time()
        measuring.read(file)
        row["open"] = time.process_time() - start
        for rate in RATES:
            part = measuring.document()
            part.load_new_mesh(file, max_bytes=int(rate * len(v) / 8))
            row["prefixes"].append(root_mean_square(v, measuring.arrays(part.current_mesh())))
    row["draco"] = 8 * len(draco(v, f, bits)) / len(v) if DracoPy else np.nan
    row["decimated"] = [decimated_draco(v, f, rate) if DracoPy else np.nan for rate in RATES]
    return row


def draw(rows, path):
    """Error over rate, logarithmic."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(figsize=(6, 4), layout="constrained")
    for k, row in enumerate(rows):
        axes.loglog(RATES, row["prefixes"], "o-", color=f"C{k}", label=row["name"])
        axes.loglog(RATES, row["decimated"], "x:", color=f"C{k}")
    axes.set(xlabel="bits per vertex of the mesh", ylabel="RMS error, % of the diagonal",
             title="Prefixes of one file; dotted: a file for each, decimated, then Draco")  # fmt: skip
    axes.legend(frameon=False)
    axes.grid(which="both", alpha=0.2)
    figure.savefig(path)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("meshes", nargs="+", type=pathlib.Path)
    parser.add_argument("--bits", type=int, default=12)
    parser.add_argument("--picture", type=pathlib.Path)
    arguments = parser.parse_args()
    measuring.load_plugins()
    print("| mesh | vertices | whole, bits/vertex | Draco | prefixes of " + ", ".join(f"{r:g}" for r in RATES) +
          " bits/vertex: RMS, % | decimated, then Draco | save, open, s |\n|---|---|---|---|---|---|---|")  # fmt: skip
    rows = []
    for path in arguments.meshes:
        row = measure(path, arguments.bits)
        rows.append(row)
        ours, theirs = (", ".join(f"{x:.4f}" if np.isfinite(x) else "–" for x in row[k]) for k in ("prefixes", "decimated"))
        print(f"| {row['name']} | {row['vertices']:,} | {row['rate']:.2f} | {row['draco']:.2f} | {ours} | {theirs} "
              f"| {row['save']:.2f}, {row['open']:.2f} |", flush=True)  # fmt: skip
    if arguments.picture:
        draw(rows, arguments.picture)


if __name__ == "__main__":
    main()
