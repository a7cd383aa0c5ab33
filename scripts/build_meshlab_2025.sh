#!/bin/bash
# Builds the GUI of MeshLab 2025.07 from Debian's upstream tarball, to try the plugins in:
#   scripts/build_meshlab_2025.sh           then: scripts/install.sh 2025.07 && .cache/meshlab-2025.07-gui/meshlab MESH
#   scripts/build_meshlab_2025.sh test      and uses it as the tests do Debian's (tests/host/test_gui.py)
# Not part of the tests: 290 steps, some 10 minutes on 2 idle cores. Single precision; of MeshLab's own plugins a few that
# need no library from elsewhere. NINJA_FLAGS goes to ninja: "-j1" builds on one core.
set -euo pipefail
cd "$(dirname "$0")/.."
source=.cache/meshlab-2025.07-all
build=.cache/meshlab-2025.07-build
gui=.cache/meshlab-2025.07-gui
plugins=(io_base render_gdp decorate_base decorate_background edit_select filter_select filter_clean filter_create
    filter_measure filter_meshing filter_unsharp)
read -ra flags <<<"${NINJA_FLAGS:-}"

scripts/setup.sh demo
scripts/fetch_meshlab.sh 2025.07 all
cmake -S "$source" -B "$build" -G Ninja --log-level=WARNING -Wno-dev -DCMAKE_BUILD_TYPE=Release \
    -DCMAKE_C_COMPILER_LAUNCHER=ccache -DCMAKE_CXX_COMPILER_LAUNCHER=ccache \
    -DMESHLAB_ALLOW_OPTIONAL_EXTERNAL_LIBRARIES=OFF "-DMESHLAB_PLUGINS=$(printf 'meshlabplugins/%s;' "${plugins[@]}")"
ninja -C "$build" "${flags[@]}"
ln -sfn "meshlab-2025.07-build/src/distrib" "$gui"
echo "Built $gui/meshlab"

[ "${1:-}" = test ] || exit 0
cmake --preset headers-2025.07 --log-level=WARNING "-DMESHLAB_PROGRAM=$PWD/$gui/meshlab"
cmake --build --preset headers-2025.07 -- "${flags[@]}"
ctest --preset headers-2025.07 -R pytest_gui
