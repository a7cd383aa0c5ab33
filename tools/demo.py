"""Shows what the filters do: builds a pyramid, applies every kind of filter through pymeshlab, writes meshes and pictures.

    .venv/bin/python tools/demo.py [MESH]

scripts/demo.sh builds the plugins and calls this. Results go to demo-output/: a PLY file for each filter, the table of
the pyramid's levels (levels.md, levels.csv), the filters' reports (reports.md), contact-sheet.png with the bands and
denoise-attributes-adaptive.png with the rest.
"""

import argparse
import pathlib
import sys

import numpy as np
import pymeshlab

import rendering
from measuring import BUILD, BUNNY, EQUALIZER_GAINS, PYRAMID, ROOT, arrays, load_plugins, table, with_noise

SECOND_SHEET = "denoise-attributes-adaptive.png"

# Title, subtitle, filter, its parameters. What is not given is derived from the mesh.
STEPS = (
    ("Low pass", "everything finer than the cutoff removed", "apply_coord_multires_low_pass", {}),
    ("Stop band", "only the middle scales removed", "apply_coord_multires_stop_band", {}),
    ("Enhance", "the same middle scales doubled", "apply_coord_multires_enhance", {"gain": 2}),
    ("Equalizer", "gains " + " ".join(f"{g:g}" for g in EQUALIZER_GAINS), "apply_coord_multires_equalizer",
     {f"gain_{i + 1}": g for i, g in enumerate(EQUALIZER_GAINS)}),
)  # fmt: skip


# The others, each with what prepares its input.
OTHERS = (
    ("Noisy", "noise of 0.2 edge lengths added", "noise", None, {}),
    ("Denoise", "no parameter given", "noise", "apply_coord_multires_denoise", {}),
    ("Painted", "stripes with speckles", "paint", None, {}),
    ("Relax attributes", "20 steps on the colours", "paint", "apply_attributes_multires_relaxation",
     {"iterations": 20}),
    ("Adaptive", "vertices where there is detail", "copy", "generate_multires_adaptive_reconstruction", {}),
)  # fmt: skip


def level_rows(report):
    """Level, vertices, wavelength, RMS detail; one row a level."""
    columns = (report["level"], report["vertices"], report["wavelength"], report["rms_detail"])
    return [(f"{k:.0f}", f"{n:.0f}", f"{w:.5g}", f"{d:.5g}") for k, n, w, d in zip(*columns)]


def report_row(title, report):
    """What a filter did, in percent where that says more."""
    diagonal = report["diagonal"]
    moved = [f"{100 * report[key] / diagonal:.3f} %" for key in ("largest_displacement", "rms_displacement")]
    changed = [f"{100 * (report[k + '_after'] / report[k + '_before'] - 1):+.3f} %" if report[k + "_before"] else "-"
               for k in ("volume", "area")]  # fmt: skip
    return [title, *moved, *changed, str(report["flipped_faces"])]


def panel(title, subtitle, mesh, **look):
    return rendering.Panel(title, subtitle, mesh.vertex_matrix(), mesh.face_matrix(), **look)


def add_input(document, kind):
    """A new layer made of the current one: a copy, with noise along the normals, or painted. Always the same."""
    mesh = document.current_mesh()
    vertices, faces = arrays(mesh)
    colors = None
    if kind == "noise":
        vertices = with_noise(vertices, faces, "normals", 0.2, seed=1)
    if kind == "paint":
        random = np.random.default_rng(1)
        height = (vertices - vertices.min(axis=0)) / np.ptp(vertices, axis=0).max()
        stripe = (np.floor(12 * height[:, :1]) % 2).astype(float)
        colors = stripe * [0.85, 0.45, 0.2, 1] + (1 - stripe) * [0.2, 0.45, 0.7, 1]
        speckled = random.random(len(colors)) < 0.25
        colors[speckled, :3] = random.random((speckled.sum(), 3))
    parts = {"vertex_matrix": vertices, "face_matrix": faces}
    document.add_mesh(pymeshlab.Mesh(**parts, **({"v_color_matrix": colors} if colors is not None else {})))


