"""docs/filters.json: our filters as MeshLab's successor declares its own. docs/successor.md says what follows from
that program's public documentation and what is a guess."""

import json
import re
import unicodedata

from filter_tables import plain, purpose_and_sources

# What plugins/shared/table.h calls Parts.
FACES, POSITIONS, QUALITY, COLOR, TEXCOORD, WEDGE_TEXCOORD, NEW_LAYER, CUSTOM, VERTEX_SELECTION, EDGE_SELECTION = (
    1 << bit for bit in range(10)
)  # fmt: skip
REQUIREMENTS = {FACES: "requireFaces", QUALITY: "requireVertexQuality", COLOR: "requireVertexColor"}
CODES = {POSITIONS: ["VG", "VN", "FN"], QUALITY: ["VQ"], COLOR: ["VC"], TEXCOORD: ["VT"], WEDGE_TEXCOORD: ["WT"],
         CUSTOM: ["VA"], VERTEX_SELECTION: ["VS"], EDGE_SELECTION: ["FES"]}  # fmt: skip

# Name as Verb Object, categories, and for new layers the tag of their name. All of ours together are one family, which
# that vocabulary wants named in parentheses.
FAMILY = "Multires"
NAMES = {
    "compute_multires_pyramid": ("Measure Detail by Level", ["Measurement/Statistics"]),
    "generate_multires_level": ("Create Coarse Level", ["Meshing/Simplification"], "level"),
    "compute_scalar_multires_detail_per_vertex": ("Compute Detail of Band", ["Attribute/Scalar"]),
    "compute_scalar_multires_difference_per_vertex": ("Compute Signed Distance to Layer", ["Attribute/Scalar"]),
    "compute_multires_roughness": ("Measure Roughness", ["Measurement/Statistics"]),
    "compute_scalar_multires_relief_per_vertex": ("Compute Relief", ["Attribute/Scalar", "Attribute/Color"]),
    "compute_custom_multires_scales": ("Compute Detail by Scale", ["Attribute/Custom", "Attribute/Scalar"]),
    "compute_selection_multires_features": ("Select Feature Lines", ["Selection/by Attribute"]),
    "apply_coord_multires_low_pass": ("Smooth Vertices by Low Pass", ["Geometry/Smoothing"]),
    "apply_coord_multires_stop_band": ("Smooth Vertices by Stop Band", ["Geometry/Smoothing"]),
    "apply_coord_multires_enhance": ("Sharpen Vertices by Band", ["Geometry/Smoothing"]),
    "apply_coord_multires_equalizer": ("Adjust Vertices by Equalizer", ["Geometry/Smoothing"]),
    "apply_coord_multires_unsharp": ("Sharpen Vertices by Unsharp Mask", ["Geometry/Smoothing"]),
    "apply_coord_multires_denoise": ("Smooth Vertices by Noise Estimate", ["Geometry/Smoothing"]),
    "apply_coord_multires_watermark": ("Add Watermark", ["Geometry/Deformation"]),
    "compute_multires_watermark": ("Extract Watermark", ["Measurement/Geometric"]),
    "apply_coord_multires_transfer_edit": ("Transfer Edit of Coarse Layer",
                                           ["Geometry/Deformation", "Transfer/Between Layers"]),
    "apply_coord_multires_displace": ("Transform Selected Region", ["Geometry/Deformation"]),
    "compute_scalar_multires_falloff_per_vertex": ("Compute Falloff from Selection", ["Attribute/Scalar"]),
    "generate_multires_base": ("Create Smooth Base", ["Geometry/Smoothing"], "smooth base"),
    "apply_coord_multires_bands": ("Adjust Vertices by Multiband Gains",
                                   ["Geometry/Smoothing", "Geometry/Deformation"]),
    "transfer_coord_multires_detail": ("Transfer Detail from Layer",
                                       ["Transfer/Between Layers", "Geometry/Deformation"]),
    "apply_attributes_multires_relaxation": ("Smooth Attributes by Relaxation", ["Attribute", "Parametrization"]),
    "apply_attributes_multires_band": ("Adjust Attributes by Band", ["Attribute/Color", "Attribute/Scalar"]),
    "apply_attributes_multires_band_custom": ("Adjust Custom Attributes by Band", ["Attribute/Custom"]),
    "apply_attributes_multires_denoise": ("Smooth Attributes by Noise Estimate", ["Attribute"]),
    "generate_multires_texcoord": ("Parametrize by Coarse Level", ["Parametrization/UV Creation"]),
    "generate_multires_adaptive_reconstruction": ("Simplify by Adaptive Reconstruction", ["Meshing/Simplification"],
                                                  "adaptive"),
    "compute_multires_grid": ("Measure Triangular Grid", ["Measurement/Topological"]),
    "apply_coord_multires_grid_band": ("Adjust Grid by Band", ["Geometry/Smoothing"]),
    "apply_coord_multires_grid_compress": ("Threshold Wavelets of Grid", ["Geometry/Smoothing"]),
    "generate_multires_grid_level": ("Create Level of Grid", ["Meshing/Subdivision", "Meshing/Simplification"],
                                     "grid level"),
    "apply_coord_multires_grid_edit": ("Transfer Edit of Grid Level",
                                       ["Geometry/Deformation", "Transfer/Between Layers"]),
    "apply_attributes_multires_grid_band": ("Adjust Attributes of Grid by Band", ["Attribute"]),
    "apply_attributes_multires_grid_compress": ("Threshold Wavelets of Grid Attributes", ["Attribute"]),
}  # fmt: skip

