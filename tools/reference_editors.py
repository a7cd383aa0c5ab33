"""Other ways to let a fine mesh follow a coarse one, for tools/edit_bench.py: libigl (package libigl) and Blender (package
bpy), if they are installed.

Each takes the fine mesh and the proxy before and after its edit, and returns the fine vertices, or None where it refuses.
"""

import importlib.util
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
from scipy.spatial import cKDTree


def handles(v, before, after):
    """The vertices of the fine mesh nearest to the proxy's, each once, and how these move: libigl holds vertices."""
    distance, nearest = cKDTree(v).query(before)
    order = np.argsort(distance)
    index, first = np.unique(nearest[order], return_index=True)
    return index.astype(np.int64), (after - before)[order[first]]


def biharmonic(v, f, before, after, faces):
    """The displacement of least bilaplacian energy through the handles (libigl, k = 2)."""
    import igl

    index, moved = handles(v, before, after)
    return v + igl.harmonic(v, f.astype(np.int64), index, moved, 2)


def arap(v, f, before, after, faces, iterations=10):
    """As rigid as possible (Sorkine and Alexa 2007; libigl), from the biharmonic displacement on."""
    import igl

    index, moved = handles(v, before, after)
    data = igl.ARAPData()
    data.max_iter = iterations
    igl.arap_precomputation(v, f.astype(np.int64), 3, index.astype(np.int32), data)
    return igl.arap_solve(v[index] + moved, data, biharmonic(v, f, before, after, faces))


def surface_deform(v, f, before, after, faces):
    """Blender's modifier Surface Deform, in a process of its own: bpy and pymeshlab bring other versions of one library."""
    with tempfile.TemporaryDirectory() as folder:
        given, found = pathlib.Path(folder, "given.npz"), pathlib.Path(folder, "found.npy")
        np.savez(given, v=v, f=f, before=before, after=after, faces=faces)
        subprocess.run([sys.executable, __file__, given, found], check=True, stdout=subprocess.DEVNULL)
        return np.load(found) if found.exists() else None


def deformed_by_blender(v, f, before, after, faces):
    import bpy

    bpy.ops.wm.read_factory_settings(use_empty=True)

    def add(name, positions, triangles):
        mesh = bpy.data.meshes.new(name)
        mesh.from_pydata(positions.tolist(), [], triangles.tolist())
        added = bpy.data.objects.new(name, mesh)
        bpy.context.collection.objects.link(added)
        return added

    scale = np.linalg.norm(np.ptp(v, axis=0))  # single precision
    centre = v.mean(axis=0)
    fine, proxy = add("fine", (v - centre) / scale, f), add("proxy", (before - centre) / scale, faces)
    modifier = fine.modifiers.new("deform", "SURFACE_DEFORM")
    modifier.target = proxy
    bpy.context.view_layer.objects.active = fine
    bpy.ops.object.surfacedeform_bind(modifier=modifier.name)
    if not modifier.is_bound:
        return None
    proxy.data.vertices.foreach_set("co", ((after - centre) / scale).astype(np.float32).ravel())
    proxy.data.update()
    graph = bpy.context.evaluated_depsgraph_get()
    graph.update()
    moved = np.empty(3 * len(v), np.float32)
    fine.evaluated_get(graph).data.vertices.foreach_get("co", moved)
    return moved.reshape(-1, 3).astype(float) * scale + centre


def installed():
    """Name: function of those that can run here."""
    ways = {"surface deform": ("bpy", surface_deform), "biharmonic": ("igl", biharmonic), "ARAP": ("igl", arap)}
    return {name: way for name, (package, way) in ways.items() if importlib.util.find_spec(package)}


if __name__ == "__main__":
    result = deformed_by_blender(**np.load(sys.argv[1]))
    if result is not None:
        np.save(sys.argv[2], result)
