"""The page that tools/compare.py writes: report.html, a jinja2 template, filled with pictures and charts.

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

import jinja2
import matplotlib
import numpy as np
from markupsafe import Markup

import charts
import rendering

HERE = pathlib.Path(__file__).parent
CLOSE_UP = 0.26  # side of a close-up, in sides of the whole view
ERROR_COLORS, MOVED_COLORS = "RdBu_r", "YlOrBr"
COLUMNS = {  # key: heading, format
    "seconds": ("seconds", ".3f"),
    "angle": ("normals off by, degrees", ".2f"),
    "rms": ("RMS distance", ".3f"),
    "largest": ("largest distance", ".2f"),
    "volume": ("volume, %", "+.2f"),
    "area": ("area, %", "+.2f"),
    "folded": ("flipped faces", "d"),
    "moved": ("vertices moved, RMS", ".3f"),
    "drift": ("of it along the surface", ".3f"),
    "shape": ("triangle shape, mean", ".3f"),
}
BEST = {"shape": max, "seconds": min, "angle": min, "rms": min, "largest": min, "folded": min, "drift": min}


def number(value, form=".2f"):
    """With a true minus sign; a dash where there is nothing to say."""
    return format(value, form).replace("-", "−") if finite(value) else "–"


def finite(value):
    return value is not None and math.isfinite(value)


def degrees(value):
    return number(value, ".2f" if value < 9.95 else ".1f") + "°"


def picture(image, alt, **attributes):
    """An <img> with the picture inside."""
    data = io.BytesIO()
    image.save(data, "WEBP", quality=82, method=5)
    attributes |= {"alt": alt, "width": image.width, "height": image.height}
    more = " ".join(f'{key.rstrip("_")}="{html.escape(str(value))}"' for key, value in attributes.items())
    return Markup(f'<img src="data:image/webp;base64,{base64.b64encode(data.getvalue()).decode()}" {more}>')


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

    def reading(self, outcome, reading):
        known = np.isfinite(reading.values)
        values = np.where(known, reading.values, reading.least)
        colors = rendering.coloured(values, reading.least, reading.most, reading.colors)
        return self._cropped(self._render(outcome, self.camera, np.where(known[:, None], colors, 1.0)))

    def moved(self, outcome):
        colors = rendering.coloured(outcome.moved, 0, self.most_moved, MOVED_COLORS)
        return self._cropped(self._render(outcome, self.camera, colors))


def kind(outcome):
    """Class of the outcome in the style sheet."""
    return {True: "ours", False: "theirs", None: "given"}[outcome.ours]


def name(outcome):
    """With whose filter it is."""
    return {True: "multires: ", False: "MeshLab: ", None: ""}[outcome.ours] + outcome.title


def columns(count):
    """As many columns as leave the last row fullest."""
    return max((6, 5, 4), key=lambda c: (count % c or c) / c) if count > 4 else 4


def gradient(colors):
    """The colour map as stops of a CSS gradient."""
    return ", ".join(matplotlib.colors.to_hex(c) for c in matplotlib.colormaps[colors](np.linspace(0, 1, 17)))


def winners(filters):
    """Key -> the best figure of the filters."""
    return {key: best(o.figures[key] for o in filters) for key, best in BEST.items()}


def first_screen(case, smoothers):
    """(ours, MeshLab's): Denoise, and the best of MeshLab's; without a truth, the one that moves vertices about as
    far."""
    ours = next(o for o in smoothers if o.title == "Denoise")
    theirs = [o for o in smoothers if o.ours is False]
    if case.truth_known:
        return ours, min(theirs, key=lambda o: o.figures["angle"])
    moved = max(ours.figures["moved"], 1e-9)
    return ours, min(theirs, key=lambda o: abs(math.log(max(o.figures["moved"], 1e-9) / moved)))


def as_json(case, groups, curves, textures):
    """All figures, for programs."""
    rows = [{"title": o.title, "whose": kind(o), "parameters": o.words, "task": task, "tried": o.tried,
             **{k: float(v) if finite(v) else None for k, v in o.figures.items()}}
            for task, outcomes in groups.items() for o in outcomes]  # fmt: skip
    data = {"mesh": case.name, "noise": case.noise, "truth_known": case.truth_known, "edge_length": case.edge,
            "rows": rows, "transmission": {title: [waves, shares] for title, _, waves, shares in curves},
            "roughness": {o.title: {k: float(n) for k, n in t.items()} for o, t in textures}}  # fmt: skip
    return Markup(json.dumps(data).replace("</", "<\\/"))


def page(case, inputs, smoothers, original, bands, curves, readings, textures, up=None, tile=440):
    """The whole page. The first four lists are what compare() returns, the others what transmissions(), readings() and
    textures() do."""
    environment = jinja2.Environment(loader=jinja2.FileSystemLoader(HERE), autoescape=True,
                                     undefined=jinja2.StrictUndefined)  # fmt: skip
    environment.filters |= {"number": number, "finite": finite, "degrees": degrees, "kind": kind}
    environment.globals |= {"charts": charts, "picture": picture, "name": name, "columns": columns,
                            "gradient": gradient, "winners": winners, "COLUMNS": COLUMNS,
                            "ERROR_COLORS": ERROR_COLORS, "MOVED_COLORS": MOVED_COLORS}  # fmt: skip
    ours, theirs = first_screen(case, smoothers)
    return environment.get_template("report.html").render(
        case=case, inputs=inputs, original=original, bands=bands, ours=ours, theirs=theirs,
        smoothers=sorted(smoothers, key=lambda o: o.figures["angle"]),
        rivals=[o for o in smoothers if o.ours is False],
        views=Views(inputs[-1], smoothers, inputs[:-1], up, tile),  # from the truth if there is one
        band_views=Views(original[0], bands, [], up, tile),
        most_share=max(charts.share(o.shapes).max() for o in [*smoothers, inputs[0]]),
        figures=as_json(case, {"input": inputs, "smooth": smoothers, "band": [*original, *bands]}, curves, textures),
        curves=curves, readings=readings, textures=textures,
        style=Markup((HERE / "report.css").read_text()),
        pymeshlab_version=importlib.metadata.version("pymeshlab"),
        machine=f"{os.cpu_count()} cores, {platform.machine()}",
    )  # fmt: skip
