#!/usr/bin/env python3
"""Fails where an include does not point down: every room (folder) may use those listed for it below, and itself.

    scripts/check_rooms.py [ROOT]      a part of scripts/test.sh; CONTRIBUTING.md shows the same picture
"""

import pathlib
import re
import sys

FLOOR = ["measure", "operators", "hierarchy", "normals"]  # rooms beside each other: none includes another
COMMON = {
    "base": [],
    "mesh": ["base"],
    "vcg": ["base", "mesh"],
    **{room: ["base", "mesh"] for room in FLOOR},
    "solvers": ["base", "mesh", "operators", "hierarchy"],
    "schemes": ["base", "mesh", "operators", "hierarchy", "grids"],
    "editing": ["base", "mesh", "measure", "solvers"],
    "bands": ["base", "mesh", "measure", "solvers"],
    "pyramid": ["base", "mesh", *FLOOR, "solvers", "schemes"],
    "denoise": ["base", "mesh", *FLOOR],
    "grids": ["base", "mesh"],
    "stream": ["base", "mesh", "measure", "hierarchy"],
    "watermark": ["base", "mesh", "measure"],
    "filters": ["base", "mesh", *FLOOR, "solvers", "bands", "schemes", "pyramid", "denoise", "editing", "grids",
                "watermark"],
}
PLUGINS = {
    "shared": list(COMMON),
    "host": ["shared", *COMMON],
    "io_multires": list(COMMON),  # the decoder as C functions
    "filter": ["shared", *COMMON],  # plugins/filter_*: one table each, which know neither each other nor the host
}
KINDS = ["shape", "attributes", "layers", "editing", "analysis", "grid"]  # of filters: rooms of their own below common/filters/
VCGLIB = re.compile(r"#include <(vcg|wrap)/")
QT_OR_MESHLAB = re.compile(r"#include <(Q\w+|common/.*)>")
INCLUDE = re.compile(r'#include "([^"/]+)/')


def faults(root):
    for path in sorted([*root.glob("common/**/*.h"), *root.glob("common/**/*.cpp"), *root.glob("plugins/**/*.h"),
                        *root.glob("plugins/**/*.cpp"), *root.glob("plugins/**/*.in")]):
        building, room, *rest = path.relative_to(root).parts
        if building == "plugins" and room.startswith("filter_"):
            room = "filter"
        rooms = COMMON if building == "common" else PLUGINS
        if room not in rooms:
            yield f"{path.relative_to(root)}: there is no room {building}/{room} in scripts/check_rooms.py"
            continue
        for number, line in enumerate(path.read_text().splitlines(), 1):
            place = f"{path.relative_to(root)}:{number}: {line}"
            include = INCLUDE.match(line)
            if include and include[1] != room and include[1] not in rooms[room]:
                yield f"{place}: {room} may not look up or sideways"
            elif room == "filters" and len(rest) > 1 and line.startswith('#include "filters/'):
                kind = line.split("/")[1]
                if kind in KINDS and kind != rest[0]:
                    yield f"{place}: filters of one kind do not use those of another; what both need belongs below"
            if QT_OR_MESHLAB.match(line) and room != "host":
                yield f"{place}: only plugins/host/ knows Qt and MeshLab"
            if VCGLIB.match(line) and room not in ("vcg", "host"):
                yield f"{place}: only common/vcg/ and plugins/host/ know vcglib"


def main():
    root = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parent.parent
    found = list(faults(root))
    print(*found, sep="\n")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
