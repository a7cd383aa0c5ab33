#!/usr/bin/env python3
"""Bit errors of Read Watermark after attacks: the tables of docs/watermark.md.

    tools/watermark_bench.py MESH... [--keys N] [--strength PERCENT]
    tools/watermark_bench.py --wrong-keys N MESH...    how often a wrong key looks right

Every mesh is marked with N messages and keys, attacked, and read beside the original. A cell holds the most wrong bits
of 64 and, in brackets, the fewest sure ones. Attacks are those of the robustness protocol of K. Wang, G. Lavoue, F.
Denis, A. Baskurt and X. He, "A Benchmark for 3D Mesh Watermarking", Shape Modeling International 2010, and harder ones.
"""

import argparse
import functools
import pathlib

import numpy as np
import pymeshlab
import scipy.sparse
from measuring import arrays, document, load_plugins, normals, read, referenced

MARK = "apply_coord_multires_watermark"
READ = "compute_multires_watermark"
LINES = "| {} |"


# ---- attacks: functions of vertices, faces and a random generator ----------------------------------------------------


def diagonal(v):
    return np.linalg.norm(np.ptp(v, axis=0))


def moved(v, f, random):
    """A similarity."""
    q, r = np.linalg.qr(random.normal(size=(3, 3)))
    q *= np.sign(np.diag(r))
    q[:, 0] *= np.linalg.det(q)
    return v @ q.T * random.uniform(0.2, 5) + random.normal(size=3) * diagonal(v), f


def reordered(v, f, random):
    order = random.permutation(len(v))
    place = np.argsort(order)
    f = place[f][random.permutation(len(f))]
    return v[order], np.array([np.roll(face, random.integers(3)) for face in f])


def noisy(amount, v, f, random):
    """Uniform in each coordinate, up to so many percent of the mean distance from the centre (Wang et al.)."""
    return v + amount / 100 * np.linalg.norm(v - v.mean(0), axis=1).mean() * random.uniform(-1, 1, v.shape), f


def noisier(amount, v, f, random):
    """Gaussian in each coordinate, its deviation in percent of the diagonal: five to six times as strong."""
    return v + amount / 100 * diagonal(v) * random.normal(size=v.shape), f


def smoothed(share, steps, v, f, _random):
    """Every vertex goes a share of the way to the mean of its neighbours."""
    ends = np.concatenate([f[:, [a, b]] for a, b in ((0, 1), (1, 2), (2, 0), (1, 0), (2, 1), (0, 2))])
    near = scipy.sparse.coo_matrix((np.ones(len(ends)), ends.T), shape=(len(v), len(v))).tocsr()
    near.data[:] = 1
    mean = scipy.sparse.diags(1 / np.maximum(np.asarray(near.sum(1)).ravel(), 1)) @ near
    for _ in range(steps):
        v = v + share * (mean @ v - v)
    return v, f


def quantised(bits, v, f, _random):
    step = np.ptp(v, axis=0).max() / (2**bits - 1)
    return np.round((v - v.min(0)) / step) * step + v.min(0), f


def simplified(share, v, f, _random):
    ms = document(v, f)
    ms.apply_filter("meshing_decimation_quadric_edge_collapse", targetfacenum=int(share * len(f)))
    return arrays(ms.current_mesh())


def cropped(share, v, f, random):
    """So much of the vertices lies on the far side of a plane."""
    along = v @ random.normal(size=3)
    return referenced(v, f[(along > np.quantile(along, share))[f].all(1)])


def both(first, second, v, f, random):
    return second(*first(v, f, random), random)


def attacks():
    part = functools.partial
    yield "none", lambda v, f, random: (v, f)
    yield "rotation, scale and shift", moved
    yield "vertices and faces reordered", part(both, reordered, moved)
    for amount in (0.05, 0.1, 0.3, 0.5):
        yield f"noise {amount} %", part(noisy, amount)
    for amount in (0.05, 0.1, 0.3, 0.5):
        yield f"Gaussian noise {amount} % of the diagonal", part(noisier, amount)
    for steps in (5, 10, 30, 50):
        yield f"Laplacian 0.1, {steps} steps", part(smoothed, 0.1, steps)
    for steps in (5, 10, 30, 50):
        yield f"Laplacian 1, {steps} steps", part(smoothed, 1, steps)
    for bits in (11, 10, 9, 8, 7):
        yield f"{bits} bits a coordinate", part(quantised, bits)
    for share in (0.75, 0.5, 0.25):
        yield f"simplified to {share:.0%}", part(simplified, share)
    for share in (0.1, 0.3, 0.5):
        yield f"cropped by {share:.0%}", part(cropped, share)
    yield "simplified to 50%, moved", part(both, part(simplified, 0.5), moved)
    yield "noise 0.1 %, moved", part(both, part(noisy, 0.1), moved)
    yield "cropped by 10%, moved", part(both, part(cropped, 0.1), moved)
    yield "cropped by 30%, moved", part(both, part(cropped, 0.3), moved)


