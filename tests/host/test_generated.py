"""What tools/generate.py writes from the filter tables: up to date, true, and of use in pymeshlab."""

import re
import sys

import numpy as np
import pymeshlab
import pytest
from conftest import BUILD, FILTER_IDS, FILTERS, citations, load_plugins, wants_another_layer, wants_grid

ROOT = BUILD.parents[1]
sys.path.insert(0, str(ROOT / "tools"))
import generate  # noqa: E402

load_plugins()
EXAMPLES = sorted((ROOT / "examples").glob("*.mlx"))
TYPES = {"boolean": bool, "integer": int, "real": float, "list": np.ndarray}

# Parameters beside the defaults that bring out what is not always returned.
MORE = {
    "compute_multires_watermark": [{"expected": "6d756c7469726573"}],
    "generate_multires_adaptive_reconstruction": [{"target": "RMS distance", "use_color": True, "use_quality": True},
                                                  {"measure": False}],
    "apply_attributes_multires_relaxation": [{"quality": True, "texcoord": True, "wedge_texcoord": True, "custom": True}],
    "apply_attributes_multires_band": [{"quality": True}, {"quality": True, "method": "spline", "measure": True}],
    "apply_attributes_multires_band_custom": [{"method": "spline", "measure": True}],
    "apply_attributes_multires_denoise": [{"quality": True, "custom": True}, {"rule": "soft"}],
    "apply_coord_multires_denoise": [{"method": "normal field"}, {"method": "soft threshold"},
                                     {"method": "hard threshold", "keep_volume": True}],
    "compute_scalar_multires_difference_per_vertex": [{"wavelength": 0.2}],
    "compute_multires_roughness": [{"form": "sphere", "l_filter": 0}],
    "generate_multires_texcoord": [{"projection": "planar"}, {"projection": "existing"}],
    **{f"apply_coord_multires_{name}": [{"method": "spline", "measure": True}, {"method": "pyramid"}]
       for name in ("low_pass", "stop_band", "enhance")},
    "apply_coord_multires_equalizer": [{"method": "spline", "measure": True, "gain_3": 0}],
    "apply_coord_multires_transfer_edit": [{"encoding": "phong", "bands": 3}],
    "apply_coord_multires_grid_edit": [{"attributes": True}],
    "transfer_coord_multires_detail": [{"use": "store"}, {"finest": 0.2}],
}  # fmt: skip


def terrain(meshes, another_layer=False, name="terrain"):
    """A document with a mesh that has every kind of attribute."""
    ms = pymeshlab.MeshSet(verbose=False)
    if another_layer:
        ms.load_new_mesh(str(meshes / ("grid.ply" if name == "grid" else "disk.ply")))
    ms.load_new_mesh(str(meshes / f"{name}.ply"))
    ms.current_mesh().add_vertex_custom_scalar_attribute(ms.current_mesh().vertex_matrix()[:, 2], "height")
    ms.compute_texcoord_transfer_vertex_to_wedge()
    return ms


def wanted():
    return generate.files(generate.tables(BUILD))


@pytest.mark.parametrize("path", wanted())
def test_file_is_up_to_date(path):
    assert (ROOT / path).read_text() == wanted()[path], "run tools/generate.py"


def test_there_are_no_other_examples():
    assert {f"examples/{p.name}" for p in EXAMPLES} == {p for p in wanted() if p.endswith(".mlx")}


def section_of(row):
    """What docs/parameters.md says of a filter."""
    text = (ROOT / "docs/parameters.md").read_text()
    return text.split(f'<a id="{row["python_name"]}"></a>')[1].split("<a id=")[0]


@pytest.mark.parametrize("row", FILTERS, ids=FILTER_IDS)
def test_reference_has_the_filter_with_all_parameters_and_results(row):
    section = section_of(row)
    assert f"## {row['name'].removeprefix('Multiresolution: ')}\n" in section
    assert not re.search(r"</?[bi]>|<br>|&\w+;|  \w| [.,]", section.split("|")[0]), "HTML was left in the text"
    rows = re.findall(r"^\| `([^`]+)`", section, re.MULTILINE)
    assert sorted(rows) == sorted([*(p["name"] for p in row["parameters"]), *(r["key"] for r in row["returns"])])


@pytest.mark.parametrize("row", FILTERS, ids=FILTER_IDS)
def test_reference_cites_every_paper_whole(row):
    cited = section_of(row).rstrip().rpartition("See:\n\n")[2].splitlines()
    assert cited == [f'- {authors}, "{title}", {where}' for authors, title, where in citations(row["info"])]


