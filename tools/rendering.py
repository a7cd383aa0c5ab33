"""Pictures of meshes, shaded or coloured by values, from the same camera. Needs no display.

contact_sheet() puts them side by side with captions: a row of whole views and a row of close-ups of the place where
they differ most. VTK renders with whatever
it finds: a display, EGL or OSMesa; Mesa's software drivers are enough.
"""

import dataclasses
import pathlib

import matplotlib
import numpy as np
import pyvista
from PIL import Image, ImageDraw, ImageFont
from vtkmodules.vtkCommonCore import vtkLogger

vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_ERROR)  # no display is no reason to warn

BACKGROUND = (246, 246, 244)
INK = (38, 38, 42)
FAINT = (112, 112, 118)
CLAY = "#d6c9b8"
FILL = 0.9  # part of a tile that the mesh takes up
CLOSE_UP = 0.3  # side of the close-up, in sides of the whole view
MARK = (196, 78, 52)


@dataclasses.dataclass
class Panel:
    """A mesh and its caption. vertices: #V by 3, faces: #F by 3, colors: #V by 3 in 0..1 or None, edges: draw them."""

    title: str
    subtitle: str
    vertices: np.ndarray
    faces: np.ndarray
    colors: np.ndarray | None = None
    edges: bool = False


@dataclasses.dataclass
class Camera:
    """Parallel projection: unit vectors of the picture, its centre and half its height, in mesh units."""

    right: np.ndarray
    up: np.ndarray
    towards: np.ndarray  # to the eye
    centre: np.ndarray
    half: float

    def closer(self, x, y, part):
        """The camera for a square of the picture with centre x, y in -1..1 and `part` of its side."""
        centre = self.centre + self.half * (x * self.right + y * self.up)
        return dataclasses.replace(self, centre=centre, half=self.half * part)


def three_quarter_camera(vertices, faces, up=None, azimuth=25.0):
    """A view of the broad side of the mesh, turned and raised a little.

    up: "x", "-x", "y", ...: the axis that points up; by default y, unless the mesh is a flat plate: then its thin axis
    azimuth: turn from the broad side, degrees
    """
    used = vertices[np.unique(faces)]
    extent = np.ptp(used, axis=0)
    thin = int(np.argmin(extent))
    plate = extent[thin] < 0.35 * np.median(extent)
    sign = -1 if up and up[0] == "-" else 1
    up = "xyz".index(up[-1]) if up else thin if plate else 1
    forward = min((axis for axis in range(3) if axis != up), key=lambda axis: extent[axis])
    azimuth, elevation = np.radians(azimuth), np.radians(40.0 if plate and up == thin else 12.0)
    upward, forward = sign * np.eye(3)[up], np.eye(3)[forward]
    sideward = np.cross(upward, forward)
    level = np.cos(azimuth) * forward + np.sin(azimuth) * sideward
    towards = np.cos(elevation) * level + np.sin(elevation) * upward
    right = np.cross(upward, towards)
    right /= np.linalg.norm(right)
    upward = np.cross(towards, right)
    seen = used @ np.stack([right, upward, towards], axis=1)
    low, high = seen.min(axis=0), seen.max(axis=0)
    centre = np.stack([right, upward, towards], axis=1) @ ((low + high) / 2)
    half = max(high[0] - low[0], high[1] - low[1]) / 2 / FILL
    return Camera(right, upward, towards, centre, half if half > 0 else 1.0)


def render(panel, camera, size):
    """An RGB picture, size by size."""
    plotter = pyvista.Plotter(off_screen=True, window_size=(size, size), lighting="none")
    plotter.set_background([c / 255 for c in BACKGROUND])
    mesh = pyvista.PolyData.from_regular_faces(panel.vertices, panel.faces)
    mesh = mesh.compute_normals(cell_normals=False, split_vertices=False, auto_orient_normals=False,
                                consistent_normals=False)
    look = {"color": CLAY} if panel.colors is None else {"scalars": panel.colors, "rgb": True}
    if panel.edges:
        look |= {"show_edges": True, "edge_color": "#4a443d", "line_width": 0.6}
    plotter.add_mesh(mesh, smooth_shading=not panel.edges, ambient=0.1, diffuse=0.9, specular=0.18, specular_power=18,
                     **look)
    # A raking key light brings out bumps; the others keep the shadows readable.
    for right, up, towards, intensity, color in ((-0.8, 0.75, 0.55, 0.95, "#fff6ea"), (0.9, 0.1, 0.5, 0.3, "#e8f0ff"),
                                                 (0.1, -0.6, 0.6, 0.12, "#ffffff"), (0.0, 0.15, 1.0, 0.18, "#ffffff")):
        position = right * camera.right + up * camera.up + towards * camera.towards
        plotter.add_light(pyvista.Light(position=position, focal_point=(0, 0, 0), intensity=intensity, color=color,
                                        light_type="scene light", positional=False))
    plotter.enable_parallel_projection()
    view = plotter.camera
    distance = 2 * float(np.linalg.norm(np.ptp(panel.vertices, axis=0)))
    view.focal_point = camera.centre
    view.position = camera.centre + distance * camera.towards
    view.up = camera.up
    view.parallel_scale = camera.half
    view.clipping_range = (distance * 0.01, distance * 3)
    plotter.enable_anti_aliasing("ssaa")
    picture = plotter.screenshot(return_img=True)
    plotter.close()
    return Image.fromarray(np.asarray(picture)[:, :, :3])


