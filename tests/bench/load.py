"""A large mesh through the filters that need the most: time and memory, and what happens when there is too little of it.

    .venv/bin/python tests/bench/load.py [--vertices 10000000] [--build build/pymeshlab-2025.07]

A generated scan in pymeshlab, each filter in a process of its own: first with all the memory there is, then with limits
of the address space at shares of what that took. A call with too little must end with an error that says so and leave
the mesh as it was, and once the limit is gone the same call in the same process must give what it gave the first time.
Prints a table; fails if anything is otherwise. At 10 million vertices it takes a quarter of an hour and 12 GB.
"""

import argparse
import hashlib
import json
import pathlib
import resource
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]

# Of what a call took at its peak; what the process has free already comes on top, so that 0.8 may be enough.
SHARES = (0, 0.15, 0.3, 0.45, 0.6)
FILTERS = (
    "compute_multires_pyramid",
    "apply_coord_multires_low_pass",
    "apply_coord_multires_denoise",
    "generate_multires_adaptive_reconstruction",
)


def status(key):
    """Bytes, from the process's own status."""
    with open("/proc/self/status") as file:
        return next(int(line.split()[1]) * 1024 for line in file if line.startswith(key))


def state(ms):
    """A hash of all that the filters could have changed."""
    mesh, h = ms.current_mesh(), hashlib.blake2b(repr((ms.mesh_number(), ms.current_mesh_id())).encode())
    for array in (mesh.vertex_matrix(), mesh.vertex_normal_matrix(), mesh.face_matrix(), mesh.face_normal_matrix()):
        h.update(array.tobytes("A"))
    return h.hexdigest()


def starve(ms, name, limit):
    """The error of a call with so much address space, or none."""
    import pymeshlab

    everything = resource.getrlimit(resource.RLIMIT_AS)
    resource.setrlimit(resource.RLIMIT_AS, (int(limit), everything[1]))
    try:
        ms.apply_filter(name)
    except pymeshlab.PyMeshLabException as error:
        return str(error)
    finally:
        resource.setrlimit(resource.RLIMIT_AS, everything)
    return None


def one(build, path, name, needed):
    """In a process of its own: a call, with limits before it if it is known what it needs. Prints its measures."""
    import pymeshlab

    for plugin in sorted((build / "plugins").glob("*.so")):
        pymeshlab.load_plugin(str(plugin))
    ms = pymeshlab.MeshSet()
    ms.load_new_mesh(str(path))
    refused = 0
    if needed:
        before = state(ms)
        for share in SHARES:
            error = starve(ms, name, status("VmSize") + share * needed)
            assert error is not None, f"{share} of the memory was enough"
            assert "Not enough memory: nothing was changed." in error, error
            assert state(ms) == before, f"changed with {share} of the memory"
            refused += 1
    with open("/proc/self/clear_refs", "w") as file:
        file.write("5")  # the peak starts anew
    resident = status("VmRSS")
    start = time.perf_counter()
    ms.apply_filter(name)
    seconds, peak = time.perf_counter() - start, status("VmHWM")
    measures = {"seconds": seconds, "peak": peak, "needed": peak - resident}
    print(json.dumps({**measures, "result": state(ms), "refused": refused}))


def run(build, path, name, needed=0):
    command = [sys.executable, __file__, "--build", build, "--one", path, name, str(needed)]
    done = subprocess.run(command, stdout=subprocess.PIPE, text=True)
    if done.returncode:
        raise SystemExit(f"{name}: exit {done.returncode}")
    return json.loads(done.stdout.splitlines()[-1])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--vertices", type=int, default=10_000_000)
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build" / "pymeshlab-2025.07")
    parser.add_argument("--one", nargs=3, metavar=("MESH", "FILTER", "NEEDED"), help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.one:
        path, name, needed = arguments.one
        return one(arguments.build, path, name, int(needed))
    with tempfile.TemporaryDirectory() as folder:
        make = arguments.build / "meshes/make_meshes"
        subprocess.run([make, folder, str(arguments.vertices)], check=True)
        path = pathlib.Path(folder) / f"scan_{arguments.vertices}.ply"
        print("| filter | seconds | with mesh at most, GB | beyond the mesh, bytes per vertex | refused with too little |")
        print("|---|---|---|---|---|")
        for name in FILTERS:
            free = run(arguments.build, path, name)
            starved = run(arguments.build, path, name, free["needed"])
            if starved["result"] != free["result"]:
                raise SystemExit(f"{name}: another result after the limits")
            print(
                f"| `{name}` | {free['seconds']:.1f} | {free['peak'] / 1e9:.1f} "
                f"| {free['needed'] / arguments.vertices:.0f} | {starved['refused']} of {len(SHARES)} |",
                flush=True,
            )
    return 0


if __name__ == "__main__":
    sys.exit(main())
