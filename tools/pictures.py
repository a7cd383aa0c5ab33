"""Makes the pictures of the README and the parameter reference: every filter, before and after.

    .venv/bin/python tools/pictures.py [--only NAME ...]

They go to docs/pictures/, one NAME.webp a filter, and top.webp for the head of the README. The mesh is the bunny that
comes with pymeshlab; noise and paint are added here.
"""

import argparse
import pathlib
import sys

import numpy as np
import pymeshlab

import rendering
from filter_tables import FUNCTIONS
from measuring import (BUNNY, DENOISE, ROOT, Setting, TAUBIN, arrays, document, load_plugins, normal_angles, normals, read, run,
                       with_noise)  # fmt: skip
from rendering import Panel

FOLDER = ROOT / "docs/pictures"
PERCENT = {"unit": "wavelength percent"}
VALUES = "viridis"  # colour map of scalars


# ---- inputs ----------------------------------------------------------------------------------------------------------


def stripes(v):
    """Two colours in stripes, with noise: #V by 4."""
    random = np.random.default_rng(1)
    height = (v - v.min(axis=0)) / np.ptp(v, axis=0).max()
    stripe = (np.floor(9 * height[:, 1:2]) % 2).astype(float)
    colors = stripe * [0.88, 0.5, 0.2, 1] + (1 - stripe) * [0.18, 0.42, 0.66, 1]
    colors[:, :3] = np.clip(colors[:, :3] + 0.25 * random.normal(size=(len(v), 3)), 0, 1)
    return colors


def waves(v):
    """A scalar with long waves and fine noise."""
    scale = np.ptp(v, axis=0).max()
    return (
        np.sin(9 * v[:, 0] / scale) + np.cos(7 * v[:, 1] / scale) + 0.6 * np.random.default_rng(2).normal(size=len(v))
    )


def with_colors(v, f):
    ms = document()
    ms.add_mesh(pymeshlab.Mesh(vertex_matrix=v, face_matrix=f, v_color_matrix=stripes(v)))
    return ms


def with_scalar(v, f):
    ms = document(v, f)
    ms.current_mesh().add_vertex_custom_scalar_attribute(waves(v), "waves")
    return ms


def noisy(v, f):
    return document(with_noise(v, f, "normals", 0.2, seed=1), f)


def warped(v, f):
    """Two layers: the mesh, and on top a copy with a swelling of long waves and with noise."""
    scale = np.ptp(v, axis=0).max()
    swelling = 0.01 * scale * np.sin(11 * v[:, 1:2] / scale) * np.sin(9 * v[:, 0:1] / scale)
    ms = document(v, f)
    noise = with_noise(v, f, "normals", 0.2, seed=1)
    ms.add_mesh(pymeshlab.Mesh(noise + swelling * ms.current_mesh().vertex_normal_matrix(), f))
    return ms


def edited(v, f):
    """Three layers: the mesh, a decimated copy, and that with its upper half bent and turned; the mesh is current."""
    ms = document(v, f)
    ms.generate_copy_of_current_mesh()
    ms.meshing_decimation_quadric_edge_collapse(targetfacenum=600)
    proxy, faces = arrays(ms.current_mesh())
    low, size = v.min(axis=0), np.ptp(v, axis=0)
    height = np.clip((proxy[:, 1] - low[1]) / size[1] - 0.45, 0, None)
    centre = low + [0.3 * size[0], 0.45 * size[1], 0.5 * size[2]]
    turn, bend = 0.9 * height, 1.1 * height
    x, y, z = (proxy - centre).T
    x, z = x * np.cos(turn) + z * np.sin(turn), z * np.cos(turn) - x * np.sin(turn)
    x, y = x * np.cos(bend) - y * np.sin(bend), y * np.cos(bend) + x * np.sin(bend)
    ms.add_mesh(pymeshlab.Mesh(np.column_stack([x, y, z]) + centre, faces))
    ms.set_current_mesh(0)
    return ms


def remeshed(v, f):
    """Two layers: the mesh, and on top a remeshed and smoothed copy."""
    ms = document(v, f)
    ms.generate_copy_of_current_mesh()
    ms.meshing_isotropic_explicit_remeshing(iterations=3, targetlen=pymeshlab.PercentageValue(0.5))
    ms.apply_coord_laplacian_smoothing(stepsmoothnum=12)
    return ms


