"""The plugins in pymeshlab: the adapter by means of the probe plugins, then every filter of every table."""

import subprocess
import sys
import textwrap

import numpy as np
import pymeshlab
import pytest
from conftest import FILTER_IDS, FILTERS, PLUGINS, PROBES, wants_grid

PROBE_FILES = [PROBES / "libfilter_multires_probe.so", PROBES / "libfilter_multires_twin.so"]
for plugin in PROBE_FILES + PLUGINS:
    pymeshlab.load_plugin(str(plugin))
Error = pymeshlab.PyMeshLabException

# What the probes can be asked to fail with, and what the user is told then.
FAILURES = {
    "input": "the probe refuses this mesh",
    "internal": "Internal error, nothing was changed: a bug in the probe",
    "memory": "Not enough memory",
    "unknown": "Internal error, nothing was changed",
    "cancel": "Cancelled",
    "wrong size": "wrong size",
}


_documents = []


def new_document():
    """An empty document that lives as long as the tests: after a filter failed, pymeshlab goes on logging to the
    document it failed on, also when that is gone."""
    _documents.append(pymeshlab.MeshSet(verbose=False))
    return _documents[-1]


def rich_sphere():
    """A document with a sphere that has every kind of data: two layers, the second of them current."""
    ms = new_document()
    ms.create_cube()
    ms.create_sphere(subdiv=2)
    v, f = ms.current_mesh().vertex_matrix(), ms.current_mesh().face_matrix()
    ms.delete_current_mesh()
    return add_rich(ms, v, f)


def rich_grid():
    """The same with a triangular grid, and a copy of it in the first layer."""
    ms = new_document()
    i, j = np.mgrid[-8:9, -9:10]
    v = np.column_stack([i.ravel(), j.ravel(), np.sin(0.9 * i.ravel()) + np.cos(0.7 * i.ravel() + j.ravel())]) / 9
    corner = (np.arange(16)[:, None] * 19 + np.arange(18)).ravel()
    f = np.vstack([corner[:, None] + [0, 19, 20], corner[:, None] + [0, 20, 1]])
    ms.add_mesh(pymeshlab.Mesh(v + [0, 0, 0.1], f))
    return add_rich(ms, v, f)


def rich(row):
    """One that the filter takes."""
    return rich_grid() if wants_grid(row["python_name"]) else rich_sphere()


def add_rich(ms, v, f):
    n, m = len(v), len(f)
    ms.add_mesh(
        pymeshlab.Mesh(
            vertex_matrix=v,
            face_matrix=f,
            v_scalar_array=np.linspace(0, 1, n),
            f_scalar_array=np.linspace(0, 1, m),
            v_color_matrix=np.tile(np.linspace(0, 1, n)[:, None], (1, 4)),
            f_color_matrix=np.tile(np.linspace(0, 1, m)[:, None], (1, 4)),
            v_tex_coords_matrix=v[:, :2],
            w_tex_coords_matrix=v[f.ravel(), :2],
        ),
        "sphere",
    )
    mesh = ms.current_mesh()
    mesh.add_vertex_custom_scalar_attribute(np.arange(n, dtype=float), "number")
    mesh.add_vertex_custom_point_attribute(2 * v, "doubled")
    mesh.add_face_custom_scalar_attribute(np.arange(m, dtype=float), "face_number")
    ms.compute_selection_by_condition_per_vertex(condselect="x > 0")
    ms.compute_selection_by_condition_per_face(condselect="y0 > 0")
    return ms


