"""What the filters promise, end to end in pymeshlab: on bad input, on selections, with attributes, with a kept pyramid."""

import os
import pathlib
import subprocess
import sys

import numpy as np
import pymeshlab
import pytest
from conftest import FILTERS, PLUGINS, wants_another_layer, wants_grid
from conftest import FILTER_IDS as EVERY_ID
from test_pymeshlab import Error, differences, new_document, rich_sphere, snapshot

SHARED = pathlib.Path(__file__).resolve().parents[3] / "shared/meshes"
NASTY = sorted(p for p in SHARED.glob("nasty/*") if p.suffix != ".mtl")
BUNNY = pathlib.Path(pymeshlab.__file__).parent / "tests/sample_meshes/bunny.obj"

# Those of one layer that take every mesh; the others are tested in test_layers.py and test_grids.py.
FILTER_IDS = [name for name in EVERY_ID if not wants_another_layer(name) and not wants_grid(name)]

PYRAMID, LEVEL = "compute_multires_pyramid", "generate_multires_level"
DETAIL = "compute_scalar_multires_detail_per_vertex"
LOW_PASS, STOP_BAND = "apply_coord_multires_low_pass", "apply_coord_multires_stop_band"
ENHANCE, EQUALIZER = "apply_coord_multires_enhance", "apply_coord_multires_equalizer"
UNSHARP = "apply_coord_multires_unsharp"
ADAPTIVE = "generate_multires_adaptive_reconstruction"
BASE = "generate_multires_base"
DISPLACE, FALLOFF = "apply_coord_multires_displace", "compute_scalar_multires_falloff_per_vertex"
NEW_LAYER = [LEVEL, ADAPTIVE, BASE]
MOVING = [name for name in FILTER_IDS if name.startswith("apply_coord") and name != DISPLACE]  # which asks where to
ROUGHNESS = "compute_multires_roughness"
RELIEF, SCALES = "compute_scalar_multires_relief_per_vertex", "compute_custom_multires_scales"
SELECT = "compute_selection_multires_features"
WITHOUT_PYRAMID = (UNSHARP, ROUGHNESS, RELIEF, SCALES, SELECT, DISPLACE, FALLOFF)
WITH_PYRAMID = [name for name in FILTER_IDS if name not in WITHOUT_PYRAMID]

POSITIONS = {"vertices", "normals", "face normals", "box"}
ATTRIBUTES = {"vertex_color_matrix", "vertex_scalar_array", "vertex_tex_coord_matrix", "wedge_tex_coord_matrix"}
every_filter = pytest.mark.parametrize("name", FILTER_IDS)
every_moving = pytest.mark.parametrize("name", MOVING)


def read_off(path):
    """Vertices and faces of an OFF file, polygons cut into fans. MeshLab's own importer gives polygons that repeat a
    vertex indices beyond the last vertex, and then writes there."""
    numbers = [word for line in path.read_text().splitlines() for word in line.split("#")[0].split()]
    assert numbers[0] == "OFF"
    n, m = int(numbers[1]), int(numbers[2])
    vertices = np.array(numbers[4 : 4 + 3 * n], dtype=float).reshape(n, 3)
    faces, at = [], 4 + 3 * n
    for _ in range(m):
        polygon = [int(word) for word in numbers[at + 1 : at + 1 + int(numbers[at])]]
        at += 1 + len(polygon)
        faces += [[polygon[0], polygon[i], polygon[i + 1]] for i in range(1, len(polygon) - 1)]
    return pymeshlab.Mesh(vertices, np.array(faces).reshape(-1, 3))


def load(path):
    ms = new_document()
    if path.suffix == ".off" and path.parent.name == "nasty":
        ms.add_mesh(read_off(path))
    else:
        ms.load_new_mesh(str(path))
    return ms


def bunny():
    return load(BUNNY)


def diagonal(mesh):
    return np.linalg.norm(np.ptp(mesh.vertex_matrix(), axis=0))


def usable(mesh):
    """Whether filters must accept the mesh: it has a finite shape with an area."""
    v, f = mesh.vertex_matrix(), mesh.face_matrix()
    if len(v) == 0 or len(f) == 0 or not np.isfinite(v).all() or np.ptp(v, axis=0).max() == 0:
        return False
    a, b, c = v[f[:, 1]] - v[f[:, 0]], v[f[:, 2]] - v[f[:, 1]], v[f[:, 0]] - v[f[:, 2]]
    double_area = np.linalg.norm(np.cross(a, b), axis=1)
    return bool((double_area > 1e-10 * ((a * a) + (b * b) + (c * c)).sum(axis=1)).any())


