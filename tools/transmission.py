"""Draws docs/pictures/transmission.webp: how much of a wave the low pass leaves, by method, on an irregular sphere.

    .venv/bin/python tools/transmission.py

The waves are spherical harmonics as vertex quality, filtered by apply_attributes_multires_band at cutoffs around them.
Prints the largest difference between the spline method and its formula.
"""

import matplotlib
import measuring
import numpy as np
import pymeshlab
from charts import FAINT, LOOK, OURS, THEIRS
from matplotlib.figure import Figure

VERTICES, DEGREE = 20_000, 20
FORMULAS = {
    "1": lambda s: 1 / (1 + s),
    "2": lambda s: 1 / (1 + s**2),
    "4": lambda s: 1 / (1 + s**4),
    "gaussian": lambda s: np.exp2(-s),
}


def irregular_sphere(vertices):
    """Random places and the faces of their convex hull."""
    v = np.random.default_rng(5).normal(size=(vertices, 3))
    v /= np.linalg.norm(v, axis=1, keepdims=True)
    ms = measuring.document()
    ms.add_mesh(pymeshlab.Mesh(v))
    ms.generate_convex_hull()
    return measuring.arrays(ms.current_mesh())


def harmonic(v, degree):
    """A zonal spherical harmonic."""
    return np.polynomial.legendre.legval(v @ np.array([0.48, 0.6, 0.64]), np.eye(degree + 1)[degree])


def left(v, f, wave, cutoff, **how):
    """The share of the wave that the low pass leaves."""
    ms = measuring.document()
    ms.add_mesh(pymeshlab.Mesh(v, f, v_scalar_array=wave))
    ms.apply_filter("apply_attributes_multires_band", color=False, quality=True, cutoff=cutoff, **how)
    return ms.current_mesh().vertex_scalar_array() @ wave / (wave @ wave)


def main():
    measuring.load_plugins()
    v, f = irregular_sphere(VERTICES)
    wave, length = harmonic(v, DEGREE), 2 * np.pi / np.sqrt(DEGREE * (DEGREE + 1))
    ratios = np.geomspace(0.3, 4, 15)  # wave / cutoff
    fine = np.geomspace(0.3, 4, 300)
    with matplotlib.rc_context(LOOK):
        figure = Figure(figsize=(6, 3.2), facecolor="white")
        axes = figure.add_axes((0.08, 0.15, 0.9, 0.8))
        axes.grid(visible=True)
        for (order, formula), dash in zip(FORMULAS.items(), (":", "-", "--", "-."), strict=True):
            measured = [left(v, f, wave, length / r, method="spline", order=order) for r in ratios]
            print(f"order {order}: largest difference {np.abs(np.array(measured) - formula(ratios**-2.0)).max():.4f}")
            axes.plot(fine, formula(fine**-2.0), dash, color=OURS, lw=1, label=f"spline, order {order}")
            axes.plot(ratios, measured, "o", color=OURS, ms=3)
        pyramid = [left(v, f, wave, length / r, method="pyramid") for r in ratios]
        axes.plot(ratios, pyramid, "s-", color=THEIRS, ms=3, lw=1, label="pyramid")
        axes.axvline(1, color=FAINT, lw=0.5)
        axes.set(xscale="log", xlabel="wavelength / cutoff", ylabel="share that is left")
        axes.set_xticks([0.3, 0.5, 1, 2, 4], ["0.3", "0.5", "1", "2", "4"])
        axes.minorticks_off()
        axes.legend(frameon=False, loc="lower right")
        figure.savefig(measuring.ROOT / "docs/pictures/transmission.webp", dpi=130)


if __name__ == "__main__":
    main()
