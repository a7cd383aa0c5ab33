"""Following an edited layer through pymeshlab: what stays, and that a level knows where it came from."""

import pathlib

import numpy as np
import pymeshlab
import pytest
from test_pymeshlab import Error, differences, new_document, snapshot

FOLLOW = "apply_coord_multires_transfer_edit"
TEXTURED = pathlib.Path(pymeshlab.__file__).parent / "tests/sample_meshes/bunny10k_textured.obj"


def twisted(v):
    angle = 0.4 * v[:, 1] / np.ptp(v[:, 1])
    x, y, z = v.T
    return np.column_stack([x * np.cos(angle) - z * np.sin(angle), y, x * np.sin(angle) + z * np.cos(angle)])


def scan_and_level():
    """A textured scan with a selection (current), and its level by Level as New Layer (id 1)."""
    ms = new_document()
    ms.load_new_mesh(str(TEXTURED))
    ms.apply_filter("generate_multires_level")
    ms.set_current_mesh(0)
    return ms


def edited_level(ms, change):
    """The level of the document, changed in place."""
    ms.set_current_mesh(1)
    level = ms.current_mesh()
    sources = level.vertex_custom_scalar_attribute_array("source_vertex")
    changed = pymeshlab.Mesh(change(level.vertex_matrix()), level.face_matrix())
    changed.add_vertex_custom_scalar_attribute(sources, "source_vertex")
    ms.add_mesh(changed)
    ms.set_current_mesh(0)
    return ms


def test_a_level_that_was_not_changed_leaves_the_document_as_it_is():
    ms = scan_and_level()
    before = snapshot(ms)
    report = ms.apply_filter(FOLLOW, edited=1, before=1, selected=False)
    assert report["way"] == 1
    assert differences(before, snapshot(ms)) == []


@pytest.mark.parametrize("parameters", [{"before": 1}, {"before": 2}])
def test_only_positions_change(parameters):
    ms = edited_level(scan_and_level(), twisted)
    ms.compute_selection_by_condition_per_vertex(condselect="y > 0.1")
    before, expected = snapshot(ms), twisted(ms.current_mesh().vertex_matrix())
    report = ms.apply_filter(FOLLOW, edited=2, selected=False, **parameters)
    assert report["way"] == {1: 2, 2: 1}[parameters["before"]]
    assert report["folded_faces"] == 0
    changes = differences(before, snapshot(ms))
    assert changes
    for change in changes:
        assert any(change.startswith(f"/meshes/0/{part}") for part in ("vertices", "box", "normals", "face normals")), change
    error = np.linalg.norm(ms.current_mesh().vertex_matrix() - expected, axis=1)
    assert np.sqrt((error**2).mean()) < 3e-4 * np.linalg.norm(np.ptp(expected, axis=0))


def test_a_level_is_edited_with_filters_of_meshlab():
    """The example of docs/editing.md."""
    ms = scan_and_level()
    before = ms.current_mesh().vertex_matrix()
    ms.set_current_mesh(1)
    ms.generate_copy_of_current_mesh()
    ms.compute_coord_by_function(x="x", y="y", z="z + 0.02 * y^2")
    ms.set_current_mesh(0)
    report = ms.apply_filter(FOLLOW, edited=2, before=1, selected=False)
    expected = before.copy()
    expected[:, 2] += 0.02 * before[:, 1] ** 2
    error = np.linalg.norm(ms.current_mesh().vertex_matrix() - expected, axis=1)
    assert np.sqrt((error**2).mean()) < 0.01 * report["rms_displacement"]
    assert report["folded_faces"] == 0


def test_a_remeshed_copy_is_wrapped():
    ms = scan_and_level()
    v = ms.current_mesh().vertex_matrix()
    ms.add_mesh(pymeshlab.Mesh(v + 0.05 * np.ptp(v, axis=0), ms.current_mesh().face_matrix()))
    ms.meshing_isotropic_explicit_remeshing(iterations=2)
    ms.set_current_mesh(0)
    report = ms.apply_filter(FOLLOW, edited=2, before=2)
    assert report["way"] == 3
    assert report["rms_displacement"] > 0.03 * np.linalg.norm(np.ptp(v, axis=0))


def test_layers_that_do_not_fit_together_are_refused_with_their_numbers():
    ms = scan_and_level()
    ms.create_sphere()
    ms.set_current_mesh(0)
    before = snapshot(ms)
    with pytest.raises(Error, match="before and edited do not fit together: before has .* edited has 642 vertices"):
        ms.apply_filter(FOLLOW, edited=2, before=1)
    assert differences(before, snapshot(ms)) == []