def has_attributes_for(name, mesh):
    """Whether the mesh has what a filter of attributes works on by default."""
    if not name.startswith("apply_attributes"):
        return True
    if name.endswith("custom"):
        return False
    every = [mesh.has_vertex_color(), mesh.has_vertex_scalar()]
    if name == "apply_attributes_multires_relaxation":
        every += [mesh.has_wedge_tex_coord(), mesh.has_vertex_tex_coord()]
    return any(every)


def all_finite(value):
    return bool(np.isfinite(np.asarray(value, dtype=float)).all())


def changed_parts(before, after):
    """(layer, part) of what differs between two snapshots; new layers left out."""
    changed = set()
    for layer, old in before["meshes"].items():
        new = after["meshes"][layer]
        for part in old.keys() | new.keys():
            if part not in old or part not in new or differences(old[part], new[part]):
                changed.add((layer, part))
    return changed


def check_outcome(ms, name, before, report):
    """What every call that succeeds promises."""
    assert report and all(all_finite(value) for value in report.values())
    here = before["current"]
    quality = {"vertex_scalar_array", "has"} if name in (DETAIL, FALLOFF, RELIEF, SCALES) else set()
    allowed = POSITIONS if name in [*MOVING, DISPLACE] else quality
    if name.startswith("apply_attributes"):
        allowed = ATTRIBUTES
    if name.endswith("texcoord"):
        allowed = ATTRIBUTES - {"vertex_color_matrix", "vertex_scalar_array"} | {"has"}
    after = snapshot(ms)
    assert changed_parts(before, after) <= {(here, part) for part in allowed}
    old, new = before["meshes"][here]["vertices"], after["meshes"][here]["vertices"]
    assert all_finite(new)
    if name in MOVING:
        moved = np.linalg.norm(new - old, axis=1)
        assert report["largest_displacement"] == pytest.approx(moved.max(), rel=1e-9, abs=1e-300)
        assert report["rms_displacement"] == pytest.approx(np.sqrt((moved**2).mean()), rel=1e-9, abs=1e-300)
        unused = np.setdiff1d(np.arange(len(old)), before["meshes"][here]["faces"])
        np.testing.assert_array_equal(new[unused], old[unused])
    assert len(after["meshes"]) == len(before["meshes"]) + (name in NEW_LAYER)


def test_details_by_scale_are_new_attributes_that_the_next_call_takes(tmp_path):
    ms = bunny()
    report = ms.apply_filter(SCALES, bands=3)
    assert len(report["limits"]) == 3
    first = [ms.current_mesh().vertex_custom_scalar_attribute_array(f"scale_{i}") for i in (1, 2, 3)]
    assert all(all_finite(values) and np.ptp(values) > 0 for values in first)
    ms.apply_filter(SCALES, bands=2, values="heights")
    again = [ms.current_mesh().vertex_custom_scalar_attribute_array(f"scale_{i}") for i in (1, 2, 3)]
    assert not np.array_equal(first[1], again[1]) and np.array_equal(first[2], again[2])
    ms.apply_filter("apply_attributes_multires_band_custom", custom_names="scale_1")
    ms.current_mesh().add_vertex_custom_point_attribute(ms.current_mesh().vertex_matrix(), "taken_1")
    before = snapshot(ms)
    with pytest.raises(Error, match="taken_1"):
        ms.apply_filter(SCALES, prefix="taken")
    assert differences(before, snapshot(ms)) == []


def test_features_are_selected_for_a_pyramid():
    ms = new_document()
    ms.create_cube()
    ms.meshing_surface_subdivision_midpoint(iterations=4)
    report = ms.apply_filter(SELECT)
    assert report["length"] == pytest.approx(12) and report["edges"] == 12 * 16
    kept = ms.apply_filter("apply_coord_multires_low_pass", features="selected edges", cutoff=0.5)
    assert kept["largest_displacement"] < 0.05
    ms.apply_filter(SELECT, select="vertices")
    assert ms.current_mesh().selected_vertex_number() == 12 * 15 + 8


# ---- bad and unusual input -------------------------------------------------------------------------------------------


def test_the_nasty_meshes_are_here():
    if not NASTY and not os.environ.get("CI"):
        pytest.skip(f"no meshes in {SHARED}")
    assert NASTY


