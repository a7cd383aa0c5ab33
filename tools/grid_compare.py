"""Box-spline wavelets of a triangular grid beside PyWavelets' tensor product ones: error by share of coefficients kept,
and whether a ridge is cheaper in some directions than in others. Needs PyWavelets.

    .venv/bin/python tools/grid_compare.py [TERRAIN.ply]

Errors are RMS, in percent of the range of heights. The terrain is a square grid in rows.
"""

import argparse
import pathlib

import numpy as np
import pywt

from measuring import document, load_plugins, read

SHARES = (1, 2, 5, 10, 20)
COMPRESS = "apply_coord_multires_grid_compress"


def tensor_error(z, name, share, levels=5):
    """Of the largest coefficients of a periodised tensor product transform, in percent of the heights' range."""
    array, slices = pywt.coeffs_to_array(pywt.wavedec2(z, name, "periodization", levels))
    keep = int(share / 100 * z.size)
    least = np.partition(np.abs(array).ravel(), -keep)[-keep]
    kept = pywt.array_to_coeffs(np.where(np.abs(array) >= least, array, 0), slices, "wavedec2")
    again = pywt.waverec2(kept, name, "periodization")[: z.shape[0], : z.shape[1]]
    return 100 * np.sqrt(((again - z) ** 2).mean()) / np.ptp(z)


def grid_error(v, f, share, **how):
    ms = document(v, f)
    report = ms.apply_filter(COMPRESS, share=share, channels="heights", levels=5, **how)
    return 100 * report["rms_error"] / np.ptp(v[:, 2])


def table(v, f):
    side = int(np.sqrt(len(v)))
    z = v[:, 2].reshape(side, side)
    print("| |", " | ".join(f"{s} %" for s in SHARES), "|\n" + "|---" * (len(SHARES) + 1) + "|")
    for name in ("haar", "bior2.2", "bior4.4"):
        print(f"| {name} |", " | ".join(f"{tensor_error(z, name, s):.2f}" for s in SHARES), "|")
    for basis in ("linear", "quartic"):
        for oracle in ("magnitude", "pursuit"):
            errors = [grid_error(v, f, s, basis=basis, oracle=oracle) for s in SHARES]
            print(f"| {basis}, {oracle} |", " | ".join(f"{e:.2f}" for e in errors), "|", flush=True)


def ridge(n, degrees, lattice):
    """A ridge through the middle of n by n points, at an angle in the plane of the lattice, with flanks that level out;
    on the square grid, or on the triangular one with equal edges."""
    i, j = np.mgrid[:n, :n] - (n - 1) / 2
    x, y = (j - 0.5 * i, np.sqrt(0.75) * i) if lattice else (j, i)
    across = x * np.sin(np.radians(degrees)) - y * np.cos(np.radians(degrees))
    outside = np.hypot(x, y) / (0.32 * n)
    return x, y, np.exp(-((across / 1.5) ** 2)) * np.exp(-(outside**6))


def directions(share=2):
    """Largest over smallest error of ridges turned in steps of 10 degrees."""
    n, angles = 128, range(0, 180, 10)
    corner = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()[:, None]
    faces = np.vstack([corner + [0, 1, n + 1], corner + [0, n + 1, n]])
    rows = {}
    for name in ("haar", "bior2.2", "bior4.4"):
        rows[name] = [tensor_error(ridge(n, a, False)[2], name, share) for a in angles]
    for basis in ("linear", "quartic"):
        meshes = [np.column_stack([c.ravel() for c in ridge(n, a, True)]) for a in angles]
        for oracle in ("magnitude", "pursuit"):
            rows[f"{basis}, {oracle}"] = [grid_error(v, faces, share, basis=basis, oracle=oracle) for v in meshes]
    print(f"\n| error at {share} % | least | largest | largest / least | deviation / mean |\n|---|---|---|---|---|")
    for name, e in rows.items():
        print(f"| {name} | {min(e):.3f} | {max(e):.3f} | {max(e) / min(e):.2f} | {np.std(e) / np.mean(e):.2f} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("terrain", type=pathlib.Path, nargs="?")
    arguments = parser.parse_args()
    load_plugins()
    if arguments.terrain:
        table(*read(arguments.terrain))
    directions()


if __name__ == "__main__":
    main()
