"""Writes what follows from the filter tables: the parameter reference, the typed Python functions, the .mlx examples.

    .venv/bin/python tools/generate.py [--build BUILD] [--check]

With --check nothing is written; the program fails and names the files that are not up to date. The tables come from
multires_list_filters, a program of the build.
"""

import argparse
import html
import itertools
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
    "compute_scalar_multires_difference_per_vertex": "difference_to_layer",
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


def derived(p):
    """Whether the default depends on the mesh. Which layer another one is always does."""
    return p.get("derived", False) or p["type"] == "layer"


def pyramid_parameters(rows):
    """The parameters that describe a pyramid: those of Build Pyramid."""
    return next(r["parameters"] for r in rows if r["python_name"] == "compute_multires_pyramid")


def takes_pyramid(row, pyramid):
    """Whether the filter takes all of them; its function then takes a Pyramid."""
    return {p["name"] for p in pyramid} <= {p["name"] for p in row["parameters"]}


def own_parameters(row, pyramid):
    """Those that are keywords of the function."""
    shared = {p["name"] for p in pyramid} if takes_pyramid(row, pyramid) else set()
    return [p for p in row["parameters"] if p["name"] not in shared]


def plain(text):
    """HTML as plain text."""
    return " ".join(html.unescape(re.sub(r"<[^>]+>", "", text.replace("<br>", " "))).split())


def purpose_and_sources(info):
    """What a filter does, and its papers: 'authors, "title", where.'"""
    purpose, *cited = re.split(r"(?:<br>)+See (?=<i>)", info)
    return plain(purpose), [plain(c) for c in cited]


def number(value):
    return f"{value:g}"


# ---- parameter reference ---------------------------------------------------------------------------------------------


KINDS = {"boolean": "true or false", "text": "text", "layer": "a layer", "point": "three numbers",
         "direction": "three numbers", "integer": "whole number"}  # fmt: skip


def allowed(p):
    """Type and range of a parameter, in words."""
    if p["type"] == "choice":
        return "one of " + ", ".join(f"`{n}`" for n in p["names"])
    kind = KINDS.get(p["type"], "number")
    least, most = p.get("least"), p.get("most")
    most = None if most is not None and most >= 1e9 - 1 else most
    if least is not None and most is not None:
        return f"{kind}, {number(least)} to {number(most)}"
    return f"{kind}, at least {number(least)}" if least is not None else kind


def default_words(p):
    if derived(p):
        return "from the mesh"
    if p["type"] == "choice":
        return f"`{p['names'][p['value']]}`"
    if p["type"] == "boolean":
        return str(p["value"]).lower()
    if p["type"] == "text":
        return f'`"{p["value"]}"`'
    return ", ".join(map(number, p["value"])) if isinstance(p["value"], list) else number(p["value"])


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
        out += ["", "See:", "", *[f"- {s}" for s in sources]]
    return "\n".join(out) + "\n"


# ---- Python functions ------------------------------------------------------------------------------------------------

TYPES = {"boolean": "bool", "integer": "int", "real": "float", "slider": "float", "angle": "float", "text": "str",
         "layer": "int", "point": "Vector", "direction": "Vector"}  # fmt: skip
FIELD = {"boolean": "bool", "integer": "int", "real": "float", "list": "Array"}

# Bases of reports: name, the field by which it is found, purpose. A base has all fields that the same filters return.
BASES = (
    ("Movement", "largest_displacement", "How far a filter moved vertices, and what that did to the shape."),
    ("PyramidUse", "pyramid_reused", "The pyramid that a filter used."),
    ("AttributeChanges", "*_largest_change", "How far a filter changed attributes."),
    ("Result", "result_hash", "What a filter that changes something returns."),
)


def literal(names):
    return "Literal[" + ", ".join(f'"{n}"' for n in names) + "]"


def packed(items, indent=4):
    """The items, separated by commas, on as few lines as they fit on."""
    lines = [" " * indent]
    for item in items:
        if lines[-1].strip() and len(lines[-1]) + len(item) + 2 > 120:
            lines.append(" " * indent)
        lines[-1] += (" " if lines[-1].strip() else "") + item + ","
    return lines if items else []


