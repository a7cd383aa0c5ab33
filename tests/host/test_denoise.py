"""Denoising, end to end in pymeshlab with its defaults. That it starts, refuses and keeps what it should in every host
is tested with all other filters (test_filters.py, test_pymeshlab.py, test_meshlab_2020.py)."""

import numpy as np
import pymeshlab
import pytest
from test_pymeshlab import Error, differences, new_document, rich_sphere, snapshot

DENOISE = "apply_coord_multires_denoise"
REPORT = {"noise", "noise_in_edges", "noise_in_all_directions", "noise_along_axis", "rounding_step", "spikes_removed",
          "estimated_rms_before", "estimated_rms_after", "share_low_pass", "share_wiener", "share_normal_field", "share_guided_normals", "largest_displacement", "rms_displacement", "volume_before", "volume_after", "area_before",
          "area_after", "centroid_shift", "flipped_faces"}  # fmt: skip


def face_normals(v, f):
    n = np.cross(v[f[:, 1]] - v[f[:, 0]], v[f[:, 2]] - v[f[:, 0]])
    return n / np.linalg.norm(n, axis=1, keepdims=True)


def mean_angle(v, truth, f):
    cosine = np.einsum("ij,ij->i", face_normals(v, f), face_normals(truth, f))
    return np.degrees(np.arccos(np.clip(cosine, -1, 1))).mean()


def noisy_sphere(impulsive=False):
    """(document, truth): noise of 0.2 mean edges along the normals of a unit sphere."""
    ms = new_document()
    ms.create_sphere(radius=1, subdiv=5)
    truth, f = ms.current_mesh().vertex_matrix(), ms.current_mesh().face_matrix()
    random = np.random.default_rng(3)
    edge = np.linalg.norm(truth[f[:, 0]] - truth[f[:, 1]], axis=1).mean()
    amount = 0.2 * edge * random.normal(size=len(truth))
    if impulsive:
        amount = np.where(random.random(len(truth)) < 1 / 7, 2 * amount, 0)
    ms.add_mesh(pymeshlab.Mesh(truth * (1 + amount[:, None]), f))
    return ms, truth


@pytest.mark.parametrize("impulsive", [False, True])
def test_noise_goes_without_a_parameter(impulsive):
    ms, truth = noisy_sphere(impulsive)
    mesh = ms.current_mesh()
    before, f = mesh.vertex_matrix(), mesh.face_matrix()
    report = ms.apply_filter(DENOISE)
    after = mesh.vertex_matrix()
    assert mean_angle(after, truth, f) < (0.35 if impulsive else 0.12) * mean_angle(before, truth, f)
    off = [np.sqrt(((np.linalg.norm(v, axis=1) - 1) ** 2).mean()) for v in (before, after)]
    assert off[1] < 0.4 * off[0]
    assert report["volume_after"] == pytest.approx(report["volume_before"], rel=0.005)
    assert (report["spikes_removed"] > 0) == impulsive


def test_report_says_what_was_found_and_done():
    ms, truth = noisy_sphere()
    mesh = ms.current_mesh()
    f = mesh.face_matrix()
    report = ms.apply_filter(DENOISE)
    assert set(report) >= REPORT
    edge = np.linalg.norm(truth[f[:, 0]] - truth[f[:, 1]], axis=1).mean()
    assert report["noise"] == pytest.approx(0.2 * edge, rel=0.25)
    assert not report["noise_in_all_directions"]
    after = np.sqrt(((np.linalg.norm(mesh.vertex_matrix(), axis=1) - 1) ** 2).mean())
    assert report["estimated_rms_after"] == pytest.approx(after, abs=0.1 * report["estimated_rms_before"])


def test_the_normal_field_reports_its_levels():
    ms, _ = noisy_sphere()
    report = ms.apply_filter(DENOISE, method="normal field")
    assert report["normal_noise_after"] < 0.2 * report["normal_noise"]
    assert len(report["detail_per_level"]) == len(report["noise_per_level"]) == len(report["share_removed"]) == 4
    assert report["flipped_faces"] == 0


def test_a_second_run_does_little():
    ms, _ = noisy_sphere()
    first = ms.apply_filter(DENOISE)["rms_displacement"]
    assert ms.apply_filter(DENOISE)["rms_displacement"] < 0.1 * first


def test_a_mesh_without_noise_stays():
    ms = new_document()
    ms.create_cube()
    for _ in range(4):
        ms.meshing_surface_subdivision_midpoint(iterations=1, threshold=pymeshlab.PercentageValue(0))
    before = snapshot(ms)
    assert ms.apply_filter(DENOISE)["largest_displacement"] == 0
    np.testing.assert_array_equal(ms.current_mesh().vertex_matrix(), before["meshes"][0]["vertices"])


@pytest.mark.parametrize("method", ["soft threshold", "hard threshold"])
def test_named_methods_say_what_they_dropped(method):
    ms, truth = noisy_sphere()
    mesh = ms.current_mesh()
    before, f = mesh.vertex_matrix(), mesh.face_matrix()
    report = ms.apply_filter(DENOISE, method=method)
    assert len(report["noise_per_level"]) == len(report["threshold_per_level"]) == len(report["share_zeroed"]) == 5
    assert report["share_zeroed"][0] > 0.5
    assert mean_angle(mesh.vertex_matrix(), truth, f) < 0.5 * mean_angle(before, truth, f)


@pytest.mark.parametrize(
    "parameters, message",
    [
        ({"threshold": -1.0}, "threshold"),
        ({"threshold": float("nan")}, "threshold"),
        ({"finest_level": 4, "coarsest_level": 3}, "coarsest_level"),
        ({"cycle_spins": 65}, "cycle_spins"),
    ],
)
def test_what_makes_no_sense_is_refused_and_nothing_changes(parameters, message):
    ms = rich_sphere()
    before = snapshot(ms)
    with pytest.raises(Error, match=message):
        ms.apply_filter(DENOISE, **parameters)
    assert differences(before, snapshot(ms)) == []


def test_a_selection_of_nothing_is_refused():
    ms, _ = noisy_sphere()
    before = snapshot(ms)
    with pytest.raises(Error, match="selected"):
        ms.apply_filter(DENOISE, selected=True)
    assert differences(before, snapshot(ms)) == []
