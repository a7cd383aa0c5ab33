"""Writes what follows from the filter tables: the parameter reference, the typed Python functions, the .mlx examples.

    .venv/bin/python tools/generate.py [--build BUILD] [--check]

With --check nothing is written; the program fails and names the files that are not up to date. The tables come from
multires_list_filters, a program of the build.
"""

import argparse
import html
import json
import pathlib
import re
import subprocess
import sys
import textwrap
import xml.etree.ElementTree as ET

ROOT = pathlib.Path(__file__).resolve().parent.parent

# Names of the Python functions; a filter that is not here is called by its Python name.
FUNCTIONS = {
    "compute_multires_pyramid": "build_pyramid",
    "generate_multires_level": "level_as_layer",
    "compute_scalar_multires_detail_per_vertex": "detail_to_quality",
    "apply_coord_multires_low_pass": "low_pass",
    "apply_coord_multires_stop_band": "stop_band",
    "apply_coord_multires_enhance": "enhance",
    "apply_coord_multires_equalizer": "equalizer",
    "apply_coord_multires_unsharp": "unsharp",
    "apply_coord_multires_denoise": "denoise",
    "apply_attributes_multires_relaxation": "relax_attributes",
    "apply_attributes_multires_band": "filter_attributes",
    "apply_attributes_multires_band_custom": "filter_custom_attributes",
    "apply_attributes_multires_denoise": "denoise_attributes",
    "generate_multires_texcoord": "generate_texcoord",
    "generate_multires_adaptive_reconstruction": "adaptive_reconstruction",
}

# Example scripts: what they do, and filters with the parameters that are not the defaults. Limits are in percent of the
# box diagonal: a script is for meshes of any size.
PERCENT = {"unit": "wavelength percent"}
EXAMPLES = {
    "denoise": ("Removes noise, keeps shape and edges.", [("apply_coord_multires_denoise", {})]),
    "smooth": ("Removes all structure finer than 4 % of the box diagonal.",
               [("apply_coord_multires_low_pass", {**PERCENT, "cutoff": 4})]),
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
    "fewer-faces": ("A new layer within 0.05 % (RMS) of the input, with as few vertices as are found.",
                    [("generate_multires_adaptive_reconstruction", {"target": "RMS distance", "unit": "percent",
                                                                    "error": 0.05})]),
}  # fmt: skip


def tables(build):
    """The filters as the tables declare them, in the order of FUNCTIONS; those that are not there last."""
    rows = json.loads(subprocess.check_output([build / "tests/tables/multires_list_filters"]))
    order = list(FUNCTIONS)
    return sorted(rows, key=lambda r: order.index(r["python_name"]) if r["python_name"] in order else len(order))


def function_name(row):
    return FUNCTIONS.get(row["python_name"], row["python_name"])


def plain(text):
    """HTML as plain text."""
    return html.unescape(re.sub(r"<[^>]+>", " ", text)).replace(" .", ".").strip()


def purpose_and_sources(info):
    """What a filter does, and its papers: "authors, title, where"."""
    purpose, *cited = re.split(r"(?:<br>)+\s*See:<br>|(?=<i>(?:[A-Z][^<]*)</i><br>\s*<b>)", info)
    sources = [
        re.sub(r"\s+", " ", plain(c.replace("<br>", " ").replace("</i>", ":"))).replace(" :", ":") for c in cited
    ]
    return plain(purpose), [re.sub(r':\s*"([^"]*)"', r': "\1",', s).strip().rstrip(".") + "." for s in sources if s]


def number(value):
    return f"{value:g}"


# ---- parameter reference ---------------------------------------------------------------------------------------------


def allowed(p):
    """Type and range of a parameter, in words."""
    if p["type"] == "choice":
        return "one of " + ", ".join(f"`{n}`" for n in p["names"])
    if p["type"] in ("boolean", "text"):
        return {"boolean": "true or false", "text": "text"}[p["type"]]
    kind = "whole number" if p["type"] == "integer" else "number"
    least, most = p.get("least"), p.get("most")
    most = None if most is not None and most >= 1e9 - 1 else most
    if least is not None and most is not None:
        return f"{kind}, {number(least)} to {number(most)}"
    return f"{kind}, at least {number(least)}" if least is not None else kind


def default_words(p):
    if p["derived"]:
        return "from the mesh"
    if p["type"] == "choice":
        return f"`{p['names'][p['value']]}`"
    if p["type"] == "boolean":
        return str(p["value"]).lower()
    return f'`"{p["value"]}"`' if p["type"] == "text" else number(p["value"])


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
        "The name in the menu is the one in `.mlx` scripts; the second one is for `MeshSet.apply_filter` of pymeshlab, the",
        "third is the typed function of the Python package (`python/`). *From the mesh*: the default is derived from the mesh",
        "(lengths from its size and density, *only on selection* from whether there is a selection, attributes from what",
        "there is). Parameters under *Advanced* are folded away in MeshLab's dialog. A key with `*` stands for one for each",
        "attribute: `color`, `quality`, `texcoord`, `custom_NAME`.",
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
        out += ["", *[f"- {s}" for s in sources]]
    return "\n".join(out) + "\n"


# ---- Python functions ------------------------------------------------------------------------------------------------


def literal(names):
    return "Literal[" + ", ".join(f'"{n}"' for n in names) + "]"