def head(v, f):
    """The mesh with its head selected."""
    ms = document(v, f)
    low, size = v.min(axis=0), np.ptp(v, axis=0)
    ms.compute_selection_by_condition_per_vertex(
        condselect=f"(y > {low[1] + 0.78 * size[1]}) || ((x < {low[0] + 0.4 * size[0]}) && (y > {low[1] + 0.6 * size[1]}))"
    )
    return ms


# ---- looks -----------------------------------------------------------------------------------------------------------


def shaded(title, words, ms):
    return Panel(title, words, *arrays(ms.current_mesh()))


def painted(title, words, ms):
    return Panel(title, words, *arrays(ms.current_mesh()), ms.current_mesh().vertex_color_matrix()[:, :3])


def selected(title, words, ms):
    chosen = ms.current_mesh().vertex_selection_array()[:, None]
    return Panel(title, words, *arrays(ms.current_mesh()), np.where(chosen, [0.8, 0.1, 0.1], [0.87, 0.85, 0.8]))


def meshed(title, words, ms):
    return Panel(
        title, f"{ms.current_mesh().vertex_number():,} vertices{words}", *arrays(ms.current_mesh()), edges=True
    )


def custom(title, words, ms):
    values = ms.current_mesh().vertex_custom_scalar_attribute_array("waves")
    return Panel(title, words, *arrays(ms.current_mesh()), rendering.coloured(values, -2, 2, VALUES))


def quality(title, words, ms):
    values = ms.current_mesh().vertex_scalar_array()
    return Panel(title, words, *arrays(ms.current_mesh()),
                 rendering.coloured(values, *np.quantile(values, (0.02, 0.98)), VALUES))  # fmt: skip


def checkered(title, words, ms):
    """A checkerboard in the texture coordinates, drawn by small parts of the faces."""
    v, f = arrays(ms.current_mesh())
    corners = np.hstack([v[f.ravel()], ms.current_mesh().wedge_tex_coord_matrix()]).reshape(-1, 3, 5)
    for _ in range(2):  # every triangle becomes four
        a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
        ab, bc, ca = (a + b) / 2, (b + c) / 2, (c + a) / 2
        corners = np.concatenate([np.stack(t, axis=1) for t in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))])
    flat = corners.reshape(-1, 5)
    board = (np.floor(flat[:, 3:] * [24, 12]).sum(axis=1) % 2)[:, None]
    return Panel(title, words, flat[:, :3], np.arange(len(flat)).reshape(-1, 3),
                 board * [0.93, 0.91, 0.86] + (1 - board) * [0.16, 0.42, 0.46])  # fmt: skip


# ---- pictures --------------------------------------------------------------------------------------------------------