def snapshot(ms):
    """Everything a filter could change, by layer."""
    meshes = {}
    for mesh in (ms.mesh(i) for i in range(1000) if ms.mesh_id_exists(i)):
        data = {
            "label": mesh.label(),
            "vertices": mesh.vertex_matrix(),
            "faces": mesh.face_matrix(),
            "normals": mesh.vertex_normal_matrix(),
            "face normals": mesh.face_normal_matrix(),
            "selected vertices": mesh.vertex_selection_array(),
            "selected faces": mesh.face_selection_array(),
            "transform": mesh.transform_matrix(),
            "box": [mesh.bounding_box().min(), mesh.bounding_box().max()],
            "has": [mesh.has_vertex_color(), mesh.has_vertex_scalar(), mesh.has_vertex_tex_coord()],
        }
        for has, get in (
            (mesh.has_vertex_color, mesh.vertex_color_matrix),
            (mesh.has_vertex_scalar, mesh.vertex_scalar_array),
            (mesh.has_vertex_tex_coord, mesh.vertex_tex_coord_matrix),
            (mesh.has_wedge_tex_coord, mesh.wedge_tex_coord_matrix),
        ):
            if has():
                data[get.__name__] = get()
        for name in ("number", "source_vertex"):
            try:
                data[name] = mesh.vertex_custom_scalar_attribute_array(name)
            except Error:
                pass
        meshes[mesh.id()] = data
    return {"current": ms.current_mesh_id(), "meshes": meshes}


def differences(before, after, path=""):
    """Paths of what differs between two snapshots."""
    if isinstance(before, dict):
        if before.keys() != after.keys():
            return [f"{path}: {sorted(map(str, before.keys() ^ after.keys()))}"]
        return [d for key in before for d in differences(before[key], after[key], f"{path}/{key}")]
    same = np.array_equal(before, after, equal_nan=np.asarray(before).dtype.kind == "f")
    return [] if same else [path]


def assert_unchanged(ms, before):
    assert differences(before, snapshot(ms)) == []


# ---- parameters ------------------------------------------------------------------------------------------------------


def test_parameters_have_the_defaults_derived_from_the_mesh():
    ms = new_document()
    ms.create_cube(size=2)
    out = ms.apply_filter("compute_parameters_probe")
    assert (out["flag"], out["count"], out["amount"], out["color"]) == (True, 3, 0.5, 1)
    assert out["length"] == pytest.approx(0.1 * np.sqrt(12), rel=1e-12)


def test_parameters_come_through():
    ms = rich_sphere()
    out = ms.apply_filter("compute_parameters_probe", flag=False, count=10, length=0, amount=0.25, color="blue")
    assert (out["flag"], out["count"], out["length"], out["amount"], out["color"]) == (False, 10, 0, 0.25, 2)


def test_filters_are_listed():
    listed = pymeshlab.filter_list()
    for name in ["compute_parameters_probe", "compute_parameters_twin", *FILTER_IDS]:
        assert name in listed


@pytest.mark.parametrize("name, value", [("count", 0), ("count", 11), ("length", -1), ("length", np.nan), ("length", np.inf)])
def test_values_out_of_range_are_refused_by_name(name, value):
    ms = rich_sphere()
    before = snapshot(ms)
    with pytest.raises(Error, match=f'Parameter "{name}"'):
        ms.apply_filter("compute_parameters_probe", **{name: value})
    assert_unchanged(ms, before)


def test_an_unknown_choice_is_refused():
    ms = rich_sphere()
    for value in ("mauve", -1, 3):
        with pytest.raises(pymeshlab.InvalidEnumException, match=f"Enum '?{value}'? not "):
            ms.apply_filter("compute_parameters_probe", color=value)


# ---- results ---------------------------------------------------------------------------------------------------------


def test_reports_keep_their_types():
    out = rich_sphere().apply_filter("compute_parameters_probe")
    assert type(out["flag"]) is bool and type(out["count"]) is int and type(out["length"]) is float
    assert isinstance(out["list"], np.ndarray) and out["list"].tolist() == [1, 2.5, 4]


def test_a_filter_without_numbers_still_returns_a_dictionary():
    assert rich_sphere().apply_filter("apply_coord_change_probe")


def test_all_parts_of_a_result_are_written():
    ms = rich_sphere()
    before = snapshot(ms)
    ms.apply_filter("apply_coord_change_probe", shift=3)
    after = snapshot(ms)
    here = before["current"]
    old, new = before["meshes"][here], after["meshes"][here]
    np.testing.assert_array_equal(new["vertices"], old["vertices"] + [0, 0, 3])
    np.testing.assert_array_equal(new["vertex_scalar_array"], np.arange(len(old["vertices"])))
    np.testing.assert_allclose(new["vertex_color_matrix"], 1 - old["vertex_color_matrix"], atol=1e-6)
    changed = {"vertices", "vertex_scalar_array", "vertex_color_matrix", "box", "normals", "face normals"}
    for path in differences(before, after):
        assert path.split("/")[2] == str(here) and path.split("/")[3] in changed


