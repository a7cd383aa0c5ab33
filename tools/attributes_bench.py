"""How well Denoise Attributes works, beside Laplacian and median filters at their best settings.

    .venv/bin/python tools/attributes_bench.py [--build BUILD] [--vertices MOST] [--only NOISE]

Signals on the meshes of ../shared/meshes (and on a generated scan and sphere): as qualities in floating point and as
colours of 8 bits. Ours runs without a parameter; of the others the setting nearest to the truth is taken, case by case:
1 to 32 steps of averaging with the neighbours, and one to three median filters. Distances are root mean squares over
vertices and channels; counted as grown from 0.5 % and 0.0005 of the range on. Meshes that no constant was chosen on
come first.
"""

import argparse
import pathlib
import tempfile
import zlib

import numpy as np
import pymeshlab
from denoise_bench import MESHES, scan
from measuring import BUILD, document, edge_length, load_plugins, normals, referenced, table

CHECKING = ("clean/cheburashka", "clean/arm", "clean/camelhead", "attributes/monkey2_rgb", "attributes/colored_airplane")
CHOOSING = ("scans/cow2903", "scans/mannequin689", "scans/fandisk", "clean/lion", "clean/homer", "attributes/swirl_rgb")
NOISES = (
    *(("Gaussian", s) for s in (0, 0.02, 0.05, 0.1, 0.2, 0.3)),
    *(("from end to end, 0.2 to 1.8 times", s) for s in (0.05, 0.2)),
    *(("at one vertex in seven", s) for s in (0.05, 0.2, 0.5)),
    *(("black or white, share", s) for s in (0.005, 0.02, 0.1)),
    ("any value, share", 0.05),
    ("Gaussian 0.05, and black or white, share", 0.05),
    *(("rounded, error", s) for s in (0.02, 0.05)),
)


# ---- meshes and signals ----------------------------------------------------------------------------------------------


def meshes(build, most):
    """(split, name, vertices, faces, colours or None)."""
    for split, names in (("checking", CHECKING), ("choosing", CHOOSING)):
        for path in (path for name in names for path in MESHES.glob(f"{name}.*")):
            ms = document()
            ms.load_new_mesh(str(path))
            mesh = ms.current_mesh()
            v, f = mesh.vertex_matrix(), mesh.face_matrix()
            used = np.unique(f)
            colour = mesh.vertex_color_matrix()[used, :3] if mesh.has_vertex_color() else None
            v, f = referenced(v, f)
            if len(v) <= most:
                yield split, path.stem, v, f, colour if colour is not None and np.ptp(colour) > 0 else None
    yield "choosing", "scan", *scan(build, min(5000, most)), None


def neighbours(v, f):
    """#V by largest valence: neighbours, the vertex itself where there are no more."""
    edges = np.sort(np.concatenate([f[:, [0, 1]], f[:, [1, 2]], f[:, [2, 0]]]), axis=1)
    edges = np.unique(edges, axis=0)
    edges = np.concatenate([edges, edges[:, ::-1]])
    edges = edges[np.argsort(edges[:, 0], kind="stable")]
    place = np.arange(len(edges)) - np.searchsorted(edges[:, 0], edges[:, 0])
    near = np.repeat(np.arange(len(v))[:, None], place.max() + 1, axis=1)
    near[edges[:, 0], place] = edges[:, 1]
    return near


def signals(v, f, colour):
    """Name and values between 0 and 1: #V qualities, #V by 3 colours."""
    d = (v - v.mean(axis=0)) / edge_length(v, f)  # in edges
    size = np.ptp(d, axis=0).max()
    checkers = np.floor(d / 7).sum(axis=1) % 2 * 0.8 + 0.1
    rings = np.mod(np.linalg.norm(d, axis=1) / (size / 6), 1)
    waves = 0.5 + 0.45 * np.sin(2 * np.pi * d @ (0.6, 0.5, 0.62) / (size / 4))
    hue = np.mod(d[:, 2] / (size / 3) * 6, 6)
    yield "constant", np.full(len(v), 0.5)
    yield "waves", waves
    yield "waves of 8 edges", 0.5 + 0.45 * np.sin(2 * np.pi * d @ (0.3, -0.8, 0.5) / 8)
    yield "rings with a jump", rings
    yield "checkers", checkers
    yield "three steps", np.floor(3 * 0.999 * (d[:, 0] - d[:, 0].min()) / np.ptp(d[:, 0])) / 2
    yield "labels of 7 edges", np.floor(d / 7) @ (1, 3, 5) % 7 / 6
    yield "height", (d[:, 1] - d[:, 1].min()) / np.ptp(d[:, 1])
    yield "normals", (normals(v, f)[1] + 1) / 2
    yield "rainbow", np.stack([np.clip(np.abs(np.mod(hue + k, 6) - 3) - 1, 0, 1) for k in (0, 4, 2)], axis=1)
    yield "checkers, rings, waves", np.stack([checkers, rings, waves], axis=1)
    if colour is not None:
        yield "its own colours", colour