# Filter: how the input is made and looks, what is said of it; parameters; how the result looks, what is said of it.
MARK = {"message": "00c0ffee00c0ffee", "key": "a key", "selected": False}
PAIRS = {
    "compute_multires_pyramid": None,  # levels()
    "generate_multires_level": (head, meshed, "", {"level": 5, "detail_in": "selection"}, meshed, ", detail in the selection"),
    "compute_scalar_multires_detail_per_vertex": (
        document,
        shaded,
        "",
        {**PERCENT, "finest": 1, "coarsest": 6, "signed_normal": True},
        quality,
        "1 to 6 % of the box, signed",
    ),
    "compute_multires_roughness": None,  # heights()
    "apply_coord_multires_watermark": (document, shaded, "", MARK, shaded, "64 bits, RMS 0.08 % of the diagonal"),
    "compute_multires_watermark": None,  # displacement()
    "compute_scalar_multires_relief_per_vertex": None,  # stone()
    "compute_custom_multires_scales": (document, shaded, "", {"bands": 12}, quality, "wavelength that stands out, of 12 bands"),
    "compute_selection_multires_features": (document, shaded, "", {"select": "vertices"}, selected, "lines of 30 degrees"),
    "compute_scalar_multires_difference_per_vertex": (
        warped,
        shaded,
        "a warped and noisy copy",
        {"wavelength": 0.02},
        quality,
        "to the original, without the noise",
    ),
    "apply_coord_multires_low_pass": (document, shaded, "", {**PERCENT, "cutoff": 8}, shaded, "cutoff 8 % of the box"),
    "apply_coord_multires_stop_band": (
        document,
        shaded,
        "",
        {**PERCENT, "finest": 3, "coarsest": 12},
        shaded,
        "3 to 12 % removed",
    ),
    "apply_coord_multires_enhance": (
        document,
        shaded,
        "",
        {**PERCENT, "finest": 1.5, "coarsest": 12, "gain": 2.5},
        shaded,
        "1.5 to 12 %, gain 2.5",
    ),
    "apply_coord_multires_equalizer": (
        document,
        shaded,
        "",
        {"gain_1": 0, "gain_2": 0.5, "gain_3": 3, "gain_4": 3},
        shaded,
        "gains 0 0.5 3 3 1 1 1 1",
    ),
    "apply_coord_multires_unsharp": (document, shaded, "", {"xi": 3}, shaded, "xi 3, 10 steps"),
    "apply_coord_multires_denoise": (noisy, shaded, "noise of 0.2 edge lengths", {}, shaded, "no parameter given"),
    "apply_coord_multires_transfer_edit": (
        edited,
        shaded,
        "",
        {"before": 1, "edited": 2},
        shaded,
        "a proxy of 300 vertices was bent",
    ),
    "apply_coord_multires_displace": (
        head,
        shaded,
        "",
        {"falloff": 0.05, "translation": [0.005, 0.025, 0], "angle": -35, "axis": [0, 0, 1]},
        shaded,
        "the head up and back",
    ),
    "compute_scalar_multires_falloff_per_vertex": (head, shaded, "", {"falloff": 0.05}, quality, "around the head"),
    "generate_multires_base": (document, shaded, "", {"vertices": 400}, shaded, "through 400 vertices"),
    "apply_coord_multires_bands": (
        document,
        shaded,
        "",
        {"gain_1": 0, "gain_2": 2.5, "gain_3": 2, "vertices": 400},
        shaded,
        "gains 0 2.5 2 1 over a base of 400 vertices",
    ),
    "transfer_coord_multires_detail": (remeshed, shaded, "remeshed and smoothed", {}, shaded, "with the detail of the scan"),
    "apply_attributes_multires_relaxation": (
        with_colors,
        painted,
        "noise on the colours",
        {"iterations": 20},
        painted,
        "20 iterations",
    ),
    "apply_attributes_multires_band": (
        with_colors,
        painted,
        "noise on the colours",
        {**PERCENT, "cutoff": 5},
        painted,
        "low pass, cutoff 5 %",
    ),
    "apply_attributes_multires_band_custom": (
        with_scalar,
        custom,
        "a scalar with noise",
        {**PERCENT, "cutoff": 6},
        custom,
        "low pass, cutoff 6 %",
    ),
    "apply_attributes_multires_denoise": (
        with_colors,
        painted,
        "noise on the colours",
        {"strength": 1.5},
        painted,
        "strength 1.5",
    ),
    "generate_multires_texcoord": (
        document,
        shaded,
        "",
        {"projection": "cylindrical", "axis": "y"},
        checkered,
        "cylinder, checkered",
    ),
    "generate_multires_adaptive_reconstruction": (
        document,
        meshed,
        "",
        {"target": "RMS distance", "unit": "percent", "error": 0.05},
        meshed,
        ", RMS 0.05 %",
    ),
    **dict.fromkeys(name for name in FUNCTIONS if "multires_grid" in name),  # grid_picture()
}


def title_of(name):
    return FUNCTIONS[name].replace("_", " ").capitalize()


def pair(name, v, f):
    make, look, words, parameters, look_after, words_after = PAIRS[name]
    ms = make(v, f)
    before = look("Before", words or ("" if look is meshed else f"{len(v):,} vertices"), ms)
    ms.apply_filter(name, **parameters)
    return [before, look_after(title_of(name), words_after, ms)]


def levels(v, f):
    panels = []
    for level in (0, 4):
        ms = document(v, f)
        ms.apply_filter("generate_multires_level", level=level, smoothed=True)
        report = ms.apply_filter("compute_multires_pyramid")
        panels.append(Panel(f"Level {level}", f"waves from {100 * report['wavelength'][0] / np.linalg.norm(np.ptp(v, axis=0)):.1f} % of the box",
                            *arrays(ms.current_mesh())))  # fmt: skip
    return panels


