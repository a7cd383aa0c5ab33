"""The Python package: its wheel, its functions beside the filters they call, its types, and a fresh environment."""

import dataclasses
import inspect
import json
import os
import pathlib
import re
import subprocess
import sys
import tarfile
import textwrap

import numpy as np
import pymeshlab
import pytest
from conftest import BUILD, FILTER_IDS, FILTERS, citations, wants_another_layer, wants_grid

ROOT = BUILD.parents[1]
sys.path.insert(0, str(ROOT / "tools"))
import generate  # noqa: E402


def document(meshes, name="terrain", another_layer=False):
    ms = pymeshlab.MeshSet(verbose=False)
    if another_layer:
        ms.load_new_mesh(str(meshes / ("grid.ply" if name == "grid" else "disk.ply")))
    ms.load_new_mesh(str(meshes / f"{name}.ply"))
    ms.current_mesh().add_vertex_custom_scalar_attribute(ms.current_mesh().vertex_matrix()[:, 2], "height")
    return ms


@pytest.mark.parametrize("row", FILTERS, ids=FILTER_IDS)
def test_a_function_does_what_its_filter_does_by_default(multires, meshes, row):
    function = getattr(multires, generate.function_name(row))
    name = "grid" if wants_grid(row["python_name"]) else "terrain"
    ms, other = (document(meshes, name, wants_another_layer(row["python_name"])) for _ in range(2))
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
    parameters = list(inspect.signature(function).parameters)
    of_pyramid = [field.name for field in dataclasses.fields(multires.Pyramid)]
    assert parameters[0] == "ms"
    every = [p for name in parameters[1:] for p in (of_pyramid if name == "pyramid" else [name])]
    assert sorted(every) == sorted(p["name"] for p in row["parameters"])
    documented = [(function, name) for name in parameters] + [(multires.Pyramid, name) for name in of_pyramid]
    for of, name in documented:
        assert re.search(rf"^        (\w+, )*{name}(, \w+)*: \S", of.__doc__, re.MULTILINE), name
    assert row["python_name"] in function.__doc__


@pytest.mark.parametrize("row", FILTERS, ids=FILTER_IDS)
def test_a_function_cites_every_paper_whole(multires, row):
    said = " ".join(getattr(multires, generate.function_name(row)).__doc__.split("See:")[1].split())
    assert said == " ".join(f'{authors}, "{title}", {where}' for authors, title, where in citations(row["info"]))


def test_a_pyramid_comes_through_and_is_reused_by_an_equal_one(multires, meshes):
    ms, other = document(meshes), document(meshes)
    pyramid = multires.Pyramid(scheme="Roy", sets_per_level=1, presmooth=0)
    report = multires.enhance(ms, gain=3, pyramid=pyramid)
    other.apply_filter("apply_coord_multires_enhance", gain=3, scheme="Roy", sets_per_level=1, presmooth=0)
    np.testing.assert_array_equal(ms.current_mesh().vertex_matrix(), other.current_mesh().vertex_matrix())
    assert not report.pyramid_reused
    same = multires.Pyramid(scheme="Roy", sets_per_level=1, presmooth=0)
    assert same == pyramid and hash(same) == hash(pyramid) and same != multires.Pyramid()
    multires.build_pyramid(ms, pyramid=same)
    assert multires.enhance(ms, gain=1, pyramid=pyramid).pyramid_reused
    with pytest.raises(dataclasses.FrozenInstanceError, match="scheme"):
        pyramid.scheme = "Guskov"


def test_pyramid_parameters_as_keywords_work_with_a_warning(multires, meshes):
    ms, other = document(meshes), document(meshes)
    with pytest.warns(DeprecationWarning, match=r"low_pass\(\.\.\., pyramid=Pyramid\(scheme='Roy'\)\)"):
        multires.low_pass(ms, cutoff=0.3, scheme="Roy")
    multires.low_pass(other, cutoff=0.3, pyramid=multires.Pyramid(scheme="Roy"))
    np.testing.assert_array_equal(ms.current_mesh().vertex_matrix(), other.current_mesh().vertex_matrix())
    with pytest.raises(TypeError, match="unexpected keyword argument 'colour'"):
        multires.low_pass(ms, colour=1)


