"""Prints what every filter computes, as hashes: to hold two builds side by side, bit for bit.

    .venv/bin/python tools/result_hashes.py [PLUGINS] > before.csv      (default: those of the pymeshlab build)
    .venv/bin/python tools/result_hashes.py --compare before.csv after.csv

One line per mesh, filter and options: result_hash of the report, or the error's first words. Bits may differ between
processors and compilers (sin, cos, vector widths of Eigen), so that the list is of no use on another machine.
"""

import csv
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
import pymeshlab
from measuring import BUILD, BUNNY, load_plugins

PYRAMIDS = [
    {},
    {"scheme": "Roy"},
    {"scheme": "Roy", "operator": "cotangent clamped", "presmooth": 0.0},
    {"storage": "float"},
    {"sets_per_level": 1, "base_vertices": 20},
    {"grouping": "sequential", "level_ratio": 0.7},
    {"grouping": "sequential"},
    {"features": "by angle", "length_weight": 0.5},
]
UNITS = [{"unit": u} for u in ("wavelength percent", "level", "vertices")]
DENOISE = [{"method": m, **o} for m in ("soft threshold", "hard threshold")
           for o in ({}, {"per_level": False, "coarsest_level": 3}, {"cycle_spins": 2}, {"keep_volume": True})]
COLOR = [{"color": True, "quality": False}]

# Filter: options of its own, and whether it has those of a pyramid.
CALLS = {
    "generate_multires_level": ([{"level": 1}, {"level": 1, "smoothed": True}], True),
    "compute_scalar_multires_detail_per_vertex": ([{}, {"signed_normal": True}, *UNITS], True),
    "apply_coord_multires_low_pass": ([{}, {"softness": 1.0}, *UNITS], True),
    "apply_coord_multires_stop_band": ([{}, *UNITS], True),
    "apply_coord_multires_enhance": ([{}, {"gain": 0.5, "softness": 0.7}], True),
    "apply_coord_multires_equalizer": ([{"gain_1": 2.0, "gain_4": 0.0}], True),
    "apply_coord_multires_unsharp": ([{}, {"operator": "umbrella", "iterations": 3}], False),
    "apply_coord_multires_denoise": ([{}, *DENOISE], True),
    "generate_multires_adaptive_reconstruction": ([
        {}, {"target": "faces"}, {"criterion": "detail", "fit": True}, {"band_gain": 2.0}], False),
    "apply_attributes_multires_relaxation": (COLOR, False),
    "apply_attributes_multires_band": ([{**COLOR[0], "mode": m} for m in ("low pass", "stop band")], True),
    "apply_attributes_multires_denoise": ([{**COLOR[0], "rule": r} for r in ("soft", "hard")], True),
    "generate_multires_texcoord": ([{"projection": p} for p in ("cylindrical", "planar")], True),
}


def meshes(folder):
    subprocess.run([BUILD / "meshes/make_meshes", folder], check=True)
    names = ("irregular_sphere", "plane", "block", "terrain", "moebius_band", "bowtie", "several_components",
             "degenerate_faces")
    found = {p.stem: p for p in pathlib.Path(folder).glob("*.ply")}
    return {"bunny": BUNNY, **{n: found[n] for n in names if n in found}, "cut": cut(found["irregular_sphere"])}


def cut(path):
    """A closed mesh with a hole at its top, cut along a seam from it: vertices on the seam are there twice."""
    ms = pymeshlab.MeshSet(verbose=False)
    ms.load_new_mesh(str(path))
    vertices, faces = ms.current_mesh().vertex_matrix(), ms.current_mesh().face_matrix()
    middle = vertices[faces].mean(axis=1) - vertices.mean(axis=0)
    size = np.ptp(vertices, axis=0) / 2
    open_ = middle[:, 2] < 0.8 * size[2]
    faces, beyond = faces[open_], middle[open_, 0] > 0
    twice = np.intersect1d(faces[beyond], faces[~beyond])
    number = np.arange(len(vertices))
    number[twice] = len(vertices) + np.arange(len(twice))
    faces[beyond] = number[faces[beyond]]
    ms.add_mesh(pymeshlab.Mesh(np.vstack([vertices, vertices[twice]]), faces))
    ms.meshing_remove_unreferenced_vertices()
    out = path.with_name(f"cut_{path.name}")
    ms.save_current_mesh(str(out), save_vertex_normal=False)
    return out


def result(path, name, options):
    ms = pymeshlab.MeshSet(verbose=False)
    ms.load_new_mesh(str(path))
    mesh = ms.current_mesh()
    if "attributes" in name:
        ms.apply_filter("compute_color_from_scalar_per_vertex") if mesh.has_vertex_scalar() else \
            ms.apply_filter("compute_color_perlin_noise_per_vertex")
    try:
        return f"{ms.apply_filter(name, **options)['result_hash']:.0f}"
    except pymeshlab.PyMeshLabException as error:
        return "error: " + str(error).strip().splitlines()[-1][:60]


def table(out):
    with tempfile.TemporaryDirectory() as folder:
        for mesh, path in meshes(folder).items():
            for name, (own, has_pyramid) in CALLS.items():
                calls = [(o, {}) for o in own] + [(own[0], p) for p in PYRAMIDS[1:] if has_pyramid]
                for options, pyramid in calls:
                    options = {**options, **pyramid}
                    words = " ".join(f"{k}={v}" for k, v in options.items())
                    out.writerow([mesh, name, words, result(path, name, options)])


def compare(before, after):
    def rows(path):
        return {tuple(r[:3]): r[3] for r in csv.reader(open(path, newline=""))}

    old, new = rows(before), rows(after)
    differ = [key for key in old if old[key] != new.get(key)]
    for key in differ:
        print(*key, old[key], new.get(key, "missing"), sep=" | ")
    print(f"{len(old) - len(differ)} of {len(old)} are the same; {len(new.keys() - old.keys())} are new")
    return 1 if differ else 0


if __name__ == "__main__":
    if sys.argv[1:2] == ["--compare"]:
        sys.exit(compare(*sys.argv[2:]))
    load_plugins(*map(pathlib.Path, sys.argv[1:2]))
    table(csv.writer(sys.stdout))
