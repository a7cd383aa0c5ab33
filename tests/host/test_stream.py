"""The progressive file .mrm: the plugin's format in pymeshlab, and the package's functions and Stream."""

import numpy as np
import pymeshlab
import pytest
from browser import Browser


def opened(path, **limits):
    ms = pymeshlab.MeshSet(verbose=False)
    ms.load_new_mesh(str(path), **limits)
    return ms


def vertices(path, **limits):
    ms = opened(path, **limits)
    return ms.current_mesh().vertex_number()


def distance(a, b):
    """Root mean square distance of the vertices of a from the surface b."""
    ms = pymeshlab.MeshSet(verbose=False)
    ms.add_mesh(pymeshlab.Mesh(b.vertices, b.faces))
    ms.add_mesh(pymeshlab.Mesh(a.vertices, a.faces))
    return ms.get_hausdorff_distance(sampledmesh=1, targetmesh=0, samplevert=True, sampleface=False)["RMS"]


@pytest.fixture
def scan(multires, meshes, tmp_path):
    ms = opened(meshes / "scan.ply")
    path = tmp_path / "scan.mrm"
    multires.save_stream(ms, path)
    return ms, path


def test_all_of_a_file_is_the_mesh_rounded(multires, scan):
    ms, path = scan
    document = opened(path)
    again, before = document.current_mesh(), ms.current_mesh()
    assert (again.vertex_number(), again.face_number()) == (before.vertex_number(), before.face_number())
    side = np.ptp(before.vertex_matrix(), axis=0).max()
    rounded = np.sort(again.vertex_matrix().sum(axis=1)), np.sort(before.vertex_matrix().sum(axis=1))
    np.testing.assert_allclose(*rounded, atol=2 * side / 4095)


@pytest.mark.parametrize("name", ["scan", "bowtie", "moebius_band", "degenerate_faces"])
def test_exact_files_keep_every_bit_and_the_order(multires, meshes, tmp_path, name):
    ms = opened(meshes / f"{name}.ply")
    mesh = ms.current_mesh()
    mesh.add_vertex_custom_scalar_attribute(mesh.vertex_matrix()[:, 0] / 3, "height")
    ms.compute_color_by_function_per_vertex(x="vi % 256", y="7", z="(3 * vi) % 256")
    multires.save_stream(ms, tmp_path / "exact.mrm", exact=True, keep_order=True)
    again = pymeshlab.MeshSet(verbose=False)
    multires.open_stream(again, tmp_path / "exact.mrm")
    other = again.current_mesh()
    np.testing.assert_array_equal(other.vertex_matrix(), mesh.vertex_matrix())
    np.testing.assert_array_equal(other.face_matrix(), mesh.face_matrix())
    np.testing.assert_array_equal(other.vertex_color_matrix(), mesh.vertex_color_matrix())
    np.testing.assert_array_equal(
        other.vertex_custom_scalar_attribute_array("height"), mesh.vertex_custom_scalar_attribute_array("height")
    )


