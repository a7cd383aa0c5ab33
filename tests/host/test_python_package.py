"""The Python package: its wheel, its functions beside the filters they call, its types, and a fresh environment."""

import inspect
import os
import subprocess
import sys
import textwrap
import zipfile

import numpy as np
import pymeshlab
import pytest
from conftest import BUILD, FILTER_IDS, FILTERS

ROOT = BUILD.parents[1]
sys.path.insert(0, str(ROOT / "tools"))
import generate  # noqa: E402


@pytest.fixture(scope="session")
def wheel(tmp_path_factory):
    """Built with the plugins that are there."""
    folder = tmp_path_factory.mktemp("wheel")
    subprocess.run([sys.executable, "-m", "pip", "wheel", "-q", "--no-build-isolation", "--no-deps", "-w", folder,
                    f"--config-settings=cmake.define.MULTIRES_PLUGINS={BUILD / 'plugins'}", ROOT / "python"], check=True)  # fmt: skip
    return next(folder.glob("*.whl"))


@pytest.fixture(scope="session")
def multires(wheel, tmp_path_factory):
    """The package, from its wheel."""
    folder = tmp_path_factory.mktemp("package")
    zipfile.ZipFile(wheel).extractall(folder)
    sys.path.insert(0, str(folder))
    import pymeshlab_multires

    assert pymeshlab_multires.__file__.startswith(str(folder))
    return pymeshlab_multires


_documents = []  # after a filter failed, pymeshlab goes on logging to the document, also when that is gone


def document(meshes, name="terrain"):
    _documents.append(pymeshlab.MeshSet(verbose=False))
    ms = _documents[-1]
    ms.load_new_mesh(str(meshes / f"{name}.ply"))
    ms.current_mesh().add_vertex_custom_scalar_attribute(ms.current_mesh().vertex_matrix()[:, 2], "height")
    return ms


@pytest.mark.parametrize("row", FILTERS, ids=FILTER_IDS)
def test_a_function_does_what_its_filter_does_by_default(multires, meshes, row):
    function = getattr(multires, generate.function_name(row))
    ms, other = document(meshes), document(meshes)
    report, raw = function(ms), other.apply_filter(row["python_name"])
    np.testing.assert_array_equal(ms.current_mesh().vertex_matrix(), other.current_mesh().vertex_matrix())
    np.testing.assert_array_equal(ms.current_mesh().vertex_color_matrix(), other.current_mesh().vertex_color_matrix())
    held = {}
    for name, value in vars(report).items():
        held |= {f"{a}_{name}": v for a, v in value.items()} if isinstance(value, dict) else {name: value}
    held = {name: value for name, value in held.items() if value is not None}
    assert held.keys() == raw.keys()
    for name, value in held.items():
        np.testing.assert_array_equal(value, raw[name], err_msg=name)


@pytest.mark.parametrize("row", FILTERS, ids=FILTER_IDS)
def test_a_function_has_every_parameter_and_tells_what_it_means(multires, row):
    function = getattr(multires, generate.function_name(row))
    parameters = inspect.signature(function).parameters
    assert list(parameters) == ["ms", *(p["name"] for p in row["parameters"])]
    for name in parameters:
        assert f"        {name}: " in function.__doc__
    assert row["python_name"] in function.__doc__


def test_parameters_come_through(multires, meshes):
    ms, other = document(meshes), document(meshes)
    report = multires.low_pass(ms, cutoff=0.3, softness=1, operator="cotangent clamped")
    other.apply_filter("apply_coord_multires_low_pass", cutoff=0.3, softness=1, operator="cotangent clamped")
    np.testing.assert_array_equal(ms.current_mesh().vertex_matrix(), other.current_mesh().vertex_matrix())
    assert report.rms_displacement > 0 and report.gains[0] == 0 < report.gains[-1]


def test_what_belongs_to_attributes_is_found_by_their_names(multires, meshes):
    report = multires.denoise_attributes(document(meshes), color=True, quality=True, custom=True)
    assert set(report.noise) == set(report.noise_per_level) == {"color", "quality", "custom_height"}


def test_equalize_is_enhance_range_by_range(multires, meshes):
    ms, other = document(meshes), document(meshes)
    wave = multires.build_pyramid(ms).wavelength
    fine, middle, end = wave[0], wave[3], wave[6]
    report = multires.equalize(ms, {f"{middle}-{end}": 2.0, f"{fine}-{middle}": 0})
    assert list(report.bands) == [f"{fine}-{middle}", f"{middle}-{end}"]
    multires.enhance(other, gain=0, finest=fine, coarsest=middle)
    multires.enhance(other, gain=2, finest=middle, coarsest=end)
    np.testing.assert_array_equal(ms.current_mesh().vertex_matrix(), other.current_mesh().vertex_matrix())
    assert report.bands[f"{fine}-{middle}"].rms_displacement > 0


