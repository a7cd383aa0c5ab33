"""tools/compare.py: its page on a small generated mesh, read as HTML, checked against direct measurements, and shown
in a real browser at the widths of a phone and of a screen."""

import html.parser
import json
import re
import subprocess
import sys

import numpy as np
import pymeshlab
import pytest
from browser import Browser
from conftest import BUILD, load_plugins

TOOLS = BUILD.parents[1] / "tools"
sys.path.insert(0, str(TOOLS))
import measuring  # noqa: E402

OURS = {"Denoise", "Low pass", "Low pass, spline", "Denoise, soft threshold", "Enhance", "Equalizer", "Stop band",
        "Unsharp (single level)"}  # fmt: skip
MESHLAB = {"Laplacian, umbrella", "Laplacian, cotangent", "Taubin", "HC Laplacian", "Two-step",
           "Scale-dependent Laplacian", "Unsharp mask, geometry"}  # fmt: skip


class Page(html.parser.HTMLParser):
    """Elements with their attributes, words, and the figures as JSON."""

    def __init__(self, source):
        super().__init__()
        self.elements, self.words, self.figures, self._inside = [], [], "", []
        self.feed(source)
        self.figures = json.loads(self.figures)

    def handle_starttag(self, tag, attributes):
        self.elements.append((tag, dict(attributes)))
        if tag in ("script", "style"):
            self._inside.append(dict(attributes).get("id", tag))

    def handle_endtag(self, tag):
        if tag in ("script", "style"):
            self._inside.pop()

    def handle_data(self, data):
        if not self._inside:
            self.words.append(data)
        elif self._inside[-1] == "figures":
            self.figures += data

    def rows(self, task):
        return {row["title"]: row for row in self.figures["rows"] if row["task"] == task}


def compared(folder, mesh, *arguments):
    subprocess.run([sys.executable, TOOLS / "compare.py", mesh, "--output", folder, "--build", BUILD, "--tile", "96",
                    "--repeats", "1", *arguments], check=True)  # fmt: skip
    return folder / "comparison.html"


@pytest.fixture(scope="module")
def mesh(tmp_path_factory):
    folder = tmp_path_factory.mktemp("scan")
    subprocess.run([BUILD / "meshes/make_meshes", folder, "2000"], check=True)
    return folder / "scan_2000.ply"


@pytest.fixture(scope="module")
def path(mesh, tmp_path_factory):
    return compared(tmp_path_factory.mktemp("noise"), mesh, "--noise", "0.3")


@pytest.fixture(scope="module")
def page(path):
    return Page(path.read_text())


def test_every_filter_is_in_the_page_and_in_its_words(page):
    rows = {(row["whose"], row["title"]) for row in page.figures["rows"]}
    assert {title for whose, title in rows if whose == "ours"} == OURS
    assert {title for whose, title in rows if whose == "theirs"} == MESHLAB
    said = " ".join(page.words)
    assert all(title in said for title in OURS | MESHLAB)


def test_the_page_is_self_contained_and_says_what_pictures_show(page, path):
    for tag, attributes in page.elements:
        assert tag not in ("link", "iframe", "object", "embed"), tag
        for key in ("src", "href", "srcset", "data", "action"):
            assert attributes.get(key, "data:").startswith("data:"), (tag, key)
        if tag == "img":
            assert len(attributes["alt"]) > 8 and int(attributes["width"]) > 0
        if tag == "script":
            assert attributes["type"] == "application/json"
    pictures = [a for tag, a in page.elements if tag == "img"]
    assert len(pictures) > 4 * len(MESHLAB)
    assert len({a["src"] for a in pictures}) > 3 * len(MESHLAB), "pictures of different meshes are the same"
    assert not re.search(r"url\(|@import|https?://", path.read_text().split('<script type="application/json"')[0])


def test_readings_and_roughness_are_in_the_page(page):
    alts = {a["alt"] for tag, a in page.elements if tag == "img"}
    for title in ("multires: Relief", "multires: Details by scale", "multires: Select Features",
                  "MeshLab: Ambient occlusion", "MeshLab: Discrete mean curvature", "MeshLab: Creases"):  # fmt: skip
        assert f"{title} in colour" in alts
    rough = page.figures["roughness"]
    assert set(rough) == {row["title"] for task in ("input", "smooth") for row in page.rows(task).values()}
    # Noise of 0.3 edges is taken for texture, and Denoise brings it nearer to the truth's.
    sq = {title: numbers["sq"] for title, numbers in rough.items()}
    assert sq["Noisy input"] > 0.2
    assert abs(sq["Denoise"] - sq["Truth"]) < 0.5 * abs(sq["Noisy input"] - sq["Truth"])


def test_the_tuning_is_told(page):
    said = " ".join(page.words)
    assert "best of a grid" in said
    smoothers = [row for row in page.rows("smooth").values() if row["whose"] == "theirs"]
    for row in smoothers:
        assert row["tried"] >= 6 and row["parameters"] in said
    assert f"{sum(row['tried'] for row in smoothers)} settings" in said
    assert page.rows("smooth")["Denoise"]["parameters"] == "defaults"


def angle(v, truth, f):
    """Mean degrees between the normals of the faces; written here again, that it may disagree."""
    a, b = (np.cross(x[f][:, 1] - x[f][:, 0], x[f][:, 2] - x[f][:, 0]) for x in (v, truth))
    cosine = (a * b).sum(1) / np.linalg.norm(a, axis=1) / np.linalg.norm(b, axis=1)
    return np.degrees(np.arccos(cosine.clip(-1, 1))).mean()


