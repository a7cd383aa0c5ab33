"""Filters of triangular grids in pymeshlab: selections, masks, attributes, what is refused, a whole edit."""

import numpy as np
import pymeshlab
import pytest
from conftest import FILTERS, wants_another_layer, wants_grid
from test_pymeshlab import Error, differences, rich_grid, rich_sphere, snapshot

GRID = [row["python_name"] for row in FILTERS if wants_grid(row["python_name"])]
MOVING = ["apply_coord_multires_grid_band", "apply_coord_multires_grid_compress"]


@pytest.mark.parametrize("name", GRID)
def test_other_meshes_are_refused_and_left_alone(name):
    ms = rich_sphere()
    before = snapshot(ms)
    with pytest.raises(Error, match="not a triangular grid"):
        ms.apply_filter(name)
    assert differences(before, snapshot(ms)) == []


@pytest.mark.parametrize("name", MOVING)
def test_only_the_selection_moves_and_quality_is_a_mask(name):
    free, chosen, masked = rich_grid(), rich_grid(), rich_grid()
    before = free.current_mesh().vertex_matrix()
    chosen.set_selection_none()
    chosen.compute_selection_by_condition_per_vertex(condselect="x > 0")
    selected = chosen.current_mesh().vertex_selection_array()
    masked.compute_scalar_by_function_per_vertex(q="x > 0 ? 0.25 : -1")
    for ms, how in ((free, {}), (chosen, {"selected": True}), (masked, {"quality_mask": True})):
        ms.apply_filter(name, **{"selected": False, **how})
    full, part, soft = (ms.current_mesh().vertex_matrix() - before for ms in (free, chosen, masked))
    assert np.abs(full).max() > 1e-3
    np.testing.assert_array_equal(part[~selected], 0)
    np.testing.assert_array_equal(part[selected], full[selected])
    np.testing.assert_allclose(soft, np.where(selected, 0.25, 0)[:, None] * full, rtol=0, atol=1e-12)
    np.testing.assert_array_equal(chosen.current_mesh().vertex_selection_array(), selected)


def test_a_control_mesh_is_edited_and_the_grid_follows_with_its_colours():
    ms = rich_grid()
    grid = ms.current_mesh_id()
    before, colors = ms.current_mesh().vertex_matrix(), ms.current_mesh().vertex_color_matrix()
    ms.apply_filter("generate_multires_grid_level", level=1)
    control, faces = ms.current_mesh().vertex_matrix(), ms.current_mesh().face_matrix()
    assert len(control) < len(before) and len(np.unique(ms.current_mesh().vertex_color_matrix(), axis=0)) > 50
    ms.add_mesh(pymeshlab.Mesh(control + [0, 0, 0.5], faces))
    edited = ms.current_mesh_id()
    ms.set_current_mesh(grid)
    report = ms.apply_filter("apply_coord_multires_grid_edit", edited=edited, selected=False)
    assert report["level"] == 1
    np.testing.assert_allclose(ms.current_mesh().vertex_matrix(), before + [0, 0, 0.5], atol=1e-12)
    np.testing.assert_array_equal(ms.current_mesh().vertex_color_matrix(), colors)


def test_what_is_painted_on_a_control_mesh_changes_the_grid():
    ms = rich_grid()
    grid = ms.current_mesh_id()
    mesh = ms.current_mesh()
    mesh.add_vertex_custom_scalar_attribute(mesh.vertex_matrix()[:, 2], "height")
    before, positions, scalar = mesh.vertex_color_matrix(), mesh.vertex_matrix(), mesh.vertex_scalar_array()
    height = mesh.vertex_custom_scalar_attribute_array("height")
    ms.apply_filter("generate_multires_grid_level", level=1)
    control = ms.current_mesh_id()
    np.testing.assert_allclose(ms.current_mesh().vertex_custom_scalar_attribute_array("height"),
                               ms.current_mesh().vertex_matrix()[:, 2], rtol=0, atol=1e-12)  # fmt: skip
    edit = {"edited": control, "attributes": True, "selected": False}
    ms.set_current_mesh(grid)
    report = ms.apply_filter("apply_coord_multires_grid_edit", **edit)
    assert report["color_largest_change"] == report["quality_largest_change"] == 0
    ms.set_current_mesh(control)
    ms.compute_scalar_by_function_per_vertex(q="q + 3")
    ms.set_current_mesh(grid)
    report = ms.apply_filter("apply_coord_multires_grid_edit", **edit)
    assert report["color_largest_change"] == report["custom_height_largest_change"] == 0
    mesh = ms.current_mesh()
    np.testing.assert_allclose(mesh.vertex_scalar_array(), scalar + 3, rtol=0, atol=1e-5)
    np.testing.assert_array_equal(mesh.vertex_color_matrix(), before)
    np.testing.assert_array_equal(mesh.vertex_matrix(), positions)
    np.testing.assert_array_equal(mesh.vertex_custom_scalar_attribute_array("height"), height)


@pytest.mark.parametrize("name", ["apply_coord_multires_stop_band", "apply_attributes_multires_band"])
def test_the_scheme_of_grids_is_refused_by_name_elsewhere(name):
    grid, sphere = rich_grid(), rich_sphere()
    how = {"scheme": "Dreger", "method": "pyramid"}
    grid.apply_filter(name, **how)
    before = snapshot(sphere)
    with pytest.raises(Error, match="scheme: Dreger is for triangular grids"):
        sphere.apply_filter(name, **how)
    assert differences(before, snapshot(sphere)) == []


def test_there_is_a_filter_of_two_layers():
    assert [name for name in GRID if wants_another_layer(name)] == ["apply_coord_multires_grid_edit"]