def displacement(v, f):
    """What carries the message of a watermark."""
    ms = document(v, f)
    ms.apply_filter("apply_coord_multires_watermark", **MARK)
    marked = ms.current_mesh().vertex_matrix()
    along = ((marked - v) * normals(v, f)[1]).sum(axis=1)
    most = 0.002 * np.linalg.norm(np.ptp(v, axis=0))
    return [shaded("Marked", "", ms),
            Panel("What the mark moved", "dark to light: -0.2 to 0.2 % of the diagonal", v, f,
                  rendering.coloured(along, -most, most, VALUES))]  # fmt: skip


def top(v, f):
    """One mesh, five settings of the equalizer, from smoothed to carved; and where the scales are."""
    gains = (("smooth", (0, 0, 0, 0, 0.3, 1, 1, 1)), ("soft", (0, 0, 0.3, 0.5, 1, 1, 1, 1)), ("as scanned", (1,) * 8),
             ("crisp", (0, 0.7, 2, 2, 1.5, 1, 1, 1)), ("carved", (0, 0.4, 3, 4, 2.5, 1, 1, 1)))  # fmt: skip
    panels = []
    for title, values in gains:
        ms = document(v, f)
        ms.apply_filter("apply_coord_multires_equalizer", **{f"gain_{i + 1}": g for i, g in enumerate(values)})
        panels.append(Panel(title, "gains " + " ".join(f"{g:g}" for g in values), *arrays(ms.current_mesh())))
    return panels


def cow(curl=0.005):
    """The cow that comes with pymeshlab, in finer triangles, with a coat in two colours and curls: vertices, faces, colours.
    It looks along z, up is y."""
    ms = document(*read(BUNNY.parent / "cow.obj"))
    ms.meshing_merge_close_vertices()
    ms.meshing_surface_subdivision_loop(iterations=2, threshold=pymeshlab.PercentageValue(0))
    v, f = arrays(ms.current_mesh())
    normal = ms.current_mesh().vertex_normal_matrix()
    curls = np.sin(90 * v[:, 0] + 2 * np.sin(25 * v[:, 1])) * np.sin(80 * v[:, 1]) * np.sin(80 * v[:, 2])
    patch = np.sin(11 * v[:, 0] + 1) + np.sin(13 * v[:, 1]) + np.sin(12 * v[:, 2] + 2 * np.sin(9 * v[:, 1])) > 0.5
    colors = np.where(patch[:, None], [0.55, 0.3, 0.14, 1], [0.92, 0.86, 0.74, 1])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    return v + curl * curls[:, None] * normal, f, colors


def rise(x, start, end):
    t = np.clip((x - start) / (end - start), 0, 1)
    return t * t * (3 - 2 * t)


def giraffe_of(p):
    """Longer legs, and a neck."""
    q = p.copy()
    neck = rise(p[:, 2], 0.25, 0.6) * rise(p[:, 1], -0.35, -0.05)
    q[:, 1] += 0.55 * neck - 0.3 * rise(-p[:, 1], 0.1, 0.5)
    q[:, 2] -= 0.12 * neck
    return q


def step_of(p):
    """One of the forelegs forward and up."""
    angle = -1.2 * rise(-p[:, 1], 0.08, 0.34) * (p[:, 0] > 0.02) * (p[:, 2] > 0.15)
    pivot = np.array([0, -0.15, 0.42])
    x, y, z = (p - pivot).T
    return np.column_stack([x, y * np.cos(angle) - z * np.sin(angle), y * np.sin(angle) + z * np.cos(angle)]) + pivot


def follow(v, f, colors, edit, **parameters):
    """The cow, its proxy after the edit, and the cow that followed it: three pairs of vertices and faces."""
    ms = document()
    ms.add_mesh(pymeshlab.Mesh(vertex_matrix=v, face_matrix=f, v_color_matrix=colors))
    ms.generate_copy_of_current_mesh()
    ms.meshing_decimation_quadric_edge_collapse(targetfacenum=1000)
    proxy, faces = arrays(ms.current_mesh())
    ms.add_mesh(pymeshlab.Mesh(edit(proxy), faces))
    ms.set_current_mesh(0)
    ms.apply_filter("apply_coord_multires_transfer_edit", before=1, edited=2, **parameters)
    return (v, f), (edit(proxy), faces), arrays(ms.current_mesh())


