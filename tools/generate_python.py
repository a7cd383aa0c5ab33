"""Writes the module of the Python package that has a typed function and a report for every filter."""

import itertools
import json
import re
import textwrap

from filter_tables import allowed, default_words, function_name, number, open_default, purpose_and_sources

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
    return f"{p['name']}: {kind} | None = None" if open_default(p) else f"{p['name']}: {kind} = {python_default(p)}"


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
    return said + (f" None: {open_default(p).replace('from', 'derived from')}." if open_default(p) else "")


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
    lines += wrapped(
        '"""How a pyramid is built. What is None is the filter\'s own default; the one named here is that of most filters.', 4
    )
    lines += ["", "    A pyramid is kept with its mesh and reused by calls with an equal Pyramid.", "", "    Args:"]
    for p in pyramid:
        lines += wrapped(f"{p['name']}: {meaning(p)} Default: {default_words(p).replace('`', '')}.", 8, 4)
    return [*lines, '    """', "", *[f"    {p['name']}: {python_type(p, shared)} | None = None" for p in pyramid]]


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


def filters(rows):
    """The filter of every function, as pymeshlab and as MeshLab's menu call it."""
    lines = ["", "", "FILTERS: dict[str, tuple[str, str]] = {"]
    lines += [f'    "{function_name(r)}": ("{r["python_name"]}", "{r["name"]}"),' for r in rows]
    return [*lines, "}", '"""By function: the name of its filter in pymeshlab, and the one in MeshLab\'s menu."""']


def python_module(rows):
    """python/src/pymeshlab_multires/_filters.py"""
    shared, pyramid = shared_choices(rows), pyramid_parameters(rows)
    names = sorted([*map(function_name, rows), *map(report_class, rows), *shared.values(), *[b[0] for b in BASES],
                    "FILTERS", "LIMITS", "Pyramid"])  # fmt: skip
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
    return "\n".join(lines + limits(rows, pyramid) + filters(rows)) + "\n"