def test_parameters_come_through(multires, meshes):
    ms, other = document(meshes), document(meshes)
    clamped = multires.Pyramid(operator="cotangent clamped")
    report = multires.low_pass(ms, cutoff=0.3, softness=1, pyramid=clamped)
    other.apply_filter("apply_coord_multires_low_pass", cutoff=0.3, softness=1, operator="cotangent clamped")
    np.testing.assert_array_equal(ms.current_mesh().vertex_matrix(), other.current_mesh().vertex_matrix())
    assert report.rms_displacement > 0 and report.gains[0] == 0 < report.gains[-1]


def test_what_belongs_to_attributes_is_found_by_their_names(multires, meshes):
    report = multires.denoise_attributes(document(meshes), color=True, quality=True, custom=True, rule="soft")
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


NO_RANGE, GAIN = "is no range of wavelengths", "must be 0 to 10"


@pytest.mark.parametrize("gains, message", [
    *[({band: 2}, NO_RANGE) for band in ("1", "2-1", "a-b", "1-1", "1--2", "nan-2", "1-inf", "1-1e39", "1-1.00000001")],
    ({"1-3": 1, "2-4": 1}, '"1-3" and "2-4" overlap'), ({"1-": 2, "5-6": 1}, '"1-" and "5-6" overlap'),
    *[({"1-2": gain}, f'the gain of "1-2" is {gain}; it {GAIN}') for gain in (-1, 10.001, float("nan"))],
])  # fmt: skip
def test_equalize_with_a_wrong_range_or_gain_changes_nothing(multires, meshes, gains, message):
    ms = document(meshes)
    before = ms.current_mesh().vertex_matrix()
    with pytest.raises(ValueError, match=re.escape(message)):
        multires.equalize(ms, {"0.001-0.002": 2, **gains})
    with pytest.raises(ValueError, match="softness is -1; it must be 0 to 10"):
        multires.equalize(ms, {"0.001-0.002": 2}, softness=-1)
    np.testing.assert_array_equal(ms.current_mesh().vertex_matrix(), before)


def test_equalize_takes_every_gain_that_enhance_takes(multires, meshes):
    ms, other = document(meshes), document(meshes)
    gain = next(p for r in FILTERS for p in r["parameters"] if (r["python_name"], p["name"]) == ("apply_coord_multires_enhance", "gain"))
    multires.equalize(ms, {"0.1-0.4": gain["most"]})
    other.apply_filter("apply_coord_multires_enhance", gain=gain["most"], finest=0.1, coarsest=0.4)
    np.testing.assert_array_equal(ms.current_mesh().vertex_matrix(), other.current_mesh().vertex_matrix())


def test_an_error_of_the_filter_is_pymeshlabs(multires, meshes):
    with pytest.raises(pymeshlab.PyMeshLabException, match="softness"):
        multires.low_pass(document(meshes), softness=-1)


AFTER_AN_ERROR = """
import sys
sys.path.insert(0, {package!r})
import pymeshlab
import pymeshlab_multires as multires

ms = pymeshlab.MeshSet(verbose={verbose})
ms.load_new_mesh({folder!r} + "/mesh.ply")
for name in ("low_pass", "enhance"):
    try:
        {call}
        sys.exit("no error")
    except pymeshlab.PyMeshLabException:
        {then}
del ms
for _ in range(5):
    for kind in ("off", "ply", "obj", "stl"):
        ms = pymeshlab.MeshSet(verbose=False)
        ms.load_new_mesh({folder!r} + "/mesh." + kind)
        assert ms.current_mesh().face_number() == {faces}
assert multires.low_pass(ms).rms_displacement > 0
ms.print_status()  # C++'s standard output is as it was
"""


