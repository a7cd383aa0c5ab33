#!/bin/bash
# Builds the Debian package of the plugins and checks it with lintian:
#   scripts/debian_package.sh [2020.09|2022.02]
# For the MeshLab of that version as Debian (12, 13) packages it; the package goes to build/deb-VERSION/. Needs debhelper
# and lintian. Takes as long as a build of all plugins: no other script calls it.
set -euo pipefail
cd "$(dirname "$0")/.."
version=${1:-2020.09}
scripts/fetch_meshlab.sh "$version"

folder=$PWD/build/deb-$version
name=$(dpkg-parsechangelog -S Source)-$(dpkg-parsechangelog -S Version)
rm -rf "$folder"
mkdir -p "$folder/$name"
git ls-files -z -- . ':!.github' ':!.ci' | tar -c --null -T - | tar -x -C "$folder/$name"
ln -s "$PWD/.cache" "$folder/$name/.cache"
cd "$folder/$name"
MESHLAB_VERSION=$version dpkg-buildpackage -us -uc -b
cd ..
lintian --fail-on error,warning --display-info --no-tag-display-limit ./*.changes
ls -l ./*.deb