def shared_choices(rows):
    """Type names of the choices that several filters have, by their values: ("Roy", "Guskov") -> "Scheme"."""
    choices = [(p["name"], tuple(p["names"])) for r in rows for p in r["parameters"] if p["type"] == "choice"]
    alike = {name: {names for n, names in choices if n == name} for name, _ in choices}
    return {names: "".join(w.capitalize() for w in name.split("_")) for name, names in choices
            if len(alike[name]) == 1 and choices.count((name, names)) > 1}  # fmt: skip


def alias(name, values):
    one = f"{name}: TypeAlias = {literal(values)}"
    return [one] if len(one) <= 120 else [f"{name}: TypeAlias = Literal[", *packed([f'"{v}"' for v in values]), "]"]


def python_type(p, shared):
    return TYPES.get(p["type"]) or shared.get(tuple(p["names"])) or literal(p["names"])


def annotation(p, shared):
    kind = python_type(p, shared)
    return f"{p['name']}: {kind} | None = None" if derived(p) else f"{p['name']}: {kind} = {python_default(p)}"


def python_default(p):
    if p["type"] == "choice":
        return f'"{p["names"][p["value"]]}"'
    if isinstance(p["value"], list):
        return repr(tuple(map(float, p["value"])))
    if TYPES[p["type"]] == "float":
        return repr(float(p["value"]))
    return repr(p["value"]).replace("'", '"')


def meaning(p):
    """What a parameter means, its range, and what None is."""
    said = p["tooltip"]
    if TYPES.get(p["type"]) in ("int", "float") and p["type"] != "layer":
        said += f" A {allowed(p)}."
    return said + (" None: derived from the mesh." if derived(p) else "")


def described(parameters):
    """The lines on parameters in a docstring; one for neighbours that mean the same (gain_1, gain_2, ...)."""
    for said, alike in itertools.groupby(parameters, meaning):
        yield from wrapped(f"{', '.join(p['name'] for p in alike)}: {said}", 8, 4)


def wrapped(text, indent, hanging=0):
    return textwrap.wrap(text, 120, initial_indent=" " * indent, subsequent_indent=" " * (indent + hanging))


def documented(text, indent=4):
    """A docstring."""
    lines = textwrap.wrap(f'"""{text}', 117 - indent)
    return [" " * indent + line for line in lines[:-1]] + [" " * indent + lines[-1] + '"""']


def camel(name):
    return "".join(w.capitalize() for w in name.split("_"))


def report_class(row):
    return camel(function_name(row)) + "Report"


def pyramid_class(pyramid, shared):
    lines = ["", "", "@dataclasses.dataclass(frozen=True, kw_only=True)", "class Pyramid:"]
    lines += documented("How a pyramid is built. What is None is the filter's own default; the one named here is that of "
                        "most filters. A pyramid is kept with its mesh and reused by calls with an equal Pyramid.")  # fmt: skip
    lines += [""]
    for p in pyramid:
        lines += [f"    {p['name']}: {python_type(p, shared)} | None = None"]
        lines += documented(f"{meaning(p)} Default: {default_words(p).replace('`', '')}.")
    return lines


def field_lines(r):
    """A report's field. What exists once for each attribute becomes a dictionary by attribute."""
    name, kind, default = r["key"], FIELD[r["type"]], ""
    if name.startswith("*_"):
        name, kind, default = name[2:], f"dict[str, {kind}]", " = dataclasses.field(default_factory=dict)"
    elif not r["always"]:
        kind, default = f"{kind} | None", " = None"
    unit = f" ({r['unit']})" if r["unit"] else ""
    by = " By attribute." if r["key"].startswith("*") else ""
    return [f"    {name}: {kind}{default}", *documented(f"{r['meaning'].rstrip('.')}{unit}.{by}")]


def report_bases(rows):
    """Name of a base -> (purpose, its fields, the reports that have it)."""
    holders = {}
    for row in rows:
        for r in row["returns"]:
            holders.setdefault(json.dumps(r), []).append(report_class(row))
    bases = {}
    for name, key, purpose in BASES:
        classes = next(c for r, c in holders.items() if json.loads(r)["key"] == key)
        bases[name] = purpose, [json.loads(r) for r, c in holders.items() if c == classes], classes
    return bases


def dataclass(name, bases, purpose, fields):
    parents = f"({', '.join(bases)})" if bases else ""
    lines = ["", "", "@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)", f"class {name}{parents}:"]
    return [*lines, f'    """{purpose}"""', "", *[line for r in fields for line in field_lines(r)]]


