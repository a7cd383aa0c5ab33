"""Small charts as inline SVG, for the page of tools/report.py. Colours come from its style sheet, by class."""

import html
import math

import numpy as np

WIDTH, HEIGHT = 280, 180
LEFT, RIGHT, TOP, BOTTOM = 42, 270, 10, 150  # of the plotting area
BINS = 25


def round_up(value):
    """The least of 1, 1.5, 2, 3, 5, 7 times a power of ten that is not below the value."""
    power = 10.0 ** math.floor(math.log10(value))
    return next(f * power for f in (1, 1.5, 2, 3, 5, 7, 10) if f * power >= value * (1 - 1e-9))


def plain(value):
    return f"{value:g}" if value == 0 or value >= 0.001 else f"{value:.0e}".replace("e-0", "e-")


def frame(label, body):
    return (
        f'<svg viewBox="0 0 {WIDTH} {HEIGHT}" role="img" aria-label="{html.escape(label)}">'
        f'<path class="axis" d="M{LEFT} {TOP}V{BOTTOM}H{RIGHT}"/>{body}</svg>'
    )


def polyline(xs, ys, kind):
    return f'<polyline class="{kind}" points="{" ".join(f"{x:.1f},{y:.1f}" for x, y in zip(xs, ys))}"/>'


def ticks(values, at, horizontal):
    """Marks and numbers below (horizontal) or left of the plotting area."""
    out = []
    for value in values:
        p = at(value)
        out.append(
            f'<path class="tick" d="M{p:.1f} {BOTTOM}v4"/><text x="{p:.1f}" y="{BOTTOM + 16}" text-anchor="middle">{plain(value)}</text>'
            if horizontal
            else f'<path class="grid" d="M{LEFT} {p:.1f}H{RIGHT}"/><text x="{LEFT - 5}" y="{p + 4:.1f}" text-anchor="end">{plain(value)}</text>'
        )
    return "".join(out)


def round_values(least, most):
    """1, 2 and 5 times powers of ten in the range; powers alone if those were more than four."""
    powers = range(math.floor(math.log10(least)), math.ceil(math.log10(most)) + 1)
    for factors in ((1, 2, 5), (1, 3), (1,)):
        values = [f * 10.0**p for p in powers for f in factors if least <= f * 10.0**p <= most]
        if len(values) <= 4:
            break
    return values


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

    def across(x):
        return LEFT + (RIGHT - LEFT) * (np.log(x) - math.log(least_x)) / (math.log(most_x) - math.log(least_x))

    def up(y):
        y = np.log(np.maximum(y, least_y))
        return BOTTOM - (BOTTOM - TOP) * (y - math.log(least_y)) / (math.log(most_y) - math.log(least_y))

    kinds = ["before", "truth"]
    lines = [polyline(across(o.levels[0]), up(o.levels[1]), k) for o, k in zip(given, kinds)]
    lines.append(polyline(across(outcome.levels[0]), up(outcome.levels[1]), "after"))
    marks = ticks(round_values(least_x, most_x), across, True) + ticks(round_values(least_y, most_y), up, False)
    axis = f'<text class="name" x="{(LEFT + RIGHT) / 2}" y="{HEIGHT - 2}" text-anchor="middle">wavelength</text>'
    return frame(f"Detail by wavelength, before and after {outcome.title}", marks + "".join(lines) + axis)


def share(shapes):
    """Percent of the triangles in each bin of shape."""
    return 100 * np.histogram(shapes, BINS, (0, 1))[0] / len(shapes)


def shapes(outcome, before, most):
    """Histogram of the shapes of triangles: before filled, after as a line."""
    most = round_up(most)

    def steps(values):
        xs = LEFT + (RIGHT - LEFT) * np.repeat(np.arange(BINS + 1), 2)[1:-1] / BINS
        return xs, BOTTOM - (BOTTOM - TOP) * np.repeat(values, 2) / most

    xs, ys = steps(share(before.shapes))
    filled = f'<polygon class="filled" points="{LEFT},{BOTTOM} {" ".join(f"{x:.1f},{y:.1f}" for x, y in zip(xs, ys))} {RIGHT},{BOTTOM}"/>'
    marks = ticks((0, 0.5, 1), lambda x: LEFT + (RIGHT - LEFT) * x, True)
    marks += ticks((most / 2, most), lambda y: BOTTOM - (BOTTOM - TOP) * y / most, False)
    axis = f'<text class="name" x="{(LEFT + RIGHT) / 2}" y="{HEIGHT - 2}" text-anchor="middle">shape; up: percent of triangles</text>'
    return frame(
        f"Shape of the triangles before and after {outcome.title}",
        filled + marks + polyline(*steps(share(outcome.shapes)), "after") + axis,
    )


def legend(colors, labels):
    """A band of colours with a label at its left, middle and right."""
    stops = ", ".join("#" + "".join(f"{round(255 * c):02x}" for c in color) for color in colors)
    return (
        f'<div class="legend"><i style="background:linear-gradient(90deg,{stops})"></i>'
        + "".join(f"<span>{html.escape(label)}</span>" for label in labels)
        + "</div>"
    )
