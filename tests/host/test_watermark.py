"""Watermarks through the host: written, read from another layer, refused without a change."""

import numpy as np
import pymeshlab
import pytest
from test_pymeshlab import Error, differences, new_document, snapshot

MARK, READ = "apply_coord_multires_watermark", "compute_multires_watermark"
MESSAGE, KEY = "0123456789abcdef", "a key"


@pytest.fixture(scope="module")
def bumpy():
    """Vertices and faces of a sphere with bumps, without symmetry."""
    ms = new_document()
    ms.create_sphere(subdiv=4)
    v, f = ms.current_mesh().vertex_matrix(), ms.current_mesh().face_matrix()
    bump = 0.1 * np.sin(3 * v[:, :1] + 1) * np.cos(2 * v[:, 1:2]) + 0.05 * np.sin(5 * v[:, 2:] + v[:, :1])
    return v * (1 + bump), f


def marked(v, f):
    """A document with the original, and the marked mesh as current layer; its report."""
    ms = new_document()
    ms.add_mesh(pymeshlab.Mesh(v, f))
    ms.add_mesh(pymeshlab.Mesh(v, f))
    return ms, ms.apply_filter(MARK, message=MESSAGE, key=KEY)


def text(bits):
    return f"{int(''.join(str(int(b)) for b in bits), 2):016x}"


def test_a_message_is_read_back_from_the_other_layer_after_a_turn_and_rounding(bumpy):
    ms, report = marked(*bumpy)
    assert report["rms_displacement"] <= 0.0008 * np.linalg.norm(np.ptp(bumpy[0], axis=0)) * (1 + 1e-9)
    ms.compute_matrix_from_rotation(rotaxis="Y axis", angle=75, freeze=False)
    before = snapshot(ms)
    read = ms.apply_filter(READ, key=KEY, expected=MESSAGE.upper())
    assert (text(read["bits"]), read["bit_errors"], read["sure_bits"]) == (MESSAGE, 0, 64)
    assert differences(before, snapshot(ms)) == []

    v = np.round(ms.current_mesh().transformed_vertex_matrix() * 3, 2)
    ms.add_mesh(pymeshlab.Mesh(v, bumpy[1]))
    assert text(ms.apply_filter(READ, original=0, key=KEY)["bits"]) == MESSAGE


def test_without_the_key_there_is_nothing_to_see(bumpy):
    ms, _ = marked(*bumpy)
    read = ms.apply_filter(READ, key="another key")
    assert read["sure_bits"] == 0 and read["probability_unmarked"] > 1e-3
    assert "bit_errors" not in read


@pytest.mark.parametrize(
    "filter_name, given, message",
    [
        (MARK, {"message": "no number"}, "message must be 64 bits as 16 hexadecimal digits"),
        (MARK, {"strength": 3}, "strength"),
        (READ, {"expected": "1"}, "expected must be 64 bits"),
        (READ, {"original": 1}, "original: it is the current layer itself"),
    ],
)
def test_what_cannot_be_is_refused_by_name_and_changes_nothing(bumpy, filter_name, given, message):
    ms, _ = marked(*bumpy)
    before = snapshot(ms)
    with pytest.raises(Error, match=message):
        ms.apply_filter(filter_name, **given)
    assert differences(before, snapshot(ms)) == []