# ---- marking and reading ---------------------------------------------------------------------------------------------


def marked(v, f, message, key, strength):
    ms = document(v, f)
    report = ms.apply_filter(MARK, message=message, key=key, strength=strength, selected=False)
    return ms.current_mesh().vertex_matrix(), report


def reading(v, f, original, key, message):
    """The report for a mesh beside the original."""
    ms = document(*original)
    ms.add_mesh(pymeshlab.Mesh(v, f))
    return ms.apply_filter(READ, original=0, key=key, expected=message)


def messages(count):
    random = np.random.default_rng(64)
    return [("".join(random.choice(list("0123456789abcdef"), 16)), f"key {k}") for k in range(count)]


def column(path, keys, strength):
    """(heading, cells) of a mesh."""
    v, f = referenced(*read(path))
    cells = {name: [] for name, _ in attacks()}
    turns, certain = [], np.zeros(2, dtype=int)
    for k, (message, key) in enumerate(messages(keys)):
        w, report = marked(v, f, message, key, strength)
        assert report["rms_displacement"] <= strength / 100 * diagonal(v) * (1 + 1e-9)
        cosine = (normals(v, f)[0] * normals(w, f)[0]).sum(1)
        turns.append(np.degrees(np.arccos(np.clip(cosine, -1, 1))).mean())
        for name, attack in attacks():
            got = reading(*attack(w, f, np.random.default_rng(k)), (v, f), key, message)
            cells[name].append((int(got["bit_errors"]), int(got["sure_bits"])))
            bits = np.array(list(f"{int(message, 16):064b}"), dtype=int)
            sure = np.array(got["confidence"]) > 0.99
            certain += np.array([sure.sum(), (sure & (bits != got["bits"])).sum()])
    heading = f"{pathlib.Path(path).stem}, {len(v):,}"
    print(f"{heading}: normals turn by {np.mean(turns):.2f} degrees on average; of {certain[0]} sure bits "
          f"{certain[1]} are wrong", flush=True)
    return heading, {name: f"{max(e for e, _ in c)} ({min(s for _, s in c)})" for name, c in cells.items()}


def print_table(paths, keys, strength):
    columns = [column(path, keys, strength) for path in paths]
    print(LINES.format(" | ".join(["attack", *(heading for heading, _ in columns)])))
    print("|---" * (len(columns) + 1) + "|")
    for name, _ in attacks():
        print(LINES.format(" | ".join([name, *(cells[name] for _, cells in columns)])))


def print_wrong_keys(paths, count, strength):
    for path in paths:
        v, f = referenced(*read(path))
        (message, key), *_ = messages(1)
        w, _ = marked(v, f, message, key, strength)
        got = [reading(w, f, (v, f), f"wrong {k}", message) for k in range(count)]
        p = np.sort([g["probability_unmarked"] for g in got])
        print(f"{pathlib.Path(path).stem}: of {count} wrong keys the least probability is {p[0]:.2g}, quartiles "
              f"{np.quantile(p, [0.25, 0.5, 0.75]).round(2)}, most sure bits {max(g['sure_bits'] for g in got)}; "
              f"bit errors on average {np.mean([g['bit_errors'] for g in got]):.1f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("meshes", nargs="+")
    parser.add_argument("--keys", type=int, default=2)
    parser.add_argument("--strength", type=float, default=0.08)
    parser.add_argument("--wrong-keys", type=int, default=0)
    options = parser.parse_args()
    load_plugins()
    if options.wrong_keys:
        print_wrong_keys(options.meshes, options.wrong_keys, options.strength)
    else:
        print_table(options.meshes, options.keys, options.strength)


if __name__ == "__main__":
    main()