def test_selections_stay():
    ms = rich_sphere()
    chosen = ms.current_mesh().vertex_selection_array(), ms.current_mesh().face_selection_array()
    assert 0 < chosen[0].sum() < len(chosen[0]) and 0 < chosen[1].sum() < len(chosen[1])
    ms.apply_filter("apply_coord_change_probe")
    np.testing.assert_array_equal(ms.current_mesh().vertex_selection_array(), chosen[0])
    np.testing.assert_array_equal(ms.current_mesh().face_selection_array(), chosen[1])


def test_normals_and_box_are_updated():
    ms = rich_sphere()
    ms.apply_filter("apply_coord_change_probe", shift=5)
    mesh = ms.current_mesh()
    np.testing.assert_allclose(mesh.bounding_box().max(), mesh.vertex_matrix().max(axis=0))
    outward = mesh.vertex_matrix() - [0, 0, 5]
    assert (np.einsum("ij,ij->i", outward, mesh.vertex_normal_matrix()) > 0.9).all()


def test_a_new_layer_has_all_attributes():
    ms = rich_sphere()
    old, before = ms.current_mesh(), snapshot(ms)
    ms.apply_filter("generate_layer_probe")
    assert ms.mesh_number() == 3
    new = ms.current_mesh()
    assert new.label() == "every second face" and new.id() != old.id()
    source = new.vertex_custom_scalar_attribute_array("source_vertex").astype(int)
    faces = np.arange(0, old.face_number(), 2)
    for get in ("vertex_matrix", "vertex_color_matrix", "vertex_scalar_array", "vertex_tex_coord_matrix"):
        np.testing.assert_array_equal(getattr(new, get)(), getattr(old, get)()[source], err_msg=get)
    for get in ("face_color_matrix", "face_scalar_array"):
        np.testing.assert_array_equal(getattr(new, get)(), getattr(old, get)()[faces], err_msg=get)
    np.testing.assert_array_equal(source[new.face_matrix()], old.face_matrix()[faces])
    np.testing.assert_array_equal(
        new.wedge_tex_coord_matrix().reshape(-1, 3, 2), old.wedge_tex_coord_matrix().reshape(-1, 3, 2)[faces]
    )
    np.testing.assert_array_equal(new.vertex_custom_scalar_attribute_array("number"), source)
    np.testing.assert_array_equal(new.vertex_custom_point_attribute_matrix("doubled"), 2 * new.vertex_matrix())
    np.testing.assert_array_equal(new.face_custom_scalar_attribute_array("face_number"), faces)
    np.testing.assert_allclose(new.bounding_box().max(), new.vertex_matrix().max(axis=0))
    after = snapshot(ms)
    del after["meshes"][new.id()]
    after["current"] = before["current"]
    assert differences(before, after) == []


def test_a_new_layer_has_the_textures_and_the_transformation(tmp_path, meshes):
    (tmp_path / "checker.ppm").write_bytes(b"P6 2 2 255\n" + bytes([255, 0, 0, 0, 255, 0, 0, 0, 255, 9, 9, 9]))
    (tmp_path / "m.mtl").write_text("newmtl a\nmap_Kd checker.ppm\n")
    (tmp_path / "m.obj").write_text(
        "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl a\n"
        "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n"
    )
    ms = new_document()
    ms.load_new_mesh(str(tmp_path / "m.obj"))
    ms.compute_matrix_from_translation(axisx=3, freeze=False)
    old = ms.current_mesh()
    assert old.texture_number() == 1
    ms.apply_filter("generate_layer_probe")
    new = ms.current_mesh()
    np.testing.assert_array_equal(new.transform_matrix(), old.transform_matrix())
    assert new.texture_number() == 1
    assert list(new.textures()) == list(old.textures())