def shared_choices(rows):
    """Type names of the choices that several filters have, by their values: ("Roy", "Guskov") -> "Scheme"."""
    choices = [(p["name"], tuple(p["names"])) for r in rows for p in r["parameters"] if p["type"] == "choice"]
    alike = {name: {names for n, names in choices if n == name} for name, _ in choices}
    return {names: "".join(w.capitalize() for w in name.split("_")) for name, names in choices
            if len(alike[name]) == 1 and choices.count((name, names)) > 1}  # fmt: skip


def alias(name, values):
    one = f"{name}: TypeAlias = {literal(values)}"
    return [one] if len(one) <= 120 else [f"{name}: TypeAlias = Literal[", *[f'    "{v}",' for v in values], "]"]


def annotation(p, shared):
    kinds = {"boolean": "bool", "integer": "int", "real": "float", "slider": "float", "text": "str"}
    kind = kinds.get(p["type"]) or shared.get(tuple(p["names"])) or literal(p["names"])
    return f"{kind} | None = None" if p["derived"] else f"{kind} = {python_default(p)}"


def python_default(p):
    if p["type"] == "choice":
        return f'"{p["names"][p["value"]]}"'
    if p["type"] in ("real", "slider"):
        return repr(float(p["value"]))
    return repr(p["value"]).replace("'", '"')


def wrapped(text, indent, hanging=0):
    return textwrap.wrap(text, 116, initial_indent=" " * indent, subsequent_indent=" " * (indent + hanging))


FIELD = {"boolean": "bool", "integer": "int", "real": "float", "list": "Array"}


def report_class(row):
    return "".join(w.capitalize() for w in function_name(row).split("_")) + "Report"


def field(r):
    """Name, type and default of a report's field. One of any attribute becomes a dictionary by attribute."""
    if r["key"].startswith("*_"):
        return r["key"][2:], f"dict[str, {FIELD[r['type']]}]", " = dataclasses.field(default_factory=dict)"
    return r["key"], FIELD[r["type"]] + ("" if r["always"] else " | None"), "" if r["always"] else " = None"


def dataclass(row):
    lines = ["", "", "@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)", f"class {report_class(row)}:"]
    lines += [f'    """What {function_name(row)}() returns."""', ""]
    for r in row["returns"]:
        name, kind, default = field(r)
        unit = f" ({r['unit']})" if r["unit"] else ""
        by = " By attribute." if r["key"].startswith("*") else ""
        lines += [f"    {name}: {kind}{default}", *documented(f"{r['meaning'].rstrip('.')}{unit}.{by}", 4)]
    return lines


def documented(text, indent):
    """A docstring."""
    lines = textwrap.wrap(f'"""{text}', 116 - indent)
    return [" " * indent + line for line in lines[:-1]] + [" " * indent + lines[-1] + '"""']


def function(row, shared):
    purpose, sources = purpose_and_sources(row["info"])
    parameters = row["parameters"]
    lines = ["", "", f"def {function_name(row)}(", "    ms: MeshSet,", *(["    *,"] if parameters else [])]
    lines += [f"    {p['name']}: {annotation(p, shared)}," for p in parameters]
    lines += [f") -> {report_class(row)}:"]
    first, *rest = re.split(r"(?<=\.)\s+", purpose, maxsplit=1)
    lines += [*wrapped(f'"""{first}', 4), ""]
    for paragraph in [
        *rest,
        f"The filter {row['python_name']}, on the current mesh; the mesh is unchanged if it fails.",
    ]:
        lines += [*wrapped(paragraph, 4), ""]
    lines += ["    Args:", "        ms: the document."]
    for p in parameters:
        said = f"{p['label'].split(':')[0]}. {p['tooltip']}"
        if p["derived"]:
            said += " None: derived from the mesh."
        if p["type"] in ("integer", "real", "slider"):
            said += f" A {allowed(p)}."
        lines += wrapped(f"{p['name']}: {said}", 8, 4)
    lines += ["", "    Raises:", "        pymeshlab.PyMeshLabException: the mesh or a value will not do; it says why."]
    if sources:
        lines += ["", "    See:", *[line for s in sources for line in wrapped(s, 8, 4)]]
    lines += ['    """', f'    return apply({report_class(row)}, ms, "{row["python_name"]}", {{']
    lines += [f'        "{p["name"]}": {p["name"]},' for p in parameters]
    return [*lines, "    })"]


def python_module(rows):
    """python/src/pymeshlab_multires/_filters.py"""
    shared = shared_choices(rows)
    names = sorted([function_name(r) for r in rows] + [report_class(r) for r in rows] + list(shared.values()))
    lines = [
        '"""A function and a report for every filter. Written by tools/generate.py from the filter tables."""',
        "",
        "import dataclasses",
        "from typing import Literal, TypeAlias",
        "",
        "from ._call import Array, MeshSet, apply",
        "",
        "__all__ = [",
        *[f'    "{n}",' for n in names],
        "]",
        "",
        *[line for values, name in shared.items() for line in alias(name, values)],
    ]
    for row in rows:
        lines += dataclass(row)
    for row in rows:
        lines += function(row, shared)
    return "\n".join(lines) + "\n"


# ---- .mlx examples ---------------------------------------------------------------------------------------------------

RICH = {"boolean": "RichBool", "integer": "RichInt", "real": "RichFloat", "slider": "RichDynamicFloat",
        "choice": "RichEnum", "text": "RichString"}  # fmt: skip


def param(p, value):
    """The XML of one parameter."""
    if p["type"] == "choice" and isinstance(value, str):
        value = p["names"].index(value)
    text = str(value).lower() if p["type"] == "boolean" else value if p["type"] == "text" else \
        str(value) if p["type"] == "integer" else number(value)  # fmt: skip
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
           "examples/README.md": examples_readme()}  # fmt: skip
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