def run_others(document, original, output):
    """Panels of denoising, attributes and adaptive reconstruction; writes the meshes."""
    panels = []
    for title, subtitle, kind, name, parameters in OTHERS:
        document.set_current_mesh(original)
        add_input(document, kind)
        if name:
            document.apply_filter(name, **parameters)
        mesh = document.current_mesh()
        look = {"colors": mesh.vertex_color_matrix()[:, :3]} if kind == "paint" else {}
        if kind == "copy":
            subtitle = f"{mesh.face_number():,} faces, {subtitle}"
            look = {"edges": True}
        panels.append(panel(title, subtitle, mesh, **look))
        document.save_current_mesh(str(output / (title.lower().replace(" ", "-") + ".ply")))
    return panels


def run(path, output):
    """Applies all steps to the mesh, each to a fresh copy. Returns level rows, report rows, panels and the others'."""
    document = pymeshlab.MeshSet(verbose=False)
    document.load_new_mesh(str(path))
    original = document.current_mesh_id()
    mesh = document.current_mesh()
    diagonal = mesh.bounding_box().diagonal()
    levels = level_rows(document.apply_filter(PYRAMID))
    panels = [panel("Input", f"{mesh.vertex_number():,} vertices", mesh)]
    reports = []
    for title, subtitle, name, parameters in STEPS:
        document.set_current_mesh(original)
        document.apply_filter("generate_copy_of_current_mesh")
        report = document.apply_filter(name, **parameters)
        reports.append(report_row(title, {**report, "diagonal": diagonal}))
        panels.append(panel(title, subtitle, document.current_mesh()))
        document.save_current_mesh(str(output / (title.lower().replace(" ", "-") + ".ply")))
        document.delete_current_mesh()
    return levels, reports, panels, run_others(document, original, output)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("mesh", nargs="?", type=pathlib.Path, default=BUNNY, help="default: the Stanford bunny")
    parser.add_argument("--output", type=pathlib.Path, default=ROOT / "demo-output")
    parser.add_argument("--plugins", type=pathlib.Path, default=BUILD / "plugins")
    parser.add_argument("--up", choices=("x", "y", "z", "-x", "-y", "-z"), help="axis that points up in the pictures")
    parser.add_argument("--tile", type=int, default=520, help="side of one picture, pixels")
    arguments = parser.parse_args()

    load_plugins(arguments.plugins)
    output = arguments.output
    output.mkdir(parents=True, exist_ok=True)
    try:
        levels, reports, panels, others = run(arguments.mesh, output)
    except pymeshlab.PyMeshLabException as error:
        sys.exit(f"{arguments.mesh}: {error}")

    header = ["level", "vertices", "wavelength", "RMS detail"]
    level_table = table(levels, header)
    report_table = table(reports, ["filter", "largest move", "RMS move", "volume", "area", "flipped faces"])
    note = "Moves in percent of the box diagonal.\n"
    (output / "levels.md").write_text(level_table)
    (output / "levels.csv").write_text("".join(",".join(row) + "\n" for row in [header, *levels]))
    (output / "reports.md").write_text(report_table + "\n" + note)
    print(level_table, report_table, note, sep="\n")

    camera = rendering.three_quarter_camera(panels[0].vertices, panels[0].faces, arguments.up)
    sheet = rendering.contact_sheet(panels, camera, arguments.tile)
    sheet.save(output / "contact-sheet.png", optimize=True)
    second = rendering.contact_sheet(others, camera, arguments.tile)
    second.save(output / SECOND_SHEET, optimize=True)
    print(f"Meshes, tables, contact-sheet.png and {SECOND_SHEET} are in {output}")


if __name__ == "__main__":
    main()