def test_limits_of_opening(multires, scan):
    ms, path = scan
    few = vertices(path, max_vertices=200)
    assert 200 <= few <= 203
    part = vertices(path, max_bytes=path.stat().st_size // 2)
    assert few < part < ms.current_mesh().vertex_number()
    stream = multires.Stream(path.read_bytes()[: path.stat().st_size // 2])
    assert vertices(path, max_error=stream.error) <= part


def test_what_cannot_be_opened_says_why(multires, scan, tmp_path):
    ms, path = scan
    with pytest.raises(pymeshlab.PyMeshLabException, match="no mesh in so few bytes"):
        opened(path, max_bytes=30)
    other = tmp_path / "other.mrm"
    other.write_bytes(b"ply\nformat ascii 1.0\n")
    with pytest.raises(pymeshlab.PyMeshLabException, match=r"no \.mrm file"):
        multires.open_stream(ms, other)
    with pytest.raises(pymeshlab.PyMeshLabException, match="bits must be between 1 and 24"):
        multires.save_stream(ms, other, bits=25)
    with pytest.raises(pymeshlab.PyMeshLabException, match="cannot be written"):
        multires.save_stream(ms, tmp_path / "no folder" / "scan.mrm")
    before = path.read_bytes()
    with pytest.raises(pymeshlab.PyMeshLabException, match="bits must be"):
        multires.save_stream(ms, path, bits=0)
    assert path.read_bytes() == before
    with pytest.raises(ValueError, match="must end in .mrm"):
        multires.save_stream(ms, tmp_path / "scan.ply")


def test_a_stream_decodes_as_bytes_arrive_and_comes_nearer(multires, scan):
    ms, path = scan
    data = path.read_bytes()
    stream, whole = multires.Stream(), multires.Stream(path).mesh()
    with pytest.raises(multires.StreamError, match="no mesh yet"):
        stream.mesh()
    errors = []
    for i in range(0, len(data), 200):
        stream.feed(data[i : i + 200])
        if stream.started and i % 800 == 0:
            errors.append((distance(whole, stream.mesh()), stream.error))
            assert stream.vertices == len(stream.mesh().vertices) <= stream.total_vertices
    assert stream.finished and stream.missing == 0
    assert len(errors) > 3
    measured, said = np.array(errors[:-1]).T
    assert np.all(np.diff(measured) < 0)
    assert np.all(said > measured / 2) and np.all(said < 4 * measured)
    np.testing.assert_array_equal(stream.mesh().faces, whole.faces)


def test_a_region_comes_first(multires, scan):
    whole = multires.Stream(scan[1])
    vertices, faces = whole.mesh().vertices, whole.mesh().faces
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    corner = low + (high - low) / 2
    regions = {
        "box": (dict(box=(low, corner)), lambda v: (v <= corner).all(axis=1)),
        "sphere": (dict(sphere=(low, 0.5 * np.linalg.norm(high - low))),
                   lambda v: np.linalg.norm(v - low, axis=1) <= 0.5 * np.linalg.norm(high - low)),
    }  # fmt: skip
    for region, inside in regions.values():
        data = whole.region_first(**region)
        wanted = inside(vertices)[faces].all(axis=1).sum()
        assert 0.1 < wanted / len(faces) < 0.5
        part = multires.Stream(data[: len(data) * 3 // 4]).mesh()
        assert len(part.vertices) < 0.75 * len(vertices)
        assert inside(part.vertices)[part.faces].all(axis=1).sum() == wanted
        again = multires.Stream(data).mesh()
        np.testing.assert_array_equal(np.sort(again.vertices.sum(axis=1)), np.sort(vertices.sum(axis=1)))
        assert len(again.faces) == len(faces)
    with pytest.raises(ValueError, match="either a sphere or a box"):
        whole.region_first()
    with pytest.raises(ValueError, match="a sphere is a centre and a radius"):
        whole.region_first(sphere=(low, np.nan))
    with pytest.raises(multires.StreamError, match="only a whole stream"):
        multires.Stream(scan[1].read_bytes()[:2000]).region_first(sphere=(low, 1))


def test_attributes_and_wedges_of_a_stream(multires, meshes, tmp_path):
    ms = opened(meshes / "torus.ply")
    ms.compute_color_by_function_per_vertex(x="vi % 256", y="7", z="9")
    ms.compute_texcoord_parametrization_triangle_trivial_per_wedge(textdim=2048)
    multires.save_stream(ms, tmp_path / "torus.mrm", keep_order=True)
    mesh = multires.Stream(tmp_path / "torus.mrm").mesh()
    colors = 255 * ms.current_mesh().vertex_color_matrix()
    np.testing.assert_array_equal(mesh.attributes["color"], np.round(colors))
    np.testing.assert_array_equal(mesh.wedge_texcoords.reshape(-1, 2), ms.current_mesh().wedge_tex_coord_matrix())


def test_damage_is_found(multires, scan):
    data = bytearray(scan[1].read_bytes())
    data[len(data) // 2] ^= 4
    stream = multires.Stream()
    with pytest.raises(multires.StreamError, match="the stream is damaged: a checksum is wrong"):
        stream.feed(bytes(data))
    assert stream.started and not stream.finished
    assert len(stream.mesh().vertices) == stream.vertices


def test_a_page_refines_the_mesh_as_its_slider_moves(multires, scan, tmp_path):
    page = tmp_path / "scan.html"
    multires.stream_page(scan[1], page, steps=8)
    whole = multires.Stream(scan[1])
    with Browser() as browser:
        browser.open(page, 800, 600)
        last = browser.value("levels.length") - 1
        assert 4 <= last < 9
        seen = []
        for k in range(last + 1):
            browser.value(f"slider.value = {k}, slider.dispatchEvent(new Event('input'))")
            seen.append(int(browser.value("document.body.dataset.vertices")))
            # Something is drawn: not all pixels have the background's colour.
            drawn = browser.value(
                "(draw(), (p => (gl.readPixels(0, 0, 800, 400, gl.RGBA, gl.UNSIGNED_BYTE, p), p))"
                "(new Uint8Array(4 * 800 * 400))).reduce((n, x, i) => n + (i % 4 == 0 && x != 244), 0)"
            )
            assert drawn > 3000
        assert seen == sorted(seen) and seen[-1] == whole.total_vertices
        assert browser.value("gl.getError()") == 0
