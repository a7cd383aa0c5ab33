#!/bin/bash
# The library on other compilers, processors and systems: compiled, a share of the unit tests run, and what every filter
# computes on generated meshes compared, bit for bit, with the build of the preset pymeshlab-2025.07. Not part of
# scripts/test.sh, for it compiles common/ once more for each: run it when a day's changes touch common/.
#   scripts/check_portable.sh [libcxx|mingw|aarch64|macos]...      default: all
# Ends with a line "N passed, N failed". macOS is compiled and linked for both processors, not run.
set -uo pipefail
cd "$(dirname "$0")/.."
targets=("$@")
[ ${#targets[@]} -gt 0 ] || targets=(libcxx mingw aarch64 macos)
passed=0
failed=0
note() { # note RESULT WHAT
    [ "$1" = 0 ] && { passed=$((passed + 1)); echo "ok: $2"; } || { failed=$((failed + 1)); echo "FAILED: $2"; }
}

scripts/setup.sh portable || exit 1
native=build/pymeshlab-2025.07
cmake --preset pymeshlab-2025.07 --log-level=WARNING >/dev/null &&
    cmake --build --preset pymeshlab-2025.07 --target multires_result_hashes || exit 1
"$native/tests/portable/multires_result_hashes" >"$native/result_hashes.csv" || exit 1

# build TARGET FOLDER [OPTION...]
build() {
    local target=$1 folder=$2
    shift 2
    cmake --preset "$target" -B "$folder" --log-level=WARNING "$@" >/dev/null &&
        cmake --build "$folder" --target multires_result_hashes multires_portable_tests
    note $? "$target: compiled in $folder"
}

# run TARGET PROGRAM...: the name ends in .exe on Windows
run() {
    local folder=build/$1
    shift
    "$@" "$(ls "$folder"/tests/portable/multires_portable_tests{,.exe} 2>/dev/null)" --gtest_brief=1
    note $? "$folder: unit tests"
    "$@" "$(ls "$folder"/tests/portable/multires_result_hashes{,.exe} 2>/dev/null)" | tr -d '\r' >"$folder/result_hashes.csv" &&
        python3 scripts/compare_hashes.py "$native/result_hashes.csv" "$folder/result_hashes.csv" "${folder##*/}"
    note $? "$folder: results"
}

for target in "${targets[@]}"; do
    case $target in
        macos)
            for processor in aarch64 x86_64; do
                build macos build/macos-$processor -DMULTIRES_ZIG_TARGET=$processor-macos \
                    -DMULTIRES_ZIG="$(echo "$PWD"/.venv/lib/python3*/site-packages/ziglang/zig)"
            done ;;
        mingw) build mingw build/mingw && WINEDEBUG=-all WINEPREFIX=$PWD/.cache/wine run mingw "$(command -v wine64 || echo /usr/lib/wine/wine64)" ;;
        aarch64) build aarch64 build/aarch64 && run aarch64 qemu-aarch64 ;;
        *) build "$target" "build/$target" && run "$target" env ;;
    esac
done
echo "$passed passed, $failed failed"
[ $failed = 0 ]
