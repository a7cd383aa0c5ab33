"""Writes what follows from the filter tables: the parameter reference, the typed Python functions, the .mlx examples,
and docs/filters.json, the description for a port to MeshLab's successor.

    .venv/bin/python tools/generate.py [--build BUILD] [--check]

With --check nothing is written; the program fails and names the files that are not up to date. The tables come from
multires_list_filters, a program of the build.
"""

import argparse
import pathlib
import sys
import xml.etree.ElementTree as ET

from filter_tables import allowed, default_words, function_name, number, purpose_and_sources, tables
from generate_filters_json import filters_json
from generate_python import python_module

ROOT = pathlib.Path(__file__).resolve().parent.parent

# Example scripts: what they do, and filters with the parameters that are not the defaults. Limits are in percent of the
# box diagonal: a script is for meshes of any size.
PERCENT = {"unit": "wavelength percent"}
EXAMPLES = {
    "denoise": ("Removes noise, keeps shape and edges.", [("apply_coord_multires_denoise", {})]),
    "smooth": ("Removes all structure finer than 4 % of the box diagonal.",
               [("apply_coord_multires_low_pass", {**PERCENT, "cutoff": 4})]),
    "smooth-calibrated": ("Leaves exactly half of waves of 4 % of the box diagonal: the spline filter of ISO 16610-22.",
                          [("apply_coord_multires_low_pass", {**PERCENT, "cutoff": 4, "method": "spline"})]),
    "remove-band": ("Removes structure of 2 to 6 % and leaves finer engraving and the coarse shape.",
                    [("apply_coord_multires_stop_band", {**PERCENT, "finest": 2, "coarsest": 6})]),
    "enhance": ("Doubles structure of 2 to 8 %: brings out worn reliefs.",
                [("apply_coord_multires_enhance", {**PERCENT, "finest": 2, "coarsest": 8, "gain": 2})]),
    "equalizer": ("Removes the two finest of eight bands and strengthens two in the middle.",
                  [("apply_coord_multires_equalizer",
                    {"gain_1": 0, "gain_2": 0, "gain_4": 2, "gain_5": 2})]),
    "denoise-and-enhance": ("Removes noise first, then enhances what was below it.",
                            [("apply_coord_multires_denoise", {}),
                             ("apply_coord_multires_enhance", {**PERCENT, "finest": 2, "coarsest": 8, "gain": 1.5})]),
    "paint-smooth": ("Smooths the vertex colours along the surface.",
                     [("apply_attributes_multires_relaxation", {"color": True, "quality": False, "iterations": 10})]),
    "inscription": ("Height over a robust low pass as quality and colour, with a band found on the mesh: makes carved "
                    "letters and tool marks legible.",
                    [("compute_scalar_multires_relief_per_vertex", {"color": True})]),
    "details-by-scale": ("The signed detail of twelve bands as custom attributes, for classification.",
                         [("compute_custom_multires_scales", {"bands": 12})]),
    "denoise-sharp-edges": ("Selects sharp lines, then removes noise and keeps them.",
                            [("compute_selection_multires_features", {}),
                             ("apply_coord_multires_denoise", {"features": "selected edges"})]),
    "roughness": ("Logs the texture parameters of ISO 25178 of the whole surface over its low pass.",
                  [("compute_multires_roughness", {"selected": False})]),
    "multiband": ("Softens the finest of five bands and strengthens the two after it, over a smooth base.",
                  [("apply_coord_multires_bands", {"gain_1": 0.5, "gain_2": 1.5, "gain_3": 1.5})]),
    "watermark": ("Hides a message of 64 bits in the shape, to be read beside the original.",
                  [("apply_coord_multires_watermark", {"message": "00c0ffee00c0ffee", "key": "my key",
                                                       "selected": False})]),
    "fewer-faces": ("A new layer within 0.05 % (RMS) of the input, with as few vertices as are found.",
                    [("generate_multires_adaptive_reconstruction", {"target": "RMS distance", "unit": "percent",
                                                                    "error": 0.05})]),
}  # fmt: skip


# ---- parameter reference ---------------------------------------------------------------------------------------------


def cell(text):
    return text.replace("|", "\\|").replace("\n", " ")


def parameter_rows(parameters):
    return ["| Parameter | Default | Values | Meaning |", "|---|---|---|---|"] + [
        f"| `{p['name']}` | {default_words(p)} | {allowed(p)} | **{cell(p['label'].split(':')[0])}.** {cell(p['tooltip'])} |"
        for p in parameters
    ]


RETURNED = {"boolean": "true or false", "integer": "whole number", "real": "number", "list": "list"}