ARTICLES = {"the", "a", "an"}
TYPES = {"boolean": "bool", "integer": "int", "real": "double", "slider": "double", "angle": "double", "choice": "enum",
         "text": "string", "layer": "mesh", "point": "point3f", "direction": "point3f"}  # fmt: skip


def snake(name):
    """A display name as identifier: 'Smooth Vertices by Low Pass (Multires)', smooth_vertices_by_low_pass_multires."""
    return "_".join(w for w in re.findall(r"[a-z0-9]+", name.lower()) if w not in ARTICLES)


def camel(name):
    first, *rest = name.split("_")
    return first + "".join(w.capitalize() for w in rest)


# ---- papers ----------------------------------------------------------------------------------------------------------


def reference(source):
    """A source, 'authors, "title", where year.', in the fields of CSL-JSON."""
    authors, title, where, year = re.fullmatch(r'(.+?), "(.+)", (?:(.+) )?(\d{4})\.', source).groups()
    first = unicodedata.normalize("NFKD", authors.split(",")[0].lower().replace("æ", "ae"))
    word = next(w for w in re.findall(r"[a-z0-9]+", title.lower()) if len(w) > 3 or w.isdigit())
    kinds = {"standard": title.startswith("ISO"), "article-journal": "IEEE" in (where or ""),
             "report": "ETH" in (where or "")}  # fmt: skip
    kind = next((k for k, it_is in kinds.items() if it_is), "paper-conference")
    out = {"id": re.sub("[^a-z]", "", first) + year + word, "type": kind, "title": title,
           "author": [{"family": a} for a in authors.split(", ")],
           "issued": {"date-parts": [[int(year)]]}}  # fmt: skip
    return out | ({"container-title": where} if where else {})


# ---- filters ---------------------------------------------------------------------------------------------------------


def group(p):
    """The section of the form; one that begins with "advanced" is folded away."""
    own = p["group"].lower()
    if not p["advanced"]:
        return own or "main"
    return f"advanced.{own}" if own else "advanced"


def option(name):
    return {"id": re.sub(r"[^a-z0-9]+", "_", name.lower()).strip("_"), "label": name[0].upper() + name[1:]}


