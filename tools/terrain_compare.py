"""Terrains with noise: what smoothing leaves of it, everywhere and at ridges and gorges. WhiteboxTools' filters and
MeshLab's get the parameters that are best, found with the truth; ours has none. Needs matplotlib (a part of its sample
elevations, of the Jacksboro fault in Tennessee, USGS); rows of WhiteboxTools need whitebox-workflows and rasterio.

    .venv/bin/python tools/terrain_compare.py [TERRAIN.ply ...]     # square grids in rows, beside those that come along

Figures are RMS errors of heights, noise = 1: all cells, and the tenth where the terrain bends most.
"""

import argparse
import itertools
import pathlib
import tempfile

import numpy as np
from matplotlib import cbook

from measuring import DENOISE, document, load_plugins, read
from pictures import mountains

NOISE = (0.01, 0.03)  # of the range of heights


def jacksboro():
    """Elevations in metres, north at the top, and the size of a cell."""
    sample = cbook.get_sample_data("jacksboro_fault_dem.npz")
    return sample["elevation"].astype(float), float(sample["dy"]) * 111_200


def terrains(paths):
    """Name, heights as a square array, size of a cell. The first was there when methods were chosen, the others were not."""
    for seed in (4, 9):
        v, _ = mountains(seed=seed)
        yield f"made up, {seed}", v[:, 2].reshape(160, 160), 1 / 160
    z, cell = jacksboro()
    yield "Jacksboro, north-west", z[:200, :200], cell
    yield "Jacksboro, east", z[140:340, 200:400], cell
    for path in paths:
        v, _ = read(path)
        side = round(len(v) ** 0.5)
        yield path.stem, v[:, 2].reshape(side, side), np.ptp(v[:, 0]) / (side - 1)


def mesh_of(z, cell):
    rows, columns = z.shape
    i, j = np.mgrid[:rows, :columns]
    corner = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).ravel()[:, None]
    faces = np.vstack([corner + [0, columns, columns + 1], corner + [0, columns + 1, 1]])
    return np.column_stack([j.ravel() * cell, (rows - 1 - i).ravel() * cell, z.ravel()]), faces


def through(filter_name, z, cell, **parameters):
    """Heights after a filter of pymeshlab."""
    ms = document(*mesh_of(z, cell))
    ms.apply_filter(filter_name, **parameters)
    return ms.current_mesh().vertex_matrix()[:, 2].reshape(z.shape)


class Whitebox:
    """Filters of WhiteboxTools (whitebox-workflows), by way of files."""

    def __init__(self, folder):
        import whitebox_workflows

        self.environment, self.folder = whitebox_workflows.WbEnvironment(), folder

    def __call__(self, tool, z, cell, **parameters):
        import rasterio

        source, target = self.folder / "in.tif", self.folder / "out.tif"
        where = rasterio.transform.from_origin(0, z.shape[0] * cell, cell, cell)
        with rasterio.open(source, "w", driver="GTiff", width=z.shape[1], height=z.shape[0], count=1, dtype="float32",
                           crs="EPSG:32617", transform=where) as raster:  # fmt: skip
            raster.write(z.astype("float32"), 1)
        made = getattr(self.environment, tool)(self.environment.read_raster(str(source)), **parameters)
        self.environment.write_raster(made, str(target))
        with rasterio.open(target) as raster:
            return raster.read(1).astype(float)


def methods(whitebox):
    """Name, and heights for each set of parameters: heights(noisy, cell, noise)."""
    yield "Denoise, no parameter", [lambda z, cell, s: through(DENOISE, z, cell)]
    for method in ("soft threshold", "hard threshold"):
        yield f"Denoise, {method}, scheme Dreger", [
            lambda z, cell, s, m=method: through(DENOISE, z, cell, method=m, scheme="Dreger")
        ]
    yield "Taubin, best number of steps", [
        lambda z, cell, s, n=n: through("apply_coord_taubin_smoothing", z, cell, stepsmoothnum=n)
        for n in (1, 2, 3, 5, 8, 12, 20)
    ]
    if not whitebox:
        return
    yield "WhiteboxTools feature-preserving, defaults", [
        lambda z, cell, s: whitebox("feature_preserving_smoothing", z, cell)
    ]
    yield "WhiteboxTools feature-preserving, best", [
        lambda z, cell, s, p=p: whitebox("feature_preserving_smoothing", z, cell, filter_size=p[0],
                                         normal_diff_threshold=p[1], iterations=p[2])
        for p in itertools.product((3, 5, 11), (8.0, 15.0, 30.0, 60.0), (1, 3))
    ]  # fmt: skip
    yield "WhiteboxTools bilateral, best", [
        lambda z, cell, s, p=p: whitebox("bilateral_filter", z, cell, sigma_dist=p[0], sigma_int=p[1] * s)
        for p in itertools.product((0.75, 1.0, 1.5, 2.0, 3.0), (1.0, 2.0, 3.0, 4.0, 6.0))
    ]


def bends_most(z):
    down, across = np.gradient(z)
    bend = np.abs(np.gradient(down, axis=0)) + np.abs(np.gradient(across, axis=1))
    return bend > np.quantile(bend, 0.9)


def errors(z, cell, noise, ways):
    """All and ridges, of the parameters with the least error of all."""
    noisy = z + noise * np.random.default_rng(7).normal(size=z.shape)
    ridges, best = bends_most(z), None
    for way in ways:
        d = (way(noisy, cell, noise) - z) / noise
        e = np.sqrt((d**2).mean()), np.sqrt((d[ridges] ** 2).mean())
        best = e if best is None else min(best, e)
    return best


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("terrain", type=pathlib.Path, nargs="*")
    parser.add_argument("--without-whitebox", action="store_true")
    arguments = parser.parse_args()
    load_plugins()
    with tempfile.TemporaryDirectory() as folder:
        whitebox = None if arguments.without_whitebox else Whitebox(pathlib.Path(folder))
        cases = list(terrains(arguments.terrain))
        print("| |", " | ".join(f"{name}, {100 * s:.0f} %" for name, *_ in cases for s in NOISE), "|")
        print("|" + "---|" * (1 + len(cases) * len(NOISE)))
        for name, ways in methods(whitebox):
            cells = [errors(z, cell, s * np.ptp(z), ways) for _, z, cell in cases for s in NOISE]
            print(f"| {name} |", " | ".join(f"{a:.2f} / {r:.2f}" for a, r in cells), "|", flush=True)


if __name__ == "__main__":
    main()
