"""Installing the plugins, and the archive of a release: the right files, which the host loads from there."""

import os
import pathlib
import subprocess
import sys
import tarfile
import textwrap

import pytest
from conftest import BUILD, FILTERS, PLUGINS
from meshlab_program import add_debian_meshlab, display, runner  # noqa: F401  a fixture

ROOT = pathlib.Path(__file__).resolve().parents[2]
PRESETS = {
    "debian-2020.09": "2020.09",
    "headers-2022.02": "2022.02",
    "headers-2025.07": "2025.07",
    "pymeshlab-2025.07": "pymeshlab",
}
VERSION = PRESETS[BUILD.name]
# Where each host looks, below the prefix that scripts/install.sh takes if none is given.
FOLDER = {
    "2020.09": "lib/x86_64-linux-gnu/meshlab/plugins",
    "2022.02": "share/VCG/MeshLab_64bit_fp/MeshLabExtraPlugins/2022.02",
    "2025.07": "share/VCG/MeshLab_64bit_fp/MeshLabExtraPlugins/2025.07",
    "pymeshlab": ".",
}[VERSION]


def files(folder):
    return sorted(path.relative_to(folder) for path in folder.rglob("*") if path.is_file())


def check_plugins_work(folder, root, display):
    """A filter of each plugin runs, or at least: the host loads them all."""
    plugins = sorted(folder.glob("*.so"))
    assert [p.name for p in plugins] == [p.name for p in PLUGINS]
    if VERSION == "pymeshlab":
        script = """
            import sys, pymeshlab
            for plugin in sys.argv[1:]:
                pymeshlab.load_plugin(plugin)
            ms = pymeshlab.MeshSet()
            ms.create_sphere()
            assert "levels" in ms.apply_filter("compute_multires_pyramid")
            ms.compute_coord_by_function(x="x + 0.01 * sin(57 * y * z)")
            for name in ("apply_coord_multires_denoise", "apply_coord_multires_low_pass"):
                assert ms.apply_filter(name)["largest_displacement"] > 0
        """
        subprocess.run([sys.executable, "-c", textwrap.dedent(script), *plugins], check=True)
    elif VERSION == "2020.09":
        add_debian_meshlab(root, [p for p in plugins if not p.is_relative_to(root)])
        done = runner(root, display)("meshlabserver", "-d", root / "filters.txt")
        told = done.stdout + (root / "filters.txt").read_text()
        for row in FILTERS:
            assert row["name"] in told, row["name"]


def test_install_puts_the_plugins_where_the_host_looks(tmp_path, display):
    subprocess.run([ROOT / "scripts/install.sh", VERSION, tmp_path / "prefix"], check=True, env=os.environ | {"HOME": str(tmp_path)})
    folder = tmp_path / "prefix" / FOLDER
    assert files(tmp_path / "prefix") == sorted(pathlib.Path(FOLDER) / p.name for p in PLUGINS)
    check_plugins_work(folder, tmp_path / "prefix", display)


def test_an_unknown_version_is_refused(tmp_path):
    done = subprocess.run([ROOT / "scripts/install.sh", "1.3.4", tmp_path], capture_output=True, text=True)
    assert done.returncode == 1 and "no plugins for MeshLab" in done.stderr
    assert not files(tmp_path)


def test_the_release_archive_holds_the_plugins_alone(tmp_path, display):
    for old in BUILD.glob("*.tar.gz"):
        old.unlink()
    subprocess.run(["cmake", "--build", BUILD, "--target", "release"], check=True, stdout=subprocess.DEVNULL)
    archives = list(BUILD.glob("*.tar.gz"))
    assert len(archives) == 1 and archives[0].name.startswith("meshlab-multires-")
    host = {"pymeshlab": "pymeshlab-2025.07"}.get(VERSION, f"meshlab-{VERSION}-float")
    top = archives[0].name.removesuffix(".tar.gz")
    assert f"-{host}-linux-" in top
    with tarfile.open(archives[0]) as archive:
        archive.extractall(tmp_path)
    names = [p.name for p in PLUGINS] + ["README.md", "LICENSE", "CHANGELOG.md"]
    assert files(tmp_path) == sorted(pathlib.Path(top) / name for name in names)
    check_plugins_work(tmp_path / top, tmp_path / "root", display)


@pytest.mark.parametrize("plugin", PLUGINS, ids=lambda p: p.stem)
def test_a_plugin_needs_nothing_that_its_host_does_not_bring(plugin):
    needed = [
        line.split("[")[1].rstrip("]")
        for line in subprocess.check_output(["readelf", "-d", plugin], text=True).splitlines()
        if "(NEEDED)" in line
    ]
    brought = ("libmeshlab-common.so", "libQt5", "libstdc++", "libgcc_s", "libm.so", "libc.so", "libGL", "libOpenGL", "ld-linux")
    assert not [name for name in needed if not name.startswith(brought)]
    assert not any("RPATH" in l or "RUNPATH" in l for l in subprocess.check_output(["readelf", "-d", plugin], text=True).splitlines())
