"""A terrain as archaeologists look at it: shaded, by its view of the sky, and both of relief of some sizes only.

    .venv/bin/python tools/terrain_relief.py PICTURE [RASTER] [--limits FINEST MIDDLE COARSEST]

Limits are wavelengths in units of the raster (metres); by default 2.5, 13 and 65 cells. Without a raster (read by rasterio)
it is matplotlib's sample, the Jacksboro fault in Tennessee (USGS).

The sky view factor (Zaksek, Ostir and Kokalj, "Sky-View Factor as a Relief Visualization Technique", 2011) is the share of
the sky that is seen from a cell, 1 - the mean over directions of the sine of the horizon's height, within 20 cells. Large
forms hide small ones in it as in a shaded picture, so it is taken of the relief of one size, too.
"""

import argparse
import pathlib

import numpy as np
from matplotlib import pyplot

from measuring import document, load_plugins
from terrain import mesh_of
from terrain_compare import jacksboro
from terrain_compare import mesh_of as mesh_of_heights

RELIEF = "compute_scalar_multires_relief_per_vertex"


def sky_view(z, cell, reach=20, directions=16):
    """Share of the sky above the horizon, 0 to 1, of every cell of a square raster."""
    around, seen = np.pad(z, reach, mode="edge"), np.zeros_like(z)
    for angle in np.arange(directions) * 2 * np.pi / directions:
        horizon = np.zeros_like(z)
        for r in range(1, reach + 1):
            i, j = round(r * np.sin(angle)), round(r * np.cos(angle))
            there = around[reach + i : reach + i + z.shape[0], reach + j : reach + j + z.shape[1]]
            horizon = np.maximum(horizon, (there - z) / (cell * np.hypot(i, j)))
        seen += 1 - horizon / np.hypot(1, horizon)
    return seen / directions


def shading(z, cell):
    """Light from the north-west, 45 degrees high."""
    down, right = np.gradient(z, cell)
    light = (down + right) * 0.5 + np.sqrt(0.5)  # the normal is (-right, down, 1), north being up
    return np.clip(light / np.sqrt(1 + down**2 + right**2), 0, 1)


def relief(v, f, finest, coarsest):
    ms = document(v, f)
    ms.apply_filter(RELIEF, finest=finest, coarsest=coarsest)
    return ms.current_mesh().vertex_scalar_array()


def opened(path):
    """Vertices, faces, which cells have them, heights with the mean where there is no data, size of a cell."""
    if not path:
        z, cell = jacksboro()
        return *mesh_of_heights(z, cell), np.ones(z.shape, dtype=bool), z, cell
    import rasterio

    from terrain import valid_cells

    with rasterio.open(path) as raster:
        z, valid = valid_cells(raster)
        z[~valid] = z[valid].mean()
        return *mesh_of(raster), valid, z, abs(raster.transform[0])


def panels(v, f, valid, z, cell, limits):
    """Titles, pictures and whether they are signed."""
    bands = []
    for finest, coarsest in zip(limits[:-1], limits[1:]):
        band = np.zeros(z.shape)
        band[valid] = relief(v, f, finest, coarsest)
        bands.append(band)
    names = [f"{a:,.0f} to {b:,.0f} m" for a, b in zip(limits[:-1], limits[1:])]
    return [
        ("Shaded", shading(z, cell), False),
        ("Sky view", sky_view(z, cell), False),
        (f"Sky view of relief, {names[0]}, × 3", sky_view(3 * bands[0], cell), False),
        (f"Shaded, relief of {names[0]} × 3", shading(z + 2 * bands[0], cell), False),
        (f"Relief, {names[0]}", bands[0], True),
        (f"Relief, {names[1]}", bands[1], True),
    ]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("picture", type=pathlib.Path)
    parser.add_argument("raster", type=pathlib.Path, nargs="?")
    parser.add_argument("--limits", type=float, nargs=3)
    arguments = parser.parse_args()
    load_plugins()
    v, f, valid, z, cell = opened(arguments.raster)
    limits = arguments.limits or [2.5 * cell, 13 * cell, 65 * cell]
    figure, axes = pyplot.subplots(2, 3, figsize=(11, 7), dpi=88, layout="constrained")
    for ax, (title, picture, signed) in zip(axes.ravel(), panels(v, f, valid, z, cell, limits)):
        low, high = np.quantile(picture, (0.01, 0.99))
        if signed:
            high = 2.5 * picture.std()
            low = -high
        ax.imshow(picture, cmap="RdBu_r" if signed else "gray", vmin=low, vmax=high)
        ax.set_title(title, fontsize=10)
        ax.axis("off")
    quality = {"quality": 62, "method": 6} if arguments.picture.suffix == ".webp" else {}
    figure.savefig(arguments.picture, pil_kwargs=quality)


if __name__ == "__main__":
    main()