def test_every_kind_of_parameter_is_written():
    """Those that no filter may have yet, too."""
    kinds = [{"name": "other", "type": "layer", "value": None}, {"name": "at", "type": "point", "value": [0, 1, 2.5]},
             {"name": "along", "type": "direction", "value": [0, 0, 1], "derived": True},
             {"name": "turn", "type": "angle", "value": 45, "least": 0, "most": 180}]  # fmt: skip
    said = {"label": "Label", "tooltip": "What it does.", "advanced": False}
    row = {"name": "Multiresolution: Kinds", "python_name": "kinds", "returns": [], "parameters": [k | said for k in kinds],
           "info": 'Does it.<br><br>See <i>Anybody</i>, <b>"A Title"</b>, SIGGRAPH 1999.'}  # fmt: skip
    rows = [*generate.tables(BUILD), row]
    reference, module = generate.reference(rows), generate.python_module(rows)
    for words in ("`other` | the first other layer | a layer", "`at` | 0, 1, 2.5 | three numbers",
                  "`along` | from the mesh | three numbers", "`turn` | 45 | number, 0 to 180"):  # fmt: skip
        assert f"| {words} |" in reference
    signature = re.sub(r"\s+", " ", module.split("def kinds(")[1].split("->")[0])
    assert signature == (" ms: MeshSet, *, other: int | None = None, at: Vector = (0.0, 1.0, 2.5), along: Vector | None = "
                         "None, turn: float = 45.0, ) ")  # fmt: skip
    compile(module, "_filters.py", "exec")


@pytest.mark.parametrize(
    "name",
    [
        "README.md",
        "CONTRIBUTING.md",
        "docs/denoising.md",
        "docs/denoising_evidence.md",
        "docs/parameters.md",
        "python/README.md",
        "examples/README.md",
    ],
)
def test_links_lead_somewhere(name):
    text = (ROOT / name).read_text()
    for link in re.findall(r"\]\(([^)\s]+)\)|<img src=\"([^\"]+)\"", text):
        path, _, anchor = "".join(link).partition("#")
        target = (ROOT / name).parent / path if path else ROOT / name
        assert path.startswith("http") or target.exists(), link
        assert not anchor or f'<a id="{anchor}"></a>' in target.read_text(), link


def test_every_filter_has_a_picture_in_the_readme_and_all_are_small():
    readme = (ROOT / "README.md").read_text()
    for row in FILTERS:
        line = next(line for line in readme.splitlines() if f"`{row['python_name']}`<br>" in line)
        assert f"docs/pictures/{generate.function_name(row).replace('_', '-')}.webp" in line
    assert sum(p.stat().st_size for p in (ROOT / "docs/pictures").iterdir()) < 3_000_000


def declared(row, key):
    """The entry of the table that stands for a key of a report."""
    for r in sorted(row["returns"], key=lambda r: -len(r["key"])):
        if r["key"] == key or (r["key"].startswith("*") and key.endswith(r["key"][1:])):
            return r
    return None


@pytest.mark.parametrize("row", FILTERS, ids=FILTER_IDS)
def test_reports_hold_what_the_table_says(row, meshes):
    seen = set()
    for more in [{}, *MORE.get(row["python_name"], [])]:
        name = "grid" if wants_grid(row["python_name"]) else "terrain"
        ms = terrain(meshes, wants_another_layer(row["python_name"]), name)
        report = ms.apply_filter(row["python_name"], **more)
        for key, value in report.items():
            entry = declared(row, key)
            assert entry, f"{key} is returned and not declared"
            assert isinstance(value, TYPES[entry["type"]]), key
            seen.add(entry["key"])
        assert {r["key"] for r in row["returns"] if r["always"]} <= set(report)
    assert {r["key"] for r in row["returns"]} == seen, "declared and not returned"


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda p: p.stem)
def test_example_runs_in_pymeshlab(path, meshes):
    """With the same result as the filters called one by one."""
    ms, other = terrain(meshes), terrain(meshes)
    ms.load_filter_script(str(path))
    ms.apply_filter_script()
    for name, parameters in generate.EXAMPLES[path.stem][1]:
        other.apply_filter(name, **parameters)
    before = terrain(meshes).current_mesh()
    mesh, same = ms.current_mesh(), other.current_mesh()
    np.testing.assert_allclose(mesh.vertex_matrix(), same.vertex_matrix(), atol=1e-6)
    np.testing.assert_array_equal(mesh.vertex_color_matrix(), same.vertex_color_matrix())
    changed = (mesh.vertex_number() != before.vertex_number() or np.ptp(mesh.vertex_matrix() - before.vertex_matrix()) > 0
               or np.ptp(mesh.vertex_color_matrix() - before.vertex_color_matrix()) > 0)  # fmt: skip
    assert changed
