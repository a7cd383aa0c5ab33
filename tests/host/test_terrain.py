"""Rasters to meshes and back (tools/terrain.py): geometry, holes, order; whole ways by files, if rasterio is there."""

import pathlib
import subprocess
import sys
import types

import numpy as np
import pymeshlab
import pytest
from test_pymeshlab import new_document

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
import terrain  # noqa: E402

CELL = 2.5
HOLE = [(3, 4), (3, 5), (4, 4)]


def heights(rows=12, columns=17):
    i, j = np.mgrid[:rows, :columns]
    return 100 + 3 * np.sin(0.7 * i) + 0.5 * j + np.cos(i * j)


def dataset(z, holes=HOLE):
    """What terrain.py takes of an open raster: north at the top, the lower left corner at (500000, 4000000)."""
    mask = np.zeros(z.shape, dtype=bool)
    for place in holes:
        mask[place] = True
    left, bottom, top = 500_000.0, 4_000_000.0, 4_000_000 + CELL * len(z)
    return types.SimpleNamespace(
        read=lambda band, masked: np.ma.array(z, mask=mask),
        transform=(CELL, 0, left, 0, -CELL, top),
        bounds=types.SimpleNamespace(left=left, bottom=bottom),
    )


def test_vertices_are_at_the_middles_of_cells_in_order_of_the_raster():
    z = heights()
    v, f = terrain.mesh_of(dataset(z, holes=[]))
    i, j = np.indices(z.shape)
    expected = np.column_stack([(j.ravel() + 0.5) * CELL, (len(z) - 0.5 - i.ravel()) * CELL, z.ravel()])
    np.testing.assert_allclose(v, expected, rtol=0, atol=1e-9)
    assert len(f) == 2 * (z.shape[0] - 1) * (z.shape[1] - 1)
    up = np.cross(v[f[:, 1]] - v[f[:, 0]], v[f[:, 2]] - v[f[:, 0]])[:, 2]
    np.testing.assert_allclose(up, CELL**2, rtol=0, atol=1e-9)


def test_cells_without_data_and_infinite_ones_become_holes_of_one_grid():
    z = heights()
    z[8, 9] = np.inf
    v, f = terrain.mesh_of(dataset(z))
    assert len(v) == z.size - len(HOLE) - 1 and np.isfinite(v).all()
    ms = new_document()
    ms.add_mesh(pymeshlab.Mesh(v, f))
    report = ms.apply_filter("compute_multires_grid")
    assert report["grids"] == 1 and list(report["holes"]) == [2] and report["loose_vertices"] == 0
    assert sorted([report["rows"][0], report["columns"][0]]) == list(z.shape)


@pytest.mark.parametrize("ending", ["tif", "asc"])
def test_the_way_to_a_mesh_and_back(tmp_path, ending):
    rasterio = pytest.importorskip("rasterio")
    z = heights().astype("float32")
    for place in HOLE:
        z[place] = -32768
    original, mesh, back = tmp_path / f"a.{ending}", tmp_path / "a.ply", tmp_path / f"b.{ending}"
    where = rasterio.transform.from_origin(500_000, 4_000_030, CELL, CELL)
    with rasterio.open(original, "w", driver={"tif": "GTiff", "asc": "AAIGrid"}[ending], width=z.shape[1],
                       height=z.shape[0], count=1, dtype="float32", nodata=-32768, transform=where) as raster:  # fmt: skip
        raster.write(z, 1)
    for arguments in ((original, mesh), (mesh, back, "--like", original)):
        subprocess.run([sys.executable, ROOT / "tools/terrain.py", *arguments], check=True)
    with rasterio.open(original) as a, rasterio.open(back) as b:
        np.testing.assert_allclose(b.read(1), a.read(1), rtol=0, atol=1e-4)  # ASCII grids have few digits
        assert a.transform == b.transform and a.nodata == b.nodata and a.shape == b.shape


def test_a_mesh_of_other_cells_is_refused(tmp_path):
    with pytest.raises(SystemExit, match="3 vertices, the raster 201 cells"):
        terrain.raster_of(np.zeros((3, 3)), dataset(heights()), tmp_path / "a.tif")