def coloured(values, least, most, name):
    """#V by 3 colours of the values, by matplotlib's colour map `name` from `least` to `most`."""
    return matplotlib.colormaps[name](np.clip((values - least) / (most - least), 0, 1))[:, :3]


def rows_in_use(pictures):
    """First and last row of square pictures that any mesh covers, with a little room."""
    size = pictures[0].height
    rows = np.flatnonzero(np.any([covered(p) for p in pictures], axis=(0, 2)))
    room = size // 40
    return (max(0, rows[0] - room), min(size, rows[-1] + room)) if rows.size else (0, size)


def covered(picture):
    """Size by size booleans: where the mesh is."""
    return (np.abs(np.asarray(picture, dtype=int) - BACKGROUND) > 3).any(axis=2)


def busiest_square(pictures, part):
    """Where pictures differ most from the first: centre of a square of `part` of their side, in -1..1."""
    grey = [np.asarray(p.convert("L"), dtype=float) for p in pictures]
    difference = sum(np.abs(g - grey[0]) for g in grey[1:]) if len(grey) > 1 else np.zeros_like(grey[0])
    inside = np.all([covered(p) for p in pictures], axis=0)
    size = difference.shape[0]
    window = max(1, int(part * size))

    def box_sum(image):
        total = np.pad(image.cumsum(axis=0).cumsum(axis=1), ((1, 0), (1, 0)))
        return total[window:, window:] - total[:-window, window:] - total[window:, :-window] + total[:-window, :-window]

    # Inside the mesh rather than at its outline.
    score = box_sum(difference * inside) * (box_sum(inside.astype(float)) / window**2) ** 2
    row, column = np.unravel_index(np.argmax(score), score.shape)
    return 2 * (column + window / 2) / size - 1, 1 - 2 * (row + window / 2) / size


def font(size, bold=False):
    name = "DejaVuSans-Bold.ttf" if bold else "DejaVuSans.ttf"
    return ImageFont.truetype(str(pathlib.Path(matplotlib.get_data_path()) / "fonts/ttf" / name), size)


def contact_sheet(panels, camera=None, tile=420, close_ups=True):
    """One picture: a column for each panel, captions on top, whole views, and close-ups below.

    The camera is that of the first panel.
    """
    camera = camera or three_quarter_camera(panels[0].vertices, panels[0].faces)
    whole = [render(p, camera, tile) for p in panels]
    x, y = busiest_square(whole, CLOSE_UP)
    near = [render(p, camera.closer(x, y, CLOSE_UP), tile) for p in panels] if close_ups else []

    # Whole views lose the empty rows above and below.
    gap, caption, line = tile // 40, tile // 6, max(1, tile // 300)
    first, last = rows_in_use(whole)
    below = caption + last - first + gap
    sheet = Image.new("RGB", (len(panels) * (tile + gap) + gap, below + (tile + gap if near else 0)), BACKGROUND)
    draw = ImageDraw.Draw(sheet)
    for column, panel in enumerate(panels):
        left = gap + column * (tile + gap)
        draw.text((left + tile / 2, caption * 0.48), panel.title, INK, font(tile // 19, bold=True), anchor="ms")
        draw.text((left + tile / 2, caption * 0.8), panel.subtitle, FAINT, font(tile // 28), anchor="ms")
        sheet.paste(whole[column].crop((0, first, tile, last)), (left, caption))
        if near:
            sheet.paste(near[column], (left, below))
            draw.rectangle([left, below, left + tile - 1, below + tile - 1], outline=MARK, width=line)
            centre, reach = (left + (x + 1) / 2 * tile, caption - first + (1 - y) / 2 * tile), CLOSE_UP * tile / 2
            draw.rectangle([c - reach for c in centre] + [c + reach for c in centre], outline=MARK, width=line)
    return sheet
