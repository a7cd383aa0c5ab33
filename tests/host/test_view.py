"""multires.view: its sliders, pictures and widget, without a notebook, a browser or a display."""

import inspect
import subprocess
import sys
import textwrap

import numpy as np
import pymeshlab
import pytest

SMALL = (120, 90)


@pytest.fixture
def ms(meshes):
    ms = pymeshlab.MeshSet(verbose=False)
    ms.load_new_mesh(str(meshes / "terrain.ply"))
    return ms


def positions(ms):
    return ms.current_mesh().vertex_matrix()


def shown(viewer):
    return np.asarray(viewer._surface.points)


def test_sliders_show_what_the_function_does_and_leave_the_document_alone(multires, ms):
    before = positions(ms)
    viewer = multires.view(ms, size=SMALL)
    assert list(viewer.sliders) == [*(f"gain_{i}" for i in range(1, 9)), "softness"]
    flat = viewer.screenshot()
    assert flat.shape == (90, 120, 3) and np.ptp(flat) > 50
    viewer.set(gain_1=3.0)
    report = viewer.set(gain_1=0.0, gain_4=4.0)
    assert report.pyramid_reused and (viewer.screenshot() != flat).any()
    np.testing.assert_array_equal(positions(ms), before)
    wanted = multires.equalizer(ms, gain_1=0.0, gain_4=4.0)
    np.testing.assert_array_equal(shown(viewer), positions(ms))
    assert report.result_hash == wanted.result_hash
    viewer.set(gain_1=1.0, gain_4=1.0)
    np.testing.assert_allclose(shown(viewer), before, atol=1e-6)


def test_apply_does_what_is_shown_and_goes_on_from_there(multires, ms):
    viewer = multires.view(ms, multires.enhance, sliders={"gain": (0, 4)}, size=SMALL)  # the band is that of the mesh
    viewer.set(gain=3.9)
    viewer.set(gain=3.5)
    wanted = shown(viewer).copy()
    viewer.apply()
    np.testing.assert_allclose(positions(ms), wanted, atol=1e-7)  # pymeshlab tells limits in single precision
    assert viewer.values == {"gain": inspect.signature(multires.enhance).parameters["gain"].default}
    viewer.set(gain=1.0)
    np.testing.assert_allclose(shown(viewer), wanted, atol=1e-6)


def test_the_call_can_be_copied(multires, ms):
    viewer = multires.view(ms, multires.low_pass, size=SMALL, method="spline", pyramid=multires.Pyramid(scheme="Lazy"))
    waves = multires.build_pyramid(ms, pyramid=multires.Pyramid(scheme="Lazy")).wavelength
    slider = viewer.sliders["cutoff"]
    assert (slider.least, slider.most) == (waves[0], waves[-1])
    viewer.set(cutoff=0.25)
    assert "cutoff=0.25, method='spline'" in viewer.call
    exec(viewer.call.replace("Pyramid(", "multires.Pyramid("), {"multires": multires, "ms": ms})
    np.testing.assert_array_equal(positions(ms), shown(viewer))


def test_the_widget_moves_with_the_sliders(multires, ms):
    viewer = multires.view(ms, size=SMALL)
    assert "application/vnd.jupyter.widget-view+json" in viewer._repr_mimebundle_()
    picture = viewer._image.value
    viewer._controls["gain_4"].value = 4.0
    assert viewer.values["gain_4"] == 4.0 and "gain_4=4.0" in viewer._told.value
    moved = viewer._image.value
    assert moved[:2] == b"\xff\xd8" and moved != picture
    viewer.color(displacement=True)
    assert viewer._image.value != moved
    viewer.set(gain_4=2.0)
    assert viewer._controls["gain_4"].value == 2.0


def test_values_that_will_not_do_are_told_and_what_was_shown_stays(multires, ms):
    viewer = multires.view(ms, multires.enhance, sliders={"gain": (0, 99)}, size=SMALL)
    before = shown(viewer).copy()
    assert viewer.widget is viewer.widget
    viewer._controls["gain"].value = 98.0
    assert "gain" in viewer._told.value and "<b>" in viewer._told.value
    np.testing.assert_array_equal(shown(viewer), before)
    with pytest.raises(pymeshlab.PyMeshLabException, match="gain"):
        viewer.set(gain=98.0)
    assert viewer.values["gain"] < 98
    with pytest.raises(ValueError, match="there is no slider softness; there are gain"):
        viewer.set(softness=1.0)


def test_what_cannot_be_viewed_is_refused(multires, ms):
    with pytest.raises(ValueError, match="roughness has no relative_to"):
        multires.view(ms, multires.roughness)
    with pytest.raises(ValueError, match="equalizer has no gain_9"):
        multires.view(ms, gain_9=2)
    with pytest.raises(ValueError, match="equalizer has no relative_to to be set"):
        multires.view(ms, relative_to="original")
    with pytest.raises(pymeshlab.PyMeshLabException, match="Faces"):
        empty = pymeshlab.MeshSet(verbose=False)
        empty.add_mesh(pymeshlab.Mesh(np.zeros((3, 3))))
        multires.view(empty)


@pytest.mark.parametrize("missing", ["pyvista", "ipywidgets"])
def test_without_what_it_needs_it_says_so(multires, meshes, missing):
    program = textwrap.dedent(f"""
        import sys
        sys.path.insert(0, {str(next(p for p in sys.path if "package" in p))!r})
        sys.modules[{missing!r}] = None
        import pymeshlab, pymeshlab_multires
        ms = pymeshlab.MeshSet(verbose=False)
        ms.load_new_mesh({str(meshes / "disk.ply")!r})
        try:
            pymeshlab_multires.view(ms, size={SMALL}).widget
        except ImportError as error:
            print(error)
    """)
    told = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True).stdout
    assert told.strip().endswith(
        f'view() needs {missing}, which is not installed: pip install "pymeshlab-multires[view]"'
    )
