#!/bin/bash
# Unpacks MeshLab's headers (with vcglib) into .cache/meshlab-<version>/, or all of it into .cache/meshlab-<version>-all/:
#   scripts/fetch_meshlab.sh 2020.09|2022.02|2025.07 [all]
# The source is Debian's upstream tarball, from the mirror the system uses, through an apt configuration of its own:
# the system's apt is neither changed nor updated. What is unpacked is checked by its SHA-256.
set -euo pipefail
cd "$(dirname "$0")/.."

version=${1:?version: 2020.09, 2022.02 or 2025.07}
case $version in
    2020.09) suite=bookworm sha=d6715352ff65caffdec0292858d4263eb0c3cbbf3b1e5c2e2bab218e3f234630 ;;
    2022.02) suite=trixie   sha=11da26ec46c3fbbbc806d410a3221542ec21ec13fdcc55d624304600029435fd ;;
    2025.07) suite=sid      sha=d22c98d362f2a284e481af8dbfc272b2222f5b9c67b3cf8bec57d1c3161886f4 ;;
    *) echo "unknown version $version" >&2; exit 1 ;;
esac
target=.cache/meshlab-$version
parts=('*/ML_VERSION' '*/LICENSE.txt' '*/src/common' "*/vcglib")
if [ "${2:-}" = all ]; then
    target+=-all
    parts=('*')
fi
[ -e "$target/ML_VERSION" ] && exit 0

# The first Debian archive among the system's sources, in either format; else Debian's own.
mirror() {
    cat /etc/apt/sources.list /etc/apt/sources.list.d/*.list /etc/apt/sources.list.d/*.sources 2>/dev/null |
        sed -nE 's#^(URIs:|deb( +\[[^]]*\])?) +((https?|file|copy):/[^ ]*/debian)/?( .*)?$#\3#p' | head -n 1
}
url=$(mirror || true)
url=${url:-http://deb.debian.org/debian}

work=$PWD/.cache/apt-$suite
mkdir -p "$work"/{sources,lists/partial,cache/archives/partial,download}
echo "deb-src [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] $url $suite main" >"$work/sources/source.list"
options=(-q -o Dir::Etc::sourcelist=/dev/null -o "Dir::Etc::sourceparts=$work/sources"
    -o "Dir::State::Lists=$work/lists" -o "Dir::Cache=$work/cache" -o APT::Sandbox::User=root)
echo "Fetching the sources of MeshLab $version from $url ($suite)"
apt-get "${options[@]}" update
(cd "$work/download" && apt-get "${options[@]}" source --download-only --tar-only meshlab)

tarball=$(ls "$work"/download/meshlab_*.orig.tar.*z)
echo "$sha  $tarball" | sha256sum --check --quiet || {
    echo "$tarball is not the MeshLab $version this suite was made with. If $suite has moved on, unpack a source" \
        "tree of $version at $target yourself." >&2
    exit 1
}
rm -rf "$target.part"
mkdir -p "$target.part"
tar -xf "$tarball" -C "$target.part" --no-same-owner --strip-components=1 --wildcards "${parts[@]}"
mv "$target.part" "$target"
rm -rf "$work"