@pytest.mark.parametrize("path", NASTY, ids=lambda p: p.name)
@every_filter
def test_nasty_mesh_works_or_is_refused_and_left_alone(name, path):
    ms = load(path)
    before = snapshot(ms)
    accepted = usable(ms.current_mesh()) and has_attributes_for(name, ms.current_mesh())
    try:
        report = ms.apply_filter(name)
    except Error as error:
        assert not accepted, f"refused: {error}"
        assert "Internal error" not in str(error)
        assert differences(before, snapshot(ms)) == []
        return
    assert accepted, "must be refused"
    check_outcome(ms, name, before, report)


@pytest.mark.parametrize("path", NASTY, ids=lambda p: p.name)
def test_equalizer_at_one_is_the_identity_on_nasty_meshes(path):
    ms = load(path)
    mesh = ms.current_mesh()
    if not usable(mesh):
        return  # refused, as tested above
    before = mesh.vertex_matrix()
    ms.apply_filter(EQUALIZER)
    assert np.abs(mesh.vertex_matrix() - before).max() <= 1e-12 * diagonal(mesh)


@every_filter
def test_generated_mesh_works_or_is_refused_and_left_alone(name, meshes):
    for path in sorted(meshes.glob("*.ply")):
        ms = load(path)
        before = snapshot(ms)
        accepted = usable(ms.current_mesh()) and has_attributes_for(name, ms.current_mesh())
        try:
            report = ms.apply_filter(name)
        except Error as error:
            assert not accepted, f"{path.name} refused: {error}"
            assert differences(before, snapshot(ms)) == []
            continue
        assert accepted, f"{path.name} must be refused"
        check_outcome(ms, name, before, report)


@pytest.mark.parametrize(
    "name, parameters, message",
    [
        (STOP_BAND, {"unit": "level", "finest": 5, "coarsest": 3}, "finest"),
        (STOP_BAND, {"unit": "vertices", "finest": 1000, "coarsest": 7000}, "finest"),
        (ENHANCE, {"unit": "wavelength percent", "finest": 3, "coarsest": 3}, "finest"),
        (LEVEL, {"level": 1000}, "level"),
    ],
)
def test_limits_out_of_order_are_refused(name, parameters, message):
    ms = rich_sphere()
    before = snapshot(ms)
    with pytest.raises(Error, match=message):
        ms.apply_filter(name, **parameters)
    assert differences(before, snapshot(ms)) == []


def test_pyramid_counts_what_is_unusual():
    v = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [0, -1, 0], [9, 9, 9], [9, 9, 9]], dtype=float)
    ms = new_document()
    ms.add_mesh(pymeshlab.Mesh(vertex_matrix=v, face_matrix=np.array([[0, 1, 2], [0, 1, 3], [0, 1, 4], [4, 1, 0]])))
    report = ms.apply_filter(PYRAMID)
    expected = {"unreferenced_vertices": 2, "duplicate_vertices": 1, "duplicate_faces": 1, "non_manifold_edges": 1,
                "components": 1}  # fmt: skip
    assert {key: report[key] for key in expected} == expected


# ---- what filters do -------------------------------------------------------------------------------------------------


@every_moving
def test_filter_without_parameters_does_something(name):
    ms = bunny()
    before = snapshot(ms)
    report = ms.apply_filter(name)
    check_outcome(ms, name, before, report)
    moved = report["largest_displacement"] / diagonal(ms.current_mesh())
    nothing_to_do = name in (EQUALIZER, "apply_coord_multires_denoise")  # the bunny has no noise
    assert moved <= 1e-12 if nothing_to_do else 1e-4 < moved < 0.1


@pytest.mark.parametrize("name, parameters", [(EQUALIZER, {}), (ENHANCE, {"gain": 1}), (UNSHARP, {"xi": 1})])
def test_gain_of_one_is_the_identity(name, parameters):
    ms = bunny()
    mesh = ms.current_mesh()
    before = mesh.vertex_matrix()
    ms.apply_filter(name, **parameters)
    assert np.abs(mesh.vertex_matrix() - before).max() <= 1e-12 * diagonal(mesh)


def test_enhance_by_zero_is_the_stop_band():
    results = []
    for name, parameters in ((ENHANCE, {"gain": 0}), (STOP_BAND, {})):
        ms = bunny()
        ms.apply_filter(name, **parameters)
        results.append(ms.current_mesh().vertex_matrix())
    np.testing.assert_array_equal(*results)


