"""Writes the inputs of corpus/conversion that must work: what fuzz_conversion.cpp reads, for meshes that are in order.

    tests/fuzz/conversion_seeds.py FOLDER

One for each component of a mesh, all of them together, deleted elements, and layers derived from the mesh: a part of
it, with other positions, and with indices that are out of range, which the target checks are refused.
"""

import pathlib
import sys

SIDE = 5  # vertices along a side of a square
COMPONENTS = {"vertex_texcoord": 1, "wedge_texcoord": 2, "face_color": 4, "custom_scalar": 16, "custom_point": 32,
              "custom_other": 64, "custom_of_faces": 128}  # fmt: skip
DELETE_VERTICES, DELETE_FACE = 8, 4
ZERO = 120  # the byte for the number 0, one more is 1/8


def grid():
    """Vertices as bytes of numbers, faces."""
    vertices = [(ZERO + x, ZERO + y, ZERO + (x * y) % 3) for y in range(SIDE) for x in range(SIDE)]
    corners = [y * SIDE + x for y in range(SIDE - 1) for x in range(SIDE - 1)]
    return vertices, [f for i in corners for f in ((i, i + 1, i + SIDE), (i + 1, i + SIDE + 1, i + SIDE))]


def given(components, deleted_faces=(), loose=0, derived=(), moved=(3, ZERO + 9)):
    """loose: vertices without a face, deleted if the components say so; derived: bytes of a layer."""
    vertices, faces = grid()
    out = [len(vertices) + loose, len(faces), components]
    for v in [*vertices, *[(ZERO, ZERO, ZERO)] * loose]:
        out += v
    for i, f in enumerate(faces):
        out += [*f, (i % 4) | (DELETE_FACE if i in deleted_faces else 0)]  # selected, faux, both or neither
    if components & DELETE_VERTICES:
        out += [0] * len(vertices) + [7] * loose
    return bytes([*out, *moved, *derived])


def layer(sources, faces, positions=()):
    """A layer of these vertices; faces: (source, corners)."""
    out = [len(sources), len(faces)]
    for s in sources:
        out += [s, 0]
    for source, corners in faces:
        out += [source, *corners]
    return [*out, *([1, len(positions), *positions[:1]] if positions else [0])]


def seeds():
    yield "plain", given(0)
    for name, bit in COMPONENTS.items():
        yield name, given(bit)
    yield "all_components", given(sum(COMPONENTS.values()) | DELETE_VERTICES, (0, 5), loose=3)
    yield "deleted_faces", given(2, range(0, 32, 3))
    yield "deleted_vertices", given(DELETE_VERTICES | 16, loose=6)
    yield "no_faces", given(1, range(32))
    yield "moved_to_nowhere", given(0, moved=(3, 245))
    part = [(0, (0, 1, 2)), (1, (1, 3, 2))]
    yield "derived", given(55, derived=layer([0, 1, 5, 6], part))
    yield "derived_and_moved", given(55, derived=layer([0, 1, 5, 6], part, [4, ZERO + 3]))
    yield "derived_of_deleted", given(2 | DELETE_VERTICES, (2, 3), 2, layer([0, 1, 5, 6], part))
    yield "derived_source_out_of_range", given(0, derived=layer([0, 1, 25, 6], part))
    yield "derived_face_out_of_range", given(0, derived=layer([0, 1, 5, 6], [(0, (0, 1, 4))]))
    yield "derived_positions_too_few", given(0, derived=layer([0, 1, 5, 6], part, [2, ZERO]))


if __name__ == "__main__":
    for name, data in seeds():
        (pathlib.Path(sys.argv[1]) / name).write_bytes(data)
