#!/bin/bash
# Builds the plugins for pymeshlab and shows what they do, on the Stanford bunny or on a mesh of yours:
#   scripts/demo.sh [MESH]
# Results are in demo-output/; comparison.html, with pictures and figures beside MeshLab's own filters, is the last.
set -euo pipefail
[ $# -eq 0 ] || mesh=$(realpath "$1")
cd "$(dirname "$0")/.."
scripts/setup.sh demo
cmake --preset pymeshlab-2025.07 --log-level=WARNING
cmake --build --preset pymeshlab-2025.07 --target plugins
.venv/bin/python tools/demo.py ${mesh:+"$mesh"}
.venv/bin/python tools/compare.py ${mesh:+"$mesh"} --noise 0.3 --output demo-output
