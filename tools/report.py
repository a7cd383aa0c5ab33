"""The page that tools/compare.py writes: one HTML file with pictures and charts in it and no script.

All figures are also in it as JSON, in the element with the id "figures".
"""

import base64
import html
import importlib.metadata
import io
import json
import math
import os
import pathlib
import platform

import numpy as np

import charts
import rendering

STYLE = (pathlib.Path(__file__).parent / "report.css").read_text()
CLOSE_UP = 0.26  # side of a close-up, in sides of the whole view
ERROR_COLORS, MOVED_COLORS = "RdBu_r", "YlOrBr"


def text(value):
    return html.escape(str(value))


def number(value, form=".2f", missing="–"):
    """With a true minus sign; the dash where there is nothing to say."""
    return missing if value is None or not math.isfinite(value) else format(value, form).replace("-", "−")


def degrees(value):
    return number(value, ".2f" if value < 9.95 else ".1f") + "°"


# ---- pictures --------------------------------------------------------------------------------------------------------


def picture(image, alt, **attributes):
    """An <img> with the picture inside."""
    data = io.BytesIO()
    image.save(data, "WEBP", quality=84, method=4)
    more = "".join(f' {key.rstrip("_")}="{text(value)}"' for key, value in attributes.items())
    return (f'<img src="data:image/webp;base64,{base64.b64encode(data.getvalue()).decode()}" alt="{text(alt)}" '
            f'width="{image.width}" height="{image.height}"{more}>')  # fmt: skip


