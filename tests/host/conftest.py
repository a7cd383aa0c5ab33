"""What the host tests share: where things were built, the tables of all filters, and meshes of every class."""

import html
import json
import os
import pathlib
import re
import subprocess
import sys
import zipfile

import pytest

BUILD = pathlib.Path(os.environ["MULTIRES_BUILD_DIR"])
PLUGINS = sorted((BUILD / "plugins").glob("*.so"))
PROBES = BUILD / "probes"

# Every filter of every plugin: dictionaries with name, python_name, changes and parameters.
FILTERS = json.loads(subprocess.check_output([BUILD / "tests/tables/multires_list_filters"]))
FILTER_IDS = [f["python_name"] for f in FILTERS]


def wants_another_layer(name):
    """Whether the filter of that Python name works on two layers."""
    parameters = next(f["parameters"] for f in FILTERS if f["python_name"] == name)
    return any(p["type"] == "layer" for p in parameters)


def wants_grid(name):
    """Whether the filter of that Python name refuses all meshes but triangular grids."""
    return "multires_grid" in name


@pytest.fixture(scope="session")
def meshes(tmp_path_factory):
    """A folder of generated meshes, a PLY file for each class of mesh."""
    folder = tmp_path_factory.mktemp("meshes")
    subprocess.run([BUILD / "meshes/make_meshes", folder], check=True)
    return folder


@pytest.fixture(scope="session")
def wheel(tmp_path_factory):
    """The Python package, built with the plugins that are there."""
    folder = tmp_path_factory.mktemp("wheel")
    subprocess.run([sys.executable, "-m", "pip", "wheel", "-q", "--no-build-isolation", "--no-deps", "-w", folder,
                    f"--config-settings=cmake.define.MULTIRES_PLUGINS={BUILD / 'plugins'}", BUILD.parents[1] / "python"],
                   check=True)  # fmt: skip
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


def citations(info):
    """(authors, title, where) of every paper that a filter's info cites; there is one at least."""
    cited = re.findall(r'<i>([^<]+)</i>,\s*<b>"([^"]+)"</b>,\s*([^<]+)', html.unescape(info))
    assert len(cited) == info.count("<b>") > 0, info
    return cited


def load_plugins():
    """Ours into pymeshlab, if they are not there yet."""
    import pymeshlab

    if FILTER_IDS[0] not in pymeshlab.filter_list():
        for plugin in PLUGINS:
            pymeshlab.load_plugin(str(plugin))
