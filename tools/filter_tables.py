"""The filter tables of the build, and what the generated documents and functions say of them alike."""

import html
import json
import re
import subprocess

# Names of the Python functions; a filter that is not here is called by its Python name.
FUNCTIONS = {
    "compute_multires_pyramid": "build_pyramid",
    "generate_multires_level": "level_as_layer",
    "compute_scalar_multires_detail_per_vertex": "detail_to_quality",
    "compute_scalar_multires_difference_per_vertex": "difference_to_layer",
    "compute_multires_roughness": "roughness",
    "compute_scalar_multires_relief_per_vertex": "relief",
    "compute_custom_multires_scales": "details_by_scale",
    "compute_selection_multires_features": "select_features",
    "apply_coord_multires_low_pass": "low_pass",
    "apply_coord_multires_stop_band": "stop_band",
    "apply_coord_multires_enhance": "enhance",
    "apply_coord_multires_equalizer": "equalizer",
    "apply_coord_multires_unsharp": "unsharp",
    "apply_coord_multires_denoise": "denoise",
    "apply_coord_multires_transfer_edit": "transfer_edit",
    "apply_coord_multires_watermark": "watermark",
    "compute_multires_watermark": "read_watermark",
    "apply_coord_multires_displace": "move_region",
    "compute_scalar_multires_falloff_per_vertex": "falloff_to_quality",
    "generate_multires_base": "smooth_base_as_layer",
    "apply_coord_multires_bands": "multiband_edit",
    "transfer_coord_multires_detail": "detail_from_layer",
    "apply_attributes_multires_relaxation": "relax_attributes",
    "apply_attributes_multires_band": "filter_attributes",
    "apply_attributes_multires_band_custom": "filter_custom_attributes",
    "apply_attributes_multires_denoise": "denoise_attributes",
    "generate_multires_texcoord": "generate_texcoord",
    "generate_multires_adaptive_reconstruction": "adaptive_reconstruction",
    "compute_multires_grid": "grid",
    "apply_coord_multires_grid_band": "grid_band",
    "apply_coord_multires_grid_compress": "grid_compress",
    "generate_multires_grid_level": "grid_level",
    "apply_coord_multires_grid_edit": "grid_edit",
    "apply_attributes_multires_grid_band": "filter_grid_attributes",
    "apply_attributes_multires_grid_compress": "compress_grid_attributes",
}


def tables(build):
    """The filters as the tables declare them, in the order of FUNCTIONS; those that are not there last."""
    rows = json.loads(subprocess.check_output([build / "tests/tables/multires_list_filters"]))
    order = list(FUNCTIONS)
    return sorted(rows, key=lambda r: order.index(r["python_name"]) if r["python_name"] in order else len(order))


def function_name(row):
    return FUNCTIONS.get(row["python_name"], row["python_name"])


def open_default(p):
    """What the default follows from, in words; None if it is a value. A filter without a layer given takes the first
    other one."""
    if p["type"] == "layer":
        return "the first other layer"
    return "from the mesh" if p.get("derived") else None


def plain(text):
    """HTML as plain text."""
    return " ".join(html.unescape(re.sub(r"<[^>]+>", "", text.replace("<br>", " "))).split())


def purpose_and_sources(info):
    """What a filter does, and its papers: 'authors, "title", where.'"""
    purpose, *cited = re.split(r"(?:<br>)+See (?=<i>)", info)
    return plain(purpose), [plain(c) for c in cited]


def number(value):
    return f"{value:g}"


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
    if open_default(p):
        return open_default(p)
    if p["type"] == "choice":
        return f"`{p['names'][p['value']]}`"
    if p["type"] == "boolean":
        return str(p["value"]).lower()
    if p["type"] == "text":
        return f'`"{p["value"]}"`'
    return ", ".join(map(number, p["value"])) if isinstance(p["value"], list) else number(p["value"])
