"""What the filters of attributes do, end to end in pymeshlab: on the meshes with attributes, and on bad values."""

import os

import numpy as np
import pymeshlab
import pytest
from test_filters import BUNNY, NASTY, SHARED, bunny, load, usable
from test_pymeshlab import Error, differences, new_document, rich_sphere, snapshot

RELAX, BAND = "apply_attributes_multires_relaxation", "apply_attributes_multires_band"
CUSTOM_BAND, DENOISE = "apply_attributes_multires_band_custom", "apply_attributes_multires_denoise"
TEXCOORD = "generate_multires_texcoord"
GEOMETRY = ["vertices", "faces", "normals", "face normals", "box", "selected vertices", "selected faces"]


def shared(file):
    path = SHARED / "attributes" / file
    if not path.exists() and not os.environ.get("CI"):
        pytest.skip(f"no {path}")
    return load(path)


def assert_same_geometry(before, after):
    old, new = before["meshes"][before["current"]], after["meshes"][after["current"]]
    for part in GEOMETRY:
        np.testing.assert_array_equal(old[part], new[part], err_msg=part)


def edges(mesh):
    f = mesh.face_matrix()
    return np.unique(np.sort(np.vstack([f[:, [0, 1]], f[:, [1, 2]], f[:, [2, 0]]]), axis=1), axis=0)


def energy(mesh):
    """Dirichlet energy of the colours over the edges."""
    c, e = mesh.vertex_color_matrix(), edges(mesh)
    return ((c[e[:, 0]] - c[e[:, 1]]) ** 2).sum()


# ---- relaxation ------------------------------------------------------------------------------------------------------


def test_swirl_becomes_smooth_as_in_the_paper():
    """Roy et al. 2003, Figure 3: 1 and 20 iterations."""
    ms = shared("swirl_rgb.off")
    mesh, before = ms.current_mesh(), snapshot(ms)
    old = mesh.vertex_color_matrix()
    energies = [energy(mesh)]
    for iterations in (1, 20):
        ms = shared("swirl_rgb.off")
        ms.apply_filter(RELAX, iterations=iterations)
        new = ms.current_mesh().vertex_color_matrix()
        energies.append(energy(ms.current_mesh()))
        assert new.min() >= old.min() and (new[:, :3].max(axis=0) <= old[:, :3].max(axis=0)).all()
        assert np.abs(new.mean(axis=0) - old.mean(axis=0)).max() < 0.002
        assert (new[:, 3] == 1).all()
        assert_same_geometry(before, snapshot(ms))
    assert energies[1] < 0.3 * energies[0] and energies[2] < 0.1 * energies[1]


def test_colours_are_rounded_once():
    """Twenty steps at once differ from twenty steps with colours rounded after each; the former are nearer to those
    of a quality, which is not rounded at all."""
    at_once, rounded, exact = (shared("swirl_rgb.off") for _ in range(3))
    at_once.apply_filter(RELAX, iterations=20)
    for _ in range(20):
        rounded.apply_filter(RELAX)
    exact.compute_scalar_by_function_per_vertex(q="r")
    exact.apply_filter(RELAX, color=False, quality=True, iterations=20)
    truth = exact.current_mesh().vertex_scalar_array()
    errors = [np.abs(255 * ms.current_mesh().vertex_color_matrix()[:, 0] - truth).max() for ms in (at_once, rounded)]
    assert errors[0] <= 0.5 + 1e-5 < errors[1]


def corner_groups(mesh):
    """For each corner the number of the set that shares its vertex and texture coordinate."""
    keys = np.column_stack([mesh.face_matrix().ravel(), mesh.wedge_tex_coord_matrix()])
    return np.unique(keys, axis=0, return_inverse=True)[1].ravel()


@pytest.mark.parametrize("keep_outline", [True, False])
def test_wedge_seams_stay_closed(keep_outline):
    ms = shared("kip_uv.obj")
    mesh, before = ms.current_mesh(), snapshot(ms)
    old, groups = mesh.wedge_tex_coord_matrix(), corner_groups(mesh)
    assert groups.max() + 1 > mesh.vertex_number(), "there are seams"
    report = ms.apply_filter(RELAX, iterations=10, keep_outline=keep_outline)
    new = mesh.wedge_tex_coord_matrix()
    first = np.zeros(groups.max() + 1, dtype=int)
    first[groups] = np.arange(len(groups))
    np.testing.assert_array_equal(new, new[first[groups]])
    assert (new != old).any() and (new >= old.min(axis=0)).all() and (new <= old.max(axis=0)).all()
    corners = mesh.face_matrix().ravel()
    sets = np.unique(np.column_stack([corners, groups]), axis=0)
    several = np.bincount(sets[:, 0]) > 1
    assert report["seam_vertices"] == several.sum()
    on_seam = several[corners]
    if keep_outline:
        np.testing.assert_array_equal(new[on_seam], old[on_seam])
    else:
        assert (new[on_seam] != old[on_seam]).any()
    assert_same_geometry(before, snapshot(ms))


