"""What the tools share: meshes as arrays, MeshLab's own smoothing filters with grids of parameters, and measures.

Vertices are #V by 3, faces #F by 3. Lengths are in mesh units unless a name says otherwise.
"""

import dataclasses
import pathlib
import sys
import time

import numpy as np
import pymeshlab
import pyvista

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUILD = ROOT / "build/pymeshlab-2025.07"
BUNNY = pathlib.Path(pymeshlab.__file__).parent / "tests/sample_meshes/bunny.obj"
PYRAMID = "compute_multires_pyramid"
DENOISE = "apply_coord_multires_denoise"
EQUALIZER_GAINS = (0, 0, 1, 2.5, 2.5, 1, 1, 1)  # what demo and comparison show of the equalizer


# ---- meshes ----------------------------------------------------------------------------------------------------------


def load_plugins(folder=BUILD / "plugins"):
    """Our filters into pymeshlab; ends the program if they are not built."""
    plugins = sorted(folder.glob("*.so"))
    if not plugins:
        sys.exit(f"No plugins in {folder}: run scripts/demo.sh, which builds them.")
    for plugin in plugins:
        pymeshlab.load_plugin(str(plugin))


def document(vertices=None, faces=None):
    """A document of pymeshlab, with the mesh if one is given."""
    ms = pymeshlab.MeshSet(verbose=False)
    if vertices is not None:
        ms.add_mesh(pymeshlab.Mesh(vertices, faces))
    return ms


def arrays(mesh):
    return mesh.vertex_matrix(), mesh.face_matrix()


def read(path):
    ms = document()
    ms.load_new_mesh(str(path))
    return arrays(ms.current_mesh())


def referenced(v, f):
    """The mesh without the vertices that no face has."""
    used = np.zeros(len(v), dtype=bool)
    used[f] = True
    return v[used], (np.cumsum(used) - 1)[f].astype(f.dtype)


def edge_length(v, f):
    """Mean over the corners of all faces."""
    return np.mean([np.linalg.norm(v[f[:, k]] - v[f[:, k - 1]], axis=1).mean() for k in range(3)])


def normals(v, f):
    """Unit normals of the faces, and of the vertices."""
    n = np.cross(v[f[:, 1]] - v[f[:, 0]], v[f[:, 2]] - v[f[:, 0]])
    at = np.zeros_like(v)
    for k in range(3):
        np.add.at(at, f[:, k], n)
    return tuple(m / np.maximum(np.linalg.norm(m, axis=1, keepdims=True), 1e-300) for m in (n, at))


def with_noise(v, f, kind, deviation, seed):
    """Gaussian noise along the normals with this deviation in edge lengths; kind "all directions" has it in all, "one
    axis" along a fixed one, "impulsive" at one vertex in seven only; "quantised" rounds the coordinates. The same seed makes the same noise."""
    random = np.random.default_rng(seed)
    size = deviation * edge_length(v, f)
    if kind == "all directions":
        return v + size * random.normal(size=v.shape)
    if kind == "one axis":
        return v + size * random.normal(size=len(v))[:, None] * np.array([0.36, 0.48, 0.8])
    if kind == "quantised":  # rounded to a grid whose errors have this deviation in each coordinate
        step = size * 12**0.5
        return np.round(v / step + 0.37) * step - 0.37 * step
    amount = size * random.normal(size=len(v))
    if kind == "impulsive":
        amount[random.random(len(v)) > 1 / 7] = 0
    return v + amount[:, None] * normals(v, f)[1]


# ---- filters ---------------------------------------------------------------------------------------------------------


@dataclasses.dataclass(frozen=True)
class Setting:
    """A filter with parameters; `times`: applied so often, for a filter that has no such parameter of its own."""

    filter: str
    parameters: dict = dataclasses.field(default_factory=dict)
    times: int = 1

    def words(self):
        """The parameters as a reader wants them: "stepsmoothnum 20, mu -0.53"."""
        said = [f"{key.rstrip('_')} {value_words(value)}" for key, value in self.parameters.items()]
        return ", ".join([*said, *([f"applied {self.times} times"] if self.times > 1 else [])]) or "defaults"


def value_words(value):
    if isinstance(value, pymeshlab.PercentageValue):
        return f"{value.value():g} %"
    return str(value).lower() if isinstance(value, bool) else f"{value:g}" if isinstance(value, float) else str(value)


def run(setting, v, f):
    """(vertices, seconds) of the filter on a document of its own; loading the mesh does not count."""
    ms = document(v, f)
    start = time.perf_counter()
    for _ in range(setting.times):
        ms.apply_filter(setting.filter, **setting.parameters)
    seconds = time.perf_counter() - start
    return ms.current_mesh().vertex_matrix(), seconds


def _laplacian(cotangent):
    return [Setting("apply_coord_laplacian_smoothing", {"stepsmoothnum": n, "cotangentweight": cotangent})
            for n in (1, 2, 3, 5, 10, 20)]  # fmt: skip


TAUBIN = [
    Setting("apply_coord_taubin_smoothing", {"lambda_": factor, "mu": mu, "stepsmoothnum": n})
    for factor, mu in ((0.5, -0.53), (0.33, -0.34)) for n in (5, 10, 20, 50, 100)
]  # fmt: skip
TWO_STEPS = [
    Setting("apply_coord_two_steps_smoothing", {"stepsmoothnum": n, "normalthr": angle})
    for n in (1, 2, 3, 6) for angle in (15, 30, 60)
]  # fmt: skip
LAPLACIAN_20 = Setting("apply_coord_laplacian_smoothing", {"stepsmoothnum": 20, "cotangentweight": True})

