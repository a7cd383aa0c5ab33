"""Fixtures that run MeshLab itself: the GUI with a pilot aboard (pilot/pilot.cpp), and meshlabserver.

Debian's MeshLab 2020.09 looks for plugins only next to itself, so it runs from a private tree: copies of the two programs
(Linux finds a program's place through links), links to their library and to three plugins (PLY files, layers,
functions), and ours. Where MULTIRES_MESHLAB names the program of a later GUI, that is run instead, with our plugins in
the user's folder.
"""

import datetime
import json
import os
import pathlib
import shutil
import subprocess

import pytest
from conftest import BUILD, PLUGINS, PROBES

LATER_GUI = os.environ.get("MULTIRES_MESHLAB")


def link(plugins, folder):
    folder.mkdir(parents=True, exist_ok=True)
    for plugin in plugins:
        (folder / plugin.name).symlink_to(plugin)


@pytest.fixture(scope="session")
def tree(tmp_path_factory):
    """A folder to be the user's home, with bin/ and all the plugins in it."""
    root = tmp_path_factory.mktemp("meshlab")
    if LATER_GUI:
        (root / "bin").mkdir()
        (root / "bin/meshlab").symlink_to(LATER_GUI)
        folder = pathlib.PurePath(os.environ["MULTIRES_PLUGIN_DIR"])  # share/VCG/PROGRAM/MeshLabExtraPlugins/VERSION
        link(PLUGINS, root / ".local" / folder)
        # No question about statistics at the start, and no look for a newer version (today's has been done).
        settings = root / "config/VCG" / f"{folder.parts[2]}.conf"
        settings.parent.mkdir(parents=True)
        today = datetime.date.today().strftime("%a %b %-d %Y")
        settings.write_text(f"[General]\ninformativeShown=true\nlastTimeMeshLabVersionCheckedOnStart={today}\n")
        return root
    add_debian_meshlab(root, [*PROBES.glob("*.so"), *PLUGINS])
    return root


def add_debian_meshlab(root, plugins):
    server = pathlib.Path(shutil.which("meshlabserver", path="/usr/bin"))
    installed = next(server.parent.parent.glob("lib/*/meshlab"))
    here = root / "lib" / installed.parent.name / "meshlab"
    own = [installed / f"plugins/lib{name}.so" for name in ("io_base", "filter_layer", "filter_func")]
    link([*own, *plugins], here / "plugins")
    (here / "libmeshlab-common.so").symlink_to(installed / "libmeshlab-common.so")
    (root / "bin").mkdir(exist_ok=True)
    for program in (server, server.with_name("meshlab")):
        shutil.copy(program, root / "bin")


@pytest.fixture(scope="session")
def display():
    """Number of an X display of our own."""
    reading, writing = os.pipe()
    xvfb = subprocess.Popen(
        ["Xvfb", "-displayfd", str(writing), "-screen", "0", "1600x1200x24", "-nolisten", "tcp"],
        pass_fds=[writing],
        stderr=subprocess.DEVNULL,
    )
    os.close(writing)
    with os.fdopen(reading) as pipe:
        number = pipe.readline().strip()
    assert number, "Xvfb did not start"
    yield number
    xvfb.terminate()
    xvfb.wait()


@pytest.fixture(scope="session")
def run(tree, display):
    """Runs a program of the tree, away from the user's display and settings."""
    return runner(tree, display)


def runner(tree, display):
    def run(program, *arguments, **variables):
        own = {
            "HOME": tree,
            "XDG_CONFIG_HOME": tree / "config",
            "XDG_DATA_HOME": tree / ".local/share",
            "XDG_RUNTIME_DIR": tree,
            "DISPLAY": ":" + display,
        }
        return subprocess.run(
            [tree / "bin" / program, *map(str, arguments)],
            env={**os.environ, **{key: str(value) for key, value in own.items()}, **variables},
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            timeout=300,
        )

    return run


@pytest.fixture
def gui(run, tmp_path):
    """Runs the GUI with a mesh and has the pilot do the commands; returns what it printed."""

    def gui(*commands, mesh=None):
        script = tmp_path / "commands.json"
        script.write_text(json.dumps([[str(word) for word in command] for command in commands]))
        done = run(
            "meshlab",
            *([mesh] if mesh else []),
            MULTIRES_PILOT=str(script),
            QT_QPA_GENERIC_PLUGINS="multires_pilot",
            QT_PLUGIN_PATH=str(BUILD / "pilot"),
        )
        assert done.returncode == 0, done.stdout
        return done.stdout

    return gui
