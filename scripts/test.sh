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
for preset in "${presets[@]}"; do
    echo "Building $preset, after $SECONDS s"
    rm -f "build/$preset"/ctest.xml "build/$preset"/pytest_*.xml
    cmake --preset "$preset" --log-level=WARNING >/dev/null || stop "cannot configure $preset"
    cmake --build --preset "$preset" || stop "cannot build $preset"
done
for preset in "${presets[@]}"; do
    echo "Testing $preset, after $SECONDS s"
    ctest --preset "$preset" --parallel "$(nproc)" --output-junit ctest.xml --progress ||
        true # counted below
done
exec python3 scripts/count_tests.py "${presets[@]/#/build/}"