BY_PACKAGE = ("getattr(multires, name)(ms, softness=-1)", "pass")
BY_HAND = ('ms.apply_filter("apply_coord_multires_" + name, softness=-1)', "pymeshlab.MeshSet().create_cube()")


@pytest.mark.parametrize("verbose", [False, True])
@pytest.mark.parametrize("call, then", [BY_PACKAGE, BY_HAND], ids=["package", "as README says"])
def test_after_an_error_and_with_its_document_gone_files_load(multires, meshes, tmp_path, verbose, call, then):
    """pymeshlab goes on logging to the document of a filter that failed: loading crashed."""
    ms = document(meshes)
    for kind in ("off", "ply", "obj", "stl"):
        ms.save_current_mesh(str(tmp_path / f"mesh.{kind}"))
    script = AFTER_AN_ERROR.format(package=os.path.dirname(os.path.dirname(multires.__file__)), folder=str(tmp_path),
                                   verbose=verbose, call=call, then=then, faces=ms.current_mesh().face_number())  # fmt: skip
    done = subprocess.run([sys.executable, "-c", script], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    assert done.returncode == 0, done.stdout
    assert "Mesh label: mesh.stl" in done.stdout


def test_an_error_leaves_the_document_and_its_script_alone(multires, meshes, tmp_path):
    ms = document(meshes)
    before = ms.current_mesh().vertex_matrix()
    with pytest.raises(pymeshlab.PyMeshLabException, match="softness"):
        multires.low_pass(ms, softness=-1)
    assert ms.mesh_number() == 1 and ms.current_mesh_id() == 0
    np.testing.assert_array_equal(ms.current_mesh().vertex_matrix(), before)
    ms.save_filter_script(str(tmp_path / "script.mlx"))
    assert "<filter" not in (tmp_path / "script.mlx").read_text()


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


def test_the_plot_shows_heights_and_the_bearing_curve(multires, meshes):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    report = multires.roughness(document(meshes), form="plane", l_filter=0)
    axes = multires.plot_roughness(report, plt.figure().add_subplot(), label="scan")
    line = axes.get_lines()[0]
    np.testing.assert_array_equal(line.get_ydata(), report.heights)
    assert line.get_xdata()[0] == 100 and abs(line.get_xdata()[-1]) < 1e-9 and (np.diff(line.get_xdata()) <= 0).all()
    below = (report.heights[:-1] + report.heights[1:]) / 2 < 0
    assert 0.2 < report.shares[below].sum() < 0.8 and len(axes.patches) == len(report.shares)


def mypy(*arguments, **environment):
    return subprocess.run([sys.executable, "-m", "mypy", "--strict", "--no-incremental", *arguments], text=True,
                          stdout=subprocess.PIPE, cwd=ROOT / "python", env={**os.environ, **environment})  # fmt: skip


def test_types_are_strict(multires, tmp_path):
    user = tmp_path / "user.py"
    user.write_text(
        textwrap.dedent("""
        import pymeshlab_multires as m
        def use(ms: m._call.MeshSet) -> float:
            m.equalize(ms, {"1-2": 2.0})
            return m.denoise(ms, method="soft threshold", pyramid=m.Pyramid(scheme="Roy")).noise
        def misuse(ms: m._call.MeshSet) -> str:
            m.low_pass(ms, pyramid=m.Pyramid(scheme="Rio"))
            return m.denoise(ms, method="softish").noise
    """)
    )
    done = mypy("src", str(user))
    errors = [line for line in done.stdout.splitlines() if "error:" in line]
    assert len(errors) == 3 and all(line.startswith(f"{user}:") for line in errors), done.stdout
    assert "softish" in done.stdout and "Rio" in done.stdout and '"float"' in done.stdout, done.stdout


def test_the_wheel_works_in_a_fresh_environment(wheel, meshes, tmp_path):
    """With nothing but what pip installs for it."""
    assert re.search(r"-py3-none-manylinux_2_\d+_x86_64\.whl$", wheel.name)
    subprocess.run([sys.executable, "-m", "venv", tmp_path / "venv"], check=True)
    python = tmp_path / "venv/bin/python"
    subprocess.run([python, "-m", "pip", "install", "-q", wheel], check=True)
    script = f"""
        import pymeshlab
        import pymeshlab_multires as multires
        ms = pymeshlab.MeshSet(verbose=False)
        ms.load_new_mesh({str(meshes / "irregular_sphere.ply")!r})
        assert multires.denoise(ms, method="normal field").rms_displacement > 0
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


def test_another_pymeshlab_is_refused_with_the_remedy(multires, tmp_path):
    (tmp_path / "pymeshlab-2023.12.dist-info").mkdir()
    (tmp_path / "pymeshlab-2023.12.dist-info/METADATA").write_text("Metadata-Version: 2.1\nName: pymeshlab\nVersion: 2023.12\n")
    path = os.pathsep.join([str(tmp_path), os.path.dirname(os.path.dirname(multires.__file__))])
    done = subprocess.run([sys.executable, "-c", "import pymeshlab_multires"], env=os.environ | {"PYTHONPATH": path},
                          text=True, stderr=subprocess.PIPE)  # fmt: skip
    said = "built for pymeshlab 2025.7, and 2023.12 is installed: pip install 'pymeshlab==2025.7.*'"
    assert done.returncode == 1 and f"ImportError: pymeshlab_multires was {said}" in done.stderr


def test_the_sdist_holds_what_the_plugins_are_built_from(tmp_path):
    """Configured, not compiled again."""
    code = f"import multires_build; print(multires_build.build_sdist({str(tmp_path)!r}))"
    done = subprocess.run([sys.executable, "-c", code], check=True, text=True, stdout=subprocess.PIPE, cwd=ROOT / "python",
                          env=os.environ | {"PYTHONPATH": str(ROOT / "python/backend")})  # fmt: skip
    name = done.stdout.split()[-1]
    with tarfile.open(tmp_path / name) as archive:
        archive.extractall(tmp_path)
    source = tmp_path / name.removesuffix(".tar.gz")
    cache = (BUILD / "CMakeCache.txt").read_text()
    given = [f"-D{n}={re.search(rf'^{n}:[A-Z]+=(.*)$', cache, re.MULTILINE)[1]}" for n in ("MESHLAB_SOURCE_DIR", "MESHLAB_COMMON_LIBRARY")]
    subprocess.run(["cmake", "-S", source, "-B", tmp_path / "build", "-G", "Ninja", *given], check=True, stdout=subprocess.PIPE)
    compiled = json.loads((tmp_path / "build/compile_commands.json").read_text())
    files = {str(pathlib.Path(entry["file"]).relative_to(source / "multires")) for entry in compiled
             if pathlib.Path(entry["file"]).is_relative_to(source)}  # fmt: skip
    wanted = {str(path.relative_to(ROOT)) for folder in ("common", "plugins") for path in (ROOT / folder).rglob("*.cpp")}
    assert files == {path for path in wanted if not path.endswith("_2020.cpp")}
    for plugin in sorted(BUILD.glob("plugins/*.so")):
        assert f"{plugin.stem.removeprefix('lib')}_class.cpp" in str([entry["file"] for entry in compiled])


def test_the_conda_recipe_is_one_of_this_version():
    import rattler_build

    project = (ROOT / "python/pyproject.toml").read_text()
    version = re.search(r'^version = "(.*)"', project, re.MULTILINE)[1]
    recipe = rattler_build.Stage0Recipe.from_file(ROOT / "conda/recipe.yaml")
    assert recipe.as_single_output().context["version"] == version


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