def test_units_name_the_same_cutoff():
    ms = bunny()
    report = ms.apply_filter(PYRAMID)
    level = 6
    wavelength, vertices = report["wavelength"][level], report["vertices"][level]
    percent = 100 * wavelength / diagonal(ms.current_mesh())
    results = []
    for unit, cutoff in (("level", level), ("wavelength", wavelength), ("wavelength percent", percent),
                         ("vertices", vertices)):  # fmt: skip
        ms = bunny()
        ms.apply_filter(LOW_PASS, unit=unit, cutoff=float(cutoff))
        results.append(ms.current_mesh().vertex_matrix())
    for other in results[1:]:  # parameters pass through single precision
        assert np.abs(other - results[0]).max() <= 1e-6 * diagonal(ms.current_mesh())


@every_moving
def test_results_do_not_depend_on_scale(name):
    results = []
    for scale in (1, 1024):
        ms = bunny()
        mesh = ms.current_mesh()
        ms.add_mesh(pymeshlab.Mesh(scale * mesh.vertex_matrix(), mesh.face_matrix()))
        ms.apply_filter(name)
        results.append(ms.current_mesh().vertex_matrix() / scale)
    assert np.abs(results[1] - results[0]).max() <= 1e-6 * diagonal(ms.mesh(0))


def test_reconstruction_error_is_small_and_levels_shrink():
    ms = bunny()
    report = ms.apply_filter(PYRAMID)
    assert report["reconstruction_error"] <= 1e-12 * diagonal(ms.current_mesh())
    assert (np.diff(report["vertices"]) < 0).all() and (np.diff(report["wavelength"]) > 0).all()
    assert report["levels"] + 1 == len(report["vertices"]) == len(report["rms_detail"])


def test_detail_becomes_quality():
    ms = bunny()
    before = ms.current_mesh().vertex_matrix()
    report = ms.apply_filter(DETAIL)
    detail = ms.current_mesh().vertex_scalar_array()
    assert report["largest_detail"] == pytest.approx(detail.max()) and detail.min() >= 0
    ms.apply_filter(STOP_BAND)
    moved = np.linalg.norm(ms.current_mesh().vertex_matrix() - before, axis=1)
    np.testing.assert_allclose(detail, moved, atol=1e-9 * diagonal(ms.current_mesh()))


@pytest.mark.parametrize("threads", [1, 3])
def test_results_do_not_depend_on_the_number_of_threads(threads, tmp_path):
    """The same to the last bit; in processes of their own, because the number is read once."""
    script = f"""if True:
        import numpy, pymeshlab, sys
        for plugin in {[str(p) for p in PLUGINS]}:
            pymeshlab.load_plugin(plugin)
        for name in {MOVING}:
            ms = pymeshlab.MeshSet(verbose=False)
            ms.load_new_mesh({str(BUNNY)!r})
            ms.apply_filter(name)
            numpy.save(sys.argv[1] + "/" + name, ms.current_mesh().vertex_matrix())
    """
    folder = tmp_path / str(threads)
    folder.mkdir()
    environment = {**os.environ, "MULTIRES_THREADS": str(threads)}
    subprocess.run([sys.executable, "-c", script, folder], check=True, env=environment)
    for name in MOVING:
        ms = bunny()
        ms.apply_filter(name)
        np.testing.assert_array_equal(np.load(folder / f"{name}.npy"), ms.current_mesh().vertex_matrix())


# ---- selections, masks, attributes -----------------------------------------------------------------------------------


def with_gains(name):
    """Parameters that make the filter move something on any mesh."""
    if name == "apply_coord_multires_denoise":
        return {"method": "normal field"}  # by default it leaves meshes without noise as they are
    return {f"gain_{i}": 0 for i in range(1, 9)} if name == EQUALIZER else {}


@pytest.mark.parametrize("what", ["vertex", "face"])
@every_moving
def test_only_the_selection_moves_and_it_stays(name, what):
    ms = bunny()
    if what == "vertex":
        ms.compute_selection_by_condition_per_vertex(condselect="x > 0")
    else:
        ms.compute_selection_by_condition_per_face(condselect="y0 > 0.1")
    mesh = ms.current_mesh()
    selected = mesh.vertex_selection_array()
    selected[mesh.face_matrix()[mesh.face_selection_array()]] = True
    assert 0 < selected.sum() < len(selected)
    before = snapshot(ms)
    report = ms.apply_filter(name, selected=True, **with_gains(name))
    check_outcome(ms, name, before, report)  # selections unchanged, too
    old, new = before["meshes"][before["current"]]["vertices"], mesh.vertex_matrix()
    np.testing.assert_array_equal(new[~selected], old[~selected])
    assert (new[selected] != old[selected]).any(axis=1).mean() > 0.5


