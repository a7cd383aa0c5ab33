"""Shows what the filters do: builds a pyramid, applies the band filters through pymeshlab, writes meshes and pictures.

    .venv/bin/python tools/demo.py [MESH]

scripts/demo.sh builds the plugins and calls this. Results go to demo-output/: a PLY file for each filter, the table of
the pyramid's levels (levels.md, levels.csv), the filters' reports (reports.md) and contact-sheet.png.
"""

import argparse
import pathlib
import sys

import pymeshlab

import contact_sheet

ROOT = pathlib.Path(__file__).resolve().parent.parent
PLUGINS = ROOT / "build/pymeshlab-2025.07/plugins"
BUNNY = pathlib.Path(pymeshlab.__file__).parent / "tests/sample_meshes/bunny.obj"

PYRAMID = "compute_multires_pyramid"
EQUALIZER_GAINS = (0, 0, 1, 2.5, 2.5, 1, 1, 1)

# Title, subtitle, filter, its parameters. What is not given is derived from the mesh.
STEPS = (
    ("Low pass", "everything finer than the cutoff removed", "apply_coord_multires_low_pass", {}),
    ("Stop band", "only the middle scales removed", "apply_coord_multires_stop_band", {}),
    ("Enhance", "the same middle scales doubled", "apply_coord_multires_enhance", {"gain": 2}),
    ("Equalizer", "gains " + " ".join(f"{g:g}" for g in EQUALIZER_GAINS), "apply_coord_multires_equalizer",
     {f"gain_{i + 1}": g for i, g in enumerate(EQUALIZER_GAINS)}),
)  # fmt: skip


def load_plugins(folder):
    plugins = sorted(folder.glob("*.so"))
    if not plugins:
        sys.exit(f"No plugins in {folder}: run scripts/demo.sh, which builds them.")
    for plugin in plugins:
        pymeshlab.load_plugin(str(plugin))


def table(rows, header):
    """Markdown, columns aligned."""
    cells = [header, *rows]
    widths = [max(len(row[i]) for row in cells) for i in range(len(header))]
    lines = ["| " + " | ".join(c.rjust(w) for c, w in zip(row, widths)) + " |" for row in cells]
    lines.insert(1, "|" + "|".join("-" * (w + 1) + ":" for w in widths) + "|")
    return "\n".join(lines) + "\n"


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


def panel(title, subtitle, mesh):
    return contact_sheet.Panel(title, subtitle, mesh.vertex_matrix(), mesh.face_matrix())


def run(path, output):
    """Applies all steps to the mesh, each to a fresh copy. Returns level rows, report rows and panels."""
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
    return levels, reports, panels


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("mesh", nargs="?", type=pathlib.Path, default=BUNNY, help="default: the Stanford bunny")
    parser.add_argument("--output", type=pathlib.Path, default=ROOT / "demo-output")
    parser.add_argument("--plugins", type=pathlib.Path, default=PLUGINS)
    parser.add_argument("--up", choices=("x", "y", "z", "-x", "-y", "-z"), help="axis that points up in the pictures")
    parser.add_argument("--tile", type=int, default=520, help="side of one picture, pixels")
    parser.add_argument("--small", type=pathlib.Path, help="also save the contact sheet here, below 300 KB")
    arguments = parser.parse_args()

    load_plugins(arguments.plugins)
    output = arguments.output
    output.mkdir(parents=True, exist_ok=True)
    try:
        levels, reports, panels = run(arguments.mesh, output)
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

    camera = contact_sheet.three_quarter_camera(panels[0].vertices, panels[0].faces, arguments.up)
    sheet = contact_sheet.contact_sheet(panels, camera, arguments.tile)
    sheet.save(output / "contact-sheet.png", optimize=True)
    if arguments.small:
        contact_sheet.save_small(sheet, arguments.small)
    print(f"Meshes, tables and contact-sheet.png are in {output}")


if __name__ == "__main__":
    main()
