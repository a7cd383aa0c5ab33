"""Small charts for the page of tools/report.py, by matplotlib, as SVG to be put into HTML."""

import io
import math
import re

import matplotlib
import numpy as np
from markupsafe import Markup, escape
from matplotlib.figure import Figure
from matplotlib.ticker import StrMethodFormatter

OURS, THEIRS, INK, BEFORE, FILLED, AXIS, GRID, FAINT = (
    "#0b6a60", "#5a6478", "#26262a", "#a4917a", "#e0d3c2", "#8c8b86", "#e3e2dc", "#5c5c63")  # fmt: skip
LOOK = {
    "svg.fonttype": "none", "svg.hashsalt": "charts", "font.sans-serif": ["DejaVu Sans"], "font.size": 8, "axes.labelsize": 8, "axes.labelcolor": FAINT,
    "xtick.labelsize": 8, "ytick.labelsize": 8, "xtick.color": AXIS, "ytick.color": AXIS, "xtick.labelcolor": FAINT,
    "ytick.labelcolor": FAINT, "xtick.major.size": 3, "ytick.major.size": 0, "axes.edgecolor": AXIS,
    "axes.spines.top": False, "axes.spines.right": False, "axes.axisbelow": True, "grid.color": GRID,
    "figure.facecolor": "none", "axes.facecolor": "none", "lines.dashed_pattern": (4, 3),
}  # fmt: skip
BINS = 25


def round_up(value):
    """The least of 1, 1.5, 2, 3, 5, 7 times a power of ten that is not below the value."""
    power = 10.0 ** math.floor(math.log10(value))
    return next(f * power for f in (1, 1.5, 2, 3, 5, 7, 10) if f * power >= value * (1 - 1e-9))


def round_values(least, most):
    """1, 2 and 5 times powers of ten in the range; powers alone if those were more than four."""
    powers = range(math.floor(math.log10(least)), math.ceil(math.log10(most)) + 1)
    for factors in ((1, 2, 5), (1, 3), (1,)):
        values = [f * 10.0**p for p in powers for f in factors if least <= f * 10.0**p <= most]
        if len(values) <= 4:
            break
    return values


def drawn(draw, label, size=(2.8, 1.8)):
    """The SVG of what draw(axes) draws, for HTML: without namespaces, and without ids, which a page has only once."""
    with matplotlib.rc_context(LOOK):
        figure = Figure(figsize=size)
        axes = figure.add_axes((0.45 / size[0], 0.36 / size[1], 1 - 0.53 / size[0], 1 - 0.45 / size[1]))
        axes.grid(axis="y")
        draw(axes)
        axes.minorticks_off()
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_formatter(StrMethodFormatter("{x:g}"))
        out = io.StringIO()
        figure.savefig(out, format="svg", metadata=dict.fromkeys(("Creator", "Date", "Format", "Type")))
    svg = out.getvalue()
    needless = r'<!--.*?-->|(?<=<g) id="[^"]*"| clip-path="[^"]*"| xmlns(:xlink)?="[^"]*"'  # everything is inside
    svg = re.sub(needless, "", svg[svg.index("<svg") :], flags=re.DOTALL)
    svg = svg.replace("<svg ", f'<svg role="img" aria-label="{escape(label)}" ', 1)
    return Markup(re.sub(r"\s*\n\s*", " ", svg))


def color(outcome):
    return OURS if outcome.ours else THEIRS


def spectrum_scale(levels):
    """(least and most wavelength, least and most detail) of all: what charts beside each other share."""
    waves = np.concatenate([w for w, _ in levels])
    details = np.concatenate([d for _, d in levels])
    details = details[details > 0]
    most = details.max() if details.size else 1.0
    least = max(details.min(), most * 1e-4) if details.size else 0.1
    return waves.min() / 1.05, waves.max() * 1.05, least / 1.2, most * 1.2


def spectrum(outcome, given, scale):
    """RMS detail over wavelength: the outcome thick, the given ones (input, then the truth) thin and dashed."""
    least_x, most_x, least_y, most_y = scale

    def draw(axes):
        for o, look in zip(given, ({"color": BEFORE, "lw": 1}, {"color": INK, "lw": 0.9, "ls": "--"})):
            axes.loglog(o.levels[0], np.maximum(o.levels[1], least_y), **look)
        axes.loglog(outcome.levels[0], np.maximum(outcome.levels[1], least_y), color=color(outcome), lw=1.8)
        axes.set(xlim=(least_x, most_x), ylim=(least_y, most_y), xlabel="wavelength",
                 xticks=round_values(least_x, most_x), yticks=round_values(least_y, most_y))  # fmt: skip

    return drawn(draw, f"Detail by wavelength, before and after {outcome.title}")


def share(shapes):
    """Percent of the triangles in each bin of shape."""
    return 100 * np.histogram(shapes, BINS, (0, 1))[0] / len(shapes)


def shapes(outcome, before, most):
    """Histogram of the shapes of triangles: before filled, after as a line."""
    most, edges = round_up(most), np.linspace(0, 1, BINS + 1)

    def draw(axes):
        axes.stairs(share(before.shapes), edges, fill=True, color=FILLED)
        axes.stairs(share(outcome.shapes), edges, baseline=None, color=color(outcome), lw=1.8)
        axes.set(xlim=(0, 1), ylim=(0, most), xticks=(0, 0.5, 1), yticks=(most / 2, most),
                 xlabel="shape; up: percent of triangles")  # fmt: skip

    return drawn(draw, f"Shape of the triangles before and after {outcome.title}")


def transmission(curves):
    """Share of a wave that is left, over its length in mean edges: ours with dots, the formula thin, MeshLab's dashed."""

    def draw(axes):
        dashes = iter(("--", ":", "-.", (0, (6, 2)), (0, (1, 1)), (0, (4, 1, 1, 1))))
        for title, ours, waves, shares in curves:
            look = ({"color": INK, "lw": 0.7} if ours is None
                    else {"color": OURS, "lw": 1.6, "marker": "o", "ms": 3} if ours
                    else {"color": THEIRS, "lw": 1.2, "ls": next(dashes, "-")})  # fmt: skip
            axes.plot(waves, shares, label=title, **look)
        waves = curves[0][2]
        axes.set(xscale="log", xlim=(min(waves), max(waves)), ylim=(-0.1, 1.2), xlabel="wavelength, mean edges",
                 xticks=round_values(min(waves), max(waves)))  # fmt: skip
        axes.axhline(0.5, color=FAINT, lw=0.5)
        axes.legend(frameon=False, fontsize=7, loc="lower right")

    return drawn(draw, "Share of a wave that each filter leaves, by wavelength", (6, 3.2))