def giraffe(path):
    v, f, colors = cow()
    before, proxy, after = follow(v, f, colors, giraffe_of)
    coat = colors[:, :3]
    panels = [
        Panel("Cow", f"{len(v):,} vertices", *before, coat),
        Panel("Proxy", f"{len(proxy[0])} vertices, edited", *proxy, edges=True),
        Panel("Follow Edited Layer", "the cow with its coat", *after, coat),
    ]
    sheet_of_cows(panels, np.vstack([before[0], after[0]]), np.vstack([f, f + len(v)]), path)


def cow_leg(path):
    """Guskov et al., Figure 14."""
    v, f, colors = cow(0.01)
    panels = [Panel("Cow", "", v, f)]
    for details in ("single resolution", "multiresolution"):
        _, _, after = follow(v, f, colors, step_of, details=details, encoding="frames")
        panels.append(Panel(details.capitalize(), "details of the leg that steps", *after))
    sheet_of_cows(panels, v, f, path, (-0.5, -0.45, 0.42))


def sheet_of_cows(panels, all_vertices, f, path, closer=(0, 0, 1)):
    camera = rendering.three_quarter_camera(all_vertices, f, up="y").closer(*closer)
    rendering.contact_sheet(panels, camera, 360, close_ups=False).save(path, "WEBP", quality=82, method=6)


def beside_taubin(title, noisy_v, truth, f, up, path):
    """A noisy mesh, Taubin's filter tuned with the truth, Denoise, and the truth."""
    angle = lambda v: normal_angles(v, f, truth, f).mean()  # noqa: E731
    taubin = min((run(setting, noisy_v, f)[0] for setting in TAUBIN), key=angle)
    ours = run(Setting(DENOISE), noisy_v, f)[0]
    shown = ((title, noisy_v), ("Taubin, tuned with the truth", taubin), ("Denoise, no parameter", ours))
    panels = [Panel(title, f"normals off by {angle(v):.1f} degrees", v, f) for title, v in shown]
    panels.append(Panel("Truth", "", truth, f))
    camera = rendering.three_quarter_camera(truth, f, up=up)
    rendering.contact_sheet(panels, camera, 300).save(path, "WEBP", quality=80, method=6)


def rounded(path):
    """The bunny with coordinates rounded to 0.7 edge lengths."""
    truth, f = read(BUNNY)
    beside_taubin("Rounded", with_noise(truth, f, "quantised", 0.2, 1), truth, f, "y", path)


def rock(n=130, around=110):
    """A rough rock on a turned plinth."""
    z = np.linspace(0, 4, n)
    turned = [z < 0.4, z < 0.8, z < 1.4, z < 1.7]
    radius = np.select(turned, [1.1, 0.95, 0.75, 1.0], 0.8 + 0.25 * np.sin(1.2 * (z - 1.7)))
    rough = np.clip((z - 2.1) / 0.25 + 0.5, 0, 1)
    angle = np.arange(around) * 2 * np.pi / around
    a, height = np.meshgrid(angle, z)
    random = np.random.default_rng(3)
    bumps = np.zeros_like(a)
    for length in 0.2 * 1.5 ** np.arange(6):
        for _ in range(10):
            turns, phase = np.round(random.normal() / length), random.uniform(0, 7)
            bumps += 0.03 * length * np.cos(turns * a + 4 * random.normal() / length * height + phase)
    r = radius[:, None] + rough[:, None] * bumps
    v = np.stack([r * np.cos(a), r * np.sin(a), height], axis=-1).reshape(-1, 3)
    here = np.arange(n * around).reshape(n, around)
    beside = np.roll(here, -1, axis=1)
    lower = np.stack([here[:-1], beside[:-1], beside[1:]], axis=-1)
    upper = np.stack([here[:-1], beside[1:], here[1:]], axis=-1)
    return v, np.concatenate([lower.reshape(-1, 3), upper.reshape(-1, 3)])


def kinds(path):
    """Two kinds of surface on one mesh."""
    truth, f = rock()
    beside_taubin("Noise of 0.2 edge lengths", with_noise(truth, f, "normals", 0.2, 1), truth, f, "z", path)