class Views:
    """Renders outcomes from one camera: whole, close up, coloured by error or by movement."""

    def __init__(self, first, results, others, up, tile):
        """first: gives the camera; results: outcomes of filters, whose errors and movements give the scales of the
        colours; the close-up is where they differ most from the first. others: what else is to be seen."""
        self.tile = tile
        self.camera = rendering.three_quarter_camera(first.vertices, first.faces, up)
        self.shaded = {o.title: self._render(o, self.camera) for o in [first, *results, *others]}
        x, y = rendering.busiest_square([self.shaded[o.title] for o in [first, *results]], CLOSE_UP)
        self.near = self.camera.closer(x, y, CLOSE_UP)
        self.rows = rendering.rows_in_use([self.shaded[first.title]])
        self.mark = [(1 + s * p) / 2 * tile for s, p in ((1, x), (-1, y))]
        pooled = [np.concatenate(values) for values in ([np.abs(o.error) for o in results], [o.moved for o in results])]
        self.most_error, self.most_moved = (charts.round_up(float(np.quantile(p, 0.97)) or 1e-9) for p in pooled)

    def _render(self, outcome, camera, colors=None):
        return rendering.render(rendering.Panel("", "", outcome.vertices, outcome.faces, colors), camera, self.tile)

    def _cropped(self, image):
        return image.crop((0, self.rows[0], self.tile, self.rows[1]))

    def whole(self, outcome):
        """With the place of the close-up marked."""
        image = self.shaded[outcome.title].copy()
        reach = CLOSE_UP * self.tile / 2
        corners = [c - reach for c in self.mark] + [c + reach for c in self.mark]
        rendering.ImageDraw.Draw(image).rectangle(corners, outline=rendering.MARK, width=max(2, self.tile // 150))
        return self._cropped(image)

    def close_up(self, outcome):
        return self._render(outcome, self.near)

    def error(self, outcome):
        colors = rendering.coloured(outcome.error, -self.most_error, self.most_error, ERROR_COLORS)
        return self._cropped(self._render(outcome, self.camera, colors))

    def moved(self, outcome):
        colors = rendering.coloured(outcome.moved, 0, self.most_moved, MOVED_COLORS)
        return self._cropped(self._render(outcome, self.camera, colors))


def kind(outcome):
    """Class of the outcome in the style sheet."""
    return {True: "ours", False: "theirs", None: "given"}[outcome.ours]


def name(outcome):
    """With whose filter it is."""
    return ("" if outcome.ours is None else "multires: " if outcome.ours else "MeshLab: ") + outcome.title


def gallery(outcomes, image, alt, caption, wide=False):
    """A grid with captions; image(outcome) is a picture or, where alt is None, HTML."""

    def shown(o):
        return image(o) if alt is None else picture(image(o), f"{alt} {name(o)}", loading="lazy")

    figures = [f'<figure class="{kind(o)}">{shown(o)}'
               f'<figcaption><strong>{text(o.title)}</strong> <span>{caption(o)}</span></figcaption></figure>'
               for o in outcomes]  # fmt: skip
    # As many columns as leave the last row fullest.
    columns = max((6, 5, 4), key=lambda c: (len(figures) % c or c) / c) if len(figures) > 4 else 4
    return f'<div class="gallery{" wide" if wide else ""}" style="--columns:{columns}">{"".join(figures)}</div>'


# ---- what it says ----------------------------------------------------------------------------------------------------


def best(outcomes, figure="angle"):
    return min(outcomes, key=lambda o: o.figures[figure])


def rivals(case, smoothers):
    """(ours, MeshLab's) of the first screen: Denoise, and the best of MeshLab's; without a truth, the one that moves
    vertices about as far."""
    ours = next(o for o in smoothers if o.title == "Denoise")
    theirs = [o for o in smoothers if o.ours is False]
    if case.truth_known:
        return ours, best(theirs)
    moved = max(ours.figures["moved"], 1e-9)
    return ours, min(theirs, key=lambda o: abs(math.log(max(o.figures["moved"], 1e-9) / moved)))


def headline(case, ours, theirs):
    a, b = degrees(ours.figures["angle"]), degrees(theirs.figures["angle"])
    if not case.truth_known:
        return f"Denoise and MeshLab’s {theirs.title} smoothing, moving {case.name} about equally far"
    untuned, tuned = f"Denoise, untuned: normals off by {a}.", f"MeshLab’s best of all settings, {theirs.title}: {b}."
    first = ours.figures["angle"] <= theirs.figures["angle"]
    return f"{untuned} {tuned}" if first else f"{tuned} {untuned}"


def summary(case, inputs, smoothers):
    if not case.truth_known:
        return ("The true surface is not known, so nothing here is better or worse: every filter ran with its own "
                "defaults and is measured against the input. Shown first are Denoise and the MeshLab smoother that "
                "moves vertices about as far.")  # fmt: skip
    theirs = [o for o in smoothers if o.ours is False]
    begin = (f"{case.noise:g} edge lengths of noise were added to {text(case.name)}" if case.noise else
             "The truth is known")  # fmt: skip
    return (f"{begin}; the input’s normals are off by {degrees(inputs[0].figures['angle'])}. MeshLab’s {len(theirs)} "
            f"smoothers were tried with {sum(o.tried for o in theirs)} settings and judged by the truth; Denoise ran "
            "once, with its defaults.")  # fmt: skip


def hero_figures(case, o):
    """Figures under a picture of the first screen."""
    f = o.figures
    if o.ours is None and not case.truth_known:
        return [(f"{len(o.vertices):,}", "vertices")]
    if o.title == "Truth":
        return [(f"{len(o.vertices):,}", "vertices")]
    against = "" if case.truth_known else " from the input"
    lines = [(degrees(f["angle"]), f"normals{against}"), (number(f["rms"], ".3f"), f"edge lengths RMS{against}")]
    if o.ours is not None:
        kept = "volume" if math.isfinite(f["volume"]) else "area"
        lines.append((number(f[kept], "+.2f") + " %", kept))
    return lines


def hero(case, views, shown):
    tiles = []
    for o in shown:
        figures = "".join(f"<li><b>{value}</b> {label}</li>" for value, label in hero_figures(case, o))
        says = text(o.words) or ("what was given" if o is shown[0] else "without noise")
        tiles.append(
            f'<figure class="{kind(o)}"><figcaption><strong>{text(o.title)}</strong><span>{says}</span><ul>{figures}</ul>'
            f'</figcaption>{picture(views.whole(o), f"{name(o)}, whole view", class_="whole")}'
            f'{picture(views.close_up(o), f"{name(o)}, close-up", class_="near")}</figure>')  # fmt: skip
    return f'<div class="hero n{len(shown)}">{"".join(tiles)}</div>'


def bars(outcomes, figure, form):
    """A horizontal bar for each outcome, least first."""
    ordered = sorted(outcomes, key=lambda o: o.figures[figure])
    most = max(o.figures[figure] for o in ordered) or 1
    rows = "".join(
        f'<li class="{kind(o)}"><span>{text(name(o))}</span>'
        f'<i style="width:{max(0.5, 100 * o.figures[figure] / most):.1f}%"></i><b>{number(o.figures[figure], form)}</b></li>'
        for o in ordered)  # fmt: skip
    return f'<ol class="bars">{rows}</ol>'


COLUMNS = (  # key, heading, format
    ("seconds", "seconds", ".3f"),
    ("angle", "normals off by, degrees", ".2f"),
    ("rms", "RMS distance", ".3f"),
    ("largest", "largest distance", ".2f"),
    ("volume", "volume, %", "+.2f"),
    ("area", "area, %", "+.2f"),
    ("folded", "flipped faces", "d"),
    ("moved", "vertices moved, RMS", ".3f"),
    ("drift", "of it along the surface", ".3f"),
    ("shape", "triangle shape, mean", ".3f"),
)


def figures_table(outcomes, against, label):
    """Least (for shape: largest) of each column in bold, among filters."""
    filters = [o for o in outcomes if o.ours is not None]
    ideal = {"shape": max, "seconds": min, "angle": min, "rms": min, "largest": min, "folded": min, "drift": min}
    winner = {}
    if against == "the truth":
        winner = {key: pick(o.figures[key] for o in filters) for key, pick in ideal.items()}
    rows = []
    for o in outcomes:
        cells = []
        for key, _, form in COLUMNS:
            value = o.figures[key]
            shown = number(value, form)
            first = o.ours is not None and key in winner and value == winner[key]
            cells.append(f"<td>{'<b>' if first else ''}{shown}{'</b>' if first else ''}</td>")
        tried = f" (of {o.tried} tried)" if o.tried > 1 else ""
        rows.append(f'<tr class="{kind(o)}"><th scope="row">{text(name(o))}</th>{"".join(cells)}'
                    f"<td class=words>{text(o.words)}{tried}</td></tr>")  # fmt: skip
    head = "".join(f'<th scope="col">{text(heading)}</th>' for _, heading, _ in COLUMNS)
    table = (f'<table><caption>{label}</caption><thead><tr><th scope="col">filter</th>{head}'
             f'<th scope="col">parameters</th></tr></thead><tbody>{"".join(rows)}</tbody></table>')  # fmt: skip
    return f'<div class="scroll" tabindex="0" role="region" aria-label="{text(label)}">{table}</div>'


def section(title, words, *body):
    return f"<section><h2>{title}</h2><p>{words}</p>{''.join(body)}</section>"


def spectra(outcomes, given):
    """Charts of the RMS detail of each level, over those of input and truth."""
    scale = charts.spectrum_scale([o.levels for o in [*outcomes, *given]])
    return gallery(outcomes, lambda o: charts.spectrum(o, given, scale), None, lambda o: text(o.words), wide=True)


def triangle_shapes(outcomes, before):
    most = max(charts.share(o.shapes).max() for o in [*outcomes, before])
    return gallery(outcomes, lambda o: charts.shapes(o, before, most), None,
                   lambda o: f"mean {number(before.figures['shape'], '.3f')} → {number(o.figures['shape'], '.3f')}",
                   wide=True)  # fmt: skip


def how(case, smoothers, bands):
    """How it was measured, in words."""
    reference = "truth" if case.truth_known else "input"
    tuning = (
        "A filter is only as good as its parameters, so MeshLab’s smoothers got the best of a grid: each was run with "
        "every setting of it, and what is shown is the one with the least mean angle to the true normals; the list "
        "below also has the setting with the least RMS distance. Nobody who has only the noisy mesh can choose like "
        "this. Ours ran with the defaults, which they derive from the mesh; where a row says something else, the row "
        "says what."
        if case.truth_known else
        "There is no truth to tune for, so every filter ran with its defaults. With <code>--truth</code> or "
        "<code>--noise</code> MeshLab’s filters are tuned.")  # fmt: skip
    grids = "".join(f"<li>{grid_words(o)}</li>" for o in [*smoothers, *bands] if o.ours is False)
    version = text(importlib.metadata.version("pymeshlab"))
    return f"""<p><strong>Tuning.</strong> {tuning}</p><ul>{grids}</ul>
<p><strong>Measures.</strong> Lengths are in mean edge lengths of the {reference}, {number(case.edge, ".4g")} mesh units.
<em>Normals off by</em>: mean angle between each face’s normal and that of the same face of the {reference} (of the
nearest face if the meshes differ). <em>Distance</em>: from the vertices of each surface to the other, both ways.
<em>Flipped</em>: faces turned by more than 90°. <em>Along the surface</em>: the part of the vertices’ way that lies in
the tangent plane; smoothing noise needs little of it, and textures slide by it. <em>Triangle shape</em>: 1 is
equilateral, 0 degenerate. <em>Spectrum</em>: RMS detail of each level of the pyramid that
<code>compute_multires_pyramid</code> builds of the result.</p>
<p><strong>Times.</strong> Medians in one pymeshlab {version} process, without reading and writing files, with building
the pyramid ({os.cpu_count()} cores, {platform.machine()}).</p>"""


def grid_words(o):
    """What was tried of a filter of MeshLab, and what won."""
    words = f"{text(o.title)}: {o.tried} setting{'s' * (o.tried > 1)}; shown: {text(o.words)}"
    if o.least_rms is not None:
        words += f"; least RMS distance: {number(o.least_rms[0], '.3f')} with {text(o.least_rms[1])}"
    return words


def as_json(case, groups):
    """All figures, for programs."""
    rows = [{"title": o.title, "whose": kind(o), "parameters": o.words, "task": task, "tried": o.tried,
             **{k: (None if v is None or not math.isfinite(v) else float(v)) for k, v in o.figures.items()}}
            for task, outcomes in groups.items() for o in outcomes]  # fmt: skip
    data = {"mesh": case.name, "noise": case.noise, "truth_known": case.truth_known, "edge_length": case.edge,
            "rows": rows}  # fmt: skip
    return json.dumps(data).replace("</", "<\\/")


def legend(least, most, middle, colors, edge):
    return charts.legend([rendering.coloured(np.array([x]), 0, 1, colors)[0] for x in np.linspace(0, 1, 17)],
                         (number(least / edge, ".2g"), middle, number(most / edge, ".2g") + " edge lengths"))  # fmt: skip


def movement(outcomes, views, edge, words):
    """The movement maps and their legend."""
    return legend(0, views.most_moved, "", MOVED_COLORS, edge) + gallery(
        outcomes, views.moved, "Movement of the vertices:", words
    )


def ranking(inputs, smoothers):
    """Bars of the two errors, least first."""
    rivals_and_input = [*inputs[:1], *smoothers]
    return section(
        "All smoothers, ranked",
        "Shorter is nearer to the truth.",
        '<div class="pair"><div><h3>Mean angle of the normals to the truth, degrees</h3>',
        bars(rivals_and_input, "angle", ".2f"),
        "</div><div><h3>RMS distance to the truth, edge lengths</h3>",
        bars(rivals_and_input, "rms", ".3f"),
        "</div></div>",
    )


def smoothing(case, inputs, ranked, views):
    """Figures, pictures and charts of the smoothers."""
    known = case.truth_known
    against = "the truth" if known else "the input"
    yield section(
        "Figures",
        f"Measured against {against}; lengths in mean edge lengths.{' The best of each column in bold.' * known}",
        figures_table([*inputs[:1], *ranked], against, f"Smoothing filters against {against}"),
    )
    yield section(
        "Close up",
        "The marked square of the first pictures, all from the same camera and in the same light.",
        gallery([*inputs, *ranked], views.close_up, "Close-up:", lambda o: text(o.words)),
    )
    yield section(
        f"Distance to {against}",
        "Red: outside it, blue: inside. An even blue on round parts is shrinking.",
        legend(-views.most_error, views.most_error, "0", ERROR_COLORS, case.edge),
        gallery([*inputs[:-1], *ranked], views.error, f"Signed distance to {against}:",
                lambda o: f"RMS {number(o.figures['rms'], '.3f')}, largest {number(o.figures['largest'])}"),
    )  # fmt: skip
    yield section(
        "How far vertices moved",
        "From where they were in the input.",
        movement(ranked, views, case.edge, lambda o: f"RMS {number(o.figures['moved'], '.3f')}, along the surface "
                                                     f"{number(o.figures['drift'], '.3f')}"),
    )  # fmt: skip
    reading = (
        ", dashed: the truth. The nearer the thick line is to it, the more of the shape was kept." if known else "."
    )
    yield section(
        "Detail by scale",
        "RMS detail of each level of the pyramid over its wavelength (both in mesh units, logarithmic). Thick: after "
        f"the filter. Thin: the input{reading}",
        spectra(ranked, inputs),
    )
    yield section(
        "Shape of the triangles",
        "Share of triangles by shape, from degenerate (0) to equilateral (1). Filled: the input, line: after the filter.",
        triangle_shapes(ranked, inputs[0]),
    )


def banding(case, original, bands, views):
    """The filters of bands."""
    noiseless = ", without the noise" if case.truth_known else ""
    return section(
        "Working on a band of scales",
        "MeshLab has one filter of this kind, the unsharp mask; the others choose the scales they change. These ran on "
        f"the mesh itself{noiseless}. No truth says how sharp a mesh should be: the unsharp mask is shown at the "
        f"setting, of {bands[-1].tried}, that moves vertices as far as Enhance does.",
        gallery([*original, *bands], views.whole, "Whole view:", lambda o: text(o.words)),
        gallery([*original, *bands], views.close_up, "Close-up:", lambda o: ""),
        "<h3>How far vertices moved</h3>",
        movement(bands, views, case.edge, lambda o: f"RMS {number(o.figures['moved'], '.3f')}"),
        "<h3>Detail by scale</h3>",
        spectra(bands, original),
        figures_table([*original, *bands], "the original", "Filters of bands against the original"),
    )


def page(case, inputs, smoothers, original, bands, up=None, tile=440):
    """The whole page. The four lists are what compare() returns."""
    ours, theirs = rivals(case, smoothers)
    views = Views(inputs[-1], smoothers, inputs[:-1], up, tile)  # from the truth if there is one
    ranked = sorted(smoothers, key=lambda o: o.figures["angle"])
    parts = [
        hero(case, views, [*inputs, theirs, ours]),
        ranking(inputs, smoothers) if case.truth_known else "",
        *smoothing(case, inputs, ranked, views),
        banding(case, original, bands, Views(original[0], bands, [], up, tile)),
        f"<section><h2>How it was done</h2>{how(case, smoothers, bands)}</section>",
    ]
    figures = as_json(case, {"input": inputs, "smooth": smoothers, "band": [*original, *bands]})
    mesh = text(case.name)
    return f"""<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">
<title>Smoothing {mesh}: MeshLab and meshlab-multires</title><style>{STYLE}</style></head>
<body><header>
<p class="eyebrow">meshlab-multires beside MeshLab’s own filters · {mesh}, {len(case.vertices):,} vertices</p>
<h1>{text(headline(case, ours, theirs))}</h1><p>{summary(case, inputs, smoothers)}</p></header>
<main>{"".join(parts)}</main>
<script type="application/json" id="figures">{figures}</script></body></html>
"""