def reference(rows):
    """docs/parameters.md"""
    out = [
        "# Parameters of all filters",
        "",
        "Written by `tools/generate.py` from the filter tables; please change those.",
        "",
        "Each filter has three names: that of the menu and of `.mlx` scripts, that for `MeshSet.apply_filter` of pymeshlab, and",
        "that of its function in the Python package (`python/`), where the parameters of Build Pyramid are the fields of",
        "`Pyramid`. *From the mesh*: the default is derived from the mesh (lengths from its size and density, *only on",
        "selection* from whether there is a selection, attributes from which there are). MeshLab's dialog folds the parameters",
        "under *Advanced* away. A key with `*` stands for one key for each attribute: `color`, `quality`, `texcoord`,",
        "`custom_NAME`.",
        "",
    ]
    out += [f"- [{r['name'].removeprefix('Multiresolution: ')}](#{r['python_name']})" for r in rows]
    for row in rows:
        purpose, sources = purpose_and_sources(row["info"])
        out += ["", f'<a id="{row["python_name"]}"></a>', "", f"## {row['name'].removeprefix('Multiresolution: ')}", ""]
        out += [f"`{row['name']}` · `{row['python_name']}` · `{function_name(row)}`", "", purpose, ""]
        simple = [p for p in row["parameters"] if not p["advanced"]]
        advanced = [p for p in row["parameters"] if p["advanced"]]
        if simple:
            out += [*parameter_rows(simple), ""]
        if advanced:
            out += ["<details><summary>Advanced</summary>", "", *parameter_rows(advanced), "", "</details>", ""]
        out += ["Returns:", "", "| Key | Value | Unit | Meaning |", "|---|---|---|---|"]
        out += [f"| `{r['key']}`{'' if r['always'] else ' (not always)'} | {RETURNED[r['type']]} | {r['unit']} | {cell(r['meaning'])} |"
                for r in row["returns"]]  # fmt: skip
        out += ["", "See:", "", *[f"- {s}" for s in sources]]
    return "\n".join(out) + "\n"


# ---- .mlx examples ---------------------------------------------------------------------------------------------------

RICH = {"boolean": "RichBool", "integer": "RichInt", "real": "RichFloat", "slider": "RichDynamicFloat",
        "angle": "RichFloat", "choice": "RichEnum", "text": "RichString", "layer": "RichMesh",
        "point": "RichPoint3f", "direction": "RichPoint3f"}  # fmt: skip


def param(p, value):
    """The XML of one parameter."""
    if p["type"] in ("point", "direction"):
        x, y, z = map(number, value)
        return ET.Element("Param", type=RICH[p["type"]], name=p["name"], x=x, y=y, z=z)
    if p["type"] == "choice" and isinstance(value, str):
        value = p["names"].index(value)
    if p["type"] == "layer":  # by its position in MeshLab 2020.09, by its id later: the first one, unless told
        value = value or 0
    text = str(value).lower() if p["type"] == "boolean" else value if p["type"] == "text" else \
        str(value) if p["type"] in ("integer", "layer") else number(value)  # fmt: skip
    out = ET.Element("Param", type=RICH[p["type"]], name=p["name"], value=text)
    if p["type"] == "slider":
        out.set("min", number(p["least"]))
        out.set("max", number(p["most"]))
    if p["type"] == "choice":
        out.set("enum_cardinality", str(len(p["names"])))
        for i, name in enumerate(p["names"]):
            out.set(f"enum_val{i}", name)
    return out


def script(rows, steps):
    """A filter script that names every parameter: MeshLab 2020.09 as Debian builds it aborts if two are missing."""
    by_name = {r["python_name"]: r for r in rows}
    root = ET.Element("FilterScript")
    for filter_name, given in steps:
        row = by_name[filter_name]
        unknown = set(given) - {p["name"] for p in row["parameters"]}
        if unknown:
            raise ValueError(f"{filter_name} has no parameter {', '.join(sorted(unknown))}")
        element = ET.SubElement(root, "filter", name=row["name"])
        element.extend(param(p, given.get(p["name"], p["value"])) for p in row["parameters"])
    ET.indent(root, " ")
    return "<!DOCTYPE FilterScript>\n" + ET.tostring(root, encoding="unicode") + "\n"


def examples_readme():
    lines = ["# Filter scripts", "", "Written by `tools/generate.py`. Each runs in MeshLab (Filters > Show current filter script > Open), in",
             "`meshlabserver` 2020.09 and in pymeshlab, on a mesh of any size:", "",
             "    meshlabserver -i scan.ply -s examples/denoise.mlx -o clean.ply", "",
             "    ms.load_filter_script(\"examples/denoise.mlx\")     # pymeshlab, after load_plugin",
             "    ms.apply_filter_script()", "", "| Script | What it does |", "|---|---|"]  # fmt: skip
    return (
        "\n".join([*lines, *[f"| [{name}.mlx]({name}.mlx) | {what} |" for name, (what, _) in EXAMPLES.items()]]) + "\n"
    )


# ---- all -------------------------------------------------------------------------------------------------------------


def files(rows):
    """Path in the repository -> text, of everything that is generated."""
    out = {"docs/parameters.md": reference(rows), "python/src/pymeshlab_multires/_filters.py": python_module(rows),
           "docs/filters.json": filters_json(rows), "examples/README.md": examples_readme()}  # fmt: skip
    return out | {f"examples/{name}.mlx": script(rows, steps) for name, (_, steps) in EXAMPLES.items()}


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/pymeshlab-2025.07")
    parser.add_argument("--check", action="store_true", help="write nothing; fail if a file is not up to date")
    arguments = parser.parse_args()
    wanted = files(tables(arguments.build))
    old = [p for p, text in wanted.items() if not (ROOT / p).exists() or (ROOT / p).read_text() != text]
    old += [f"examples/{p.name}" for p in (ROOT / "examples").glob("*.mlx") if f"examples/{p.name}" not in wanted]
    if arguments.check:
        sys.exit(f"Not up to date, run tools/generate.py: {', '.join(old)}" if old else 0)
    for path in old:
        if path not in wanted:
            (ROOT / path).unlink()
            continue
        (ROOT / path).parent.mkdir(parents=True, exist_ok=True)
        (ROOT / path).write_text(wanted[path])
    print(f"Written: {', '.join(old)}" if old else "Everything is up to date.")


if __name__ == "__main__":
    main()
