#!/bin/bash
# Builds everything and runs every test: unit tests, plugins in their hosts, unit tests under sanitizers, the fuzzers for
# 20 seconds each, format, lint. Ends with one line, "N passed, N failed". May be run at any time; what is unchanged is
# not built or linted again.
set -uo pipefail
cd "$(dirname "$0")/.."
presets=(pymeshlab-2025.07 debian-2020.09 headers-2022.02 sanitize threads)

stop() {
    echo "$1" >&2
    echo "0 passed, 1 failed"
    exit 1
}

scripts/setup.sh || stop "setup failed"
build() {
    echo "Building $1, after $SECONDS s"
    rm -f "build/$1"/ctest.xml "build/$1"/pytest_*.xml
    cmake --preset "$1" --log-level=WARNING >/dev/null && cmake --build --preset "$1"
}

build pymeshlab-2025.07 || stop "cannot build pymeshlab-2025.07"
# Two at once: each is mostly a few sources that wait for one another.
build debian-2020.09 &
debian=$!
build headers-2022.02 || stop "cannot build headers-2022.02"
wait $debian || stop "cannot build debian-2020.09"
build sanitize || stop "cannot build sanitize"
build threads || stop "cannot build threads"
for preset in "${presets[@]}"; do
    echo "Testing $preset, after $SECONDS s"
    ctest --preset "$preset" --parallel "$(nproc)" --output-junit ctest.xml --progress ||
        true # counted below
done
exec python3 scripts/count_tests.py "${presets[@]/#/build/}"
