"""Filters of two layers, and the parameter for a layer: which one is meant, what is refused, what stays."""

import numpy as np
import pymeshlab
import pytest
from test_pymeshlab import Error, differences, new_document, snapshot

DIFFERENCE = "compute_scalar_multires_difference_per_vertex"


def spheres(*radii):
    """A document with a sphere a layer; the last one is current."""
    ms = new_document()
    for radius in radii:
        ms.create_sphere(radius=radius, subdiv=4)
    return ms


def test_the_default_is_the_first_layer_that_is_not_the_current_one():
    ms = spheres(1, 2, 1.5)
    assert ms.apply_filter(DIFFERENCE)["mean_difference"] == pytest.approx(0.5, abs=0.01)
    ms.set_current_mesh(0)
    assert ms.apply_filter(DIFFERENCE)["mean_difference"] == pytest.approx(-1, abs=0.01)


def test_a_layer_is_named_by_its_id_also_after_one_was_deleted():
    ms = spheres(1, 2, 1.5)
    assert ms.apply_filter(DIFFERENCE, layer=1)["mean_difference"] == pytest.approx(-0.5, abs=0.01)
    ms.set_current_mesh(0)
    ms.delete_current_mesh()
    ms.set_current_mesh(2)
    assert ms.apply_filter(DIFFERENCE, layer=1)["mean_difference"] == pytest.approx(-0.5, abs=0.01)


@pytest.mark.parametrize(
    "layer, message",
    [(7, 'Parameter "layer" .*there is no layer 7'), (-1, "there is no layer -1"), (1, "it is the current layer itself")],
)
def test_a_layer_that_will_not_do_is_refused_by_name(layer, message):
    ms = spheres(1, 2)
    before = snapshot(ms)
    with pytest.raises(Error, match=message):
        ms.apply_filter(DIFFERENCE, layer=layer)
    assert differences(before, snapshot(ms)) == []


def test_without_another_layer_it_is_refused():
    ms = spheres(1)
    with pytest.raises(Error, match="layer: it is the current layer itself"):
        ms.apply_filter(DIFFERENCE)


@pytest.mark.parametrize("what", ["cloud", "nan"])
def test_a_reference_without_a_surface_is_refused(what):
    ms = spheres(1)
    v, f = ms.current_mesh().vertex_matrix(), ms.current_mesh().face_matrix()
    if what == "nan":
        v[3, 1] = np.nan
    ms.add_mesh(pymeshlab.Mesh(v, f) if what == "nan" else pymeshlab.Mesh(v))
    ms.set_current_mesh(0)
    before = snapshot(ms)
    with pytest.raises(Error, match="layer: "):
        ms.apply_filter(DIFFERENCE, layer=1)
    assert differences(before, snapshot(ms)) == []


def test_only_the_quality_of_the_current_layer_changes():
    ms = spheres(1, 2)
    before = snapshot(ms)
    ms.apply_filter(DIFFERENCE, wavelength=0.5)
    changes = differences(before, snapshot(ms))
    assert changes
    for change in changes:
        assert change.startswith("/meshes/1") and ("vertex_scalar_array" in change or "/has" in change), change


def test_layers_are_compared_where_the_document_shows_them():
    ms = spheres(1, 1)
    assert ms.apply_filter(DIFFERENCE)["rms_difference"] == 0
    ms.compute_matrix_from_translation(axisx=5, freeze=False)
    report = ms.apply_filter(DIFFERENCE)
    assert report["smallest_difference"] == pytest.approx(3, abs=0.01)
    assert report["largest_difference"] == pytest.approx(5, abs=0.01)


def test_a_script_names_the_layer(tmp_path):
    ms = spheres(1, 2, 1.5)
    ms.apply_filter(DIFFERENCE, layer=1)
    expected = ms.current_mesh().vertex_scalar_array()
    path = tmp_path / "script.mlx"
    path.write_text(
        '<!DOCTYPE FilterScript><FilterScript><filter name="Multiresolution: Difference to Layer">'
        '<Param type="RichMesh" name="layer" value="1"/></filter></FilterScript>'
    )
    other = spheres(1, 2, 1.5)
    other.load_filter_script(str(path))
    other.apply_filter_script()
    np.testing.assert_array_equal(other.current_mesh().vertex_scalar_array(), expected)
