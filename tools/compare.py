"""MeshLab's own smoothing filters and ours side by side on one mesh: pictures, error maps, spectra and figures.

    .venv/bin/python tools/compare.py [MESH] [--truth MESH | --noise SIGMA] [--output DIR]

Writes one self-contained page, DIR/comparison.html. With --truth the mesh without its noise is known; with --noise
Gaussian noise along the normals, SIGMA in mean edge lengths, is added to MESH, which is then the truth. MeshLab's
smoothers are then run with every setting of a grid and shown at the one with the least error of the normals, which
only somebody who has the truth can find; ours run with their defaults. Without a truth all run with their defaults and
are compared with the input.

Every filter works on a document of its own. Times are medians of --repeats runs and include building the pyramid.
"""

import argparse
import dataclasses
import pathlib
import statistics
import sys

import numpy as np
import pymeshlab

import report
from features_compare import creases
from measuring import (BUILD, BUNNY, DENOISE, EQUALIZER_GAINS, PYRAMID, SMOOTHERS, UNSHARP_MASKS, Setting, document,
                       edge_length, load_plugins, measures, read, referenced, run, same_faces, shape,
                       signed_distance, tangential, with_noise)  # fmt: skip
from transmission import FORMULAS, harmonic, irregular_sphere

ROUGHNESS, TEXTURE = "compute_multires_roughness", ("sa", "sq", "sp", "sv", "sz", "ssk", "sku", "sdq", "sdr")
CREASE = 30  # degrees

# Ours: title, setting, what to say of the setting where it is not the defaults.
OUR_SMOOTHERS = (
    ("Denoise", Setting(DENOISE), None),
    ("Low pass", Setting("apply_coord_multires_low_pass"), None),
    ("Low pass, spline", Setting("apply_coord_multires_low_pass", {"method": "spline"}), "method spline, else defaults"),
    ("Denoise, soft threshold", Setting(DENOISE, {"method": "soft threshold"}), "method soft threshold, else defaults"),
)
OUR_BANDS = (
    ("Enhance", Setting("apply_coord_multires_enhance"), None),
    ("Equalizer", Setting("apply_coord_multires_equalizer",
                          {f"gain_{i + 1}": float(g) for i, g in enumerate(EQUALIZER_GAINS)}),
     "gains " + " ".join(f"{g:g}" for g in EQUALIZER_GAINS) + " (the default, all 1, changes nothing)"),
    ("Stop band", Setting("apply_coord_multires_stop_band"), None),
    ("Unsharp (single level)", Setting("apply_coord_multires_unsharp"), None),
)  # fmt: skip


@dataclasses.dataclass
class Case:
    """What is compared. Without a truth, `truth` is the input itself and `truth_known` false."""

    name: str
    vertices: np.ndarray
    faces: np.ndarray
    truth: np.ndarray
    truth_faces: np.ndarray
    truth_known: bool
    noise: float | None = None  # in edge lengths, where this program added it

    @property
    def edge(self):
        return edge_length(self.truth, self.truth_faces)

    def original(self):
        """The case without noise and without a task of finding it: what filters of bands are shown on."""
        return Case(self.name, self.truth, self.truth_faces, self.truth, self.truth_faces, False)


@dataclasses.dataclass
class Outcome:
    """One filter on the case (or none: the input, the truth). figures: see describe(); levels: wavelengths and RMS
    details of the pyramid of the result; error: signed distance to the truth at each vertex; moved: the way of each
    vertex from the input."""

    title: str
    ours: bool | None  # None: no filter
    words: str
    vertices: np.ndarray
    faces: np.ndarray
    figures: dict
    levels: tuple
    shapes: np.ndarray
    error: np.ndarray
    moved: np.ndarray
    setting: Setting | None = None
    tried: int = 1
    least_rms: tuple | None = None  # the least RMS distance of all settings tried, and the words of that setting


def spectrum(v, f):
    """Wavelengths and RMS details of the levels, finest first; the base level has no details."""
    levels = document(v, f).apply_filter(PYRAMID)
    return levels["wavelength"][:-1], levels["rms_detail"][:-1]


def describe(case, title, v, f, ours=None, words="", seconds=None, **more):
    """Measures one result. Lengths among the figures are in edge lengths of the truth."""
    figures = measures(v, f, case.truth, case.truth_faces)
    figures |= {"seconds": seconds, "shape": float(shape(v, f).mean()), "moved": 0.0, "drift": 0.0}
    moved = np.zeros(len(v))
    if same_faces(f, case.faces):
        moved = np.linalg.norm(v - case.vertices, axis=1)
        figures["moved"] = float(np.sqrt(np.square(moved).mean()) / case.edge)
        figures["drift"] = float(np.sqrt(np.square(tangential(v, f, case.vertices)).mean()) / case.edge)
    return Outcome(title, ours, words, v, f, figures, spectrum(v, f), shape(v, f),
                   signed_distance(v, f, case.truth, case.truth_faces), moved, **more)  # fmt: skip


