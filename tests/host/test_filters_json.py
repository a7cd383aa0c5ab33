"""docs/filters.json: what tools/generate.py writes for a port to MeshLab's successor keeps that program's rules.

That it is up to date is tested with the other generated files, in test_generated.py."""

import copy
import json
import re
import sys

import jsonschema
import pytest
from conftest import BUILD, FILTERS

ROOT = BUILD.parents[1]
sys.path.insert(0, str(ROOT / "tools"))
import generate_filters_json  # noqa: E402

DOCUMENT = json.loads((ROOT / "docs/filters.json").read_text())
VALIDATOR = jsonschema.Draft202012Validator(json.loads((ROOT / "docs/filters.schema.json").read_text()))


def descriptor(row):
    return next(d for d in DOCUMENT["filters"] if d["name"] == generate_filters_json.named(row)[0])


def problems(document):
    """What the schema cannot say."""
    ids = [d["id"] for d in document["filters"]]
    if len(set(ids)) != len(ids):
        yield "two filters of one id"
    known = {r["id"] for r in document["references"]}
    if len(known) != len(document["references"]):
        yield "two references of one id"
    for d in document["filters"]:
        if not set(d["referenceIds"]) <= known:
            yield f"{d['id']}: unknown reference"
        if len({p["id"] for p in d["parameters"]}) != len(d["parameters"]):
            yield f"{d['id']}: two parameters of one id"
        words = [w for w in re.findall("[a-z0-9]+", d["name"].lower()) if w not in ("a", "an", "the")]
        if not d["id"] == d["pythonName"] == "_".join(words):
            yield f"{d['id']}: three names in place of one"
        if d["categories"][0].startswith("Selection") and not {"VS", "FS", "ES", "FES"} & set(d["outputModifies"]):
            yield f"{d['id']}: selects, and does not say what"
        yield from (f"{d['id']}.{p['id']}: {what}" for p in d["parameters"] for what in out_of_range(p))


def out_of_range(p):
    if p["type"] == "enum":
        options = [o["id"] for o in p["enumOptions"]]
        if p["default"] not in options or len(set(options)) != len(options):
            yield "default or options"
    least, most = p.get("min", float("-inf")), p.get("max", float("inf"))
    if p["type"] in ("int", "double") and not (least < most and least <= p.get("default", least) <= most):
        yield "default or range"


def test_schema_is_one_and_the_description_keeps_it():
    jsonschema.Draft202012Validator.check_schema(VALIDATOR.schema)
    assert [f"{e.json_path}: {e.message[:200]}" for e in VALIDATOR.iter_errors(DOCUMENT)] == []
    assert list(problems(DOCUMENT)) == []


def test_every_filter_is_described_with_every_parameter():
    assert sorted(d["id"] for d in DOCUMENT["filters"]) == sorted(descriptor(row)["id"] for row in FILTERS)
    for row in FILTERS:
        names = [p["name"] for p in row["parameters"]]
        described = [p["id"].lower() for p in descriptor(row)["parameters"]]
        assert described == [n.replace("_", "") for n in names if n != "selected"], row["name"]
        assert ("selectionScope" in descriptor(row)) == ("selected" in names), row["name"]


def test_types_ranges_and_defaults_are_those_of_the_tables():
    for row in FILTERS:
        described = iter(descriptor(row)["parameters"])
        for p in row["parameters"]:
            if p["name"] == "selected":
                continue
            d = next(described)
            if p["type"] == "choice":
                assert [o["label"].lower() for o in d["enumOptions"]] == [n.lower() for n in p["names"]]
                assert d["enumOptions"][p["value"]]["id"] == d["default"]
            elif p["type"] in ("integer", "real", "slider", "angle"):
                assert ("default" in d) != p["derived"], (row["name"], p["name"])
                assert d.get("default", p["value"]) == p["value"] and d.get("min") == p.get("least")


WRONG = {
    "verb": (lambda d: d.update(name="Denoise Vertices (Multires)"), "name"),
    "category": (lambda d: d.update(categories=["Smoothing"]), "categories"),
    "code": (lambda d: d.update(outputModifies=["XY"]), "outputModifies"),
    "domain": (lambda d: d.update(outputDomain="NewMeshes"), "filters"),
    "markdown in a label": (lambda d: d.update(shortDescription="a *b*"), "shortDescription"),
    "type of another case": (lambda d: d["parameters"][0].update(type="Enum"), "parameters"),
    "no help": (lambda d: d["parameters"][0].pop("help"), "parameters"),
    "enum without options": (lambda d: d["parameters"][0].pop("enumOptions"), "parameters"),
}


@pytest.mark.parametrize("wrong", WRONG)
def test_schema_refuses(wrong):
    spoil, where = WRONG[wrong]
    d = copy.deepcopy(next(d for d in DOCUMENT["filters"] if d["id"] == "smooth_vertices_by_low_pass_multires"))
    document = {"pluginId": DOCUMENT["pluginId"], "filters": [d]}
    d["parameters"].sort(key=lambda p: p["type"] != "enum")
    assert VALIDATOR.is_valid(document)
    spoil(d)
    errors = list(VALIDATOR.iter_errors(document))
    assert errors and all(where in e.json_path for e in errors)


def test_what_the_schema_cannot_say_is_found():
    document = copy.deepcopy(DOCUMENT)
    by_id = {d["id"]: d for d in document["filters"]}
    low_pass, other = (by_id[f"smooth_vertices_by_{band}_multires"] for band in ("low_pass", "stop_band"))
    other["id"] = low_pass["id"]
    low_pass["referenceIds"] = ["nobody2026"]
    low_pass["parameters"][-1]["id"] = low_pass["parameters"][0]["id"]
    choice = next(p for p in low_pass["parameters"] if p["type"] == "enum")
    choice["default"] = "none_of_them"
    found = " ".join(problems(document))
    for what in ("two filters", "unknown reference", "two parameters", "three names", "default or options"):
        assert what in found