@every_moving
def test_an_existing_selection_is_honoured_by_default(name):
    ms = rich_sphere()
    mesh = ms.current_mesh()
    selected = mesh.vertex_selection_array()
    selected[mesh.face_matrix()[mesh.face_selection_array()]] = True
    before = mesh.vertex_matrix()
    ms.apply_filter(name, **with_gains(name))
    np.testing.assert_array_equal(mesh.vertex_matrix()[~selected], before[~selected])


@every_moving
def test_quality_is_a_soft_mask(name):
    free, masked = bunny(), bunny()
    before = free.current_mesh().vertex_matrix()
    free.apply_filter(name, **with_gains(name))
    masked.compute_scalar_by_function_per_vertex(q="x > 0 ? (y > 0.1 ? 7 : 0.25) : -1")
    quality = np.clip(masked.current_mesh().vertex_scalar_array(), 0, 1)
    assert set(quality) == {0, 0.25, 1}
    masked.apply_filter(name, quality_mask=True, **with_gains(name))
    full, soft = (ms.current_mesh().vertex_matrix() - before for ms in (free, masked))
    np.testing.assert_array_equal(soft[quality == 0], 0)
    np.testing.assert_allclose(soft, quality[:, None] * full, rtol=0, atol=1e-12 * np.abs(before).max())


@pytest.mark.parametrize("file", ["swirl_rgb.off", "kip_uv.obj", "colored_airplane.ply"])
@every_filter
def test_attributes_of_real_meshes_survive(name, file):
    path = SHARED / "attributes" / file
    if not path.exists() and not os.environ.get("CI"):
        pytest.skip(f"no {path}")
    ms = load(path)
    before = snapshot(ms)
    if not has_attributes_for(name, ms.current_mesh()):
        with pytest.raises(Error, match="the mesh has no"):
            ms.apply_filter(name)
        return
    check_outcome(ms, name, before, ms.apply_filter(name, **with_gains(name)))


@pytest.mark.parametrize("level", [0, 3])
def test_a_level_is_a_subset_of_the_mesh_with_its_attributes(level):
    ms = new_document()
    v, f = bunny().current_mesh().vertex_matrix(), bunny().current_mesh().face_matrix()
    colors = np.random.default_rng(1).integers(0, 256, (len(v), 4)) / 255
    ms.add_mesh(pymeshlab.Mesh(v, f, v_color_matrix=colors))
    old = ms.current_mesh()
    report = ms.apply_filter(LEVEL, level=level)
    new = ms.current_mesh()
    assert new.id() != old.id()
    assert (new.vertex_number(), new.face_number()) == (report["vertices"], report["faces"])
    source = new.vertex_custom_scalar_attribute_array("source_vertex").astype(int)
    assert len(np.unique(source)) == len(source)
    np.testing.assert_array_equal(new.vertex_matrix(), old.vertex_matrix()[source])
    np.testing.assert_array_equal(new.vertex_color_matrix(), old.vertex_color_matrix()[source])
    if level == 0:
        np.testing.assert_array_equal(source[new.face_matrix()], old.face_matrix())


def test_wedge_texture_coordinates_of_a_level_stay_near_the_surface():
    """On a plane with its position as texture coordinates: exact wherever a corner went, also along the seam."""
    ms = new_document()
    ms.create_grid(numvertx=20, numverty=20, absscalex=1, absscaley=1)
    mesh = ms.current_mesh()
    v, f = mesh.vertex_matrix(), mesh.face_matrix()
    uv = v[f.ravel(), :2] - v[:, :2].min(axis=0)
    chart = np.repeat(v[f, 0].mean(axis=1) > v[:, 0].mean(), 3)
    uv[chart, 1] += 10  # a seam across the middle
    ms.add_mesh(pymeshlab.Mesh(vertex_matrix=v, face_matrix=f, w_tex_coords_matrix=uv))
    ms.apply_filter(LEVEL, level=2)
    new = ms.current_mesh()
    assert new.vertex_number() < 0.6 * len(v)
    new_uv, faces = new.wedge_tex_coord_matrix().reshape(-1, 3, 2), new.face_matrix()
    flat = new.vertex_matrix()[faces][:, :, :2] - v[:, :2].min(axis=0)
    offset = new_uv - flat
    one_chart = np.ptp(offset[:, :, 1], axis=1) < 1  # a corner that has no wedge in the chart keeps its old one
    assert one_chart.all()
    exact = (np.abs(np.minimum(np.abs(offset), np.abs(offset - [0, 10]))) < 1e-6).all(axis=2)
    assert exact.mean() > 0.9


