#!/bin/bash
# Makes what a release on Linux has, in dist/: an archive of the plugins for each host, the wheel and the sdist. Uses what
# scripts/test.sh built.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh
rm -rf dist
mkdir dist
for preset in pymeshlab-2025.07 debian-2020.09 headers-2022.02 headers-2025.07; do
    cmake --preset "$preset" --log-level=WARNING >/dev/null
    rm -f "build/$preset"/meshlab-multires-*.tar.gz
    cmake --build --preset "$preset" --target release
    cp "build/$preset"/meshlab-multires-*.tar.gz dist/
done
plugins=$PWD/build/pymeshlab-2025.07/plugins
MULTIRES_PLUGINS=$plugins .venv/bin/pip wheel -q --no-build-isolation --no-deps -w dist ./python
(cd python && PYTHONPATH=backend ../.venv/bin/python -c 'import multires_build as b; print(b.build_sdist("../dist"))')
ls -l dist
