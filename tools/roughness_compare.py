#!/usr/bin/env python3
"""Roughness on meshes beside surfalize on the height maps they were made of: the largest difference of each parameter.

    tools/roughness_compare.py [FOLDER_WITH_PLUGINS]

Needs surfalize (pip install surfalize), which is not in requirements.txt: it brings pandas, scipy and scikit-learn.
"""

import pathlib
import sys

import numpy as np
import pymeshlab
from scipy.spatial import Delaunay
from surfalize import Surface

NAMES = ["Sa", "Sq", "Sp", "Sv", "Sz", "Ssk", "Sku", "Sdq", "Sdr"]
N = 301  # points along a side


def textures():
    """Functions on the unit square: waves of many directions, longer than 12 steps, symmetric, pitted, one-sided."""
    for seed in range(4):
        rng = np.random.default_rng(seed)
        k = 2 * np.pi / rng.uniform(12 / N, 0.2, 60)
        angle, phase, height = rng.uniform(0, 2 * np.pi, 60), rng.uniform(0, 2 * np.pi, 60), rng.uniform(0.2, 1, 60)

        def waves(x, y, k=k, angle=angle, phase=phase, height=height, seed=seed):
            along = np.cos(angle) * x[..., None] + np.sin(angle) * y[..., None]
            sum_ = (height * np.cos(k * along + phase)).sum(-1)
            bent = [sum_, sum_ - 0.1 * sum_**2, -np.abs(sum_), np.tanh(sum_ / 3)][seed]
            return 0.0008 * bent + (0.02 * x - 0.01 * y)

        yield ["waves", "pits", "creases", "plateaus"][seed], waves


def points(kind):
    """x and y of the vertices."""
    x, y = (a.ravel() for a in np.meshgrid(np.linspace(0, 1, N), np.linspace(0, 1, N), indexing="xy"))
    if kind != "irregular":
        return x, y
    rng = np.random.default_rng(1)
    inside = (x > 0) & (x < 1) & (y > 0) & (y < 1)
    return x + inside * rng.uniform(-0.4, 0.4, x.shape) / N, y + inside * rng.uniform(-0.4, 0.4, x.shape) / N


def triangles(kind, x, y):
    if kind == "irregular":
        f = Delaunay(np.column_stack([x, y])).simplices
        a, b, c = (np.column_stack([x, y])[f[:, i]] for i in range(3))
        u, v = b - a, c - a
        f[u[:, 0] * v[:, 1] < u[:, 1] * v[:, 0]] = f[u[:, 0] * v[:, 1] < u[:, 1] * v[:, 0]][:, ::-1]
        return f[np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) > 1e-12]
    i = (np.arange(N - 1)[:, None] * N + np.arange(N - 1)).ravel()
    return np.concatenate([np.column_stack([i, i + 1, i + N + 1]), np.column_stack([i, i + N + 1, i + N])])


def by_surfalize(waves, filters):
    x, y = np.meshgrid(np.linspace(0, 1, N), np.linspace(0, 1, N), indexing="xy")
    surface = Surface(waves(x, y), 1 / (N - 1), 1 / (N - 1)).level()
    if filters:
        # Mirrored about the points of the rim, where the mesh ends. Its default "reflect" mirrors half a step farther out.
        surface = surface.filter("lowpass", filters[0], endeffect_mode="mirror")
        surface = surface.filter("highpass", filters[1], endeffect_mode="mirror")
    return {name: getattr(surface, name)() for name in NAMES}


def by_mesh(waves, filters, kind):
    x, y = points(kind)
    ms = pymeshlab.MeshSet(verbose=False)
    ms.add_mesh(pymeshlab.Mesh(np.column_stack([x, y, waves(x, y)]), triangles(kind, x, y)))
    s, l = filters or (0, 0)
    report = ms.apply_filter("compute_multires_roughness", form="plane", s_filter=s, l_filter=l)
    return {name: report[name.lower()] for name in NAMES}


def main():
    folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "build/pymeshlab-2025.07/plugins")
    pymeshlab.load_plugin(str(folder / "libfilter_multires_analysis.so"))
    print(f"{'':32}" + "".join(f"{name:>8}" for name in NAMES) + "   (difference to surfalize, %)")
    for name, waves in textures():
        for filters in (None, (0.05, 0.4)):
            there = by_surfalize(waves, filters)
            for kind in ("regular", "irregular"):
                here = by_mesh(waves, filters, kind)
                # A skewness of nothing has no percentage: differences count in units of 1.
                off = [100 * (here[n] - there[n]) / (max(1, abs(there[n])) if n == "Ssk" else there[n]) for n in NAMES]
                print(f"{name:10}{kind:11}{'S-L 0.05-0.4' if filters else 'level':11}" + "".join(f"{o:8.2f}" for o in off))


if __name__ == "__main__":
    main()