# MeshLab's own smoothing filters: name in the tables and the settings that are tried where the truth is known.
SMOOTHERS = {
    "Laplacian, umbrella": _laplacian(False),
    "Laplacian, cotangent": _laplacian(True),
    "Taubin": TAUBIN,
    "HC Laplacian": [Setting("apply_coord_hc_laplacian_smoothing", {}, n) for n in (1, 2, 3, 5, 10, 20)],
    "Two-step": TWO_STEPS,
    "Scale-dependent Laplacian": [
        Setting("apply_coord_laplacian_smoothing_scale_dependent",
                {"stepsmoothnum": n, "delta": pymeshlab.PercentageValue(percent)})
        for n in (3, 10, 30) for percent in (0.01, 0.1, 1)
    ],
}  # fmt: skip
UNSHARP_MASKS = [
    Setting("apply_coord_unsharp_mask", {"weight": weight, "iterations": n})
    for n in (5, 10, 20, 40) for weight in (0.1, 0.3, 1.0, 2.0)
]  # fmt: skip


# ---- measures --------------------------------------------------------------------------------------------------------


def closed(f):
    """True if every edge has two faces."""
    edges = np.sort(np.concatenate([f[:, [0, 1]], f[:, [1, 2]], f[:, [2, 0]]]), axis=1)
    return (np.unique(edges, axis=0, return_counts=True)[1] == 2).all()


def volume(v, f):
    a, b, c = (v[f[:, k]] - v.mean(axis=0) for k in range(3))
    return np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6


def area(v, f):
    return np.linalg.norm(np.cross(v[f[:, 1]] - v[f[:, 0]], v[f[:, 2]] - v[f[:, 0]]), axis=1).sum() / 2


def signed_distance(v, f, to_v, to_f):
    """At each vertex: distance to the other surface, positive outside it."""
    ms = document(v, f)
    ms.add_mesh(pymeshlab.Mesh(to_v, to_f))
    ms.compute_scalar_by_distance_from_another_mesh_per_vertex(
        measuremesh=0, refmesh=1, signeddist=True, maxdist=pymeshlab.PercentageValue(50)
    )
    return ms.mesh(0).vertex_scalar_array()


def distance(v, f, truth, truth_f):
    """(root of the mean square, largest) distance from the vertices of each surface to the other."""
    ways = [signed_distance(v, f, truth, truth_f), signed_distance(truth, truth_f, v, f)]
    return np.sqrt(np.mean([np.square(d).mean() for d in ways])), max(np.abs(d).max() for d in ways)


def same_faces(f, truth_f):
    return f.shape == truth_f.shape and (f == truth_f).all()


def normal_angles(v, f, truth, truth_f):
    """Degrees between the normal of each face and that of the truth: of the same face if the faces are the same,
    otherwise of the nearest one."""
    wanted = normals(truth, truth_f)[0]
    if not same_faces(f, truth_f):
        surface = pyvista.PolyData.from_regular_faces(truth, truth_f)
        wanted = wanted[surface.find_closest_cell(v[f].mean(axis=1))]
    cosine = np.einsum("ij,ij->i", normals(v, f)[0], wanted)
    return np.degrees(np.arccos(np.clip(cosine, -1, 1)))


def shape(v, f):
    """Of each face: 1 if equilateral, 0 if degenerate (area over the sum of the squared edges, scaled)."""
    squares = sum(np.square(v[f[:, k]] - v[f[:, k - 1]]).sum(axis=1) for k in range(3))
    doubled = np.linalg.norm(np.cross(v[f[:, 1]] - v[f[:, 0]], v[f[:, 2]] - v[f[:, 0]]), axis=1)
    return 2 * np.sqrt(3) * doubled / np.maximum(squares, 1e-300)


def tangential(v, f, before):
    """At each vertex: the part of its way from `before` that lies in the surface before."""
    way = v - before
    n = normals(before, f)[1]
    return np.linalg.norm(way - np.einsum("ij,ij->i", way, n)[:, None] * n, axis=1)


def measures(v, f, truth, truth_f):
    """Of a mesh and its truth: mean angle of the normals (degrees), RMS and largest distance (in edge lengths of the
    truth), change of volume (percent, not a number if either is open) and of area (percent), and the number of faces
    turned by more than 90 degrees."""
    angles = normal_angles(v, f, truth, truth_f)
    rms, largest = (d / edge_length(truth, truth_f) for d in distance(v, f, truth, truth_f))
    both_closed = closed(f) and closed(truth_f)
    change = 100 * (volume(v, f) / volume(truth, truth_f) - 1) if both_closed else float("nan")
    return {"angle": angles.mean(), "rms": rms, "largest": largest, "volume": change,
            "area": 100 * (area(v, f) / area(truth, truth_f) - 1), "folded": int((angles > 90).sum())}  # fmt: skip


# ---- output ----------------------------------------------------------------------------------------------------------


def table(rows, header):
    """Markdown, columns aligned."""
    cells = [header, *rows]
    widths = [max(len(row[i]) for row in cells) for i in range(len(header))]
    lines = ["| " + " | ".join(c.rjust(w) for c, w in zip(row, widths)) + " |" for row in cells]
    lines.insert(1, "|" + "|".join("-" * (w + 1) + ":" for w in widths) + "|")
    return "\n".join(lines) + "\n"
