"""How well a scan follows its proxy: edits with a known truth, beside corners that are interpolated in one band.

    .venv/bin/python tools/edit_bench.py [MESH ...] [--vertices 500 2000] [--build BUILD]

The proxy is MeshLab's quadric decimation; proxy and scan are mapped by the same formula, so the truth is known: twists of
45 and 120 degrees about the longest axis of the box, bends of 90 and 180, a pull of a fifth of the diagonal at one end,
a scale of 1.5, 0.8 and 1.1 along the axes. Printed for each: root mean square distance of the vertices to the truth in
percent of the diagonal, mean angle between the normals of the faces and the truth's in degrees, faces that lie the other
way round than the truth's, and faces that cut others (MeshLab's selection of them) beyond those of the truth; for

- one band: the closest point of the proxy, its corners' displacements interpolated and the offset turned with them
  (what surface deformers do);
- surface deform (Blender, package bpy), biharmonic displacement and as-rigid-as-possible (package libigl), where they are
  installed;
- phong 1, phong 5, frames: Follow Edited Layer with these encodings, phong with one and with five bands;
- gradient: Follow Edited Layer without a parameter, and its seconds.
"""

import argparse
import pathlib
import statistics
import time

import numpy as np
import pymeshlab
import pyvista
import reference_editors
from measuring import BUILD, BUNNY, arrays, document, load_plugins, normals, read, referenced, table

FOLLOW = "apply_coord_multires_transfer_edit"


# ---- edits -----------------------------------------------------------------------------------------------------------


def frame(box):
    """The longest axis and the two others, the shortest first; the middle and the extent of the box."""
    low, high = box
    size = high - low
    shortest, middle, longest = np.argsort(size)
    return longest, shortest, middle, (low + high) / 2, size


def twist(degrees):
    def edit(p, box):
        axis, i, j, centre, size = frame(box)
        angle = np.radians(degrees) * (p[:, axis] - box[0][axis]) / size[axis]
        x, y, q = p[:, i] - centre[i], p[:, j] - centre[j], p.copy()
        q[:, i] = centre[i] + x * np.cos(angle) - y * np.sin(angle)
        q[:, j] = centre[j] + x * np.sin(angle) + y * np.cos(angle)
        return q

    return edit


def bend(degrees):
    def edit(p, box):
        axis, i, _, centre, size = frame(box)
        radius = size[axis] / np.radians(degrees)
        angle, r, q = (p[:, axis] - centre[axis]) / radius, radius - (p[:, i] - centre[i]), p.copy()
        q[:, axis] = centre[axis] + r * np.sin(angle)
        q[:, i] = centre[i] + radius - r * np.cos(angle)
        return q

    return edit


def pull(p, box):
    axis, _, _, centre, size = frame(box)
    end, diagonal = centre.copy(), np.linalg.norm(size)
    end[axis] = box[1][axis]
    near = np.clip(1 - (np.linalg.norm(p - end, axis=1) / (0.25 * diagonal)) ** 2, 0, None) ** 2
    return p + 0.2 * diagonal * near[:, None] * np.ones(3) / np.sqrt(3)


def scale(p, box):
    return p * [1.5, 0.8, 1.1]


EDITS = {"twist 45": twist(45), "twist 120": twist(120), "bend 90": bend(90), "bend 180": bend(180), "pull": pull,
         "scale": scale}  # fmt: skip


# ---- ways to follow --------------------------------------------------------------------------------------------------


def decimated(v, f, vertices):
    ms = document(v, f)
    ms.meshing_decimation_quadric_edge_collapse(targetfacenum=2 * vertices, preservenormal=True)
    return referenced(*arrays(ms.current_mesh()))


def one_band(v, before, after, faces):
    """Closest point, interpolated displacement, offset in the frame of interpolated normals."""
    surface = pyvista.PolyData(before, np.hstack([np.full((len(faces), 1), 3), faces]))
    cell, foot = surface.find_closest_cell(v, return_closest_point=True)
    corner = faces[cell]
    a, b, c = (before[corner[:, k]] for k in range(3))
    area = np.cross(b - a, c - a)
    squared = np.maximum((area**2).sum(axis=1), 1e-300)
    weight = np.stack([(np.cross(b - foot, c - foot) * area).sum(axis=1) / squared,
                       (np.cross(c - foot, a - foot) * area).sum(axis=1) / squared,
                       (np.cross(a - foot, b - foot) * area).sum(axis=1) / squared], axis=1)  # fmt: skip

    def axes(positions):
        n = (weight[:, :, None] * normals(positions, faces)[1][corner]).sum(axis=1)
        n /= np.maximum(np.linalg.norm(n, axis=1, keepdims=True), 1e-300)
        t = positions[corner[:, 1]] - positions[corner[:, 0]]
        t -= (t * n).sum(axis=1, keepdims=True) * n
        t /= np.maximum(np.linalg.norm(t, axis=1, keepdims=True), 1e-300)
        return np.stack([t, np.cross(n, t), n], axis=1)

    foot_after = (weight[:, :, None] * after[corner]).sum(axis=1)
    local = np.einsum("nij,nj->ni", axes(before), v - foot)
    return foot_after + np.einsum("nij,ni->nj", axes(after), local)