def test_a_region_moves_and_the_rest_stays():
    ms = new_document()
    ms.load_new_mesh(str(TEXTURED))
    v = ms.current_mesh().vertex_matrix()
    top = v[:, 1] > v[:, 1].max() - 0.2 * np.ptp(v[:, 1])
    ms.compute_selection_by_condition_per_vertex(condselect=f"y > {v[:, 1].max() - 0.2 * np.ptp(v[:, 1])}")
    before = snapshot(ms)
    report = ms.apply_filter("apply_coord_multires_displace", translation=[0, 0, 1], store_falloff=True)
    after, share = ms.current_mesh().vertex_matrix(), ms.current_mesh().vertex_scalar_array()
    np.testing.assert_allclose(after[top], v[top] + [0, 0, 1], atol=1e-12)
    np.testing.assert_array_equal(after[share == 0], v[share == 0])
    assert set(share[top]) == {1} and 100 < ((share > 0) & (share < 1)).sum() < top.sum()
    assert report["largest_displacement"] == pytest.approx(1, rel=0.1)
    parts = ("/vertices", "/box", "/normals", "/face normals", "/vertex_scalar_array", "/has", ": ['vertex_scalar_array']")
    for change in differences(before, snapshot(ms)):
        assert any(change.startswith(f"/meshes/0{part}") for part in parts), change
    other = new_document()
    other.load_new_mesh(str(TEXTURED))
    other.compute_selection_by_condition_per_vertex(condselect=f"y > {v[:, 1].max() - 0.2 * np.ptp(v[:, 1])}")
    other.apply_filter("compute_scalar_multires_falloff_per_vertex")
    np.testing.assert_array_equal(other.current_mesh().vertex_scalar_array(), share)


def test_a_smooth_base_can_be_edited_and_followed():
    ms = new_document()
    ms.load_new_mesh(str(TEXTURED))
    report = ms.apply_filter("generate_multires_base", vertices=500)
    base = ms.current_mesh()
    assert report["vertices_kept"] == 500
    ms.add_mesh(pymeshlab.Mesh(base.vertex_matrix() * 2, base.face_matrix()))
    ms.set_current_mesh(0)
    v = ms.current_mesh().vertex_matrix()
    np.testing.assert_array_equal(base.face_matrix(), ms.current_mesh().face_matrix())
    ms.apply_filter(FOLLOW, before=1, edited=2)
    np.testing.assert_allclose(ms.current_mesh().vertex_matrix(), 2 * v, atol=1e-9 * np.ptp(v))


def test_detail_is_stored_and_applied_later():
    ms = new_document()
    ms.load_new_mesh(str(TEXTURED))
    v, f = ms.current_mesh().vertex_matrix(), ms.current_mesh().face_matrix()
    sculpted = v + 0.01 * np.ptp(v) * np.sin(9 * v[:, [1, 2, 0]] / np.ptp(v))
    ms.add_mesh(pymeshlab.Mesh(sculpted, f))
    ms.set_current_mesh(0)
    before = snapshot(ms)
    report = ms.apply_filter("transfer_coord_multires_detail", layer=1, use="store", attribute="waves")
    assert report["rms_detail"] == pytest.approx(np.sqrt(((sculpted - v) ** 2).sum(axis=1).mean()))
    assert ms.current_mesh().vertex_custom_point_attribute_matrix("waves").shape == v.shape
    assert all("waves" in change or "custom" in change for change in differences(before, snapshot(ms)))
    ms.apply_filter("transfer_coord_multires_detail", use="apply stored", attribute="waves")
    np.testing.assert_allclose(ms.current_mesh().vertex_matrix(), sculpted, atol=1e-12 * np.ptp(v))
    before = snapshot(ms)
    with pytest.raises(Error, match="use: there is no attribute pores of points"):
        ms.apply_filter("transfer_coord_multires_detail", use="apply stored", attribute="pores")
    assert differences(before, snapshot(ms)) == []


def test_bands_put_the_scan_together_again():
    ms = new_document()
    ms.load_new_mesh(str(TEXTURED))
    before = snapshot(ms)
    report = ms.apply_filter("apply_coord_multires_bands", gain_2=1)
    assert differences(before, snapshot(ms)) == []
    assert len(report["vertices_kept"]) == len(report["band_detail"]) == 4
    report = ms.apply_filter("apply_coord_multires_bands", gain_1=2, gain_2=1, levels="equal detail")
    assert report["rms_displacement"] == pytest.approx(report["band_detail"][0], rel=1e-6)