def cut_in_two(mesh):
    """The faces of a sphere in two charts, each with vertices of its own."""
    v, f = mesh.vertex_matrix(), mesh.face_matrix()
    other = v[f, 0].mean(axis=1) > 0
    twice = np.intersect1d(f[other], f[~other])
    copy = np.arange(len(v))
    copy[twice] = len(v) + np.arange(len(twice))
    return np.concatenate([v, v[twice]]), np.where(other[:, None], copy[f], f), other


def test_a_level_of_a_mesh_cut_along_a_seam_is_that_of_the_whole():
    ms = new_document()
    ms.create_sphere(subdiv=4)
    whole = ms.current_mesh()
    vertices, faces, other = cut_in_two(whole)
    uv = whole.vertex_matrix()[whole.face_matrix()][:, :, 1:] + 10 * other[:, None, None]
    wedges = {"w_tex_coords_matrix": uv.reshape(-1, 2)}
    levels = []
    for v, f in ((whole.vertex_matrix(), whole.face_matrix()), (vertices, faces)):
        ms.add_mesh(pymeshlab.Mesh(vertex_matrix=v, face_matrix=f, **wedges))
        ms.apply_filter(LEVEL)
        level = ms.current_mesh()
        corners = level.vertex_matrix()[level.face_matrix()]
        levels.append((level.vertex_number(), corners, level.wedge_tex_coord_matrix()))
    assert levels[0][0] < 0.5 * whole.vertex_number()
    for of_whole, of_cut in zip(*levels):
        np.testing.assert_array_equal(of_cut, of_whole)


def test_values_at_a_level_of_a_cut_mesh_stay_in_their_chart():
    ms = new_document()
    ms.create_sphere(subdiv=4)
    vertices, faces, other = cut_in_two(ms.current_mesh())
    chart = np.zeros(len(vertices))
    chart[faces[other]] = 1
    ms.add_mesh(pymeshlab.Mesh(vertex_matrix=vertices, face_matrix=faces, v_scalar_array=chart))
    report = ms.apply_filter(LEVEL)
    level = ms.current_mesh()
    assert report["vertices"] == level.vertex_number()
    assert (np.ptp(level.vertex_scalar_array()[level.face_matrix()], axis=1) == 0).all(), "no face has both"
    assert ms.apply_filter(PYRAMID)["boundary_edges"] == 0, "closed, though there are two charts"
    assert ms.get_topological_measures()["boundary_edges"] > 0


# ---- the kept pyramid ------------------------------------------------------------------------------------------------


def test_a_kept_pyramid_is_reused_by_both_plugins_while_nothing_changes():
    ms = bunny()
    assert ms.apply_filter(PYRAMID)["pyramid_reused"] is False
    for name in (PYRAMID, DETAIL, EQUALIZER):
        assert ms.apply_filter(name, **({} if name != EQUALIZER else with_gains(name)))["pyramid_reused"] is True
    assert ms.apply_filter(PYRAMID)["pyramid_reused"] is False, "the equalizer moved the vertices"


def test_a_filter_of_bands_keeps_the_pyramid_it_built():
    ms = bunny()
    assert ms.apply_filter(DETAIL)["pyramid_reused"] is False
    assert ms.apply_filter(LOW_PASS)["pyramid_reused"] is True