def typed(p):
    """What a parameter's type asks for: range, decimals, options; and the default, where the mesh does not give it."""
    kind = TYPES[p["type"]]
    out = {"type": kind}
    if kind == "mesh":
        return out | {"default": "@otherMeshIndex", "meshRequirements": {"requireVertices": True, "requireFaces": True}}
    if kind == "enum":
        options = [option(n) for n in p["names"]]
        return out | {"default": options[p["value"]]["id"], "enumOptions": options}
    if kind == "point3f":
        role = "direction" if p["type"] == "direction" else "point"
        preset = {"point3fDefaultPreset": "bboxCenter"} if p["derived"] else {}
        return out | {"default": [0, 0, 0] if p["derived"] else p["value"], "point3fRole": role} | preset
    if not p["derived"]:
        out["default"] = p["value"]
    for theirs, ours in (("min", "least"), ("max", "most")):
        if ours in p and abs(p[ours]) < 1e9 - 1:  # more is no limit but the type's own
            out[theirs] = p[ours]
    return out | ({"decimals": 3 if p["type"] in ("slider", "angle") else 6} if kind == "double" else {})


def parameter(p):
    told = " By default derived from the mesh." if p["derived"] and TYPES[p["type"]] not in ("mesh", "point3f") else ""
    return {"id": camel(p["name"]), "label": p["label"].split(":")[0], "help": p["tooltip"] + told, "group": group(p),
            **typed(p)}  # fmt: skip


def selection_scope(row):
    """The kind of elements that a filter can be confined to; that program has one parameter for it in all filters."""
    if not any(p["name"] == "selected" for p in row["parameters"]):
        return {}
    return {"selectionScope": "vertices" if row["changes"] else "faces"}  # what only measures, measures faces


def named(row):
    if row["python_name"] not in NAMES:
        raise ValueError(f"NAMES of tools/generate_filters_json.py lacks {row['python_name']}")
    name, categories, *tag = NAMES[row["python_name"]]
    return f"{name} ({FAMILY})", categories, *tag


def domains(row):
    two = any(p["type"] == "layer" for p in row["parameters"])
    if row["changes"] & NEW_LAYER:
        out, tag = "NewMeshes", {"outputTag": named(row)[2]}
    else:
        out, tag = "ModifyCurrentMesh" if row["changes"] else "Information", {}
    codes = [c for part, cs in CODES.items() if row["changes"] & part for c in cs]
    modifies = {"outputModifies": codes} if out == "ModifyCurrentMesh" else {}
    return {"inputDomain": "WholeDocument" if two else "SingleMesh", "outputDomain": out, **tag, **modifies}


def descriptor(row, references):
    name, categories, *_ = named(row)
    purpose, sources = purpose_and_sources(row["info"])
    needed = {"requireVertices": True} | {n: True for part, n in REQUIREMENTS.items() if row["needs"] & part}
    tags = dict.fromkeys(w.lower() for c in categories for w in c.split("/"))
    return {
        "id": snake(name),
        "categories": categories,
        "name": name,
        "pythonName": snake(name),
        "shortDescription": re.split(r"(?<=\.)\s+", plain(purpose))[0],
        "longDescriptionMarkdown": purpose,
        "referenceIds": [references[s]["id"] for s in sources],
        "tags": ["multiresolution", row["name"].removeprefix("Multiresolution: ").lower(), *tags],
        **domains(row),
        "inputRequirements": needed,
        **selection_scope(row),
        "parameters": [parameter(p) for p in row["parameters"] if p["name"] != "selected"],
    }


def lines(value, depth=0):
    """JSON with what is short on one line."""
    flat = json.dumps(value, ensure_ascii=False)
    if not isinstance(value, (dict, list)) or len(flat) + 2 * depth <= 116 or depth >= 4:
        return flat
    inner = "  " * (depth + 1)
    items = [f"{json.dumps(k)}: {lines(v, depth + 1)}" for k, v in value.items()] if isinstance(value, dict) else \
        [lines(v, depth + 1) for v in value]  # fmt: skip
    opening, closing = "{}" if isinstance(value, dict) else "[]"
    return opening + "\n" + ",\n".join(inner + i for i in items) + "\n" + "  " * depth + closing


def filters_json(rows):
    """docs/filters.json"""
    sources = dict.fromkeys(s for row in rows for s in purpose_and_sources(row["info"])[1])
    references = {s: reference(s) for s in sources}
    document = {
        "pluginId": "meshlab2.filter.multires",
        "provenance": {"project": "meshlab-multires", "license": "GPL-3.0-or-later"},
        "references": list(references.values()),
        "filters": [descriptor(row, references) for row in rows],
    }
    return lines(document) + "\n"