def test_figures_agree_with_a_direct_measurement(mesh, page):
    load_plugins()
    ms = pymeshlab.MeshSet(verbose=False)
    ms.load_new_mesh(str(mesh))
    truth, f = ms.current_mesh().vertex_matrix(), ms.current_mesh().face_matrix()
    noisy = measuring.with_noise(truth, f, "normals", 0.3, seed=1)
    edge = page.figures["edge_length"]
    assert edge == pytest.approx(np.mean([np.linalg.norm(t[k] - t[k - 1]) for t in truth[f] for k in range(3)]))
    assert page.rows("input")["Noisy input"]["angle"] == pytest.approx(angle(noisy, truth, f))

    ms.add_mesh(pymeshlab.Mesh(noisy, f))
    report = ms.apply_filter("apply_coord_multires_denoise")
    denoised = ms.current_mesh().vertex_matrix()
    row = page.rows("smooth")["Denoise"]
    assert row["angle"] == pytest.approx(angle(denoised, truth, f), rel=1e-6)
    assert row["moved"] * edge == pytest.approx(report["rms_displacement"], rel=1e-6)
    ways = [ms.get_hausdorff_distance(sampledmesh=a, targetmesh=1 - a, samplevert=True, sampleface=False,
                                      samplenum=10**6, maxdist=pymeshlab.PercentageValue(50)) for a in (0, 1)]  # fmt: skip
    assert row["rms"] * edge == pytest.approx(np.sqrt(np.mean([w["RMS"] ** 2 for w in ways])), rel=1e-3)
    assert row["largest"] * edge == pytest.approx(max(w["max"] for w in ways), rel=1e-3)
    before, after = (ms.mesh(i) for i in (0, 1))
    ms.set_current_mesh(0)
    area = ms.get_geometric_measures()["surface_area"]
    ms.set_current_mesh(1)
    assert row["area"] == pytest.approx(100 * (ms.get_geometric_measures()["surface_area"] / area - 1), abs=1e-4)


def test_tuned_filters_are_not_beaten_by_another_setting(mesh, page):
    """Taubin's filter, run here over MeshLab's default and a few more step counts."""
    ms = pymeshlab.MeshSet(verbose=False)
    ms.load_new_mesh(str(mesh))
    truth, f = ms.current_mesh().vertex_matrix(), ms.current_mesh().face_matrix()
    noisy = measuring.with_noise(truth, f, "normals", 0.3, seed=1)
    for steps in (5, 10, 20, 50):
        ms.add_mesh(pymeshlab.Mesh(noisy, f))
        ms.apply_coord_taubin_smoothing(stepsmoothnum=steps)
        assert page.rows("smooth")["Taubin"]["angle"] <= angle(ms.current_mesh().vertex_matrix(), truth, f) + 1e-9


def test_the_spline_filter_leaves_of_waves_what_the_formula_says(page):
    curves = page.figures["transmission"]
    assert set(curves) > MESHLAB - {"Unsharp mask, geometry"}
    waves, left = map(np.array, curves["Low pass, spline"])
    # Of random places, some waves of few edges are met too rarely.
    assert left == pytest.approx(1 / (1 + (10 / waves) ** 4), abs=0.035)
    assert np.interp(10, *curves["Formula"]) == pytest.approx(0.5, abs=0.01)
    assert "What is left of a wave" in " ".join(page.words)


def test_without_a_truth_nothing_is_called_better(mesh, tmp_path):
    page = Page(compared(tmp_path, mesh).read_text())
    assert page.figures["truth_known"] is False
    said = " ".join(page.words)
    assert "not known" in said and "ranked" not in said
    assert all(row["tried"] == 1 for row in page.rows("smooth").values())


def test_a_truth_with_other_faces_will_do(mesh, tmp_path):
    ms = pymeshlab.MeshSet(verbose=False)
    ms.load_new_mesh(str(mesh))
    ms.meshing_decimation_quadric_edge_collapse(targetfacenum=2500)
    v, f = measuring.arrays(ms.current_mesh())
    ms.add_mesh(pymeshlab.Mesh(measuring.with_noise(v, f, "normals", 0.2, seed=1), f))
    ms.save_current_mesh(str(tmp_path / "noisy.ply"))
    page = Page(compared(tmp_path, tmp_path / "noisy.ply", "--truth", mesh).read_text())
    rows = page.rows("smooth")
    assert all(0 < row["angle"] < 60 and 0 < row["rms"] < 3 for row in rows.values())
    assert rows["Denoise"]["angle"] < page.rows("input")["Noisy input"]["angle"]


@pytest.mark.parametrize("width", [390, 768, 1280])
def test_the_page_fits_its_window(path, tmp_path, width):
    with Browser() as browser:
        browser.open(path, width)
        assert browser.value("document.documentElement.scrollWidth") <= width
        browser.screenshot(tmp_path / "page.png")  # decodes every picture; a broken one is an error
        # Nothing sticks out but what scrolls in its own box.
        out = browser.value(
            "[...document.querySelectorAll('body *')].filter(e => !e.closest('.scroll') && !e.closest('svg') && "
            f"e.getBoundingClientRect().right > {width} + 0.5).map(e => e.outerHTML.slice(0, 80))"
        )
        assert out == []
        small = browser.value(
            "[...document.querySelectorAll('p, td, th, figcaption span, li')].filter(e => "
            "parseFloat(getComputedStyle(e).fontSize) < 12).length"
        )
        assert small == 0
        # The first pictures with their figures are there without scrolling.
        assert browser.value("document.querySelector('.hero .ours b').getBoundingClientRect().bottom") < 844