@pytest.mark.parametrize("change", ["move", "flip", "delete", "options"])
def test_a_kept_pyramid_is_not_used_after_a_change(change):
    ms = bunny()
    ms.apply_filter(PYRAMID)
    if change == "move":
        ms.compute_matrix_from_translation(axisx=1e-9, freeze=True)
    elif change == "flip":
        ms.meshing_invert_face_orientation(forceflip=True)
    elif change == "delete":
        ms.compute_selection_by_condition_per_face(condselect="fi == 100")
        ms.meshing_remove_selected_faces()
    options = {"base_vertices": 200} if change == "options" else {}
    kept = ms.apply_filter(DETAIL, **options)
    fresh = new_document()
    fresh.add_mesh(pymeshlab.Mesh(ms.current_mesh().vertex_matrix(), ms.current_mesh().face_matrix()))
    fresh.apply_filter(DETAIL, **options)
    assert kept["pyramid_reused"] is False
    np.testing.assert_array_equal(
        ms.current_mesh().vertex_scalar_array(), fresh.current_mesh().vertex_scalar_array()
    )


def test_a_reused_pyramid_gives_the_same_result():
    results = []
    for first in ([PYRAMID], []):
        ms = bunny()
        for name in first:
            ms.apply_filter(name)
        ms.apply_filter(LOW_PASS)
        results.append(ms.current_mesh().vertex_matrix())
    np.testing.assert_array_equal(*results)


# ---- relative to the original ----------------------------------------------------------------------------------------

GAINS_OF_ONE = {"relative_to": "original", **{f"gain_{i}": 1 for i in range(1, 9)}}
# What brings the original back with each filter; the others have no value that changes nothing.
NEUTRAL = {
    EQUALIZER: GAINS_OF_ONE,
    ENHANCE: {"relative_to": "original", "gain": 1},
    UNSHARP: {"relative_to": "original", "xi": 1},
    "apply_coord_multires_bands": {"relative_to": "original", "gain_2": 1},
    "apply_coord_multires_denoise": {"relative_to": "original", "strength": 0},
}


def change_in_many_ways(ms):
    for name in MOVING:
        ms.apply_filter(name, **with_gains(name) | ({"gain_8": 2} if name == EQUALIZER else {}))


@pytest.mark.parametrize("name", NEUTRAL)
def test_the_original_comes_back_bit_for_bit(name):
    ms = bunny()
    mesh = ms.current_mesh()
    before = mesh.vertex_matrix()
    change_in_many_ways(ms)
    assert not np.array_equal(mesh.vertex_matrix(), before)
    ms.apply_filter(name, **NEUTRAL[name])
    np.testing.assert_array_equal(mesh.vertex_matrix(), before)


@every_moving
def test_a_filter_relative_to_the_original_is_that_filter_on_it(name):
    changed, fresh = bunny(), bunny()
    change_in_many_ways(changed)
    # The default limits are those of the shape the dialog is opened for.
    limits = {LOW_PASS: {"cutoff": 0.02}, STOP_BAND: {"finest": 0.01, "coarsest": 0.04}}
    limits[ENHANCE] = limits[STOP_BAND]
    parameters = with_gains(name) | limits.get(name, {})
    changed.apply_filter(name, relative_to="original", **parameters)
    fresh.apply_filter(name, **parameters)
    np.testing.assert_array_equal(changed.current_mesh().vertex_matrix(), fresh.current_mesh().vertex_matrix())


def test_only_the_selection_goes_back_to_the_original():
    ms = bunny()
    mesh = ms.current_mesh()
    before = mesh.vertex_matrix()
    ms.apply_filter(LOW_PASS)
    smooth = mesh.vertex_matrix()
    ms.compute_selection_by_condition_per_vertex(condselect="x > 0")
    selected = mesh.vertex_selection_array()
    ms.apply_filter(EQUALIZER, **GAINS_OF_ONE)
    np.testing.assert_array_equal(mesh.vertex_matrix(), np.where(selected[:, None], before, smooth))
    np.testing.assert_array_equal(mesh.vertex_selection_array(), selected)


@pytest.mark.parametrize("change", ["smooth", "scale", "delete"])
def test_the_original_does_not_undo_what_others_did(change):
    ms = bunny()
    ms.apply_filter(LOW_PASS)
    if change == "smooth":
        ms.apply_coord_laplacian_smoothing()
    elif change == "scale":
        ms.compute_matrix_from_scaling_or_normalization(axisx=2, freeze=True)
    else:
        ms.compute_selection_by_condition_per_face(condselect="fi == 100")
        ms.meshing_remove_selected_faces()
    before = snapshot(ms)
    with pytest.raises(Error, match="relative_to: something else has changed this mesh"):
        ms.apply_filter(EQUALIZER, **GAINS_OF_ONE)
    assert not differences(before, snapshot(ms))
    # Filtered as it is, the changed mesh becomes the original.
    ms.apply_filter(LOW_PASS)
    ms.apply_filter(EQUALIZER, **GAINS_OF_ONE)
    assert not differences(before["meshes"][0]["vertices"], ms.current_mesh().vertex_matrix())


