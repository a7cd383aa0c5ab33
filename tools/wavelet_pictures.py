#!/usr/bin/env python3
"""Draws scaling functions and wavelets of the scheme Szczesna: docs/pictures/wavelet-functions.webp.

    tools/wavelet_pictures.py [PICTURE]

As in Figures 9 to 12 of the chapter, a coefficient of the level 268 vertices below a plane is 1, all others are 0, and
the level is synthesised. Filters do that, too: the level's height is changed at one vertex, and Transfer Edit puts back
the plane's details, which are 0.
"""

import pathlib
import sys

import numpy as np
import pymeshlab
from PIL import Image

import rendering
from measuring import ROOT, arrays, document, load_plugins

REMOVED = 268
SHOWN = 6.5  # radius around the function's middle, edges
HEIGHT = 6  # of 1 in the picture, edges
UPDATES = {"none": "without update", "mean": "with update"}
CAMERA = rendering.Camera(*np.array([[0.8, -0.6, 0], [0.36, 0.48, 0.8], [-0.48, -0.64, 0.6]]), np.array([0, 0, 1.6]), 6.5)


def plane(n=21):
    """n by n vertices of valence 6. Those of a plane would go one after the other, from one side to the other: they lie
    beside it by a 10,000th of an edge or so, at random."""
    j, i = (a.ravel() for a in np.mgrid[:n, :n])
    v = np.column_stack([i + 0.5 * j, 0.75**0.5 * j, 1e-4 * np.random.default_rng(1).normal(size=n * n)])
    corner = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()[:, None]
    return v, np.concatenate([corner + [0, 1, n], corner + [1, n + 1, n]])


def ring(faces, vertex):
    return np.setdiff1d(faces[(faces == vertex).any(axis=1)], vertex)


def synthesised(v, f, level, coefficients, options):
    """Heights over the plane; None if there is no function of the kind at this level.

    level: how many vertices are removed
    coefficients: a function of the level's vertices, #V by 3, and faces that gives their heights, or None
    """
    ms = document(v, f)
    ms.apply_filter("generate_multires_level", level=level, smoothed=True, **options)
    coarse, faces = arrays(ms.current_mesh())
    height = coefficients(coarse, faces)
    if height is None:
        return None
    ms.add_mesh(pymeshlab.Mesh(coarse + height[:, None] * [0, 0, 1], faces))
    ms.set_current_mesh(0)
    ms.apply_filter("apply_coord_multires_transfer_edit", edited=2, before=1, encoding="frames",
                    details="single resolution", selected=False, **options)  # fmt: skip
    return ms.current_mesh().vertex_matrix()[:, 2]


def panel(kind, valence, operator, update):
    """A scaling function or a wavelet of a vertex of that valence in the middle, which is put into the origin."""
    v, f = plane()
    options = {"scheme": "Szczesna", "operator": operator, "update": update, "grouping": "sequential",
               "split": "regression plane", "base_vertices": 20}  # fmt: skip
    from_middle = np.linalg.norm(v - v.mean(axis=0), axis=1)

    def scaling(coarse, faces):
        order = np.argsort(np.linalg.norm(coarse - v.mean(axis=0), axis=1), kind="stable")
        return np.eye(len(coarse))[next(k for k in order if len(ring(faces, k)) == valence)]

    def wavelet(coarse, faces):
        odd = len(coarse) - 1  # the one that goes next
        around = ring(faces, odd)
        if np.linalg.norm(coarse[odd] - v.mean(axis=0)) > 0.4 * from_middle.max() or len(around) != valence:
            return None
        height = np.eye(len(coarse))[odd]
        height[around] = -1 / valence if update == "mean" else 0  # what the ring gets back of it
        return height

    levels = [REMOVED] if kind == "Scaling function" else range(REMOVED - 1, 0, -1)
    coefficients = scaling if kind == "Scaling function" else wavelet
    z = next(z for level in levels if (z := synthesised(v, f, level, coefficients, options)) is not None)
    v = (v - v[np.argmax(z)]) * [1, 1, 0] + (HEIGHT * z)[:, None] * [0, 0, 1]
    f = f[(np.linalg.norm(v[:, :2], axis=1) < SHOWN)[f].all(axis=1)]
    words = f"valence {valence}, {operator}, {UPDATES[update]}"
    return rendering.Panel(kind, words, v, f, rendering.coloured(z, -0.6, 0.6, "RdBu_r"), edges=True)


def main():
    path = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "docs/pictures/wavelet-functions.webp"
    load_plugins()
    nearest, one, two = "natural neighbours", "thin plate 1-ring", "thin plate 2-ring"
    rows = [
        [("Scaling function", valence, nearest) for valence in (6, 4)],
        [("Scaling function", 4, operator) for operator in (one, two)],
        [("Wavelet", valence, nearest) for valence in (6, 4)],
    ]
    sheets = [rendering.contact_sheet([panel(*what, update) for what in row for update in UPDATES], CAMERA, 300,
                                      close_ups=False) for row in rows]  # fmt: skip
    out = Image.new("RGB", (sheets[0].width, sum(s.height for s in sheets)), rendering.BACKGROUND)
    top = 0
    for sheet in sheets:
        out.paste(sheet, (0, top))
        top += sheet.height
    out.save(path, "WEBP", quality=80, method=6)


if __name__ == "__main__":
    main()