def test_custom_attributes_by_name():
    ms = rich_sphere()
    mesh = ms.current_mesh()
    number = mesh.vertex_custom_scalar_attribute_array("number")
    doubled = mesh.vertex_custom_point_attribute_matrix("doubled")
    report = ms.apply_filter(RELAX, color=False, custom=True, custom_names="doubled", selected=False)
    assert "custom_doubled_rms_change" in report and "custom_number_rms_change" not in report
    np.testing.assert_array_equal(mesh.vertex_custom_scalar_attribute_array("number"), number)
    assert (mesh.vertex_custom_point_attribute_matrix("doubled") != doubled).any(axis=1).all()
    ms.apply_filter(RELAX, color=False, custom=True, selected=False)
    assert (mesh.vertex_custom_scalar_attribute_array("number") != number).mean() > 0.9
    with pytest.raises(Error, match="custom_names"):
        ms.apply_filter(RELAX, color=False, custom=True, custom_names="doubled, absent")


@pytest.mark.parametrize("name", [RELAX, BAND, DENOISE])
def test_only_the_selection_changes(name):
    ms = rich_sphere()
    ms.set_selection_none()
    ms.compute_selection_by_condition_per_vertex(condselect="x > 0.3")
    mesh, before = ms.current_mesh(), snapshot(ms)
    selected, old = mesh.vertex_selection_array(), mesh.vertex_scalar_array()
    parameters = {"unit": "level", "cutoff": 2.0} if name == BAND else {}
    parameters |= {"automatic": False, "threshold": 10.0} if name == DENOISE else {}
    parameters |= {"base_vertices": 10} if name != RELAX else {}
    ms.apply_filter(name, quality=True, **parameters)
    new = mesh.vertex_scalar_array()
    np.testing.assert_array_equal(new[~selected], old[~selected])
    assert (new[selected] != old[selected]).mean() > 0.9
    assert_same_geometry(before, snapshot(ms))


@pytest.mark.parametrize("name", [RELAX, BAND, DENOISE])
def test_values_that_are_not_numbers_are_refused_by_name(name):
    ms = bunny()
    quality = np.ones(ms.current_mesh().vertex_number())
    quality[99] = np.nan
    ms.add_mesh(
        pymeshlab.Mesh(ms.current_mesh().vertex_matrix(), ms.current_mesh().face_matrix(), v_scalar_array=quality)
    )
    before = snapshot(ms)
    with pytest.raises(Error, match="quality.*99"):
        ms.apply_filter(name, color=False, quality=True)
    assert differences(before, snapshot(ms)) == []


@pytest.mark.parametrize(
    "name, parameters, message",
    [
        (RELAX, {"color": False}, "no attribute is chosen"),
        (RELAX, {"wedge_texcoord": True}, "wedge_texcoord: the mesh has no"),
        (RELAX, {"texcoord": True}, "texcoord: the mesh has no"),
        (RELAX, {"custom": True}, "custom: the mesh has no"),
        (CUSTOM_BAND, {}, "custom: the mesh has no"),
        (TEXCOORD, {"projection": "existing"}, "projection: the mesh has no"),
    ],
)
def test_what_is_missing_is_named(name, parameters, message):
    ms = bunny()
    ms.compute_color_by_function_per_vertex()
    before = snapshot(ms)
    with pytest.raises(Error, match=message):
        ms.apply_filter(name, **parameters)
    assert differences(before, snapshot(ms)) == []


@pytest.mark.parametrize("path", NASTY, ids=lambda p: p.name)
@pytest.mark.parametrize("name", [RELAX, BAND, DENOISE, CUSTOM_BAND])
def test_nasty_meshes_with_attributes(name, path):
    ms = load(path)
    mesh = ms.current_mesh()
    if not usable(mesh):
        return  # refused, as tested elsewhere
    v, f = mesh.vertex_matrix(), mesh.face_matrix()
    random = np.random.default_rng(1)
    ms.add_mesh(
        pymeshlab.Mesh(v, f, v_color_matrix=random.random((len(v), 4)), v_scalar_array=random.random(len(v)))
    )
    mesh = ms.current_mesh()
    mesh.add_vertex_custom_scalar_attribute(random.random(len(v)), "heat")
    before = snapshot(ms)
    ms.apply_filter(name, **({} if name == CUSTOM_BAND else {"quality": True, "color": True}))
    assert np.isfinite(mesh.vertex_scalar_array()).all()
    assert np.isfinite(mesh.vertex_custom_scalar_attribute_array("heat")).all()
    assert_same_geometry(before, snapshot(ms))


