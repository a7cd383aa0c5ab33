"""The progressive file .mrm: saving, opening, and decoding as bytes arrive."""

import ctypes
import functools
import os
import pathlib
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from ._call import forgetting_failures

KINDS = ["color", "quality", "texcoord", "scalar", "point"]


class Files(Protocol):
    """What is used of pymeshlab.MeshSet, which has no types of its own."""

    def load_new_mesh(self, file_name: str, /, **parameters: Any) -> None: ...
    def save_current_mesh(self, file_name: str, /, **parameters: Any) -> None: ...


def save_stream(ms: Files, file: str | os.PathLike[str], *, bits: int = 12, exact: bool = False,
                keep_order: bool = False) -> None:  # fmt: skip
    """Saves the current mesh as a progressive file: every prefix of it is a mesh.

    bits: of a coordinate, over the longest side of the box, 1 to 24
    exact: coordinates come back bit for bit once the whole file is read
    keep_order: vertices and faces come back in their order
    """
    with forgetting_failures():
        ms.save_current_mesh(str(_mrm(file)), bits=bits, exact=exact, keep_order=keep_order)


def open_stream(ms: Files, file: str | os.PathLike[str], *, max_vertices: int = 0, max_bytes: int = 0,
                max_error: float = 0) -> None:  # fmt: skip
    """Opens a progressive file as a new mesh, whole or until a limit is reached; 0 is no limit.

    max_error: RMS distance from the whole mesh, as estimated when it was saved, in units of the mesh
    """
    with forgetting_failures():
        ms.load_new_mesh(str(_mrm(file)), max_vertices=max_vertices, max_bytes=max_bytes, max_error=max_error)


def _mrm(file: str | os.PathLike[str]) -> pathlib.Path:
    path = pathlib.Path(file)
    if path.suffix.lower() != ".mrm":
        raise ValueError(f"{path}: pymeshlab goes by the name, which must end in .mrm")
    return path


class StreamError(ValueError):
    """A stream that is damaged, or none."""


@functools.cache
def _library() -> ctypes.CDLL:
    import pymeshlab  # type: ignore[import-untyped, unused-ignore]  # noqa: F401  # brings the plugin's libraries

    folder = pathlib.Path(__file__).parent / "plugins"
    library = ctypes.CDLL(str(next(iter(folder.glob("*io_multires*")))))
    handle, numbers = ctypes.c_void_p, ctypes.c_void_p
    for name, result, arguments in [
        ("new", handle, [ctypes.c_int32, ctypes.c_double]),
        ("free", None, [handle]),
        ("message", ctypes.c_char_p, [handle]),
        ("feed", ctypes.c_int, [handle, ctypes.c_char_p, ctypes.c_size_t]),
        ("state", None, [handle, numbers]),
        ("error", ctypes.c_double, [handle]),
        ("take", ctypes.c_int, [handle]),
        ("sizes", None, [handle, numbers]),
        ("mesh", None, [handle, numbers, numbers]),
        ("attribute", ctypes.c_char_p, [handle, ctypes.c_int32, numbers]),
        ("values", None, [handle, ctypes.c_int32, numbers]),
        ("wedges", None, [handle, numbers, numbers]),
        ("region_first", ctypes.c_int64, [handle, ctypes.c_int, numbers]),
        ("bytes", None, [handle, ctypes.c_char_p]),
    ]:
        function = getattr(library, "multires_stream_" + name)
        function.restype, function.argtypes = result, arguments
    return library


class StreamMesh:
    """A mesh out of a stream.

    vertices: #V by 3; faces: #F by 3
    attributes: arrays of #V by width: "color" (r, g, b, a in 0..255), "quality", "texcoord", and custom ones by name
    wedge_texcoords: #F by 3 by 2, and wedge_textures: #F by 3; None until the stream is complete, or if it has none
    """

    def __init__(self, handle: int) -> None:
        library = _library()
        sizes = np.zeros(4, np.int64)
        library.multires_stream_sizes(handle, sizes.ctypes.data)
        self.vertices: npt.NDArray[np.float64] = np.empty((sizes[0], 3))
        self.faces: npt.NDArray[np.int32] = np.empty((sizes[1], 3), np.int32)
        library.multires_stream_mesh(handle, self.vertices.ctypes.data, self.faces.ctypes.data)
        self.attributes: dict[str, npt.NDArray[np.float64]] = {}
        for k in range(int(sizes[2])):
            shape = np.zeros(2, np.int32)
            name = library.multires_stream_attribute(handle, k, shape.ctypes.data).decode()
            values = np.empty((sizes[0], shape[1]))
            library.multires_stream_values(handle, k, values.ctypes.data)
            self.attributes[name or KINDS[shape[0]]] = values
        self.wedge_texcoords: npt.NDArray[np.float64] | None = None
        self.wedge_textures: npt.NDArray[np.int32] | None = None
        if sizes[3]:
            self.wedge_texcoords = np.empty((sizes[1], 3, 2))
            self.wedge_textures = np.empty((sizes[1], 3), np.int32)
            library.multires_stream_wedges(handle, self.wedge_texcoords.ctypes.data, self.wedge_textures.ctypes.data)


