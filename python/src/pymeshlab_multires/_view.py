"""A viewer with live sliders, for notebooks."""

import dataclasses
import html
import importlib
import inspect
import io
import math
import pathlib
import time
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from ._call import Array
from ._filters import FILTERS, LIMITS, build_pyramid, equalizer

_WAVELENGTHS = {"finest", "cutoff", "coarsest"}
_MISSING = 'view() needs {}, which is not installed: pip install "pymeshlab-multires[view]"'


@dataclasses.dataclass
class _Slider:
    least: float
    most: float
    start: float

    @property
    def logarithmic(self) -> bool:
        return self.least > 0 and self.most >= 8 * self.least


def _copy(ms: Any) -> Any:
    """A document of a copy of the current mesh. It has no pyramid and no original shape yet."""
    import pymeshlab  # type: ignore[import-untyped, unused-ignore]

    work = pymeshlab.MeshSet(verbose=False)
    work.add_mesh(ms.current_mesh())
    return work


def _check(function: Callable[..., Any], given: set[str]) -> None:
    parameters = {*inspect.signature(function).parameters}
    if "relative_to" not in parameters:
        raise ValueError(f"{function.__name__} has no relative_to, which view() needs")
    for name in given - (parameters - {"ms", "relative_to"}):
        raise ValueError(f"{function.__name__} has no {name} to be set in view()")


def _lengths(ms: Any, function: Callable[..., Any], fixed: Mapping[str, Any]) -> dict[str, float]:
    """The defaults that the filter derives from the mesh, mesh units: they would drift as the shape changes."""
    if fixed.get("unit", "wavelength") != "wavelength":
        return {}
    values = ms.filter_parameter_values(FILTERS[function.__name__][0])
    derived = [n for n, p in inspect.signature(function).parameters.items() if p.default is None]
    return {n: values[n] for n in derived if isinstance(values.get(n), float) and n not in fixed}


def _sliders(ms: Any, function: Callable[..., Any], wanted: Mapping[str, tuple[float, float]] | None,
             fixed: Mapping[str, Any], lengths: Mapping[str, float]) -> dict[str, _Slider]:  # fmt: skip
    """The sliders of the function: those that are wanted; else its real numbers of two limits, and its wavelengths."""
    parameters = inspect.signature(function).parameters
    ranges = dict(wanted or {})
    if wanted is None:
        limits = LIMITS.get(function.__name__, {})
        ranges = {n: limits[n] for n, p in parameters.items() if n in limits and isinstance(p.default, float)}
        if lengths.keys() & _WAVELENGTHS:
            waves = build_pyramid(_copy(ms), pyramid=fixed.get("pyramid")).wavelength
            ranges |= {n: (float(waves[0]), float(waves[-1])) for n in parameters if n in _WAVELENGTHS}
    out = {}
    for name, (least, most) in ranges.items():
        start = lengths.get(name, parameters[name].default)
        if name not in fixed:
            out[name] = _Slider(least, most, min(max(least if start is None else start, least), most))
    return out