# ---- bands and noise -------------------------------------------------------------------------------------------------


def test_bands_of_quality_and_of_a_custom_attribute_are_the_same_and_add_up():
    ms = bunny()
    mesh = ms.current_mesh()
    ms.compute_scalar_by_function_per_vertex(q="sin(200*x)+sin(30*y)")
    q = mesh.vertex_scalar_array()
    mesh.add_vertex_custom_scalar_attribute(q, "heat")
    low = {"mode": "low pass", "unit": "level", "cutoff": 6.0}
    ms.apply_filter(BAND, color=False, quality=True, **low)
    report = ms.apply_filter(CUSTOM_BAND, **low)
    assert report["pyramid_reused"] is True
    smooth = mesh.vertex_scalar_array()
    np.testing.assert_allclose(mesh.vertex_custom_scalar_attribute_array("heat"), smooth, atol=1e-9)
    mesh.add_vertex_custom_scalar_attribute(q, "again")
    fine = {"unit": "level", "finest": 0.0, "coarsest": 6.0, "gain": 2.0}
    ms.apply_filter(CUSTOM_BAND, mode="enhance", custom_names="again", **fine)
    np.testing.assert_allclose(mesh.vertex_custom_scalar_attribute_array("again"), 2 * q - smooth, atol=1e-9)
    assert np.abs(smooth - q).max() > 0.1


@pytest.mark.parametrize("contrast", [0.5, 1])
def test_noise_on_the_swirl_is_found_and_taken_away(contrast):
    """At full contrast most of it is cut off at black and white: no such noise is known, and the colours stay."""
    ms = shared("swirl_rgb.off")
    mesh = ms.current_mesh()
    true = 0.5 + contrast * (mesh.vertex_color_matrix() - 0.5)
    random = np.random.default_rng(5)
    noisy = np.clip(np.round(255 * true + 20 * random.standard_normal(true.shape)), 0, 255) / 255
    noisy[:, 3] = true[:, 3] = 1
    ms.add_mesh(pymeshlab.Mesh(mesh.vertex_matrix(), mesh.face_matrix(), v_color_matrix=noisy))
    before = snapshot(ms)
    report = ms.apply_filter(DENOISE)
    after = ms.current_mesh().vertex_color_matrix()
    rms = [np.sqrt(((colors - true) ** 2).mean()) for colors in (noisy, after)]
    assert rms[1] < 0.9 * rms[0] if contrast < 1 else rms[1] <= rms[0]
    assert 0 <= report["color_estimated_rms_after"] <= report["color_estimated_rms_before"]
    assert_same_geometry(before, snapshot(ms))


# ---- texture coordinates ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize("projection", ["cylindrical", "spherical", "planar"])
def test_texture_coordinates_are_made_for_vertices_and_wedges(projection):
    ms = load(BUNNY)
    mesh, before = ms.current_mesh(), snapshot(ms)
    assert not mesh.has_vertex_tex_coord() and not mesh.has_wedge_tex_coord()
    report = ms.apply_filter(TEXCOORD, projection=projection, axis="y")
    assert mesh.has_vertex_tex_coord() and mesh.has_wedge_tex_coord()
    vertex, wedge = mesh.vertex_tex_coord_matrix(), mesh.wedge_tex_coord_matrix().reshape(-1, 3, 2)
    corners = mesh.face_matrix()
    np.testing.assert_array_equal(wedge[:, :, 1], vertex[corners][:, :, 1])
    turns = wedge[:, :, 0] - vertex[corners][:, :, 0]
    assert np.abs(turns - np.round(turns)).max() < 1e-6
    wide = np.ptp(wedge[:, :, 0], axis=1) > 0.5
    assert wide.sum() <= report["pole_faces"] and report["pole_faces"] < 20
    assert (report["seam_faces"] > 0) == (projection != "planar")
    assert_same_geometry(before, snapshot(ms))


def test_existing_texture_coordinates_are_made_smooth():
    ms = bunny()
    mesh = ms.current_mesh()
    v = mesh.vertex_matrix()
    random = np.random.default_rng(2)
    uv = v[:, :2] + 0.002 * random.standard_normal((len(v), 2))
    ms.add_mesh(pymeshlab.Mesh(v, mesh.face_matrix(), v_tex_coords_matrix=uv))
    mesh = ms.current_mesh()
    e = edges(mesh)
    ms.apply_filter(TEXCOORD, projection="existing", coarse_vertices=500)
    new = mesh.vertex_tex_coord_matrix()
    rough = [((x[e[:, 0]] - x[e[:, 1]] - (v[e[:, 0], :2] - v[e[:, 1], :2])) ** 2).sum() for x in (uv, new)]
    assert rough[1] < 0.5 * rough[0]
