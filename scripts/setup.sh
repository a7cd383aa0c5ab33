#!/bin/bash
# Installs what is missing, and nothing else: Debian packages, .venv/, MeshLab's sources in .cache/.
#   scripts/setup.sh demo    enough to build and run the pymeshlab preset
#   scripts/setup.sh         everything: all presets, all tests
#   scripts/setup.sh portable   everything, and the compilers and emulators of scripts/check_portable.sh
# Made for Debian 12; needs root or sudo only if a package is missing. May be run at any time.
set -euo pipefail
cd "$(dirname "$0")/.."
what=${1:-all}

packages=(build-essential ca-certificates ccache cmake ninja-build
    libeigen3-dev libxxhash-dev libzstd-dev libglew-dev libgtest-dev libbenchmark-dev qtbase5-dev libqt5opengl5-dev
    python3 python3-venv dpkg-dev debian-archive-keyring xz-utils
    libegl1 libgl1 libgl1-mesa-dri libglu1-mesa libopengl0 libxrender1 xvfb xauth)
if [ "$what" != demo ]; then
    packages+=(meshlab clang clang-format libclang-rt-dev chromium-headless-shell)
fi
if [ "$what" = portable ]; then
    packages+=(g++-mingw-w64-x86-64-posix wine64 g++-aarch64-linux-gnu qemu-user libc++-dev libc++abi-dev)
fi

missing=()
for package in "${packages[@]}"; do
    [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || missing+=("$package")
done
if [ ${#missing[@]} -gt 0 ]; then
    echo "Installing: ${missing[*]}"
    sudo=""
    if [ "$(id -u)" != 0 ]; then
        sudo=sudo
        command -v sudo >/dev/null || { echo "Neither root nor sudo: please install these packages." >&2; exit 1; }
    fi
    $sudo env DEBIAN_FRONTEND=noninteractive apt-get update -q
    $sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends "${missing[@]}"
fi

# Debian's own Python: another one on the PATH may be built without what the wheels need. What is there already stays
# usable for programs that run.
wanted=$(sha256sum requirements.txt)
if [ "$(cat .venv/installed 2>/dev/null)" != "$wanted" ]; then
    /usr/bin/python3 -m venv "$(readlink -m .venv)" # which may be a link to one that is shared; venv refuses links
    .venv/bin/pip install -q -r requirements.txt
    echo "$wanted" >.venv/installed
fi
# One path to the wheel's libraries, whatever the version of Python is; the presets name it.
mkdir -p .cache
wheel=$(.venv/bin/python -c 'import sysconfig; print(sysconfig.get_path("platlib"))')/pymeshlab
[ "$(readlink .cache/pymeshlab)" = "$wheel" ] || ln -sfn "$wheel" .cache/pymeshlab

if [ "$what" = portable ] && ! ls .venv/lib/python3*/site-packages/ziglang/zig >/dev/null 2>&1; then
    .venv/bin/pip install -q ziglang==0.17.1
fi

scripts/fetch_meshlab.sh 2025.07
if [ "$what" != demo ]; then
    scripts/fetch_meshlab.sh 2020.09
    scripts/fetch_meshlab.sh 2022.02
fi