class Stream:
    """Decodes a progressive file as its bytes arrive, for viewers and servers.

        stream = multires.Stream()
        for bytes in connection:
            stream.feed(bytes)
            if stream.started:
                show(stream.mesh())

    source: bytes, or the name of a file to read at once; None: all comes by feed()
    max_vertices, max_error: as in open_stream
    """

    def __init__(self, source: bytes | str | os.PathLike[str] | None = None, *, max_vertices: int = 0,
                 max_error: float = 0) -> None:  # fmt: skip
        self._handle = _library().multires_stream_new(max_vertices, max_error)
        if not self._handle:
            raise MemoryError
        if isinstance(source, bytes):
            self.feed(source)
        elif source is not None:
            self.feed(pathlib.Path(source).read_bytes())

    def __del__(self) -> None:
        if getattr(self, "_handle", None):
            _library().multires_stream_free(self._handle)
            self._handle = None

    def feed(self, data: bytes) -> None:
        """Takes the next bytes. Raises StreamError if they are damaged; what was decoded before stays."""
        self._check(_library().multires_stream_feed(self._handle, bytes(data), len(data)))

    def mesh(self) -> StreamMesh:
        """The mesh as far as it is known. Raises StreamError as long as there is none."""
        self._check(_library().multires_stream_take(self._handle))
        return StreamMesh(self._handle)

    def region_first(self, *, sphere: tuple[npt.ArrayLike, float] | None = None,
                     box: tuple[npt.ArrayLike, npt.ArrayLike] | None = None) -> bytes:  # fmt: skip
        """The same mesh as another stream, which has all vertices and faces of a region before it refines the rest.

            answer.write(multires.Stream("scan.mrm").region_first(sphere=(eye, 0.2)))

        sphere: centre and radius; box: lowest and highest corner; one of them, in units of the mesh
        Raises StreamError unless all has been read. Takes as long as saving: the file is written anew.
        """
        if (sphere is None) == (box is None):
            raise ValueError("a region is either a sphere or a box")
        region = sphere if box is None else box
        numbers = np.concatenate([np.ravel(np.asarray(part, float)) for part in region or ()])
        if len(numbers) != (4 if box is None else 6) or not np.isfinite(numbers).all():
            raise ValueError("a sphere is a centre and a radius, a box two corners, of numbers")
        size = _library().multires_stream_region_first(self._handle, box is not None, numbers.ctypes.data)
        self._check(size)
        data = ctypes.create_string_buffer(size)
        _library().multires_stream_bytes(self._handle, data)
        return data.raw

    @property
    def error(self) -> float:
        """Estimated RMS distance of the whole mesh's vertices from the present mesh, in units of the mesh."""
        return float(_library().multires_stream_error(self._handle))

    @property
    def started(self) -> bool:
        """Whether there is a mesh."""
        return bool(self._state()[0])

    @property
    def finished(self) -> bool:
        """Whether the mesh is complete."""
        return bool(self._state()[1])

    @property
    def vertices(self) -> int:
        """How many vertices there are now."""
        return int(self._state()[3])

    @property
    def total_vertices(self) -> int:
        """How many there will be."""
        return int(self._state()[4])

    @property
    def missing(self) -> int:
        """How many bytes have not come yet; 0 as long as that is not known."""
        return int(self._state()[5])

    def _state(self) -> npt.NDArray[np.int64]:
        state = np.zeros(6, np.int64)
        _library().multires_stream_state(self._handle, state.ctypes.data)
        return state

    def _check(self, worked: int) -> None:
        if not worked:
            raise StreamError(_library().multires_stream_message(self._handle).decode())
