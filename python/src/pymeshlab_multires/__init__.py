"""Multiresolution filters for pymeshlab as typed functions.

    import pymeshlab, pymeshlab_multires as multires

    ms = pymeshlab.MeshSet()
    ms.load_new_mesh("scan.ply")
    report = multires.denoise(ms)
    multires.enhance(ms, gain=2, pyramid=multires.Pyramid(scheme="Roy"))

Importing loads the plugins of the package into pymeshlab. Functions work on the current mesh of the document, take the
parameters of the filter by name (those of the pyramid as one Pyramid) and return its report; a filter that fails raises
pymeshlab.PyMeshLabException and leaves the document as it was.
"""

from . import _call
from ._equalize import EqualizeReport, equalize
from ._filters import *  # noqa: F403
from ._filters import __all__ as _names
from ._plot import plot_roughness, plot_spectrum
from ._stream import Stream, StreamError, StreamMesh, open_stream, save_stream
from ._stream_page import stream_page
from ._view import Viewer, view

__all__ = [*_names, "EqualizeReport", "Stream", "StreamError", "StreamMesh", "Viewer", "equalize", "open_stream",
           "plot_roughness", "plot_spectrum", "save_stream", "stream_page", "view"]  # fmt: skip

_call.load_plugins()