def voxels(path):
    """The bunny as voxels that are only inside or outside, by marching cubes; Taubin's filter with its defaults; Denoise."""
    import pyvista

    v, f = read(BUNNY)
    size = np.ptp(v, axis=0).max() / 60
    low = v.min(axis=0) - 2 * size
    dimensions = np.ceil((v.max(axis=0) + 2 * size - low) / size).astype(int)
    grid = pyvista.ImageData(dimensions=dimensions, spacing=(size,) * 3, origin=low)
    surface = pyvista.PolyData(v, np.column_stack([np.full(len(f), 3), f]).ravel())
    distance = grid.compute_implicit_distance(surface)["implicit_distance"]
    grid["inside"] = (distance < 0).astype(float)
    stairs = grid.contour([0.5], scalars="inside", method="marching_cubes").triangulate().clean()
    v, f = np.asarray(stairs.points, dtype=float), stairs.faces.reshape(-1, 4)[:, 1:]
    taubin = run(Setting("apply_coord_taubin_smoothing"), v, f)[0]
    ours = run(Setting(DENOISE), v, f)[0]
    panels = [Panel("Voxels", "marching cubes", v, f), Panel("Taubin", "defaults", taubin, f),
              Panel("Denoise", "no parameter", ours, f)]  # fmt: skip
    rendering.contact_sheet(panels, rendering.three_quarter_camera(v, f), 300).save(path, "WEBP", quality=80, method=6)


def heights(v, f, path):
    """How common each height of the bunny's fur is, and the bearing curve, by the Python package's plot."""
    import types

    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    from PIL import Image

    package = types.ModuleType("pymeshlab_multires")  # without what importing it does: the plugins are loaded already
    package.__path__ = [str(ROOT / "python/src/pymeshlab_multires")]
    sys.modules["pymeshlab_multires"] = package
    from pymeshlab_multires._filters import roughness
    from pymeshlab_multires._plot import plot_roughness

    figure, axes = plt.subplots(figsize=(7.2, 3.6), dpi=100, layout="constrained")
    plot_roughness(roughness(document(v, f)), axes, color="#29696f")
    figure.savefig(path.with_suffix(".png"))
    with Image.open(path.with_suffix(".png")) as picture:
        picture.convert("RGB").save(path, "WEBP", quality=82, method=6)
    path.with_suffix(".png").unlink()


def stone(path):
    """A synthetic stone as it looks in slanting light, its letters, and its relief."""
    from relief_compare import stone as carved

    v, f, letter = carved(11)
    ms = document(v, f)
    ms.apply_filter("compute_scalar_multires_relief_per_vertex", color=True)
    panels = [
        Panel("Stone", "letters 0.3 mm deep, chisel, noise", v, f),
        Panel("Letters", "the truth", v, f, np.where(letter[:, None], [0.16, 0.28, 0.6], [0.87, 0.87, 0.87])),
        painted("Relief", "no parameter given", ms),
    ]
    centre = (v.min(axis=0) + v.max(axis=0)) / 2
    camera = rendering.Camera(*np.eye(3), centre, np.ptp(v[:, 0]) / 2)
    rendering.contact_sheet(panels, camera, 420, close_ups=False).save(path, "WEBP", quality=82, method=6)


def mountains(n=160, seed=4):
    """A made-up terrain on a triangular grid: ridges of all sizes. Vertices and faces."""
    i, j = np.mgrid[:n, :n] / n
    random, z = np.random.default_rng(seed), np.zeros((n, n))
    for octave in range(6):
        turn, shift = random.uniform(0, 7, 2), random.uniform(0, 7, 2)
        for angle in turn:
            wave = np.cos(angle) * i + np.sin(angle) * j + 0.1 * np.sin(9 * i + shift[0]) * np.cos(8 * j + shift[1])
            z += 0.14 * 0.55**octave * (1 - np.abs(np.sin(2.3 * 2**octave * wave + shift[0])))
    corner = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()[:, None]
    faces = np.vstack([corner + [0, n, n + 1], corner + [0, n + 1, 1]])
    return np.column_stack([i.ravel(), j.ravel(), z.ravel()]), faces


def painted_grid(name, v, f):
    """A filter of attributes of triangular grids on the mountains, in colours with noise."""
    ms, how = with_colors(v, f), {"share": 5} if "compress" in name else {"gains": "0, 0, 0.5"}
    panels = [painted("Before", "colours with noise", ms)]
    ms.apply_filter(name, **how)
    return [*panels, painted("After", "5 % of the coefficients" if "compress" in name else "gains 0, 0, 0.5", ms)]


