#!/bin/bash
# Builds the plugins for a MeshLab and puts them where it finds them:
#   scripts/install.sh                      for the MeshLab that is installed as a Debian package
#   scripts/install.sh VERSION [PREFIX]     VERSION: 2020.09, 2022.02, 2025.07, or pymeshlab
# PREFIX is by default /usr for 2020.09, which looks for plugins beside itself only (this asks for sudo), ~/.local for the
# user's own plugins of later versions, and ~/.local/lib/meshlab-multires for pymeshlab, which loads them by path. To
# take them away again, delete the files that are listed at the end.
set -euo pipefail
here=$(cd "$(dirname "$0")/.." && pwd)
version=${1:-}
if [ -z "$version" ]; then
    version=$(dpkg-query -W -f '${source:Upstream-Version}' meshlab 2>/dev/null | cut -c 1-7) ||
        { echo "No MeshLab package is installed here: say which version, see $0." >&2; exit 1; }
    echo "Installed here: MeshLab $version"
fi
case $version in
    2020.09)   preset=debian-2020.09    prefix=/usr ;;
    2022.02)   preset=headers-2022.02   prefix=$HOME/.local ;;
    2025.07)   preset=headers-2025.07   prefix=$HOME/.local ;;
    pymeshlab) preset=pymeshlab-2025.07 prefix=$HOME/.local/lib/meshlab-multires ;;
    *) echo "There are no plugins for MeshLab \"$version\": see $0, or \"Installing\" in README.md." >&2; exit 1 ;;
esac
prefix=$(realpath -m "${2:-$prefix}")

cd "$here"
scripts/setup.sh demo
[ "$version" = pymeshlab ] || scripts/fetch_meshlab.sh "$version"
cmake --preset "$preset" --log-level=WARNING >/dev/null
cmake --build --preset "$preset" --target plugins
as=()
mkdir -p "$prefix" 2>/dev/null || true
[ -w "$prefix" ] || as=(sudo)
"${as[@]}" cmake --install "build/$preset" --prefix "$prefix"
