#!/usr/bin/env python3
"""Adaptive reconstruction beside other simplifiers: RMS distance at 10 % of the faces, and time.

    python tests/bench/adaptive_compare.py PLUGIN_FOLDER MESH...

Needs pymeshlab; meshoptimizer and fast_simplification (from PyPI) are compared if they are installed. All results are
judged by MeshLab's own sampled Hausdorff distance, both ways; the root of the mean of the two mean squares is shown, in
1e-4 of the diagonal of the bounding box. Times are the least of some runs: seconds by the clock, and of all cores.
"""

import pathlib
import sys
import time

import numpy as np
import pymeshlab

ADAPTIVE = "generate_multires_adaptive_reconstruction"
SAMPLES = 300_000
RUNS = 5


def judge(truth, result):
    """(RMS, largest) two-sided distance over the diagonal."""
    ms = pymeshlab.MeshSet(verbose=False)
    ms.add_mesh(pymeshlab.Mesh(*truth))
    ms.add_mesh(pymeshlab.Mesh(*result))
    ways = [
        ms.get_hausdorff_distance(sampledmesh=a, targetmesh=1 - a, samplevert=True, sampleface=True, samplenum=SAMPLES,
                                  maxdist=pymeshlab.PercentageValue(100))
        for a in (0, 1)
    ]  # fmt: skip
    diagonal = np.linalg.norm(np.ptp(truth[0], axis=0))
    rms = np.sqrt(np.mean([way["RMS"] ** 2 for way in ways]))
    return rms / diagonal, max(way["max"] for way in ways) / diagonal


def timed(run):
    """Least clock and processor time of some runs, and the last result."""
    clock = processor = np.inf
    for _ in range(RUNS):
        start, start_processor = time.perf_counter(), time.process_time()
        result = run()
        clock = min(clock, time.perf_counter() - start)
        processor = min(processor, time.process_time() - start_processor)
    return clock, processor, result


def in_meshlab(truth, name, **parameters):
    """A MeshLab filter on a fresh document; only the filter is timed."""
    clock = processor = np.inf
    for _ in range(RUNS):
        ms = pymeshlab.MeshSet(verbose=False)
        ms.add_mesh(pymeshlab.Mesh(*truth))
        start, start_processor = time.perf_counter(), time.process_time()
        ms.apply_filter(name, **parameters)
        clock = min(clock, time.perf_counter() - start)
        processor = min(processor, time.process_time() - start_processor)
    mesh = ms.current_mesh()
    return clock, processor, (mesh.vertex_matrix(), mesh.face_matrix())


def with_meshoptimizer(truth, faces):
    import meshoptimizer

    vertices = np.ascontiguousarray(truth[0], dtype=np.float32)
    indices = np.ascontiguousarray(truth[1], dtype=np.uint32).ravel()
    out = np.zeros_like(indices)

    def run():
        count = meshoptimizer.simplify(out, indices, vertices, target_index_count=3 * faces, target_error=1.0)
        return vertices.astype(float), out[:count].reshape(-1, 3).astype(np.int32)

    return timed(run)


def with_fast_simplification(truth, faces):
    import fast_simplification

    vertices, triangles = truth[0].astype(np.float32), truth[1].astype(np.int32)

    def run():
        v, f = fast_simplification.simplify(vertices, triangles, target_count=faces)
        return v.astype(float), f.astype(np.int32)

    return timed(run)


def competitors(truth, faces):
    ours = {"target": "faces", "faces": faces, "measure": False}
    yield "adaptive reconstruction", lambda: in_meshlab(truth, ADAPTIVE, **ours)
    yield "  with fitted positions", lambda: in_meshlab(truth, ADAPTIVE, fit=True, **ours)
    yield "  by local error", lambda: in_meshlab(truth, ADAPTIVE, criterion="local error", **ours)
    yield "  by detail (Roy)", lambda: in_meshlab(truth, ADAPTIVE, criterion="detail", **ours)
    yield "MeshLab quadric", lambda: in_meshlab(truth, "meshing_decimation_quadric_edge_collapse", targetfacenum=faces)
    yield "meshoptimizer", lambda: with_meshoptimizer(truth, faces)
    yield "fast-simplification", lambda: with_fast_simplification(truth, faces)


def main():
    plugins = sorted(pathlib.Path(sys.argv[1]).glob("*adaptive*.so"))
    for plugin in plugins:
        pymeshlab.load_plugin(str(plugin))
    for path in sys.argv[2:]:
        ms = pymeshlab.MeshSet(verbose=False)
        ms.load_new_mesh(path)
        ms.meshing_remove_unreferenced_vertices()
        truth = ms.current_mesh().vertex_matrix(), ms.current_mesh().face_matrix()
        faces = len(truth[1]) // 10
        print(f"{pathlib.Path(path).name}: {len(truth[1])} faces to {faces}")
        print(f"{'':26}{'faces':>8}{'RMS':>8}{'largest':>9}{'clock':>9}{'cores':>9}")
        for name, run in competitors(truth, faces):
            try:
                clock, processor, result = run()
            except ImportError:
                continue
            rms, largest = judge(truth, result)
            print(f"{name:26}{len(result[1]):8}{1e4 * rms:8.2f}{1e4 * largest:9.1f}{clock:9.4f}{processor:9.4f}")


main()
