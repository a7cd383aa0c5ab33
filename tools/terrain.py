"""Elevation rasters (GeoTIFF, ESRI ASCII grids, whatever rasterio reads) to meshes of triangular grids, and back.
Needs rasterio.

    .venv/bin/python tools/terrain.py RASTER MESH.ply            # cells without data become holes
    .venv/bin/python tools/terrain.py MESH.ply RASTER --like ORIGINAL_RASTER

x and y are the raster's coordinates less its lower left corner (mesh formats in single precision would round UTM
coordinates to decimetres), z is the elevation. The way back takes georeference and cells from the original: vertices
are in its order, so any filter that keeps them will do.
"""

import argparse
import pathlib

import numpy as np
import pymeshlab


def valid_cells(raster):
    """Elevations of the first band, rows from north to south, and which of them there are."""
    band = raster.read(1, masked=True)
    return band.filled(0).astype(float), ~np.ma.getmaskarray(band) & np.isfinite(band.filled(0))


def mesh_of(raster):
    """Vertices at the middles of cells with data, and faces that look up."""
    z, valid = valid_cells(raster)
    row, column = np.nonzero(valid)
    a, b, c, d, e, f = raster.transform[:6]
    x, y = a * (column + 0.5) + b * (row + 0.5) + c, d * (column + 0.5) + e * (row + 0.5) + f
    v = np.column_stack([x - raster.bounds.left, y - raster.bounds.bottom, z[valid]])
    number = np.full(valid.shape, -1)
    number[valid] = np.arange(len(v))
    nw, ne, sw, se = number[:-1, :-1], number[:-1, 1:], number[1:, :-1], number[1:, 1:]
    faces = np.vstack([np.stack([c.ravel() for c in f], axis=1) for f in ((nw, sw, se), (nw, se, ne))])
    return v, faces[(faces >= 0).all(axis=1)]


def raster_of(vertices, original, path):
    """Writes the heights of the vertices into a raster like the original."""
    z, valid = valid_cells(original)
    if valid.sum() != len(vertices):
        raise SystemExit(f"The mesh has {len(vertices)} vertices, the raster {valid.sum()} cells with data.")
    import rasterio

    empty = -9999.0 if original.nodata is None else original.nodata
    z[:] = empty
    z[valid] = vertices[:, 2]
    driver = "AAIGrid" if path.suffix.lower() == ".asc" else "GTiff"
    profile = {"driver": driver, "width": original.width, "height": original.height, "count": 1,
               "dtype": "float32", "crs": original.crs, "transform": original.transform, "nodata": empty}  # fmt: skip
    with rasterio.open(path, "w", **profile) as out:
        out.write(z.astype("float32"), 1)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("source", type=pathlib.Path)
    parser.add_argument("target", type=pathlib.Path)
    parser.add_argument("--like", type=pathlib.Path, help="the raster that the mesh was made from")
    arguments = parser.parse_args()
    import rasterio

    ms = pymeshlab.MeshSet(verbose=False)
    if arguments.like:
        ms.load_new_mesh(str(arguments.source))
        with rasterio.open(arguments.like) as original:
            raster_of(ms.current_mesh().vertex_matrix(), original, arguments.target)
        return
    with rasterio.open(arguments.source) as raster:
        ms.add_mesh(pymeshlab.Mesh(*mesh_of(raster)))
    ms.save_current_mesh(str(arguments.target))


if __name__ == "__main__":
    main()