def timed(setting, case, repeats):
    """(vertices, median of the seconds)"""
    runs = [run(setting, case.vertices, case.faces) for _ in range(repeats)]
    return runs[0][0], statistics.median(seconds for _, seconds in runs)


def own(case, filters, repeats):
    """Our filters."""
    for title, setting, words in filters:
        print(f"  {title}", file=sys.stderr)
        v, seconds = timed(setting, case, repeats)
        yield describe(case, title, v, case.faces, True, words or "defaults", seconds, setting=setting)


def tuned(case, title, settings, repeats):
    """One filter of MeshLab at the setting of the grid with the least error of the normals."""
    print(f"  MeshLab: {title}, {len(settings)} settings", file=sys.stderr)
    tried = []
    for setting in settings:
        figures = measures(run(setting, case.vertices, case.faces)[0], case.faces, case.truth, case.truth_faces)
        tried.append((figures["angle"], figures["rms"], setting))
    best = min(tried, key=lambda t: t[0])[2]
    _, rms, nearest = min(tried, key=lambda t: t[1])
    v, seconds = timed(best, case, repeats)
    return describe(case, title, v, case.faces, False, best.words(), seconds, setting=best, tried=len(settings),
                    least_rms=(rms, nearest.words()))  # fmt: skip


def default_of(setting):
    """The same filter with its defaults, but for the weights that give the variant its name."""
    return Setting(setting.filter, {k: v for k, v in setting.parameters.items() if k == "cotangentweight"})


def by_default(case, title, settings, repeats):
    """One filter of MeshLab with its defaults."""
    setting = default_of(settings[0])
    print(f"  MeshLab: {title}", file=sys.stderr)
    v, seconds = timed(setting, case, repeats)
    return describe(case, title, v, case.faces, False, setting.words(), seconds, setting=setting)


def matched_mask(case, moved, repeats):
    """MeshLab's unsharp mask at the setting that moves vertices as far as our Enhance does: no truth says how sharp a
    mesh should be, so that only the same strength can be compared."""
    print(f"  MeshLab: unsharp mask, {len(UNSHARP_MASKS)} settings", file=sys.stderr)

    def distance_of(setting):
        way = np.linalg.norm(run(setting, case.vertices, case.faces)[0] - case.vertices, axis=1)
        return abs(np.log(max(np.sqrt(np.square(way).mean()) / case.edge, 1e-12) / max(moved, 1e-12)))

    best = min(UNSHARP_MASKS, key=distance_of)
    v, seconds = timed(best, case, repeats)
    return describe(case, "Unsharp mask, geometry", v, case.faces, False, best.words(), seconds, setting=best,
                    tried=len(UNSHARP_MASKS))  # fmt: skip


def transmissions():
    """Title, whether ours, wavelengths in mean edges and shares that are left of them: of waves so low that filters are
    linear, on an irregular sphere. MeshLab's smoothers with their defaults, our spline filter with a cutoff of 10 edges,
    and its formula."""
    print("  transmission", file=sys.stderr)
    v, f = irregular_sphere(5000)
    edge = edge_length(v, f)
    low_pass = {"unit": "wavelength", "cutoff": 10 * edge}
    settings = [("Low pass, spline", True, Setting(OUR_SMOOTHERS[2][1].filter, low_pass | {"method": "spline"}))]
    settings += [(title, False, default_of(first)) for title, (first, *_) in SMOOTHERS.items()]
    degrees = np.array([2, 3, 4, 6, 8, 11, 15, 20, 28, 38])
    waves = 2 * np.pi / np.sqrt(degrees * (degrees + 1)) / edge

    def radius(setting, places):
        return np.linalg.norm(run(setting, places, f)[0], axis=1)

    for title, ours, setting in settings:
        smooth, shares = radius(setting, v), []
        for degree in degrees:
            wave = harmonic(v, degree)
            height = 0.02 * edge
            rest = radius(setting, v * (1 + height * wave)[:, None]) - smooth
            shares.append(float(rest @ wave / (wave @ wave) / height))
        yield title, ours, waves.tolist(), shares
    fine = np.geomspace(waves.min(), waves.max(), 100)
    yield "Formula", None, fine.tolist(), FORMULAS["2"]((10 / fine) ** 2).tolist()


@dataclasses.dataclass
class Reading:
    """What a filter says of the vertices of a mesh, and in which colours to show it: from `least` to `most`, the
    finite values; those that are not are left white."""

    title: str
    ours: bool
    words: str
    values: np.ndarray
    colors: str
    least: float
    most: float


