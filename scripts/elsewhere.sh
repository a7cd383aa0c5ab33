#!/bin/bash
# What .github/workflows/build.yml does on Windows (in Git's bash) and macOS, step by step:
#   scripts/elsewhere.sh setup|build|test|wheel
# Plugins are built for pymeshlab 2025.7, which brings the library to link with. The wheel is tested where it was made.
set -euo pipefail
cd "$(dirname "$0")/.."

qt=5.15.2
case $(uname -s) in
    Darwin) system=macos qt_host=mac qt_kind=clang_64 qt_folder=clang_64 packages=$PWD/.cache/vcpkg/installed/arm64-osx ;;
    MINGW* | MSYS*) system=windows qt_host=windows qt_kind=win64_msvc2019_64 qt_folder=msvc2019_64
        packages=$(cygpath -m "$PWD")/.cache/vcpkg/installed/x64-windows ;;
    *) echo "scripts/test.sh does this on Linux" >&2; exit 1 ;;
esac
python=.venv/bin/python
[ $system = windows ] && python=.venv/Scripts/python.exe

setup() {
    python -m venv .venv
    "$python" -m pip install -q pymeshlab==2025.7.post1 numpy pytest scikit-build-core cmake ninja aqtinstall
    "$python" -m aqt install-qt "$qt_host" desktop $qt "$qt_kind" -O .cache/qt
    # MeshLab's sources at the commits that pymeshlab 2025.7.post1 was built from.
    fetch cnr-isti-vclab/meshlab dc48b91ae562756a6988048c5d5c7f1d2b687256 .cache/meshlab-2025.07
    fetch cnr-isti-vclab/vcglib c94ef4e12e9ea3ae986d9af91005be8328d13719 .cache/meshlab-2025.07/src/vcglib
    git clone -q --depth 1 https://github.com/microsoft/vcpkg .cache/vcpkg
    .cache/vcpkg/bootstrap-vcpkg.sh -disableMetrics
    .cache/vcpkg/vcpkg install eigen3 glew xxhash zstd gtest
}

# fetch REPOSITORY COMMIT FOLDER
fetch() {
    mkdir -p "$3"
    git -C "$3" init -q
    git -C "$3" fetch -q --depth 1 "https://github.com/$1" "$2"
    git -C "$3" checkout -q FETCH_HEAD
}

options() {
    local wheel
    wheel=$("$python" -c 'import importlib.util as u; print(u.find_spec("pymeshlab").submodule_search_locations[0].replace("\\", "/"))')
    local library=$wheel/meshlab-common.lib
    [ $system = macos ] && library=$wheel/Frameworks/libmeshlab-common.dylib
    printf '%s\n' "-DMESHLAB_SOURCE_DIR=$PWD/.cache/meshlab-2025.07" "-DMESHLAB_COMMON_LIBRARY=$library" \
        -DMESHLAB_SCALAR=double -DMULTIRES_BUILD_HOST_TESTS=OFF \
        "-DCMAKE_PREFIX_PATH=$PWD/.cache/qt/$qt/$qt_folder;$packages"
}

build() {
    # The generator's own default on Windows is Visual Studio, which needs no environment of its own.
    local options=()
    while read -r option; do options+=("$option"); done < <(options)
    cmake -S . -B build/elsewhere "${options[@]}" -DCMAKE_BUILD_TYPE=Release
    cmake --build build/elsewhere --config Release --parallel
}

test_all() {
    ctest --test-dir build/elsewhere -C Release --output-on-failure --parallel 3
}

wheel() {
    mkdir -p dist
    local plugins=build/elsewhere/plugins
    [ -d $plugins/Release ] && plugins=$plugins/Release
    MULTIRES_PLUGINS=$PWD/$plugins "$python" -m pip wheel -q --no-deps -w dist ./python
    "$python" -m pip install -q dist/*.whl
    "$python" - <<'PYTHON'
import pymeshlab
import pymeshlab_multires as multires

ms = pymeshlab.MeshSet(verbose=False)
ms.create_sphere(subdiv=4)
ms.compute_coord_by_function(x="x + 0.01 * sin(57 * y * z)")
assert multires.build_pyramid(ms).vertices[0] == 2562
assert multires.low_pass(ms).rms_displacement > 0
PYTHON
    cmake --build build/elsewhere --config Release --target release
    cp build/elsewhere/meshlab-multires-*.* dist/
}

case ${1:-} in
    setup | build | wheel) "$1" ;;
    test) test_all ;;
    *) sed -n '2,4s/^# \{0,1\}//p' "$0"; exit 1 ;;
esac