def report_classes(rows):
    bases = report_bases(rows)
    lines = [line for name, (purpose, fields, _) in bases.items() for line in dataclass(name, [], purpose, fields)]
    for row in rows:
        name = report_class(row)
        mine = [base for base, (_, _, classes) in bases.items() if name in classes]
        inherited = [r for base in mine for r in bases[base][1]]
        fields = [r for r in row["returns"] if r not in inherited]
        lines += dataclass(name, mine, f"What {function_name(row)}() returns.", fields)
    return lines


def function(row, pyramid, shared):
    purpose, sources = purpose_and_sources(row["info"])
    own, whole = own_parameters(row, pyramid), takes_pyramid(row, pyramid)
    lines = ["", "", *["@also_flat(Pyramid)"] * whole, f"def {function_name(row)}("]
    lines += packed(["ms: MeshSet", "*", *[annotation(p, shared) for p in own],
                     *["pyramid: Pyramid | None = None"] * whole])  # fmt: skip
    lines += [f") -> {report_class(row)}:"]
    first, *rest = re.split(r"(?<=\.)\s+", purpose, maxsplit=1)
    lines += [*wrapped(f'"""{first}', 4), ""]
    for paragraph in [*rest, f"The filter {row['python_name']}, on the current mesh; the mesh is unchanged if it fails."]:
        lines += [*wrapped(paragraph, 4), ""]
    lines += ["    Args:", "        ms: the document."]
    lines += described(own)
    lines += ["        pyramid: how the pyramid is built. None: the filter's defaults."] * whole
    lines += ["", "    Raises:", "        pymeshlab.PyMeshLabException: the mesh or a value will not do; it says why.", ""]
    lines += ["    See:", *[line for s in sources for line in wrapped(s, 8, 4)], '    """']
    return [*lines, f'    return apply({report_class(row)}, "{row["python_name"]}", **locals())']


def limits(rows, pyramid):
    """Least and most of every number that has both, by function or class, and parameter."""
    lines = ["", "", "LIMITS: dict[str, dict[str, tuple[float, float]]] = {"]
    of_functions = [(function_name(r), own_parameters(r, pyramid)) for r in rows]
    for name, parameters in [("Pyramid", pyramid), *of_functions]:
        ranges = [f'"{p["name"]}": ({number(p["least"])}, {number(p["most"])})' for p in parameters
                  if p.get("least") is not None and p.get("most") is not None and p["most"] < 1e9 - 1]  # fmt: skip
        lines += [f'    "{name}": {{', *packed(ranges, 8), "    },"] if ranges else []
    return [*lines, "}", '"""Least and most of the numbers that have both, by function (or class) and parameter."""']


def python_module(rows):
    """python/src/pymeshlab_multires/_filters.py"""
    shared, pyramid = shared_choices(rows), pyramid_parameters(rows)
    names = sorted([*map(function_name, rows), *map(report_class, rows), *shared.values(), *[b[0] for b in BASES],
                    "LIMITS", "Pyramid"])  # fmt: skip
    used = {TYPES.get(p["type"]) for r in rows for p in r["parameters"]}
    imported = ["Array", "MeshSet", *["Vector"] * ("Vector" in used), "also_flat", "apply"]
    lines = [
        '"""A function and a report for every filter. Written by tools/generate.py from the filter tables."""',
        "",
        "import dataclasses",
        "from typing import Literal, TypeAlias",
        "",
        f"from ._call import {', '.join(imported)}",
        "",
        "__all__ = [",
        *packed([f'"{n}"' for n in names]),
        "]",
        "",
        *[line for values, name in shared.items() for line in alias(name, values)],
        *pyramid_class(pyramid, shared),
        *report_classes(rows),
    ]
    for row in rows:
        lines += function(row, pyramid, shared)
    return "\n".join(lines + limits(rows, pyramid)) + "\n"


# ---- .mlx examples ---------------------------------------------------------------------------------------------------

RICH = {"boolean": "RichBool", "integer": "RichInt", "real": "RichFloat", "slider": "RichDynamicFloat",
        "angle": "RichFloat", "choice": "RichEnum", "text": "RichString"}  # fmt: skip


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