# ---- failures --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("failure", [*FAILURES, "not finite"])
def test_a_failing_change_leaves_the_document_alone(failure):
    ms = rich_sphere()
    before = snapshot(ms)
    with pytest.raises(Error, match=FAILURES.get(failure, "not finite")):
        ms.apply_filter("apply_coord_change_probe", fail=failure)
    assert_unchanged(ms, before)


@pytest.mark.parametrize("failure", [*FAILURES, "wrong source"])
def test_a_failing_layer_leaves_the_document_alone(failure):
    ms = rich_sphere()
    before = snapshot(ms)
    with pytest.raises(Error, match=FAILURES.get(failure, "out of range")):
        ms.apply_filter("generate_layer_probe", fail=failure)
    assert_unchanged(ms, before)


def test_no_data_appears_when_a_filter_fails():
    ms = new_document()
    ms.create_cube()
    before = snapshot(ms)
    with pytest.raises(Error, match="coordinates that are not finite"):
        ms.apply_filter("apply_coord_change_probe", fail="not finite")
    assert_unchanged(ms, before)


def test_no_mesh_empty_mesh_and_no_faces_are_refused():
    ms = new_document()
    with pytest.raises(Error, match="mesh"):
        ms.apply_filter("compute_parameters_probe")
    ms.create_cube()
    ms.compute_selection_by_condition_per_vertex(condselect="1")
    ms.meshing_remove_selected_vertices()
    assert ms.current_mesh().vertex_number() == 0
    with pytest.raises(Error, match="empty|[Ff]aces"):
        ms.apply_filter("apply_coord_change_probe")
    with pytest.raises(Error, match="empty"):
        ms.apply_filter("compute_parameters_probe")
    ms.add_mesh(pymeshlab.Mesh(vertex_matrix=np.eye(3)))
    with pytest.raises(Error, match="[Ff]aces"):
        ms.apply_filter("apply_coord_change_probe")
    assert ms.apply_filter("compute_parameters_probe")["vertices"] == 3


# ---- what is kept with the mesh --------------------------------------------------------------------------------------


def test_what_one_plugin_keeps_another_finds():
    ms = rich_sphere()
    assert ms.apply_filter("compute_kept_twin") == {"found": False}
    ms.apply_filter("compute_keep_probe", value=4.25)
    assert ms.apply_filter("compute_kept_twin") == {"found": True, "value": 4.25}
    ms.apply_filter("compute_keep_twin", value=-1)
    assert ms.apply_filter("compute_kept_probe") == {"found": True, "value": -1}


def test_what_is_kept_belongs_to_its_mesh():
    ms = rich_sphere()
    ms.apply_filter("compute_keep_probe", value=1)
    ms.apply_filter("generate_layer_probe")
    assert ms.apply_filter("compute_kept_probe")["found"] is False
    ms.set_current_mesh(0)
    assert ms.apply_filter("compute_kept_probe")["found"] is False


def test_nothing_is_kept_when_the_filter_fails():
    ms = rich_sphere()
    ms.apply_filter("compute_keep_probe", value=1)
    with pytest.raises(Error, match='"value" .* must be a finite number'):
        ms.apply_filter("compute_keep_twin", value=np.nan)
    assert ms.apply_filter("compute_kept_probe")["value"] == 1


def test_keeping_survives_saving_deleting_and_the_end_of_the_program(tmp_path):
    """In a process of its own, because a fault may show only at its very end."""
    script = f"""
        import pymeshlab
        for plugin in {[str(p) for p in PROBE_FILES]}:
            pymeshlab.load_plugin(plugin)
        ms = pymeshlab.MeshSet()
        for value in range(3):
            ms.create_sphere()
            ms.apply_filter("compute_keep_probe", value=value)
        for name in ("a.ply", "a.obj", "a.off"):
            ms.save_current_mesh({str(tmp_path)!r} + "/" + name)
        ms.save_project({str(tmp_path)!r} + "/a.mlp")
        ms.delete_current_mesh()
        ms.load_new_mesh({str(tmp_path)!r} + "/a.ply")
        assert not ms.apply_filter("compute_kept_twin")["found"]
        ms.apply_filter("compute_keep_twin", value=7)
        assert ms.apply_filter("compute_kept_probe")["value"] == 7
        print("done")
    """
    run = subprocess.run([sys.executable, "-c", textwrap.dedent(script)], capture_output=True, text=True)
    assert (run.returncode, run.stdout.strip()[-4:]) == (0, "done"), run.stdout + run.stderr