def with_noise(values, v, kind, size, random):
    noisy = values.reshape(len(v), -1).copy()
    if kind == "Gaussian":
        noisy += random.normal(0, size, noisy.shape)
    elif kind.startswith("from end to end"):
        share = (v[:, 0] - v[:, 0].min()) / np.ptp(v[:, 0])
        noisy += random.normal(0, size, noisy.shape) * (0.2 + 1.6 * share)[:, None]
    elif kind == "at one vertex in seven":
        hit = random.random(len(v)) < 1 / 7
        noisy[hit] += random.normal(0, size, noisy[hit].shape)
    elif kind.startswith("rounded"):
        step = size * np.sqrt(12)
        noisy = step * np.round(noisy / step)
    else:
        if kind.startswith("Gaussian 0.05"):
            noisy += random.normal(0, 0.05, noisy.shape)
        hit = random.random(len(v)) < size
        other = random.random((hit.sum(), noisy.shape[1] if kind.startswith("any") else 1))
        noisy[hit] = other if kind.startswith("any") else other < 0.5
    if noisy.shape[1] == 3:
        noisy = np.round(255 * np.clip(noisy, 0, 1)) / 255
    return noisy.reshape(values.shape)


# ---- methods ---------------------------------------------------------------------------------------------------------


def ours(v, f, values):
    colour = values.ndim == 2
    keywords = {"v_color_matrix": np.c_[values, np.ones(len(v))]} if colour else {"v_scalar_array": values}
    ms = document()
    ms.add_mesh(pymeshlab.Mesh(v, f, **keywords))
    ms.apply_filter("apply_attributes_multires_denoise", color=colour, quality=not colour)
    mesh = ms.current_mesh()
    return mesh.vertex_color_matrix()[:, :3] if colour else mesh.vertex_scalar_array()


def repeated(step, values, rounds):
    """The values after each of these numbers of steps."""
    for n in range(1, max(rounds) + 1):
        values = step(values)
        if n in rounds:
            yield values


def compare(v, near, f, truth, noisy):
    """Root mean square errors: noisy, ours, Laplacian, median."""

    def error(values):
        return float(np.sqrt(np.mean((values - truth) ** 2)))

    valence = (near != np.arange(len(v))[:, None]).sum(axis=1).reshape(-1, *[1] * (truth.ndim - 1))
    beyond = near.shape[1] - valence  # places that hold the vertex itself
    own = np.concatenate([np.arange(len(v))[:, None], near], axis=1).astype(float)
    own[:, 1:][near == np.arange(len(v))[:, None]] = np.nan
    missing, index = np.isnan(own), np.nan_to_num(own).astype(int)

    def mean(x):
        return (x[near].sum(axis=1) - (beyond - 1) * x) / (valence + 1)

    def median(x):
        around = x[index]
        around[missing] = np.nan
        return np.nanmedian(around, axis=1)

    return (error(noisy), error(ours(v, f, noisy)),
            min(map(error, repeated(mean, noisy, (1, 2, 3, 5, 8, 12, 20, 32)))),
            min(map(error, repeated(median, noisy, (1, 2, 3)))))  # fmt: skip


# ---- tables ----------------------------------------------------------------------------------------------------------


def mean_of(ratios):
    return f"{np.exp(np.mean(np.log(np.maximum(ratios, 1e-3)))):.2f}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--build", type=pathlib.Path, default=BUILD)
    parser.add_argument("--vertices", type=int, default=12000, help="larger meshes are left out")
    parser.add_argument("--only", default="", help="noise whose name holds this")
    args = parser.parse_args()
    load_plugins(args.build / "plugins")
    rows = []
    for split, name, v, f, colour in meshes(args.build, args.vertices):
        near = neighbours(v, f)
        for signal, truth in signals(v, f, colour):
            for kind, size in NOISES:
                if args.only not in kind:
                    continue
                random = np.random.default_rng(zlib.crc32(f"{name} {signal} {kind} {size}".encode()))
                noisy = with_noise(truth, v, kind, size, random)
                rows.append((split, name, signal, f"{kind} {size:g}", *compare(v, near, f, truth, noisy)))
        print(name, flush=True)
    for split in ("checking", "choosing"):
        out = []
        for noise in dict.fromkeys(row[3] for row in rows if row[3] != "Gaussian 0"):
            errors = [row[4:] for row in rows if row[:4:3] == (split, noise) and row[4] > 1e-9]
            if errors:
                before, *after = np.array(errors).T
                grown = int((after[0] > np.maximum(1.005 * before, before + 0.0005)).sum())
                out.append((noise, str(len(before)), *(mean_of(x / before) for x in after), str(grown)))
        print(split, table(out, ("noise", "cases", "ours", "Laplacian", "median", "ours grown")), sep="\n\n")
    moved = [row for row in rows if row[3] == "Gaussian 0"]
    if moved:
        print("Without noise moved by", max(row[5] for row in moved), "at most")
    worst = sorted((row for row in rows if row[3] != "Gaussian 0" and row[4] > 1e-9), key=lambda row: -row[5] / row[4])[:5]
    print(table([(*row[:4], f"{row[4]:.4f}", f"{row[5]:.4f}") for row in worst],
          ("split", "mesh", "signal", "noise", "before", "after")))  # fmt: skip


if __name__ == "__main__":
    main()