def followed(v, f, before, after, faces, **parameters):
    """The result and seconds."""
    ms = document(v, f)
    ms.add_mesh(pymeshlab.Mesh(before, faces))
    ms.add_mesh(pymeshlab.Mesh(after, faces))
    ms.set_current_mesh(0)
    begin = time.perf_counter()
    ms.apply_filter(FOLLOW, before=1, edited=2, **parameters)
    return ms.current_mesh().vertex_matrix(), time.perf_counter() - begin


def crossing(v, f):
    ms = document(v, f)
    ms.compute_selection_by_self_intersections_per_face()
    return ms.current_mesh().selected_face_number()


def errors(v, f, result, truth):
    """RMS in percent of the diagonal, degrees, faces the other way round, faces that cut others beyond the truth's."""
    rms = np.sqrt(((result - truth) ** 2).sum(axis=1).mean()) / np.linalg.norm(np.ptp(v, axis=0))
    cosine = (normals(result, f)[0] * normals(truth, f)[0]).sum(axis=1)
    with_area = np.linalg.norm(normals(v, f)[0], axis=1) > 0.5
    angle = np.degrees(np.arccos(np.clip(cosine[with_area], -1, 1))).mean()
    return 100 * rms, angle, int((cosine < 0).sum()), crossing(result, f) - crossing(truth, f)


OURS = {"phong 1": {"encoding": "phong", "bands": 1}, "phong 5": {"encoding": "phong"}, "frames": {"encoding": "frames"},
        "gradient": {}}  # fmt: skip


def cases(v, f, vertices):
    """Vertices of the proxy, the edit, errors by way, seconds of the last of ours."""
    box = v.min(axis=0), v.max(axis=0)
    others = {"one band": lambda v, f, *proxy: one_band(v, *proxy), **reference_editors.installed()}
    for count in vertices:
        before, faces = decimated(v, f, count)
        for name, edit in EDITS.items():
            after, truth = edit(before, box), edit(v, box)
            results = {way: function(v, f, before, after, faces) for way, function in others.items()}
            for way, parameters in OURS.items():
                results[way], seconds = followed(v, f, before, after, faces, **parameters)
            measured = {way: None if result is None else errors(v, f, result, truth) for way, result in results.items()}
            yield len(before), name, measured, seconds


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("meshes", nargs="*", type=pathlib.Path, default=[BUNNY])
    parser.add_argument("--vertices", nargs="*", type=int, default=[500, 2000], help="of the proxies")
    parser.add_argument("--build", type=pathlib.Path, default=BUILD)
    arguments = parser.parse_args()
    load_plugins(arguments.build / "plugins")
    rows, ratios, ways = [], [], []
    for path in arguments.meshes:
        v, f = referenced(*read(path))
        for count, name, measured, seconds in cases(v, f, arguments.vertices):
            ways = list(measured)
            words = ["refuses" if e is None else "{:.4f}, {:.2f}, {}, {}".format(*e) for e in measured.values()]
            rows.append([path.stem, str(count), name, *words, f"{seconds:.2f}"])
            print("|", " | ".join(rows[-1]), "|", flush=True)
            theirs = [e for way, e in measured.items() if e and way not in ("frames", "phong 5", "gradient")]
            ratios.append([measured["gradient"][k] / min(e[k] for e in theirs) for k in (0, 1)])
    print(table(rows, ["mesh", "proxy", "edit", *ways, "seconds"]))
    rms, angle = zip(*ratios)
    print(f"gradient / best of the others, median (worst): RMS {statistics.median(rms):.2f} ({max(rms):.2f}), "
          f"normals {statistics.median(angle):.2f} ({max(angle):.2f})")  # fmt: skip


if __name__ == "__main__":
    main()