class Viewer:
    """What view() returns: a notebook shows it, and scripts set() its sliders and take a screenshot()."""

    report: Any
    """What the function returned for the values that are shown: displacements are those from what was shown before."""

    def __init__(self, ms: Any, function: Callable[..., Any], sliders: Mapping[str, tuple[float, float]] | None,
                 size: tuple[int, int], fixed: Mapping[str, Any]) -> None:  # fmt: skip
        _check(function, {*(sliders or {}), *fixed})
        self._ms, self._function, self._fixed = ms, function, dict(fixed)
        self._begin()
        self.sliders = _sliders(ms, function, sliders, fixed, self._lengths)
        self._values = {name: s.start for name, s in self.sliders.items()}
        self._widget: Any = None
        self._run()
        self._draw(size)

    # ---- values ----

    @property
    def values(self) -> dict[str, float]:
        """Where the sliders are."""
        return dict(self._values)

    @property
    def call(self) -> str:
        """The call that does to the document what is shown."""
        usual = {n: p.default for n, p in inspect.signature(self._function).parameters.items()} | self._lengths
        moved = {n: float(f"{v:.4g}") for n, v in self._values.items() if v != usual[n]}
        given = moved | self._fixed
        return f"multires.{self._function.__name__}({', '.join(['ms', *(f'{n}={v!r}' for n, v in given.items())])})"

    def set(self, **values: float) -> Any:
        """Moves sliders, computes the shape anew on the pyramid that is kept, and draws it; the function's report.

        Raises:
            ValueError: there is no such slider.
            pymeshlab.PyMeshLabException: the values will not do; what was shown stays.
        """
        for name in values.keys() - self.sliders.keys():
            raise ValueError(f"there is no slider {name}; there are {', '.join(self.sliders) or 'none'}")
        before, self._values = self._values, self._values | values
        try:
            self._run()
        except Exception:
            self._values = before
            raise
        self._show()
        return self.report

    def apply(self) -> Any:
        """Does to the document's current mesh what is shown, and goes on from there, with the sliders at their start.

        Returns: the function's report.
        """
        done = self._function(self._ms, **self._given)
        self._begin()
        self.set(**{name: s.start for name, s in self.sliders.items()})
        return done

    def _begin(self) -> None:
        """Takes the shape of the document's mesh as the one that all values start from."""
        self._work = _copy(self._ms)
        self._before: Array = self._work.current_mesh().vertex_matrix()
        self._normals: Array = self._work.current_mesh().vertex_normal_matrix()
        self._lengths = _lengths(self._work, self._function, self._fixed)

    @property
    def _given(self) -> dict[str, Any]:
        return self._lengths | self._values | self._fixed

    def _run(self) -> None:
        begin = time.perf_counter()
        self.report = self._function(self._work, relative_to="original", **self._given)
        self.seconds = time.perf_counter() - begin

    # ---- picture ----

    def _draw(self, size: tuple[int, int]) -> None:
        try:
            pyvista: Any = importlib.import_module("pyvista")
        except ImportError as error:
            raise ImportError(_MISSING.format("pyvista")) from error
        vtkLogger = importlib.import_module("vtkmodules.vtkCommonCore").vtkLogger
        vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_ERROR)  # that there is no display is no reason to warn
        mesh = self._work.current_mesh()
        self._surface = pyvista.PolyData.from_regular_faces(mesh.vertex_matrix(), mesh.face_matrix())
        self._surface["displacement"] = np.zeros(mesh.vertex_number())
        self.plotter: Any = pyvista.Plotter(off_screen=True, window_size=list(size))
        self._actor = self.plotter.add_mesh(self._surface, scalars="displacement", cmap="coolwarm", smooth_shading=True,
                                            show_scalar_bar=False)  # fmt: skip
        self._actor.prop.color = "#d6c9b8"
        self.plotter.camera_position = "xy"
        self.plotter.camera.zoom(1.35)
        self._home = self.plotter.camera.copy()
        self.look(25, 12)
        self.color(displacement=False)

    def look(self, turn: float = 0, tilt: float = 0, zoom: float = 1) -> None:
        """Sets the camera: degrees to the right and up from the front (x to the right, y up), and magnification."""
        self.plotter.camera = self._home.copy()
        self.plotter.camera.azimuth, self.plotter.camera.elevation = turn, min(max(tilt, -89.9), 89.9)
        self.plotter.camera.zoom(zoom)
        self.plotter.reset_camera_clipping_range()
        self._refresh()

    def color(self, *, displacement: bool) -> None:
        """Whether colours show how far each vertex has moved along its normal: outward red, inward blue."""
        self._actor.mapper.scalar_visibility = displacement
        self._show()

    def _show(self) -> None:
        points = self._work.current_mesh().vertex_matrix()
        self._surface.points = points
        self._surface.compute_normals(cell_normals=False, split_vertices=False, consistent_normals=False, inplace=True)
        moved = np.einsum("ij,ij->i", points - self._before, self._normals)
        self._surface["displacement"] = moved
        most = max(float(np.quantile(np.abs(moved), 0.99)), 1e-300) if moved.size else 1.0
        self._actor.mapper.scalar_range = -most, most
        self._refresh()

    def screenshot(self, path: str | pathlib.Path | None = None) -> npt.NDArray[np.uint8]:
        """The picture, height by width by 3; written to the file too, if a path is given."""
        self.plotter.render()
        picture: npt.NDArray[np.uint8] = self.plotter.screenshot(None if path is None else str(path), return_img=True)
        return picture

    # ---- notebook ----

    @property
    def widget(self) -> Any:
        """Sliders and picture as a widget of ipywidgets."""
        if self._widget is None:
            try:
                ipywidgets: Any = importlib.import_module("ipywidgets")
            except ImportError as error:
                raise ImportError(_MISSING.format("ipywidgets")) from error
            self._widget = self._build(ipywidgets)
            self._refresh()
        return self._widget

    def _build(self, w: Any) -> Any:
        live = self.seconds < 0.5  # slower: when the mouse is let go
        style = {"continuous_update": live, "style": {"description_width": "80px"}}
        self._controls = {}
        for name, s in self.sliders.items():
            ends = ({"base": 10, "min": math.log10(s.least), "max": math.log10(s.most), "step": 0.01} if s.logarithmic
                    else {"min": s.least, "max": s.most, "step": (s.most - s.least) / 200})  # fmt: skip
            kind = w.FloatLogSlider if s.logarithmic else w.FloatSlider
            told = {"description": name, "readout_format": ".3g"}
            self._controls[name] = kind(value=self._values[name], **told, **ends, **style)
            self._controls[name].observe(lambda change, name=name: self._moved(**{name: change["new"]}), "value")
        camera = {"turn": w.FloatSlider(value=25, min=-180, max=180, description="turn", readout_format=".0f", **style),
                  "tilt": w.FloatSlider(value=12, min=-89, max=89, description="tilt", readout_format=".0f", **style),
                  "zoom": w.FloatLogSlider(value=1, base=10, min=0, max=1.5, description="zoom", **style)}  # fmt: skip
        for control in camera.values():
            control.observe(lambda _: self.look(**{n: c.value for n, c in camera.items()}), "value")
        colors = w.Checkbox(value=False, description="colour by displacement", indent=False)
        colors.observe(lambda change: self.color(displacement=change["new"]), "value")
        apply = w.Button(description="Apply", tooltip="Do this to the document's mesh")
        apply.on_click(lambda _: self._tell_errors(self.apply))
        self._told, self._image = w.HTML(), w.Image(format="jpeg")
        left = w.VBox([*self._controls.values(), colors, apply, self._told, *camera.values()])
        return w.HBox([left, self._image])

    def _moved(self, **values: float) -> None:
        """A slider was moved in the notebook."""
        if any(self._values[n] != v for n, v in values.items()):
            self._tell_errors(lambda: self.set(**values))

    def _tell_errors(self, action: Callable[[], Any]) -> None:
        """What a filter has against the values stands below the sliders: a notebook drops what callbacks raise."""
        try:
            action()
        except Exception as error:  # noqa: BLE001
            self._told.value = f"<b>{html.escape(str(error).strip())}</b>"

    def _refresh(self) -> None:
        """Picture, sliders and report of the widget, if there is one."""
        if self._widget is None:
            return
        from PIL import Image

        for name, control in self._controls.items():
            control.value = self._values[name]
        moved = np.linalg.norm(self._surface.points - self._before, axis=1)
        self._told.value = (f"largest displacement {moved.max():.3g}, RMS {np.sqrt(np.mean(moved**2)):.3g}<br>"
                            f"{self.seconds:.2f} s<br><code>{html.escape(self.call)}</code>")  # fmt: skip
        out = io.BytesIO()
        Image.fromarray(self.screenshot()).save(out, "jpeg", quality=90)
        self._image.value = out.getvalue()

    def _repr_mimebundle_(self, **how: Any) -> Any:
        return self.widget._repr_mimebundle_(**how)