def readings(case):
    """Filters that measure or select, ours and MeshLab's for the purpose, on a mesh, with their defaults."""
    print("  readings", file=sys.stderr)
    v, f = case.vertices, case.faces

    def quality(name, **parameters):
        ms = document(v, f)
        ms.apply_filter(name, **parameters)
        return ms.current_mesh().vertex_scalar_array()

    def selected():
        ms = document(v, f)
        ms.apply_filter("compute_selection_multires_features", select="vertices")
        return ms.current_mesh().vertex_selection_array()

    def spread(values):
        return [float(q) for q in np.quantile(values, (0.03, 0.97))]

    def marked(on):
        return np.where(on, 1.0, np.nan), "Reds", 0.0, 1.3

    relief = quality("compute_scalar_multires_relief_per_vertex")
    most = float(np.quantile(np.abs(relief), 0.97)) or 1e-9
    yield Reading("Relief", True, "height over the low pass", relief, "RdBu_r", -most, most)
    dark = quality("compute_scalar_ambient_occlusion")
    yield Reading("Ambient occlusion", False, "no unit", dark, "gray", *spread(dark))
    scale = np.log(quality("compute_custom_multires_scales"))
    yield Reading("Details by scale", True, "wavelength of the strongest band", scale, "viridis", *spread(scale))
    bent = quality("compute_scalar_by_discrete_curvature_per_vertex")
    yield Reading("Discrete mean curvature", False, "per length", bent, "viridis", *spread(bent))
    yield Reading("Select Features", True, "lines over scales", *marked(selected()))
    yield Reading("Creases", False, f"edges bent by {CREASE} degrees", *marked(creases(v, f, CREASE)))


def textures(case, outcomes):
    """ISO 25178 parameters of results, over the low pass at 10 mean edges: outcome, name -> number; lengths in edges."""
    print("  roughness", file=sys.stderr)
    limit, rows = 10 * case.edge, []
    for o in outcomes:
        found = document(o.vertices, o.faces).apply_filter(ROUGHNESS, form="low pass", l_filter=limit)
        units = dict.fromkeys(("sa", "sq", "sp", "sv", "sz"), case.edge)
        rows.append((o, {k: found[k] / units.get(k, 1) for k in TEXTURE}))
    return rows


def compare(case, repeats):
    """(input and truth, smoothers, the original mesh, filters of bands): lists of outcomes."""
    inputs = [describe(case, "Noisy input" if case.truth_known else "Input", case.vertices, case.faces)]
    if case.truth_known:
        inputs.append(describe(case, "Truth", case.truth, case.truth_faces))
    smoothers = list(own(case, OUR_SMOOTHERS, repeats))
    smoothers += [(tuned if case.truth_known else by_default)(case, title, settings, repeats)
                  for title, settings in SMOOTHERS.items()]  # fmt: skip
    original = case.original()
    bands = list(own(original, OUR_BANDS, repeats))
    bands.append(matched_mask(original, bands[0].figures["moved"], repeats))
    return inputs, smoothers, [describe(original, "Original", original.vertices, original.faces)], bands


def read_case(mesh, truth, noise):
    """The case that the command line asks for."""
    v, f = referenced(*read(mesh))
    if noise is not None:
        return Case(mesh.stem, with_noise(v, f, "normals", noise, seed=1), f, v, f, True, noise)
    if truth is not None:
        return Case(mesh.stem, v, f, *referenced(*read(truth)), True)
    return Case(mesh.stem, v, f, v, f, False)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("mesh", type=pathlib.Path, nargs="?", default=BUNNY, help="by default the Stanford bunny")
    known = parser.add_mutually_exclusive_group()
    known.add_argument("--truth", type=pathlib.Path, help="the mesh without its noise; best with the same faces")
    known.add_argument(
        "--noise", type=float, help="add noise of this deviation, in mean edge lengths; MESH is the truth"
    )
    parser.add_argument("--output", type=pathlib.Path, default=pathlib.Path("demo-output"))
    parser.add_argument("--build", type=pathlib.Path, default=BUILD)
    parser.add_argument(
        "--up", choices=("x", "y", "z", "-x", "-y", "-z"), help="the axis that points up in the pictures"
    )
    parser.add_argument("--repeats", type=int, default=3, help="runs for the times")
    parser.add_argument("--tile", type=int, default=440, help="side of one picture, pixels")
    arguments = parser.parse_args()
    if arguments.noise is not None and not arguments.noise > 0:
        parser.error("--noise must be above 0")

    load_plugins(arguments.build / "plugins")
    try:
        case = read_case(arguments.mesh, arguments.truth, arguments.noise)
        if not len(case.faces) or not len(case.truth_faces):
            sys.exit(f"{arguments.mesh}: a mesh with faces is needed")
        results = compare(case, arguments.repeats)
        curves = list(transmissions())
        read_off = list(readings(case.original()))
        rough = textures(case, [*results[0], *results[1]])
    except pymeshlab.PyMeshLabException as error:
        sys.exit(f"{arguments.mesh}: {error}")
    print("  pictures", file=sys.stderr)
    page = report.page(case, *results, curves, read_off, rough, up=arguments.up, tile=arguments.tile)
    arguments.output.mkdir(parents=True, exist_ok=True)
    path = arguments.output / "comparison.html"
    path.write_text(page, encoding="utf-8")
    print(f"The comparison is in {path}")


if __name__ == "__main__":
    main()