def grid_panels(name, v, f):
    """A filter of triangular grids on the mountains."""
    if "attributes" in name:
        return painted_grid(name, v, f)
    ms = document(v, f)
    panels = [shaded("Before", f"{len(v):,} vertices", ms)]
    if name == "compute_multires_grid":
        for basis in ("linear", "quartic"):
            now = document(v, f)
            now.apply_filter("generate_multires_grid_level", level=3, refine=3, basis=basis)
            panels.append(shaded(f"Level 3, {basis}", "its control points' surface", now))
    if name == "apply_coord_multires_grid_band":
        ms.apply_filter(name, gains="0.5, 2, 3, 2")
        panels.append(shaded("Grid band", "gains 0.5, 2, 3, 2", ms))
    if name == "apply_coord_multires_grid_compress":
        for share in (10, 1):
            now = document(v, f)
            now.apply_filter(name, share=share, channels="heights")
            panels.append(shaded("Grid compress", f"{share} % of the coefficients", now))
    if name == "generate_multires_grid_level":
        ms.apply_filter(name, level=3, basis="linear")
        panels.append(meshed("Grid level", ", level 3", ms))
    if name == "apply_coord_multires_grid_edit":
        ms.apply_filter("generate_multires_grid_level", level=4, basis="linear")
        control = ms.current_mesh().vertex_matrix()
        control[:, 2] += 0.35 * np.exp(-25 * ((control[:, :2] - 0.55) ** 2).sum(axis=1))
        ms.add_mesh(pymeshlab.Mesh(control, ms.current_mesh().face_matrix()))
        panels.append(meshed("Control mesh", ", level 4, edited", ms))
        ms.set_current_mesh(0)
        ms.apply_filter(name, edited=2, basis="linear")
        panels.append(shaded("Grid edit", "the terrain follows", ms))
    return panels


def grid_picture(name, path):
    v, f = mountains()
    view = np.array([[0.71, -0.71, 0], [0.45, 0.45, 0.77], [-0.54, -0.54, 0.64]])
    half = 0.72 if "band" in name or "compress" in name else 0.8
    camera = rendering.Camera(*view, (v.min(axis=0) + v.max(axis=0)) / 2, half)
    sheet = rendering.contact_sheet(grid_panels(name, v, f), camera, 360, close_ups=False)
    sheet.save(path, "WEBP", quality=80, method=6)


SPECIAL = {"compute_multires_pyramid": levels, "compute_multires_watermark": displacement}
ALONE = {"giraffe": giraffe, "cow-leg": cow_leg, "denoise-rounded": rounded, "denoise-voxels": voxels,
         "denoise-kinds": kinds}  # fmt: skip


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--only", nargs="*", help="names of filters, top, giraffe, cow-leg, denoise-rounded, denoise-voxels or denoise-kinds")
    parser.add_argument("--output", type=pathlib.Path, default=FOLDER)
    arguments = parser.parse_args()
    load_plugins()
    v, f = read(BUNNY)
    arguments.output.mkdir(parents=True, exist_ok=True)
    for name in arguments.only or ["top", *ALONE, *PAIRS]:
        if name in ALONE:
            ALONE[name](arguments.output / f"{name}.webp")
            continue
        if name == "compute_multires_roughness":
            heights(v, f, arguments.output / "roughness.webp")
            continue
        if name == "compute_scalar_multires_relief_per_vertex":
            stone(arguments.output / "relief.webp")
            continue
        if "multires_grid" in name:
            grid_picture(name, arguments.output / f"{FUNCTIONS[name].replace('_', '-')}.webp")
            continue
        panels = (
            top(v, f) if name == "top" else SPECIAL[name](v, f) if PAIRS[name] is None else pair(name, v, f)
        )
        camera = rendering.three_quarter_camera(v, f)
        if any(panel.edges for panel in panels):
            camera = camera.closer(-0.35, 0.25, 0.5)  # the head, that edges can be told apart
        sheet = rendering.contact_sheet(panels, camera, 400 if name == "top" else 360, close_ups=name == "top")
        path = arguments.output / f"{'top' if name == 'top' else FUNCTIONS[name].replace('_', '-')}.webp"
        sheet.save(path, "WEBP", quality=82, method=6)
        print(f"{path.name}: {sheet.width} by {sheet.height}, {path.stat().st_size // 1000} KB", flush=True)


if __name__ == "__main__":
    main()