def test_files_and_copies_do_not_hold_the_original(tmp_path):
    ms = bunny()
    ms.apply_filter(LOW_PASS)
    smooth = ms.current_mesh().vertex_matrix()
    ms.save_current_mesh(str(tmp_path / "smooth.obj"))
    ms.generate_copy_of_current_mesh()
    ms.apply_filter(EQUALIZER, **GAINS_OF_ONE)
    np.testing.assert_array_equal(ms.current_mesh().vertex_matrix(), smooth)
    loaded = load(tmp_path / "smooth.obj")
    before = loaded.current_mesh().vertex_matrix()
    loaded.apply_filter(LOW_PASS)
    loaded.apply_filter(EQUALIZER, **GAINS_OF_ONE)
    np.testing.assert_array_equal(loaded.current_mesh().vertex_matrix(), before)


# ---- adaptive reconstruction -----------------------------------------------------------------------------------------


def test_adaptive_reconstruction_from_the_input_to_the_base():
    ms = bunny()
    truth = ms.current_mesh()
    fine = ms.apply_filter(ADAPTIVE, geometry_threshold=0)
    np.testing.assert_array_equal(ms.current_mesh().vertex_matrix(), truth.vertex_matrix())
    np.testing.assert_array_equal(ms.current_mesh().face_matrix(), truth.face_matrix())
    assert fine["rms_distance"] == 0
    ms.set_current_mesh(0)
    coarse = ms.apply_filter(ADAPTIVE, geometry_threshold=1e9)
    assert coarse["faces"] == coarse["base_faces"] == ms.current_mesh().face_number()
    ms.set_current_mesh(0)
    tenth = ms.apply_filter(ADAPTIVE, target="faces", faces=truth.face_number() // 10)
    assert truth.face_number() // 10 - 1 <= tenth["faces"] <= truth.face_number() // 10
    source = ms.current_mesh().vertex_custom_scalar_attribute_array("source_vertex").astype(int)
    np.testing.assert_array_equal(ms.current_mesh().vertex_matrix(), truth.vertex_matrix()[source])
    ms.set_current_mesh(0)
    fit = ms.apply_filter(ADAPTIVE, target="faces", faces=truth.face_number() // 10, fit=True)
    assert fit["rms_distance"] < 0.85 * tenth["rms_distance"]
    # MeshLab measures the same.
    way = ms.get_hausdorff_distance(sampledmesh=0, targetmesh=4, sampleface=True, samplenum=100000,
                                    maxdist=pymeshlab.PercentageValue(100))  # fmt: skip
    assert way["RMS"] == pytest.approx(fit["rms_distance"], rel=0.15)


@pytest.mark.parametrize(
    "parameters, message",
    [
        ({"geometry_threshold": -1.0}, "geometry_threshold"),
        ({"geometry_threshold": float("nan")}, "geometry_threshold"),
        ({"use_color": True}, "use_color"),
        ({"use_quality": True}, "use_quality"),
        ({"use_texcoord": True}, "use_texcoord"),
        ({"region_of_interest": True}, "region_of_interest"),
        ({"use_geometry": False}, "use_geometry"),
        ({"target": "RMS distance", "error": 0}, "error"),
    ],
)
def test_adaptive_reconstruction_names_what_is_wrong(parameters, message):
    ms = new_document()
    ms.create_sphere()
    before = snapshot(ms)
    with pytest.raises(Error, match=message):
        ms.apply_filter(ADAPTIVE, **parameters)
    assert differences(before, snapshot(ms)) == []


def test_adaptive_reconstruction_keeps_the_selection_in_full_and_selected():
    ms = bunny()
    ms.compute_selection_by_condition_per_face(condselect="x0 > 0")
    selected = ms.current_mesh().face_selection_array()
    truth = ms.current_mesh().face_matrix()[selected]
    ms.apply_filter(ADAPTIVE, region_of_interest=True, geometry_threshold=1e9)
    source = ms.current_mesh().vertex_custom_scalar_attribute_array("source_vertex").astype(int)
    kept = {tuple(f) for f in source[ms.current_mesh().face_matrix()]}
    assert {tuple(f) for f in truth} <= kept
    np.testing.assert_array_equal(ms.mesh(0).face_selection_array(), selected)