def test_open_ranges_hold_everything_finer_or_coarser(multires, meshes):
    ms = document(meshes)
    wave = multires.build_pyramid(ms).wavelength
    assert multires.equalize(ms, {f"-{wave[3]}": 0.5}).bands[f"-{wave[3]}"].gains[0] == 0.5
    ms = document(meshes)
    gains = multires.equalize(ms, {f"{wave[3]:.3e}-": 0.5}).bands[f"{wave[3]:.3e}-"].gains
    assert gains[0] == 1 and gains[-1] == pytest.approx(0.5)


@pytest.mark.parametrize("gains", [{"1": 2}, {"2-1": 2}, {"a-b": 2}, {"1-1": 1}, {"1--2": 1}, {"nan-2": 1}, {"1-3": 1, "2-4": 1}, {"1-": 2, "5-6": 1},
                                   {"1-2": -1}, {"1-2": 9}, {"1-2": float("nan")}])  # fmt: skip
def test_wrong_ranges_and_gains_change_nothing(multires, meshes, gains):
    ms = document(meshes)
    before = ms.current_mesh().vertex_matrix()
    with pytest.raises(ValueError):
        multires.equalize(ms, {"0.001-0.002": 2, **gains})
    np.testing.assert_array_equal(ms.current_mesh().vertex_matrix(), before)


def test_an_error_of_the_filter_is_pymeshlabs(multires, meshes):
    with pytest.raises(pymeshlab.PyMeshLabException, match="softness"):
        multires.low_pass(document(meshes), softness=-1)


def test_the_plot_shows_the_spectrum(multires, meshes):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    report = multires.build_pyramid(document(meshes))
    axes = multires.plot_spectrum(report, plt.figure().add_subplot(), label="scan")
    line = axes.get_lines()[0]
    drawn = report.rms_detail > 0
    np.testing.assert_array_equal(line.get_xdata(), report.wavelength[drawn])
    np.testing.assert_array_equal(line.get_ydata(), report.rms_detail[drawn])
    assert axes.get_xscale() == axes.get_yscale() == "log" and "wavelength" in axes.get_xlabel()


def mypy(*arguments, **environment):
    return subprocess.run([sys.executable, "-m", "mypy", "--strict", "--no-incremental", *arguments], text=True,
                          stdout=subprocess.PIPE, cwd=ROOT / "python", env={**os.environ, **environment})  # fmt: skip


def test_types_are_strict(multires, tmp_path):
    done = mypy("src")
    assert done.returncode == 0, done.stdout
    user = tmp_path / "user.py"
    user.write_text(
        textwrap.dedent("""
        import pymeshlab_multires as m
        def use(ms: m._call.MeshSet) -> float:
            m.equalize(ms, {"1-2": 2.0})
            return m.denoise(ms, method="soft threshold").noise
        def misuse(ms: m._call.MeshSet) -> str:
            return m.denoise(ms, method="softish").noise
    """)
    )
    done = mypy(str(user), MYPYPATH=os.path.dirname(os.path.dirname(multires.__file__)))
    assert done.stdout.count("error:") == 2 and "softish" in done.stdout and '"float"' in done.stdout, done.stdout


def test_the_wheel_works_in_a_fresh_environment(wheel, meshes, tmp_path):
    """With nothing but what pip installs for it."""
    subprocess.run([sys.executable, "-m", "venv", tmp_path / "venv"], check=True)
    python = tmp_path / "venv/bin/python"
    subprocess.run([python, "-m", "pip", "install", "-q", wheel], check=True)
    script = f"""
        import pymeshlab
        import pymeshlab_multires as multires
        ms = pymeshlab.MeshSet(verbose=False)
        ms.load_new_mesh({str(meshes / "irregular_sphere.ply")!r})
        assert multires.denoise(ms).rms_displacement > 0
        assert multires.build_pyramid(ms).wavelength[0] > 0
        try:
            multires.plot_spectrum(multires.build_pyramid(ms))
        except ImportError:
            print("fine")
    """
    clean = {k: v for k, v in os.environ.items() if not k.startswith(("PYTHON", "MULTIRES", "LD_"))}
    done = subprocess.run([python, "-c", textwrap.dedent(script)], check=True, text=True, stdout=subprocess.PIPE,
                          cwd=tmp_path, env=clean)  # fmt: skip
    assert done.stdout.strip() == "fine"


def build(source, **settings):
    """Output of a build of the package that is to fail."""
    defines = [f"--config-settings=cmake.define.{k}={v}" for k, v in settings.items()]
    done = subprocess.run([sys.executable, "-m", "pip", "wheel", "--no-build-isolation", "--no-deps", "-w", source / "out",
                           *defines, ROOT / "python"], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)  # fmt: skip
    assert done.returncode != 0
    return " ".join(done.stdout.split())


def test_what_is_missing_for_the_build_is_said(tmp_path):
    assert "There are no headers of MeshLab 2025.07 in" in build(tmp_path, MESHLAB_SOURCE_DIR=tmp_path)
    assert "pymeshlab's library is not at" in build(tmp_path, MESHLAB_COMMON_LIBRARY=tmp_path / "no.so")
    assert "where there are no plugins" in build(tmp_path, MULTIRES_PLUGINS=tmp_path)