def view(ms: Any, function: Callable[..., Any] = equalizer, *,
         sliders: Mapping[str, tuple[float, float]] | None = None, size: tuple[int, int] = (640, 520),
         **fixed: Any) -> Viewer:  # fmt: skip
    """A viewer with live sliders for a function that moves vertices, for the last line of a notebook's cell.

    It works on a copy of the current mesh, on which the pyramid is built once; each move of a slider starts again from
    the shape that the mesh had. The document changes at "Apply" only. Pictures are drawn where Python runs, without a
    display, so that it works in any notebook, also from afar.

    Args:
        ms: the document; its current mesh is shown.
        function: equalizer, enhance, low_pass, stop_band, denoise, unsharp, multiband_edit or grid_band.
        sliders: least and most of each, by parameter: {"cutoff": (0.5, 8)}. None: all real numbers of the function that
            have two limits, and wavelengths from the finest to the coarsest of the pyramid.
        size: width and height of the picture.
        fixed: other parameters of the function: method="spline", pyramid=Pyramid(scheme="Roy").

    Raises:
        ValueError: a function that has no relative_to, or a parameter that it does not have.
        ImportError: pyvista (or, when it is shown, ipywidgets) is not installed.
        pymeshlab.PyMeshLabException: the mesh or a value will not do; it says why.
    """
    return Viewer(ms, function, sliders, size, fixed)
