#!/usr/bin/env python3
"""Sharp lines of noisy meshes: the F1 score of our selection without a parameter, and of MeshLab's
compute_selection_crease_per_edge with the angle that is best on each mesh, found with the truth, alone and after the
steps of Taubin's smoothing that are best. Within one ring; what is found must be near edges of the clean mesh that bend
by more than 15 degrees, and those of more than 30 degrees must be found.

    .venv/bin/python tools/features_compare.py CLEAN.ply NOISE[,NOISE...] [...]

Noise goes along the normals, in mean edges.
"""

import sys

import measuring
import numpy as np
import pymeshlab


def normals(v, f):
    n = np.cross(v[f[:, 1]] - v[f[:, 0]], v[f[:, 2]] - v[f[:, 0]])
    return n / np.maximum(np.linalg.norm(n, axis=1), 1e-300)[:, None]


def creases(v, f, degrees):
    """#V, on edges of two faces that bend by more."""
    halves = np.stack([f, np.roll(f, -1, axis=1)], axis=2).reshape(-1, 2)
    ends, edge, faces = np.unique(np.sort(halves, axis=1), axis=0, return_inverse=True, return_counts=True)
    order = np.argsort(edge.ravel(), kind="stable") // 3
    first = np.cumsum(faces) - faces
    two = np.flatnonzero(faces == 2)
    n = normals(v, f)
    cosine = (n[order[first[two]]] * n[order[first[two] + 1]]).sum(axis=1)
    on = np.zeros(len(v), bool)
    on[ends[two[cosine < np.cos(np.radians(degrees))]]] = True
    return on


def with_ring(f, on):
    out = on.copy()
    out[f[on[f].any(axis=1)]] = True
    return out


def f1(f, found, truth):
    """truth: vertices that may be found, vertices that must."""
    if not found.any():
        return 0.0
    precision, recall = with_ring(f, truth[0])[found].mean(), with_ring(f, found)[truth[1]].mean()
    return 2 * precision * recall / max(precision + recall, 1e-300)


def noisy(v, f, edges, seed=7):
    ms = measuring.document()
    ms.add_mesh(pymeshlab.Mesh(v, f))
    ms.compute_normal_per_vertex()
    size = edges * np.linalg.norm(v[f[:, 0]] - v[f[:, 1]], axis=1).mean()
    noise = size * np.random.default_rng(seed).normal(size=len(v))
    return v + noise[:, None] * ms.current_mesh().vertex_normal_matrix()


def ours(v, f):
    ms = measuring.document()
    ms.add_mesh(pymeshlab.Mesh(v, f))
    ms.apply_filter("compute_selection_multires_features", select="vertices")
    return ms.current_mesh().vertex_selection_array()


def theirs(v, f, truth, all_steps):
    """The best F1 score, angle and number of steps."""
    best = (0.0, 0, 0)
    for steps in all_steps:
        ms = measuring.document()
        ms.add_mesh(pymeshlab.Mesh(v, f))
        if steps:
            ms.apply_coord_taubin_smoothing(stepsmoothnum=steps)
        smooth = ms.current_mesh().vertex_matrix()
        # What compute_selection_crease_per_edge selects; its edges are not to be had from Python.
        for angle in range(10, 95, 5):
            best = max(best, (f1(f, creases(smooth, f, angle), truth), angle, steps))
    return best


def main():
    measuring.load_plugins()
    print("| | noise, edges | Select Features | MeshLab's creases | angle | after smoothing | angle, steps |")
    print("|---|---|---|---|---|---|---|")
    for name, noises in zip(sys.argv[1::2], sys.argv[2::2], strict=True):
        ms = measuring.document()
        ms.load_new_mesh(name)
        v, f = measuring.arrays(ms.current_mesh())
        truth = creases(v, f, 15), creases(v, f, 30)
        for noise in map(float, noises.split(",")):
            rough = noisy(v, f, noise) if noise else v
            alone, after = (theirs(rough, f, truth, steps) for steps in ([0], [0, 5, 10, 20, 50]))
            title = name.rsplit("/", 1)[-1].rsplit(".", 1)[0]
            print(f"| {title} | {noise:g} | {f1(f, ours(rough, f), truth):.3f} | {alone[0]:.3f} | {alone[1]} "
                  f"| {after[0]:.3f} | {after[1]}, {after[2]} |", flush=True)  # fmt: skip


if __name__ == "__main__":
    main()