# ---- every filter of every table -------------------------------------------------------------------------------------

every_filter = pytest.mark.parametrize("row", FILTERS, ids=FILTER_IDS)


def finite(value):
    return np.isfinite(np.asarray(value, dtype=float)).all()


def test_there_are_filters():
    assert FILTERS and PLUGINS


@every_filter
def test_filter_works_without_parameters(row):
    ms = rich(row)
    before = snapshot(ms)
    out = ms.apply_filter(row["python_name"])
    assert out and all(finite(value) for value in out.values())
    after = snapshot(ms)["meshes"][before["current"]]
    old = before["meshes"][before["current"]]
    assert finite(after["vertices"]) and after["vertices"].shape == old["vertices"].shape
    custom = [] if row["changes"] & 128 else ["number"]
    for same in ("faces", "selected vertices", "selected faces", *custom):
        np.testing.assert_array_equal(after[same], old[same])


@every_filter
def test_filter_gives_the_same_twice(row):
    results = []
    for _ in range(2):
        ms = rich(row)
        ms.apply_filter(row["python_name"])
        results.append(snapshot(ms))
    assert differences(*results) == []


@every_filter
def test_filter_refuses_values_out_of_range(row):
    ms = rich(row)
    before = snapshot(ms)
    for parameter in row["parameters"]:
        outside = [np.nan] if parameter["type"] == "real" else []
        if parameter["type"] in ("real", "integer"):
            outside += [parameter["least"] - 1] if "least" in parameter else []
            outside += [parameter["most"] + 1] if "most" in parameter and parameter["most"] < 2**31 - 1 else []
        for value in outside:
            value = int(value) if parameter["type"] == "integer" else value
            with pytest.raises(Error, match=f'Parameter "{parameter["name"]}"'):
                ms.apply_filter(row["python_name"], **{parameter["name"]: value})
    assert_unchanged(ms, before)


@every_filter
def test_filter_handles_every_class_of_mesh(row, meshes):
    for path in sorted(meshes.glob("*.ply")):
        ms = new_document()
        ms.load_new_mesh(str(path))
        before = snapshot(ms)
        try:
            out = ms.apply_filter(row["python_name"])
        except Error as error:
            assert "Internal error" not in str(error), path.name
            assert_unchanged(ms, before)
            continue
        assert all(finite(value) for value in out.values()), path.name
        after, old = snapshot(ms)["meshes"][0], before["meshes"][0]
        assert finite(after["vertices"]) and after["vertices"].shape == old["vertices"].shape, path.name
        np.testing.assert_array_equal(after["faces"], old["faces"], err_msg=path.name)


@every_filter
@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_filter_refuses_coordinates_that_are_not_finite(row, bad):
    ms = rich(row)
    mesh = ms.current_mesh()
    vertices = mesh.vertex_matrix()
    vertices[7, 1] = bad
    ms.add_mesh(pymeshlab.Mesh(vertex_matrix=vertices, face_matrix=mesh.face_matrix()))
    assert not finite(ms.current_mesh().vertex_matrix()), "pymeshlab mended it"
    before = snapshot(ms)
    with pytest.raises(Error, match="finite|NaN|infinite"):
        ms.apply_filter(row["python_name"])
    assert_unchanged(ms, before)


@every_filter
def test_filter_refuses_a_document_without_faces(row):
    ms = new_document()
    with pytest.raises(Error, match="requires at least one mesh"):
        ms.apply_filter(row["python_name"])
    ms.add_mesh(pymeshlab.Mesh(vertex_matrix=np.eye(3)))
    before = snapshot(ms)
    with pytest.raises(Error, match="Any Faces"):
        ms.apply_filter(row["python_name"])
    assert_unchanged(ms, before)
