"""A function and a report for every filter. Written by tools/generate.py from the filter tables."""

import dataclasses
from typing import Literal, TypeAlias

from ._call import Array, MeshSet, Vector, also_flat, apply

__all__ = [
    "AdaptiveReconstructionReport", "AttributeChanges", "Basis", "BuildPyramidReport", "Channels",
    "CompressGridAttributesReport", "DenoiseAttributesReport", "DenoiseReport", "DetailFromLayerReport",
    "DetailToQualityReport", "DetailsByScaleReport", "DifferenceToLayerReport", "EnhanceReport", "EqualizerReport",
    "FILTERS", "FalloffToQualityReport", "Features", "FilterAttributesReport", "FilterCustomAttributesReport",
    "FilterGridAttributesReport", "GenerateTexcoordReport", "GridBandReport", "GridCompressReport", "GridEditReport",
    "GridLevelReport", "GridReport", "Grouping", "KeepBy", "LIMITS", "LevelAsLayerReport", "LowPassReport", "Mode",
    "MoveRegionReport", "Movement", "MultibandEditReport", "Operator", "Oracle", "Order", "Pyramid", "PyramidUse",
    "ReadWatermarkReport", "RelativeTo", "RelaxAttributesReport", "ReliefReport", "Result", "RoughnessReport", "Scheme",
    "SelectFeaturesReport", "SmoothBaseAsLayerReport", "Split", "StopBandReport", "Storage", "TransferEditReport",
    "UnsharpReport", "Update", "WatermarkReport", "adaptive_reconstruction", "build_pyramid",
    "compress_grid_attributes", "denoise", "denoise_attributes", "detail_from_layer", "detail_to_quality",
    "details_by_scale", "difference_to_layer", "enhance", "equalizer", "falloff_to_quality", "filter_attributes",
    "filter_custom_attributes", "filter_grid_attributes", "generate_texcoord", "grid", "grid_band", "grid_compress",
    "grid_edit", "grid_level", "level_as_layer", "low_pass", "move_region", "multiband_edit", "read_watermark",
    "relax_attributes", "relief", "roughness", "select_features", "smooth_base_as_layer", "stop_band", "transfer_edit",
    "unsharp", "watermark",
]

Scheme: TypeAlias = Literal["Roy", "Guskov", "Lazy", "Szczesna", "Dreger"]
Operator: TypeAlias = Literal[
    "umbrella", "cotangent", "cotangent clamped", "cotangent Delaunay", "second difference",
    "second difference with flaps", "natural neighbours", "thin plate 1-ring", "thin plate 2-ring",
]
Update: TypeAlias = Literal["mean", "none"]
Grouping: TypeAlias = Literal["independent sets", "sequential"]
Storage: TypeAlias = Literal["double", "float"]
Split: TypeAlias = Literal["quadric", "regression plane"]
Features: TypeAlias = Literal["none", "by angle", "edges not faux", "selected edges"]
Order: TypeAlias = Literal["1", "2", "4", "gaussian"]
RelativeTo: TypeAlias = Literal["current shape", "original"]
Mode: TypeAlias = Literal["low pass", "stop band", "enhance"]
Channels: TypeAlias = Literal["positions", "heights"]
Basis: TypeAlias = Literal["linear", "quartic"]
KeepBy: TypeAlias = Literal["share", "error"]
Oracle: TypeAlias = Literal["magnitude", "pursuit"]


@dataclasses.dataclass(frozen=True, kw_only=True)
class Pyramid:
    """How a pyramid is built. What is None is the filter's own default; the one named here is that of most filters.

    A pyramid is kept with its mesh and reused by calls with an equal Pyramid.

    Args:
        scheme: Roy: details in world axes. Guskov: details turn with the coarser surface, so that fine structure
            follows when coarse structure is changed. Lazy: vertices that stay keep their values and have no details:
            the least memory and time, but fine noise comes back in coarse levels. Szczesna: lifting that hands the mean
            of what goes to what stays: no more details than vertices, in world axes, and coarse levels that are means.
            Dreger: box-spline wavelets, for triangular grids only (terrains, range maps); levels are octaves of the
            grid, and operator, presmoothing and how vertices are removed do not apply. Default: Guskov.
        operator: Relaxation operator: how a vertex is predicted from its neighbours. Second differences keep shape
            best; cotangent weights are faster and shrink; the umbrella ignores geometry and lets vertices drift;
            natural neighbours and thin plates interpolate above the vertex's foot in the plane of its neighbours
            (Szczesna). Default: second difference with flaps.
        presmooth: Share of a relaxation step taken before vertices are removed, 0 to 1. It keeps fine noise out of
            coarse levels; 0 is what the papers do. Only Roy and Guskov have it. A number, 0 to 1. Default: 0.5.
        update: Szczesna's scheme only. Mean: before a vertex goes, its neighbours take over its share of the mean, so
            that coarse levels are means. None: coarse levels are subsets of the vertices, as in Lazy. Default: mean.
        grouping: Independent sets: each level removes sets of vertices that are not neighbours, about a quarter of the
            vertices a set (Roy). Sequential: one vertex after the other, cheapest first (Guskov). Default: independent
            sets.
        storage: How the pyramid keeps weights and details. Float takes half the memory, for meshes of many millions of
            vertices; unchanged bands then come back to about 1e-8 of the mesh's size instead of 1e-15. Default: double.
        sets_per_level: Independent sets only: how many sets, a quarter of the vertices each, a level removes. 2
            separates bands best; 1 sees most of the noise. A whole number, 1 to 100. Default: 2.
        level_ratio: Sequential only: share of its vertices that a level keeps, for example 0.8; 0 makes every vertex a
            level of its own. A number, 0 to 0.99. Default: 0.
        base_vertices: Vertices at which the pyramid stops. A whole number, at least 4. Default: 100.
        length_weight: Weight of edge length against the quadric error when vertices are chosen: 0 keeps vertices where
            the surface bends, 1 keeps them evenly spaced. A number, 0 to 1000. Default: 0.1.
        split: Which vertices go first, and where to. Quadric: those that change the surface least, spaced evenly.
            Regression plane: those nearest to the plane of their neighbours, into the neighbour that turns the faces
            least (Szczesna); flat parts empty first, and even spacing does not apply. Default: quadric.
        normal_limit: Degrees by which removing a vertex may turn a face at most. A number, 1 to 180. Default: 60.
        features: Edges that are not smoothed across: none; those where the normals of the two faces differ by more than
            the feature angle; those not marked as faux; those selected on their faces. Default: none.
        feature_angle: Degrees between the normals of two faces above which their edge is sharp. A number, 0.01 to
            179.99. Default: 40.
    """

    scheme: Scheme | None = None
    operator: Operator | None = None
    presmooth: float | None = None
    update: Update | None = None
    grouping: Grouping | None = None
    storage: Storage | None = None
    sets_per_level: int | None = None
    level_ratio: float | None = None
    base_vertices: int | None = None
    length_weight: float | None = None
    split: Split | None = None
    normal_limit: float | None = None
    features: Features | None = None
    feature_angle: float | None = None


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class Movement:
    """How far a filter moved vertices, and what that did to the shape."""

    largest_displacement: float
    """The longest way a vertex moved (mesh units)."""
    rms_displacement: float
    """Root of the mean square of the ways of all vertices (mesh units)."""
    volume_before: float
    """Enclosed volume of the input; of no use if the mesh is open (cubic mesh units)."""
    volume_after: float
    """The same of the result (cubic mesh units)."""
    area_before: float
    """Surface area of the input (square mesh units)."""
    area_after: float
    """Surface area of the result (square mesh units)."""
    centroid_shift: float
    """How far the centroid of the surface moved (mesh units)."""
    flipped_faces: int
    """Faces whose normal turned by more than 90 degrees."""


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class PyramidUse:
    """The pyramid that a filter used."""

    pyramid_reused: bool
    """The pyramid kept with the mesh was used; otherwise one was built and kept."""
    locked_vertices: int
    """Vertices at non-manifold edges or points, which are neither moved nor removed."""
    unreferenced_vertices: int
    """Vertices without a face, which stay where they are."""


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class AttributeChanges:
    """How far a filter changed attributes."""

    largest_change: dict[str, float] = dataclasses.field(default_factory=dict)
    """The largest change of a vertex's value; of colours 0 to 255 (units of the attribute). By attribute."""
    rms_change: dict[str, float] = dataclasses.field(default_factory=dict)
    """Root of the mean square of the changes (units of the attribute). By attribute."""


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class Result:
    """What a filter that changes something returns."""

    result_hash: float
    """Hash of all that was computed: the same if, and in practice only if, the result is."""


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class BuildPyramidReport(PyramidUse):
    """What build_pyramid() returns."""

    levels: int
    """Number of the coarsest level; the finest is 0."""
    level: Array
    """0, 1, ... to the coarsest."""
    vertices: Array
    """Vertices of each level."""
    wavelength: Array
    """Finest wave of each level: twice its mean edge length (mesh units)."""
    rms_detail: Array
    """Root mean square of each level's details; 0 for the coarsest (mesh units)."""
    reconstruction_error: float
    """Largest distance of a vertex after all levels are added up (mesh units)."""
    duplicate_vertices: int
    """Vertices at the place of another one."""
    degenerate_faces: int
    """Faces with a vertex twice or without area."""
    duplicate_faces: int
    """Faces with the vertices of another one."""
    non_manifold_edges: int
    """Edges of more than two faces."""
    non_manifold_vertices: int
    """Vertices whose faces do not form one fan."""
    boundary_edges: int
    """Edges of one face."""
    boundary_loops: int
    """Closed boundaries."""
    inconsistent_edges: int
    """Edges whose two faces are turned differently."""
    components: int
    """Parts that share no edge."""


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class LevelAsLayerReport(PyramidUse, Result):
    """What level_as_layer() returns."""

    level: int
    """The level."""
    vertices: int
    """Its vertices."""
    faces: int
    """Its faces."""
    wavelength: float
    """Twice its mean edge length (mesh units)."""


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class DetailToQualityReport(PyramidUse, Result):
    """What detail_to_quality() returns."""

    least_detail: float
    """Smallest value written to the vertex quality (mesh units)."""
    largest_detail: float
    """Largest value (mesh units)."""
    rms_detail: float
    """Root of their mean square (mesh units)."""
    gains: Array
    """The factor of each level's details, finest first."""


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class DifferenceToLayerReport(Result):
    """What difference_to_layer() returns."""

    rms_difference: float
    """Root mean square of the difference over the surface (mesh units)."""
    mean_difference: float
    """Its mean: positive outside the reference, on the whole (mesh units)."""
    largest_difference: float
    """Largest value written to the vertex quality (mesh units)."""
    smallest_difference: float
    """Smallest value; negative inside (mesh units)."""
    share_beyond: float
    """Share of the area farther away than the tolerance, 0 to 1."""
    gains: Array | None = None
    """With a wavelength: the factor of each level's details, finest first."""
    pyramid_reused: bool | None = None
    """With a wavelength: the pyramid kept with the mesh was used."""
    locked_vertices: int | None = None
    """With a wavelength: vertices at non-manifold edges or points."""
    unreferenced_vertices: int | None = None
    """With a wavelength: vertices without a face."""


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class RoughnessReport:
    """What roughness() returns."""

    solver_reused: bool | None = None
    """The solver kept with the mesh was used; otherwise one was set up and kept (low pass)."""
    form_radius: float | None = None
    """Radius of the fitted sphere or cylinder (mesh units)."""
    area: float
    """Area of the surface that heights count from (square mesh units)."""
    sa: float
    """Arithmetical mean height (mesh units)."""
    sq: float
    """Root mean square height (mesh units)."""
    sp: float
    """Maximum peak height (mesh units)."""
    sv: float
    """Maximum pit height (mesh units)."""
    sz: float
    """Maximum height, Sp + Sv (mesh units)."""
    ssk: float
    """Skewness: below 0 with pits, above with peaks."""
    sku: float
    """Kurtosis: 3 for a normal distribution."""
    sdq: float
    """Root mean square gradient."""
    sdr: float
    """Developed interfacial area ratio (percent)."""
    heights: Array
    """Limits of the histogram, from the mean height; one more than shares (mesh units)."""
    shares: Array
    """Share of the area between two heights; sum 1."""


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class ReliefReport(Result):
    """What relief() returns."""

    solver_reused: bool
    """The solver kept with the mesh was used; otherwise one was set up and kept."""
    finest: float
    """The fine limit of the band, 0 if there is none (mesh units)."""
    coarsest: float
    """The coarse limit (mesh units)."""
    lowest: float
    """The lowest height (mesh units)."""
    highest: float
    """The highest (mesh units)."""
    rms_height: float
    """Root mean square of the heights, by area (mesh units)."""
    skewness: float
    """Of the heights: below 0 where the relief is cut, above where it is raised."""


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class DetailsByScaleReport(Result):
    """What details_by_scale() returns."""

    solver_reused: bool
    """The solver kept with the mesh was used; otherwise one was set up and kept."""
    limits: Array
    """Where each band ends; it begins where the one before ends (mesh units)."""
    wavelengths: Array
    """The middle of each band: what the quality holds (mesh units)."""
    rms_details: Array
    """Root mean square detail of each band, by area (mesh units)."""


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class SelectFeaturesReport(Result):
    """What select_features() returns."""

    edges: int
    """Edges on the lines."""
    vertices: int
    """Vertices on the lines."""
    length: float
    """Length of all lines (mesh units)."""
    noise: float
    """Median difference of neighbouring normals before they were denoised."""


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class LowPassReport(Movement, Result):
    """What low_pass() returns."""

    gains: Array | None = None
    """The factor of each level's details, finest first."""
    pyramid_reused: bool | None = None
    """The pyramid kept with the mesh was used; otherwise one was built and kept."""
    locked_vertices: int | None = None
    """Vertices at non-manifold edges or points, which are neither moved nor removed."""
    unreferenced_vertices: int | None = None
    """Vertices without a face, which stay where they are."""
    solver_reused: bool | None = None
    """The solver kept with the mesh was used; otherwise one was set up and kept (spline)."""
    measured_waves: Array | None = None
    """Waves that were tested (measure) (mesh units)."""
    measured_transmission: Array | None = None
    """The share that was left of them."""
    formula_transmission: Array | None = None
    """The share that the formula leaves of them."""
    normal_rms: float | None = None
    """Root of the mean square of the ways along the normals, by area (spline) (mesh units)."""
    tangential_rms: float | None = None
    """The same of the ways along the surface: drift (spline) (mesh units)."""


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class StopBandReport(Movement, Result):
    """What stop_band() returns."""

    gains: Array | None = None
    """The factor of each level's details, finest first."""
    pyramid_reused: bool | None = None
    """The pyramid kept with the mesh was used; otherwise one was built and kept."""
    locked_vertices: int | None = None
    """Vertices at non-manifold edges or points, which are neither moved nor removed."""
    unreferenced_vertices: int | None = None
    """Vertices without a face, which stay where they are."""
    solver_reused: bool | None = None
    """The solver kept with the mesh was used; otherwise one was set up and kept (spline)."""
    measured_waves: Array | None = None
    """Waves that were tested (measure) (mesh units)."""
    measured_transmission: Array | None = None
    """The share that was left of them."""
    formula_transmission: Array | None = None
    """The share that the formula leaves of them."""
    normal_rms: float | None = None
    """Root of the mean square of the ways along the normals, by area (spline) (mesh units)."""
    tangential_rms: float | None = None
    """The same of the ways along the surface: drift (spline) (mesh units)."""


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class EnhanceReport(Movement, Result):
    """What enhance() returns."""

    gains: Array | None = None
    """The factor of each level's details, finest first."""
    pyramid_reused: bool | None = None
    """The pyramid kept with the mesh was used; otherwise one was built and kept."""
    locked_vertices: int | None = None
    """Vertices at non-manifold edges or points, which are neither moved nor removed."""
    unreferenced_vertices: int | None = None
    """Vertices without a face, which stay where they are."""
    solver_reused: bool | None = None
    """The solver kept with the mesh was used; otherwise one was set up and kept (spline)."""
    measured_waves: Array | None = None
    """Waves that were tested (measure) (mesh units)."""
    measured_transmission: Array | None = None
    """The share that was left of them."""
    formula_transmission: Array | None = None
    """The share that the formula leaves of them."""
    normal_rms: float | None = None
    """Root of the mean square of the ways along the normals, by area (spline) (mesh units)."""
    tangential_rms: float | None = None
    """The same of the ways along the surface: drift (spline) (mesh units)."""


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class EqualizerReport(Movement, Result):
    """What equalizer() returns."""

    gains: Array | None = None
    """The factor of each level's details, finest first."""
    pyramid_reused: bool | None = None
    """The pyramid kept with the mesh was used; otherwise one was built and kept."""
    locked_vertices: int | None = None
    """Vertices at non-manifold edges or points, which are neither moved nor removed."""
    unreferenced_vertices: int | None = None
    """Vertices without a face, which stay where they are."""
    solver_reused: bool | None = None
    """The solver kept with the mesh was used; otherwise one was set up and kept (spline)."""
    measured_waves: Array | None = None
    """Waves that were tested (measure) (mesh units)."""
    measured_transmission: Array | None = None
    """The share that was left of them."""
    formula_transmission: Array | None = None
    """The share that the formula leaves of them."""
    normal_rms: float | None = None
    """Root of the mean square of the ways along the normals, by area (spline) (mesh units)."""
    tangential_rms: float | None = None
    """The same of the ways along the surface: drift (spline) (mesh units)."""


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class UnsharpReport(Movement, Result):
    """What unsharp() returns."""



@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class DenoiseReport(Movement, Result):
    """What denoise() returns."""

    noise: float
    """Standard deviation of the noise found, along the normals (mesh units)."""
    noise_in_edges: float | None = None
    """Automatic: the same in mean edge lengths."""
    noise_least: float | None = None
    """Automatic: the same where it is least, if it varies (mesh units)."""
    noise_most: float | None = None
    """Automatic: the same where it is largest (mesh units)."""
    noise_in_all_directions: bool | None = None
    """Automatic: the noise was found within the surface too."""
    noise_along_axis: bool | None = None
    """Automatic: most of the noise goes along one axis of space."""
    rounding_step: float | None = None
    """Automatic: step that the coordinates were rounded to, if that is what the noise is; otherwise 0 (mesh units)."""
    spikes_removed: int | None = None
    """Vertices found to be impulses and set back first."""
    estimated_rms_before: float | None = None
    """Automatic: expected RMS distance of the vertices from the truth (mesh units)."""
    estimated_rms_after: float | None = None
    """Automatic: the same of the result (mesh units)."""
    share_low_pass: float | None = None
    """Automatic: weight of the low passes in the result."""
    share_wiener: float | None = None
    """Automatic: weight of the local Wiener filters."""
    share_normal_field: float | None = None
    """Automatic: weight of the normal field."""
    share_guided_normals: float | None = None
    """Automatic: weight of guided normals after it."""
    noise_per_level: Array | None = None
    """Noise in the details of each level, finest first: of the normals, or with thresholding in mesh units."""
    normal_noise: float | None = None
    """Normal field: median difference of neighbouring unit normals."""
    normal_noise_after: float | None = None
    """Normal field: the same after denoising."""
    detail_per_level: Array | None = None
    """Normal field: RMS detail of the normals on each level."""
    share_removed: Array | None = None
    """Normal field: share of each level's details that was taken out."""
    threshold_per_level: Array | None = None
    """Thresholding: what was used on each level (mesh units)."""
    share_zeroed: Array | None = None
    """Thresholding: share of the details that became 0, of each level."""
    pyramid_reused: bool | None = None
    """Thresholding: the pyramid kept with the mesh was used."""
    locked_vertices: int | None = None
    """Thresholding: vertices at non-manifold edges or points."""
    unreferenced_vertices: int | None = None
    """Thresholding: vertices without a face."""


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class TransferEditReport(Movement, Result):
    """What transfer_edit() returns."""

    way: int
    """What the edited proxy was compared with: 1 a level of the current layer, 2 the proxy before, 3 a level that
    was wrapped onto it."""
    proxy_distance: float
    """Root mean square distance of the vertices to the proxy before (mesh units)."""
    folded_faces: int
    """Faces that lie the other way round than the motion of the proxy near them would have it."""
    vertices_kept: Array | None = None
    """Vertices that each base keeps, finest first."""
    band_detail: Array | None = None
    """Root mean square length of the details of each band, finest first (mesh units)."""
    border_points: int | None = None
    """Base points on the boundary, where the search left the surface."""
    nearest_points: int | None = None
    """Base points that are the nearest, where no normal goes through the vertex."""
    pyramid_reused: bool | None = None
    """The pyramid kept with the mesh was used; otherwise one was built and kept."""
    locked_vertices: int | None = None
    """Vertices at non-manifold edges or points, which are neither moved nor removed."""
    unreferenced_vertices: int | None = None
    """Vertices without a face, which stay where they are."""


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class WatermarkReport(Movement, Result):
    """What watermark() returns."""

    carriers: int
    """Places that carry the mark: 280, fewer if there are fewer than 560 vertices, and then it may not be readable."""
    carrier_spacing: float
    """Distance of the places that carry the mark; its waves are about twice as long, and longer (mesh units)."""


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class ReadWatermarkReport:
    """What read_watermark() returns."""

    bits: Array
    """The 64 bits of the message, the most significant first."""
    confidence: Array
    """For each bit the probability that it is right, 0.5 to 1."""
    sure_bits: int
    """How many of them are right with a probability of more than 0.99."""
    probability_unmarked: float
    """Probability that a mesh without a mark of this key would look as much like one, as estimated from wrong keys."""
    bit_errors: int | None = None
    """With an expected message: the bits that differ."""
    carriers_seen: float
    """Share of the places that carry the mark that the mesh still has, 0 to 1."""
    scale: float
    """Factor that makes the mesh as large as the original."""
    smoothing: float
    """How many steps of smoothing made the original most like the mesh, 0 if none did."""
    rms_offset: float
    """Root mean square distance of the mesh from the original, once it was laid onto it (mesh units)."""


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class MoveRegionReport(Movement, Result):
    """What move_region() returns."""



@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class FalloffToQualityReport(Result):
    """What falloff_to_quality() returns."""

    vertices_inside: int
    """Vertices of the selection."""
    vertices_between: int
    """Vertices between it and what is out of reach."""


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class SmoothBaseAsLayerReport(PyramidUse, Result):
    """What smooth_base_as_layer() returns."""

    vertices_kept: int
    """Vertices that stay where they are."""
    rms_displacement: float
    """Root of the mean square of the ways of all vertices to the base (mesh units)."""
    largest_displacement: float
    """The longest of these ways (mesh units)."""
    solver_steps: int
    """Steps of conjugate gradients."""


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class MultibandEditReport(Movement, PyramidUse, Result):
    """What multiband_edit() returns."""

    vertices_kept: Array
    """Vertices that each base keeps, finest first."""
    band_detail: Array
    """Root mean square length of the details of each band, finest first (mesh units)."""
    border_points: int
    """Base points on the boundary, where the search left the surface."""
    nearest_points: int
    """Base points that are the nearest, where no normal goes through the vertex."""


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class DetailFromLayerReport(Result):
    """What detail_from_layer() returns."""

    rms_detail: float
    """Root mean square length of the detail, with limits and gain (mesh units)."""
    vertices_without: int | None = None
    """Vertices that meet no other layer: they follow their neighbours."""
    pyramid_reused: bool | None = None
    """The pyramid kept with the mesh was used; otherwise one was built and kept."""
    locked_vertices: int | None = None
    """Vertices at non-manifold edges or points, which are neither moved nor removed."""
    unreferenced_vertices: int | None = None
    """Vertices without a face, which stay where they are."""
    largest_displacement: float | None = None
    """The longest way a vertex moved (mesh units)."""
    rms_displacement: float | None = None
    """Root of the mean square of the ways of all vertices (mesh units)."""
    volume_before: float | None = None
    """Enclosed volume of the input; of no use if the mesh is open (cubic mesh units)."""
    volume_after: float | None = None
    """The same of the result (cubic mesh units)."""
    area_before: float | None = None
    """Surface area of the input (square mesh units)."""
    area_after: float | None = None
    """Surface area of the result (square mesh units)."""
    centroid_shift: float | None = None
    """How far the centroid of the surface moved (mesh units)."""
    flipped_faces: int | None = None
    """Faces whose normal turned by more than 90 degrees."""


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class RelaxAttributesReport(AttributeChanges, Result):
    """What relax_attributes() returns."""

    kept_vertices: int | None = None
    """Vertices whose values were kept: corners, or without neighbours."""
    seam_vertices: int | None = None
    """Vertices on seams of the wedge texture coordinates."""


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class FilterAttributesReport(AttributeChanges, Result):
    """What filter_attributes() returns."""

    gains: Array | None = None
    """The factor of each level's details, finest first."""
    pyramid_reused: bool | None = None
    """The pyramid kept with the mesh was used; otherwise one was built and kept."""
    locked_vertices: int | None = None
    """Vertices at non-manifold edges or points, which are neither moved nor removed."""
    unreferenced_vertices: int | None = None
    """Vertices without a face, which stay where they are."""
    solver_reused: bool | None = None
    """The solver kept with the mesh was used; otherwise one was set up and kept (spline)."""
    measured_waves: Array | None = None
    """Waves that were tested (measure) (mesh units)."""
    measured_transmission: Array | None = None
    """The share that was left of them."""
    formula_transmission: Array | None = None
    """The share that the formula leaves of them."""


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class FilterCustomAttributesReport(AttributeChanges, Result):
    """What filter_custom_attributes() returns."""

    gains: Array | None = None
    """The factor of each level's details, finest first."""
    pyramid_reused: bool | None = None
    """The pyramid kept with the mesh was used; otherwise one was built and kept."""
    locked_vertices: int | None = None
    """Vertices at non-manifold edges or points, which are neither moved nor removed."""
    unreferenced_vertices: int | None = None
    """Vertices without a face, which stay where they are."""
    solver_reused: bool | None = None
    """The solver kept with the mesh was used; otherwise one was set up and kept (spline)."""
    measured_waves: Array | None = None
    """Waves that were tested (measure) (mesh units)."""
    measured_transmission: Array | None = None
    """The share that was left of them."""
    formula_transmission: Array | None = None
    """The share that the formula leaves of them."""


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class DenoiseAttributesReport(AttributeChanges, Result):
    """What denoise_attributes() returns."""

    noise: dict[str, float] = dataclasses.field(default_factory=dict)
    """Deviation of the noise found (units of the attribute). By attribute."""
    noise_least: dict[str, float] = dataclasses.field(default_factory=dict)
    """Automatic: the same where it is least (units of the attribute). By attribute."""
    noise_most: dict[str, float] = dataclasses.field(default_factory=dict)
    """Automatic: the same where it is largest (units of the attribute). By attribute."""
    impulses: dict[str, int] = dataclasses.field(default_factory=dict)
    """Automatic: vertices whose values were found to be impulses and replaced. By attribute."""
    rounding_step: dict[str, float] = dataclasses.field(default_factory=dict)
    """Automatic: step that the values were rounded to, if that is what the noise is; otherwise 0 (units of the
    attribute). By attribute."""
    estimated_rms_before: dict[str, float] = dataclasses.field(default_factory=dict)
    """Automatic: expected RMS error of the values (units of the attribute). By attribute."""
    estimated_rms_after: dict[str, float] = dataclasses.field(default_factory=dict)
    """Automatic: the same of the result (units of the attribute). By attribute."""
    share_low_pass: dict[str, float] = dataclasses.field(default_factory=dict)
    """Automatic: weight of the low passes in the result. By attribute."""
    share_wiener: dict[str, float] = dataclasses.field(default_factory=dict)
    """Automatic: weight of the local Wiener filters. By attribute."""
    share_total_variation: dict[str, float] = dataclasses.field(default_factory=dict)
    """Automatic: weight of total variation. By attribute."""
    noise_per_level: dict[str, Array] = dataclasses.field(default_factory=dict)
    """Thresholds: noise in the details of each level (units of the attribute). By attribute."""
    threshold: dict[str, Array] = dataclasses.field(default_factory=dict)
    """Thresholds: what was used on each level (units of the attribute). By attribute."""
    zeroed: dict[str, Array] = dataclasses.field(default_factory=dict)
    """Thresholds: share of each level's details that became 0. By attribute."""
    pyramid_reused: bool | None = None
    """The pyramid kept with the mesh was used; otherwise one was built and kept."""
    locked_vertices: int | None = None
    """Vertices at non-manifold edges or points, which are neither moved nor removed."""
    unreferenced_vertices: int | None = None
    """Vertices without a face, which stay where they are."""


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class GenerateTexcoordReport(PyramidUse, Result):
    """What generate_texcoord() returns."""

    level: int
    """The level that was projected."""
    coarse_vertices: int
    """Its vertices."""
    axis: Array | None = None
    """Direction of the projection's axis, a unit vector."""
    seam_faces: int
    """Faces across the seam of a cylinder or sphere, whose wedges go on beyond 1."""
    pole_faces: int
    """Faces around a pole of the projection."""


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class AdaptiveReconstructionReport(Result):
    """What adaptive_reconstruction() returns."""

    faces: int
    """Faces of the new layer."""
    vertices: int
    """Its vertices."""
    unreferenced_vertices: int
    """Vertices without a face, which are kept."""
    base_faces: int | None = None
    """Faces of the base mesh: no fewer can be had."""
    base_vertices: int | None = None
    """Its vertices."""
    threshold_used: dict[str, float] = dataclasses.field(default_factory=dict)
    """Threshold of each kind of detail in use, as given or as found for the target (unit of the threshold). By
    attribute."""
    rms_distance: float | None = None
    """Root of the mean square of the two-sided distance to the input (mesh units)."""
    largest_distance: float | None = None
    """Largest two-sided distance to the input (mesh units)."""
    rms_distance_percent: float | None = None
    """The same, relative (percent of the box diagonal)."""
    largest_distance_percent: float | None = None
    """The same, relative (percent of the box diagonal)."""


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class GridReport:
    """What grid() returns."""

    grids: int
    """Grids that the layer consists of."""
    rows: Array
    """Rows of each grid's box on the lattice, largest grid first."""
    columns: Array
    """Columns of each."""
    vertices: Array
    """Vertices of each."""
    holes: Array
    """Holes of each: groups of faces missing inside."""
    loose_vertices: int
    """Vertices of faces that belong to no grid; no filter moves them."""
    off_lattice_faces: int
    """Faces that do not join three neighbours, as at corners of holes."""
    levels: int
    """Levels of the largest grid."""
    wavelength: Array
    """The finest wave of each level (mesh units)."""
    energy: Array
    """Energy of the details: seven types of wavelets of level 0, then those of level 1,  (square mesh units)."""
    reconstruction_error: float
    """The most that a coordinate changes by analysis and synthesis (mesh units)."""


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class GridBandReport(Movement, Result):
    """What grid_band() returns."""

    grids: int
    """Grids that the layer consists of."""
    gains: Array
    """The factor of each level's details, finest first."""


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class GridCompressReport(Movement, Result):
    """What grid_compress() returns."""

    kept_coefficients: int
    """Coefficients that were kept."""
    kept_share: float
    """The same, of the vertices of grids (percent)."""
    rms_error: float
    """Root of the mean square distance of vertices from where they were (mesh units)."""
    largest_error: float
    """The largest distance (mesh units)."""
    error_energy: float
    """Energy of the error, of that of the samples (percent)."""


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class GridLevelReport(Result):
    """What grid_level() returns."""

    vertices: int
    """Vertices of the new layer."""
    faces: int
    """Its faces."""


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class GridEditReport(Movement, AttributeChanges, Result):
    """What grid_edit() returns."""

    level: int
    """The level that the edited layer is a control mesh of."""


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class FilterGridAttributesReport(AttributeChanges, Result):
    """What filter_grid_attributes() returns."""

    grids: int
    """Grids that the layer consists of."""
    gains: Array
    """The factor of each level's details, finest first."""


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class CompressGridAttributesReport(AttributeChanges, Result):
    """What compress_grid_attributes() returns."""

    kept_coefficients: dict[str, int] = dataclasses.field(default_factory=dict)
    """Coefficients that were kept. By attribute."""
    kept_share: dict[str, float] = dataclasses.field(default_factory=dict)
    """The same, of the vertices of grids (percent). By attribute."""
    rms_error: dict[str, float] = dataclasses.field(default_factory=dict)
    """Root of the mean square error before colours are clamped (units of the attribute). By attribute."""
    largest_error: dict[str, float] = dataclasses.field(default_factory=dict)
    """The largest error (units of the attribute). By attribute."""
    error_energy: dict[str, float] = dataclasses.field(default_factory=dict)
    """Energy of the error, of that of the samples (percent). By attribute."""


@also_flat(Pyramid)
def build_pyramid(
    ms: MeshSet, *, pyramid: Pyramid | None = None,
) -> BuildPyramidReport:
    """Builds a pyramid of levels of resolution and keeps it with the mesh, so that the other multiresolution filters
    answer at once while the mesh stays the same.

    The mesh is not changed. Returned for each level: number of vertices, wavelength (twice the mean edge length) and
    root mean square of the details; the largest error of the reconstruction; and what is unusual in the mesh.

    The filter compute_multires_pyramid, on the current mesh; the mesh is unchanged if it fails.

    Args:
        ms: the document.
        pyramid: how the pyramid is built. None: the filter's defaults.

    Raises:
        pymeshlab.PyMeshLabException: the mesh or a value will not do; it says why.

    See:
        Guskov, Sweldens, Schröder, "Multiresolution Signal Processing for Meshes", SIGGRAPH 1999.
        Roy, Foufou, Koschan, Truchetet, Abidi, "Multiresolution Analysis for Irregular Meshes", SPIE Photonics
            Technologies 2003.
    """
    return apply(BuildPyramidReport, "compute_multires_pyramid", **locals())


@also_flat(Pyramid)
def level_as_layer(
    ms: MeshSet, *, level: int = -1, vertices: int = 0, smoothed: bool = False,
    detail_in: Literal["nowhere", "selection", "box", "sphere"] = "nowhere", growth: float = 0.2,
    low: Vector | None = None, high: Vector | None = None, centre: Vector | None = None, radius: float | None = None,
    pyramid: Pyramid | None = None,
) -> LevelAsLayerReport:
    """Makes a new layer with the mesh of one level of the pyramid, or of any number of vertices: a subset of the
    vertices with all their attributes.

    A region (the selection, a box or a sphere) may keep all its detail, with ever larger faces around it. Faces of
    coarse levels may straddle the seams of a texture; those of Adaptive Reconstruction do not. The custom vertex
    attribute source_vertex holds the index of each in the input.

    The filter generate_multires_level, on the current mesh; the mesh is unchanged if it fails.

    Args:
        ms: the document.
        level: 0 is the mesh itself; Build Pyramid lists the vertices of the others. -1: the level that comes nearest to
            a quarter of the vertices. A number beyond the last level is an error that names the last. A whole number,
            at least -1.
        vertices: More than 0: a mesh of exactly so many vertices, whatever the level; with a region, those around it
            are chosen by their distance. A whole number, at least 0.
        smoothed: Place the vertices where the coarse level of the pyramid has them (presmoothed) instead of where they
            are in the mesh. Of whole levels only.
        detail_in: A region that keeps all its vertices; the mesh gets coarser with the distance from it until it is
            that of the level. Nowhere: the level everywhere.
        growth: How fast it gets coarser: edges may be longer by so much of their distance from the region. A number, at
            least 0.
        low: The corner of the box with the smallest coordinates. None: derived from the mesh.
        high: The opposite corner. None: derived from the mesh.
        centre: Of the sphere. None: derived from the mesh.
        radius: Of the sphere, mesh units. A number, at least 0. None: derived from the mesh.
        pyramid: how the pyramid is built. None: the filter's defaults.

    Raises:
        pymeshlab.PyMeshLabException: the mesh or a value will not do; it says why.

    See:
        Roy, Foufou, Koschan, Truchetet, Abidi, "Multiresolution Analysis for Irregular Meshes", SPIE Photonics
            Technologies 2003.
    """
    return apply(LevelAsLayerReport, "generate_multires_level", **locals())


@also_flat(Pyramid)
def detail_to_quality(
    ms: MeshSet, *, unit: Literal["wavelength", "wavelength percent", "level", "vertices"] = "wavelength",
    finest: float | None = None, coarsest: float | None = None, softness: float = 0.0, signed_normal: bool = False,
    pyramid: Pyramid | None = None,
) -> DetailToQualityReport:
    """Stores in the vertex quality how much a band of scales adds to the shape at each vertex: the distance to where
    the vertex would be without the band, or its signed part along the normal, in mesh units.

    The filter compute_scalar_multires_detail_per_vertex, on the current mesh; the mesh is unchanged if it fails.

    Args:
        ms: the document.
        unit: What the limits are given in. Wavelength: length of a wave on the surface in mesh units; the finest a mesh
            can carry is twice its mean edge length. Wavelength percent: the same, 1 is 1 % of the diagonal of the
            bounding box. Level: of the pyramid, 0 is the finest. Vertices: how many vertices the level has. Scripts may
            leave limits out: they are then derived from the mesh, in this unit. In a dialog the numbers shown count.
        finest: Fine limit of the band, in the unit chosen: short waves, low levels, many vertices. A number, at least
            0. None: derived from the mesh.
        coarsest: Coarse limit of the band, in the unit chosen: long waves, high levels, few vertices. A number, at
            least 0. None: derived from the mesh.
        softness: Pyramid only: width of the band's edges in octaves of wavelength; 0 is a sharp edge. A number, 0 to
            10.
        signed_normal: Store the part of the detail along the vertex normal, positive outwards, instead of its length.
        pyramid: how the pyramid is built. None: the filter's defaults.

    Raises:
        pymeshlab.PyMeshLabException: the mesh or a value will not do; it says why.

    See:
        Guskov, Sweldens, Schröder, "Multiresolution Signal Processing for Meshes", SIGGRAPH 1999.
    """
    return apply(DetailToQualityReport, "compute_scalar_multires_detail_per_vertex", **locals())


@also_flat(Pyramid)
def difference_to_layer(
    ms: MeshSet, *, layer: int | None = None, wavelength: float = 0.0, beyond: float | None = None,
    pyramid: Pyramid | None = None,
) -> DifferenceToLayerReport:
    """Stores in the vertex quality how far each vertex is from another layer's surface, as the two are placed in the
    document: positive outside, where that layer's normals point to, negative inside.

    With a wavelength, only what is as coarse as that: deformation without noise.

    The filter compute_scalar_multires_difference_per_vertex, on the current mesh; the mesh is unchanged if it fails.

    Args:
        ms: the document.
        layer: The layer that the distance is measured to: a surface, open or closed. None: the first other layer.
        wavelength: Mesh units: differences that vary more finely over the surface, such as noise, are left out. 0
            leaves in all. A number, at least 0.
        beyond: Mesh units: the share of the surface that is farther away is reported. A number, at least 0. None:
            derived from the mesh.
        pyramid: how the pyramid is built. None: the filter's defaults.

    Raises:
        pymeshlab.PyMeshLabException: the mesh or a value will not do; it says why.

    See:
        Roy, Foufou, Koschan, Truchetet, Abidi, "Multiresolution Analysis for Irregular Meshes", SPIE Photonics
            Technologies 2003.
        Bærentzen, Aanæs, "Signed Distance Computation Using the Angle Weighted Pseudonormal", IEEE TVCG 2005.
    """
    return apply(DifferenceToLayerReport, "compute_scalar_multires_difference_per_vertex", **locals())


def roughness(
    ms: MeshSet, *, form: Literal["none", "plane", "sphere", "cylinder", "low pass"] = "low pass",
    s_filter: float = 0.0, l_filter: float | None = None, order: Order = "gaussian", selected: bool | None = None,
) -> RoughnessReport:
    """Measures the texture of a surface by ISO 25178: Sa, Sq, Sp, Sv, Sz, Ssk, Sku, Sdq and Sdr of the waves between
    two wavelengths, over a fitted form or, on any shape, over its low pass.

    Changes nothing.

    The filter compute_multires_roughness, on the current mesh; the mesh is unchanged if it fails.

    Args:
        ms: the document.
        form: What heights count from (F-operation). Plane, sphere, cylinder: fitted. Low pass: the shape without waves
            shorter than the L-filter, for any shape. None: the xy plane, for height maps that are level.
        s_filter: Nesting index, mesh units: shorter waves do not count. At least two mean edges; 0: all count. A
            number, at least 0.
        l_filter: Nesting index, mesh units: longer waves do not count. More than the S-filter; 0: all count (not with
            low pass). A number, at least 0. None: derived from the mesh.
        order: How steeply a limit separates. With s = (limit / wave)^2, waves keep 1 / (1 + s), 1 / (1 + s^2) (ISO
            16610-22), 1 / (1 + s^4) or exp(-ln 2 s) (ISO 16610-21).
        selected: Measure the faces whose vertices are all selected, or in selected faces. None: derived from the mesh.

    Raises:
        pymeshlab.PyMeshLabException: the mesh or a value will not do; it says why.

    See:
        ISO/TC 213, "ISO 25178-2: Surface texture: Areal, Part 2: Terms, definitions and surface texture parameters",
            2021.
    """
    return apply(RoughnessReport, "compute_multires_roughness", **locals())


def relief(
    ms: MeshSet, *, coarsest: float = 0.0, finest: float = 0.0, robust: bool = True, order: Order = "2",
    color: bool = False,
) -> ReliefReport:
    """Signed height over the low pass as vertex quality, in mesh units: carvings, tool marks, wear.

    The band is chosen from the mesh unless one is given.

    The filter compute_scalar_multires_relief_per_vertex, on the current mesh; the mesh is unchanged if it fails.

    Args:
        ms: the document.
        coarsest: Mesh units: the relief is what is left without waves longer than that, about three times as wide as
            strokes. At least two mean edges; 0: the band is chosen from the mesh. A number, at least 0.
        finest: Mesh units: shorter waves are left out as noise. At least two mean edges; 0: all count, or chosen with
            the coarsest. A number, at least 0.
        robust: The low pass does not give way to what is cut or raised (after ISO 16610-71): depths come out larger,
            and without a wall around strokes. Off: a linear low pass, calibrated.
        order: How steeply a limit separates. With s = (limit / wave)^2, waves keep 1 / (1 + s), 1 / (1 + s^2) (ISO
            16610-22), 1 / (1 + s^4) or exp(-ln 2 s) (ISO 16610-21).
        color: Colour the vertices, too: blue is deep, grey level, red high.

    Raises:
        pymeshlab.PyMeshLabException: the mesh or a value will not do; it says why.

    See:
        ISO/TC 213, "ISO 16610-62: Filtration: Linear areal filters: Spline filters", 2023.
    """
    return apply(ReliefReport, "compute_scalar_multires_relief_per_vertex", **locals())


def details_by_scale(
    ms: MeshSet, *, bands: int = 8, finest: float | None = None, coarsest: float | None = None,
    values: Literal["bands", "heights"] = "bands", prefix: str = "scale",
) -> DetailsByScaleReport:
    """The signed detail of up to 16 bands of wavelengths as custom attributes of the vertices, and as quality the
    wavelength at which a vertex stands out most: feature vectors for classification, and for finding writing.

    The filter compute_custom_multires_scales, on the current mesh; the mesh is unchanged if it fails.

    Args:
        ms: the document.
        bands: How many bands. A whole number, 1 to 16.
        finest: Mesh units: the first band holds the waves shorter than that. At least two mean edges. Not with one
            band. A number, at least 0. None: derived from the mesh.
        coarsest: Mesh units: the last band ends at this wavelength. A number, at least 0. None: derived from the mesh.
        values: Bands: what each band adds. Heights: what all bands up to it add, the height over the low pass, which
            goes with the volume integral invariant of a ball of 0.45 limits radius.
        prefix: The attributes are called so, followed by _1 (finest), _2, ...

    Raises:
        pymeshlab.PyMeshLabException: the mesh or a value will not do; it says why.

    See:
        Mara, Krömker, Jakob, Breuckmann, "GigaMesh and Gilgamesh: 3D Multiscale Integral Invariant Cuneiform Character
            Extraction", VAST 2010.
        Guskov, Sweldens, Schröder, "Multiresolution Signal Processing for Meshes", SIGGRAPH 1999.
    """
    return apply(DetailsByScaleReport, "compute_custom_multires_scales", **locals())


def select_features(
    ms: MeshSet, *, strong: float = 30.0, weak: float = 15.0, shortest: int = 6,
    select: Literal["edges", "vertices"] = "edges",
) -> SelectFeaturesReport:
    """Selects the lines along which a surface is sharp at every scale, with noise, too, and cleans them: branches out,
    gaps closed.

    The filter compute_selection_multires_features, on the current mesh; the mesh is unchanged if it fails.

    Args:
        ms: the document.
        strong: Lines start at edges that bend by as much, at every scale. A number, 1 to 179.
        weak: Lines go on along edges that bend by as much; at most the strong one. A number, 1 to 179.
        shortest: Edges: shorter branches and loose lines are left out, and gaps of up to half of it are closed. A whole
            number, 0 to 1000.
        select: Edges: what features=selected edges of the other filters then keeps sharp. Vertices: those on the lines.

    Raises:
        pymeshlab.PyMeshLabException: the mesh or a value will not do; it says why.

    See:
        Hubeli, Gross, "Multiresolution Feature Extraction for Unstructured Meshes", Visualization 2001.
    """
    return apply(SelectFeaturesReport, "compute_selection_multires_features", **locals())


@also_flat(Pyramid)
def low_pass(
    ms: MeshSet, *, unit: Literal["wavelength", "wavelength percent", "level", "vertices"] = "wavelength",
    cutoff: float | None = None, softness: float = 0.0, method: Literal["pyramid", "spline"] | None = None,
    order: Order = "2", measure: bool = False, selected: bool | None = None, quality_mask: bool = False,
    relative_to: RelativeTo = "current shape", pyramid: Pyramid | None = None,
) -> LowPassReport:
    """Removes everything finer than a wavelength and keeps everything coarser, in one pass, without shrinking the
    shape.

    The filter apply_coord_multires_low_pass, on the current mesh; the mesh is unchanged if it fails.

    Args:
        ms: the document.
        unit: What the limits are given in. Wavelength: length of a wave on the surface in mesh units; the finest a mesh
            can carry is twice its mean edge length. Wavelength percent: the same, 1 is 1 % of the diagonal of the
            bounding box. Level: of the pyramid, 0 is the finest. Vertices: how many vertices the level has. Scripts may
            leave limits out: they are then derived from the mesh, in this unit. In a dialog the numbers shown count.
        cutoff: Everything finer than this is removed: shorter waves, lower levels, levels with more vertices. A number,
            at least 0. None: derived from the mesh.
        softness: Pyramid only: width of the band's edges in octaves of wavelength; 0 is a sharp edge. A number, 0 to
            10.
        method: Spline: calibrated, a limit is the wavelength of which exactly half belongs to either side; a sphere
            stays a sphere. Pyramid: limits are approximate; softness and the pyramid's options apply. By default the
            pyramid, which previews at once, but the spline where edges differ much in length, as CAD programs make
            them. None: derived from the mesh.
        order: Spline only: how steeply a limit separates. With s = (limit / wave)^2, waves keep 1 / (1 + s), 1 / (1 +
            s^2) (ISO 16610-22), 1 / (1 + s^4) or exp(-ln 2 s) (ISO 16610-21).
        measure: Spline only: filter test waves on this very mesh and tell how much is left of waves of 0.7, 1 and 1.4
            cutoffs. Takes a few times as long.
        selected: Change selected vertices and the vertices of selected faces only. The selection stays as it is. None:
            derived from the mesh.
        quality_mask: Scale the effect at each vertex by its quality: 0 is no change, 1 the full one, values outside are
            clamped.
        relative_to: Current shape: the filter changes the mesh as it is now. Original: it starts again from the shape
            the mesh had before any Multiresolution filter moved it, so that changes do not add up, and values that
            change nothing (gains of 1) bring exactly that shape back. Outside the selection the mesh stays as it is.
            The original is kept with the layer until something else changes the mesh; files do not hold it.
        pyramid: how the pyramid is built. None: the filter's defaults.

    Raises:
        pymeshlab.PyMeshLabException: the mesh or a value will not do; it says why.

    See:
        Guskov, Sweldens, Schröder, "Multiresolution Signal Processing for Meshes", SIGGRAPH 1999.
    """
    return apply(LowPassReport, "apply_coord_multires_low_pass", **locals())


@also_flat(Pyramid)
def stop_band(
    ms: MeshSet, *, unit: Literal["wavelength", "wavelength percent", "level", "vertices"] = "wavelength",
    finest: float | None = None, coarsest: float | None = None, softness: float = 0.0,
    method: Literal["pyramid", "spline"] | None = None, order: Order = "2", measure: bool = False,
    selected: bool | None = None, quality_mask: bool = False, relative_to: RelativeTo = "current shape",
    pyramid: Pyramid | None = None,
) -> StopBandReport:
    """Removes the structure between two wavelengths; finer engraving and the coarse shape stay.

    The filter apply_coord_multires_stop_band, on the current mesh; the mesh is unchanged if it fails.

    Args:
        ms: the document.
        unit: What the limits are given in. Wavelength: length of a wave on the surface in mesh units; the finest a mesh
            can carry is twice its mean edge length. Wavelength percent: the same, 1 is 1 % of the diagonal of the
            bounding box. Level: of the pyramid, 0 is the finest. Vertices: how many vertices the level has. Scripts may
            leave limits out: they are then derived from the mesh, in this unit. In a dialog the numbers shown count.
        finest: Fine limit of the band, in the unit chosen: short waves, low levels, many vertices. A number, at least
            0. None: derived from the mesh.
        coarsest: Coarse limit of the band, in the unit chosen: long waves, high levels, few vertices. A number, at
            least 0. None: derived from the mesh.
        softness: Pyramid only: width of the band's edges in octaves of wavelength; 0 is a sharp edge. A number, 0 to
            10.
        method: Spline: calibrated, a limit is the wavelength of which exactly half belongs to either side; a sphere
            stays a sphere. Pyramid: limits are approximate; softness and the pyramid's options apply. By default the
            pyramid, which previews at once, but the spline where edges differ much in length, as CAD programs make
            them. None: derived from the mesh.
        order: Spline only: how steeply a limit separates. With s = (limit / wave)^2, waves keep 1 / (1 + s), 1 / (1 +
            s^2) (ISO 16610-22), 1 / (1 + s^4) or exp(-ln 2 s) (ISO 16610-21).
        measure: Spline only: filter test waves on this very mesh and tell how much is left of waves of 0.7, 1 and 1.4
            cutoffs. Takes a few times as long.
        selected: Change selected vertices and the vertices of selected faces only. The selection stays as it is. None:
            derived from the mesh.
        quality_mask: Scale the effect at each vertex by its quality: 0 is no change, 1 the full one, values outside are
            clamped.
        relative_to: Current shape: the filter changes the mesh as it is now. Original: it starts again from the shape
            the mesh had before any Multiresolution filter moved it, so that changes do not add up, and values that
            change nothing (gains of 1) bring exactly that shape back. Outside the selection the mesh stays as it is.
            The original is kept with the layer until something else changes the mesh; files do not hold it.
        pyramid: how the pyramid is built. None: the filter's defaults.

    Raises:
        pymeshlab.PyMeshLabException: the mesh or a value will not do; it says why.

    See:
        Guskov, Sweldens, Schröder, "Multiresolution Signal Processing for Meshes", SIGGRAPH 1999.
        Roy, Foufou, Koschan, Truchetet, Abidi, "Multiresolution Analysis for Irregular Meshes", SPIE Photonics
            Technologies 2003.
    """
    return apply(StopBandReport, "apply_coord_multires_stop_band", **locals())


@also_flat(Pyramid)
def enhance(
    ms: MeshSet, *, gain: float = 2.0,
    unit: Literal["wavelength", "wavelength percent", "level", "vertices"] = "wavelength", finest: float | None = None,
    coarsest: float | None = None, softness: float = 0.0, method: Literal["pyramid", "spline"] | None = None,
    order: Order = "2", measure: bool = False, selected: bool | None = None, quality_mask: bool = False,
    relative_to: RelativeTo = "current shape", pyramid: Pyramid | None = None,
) -> EnhanceReport:
    """Multiplies the structure between two wavelengths by a gain: brings out what is worn, or weakens what disturbs.

    The filter apply_coord_multires_enhance, on the current mesh; the mesh is unchanged if it fails.

    Args:
        ms: the document.
        gain: Factor for the details of the band: 1 changes nothing, 2 doubles them, 0 removes them. A number, 0 to 10.
        unit: What the limits are given in. Wavelength: length of a wave on the surface in mesh units; the finest a mesh
            can carry is twice its mean edge length. Wavelength percent: the same, 1 is 1 % of the diagonal of the
            bounding box. Level: of the pyramid, 0 is the finest. Vertices: how many vertices the level has. Scripts may
            leave limits out: they are then derived from the mesh, in this unit. In a dialog the numbers shown count.
        finest: Fine limit of the band, in the unit chosen: short waves, low levels, many vertices. A number, at least
            0. None: derived from the mesh.
        coarsest: Coarse limit of the band, in the unit chosen: long waves, high levels, few vertices. A number, at
            least 0. None: derived from the mesh.
        softness: Pyramid only: width of the band's edges in octaves of wavelength; 0 is a sharp edge. A number, 0 to
            10.
        method: Spline: calibrated, a limit is the wavelength of which exactly half belongs to either side; a sphere
            stays a sphere. Pyramid: limits are approximate; softness and the pyramid's options apply. By default the
            pyramid, which previews at once, but the spline where edges differ much in length, as CAD programs make
            them. None: derived from the mesh.
        order: Spline only: how steeply a limit separates. With s = (limit / wave)^2, waves keep 1 / (1 + s), 1 / (1 +
            s^2) (ISO 16610-22), 1 / (1 + s^4) or exp(-ln 2 s) (ISO 16610-21).
        measure: Spline only: filter test waves on this very mesh and tell how much is left of waves of 0.7, 1 and 1.4
            cutoffs. Takes a few times as long.
        selected: Change selected vertices and the vertices of selected faces only. The selection stays as it is. None:
            derived from the mesh.
        quality_mask: Scale the effect at each vertex by its quality: 0 is no change, 1 the full one, values outside are
            clamped.
        relative_to: Current shape: the filter changes the mesh as it is now. Original: it starts again from the shape
            the mesh had before any Multiresolution filter moved it, so that changes do not add up, and values that
            change nothing (gains of 1) bring exactly that shape back. Outside the selection the mesh stays as it is.
            The original is kept with the layer until something else changes the mesh; files do not hold it.
        pyramid: how the pyramid is built. None: the filter's defaults.

    Raises:
        pymeshlab.PyMeshLabException: the mesh or a value will not do; it says why.

    See:
        Guskov, Sweldens, Schröder, "Multiresolution Signal Processing for Meshes", SIGGRAPH 1999.
        Roy, Foufou, Koschan, Truchetet, Abidi, "Multiresolution Analysis for Irregular Meshes", SPIE Photonics
            Technologies 2003.
    """
    return apply(EnhanceReport, "apply_coord_multires_enhance", **locals())


@also_flat(Pyramid)
def equalizer(
    ms: MeshSet, *, gain_1: float = 1.0, gain_2: float = 1.0, gain_3: float = 1.0, gain_4: float = 1.0,
    gain_5: float = 1.0, gain_6: float = 1.0, gain_7: float = 1.0, gain_8: float = 1.0, softness: float = 0.5,
    method: Literal["pyramid", "spline"] | None = None, order: Order = "2", measure: bool = False,
    selected: bool | None = None, quality_mask: bool = False, relative_to: RelativeTo = "current shape",
    pyramid: Pyramid | None = None,
) -> EqualizerReport:
    """Eight gains for eight bands of wavelengths from fine to coarse, given in the mesh's unit.

    With all gains at 1 the mesh comes back unchanged.

    The filter apply_coord_multires_equalizer, on the current mesh; the mesh is unchanged if it fails.

    Args:
        ms: the document.
        gain_1, gain_2, gain_3, gain_4, gain_5, gain_6, gain_7, gain_8: Factor for the structure of these wavelengths
            (mesh units): 1 leaves it, 0 removes it, 2 doubles it. A number, 0 to 4.
        softness: Pyramid only: width of the band's edges in octaves of wavelength; 0 is a sharp edge. A number, 0 to
            10.
        method: Spline: calibrated, a limit is the wavelength of which exactly half belongs to either side; a sphere
            stays a sphere. Pyramid: limits are approximate; softness and the pyramid's options apply. By default the
            pyramid, which previews at once, but the spline where edges differ much in length, as CAD programs make
            them. None: derived from the mesh.
        order: Spline only: how steeply a limit separates. With s = (limit / wave)^2, waves keep 1 / (1 + s), 1 / (1 +
            s^2) (ISO 16610-22), 1 / (1 + s^4) or exp(-ln 2 s) (ISO 16610-21).
        measure: Spline only: filter test waves on this very mesh and tell how much is left of waves of 0.7, 1 and 1.4
            cutoffs. Takes a few times as long.
        selected: Change selected vertices and the vertices of selected faces only. The selection stays as it is. None:
            derived from the mesh.
        quality_mask: Scale the effect at each vertex by its quality: 0 is no change, 1 the full one, values outside are
            clamped.
        relative_to: Current shape: the filter changes the mesh as it is now. Original: it starts again from the shape
            the mesh had before any Multiresolution filter moved it, so that changes do not add up, and values that
            change nothing (gains of 1) bring exactly that shape back. Outside the selection the mesh stays as it is.
            The original is kept with the layer until something else changes the mesh; files do not hold it.
        pyramid: how the pyramid is built. None: the filter's defaults.

    Raises:
        pymeshlab.PyMeshLabException: the mesh or a value will not do; it says why.

    See:
        Guskov, Sweldens, Schröder, "Multiresolution Signal Processing for Meshes", SIGGRAPH 1999.
    """
    return apply(EqualizerReport, "apply_coord_multires_equalizer", **locals())


def unsharp(
    ms: MeshSet, *, xi: float = 2.0, iterations: int = 10, operator: Operator = "second difference with flaps",
    selected: bool | None = None, quality_mask: bool = False, relative_to: RelativeTo = "current shape",
    features: Features = "none", feature_angle: float = 40.0,
) -> UnsharpReport:
    """Strengthens (or weakens) what some steps of relaxation would take away, without a pyramid.

    Best for small meshes; scans with noise are better served by the bands.

    The filter apply_coord_multires_unsharp, on the current mesh; the mesh is unchanged if it fails.

    Args:
        ms: the document.
        xi: 1 changes nothing; 2 doubles what the relaxation takes away; between 0 and 1 smooths, 0 fully. A number, 0
            to 10.
        iterations: More steps reach coarser structure; each costs the same. A whole number, 1 to 10000.
        operator: Relaxation operator: how a vertex is predicted from its neighbours. Second differences keep shape
            best; cotangent weights are faster and shrink; the umbrella ignores geometry and lets vertices drift;
            natural neighbours and thin plates interpolate above the vertex's foot in the plane of its neighbours
            (Szczesna).
        selected: Change selected vertices and the vertices of selected faces only. The selection stays as it is. None:
            derived from the mesh.
        quality_mask: Scale the effect at each vertex by its quality: 0 is no change, 1 the full one, values outside are
            clamped.
        relative_to: Current shape: the filter changes the mesh as it is now. Original: it starts again from the shape
            the mesh had before any Multiresolution filter moved it, so that changes do not add up, and values that
            change nothing (gains of 1) bring exactly that shape back. Outside the selection the mesh stays as it is.
            The original is kept with the layer until something else changes the mesh; files do not hold it.
        features: Edges that are not smoothed across: none; those where the normals of the two faces differ by more than
            the feature angle; those not marked as faux; those selected on their faces.
        feature_angle: Degrees between the normals of two faces above which their edge is sharp. A number, 0.01 to
            179.99.

    Raises:
        pymeshlab.PyMeshLabException: the mesh or a value will not do; it says why.

    See:
        Guskov, Sweldens, Schröder, "Multiresolution Signal Processing for Meshes", SIGGRAPH 1999.
    """
    return apply(UnsharpReport, "apply_coord_multires_unsharp", **locals())


@also_flat(Pyramid)
def denoise(
    ms: MeshSet, *, method: Literal["normal field", "soft threshold", "hard threshold", "automatic"] = "automatic",
    threshold_unit: Literal["automatic", "mesh units", "percent", "share"] = "automatic", threshold: float = 0.0,
    strength: float = 1.0, fast: bool = False, keep_volume: bool = False, confidence: bool = False,
    selected: bool | None = None, quality_mask: bool = False, relative_to: RelativeTo = "current shape",
    finest_level: int = 0, coarsest_level: int = 5, per_level: bool = True, normal_only: bool = False,
    cycle_spins: int = 1, pyramid: Pyramid | None = None,
) -> DenoiseReport:
    """Removes noise and keeps shape, without a parameter to set: the noise is measured, and what is done is chosen by
    the estimated distance from the truth.

    The filter apply_coord_multires_denoise, on the current mesh; the mesh is unchanged if it fails.

    Args:
        ms: the document.
        method: Automatic: measures the noise and blends low passes, local Wiener filters, the normal field and the mesh
            as it is so that the result is expected to be nearest to the truth. Normal field: denoises the face normals
            over several scales and moves the vertices to fit; tunes itself and keeps sharp edges. Soft threshold:
            shrinks the pyramid's details (Roy). Hard threshold: drops small details and leaves large ones.
        threshold_unit: Automatic: from the noise found in the mesh. Mesh units, or percent of the diagonal of the
            bounding box: the value below. Share, for the threshold methods: the value below is the percentage of the
            details that goes, the shortest of all levels chosen.
        threshold: Size of the noise if the threshold is not automatic: its standard deviation for automatic and normal
            field, the length up to which details are dropped for the others. A number, at least 0.
        strength: Factor for the noise: 1 removes the noise found, 2 takes twice as much for noise, 0 changes nothing.
            The threshold methods use it if their threshold is automatic. A number, 0 to 4.
        fast: Automatic: the noise of meshes of more than 25,000 vertices is measured on parts of them. About half the
            time; what is left of the noise is a few percent more.
        keep_volume: Shift the surface along its normals until the volume is that of the input.
        confidence: Vertex quality says how far a vertex is trusted: 1 stays, 0 gets the full threshold.
        selected: Change selected vertices and the vertices of selected faces only. The selection stays as it is. None:
            derived from the mesh.
        quality_mask: Scale the effect at each vertex by its quality: 0 is no change, 1 the full one, values outside are
            clamped.
        relative_to: Current shape: the filter changes the mesh as it is now. Original: it starts again from the shape
            the mesh had before any Multiresolution filter moved it, so that changes do not add up, and values that
            change nothing (gains of 1) bring exactly that shape back. Outside the selection the mesh stays as it is.
            The original is kept with the layer until something else changes the mesh; files do not hold it.
        finest_level: Thresholding: first level whose details are shrunk, 0 is the finest. A whole number, at least 0.
        coarsest_level: Thresholding: details of levels up to, but not with, this one are shrunk. A whole number, at
            least 1.
        per_level: Thresholding: scale the automatic threshold to the noise each level holds.
        normal_only: Thresholding: leave the tangential part of details as it is.
        cycle_spins: Thresholding: average over so many different hierarchies; the time grows with it. A whole number, 1
            to 64.
        pyramid: how the pyramid is built. None: the filter's defaults.

    Raises:
        pymeshlab.PyMeshLabException: the mesh or a value will not do; it says why.

    See:
        Roy, Foufou, Koschan, Truchetet, Abidi, "Multiresolution Analysis for Irregular Meshes", SPIE Photonics
            Technologies 2003.
        Sun, Rosin, Martin, Langbein, "Fast and Effective Feature-Preserving Mesh Denoising", IEEE TVCG 2007.
        Zheng, Fu, Au, Tai, "Bilateral Normal Filtering for Mesh Denoising", IEEE TVCG 2011.
        Ramani, Blu, Unser, "Monte-Carlo SURE", IEEE Transactions on Image Processing 2008.
    """
    return apply(DenoiseReport, "apply_coord_multires_denoise", **locals())


@also_flat(Pyramid)
def transfer_edit(
    ms: MeshSet, *, edited: int | None = None, before: int | None = None,
    details: Literal["multiresolution", "single resolution", "none"] = "multiresolution", gain: float = 1.0,
    encoding: Literal["gradient", "frames", "phong"] = "gradient", bands: int = 5, selected: bool | None = None,
    quality_mask: bool = False, soft_border: float | None = None, pyramid: Pyramid | None = None,
) -> TransferEditReport:
    """Lets the current layer, a scan say, follow the edit of a coarse mesh near it: export a decimated copy or a level,
    change it in any editor, import it, and the scan changes with it and keeps its detail, colours and texture.

    An edit that changes nothing leaves every vertex exactly where it is.

    The filter apply_coord_multires_transfer_edit, on the current mesh; the mesh is unchanged if it fails.

    Args:
        ms: the document.
        edited: The coarse mesh near the current one, after it was edited. None: the first other layer.
        before: The coarse mesh before it was edited, with the same vertices and faces in the same order. The same layer
            as the edited proxy if there is none: that one is then taken for a level of the current layer or, if it is
            none (remeshed, sculpted), a level is wrapped onto it. None: the first other layer.
        details: What becomes of detail finer than the proxy. Multiresolution: it turns and stretches with the surface.
            Single resolution: it keeps its direction in space. None: it is left out.
        gain: Factor of the detail finer than the proxy; 1 is as it is. A number, 0 to 4.
        encoding: Gradient: the proxy's turning and stretching is applied to the gradients of the surface, which is then
            put together by one linear solve; the most exact. Frames: a level of the pyramid moves, and details in
            frames of coarser levels follow. Phong: a smooth base moves, and details along smooth fields of normals
            follow.
        bands: Phong only: 1 measures heights over the proxy itself; 2 to 8 put a smooth base of as many vertices as the
            proxy has and that many bands less one over it. A whole number, 1 to 8.
        selected: Change selected vertices and the vertices of selected faces only. The selection stays as it is. None:
            derived from the mesh.
        quality_mask: Scale the effect at each vertex by its quality: 0 is no change, 1 the full one, values outside are
            clamped.
        soft_border: Only on selection: distance from the border of the selection, mesh units, at which it takes full
            effect; 0 is a sharp border. A number, at least 0. None: derived from the mesh.
        pyramid: how the pyramid is built. None: the filter's defaults.

    Raises:
        pymeshlab.PyMeshLabException: the mesh or a value will not do; it says why.

    See:
        Guskov, Sweldens, Schröder, "Multiresolution Signal Processing for Meshes", SIGGRAPH 1999.
        Vorsatz, Kobbelt, "Robust Multi-Band Detail Encoding for Triangular Meshes of Arbitrary Connectivity", VMV 1999.
    """
    return apply(TransferEditReport, "apply_coord_multires_transfer_edit", **locals())


def watermark(
    ms: MeshSet, *, message: str = "6d756c7469726573", key: str = "", strength: float = 0.08,
    selected: bool | None = None, quality_mask: bool = False, relative_to: RelativeTo = "current shape",
) -> WatermarkReport:
    """Hides a message of 64 bits in the coefficients of a band of middle wavelengths, too small and too smooth to be
    seen.

    Read Watermark finds it again, beside the original, after motion, scaling, reordering, remeshing, simplification,
    noise, smoothing, rounding or cropping.

    The filter apply_coord_multires_watermark, on the current mesh; the mesh is unchanged if it fails.

    Args:
        ms: the document.
        message: 64 bits as 16 hexadecimal digits.
        key: Any text. Who does not know it can neither read the message nor tell that there is one.
        strength: Root mean square displacement, percent of the diagonal of the bounding box. More withstands more, and
            shows. A number, 0.001 to 1.
        selected: Change selected vertices and the vertices of selected faces only. The selection stays as it is. None:
            derived from the mesh.
        quality_mask: Scale the effect at each vertex by its quality: 0 is no change, 1 the full one, values outside are
            clamped.
        relative_to: Current shape: the filter changes the mesh as it is now. Original: it starts again from the shape
            the mesh had before any Multiresolution filter moved it, so that changes do not add up, and values that
            change nothing (gains of 1) bring exactly that shape back. Outside the selection the mesh stays as it is.
            The original is kept with the layer until something else changes the mesh; files do not hold it.

    Raises:
        pymeshlab.PyMeshLabException: the mesh or a value will not do; it says why.

    See:
        Cox, Kilian, Leighton, Shamoon, "Secure Spread Spectrum Watermarking for Multimedia", IEEE TIP 1997.
        Praun, Hoppe, Finkelstein, "Robust Mesh Watermarking", SIGGRAPH 1999.
    """
    return apply(WatermarkReport, "apply_coord_multires_watermark", **locals())


def read_watermark(
    ms: MeshSet, *, original: int | None = None, key: str = "", expected: str = "",
) -> ReadWatermarkReport:
    """Reads the message that Watermark hid, beside the original in another layer; the mesh may have been moved, turned
    and scaled.

    Returns how sure each bit is, and how probable it is that there is no mark at all.

    The filter compute_multires_watermark, on the current mesh; the mesh is unchanged if it fails.

    Args:
        ms: the document.
        original: The layer with the mesh before it was marked. None: the first other layer.
        key: Any text. Who does not know it can neither read the message nor tell that there is one.
        expected: 16 hexadecimal digits to compare with, which is then reported as bit_errors; empty: none.

    Raises:
        pymeshlab.PyMeshLabException: the mesh or a value will not do; it says why.

    See:
        Cox, Kilian, Leighton, Shamoon, "Secure Spread Spectrum Watermarking for Multimedia", IEEE TIP 1997.
        Praun, Hoppe, Finkelstein, "Robust Mesh Watermarking", SIGGRAPH 1999.
    """
    return apply(ReadWatermarkReport, "compute_multires_watermark", **locals())


@also_flat(Pyramid)
def move_region(
    ms: MeshSet, *, falloff: float | None = None, translation: Vector = (0.0, 0.0, 0.0), angle: float = 0.0,
    axis: Vector = (0.0, 0.0, 1.0), pivot: Vector | None = None, scale: float = 1.0, details_follow: bool = True,
    store_falloff: bool = False, pyramid: Pyramid | None = None,
) -> MoveRegionReport:
    """Turns, scales and moves the selected part of a layer; the surface around it follows smoothly up to a distance
    along the surface, and its detail turns with it.

    The filter apply_coord_multires_displace, on the current mesh; the mesh is unchanged if it fails.

    Args:
        ms: the document.
        falloff: How far around the selection the surface follows, along it, mesh units. Beyond it nothing moves. A
            number, at least 0. None: derived from the mesh.
        translation: Where to the selection moves: x, y and z, mesh units.
        angle: Degrees by which the selection turns about the axis, counter-clockwise seen from its tip. A number, -180
            to 180.
        axis: Direction of the axis that the selection turns about.
        pivot: The point that the axis passes through and that scale starts from. By default the middle of the selected
            vertices. None: derived from the mesh.
        scale: Factor of the selection's size; 1 leaves it. A number, 0.01 to 100.
        details_follow: Detail finer than the falloff turns with the surface around it. Otherwise every vertex moves on
            its own.
        store_falloff: Store the share of the motion that each vertex gets in the vertex quality.
        pyramid: how the pyramid is built. None: the filter's defaults.

    Raises:
        pymeshlab.PyMeshLabException: the mesh or a value will not do; it says why.

    See:
        Guskov, Sweldens, Schröder, "Multiresolution Signal Processing for Meshes", SIGGRAPH 1999.
    """
    return apply(MoveRegionReport, "apply_coord_multires_displace", **locals())


def falloff_to_quality(
    ms: MeshSet, *, falloff: float | None = None,
) -> FalloffToQualityReport:
    """Stores in the vertex quality a smooth function on the surface that is 1 on the selection and 0 beyond a distance
    from it: the share of the motion that Move Region gives each vertex, and a mask for the other filters.

    The filter compute_scalar_multires_falloff_per_vertex, on the current mesh; the mesh is unchanged if it fails.

    Args:
        ms: the document.
        falloff: How far around the selection the surface follows, along it, mesh units. Beyond it nothing moves. A
            number, at least 0. None: derived from the mesh.

    Raises:
        pymeshlab.PyMeshLabException: the mesh or a value will not do; it says why.

    See:
        Guskov, Sweldens, Schröder, "Multiresolution Signal Processing for Meshes", SIGGRAPH 1999.
    """
    return apply(FalloffToQualityReport, "compute_scalar_multires_falloff_per_vertex", **locals())


@also_flat(Pyramid)
def smooth_base_as_layer(
    ms: MeshSet, *, vertices: int | None = None, pyramid: Pyramid | None = None,
) -> SmoothBaseAsLayerReport:
    """Makes a new layer with the same vertices and faces, the smooth surface through some of them: those that the
    pyramid keeps longest stay, the others go where the bending energy is least.

    To be edited and followed, or to take detail from.

    The filter generate_multires_base, on the current mesh; the mesh is unchanged if it fails.

    Args:
        ms: the document.
        vertices: How many vertices stay where they are. Fewer give a smoother base; waves longer than a few of their
            distances are left. A whole number, at least 1. None: derived from the mesh.
        pyramid: how the pyramid is built. None: the filter's defaults.

    Raises:
        pymeshlab.PyMeshLabException: the mesh or a value will not do; it says why.

    See:
        Vorsatz, Kobbelt, "Robust Multi-Band Detail Encoding for Triangular Meshes of Arbitrary Connectivity", VMV 1999.
    """
    return apply(SmoothBaseAsLayerReport, "generate_multires_base", **locals())


@also_flat(Pyramid)
def multiband_edit(
    ms: MeshSet, *, gain_1: float = 1.0, gain_2: float = 2.0, gain_3: float = 1.0, gain_4: float = 1.0,
    gain_5: float = 1.0, gain_6: float = 1.0, gain_7: float = 1.0, bands: int = 5,
    levels: Literal["ratio", "edge length", "equal detail"] = "ratio", vertices: int | None = None,
    selected: bool | None = None, quality_mask: bool = False, relative_to: RelativeTo = "current shape",
    pyramid: Pyramid | None = None,
) -> MultibandEditReport:
    """Splits the surface into a smooth base and bands of detail over one another, and puts it together with a gain for
    each band.

    Details are heights over the next coarser shape, along a field of normals without a jump, so they follow what
    coarser bands do.

    The filter apply_coord_multires_bands, on the current mesh; the mesh is unchanged if it fails.

    Args:
        ms: the document.
        gain_1: Factor of the detail of band 1, the finest. There are as many bands of detail as bands less one. A
            number, 0 to 4.
        gain_2: Factor of the detail of band 2. There are as many bands of detail as bands less one. A number, 0 to 4.
        gain_3: Factor of the detail of band 3. There are as many bands of detail as bands less one. A number, 0 to 4.
        gain_4: Factor of the detail of band 4. There are as many bands of detail as bands less one. A number, 0 to 4.
        gain_5: Factor of the detail of band 5. There are as many bands of detail as bands less one. A number, 0 to 4.
        gain_6: Factor of the detail of band 6. There are as many bands of detail as bands less one. A number, 0 to 4.
        gain_7: Factor of the detail of band 7. There are as many bands of detail as bands less one. A number, 0 to 4.
        bands: How many bands there are, the smooth base among them. A whole number, 2 to 8.
        levels: How the bases follow each other. Ratio: by a constant ratio of the vertices they keep. Edge length: by
            one of the mean edge lengths of these. Equal detail: so that all bands have about the same detail.
        vertices: How many vertices the coarsest base keeps. Fewer leave more to the bands. A whole number, at least 1.
            None: derived from the mesh.
        selected: Change selected vertices and the vertices of selected faces only. The selection stays as it is. None:
            derived from the mesh.
        quality_mask: Scale the effect at each vertex by its quality: 0 is no change, 1 the full one, values outside are
            clamped.
        relative_to: Current shape: the filter changes the mesh as it is now. Original: it starts again from the shape
            the mesh had before any Multiresolution filter moved it, so that changes do not add up, and values that
            change nothing (gains of 1) bring exactly that shape back. Outside the selection the mesh stays as it is.
            The original is kept with the layer until something else changes the mesh; files do not hold it.
        pyramid: how the pyramid is built. None: the filter's defaults.

    Raises:
        pymeshlab.PyMeshLabException: the mesh or a value will not do; it says why.

    See:
        Vorsatz, Kobbelt, "Robust Multi-Band Detail Encoding for Triangular Meshes of Arbitrary Connectivity", VMV 1999.
    """
    return apply(MultibandEditReport, "apply_coord_multires_bands", **locals())


@also_flat(Pyramid)
def detail_from_layer(
    ms: MeshSet, *, layer: int | None = None, use: Literal["apply", "store", "apply stored"] = "apply",
    attribute: str = "detail", gain: float = 1.0, largest_distance: float | None = None, finest: float = 0.0,
    coarsest: float = 0.0, selected: bool | None = None, quality_mask: bool = False, pyramid: Pyramid | None = None,
) -> DetailFromLayerReport:
    """Brings the detail of another layer, a scan say, onto the current one: its remesh, a smooth or another shape
    nearby.

    Or stores it as a custom attribute that can be applied later, to the same layer in another shape, as often and as
    strongly as wanted.

    The filter transfer_coord_multires_detail, on the current mesh; the mesh is unchanged if it fails.

    Args:
        ms: the document.
        layer: The layer that has the detail: a scan near the current layer, or a copy of the current one that was
            sculpted. None: the first other layer.
        use: Apply: the current layer takes the detail over. Store: the detail becomes a custom attribute of the current
            layer, points in the frames of its vertices, and nothing moves. Apply stored: the current layer takes over
            what that attribute holds.
        attribute: Name of the custom attribute that stores the detail.
        gain: Factor of the detail; 1 brings vertices onto the other layer. A number, 0 to 4.
        largest_distance: How far along its normal, on either side, a vertex looks for the other layer, mesh units. A
            number, at least 0. None: derived from the mesh.
        finest: Leave out detail of waves shorter than that, mesh units; 0 leaves none out. A number, at least 0.
        coarsest: Leave out detail of waves longer than that, mesh units; 0 leaves none out. A number, at least 0.
        selected: Change selected vertices and the vertices of selected faces only. The selection stays as it is. None:
            derived from the mesh.
        quality_mask: Scale the effect at each vertex by its quality: 0 is no change, 1 the full one, values outside are
            clamped.
        pyramid: how the pyramid is built. None: the filter's defaults.

    Raises:
        pymeshlab.PyMeshLabException: the mesh or a value will not do; it says why.

    See:
        Vorsatz, Kobbelt, "Robust Multi-Band Detail Encoding for Triangular Meshes of Arbitrary Connectivity", VMV 1999.
    """
    return apply(DetailFromLayerReport, "transfer_coord_multires_detail", **locals())


def relax_attributes(
    ms: MeshSet, *, color: bool | None = None, quality: bool | None = None, texcoord: bool | None = None,
    wedge_texcoord: bool | None = None, custom: bool | None = None, custom_names: str = "", iterations: int = 1,
    strength: float = 1.0, operator: Operator = "cotangent Delaunay", corner_angle: float = 45.0,
    keep_outline: bool = True, linear_light: bool = False, selected: bool | None = None, quality_mask: bool = False,
    features: Features = "none", feature_angle: float = 40.0,
) -> RelaxAttributesReport:
    """Smooths attributes along the surface: colours with alpha, quality, texture coordinates, custom scalars and
    points.

    Every value becomes a mean of those around it with weights from the geometry, which itself stays as it is. Colours
    are rounded once, at the end.

    The filter apply_attributes_multires_relaxation, on the current mesh; the mesh is unchanged if it fails.

    Args:
        ms: the document.
        color: With alpha. None: derived from the mesh.
        quality: The scalar value of the vertices. None: derived from the mesh.
        texcoord: Of the vertices. None: derived from the mesh.
        wedge_texcoord: Of the faces' corners, chart by chart: corners with the same vertex and the same texture
            coordinate stay together. None: derived from the mesh.
        custom: Custom scalars and points of the vertices. None: derived from the mesh.
        custom_names: Which custom attributes: their names, separated by commas. Empty: all, but for source_vertex.
        iterations: Steps of relaxation; each reaches a ring further. A whole number, 1 to 10000.
        strength: Share of each step that is taken: 1 replaces a value by the mean around it. A number, 1e-06 to 1.
        operator: Weights of the neighbours, from the geometry. Delaunay cotangents: means in the strict sense, that
            keep linear functions on planes. Cotangents: those of the paper, which may be negative on bad triangles. The
            umbrella ignores geometry.
        corner_angle: Degrees: where the boundary turns by more than this, values are kept. A number, 0 to 180.
        keep_outline: Keep texture coordinates on seams and boundaries as they are, so that charts keep their outline in
            the picture. Off: they are relaxed along the outline, both sides of a seam alike.
        linear_light: Decode colours (sRGB) to amounts of light before computing with them, and encode the result. Right
            for photographs; off, colours are computed with as they are stored, right for colour scales.
        selected: Change selected vertices and the vertices of selected faces only. The selection stays as it is. None:
            derived from the mesh.
        quality_mask: Scale the effect at each vertex by its quality: 0 is no change, 1 the full one, values outside are
            clamped.
        features: Edges that are not smoothed across: none; those where the normals of the two faces differ by more than
            the feature angle; those not marked as faux; those selected on their faces.
        feature_angle: Degrees between the normals of two faces above which their edge is sharp. A number, 0.01 to
            179.99.

    Raises:
        pymeshlab.PyMeshLabException: the mesh or a value will not do; it says why.

    See:
        Roy, Foufou, Koschan, Truchetet, Abidi, "Multiresolution Analysis for Irregular Meshes", SPIE Photonics
            Technologies 2003.
    """
    return apply(RelaxAttributesReport, "apply_attributes_multires_relaxation", **locals())


@also_flat(Pyramid)
def filter_attributes(
    ms: MeshSet, *, color: bool | None = None, quality: bool | None = None, linear_light: bool = False,
    mode: Mode = "low pass", gain: float = 2.0, cutoff: float | None = None,
    unit: Literal["wavelength", "wavelength percent", "level", "vertices"] = "wavelength", finest: float | None = None,
    coarsest: float | None = None, softness: float = 0.0, method: Literal["pyramid", "spline"] | None = None,
    order: Order = "2", measure: bool = False, selected: bool | None = None, quality_mask: bool = False,
    pyramid: Pyramid | None = None,
) -> FilterAttributesReport:
    """Low pass, stop band or enhancement of vertex colour or quality by scale, through the pyramid of the surface.

    The geometry stays as it is.

    The filter apply_attributes_multires_band, on the current mesh; the mesh is unchanged if it fails.

    Args:
        ms: the document.
        color: With alpha. None: derived from the mesh.
        quality: The scalar value of the vertices. None: derived from the mesh.
        linear_light: Decode colours (sRGB) to amounts of light before computing with them, and encode the result. Right
            for photographs; off, colours are computed with as they are stored, right for colour scales.
        mode: Low pass: remove everything finer than the cutoff. Stop band: remove what is between finest and coarsest.
            Enhance: multiply it by the gain.
        gain: For enhance: 1 changes nothing, 2 doubles the details of the band, 0 removes them. A number, 0 to 10.
        cutoff: For low pass: everything finer than this is removed: shorter waves, lower levels, levels with more
            vertices. A number, at least 0. None: derived from the mesh.
        unit: What the limits are given in. Wavelength: length of a wave on the surface in mesh units; the finest a mesh
            can carry is twice its mean edge length. Wavelength percent: the same, 1 is 1 % of the diagonal of the
            bounding box. Level: of the pyramid, 0 is the finest. Vertices: how many vertices the level has. Scripts may
            leave limits out: they are then derived from the mesh, in this unit. In a dialog the numbers shown count.
        finest: Fine limit of the band, in the unit chosen: short waves, low levels, many vertices. A number, at least
            0. None: derived from the mesh.
        coarsest: Coarse limit of the band, in the unit chosen: long waves, high levels, few vertices. A number, at
            least 0. None: derived from the mesh.
        softness: Pyramid only: width of the band's edges in octaves of wavelength; 0 is a sharp edge. A number, 0 to
            10.
        method: Spline: calibrated, a limit is the wavelength of which exactly half belongs to either side; a sphere
            stays a sphere. Pyramid: limits are approximate; softness and the pyramid's options apply. By default the
            pyramid, which previews at once, but the spline where edges differ much in length, as CAD programs make
            them. None: derived from the mesh.
        order: Spline only: how steeply a limit separates. With s = (limit / wave)^2, waves keep 1 / (1 + s), 1 / (1 +
            s^2) (ISO 16610-22), 1 / (1 + s^4) or exp(-ln 2 s) (ISO 16610-21).
        measure: Spline only: filter test waves on this very mesh and tell how much is left of waves of 0.7, 1 and 1.4
            cutoffs. Takes a few times as long.
        selected: Change selected vertices and the vertices of selected faces only. The selection stays as it is. None:
            derived from the mesh.
        quality_mask: Scale the effect at each vertex by its quality: 0 is no change, 1 the full one, values outside are
            clamped.
        pyramid: how the pyramid is built. None: the filter's defaults.

    Raises:
        pymeshlab.PyMeshLabException: the mesh or a value will not do; it says why.

    See:
        Roy, Foufou, Koschan, Truchetet, Abidi, "Multiresolution Analysis for Irregular Meshes", SPIE Photonics
            Technologies 2003.
        Guskov, Sweldens, Schröder, "Multiresolution Signal Processing for Meshes", SIGGRAPH 1999.
    """
    return apply(FilterAttributesReport, "apply_attributes_multires_band", **locals())


@also_flat(Pyramid)
def filter_custom_attributes(
    ms: MeshSet, *, custom_names: str = "", mode: Mode = "low pass", gain: float = 2.0, cutoff: float | None = None,
    unit: Literal["wavelength", "wavelength percent", "level", "vertices"] = "wavelength", finest: float | None = None,
    coarsest: float | None = None, softness: float = 0.0, method: Literal["pyramid", "spline"] | None = None,
    order: Order = "2", measure: bool = False, selected: bool | None = None, quality_mask: bool = False,
    pyramid: Pyramid | None = None,
) -> FilterCustomAttributesReport:
    """Low pass, stop band or enhancement of custom scalars and points of the vertices by scale, through the pyramid of
    the surface.

    The geometry stays as it is.

    The filter apply_attributes_multires_band_custom, on the current mesh; the mesh is unchanged if it fails.

    Args:
        ms: the document.
        custom_names: Which custom attributes: their names, separated by commas. Empty: all, but for source_vertex.
        mode: Low pass: remove everything finer than the cutoff. Stop band: remove what is between finest and coarsest.
            Enhance: multiply it by the gain.
        gain: For enhance: 1 changes nothing, 2 doubles the details of the band, 0 removes them. A number, 0 to 10.
        cutoff: For low pass: everything finer than this is removed: shorter waves, lower levels, levels with more
            vertices. A number, at least 0. None: derived from the mesh.
        unit: What the limits are given in. Wavelength: length of a wave on the surface in mesh units; the finest a mesh
            can carry is twice its mean edge length. Wavelength percent: the same, 1 is 1 % of the diagonal of the
            bounding box. Level: of the pyramid, 0 is the finest. Vertices: how many vertices the level has. Scripts may
            leave limits out: they are then derived from the mesh, in this unit. In a dialog the numbers shown count.
        finest: Fine limit of the band, in the unit chosen: short waves, low levels, many vertices. A number, at least
            0. None: derived from the mesh.
        coarsest: Coarse limit of the band, in the unit chosen: long waves, high levels, few vertices. A number, at
            least 0. None: derived from the mesh.
        softness: Pyramid only: width of the band's edges in octaves of wavelength; 0 is a sharp edge. A number, 0 to
            10.
        method: Spline: calibrated, a limit is the wavelength of which exactly half belongs to either side; a sphere
            stays a sphere. Pyramid: limits are approximate; softness and the pyramid's options apply. By default the
            pyramid, which previews at once, but the spline where edges differ much in length, as CAD programs make
            them. None: derived from the mesh.
        order: Spline only: how steeply a limit separates. With s = (limit / wave)^2, waves keep 1 / (1 + s), 1 / (1 +
            s^2) (ISO 16610-22), 1 / (1 + s^4) or exp(-ln 2 s) (ISO 16610-21).
        measure: Spline only: filter test waves on this very mesh and tell how much is left of waves of 0.7, 1 and 1.4
            cutoffs. Takes a few times as long.
        selected: Change selected vertices and the vertices of selected faces only. The selection stays as it is. None:
            derived from the mesh.
        quality_mask: Scale the effect at each vertex by its quality: 0 is no change, 1 the full one, values outside are
            clamped.
        pyramid: how the pyramid is built. None: the filter's defaults.

    Raises:
        pymeshlab.PyMeshLabException: the mesh or a value will not do; it says why.

    See:
        Roy, Foufou, Koschan, Truchetet, Abidi, "Multiresolution Analysis for Irregular Meshes", SPIE Photonics
            Technologies 2003.
        Guskov, Sweldens, Schröder, "Multiresolution Signal Processing for Meshes", SIGGRAPH 1999.
    """
    return apply(FilterCustomAttributesReport, "apply_attributes_multires_band_custom", **locals())


@also_flat(Pyramid)
def denoise_attributes(
    ms: MeshSet, *, color: bool | None = None, quality: bool | None = None, custom: bool = False,
    custom_names: str = "", linear_light: bool = False, rule: Literal["soft", "hard", "automatic"] = "automatic",
    automatic: bool = True, strength: float = 1.0, threshold: float = 0.0, finest_level: int = 0,
    coarsest_level: int = 1000000000, selected: bool | None = None, quality_mask: bool = False,
    pyramid: Pyramid | None = None,
) -> DenoiseAttributesReport:
    """Removes noise from vertex colour, quality or custom attributes, without a parameter to set: the noise and
    impulses are measured, and what is done is chosen by the estimated error; the geometry stays as it is.

    The report says what was found and done.

    The filter apply_attributes_multires_denoise, on the current mesh; the mesh is unchanged if it fails.

    Args:
        ms: the document.
        color: With alpha. None: derived from the mesh.
        quality: The scalar value of the vertices. None: derived from the mesh.
        custom: Custom scalars and points of the vertices.
        custom_names: Which custom attributes: their names, separated by commas. Empty: all, but for source_vertex.
        linear_light: Decode colours (sRGB) to amounts of light before computing with them, and encode the result. Right
            for photographs; off, colours are computed with as they are stored, right for colour scales.
        rule: Automatic: impulses are replaced, the noise is measured, at each vertex where it varies, and what comes
            nearest to the truth by its estimated risk is done: low passes, local Wiener filters, total variation, or
            nothing. Soft: details of the pyramid up to the threshold go, all others become shorter by it. Hard: details
            up to the threshold go, the others stay.
        automatic: The noise is measured. Off: the threshold below is used, by the soft rule if the rule is automatic.
        strength: Factor for the noise that is measured, or the automatic threshold: 1 removes the noise found, 0
            changes nothing. A number, 0 to 100.
        threshold: If it is not automatic: the length up to which details are dropped, in units of the attribute, for
            colours of 255. A number, at least 0.
        finest_level: Thresholds only: first level that is denoised, 0 is the finest. A whole number, at least 0.
        coarsest_level: Thresholds only: levels up to, but not with, this one are denoised. A whole number, at least 1.
        selected: Change selected vertices and the vertices of selected faces only. The selection stays as it is. None:
            derived from the mesh.
        quality_mask: Scale the effect at each vertex by its quality: 0 is no change, 1 the full one, values outside are
            clamped.
        pyramid: how the pyramid is built. None: the filter's defaults.

    Raises:
        pymeshlab.PyMeshLabException: the mesh or a value will not do; it says why.

    See:
        Rudin, Osher, Fatemi, "Nonlinear total variation based noise removal algorithms", Physica D 1992.
        Ramani, Blu, Unser, "Monte-Carlo SURE", IEEE Transactions on Image Processing 2008.
        Roy, Foufou, Koschan, Truchetet, Abidi, "Multiresolution Analysis for Irregular Meshes", SPIE Photonics
            Technologies 2003.
    """
    return apply(DenoiseAttributesReport, "apply_attributes_multires_denoise", **locals())


@also_flat(Pyramid)
def generate_texcoord(
    ms: MeshSet, *, projection: Literal["cylindrical", "spherical", "planar", "existing"] = "cylindrical",
    axis: Literal["principal", "x", "y", "z"] = "principal", coarse_vertices: int = 1000,
    pyramid: Pyramid | None = None,
) -> GenerateTexcoordReport:
    """Projects a coarse level of the pyramid to a cylinder, a sphere or a plane and subdivides its texture coordinates
    to the finest level: they vary smoothly however rough the surface is.

    Makes vertex and wedge texture coordinates; wedges go on beyond 1 where a face crosses the seam.

    The filter generate_multires_texcoord, on the current mesh; the mesh is unchanged if it fails.

    Args:
        ms: the document.
        projection: Where the coarse level gets its coordinates from: a cylinder or sphere about the axis, the plane
            across it, or the texture coordinates its vertices have.
        axis: Axis of the projection, through the centroid. Principal: along the longest extent of the shape, for a
            planar projection along the shortest.
        coarse_vertices: The first level with so many vertices or fewer is the one that is projected; all finer ones
            follow smoothly. More follow the shape more closely, fewer vary more smoothly. A whole number, at least 1.
        pyramid: how the pyramid is built. None: the filter's defaults.

    Raises:
        pymeshlab.PyMeshLabException: the mesh or a value will not do; it says why.

    See:
        Guskov, Sweldens, Schröder, "Multiresolution Signal Processing for Meshes", SIGGRAPH 1999.
    """
    return apply(GenerateTexcoordReport, "generate_multires_texcoord", **locals())


def adaptive_reconstruction(
    ms: MeshSet, *, target: Literal["threshold", "faces", "vertices", "RMS distance", "largest distance"] = "threshold",
    unit: Literal["mesh units", "percent"] = "percent", faces: int | None = None, vertices: int | None = None,
    error: float = 0.1, use_geometry: bool = True, geometry_threshold: float = 0.05, use_color: bool = False,
    color_threshold: float = 16.0, use_quality: bool = False, quality_threshold: float = 1.0,
    use_texcoord: bool | None = None, texcoord_threshold: float = 0.01, use_normal: bool = False,
    normal_threshold: float = 10.0, criterion: Literal["area error", "local error", "detail"] = "area error",
    region_of_interest: bool = False, fit: bool = False, measure: bool = True, band_gain: float = 1.0,
    finest: float | None = None, coarsest: float | None = None, operator: Operator = "cotangent Delaunay",
    base_vertices: int = 100, normal_limit: float = 60.0, features: Features = "none", feature_angle: float = 40.0,
) -> AdaptiveReconstructionReport:
    """Makes a new layer that holds only the vertices whose detail exceeds a threshold, and all they depend on: many
    where the surface, its colour, quality or texture changes, few elsewhere.

    The threshold can also be found for a number of faces or vertices or an error bound. The custom vertex attribute
    source_vertex holds the index of each vertex in the input.

    The filter generate_multires_adaptive_reconstruction, on the current mesh; the mesh is unchanged if it fails.

    Args:
        ms: the document.
        target: What decides how many vertices are kept: the thresholds as given; a number of faces or vertices; or a
            bound on the measured two-sided distance to the input, with as few vertices as are found.
        unit: Of the threshold of shape and of the error bound: mesh units, or percent of the diagonal of the bounding
            box (1 is 1 %).
        faces: Target faces: at most so many faces; the base may have more. A whole number, at least 0. None: derived
            from the mesh.
        vertices: Target vertices: so many, not counting those in no face. A whole number, at least 0. None: derived
            from the mesh.
        error: Targets RMS distance and largest distance: the bound, in the unit of lengths. A number, at least 0.
        use_geometry: Keep vertices for the sake of their shape.
        geometry_threshold: Vertices whose detail is at least this long are kept: in the unit of lengths. 0 keeps all.
            With a target other than the threshold it only says how the kinds of detail compare. A number, at least 0.
        use_color: Keep vertices for the sake of their colour.
        color_threshold: Vertices whose detail is at least this long are kept: length of the difference in red, green,
            blue and alpha, 0 to 255. 0 keeps all. With a target other than the threshold it only says how the kinds of
            detail compare. A number, at least 0.
        use_quality: Keep vertices for the sake of their quality.
        quality_threshold: Vertices whose detail is at least this long are kept: in the measure of the vertex quality. 0
            keeps all. With a target other than the threshold it only says how the kinds of detail compare. A number, at
            least 0.
        use_texcoord: Keep vertices for the sake of their texture coordinates. Seams of the texture stay seams: no face
            straddles them. On by default if there can be any, unless they meet at more than a twentieth of the
            vertices, which could not go then. None: derived from the mesh.
        texcoord_threshold: Vertices whose detail is at least this long are kept: length of the difference in u and v,
            of wedges if there are any, of vertices otherwise. 0 keeps all. With a target other than the threshold it
            only says how the kinds of detail compare. A number, at least 0.
        use_normal: Keep vertices for the sake of their normals.
        normal_threshold: Vertices whose detail is at least this long are kept: degrees. 0 keeps all. With a target
            other than the threshold it only says how the kinds of detail compare. A number, at least 0.
        criterion: Area error: what removing the vertex adds to the RMS distance of the surfaces; the fewest faces for
            an RMS distance. Local error: the distance it adds at the vertex, whatever the area; keeps small features.
            Detail: distance to where relaxation predicts the vertex (Roy).
        region_of_interest: Keep selected vertices and faces as they are, and level of detail by the thresholds
            elsewhere.
        fit: Move the vertices kept to where they fit the input best. The boundary and the selection kept in full stay
            where they are. If the target is a number or the RMS distance and the shape alone decides, vertices move
            while others are removed: less RMS distance in less time.
        measure: Report the two-sided distance to the input.
        band_gain: Applied to the input first: 0 removes the details between the two wavelengths below, 1 changes
            nothing. A number, -1000 to 1000.
        finest: Fine limit of the band: wavelength in mesh units. A number, at least 0. None: derived from the mesh.
        coarsest: Coarse limit of the band: wavelength in mesh units. A number, at least 0. None: derived from the mesh.
        operator: Relaxation operator: how a vertex is predicted from its neighbours. Second differences keep shape
            best; cotangent weights are faster and shrink; the umbrella ignores geometry and lets vertices drift;
            natural neighbours and thin plates interpolate above the vertex's foot in the plane of its neighbours
            (Szczesna).
        base_vertices: Vertices of the base mesh. A whole number, at least 4.
        normal_limit: Degrees by which removing a vertex may turn a face at most. A number, 1 to 180.
        features: Edges that are not smoothed across: none; those where the normals of the two faces differ by more than
            the feature angle; those not marked as faux; those selected on their faces.
        feature_angle: Degrees between the normals of two faces above which their edge is sharp. A number, 0.01 to
            179.99.

    Raises:
        pymeshlab.PyMeshLabException: the mesh or a value will not do; it says why.

    See:
        Roy, Foufou, Koschan, Truchetet, Abidi, "Multiresolution Analysis for Irregular Meshes", SPIE Photonics
            Technologies 2003.
    """
    return apply(AdaptiveReconstructionReport, "generate_multires_adaptive_reconstruction", **locals())


def grid(
    ms: MeshSet, *, channels: Channels = "positions", basis: Basis = "quartic", levels: int = 0,
) -> GridReport:
    """Finds out whether the layer is a triangular grid (all inner vertices with six neighbours: a terrain, a range
    map), how large it is, and how much energy the seven types of box-spline wavelets have at each level.

    The filter compute_multires_grid, on the current mesh; the mesh is unchanged if it fails.

    Args:
        ms: the document.
        channels: Positions: all three coordinates. Heights: only along the direction in which the surface leaves its
            plane most, z of a terrain.
        basis: Scaling functions and wavelets. Linear: continuous, of two triangles' reach. Quartic: curvature is
            continuous, too.
        levels: How many, at most; fewer on small grids. 0: down to about 4 by 4 points. A whole number, 0 to 16.

    Raises:
        pymeshlab.PyMeshLabException: the mesh or a value will not do; it says why.

    See:
        Dreger, Gross, Schlegel, "Construction of Multiresolution Triangular B-Spline Surfaces using Hexagonal Filters",
            ETH Zürich 1999.
    """
    return apply(GridReport, "compute_multires_grid", **locals())


def grid_band(
    ms: MeshSet, *, gain: float = 0.0,
    unit: Literal["wavelength", "wavelength percent", "level", "vertices"] = "wavelength", finest: float | None = None,
    coarsest: float | None = None, softness: float = 0.0, gains: str = "", channels: Channels = "positions",
    basis: Basis = "quartic", levels: int = 0, selected: bool | None = None, quality_mask: bool = False,
    relative_to: RelativeTo = "current shape",
) -> GridBandReport:
    """Weakens, removes or strengthens detail of some sizes on a triangular grid, by box-spline wavelets that prefer
    none of its directions.

    The filter apply_coord_multires_grid_band, on the current mesh; the mesh is unchanged if it fails.

    Args:
        ms: the document.
        gain: Factor for the details of the band: 1 changes nothing, 2 doubles them, 0 removes them. A number, 0 to 10.
        unit: What the limits are given in. Wavelength: length of a wave on the surface in mesh units; the finest a mesh
            can carry is twice its mean edge length. Wavelength percent: the same, 1 is 1 % of the diagonal of the
            bounding box. Level: of the pyramid, 0 is the finest. Vertices: how many vertices the level has. Scripts may
            leave limits out: they are then derived from the mesh, in this unit. In a dialog the numbers shown count.
        finest: Fine limit of the band, in the unit chosen: short waves, low levels, many vertices. A number, at least
            0. None: derived from the mesh.
        coarsest: Coarse limit of the band, in the unit chosen: long waves, high levels, few vertices. A number, at
            least 0. None: derived from the mesh.
        softness: Pyramid only: width of the band's edges in octaves of wavelength; 0 is a sharp edge. A number, 0 to
            10.
        gains: If not empty, in place of gain and limits: a factor for each level, finest first, separated by commas.
            Levels left out keep 1.
        channels: Positions: all three coordinates. Heights: only along the direction in which the surface leaves its
            plane most, z of a terrain.
        basis: Scaling functions and wavelets. Linear: continuous, of two triangles' reach. Quartic: curvature is
            continuous, too.
        levels: How many, at most; fewer on small grids. 0: down to about 4 by 4 points. A whole number, 0 to 16.
        selected: Change selected vertices and the vertices of selected faces only. The selection stays as it is. None:
            derived from the mesh.
        quality_mask: Scale the effect at each vertex by its quality: 0 is no change, 1 the full one, values outside are
            clamped.
        relative_to: Current shape: the filter changes the mesh as it is now. Original: it starts again from the shape
            the mesh had before any Multiresolution filter moved it, so that changes do not add up, and values that
            change nothing (gains of 1) bring exactly that shape back. Outside the selection the mesh stays as it is.
            The original is kept with the layer until something else changes the mesh; files do not hold it.

    Raises:
        pymeshlab.PyMeshLabException: the mesh or a value will not do; it says why.

    See:
        Dreger, Gross, Schlegel, "Construction of Multiresolution Triangular B-Spline Surfaces using Hexagonal Filters",
            ETH Zürich 1999.
    """
    return apply(GridBandReport, "apply_coord_multires_grid_band", **locals())


def grid_compress(
    ms: MeshSet, *, keep_by: KeepBy = "share", share: float = 10.0, error: float | None = None,
    oracle: Oracle = "pursuit", channels: Channels = "positions", basis: Basis = "quartic", levels: int = 0,
    selected: bool | None = None, quality_mask: bool = False,
) -> GridCompressReport:
    """Replaces a triangular grid by what a few of its box-spline wavelets give: a share of them, or as few as an error
    bound allows.

    The filter apply_coord_multires_grid_compress, on the current mesh; the mesh is unchanged if it fails.

    Args:
        ms: the document.
        keep_by: What says how many coefficients are kept.
        share: Coefficients kept, in percent of the number of vertices. A number, 0 to 100.
        error: How far vertices may be off, at most, mesh units; as few as do it are kept. A number, at least 0. None:
            derived from the mesh.
        oracle: How they are chosen. Magnitude: the largest, at once. Pursuit: those that explain most of what is left,
            with the best values for all of them; some 100 times slower, half the error.
        channels: Positions: all three coordinates. Heights: only along the direction in which the surface leaves its
            plane most, z of a terrain.
        basis: Scaling functions and wavelets. Linear: continuous, of two triangles' reach. Quartic: curvature is
            continuous, too.
        levels: How many, at most; fewer on small grids. 0: down to about 4 by 4 points. A whole number, 0 to 16.
        selected: Change selected vertices and the vertices of selected faces only. The selection stays as it is. None:
            derived from the mesh.
        quality_mask: Scale the effect at each vertex by its quality: 0 is no change, 1 the full one, values outside are
            clamped.

    Raises:
        pymeshlab.PyMeshLabException: the mesh or a value will not do; it says why.

    See:
        Dreger, Gross, Schlegel, "Construction of Multiresolution Triangular B-Spline Surfaces using Hexagonal Filters",
            ETH Zürich 1999.
    """
    return apply(GridCompressReport, "apply_coord_multires_grid_compress", **locals())


def grid_level(
    ms: MeshSet, *, level: int = 1, refine: int = 0, attributes: bool = True, basis: Basis = "quartic", levels: int = 0,
) -> GridLevelReport:
    """Makes a new layer of the control points of a level of a triangular grid, or of the smooth surface that they give,
    at a level as fine as wanted.

    The filter generate_multires_grid_level, on the current mesh; the mesh is unchanged if it fails.

    Args:
        ms: the document.
        level: Of the control points: 0 is the grid, each level halves the number of points along each direction. A
            whole number, at least 0.
        refine: Steps of subdivision: 0 is the control mesh itself; as many as the level give the smooth surface with
            the grid's own vertices; up to three more are finer than the grid. A whole number, at least 0.
        attributes: Vertex colours, quality and custom attributes are transformed like the shape. Off: they are those of
            a vertex near.
        basis: Scaling functions and wavelets. Linear: continuous, of two triangles' reach. Quartic: curvature is
            continuous, too.
        levels: How many, at most; fewer on small grids. 0: down to about 4 by 4 points. A whole number, 0 to 16.

    Raises:
        pymeshlab.PyMeshLabException: the mesh or a value will not do; it says why.

    See:
        Dreger, Gross, Schlegel, "Construction of Multiresolution Triangular B-Spline Surfaces using Hexagonal Filters",
            ETH Zürich 1999.
    """
    return apply(GridLevelReport, "generate_multires_grid_level", **locals())


def grid_edit(
    ms: MeshSet, *, edited: int | None = None, attributes: bool = False, basis: Basis = "quartic", levels: int = 0,
    selected: bool | None = None, quality_mask: bool = False,
) -> GridEditReport:
    """Lets a triangular grid follow its edited control mesh: make one with Grid Level as Layer, move its vertices, and
    the surface moves with them and keeps its detail.

    The filter apply_coord_multires_grid_edit, on the current mesh; the mesh is unchanged if it fails.

    Args:
        ms: the document.
        edited: A layer made by Grid Level as Layer from the current one, without refinement, whose vertices were moved.
            None: the first other layer.
        attributes: Vertex colours, quality and custom attributes change where those of the control mesh were changed
            (painted), too. It must have been made with Attributes of the level.
        basis: Scaling functions and wavelets. Linear: continuous, of two triangles' reach. Quartic: curvature is
            continuous, too.
        levels: How many, at most; fewer on small grids. 0: down to about 4 by 4 points. A whole number, 0 to 16.
        selected: Change selected vertices and the vertices of selected faces only. The selection stays as it is. None:
            derived from the mesh.
        quality_mask: Scale the effect at each vertex by its quality: 0 is no change, 1 the full one, values outside are
            clamped.

    Raises:
        pymeshlab.PyMeshLabException: the mesh or a value will not do; it says why.

    See:
        Dreger, Gross, Schlegel, "Construction of Multiresolution Triangular B-Spline Surfaces using Hexagonal Filters",
            ETH Zürich 1999.
    """
    return apply(GridEditReport, "apply_coord_multires_grid_edit", **locals())


def filter_grid_attributes(
    ms: MeshSet, *, color: bool | None = None, quality: bool | None = None, custom: bool | None = None,
    custom_names: str = "", linear_light: bool = False, gain: float = 0.0,
    unit: Literal["wavelength", "wavelength percent", "level", "vertices"] = "wavelength", finest: float | None = None,
    coarsest: float | None = None, softness: float = 0.0, gains: str = "", basis: Basis = "quartic", levels: int = 0,
    selected: bool | None = None, quality_mask: bool = False,
) -> FilterGridAttributesReport:
    """Weakens, removes or strengthens detail of some sizes of vertex colours, quality and custom attributes on a
    triangular grid, by box-spline wavelets.

    The geometry stays as it is.

    The filter apply_attributes_multires_grid_band, on the current mesh; the mesh is unchanged if it fails.

    Args:
        ms: the document.
        color: With alpha. None: derived from the mesh.
        quality: The scalar value of the vertices. None: derived from the mesh.
        custom: Custom scalars and points of the vertices. None: derived from the mesh.
        custom_names: Which custom attributes: their names, separated by commas. Empty: all, but for source_vertex.
        linear_light: Decode colours (sRGB) to amounts of light before computing with them, and encode the result. Right
            for photographs; off, colours are computed with as they are stored, right for colour scales.
        gain: Factor for the details of the band: 1 changes nothing, 2 doubles them, 0 removes them. A number, 0 to 10.
        unit: What the limits are given in. Wavelength: length of a wave on the surface in mesh units; the finest a mesh
            can carry is twice its mean edge length. Wavelength percent: the same, 1 is 1 % of the diagonal of the
            bounding box. Level: of the pyramid, 0 is the finest. Vertices: how many vertices the level has. Scripts may
            leave limits out: they are then derived from the mesh, in this unit. In a dialog the numbers shown count.
        finest: Fine limit of the band, in the unit chosen: short waves, low levels, many vertices. A number, at least
            0. None: derived from the mesh.
        coarsest: Coarse limit of the band, in the unit chosen: long waves, high levels, few vertices. A number, at
            least 0. None: derived from the mesh.
        softness: Pyramid only: width of the band's edges in octaves of wavelength; 0 is a sharp edge. A number, 0 to
            10.
        gains: If not empty, in place of gain and limits: a factor for each level, finest first, separated by commas.
            Levels left out keep 1.
        basis: Scaling functions and wavelets. Linear: continuous, of two triangles' reach. Quartic: curvature is
            continuous, too.
        levels: How many, at most; fewer on small grids. 0: down to about 4 by 4 points. A whole number, 0 to 16.
        selected: Change selected vertices and the vertices of selected faces only. The selection stays as it is. None:
            derived from the mesh.
        quality_mask: Scale the effect at each vertex by its quality: 0 is no change, 1 the full one, values outside are
            clamped.

    Raises:
        pymeshlab.PyMeshLabException: the mesh or a value will not do; it says why.

    See:
        Dreger, Gross, Schlegel, "Construction of Multiresolution Triangular B-Spline Surfaces using Hexagonal Filters",
            ETH Zürich 1999.
    """
    return apply(FilterGridAttributesReport, "apply_attributes_multires_grid_band", **locals())


def compress_grid_attributes(
    ms: MeshSet, *, color: bool | None = None, quality: bool | None = None, custom: bool | None = None,
    custom_names: str = "", linear_light: bool = False, keep_by: KeepBy = "share", share: float = 10.0,
    error: float | None = None, oracle: Oracle = "pursuit", basis: Basis = "quartic", levels: int = 0,
    selected: bool | None = None, quality_mask: bool = False,
) -> CompressGridAttributesReport:
    """Replaces vertex colours, quality and custom attributes on a triangular grid by what a few box-spline wavelets
    give: a share of them, or as few as an error bound allows.

    The geometry stays as it is.

    The filter apply_attributes_multires_grid_compress, on the current mesh; the mesh is unchanged if it fails.

    Args:
        ms: the document.
        color: With alpha. None: derived from the mesh.
        quality: The scalar value of the vertices. None: derived from the mesh.
        custom: Custom scalars and points of the vertices. None: derived from the mesh.
        custom_names: Which custom attributes: their names, separated by commas. Empty: all, but for source_vertex.
        linear_light: Decode colours (sRGB) to amounts of light before computing with them, and encode the result. Right
            for photographs; off, colours are computed with as they are stored, right for colour scales.
        keep_by: What says how many coefficients are kept.
        share: Coefficients kept, in percent of the number of vertices. A number, 0 to 100.
        error: How far values may be off, at most, in units of the attribute (a colour as a vector of 0 to 255); as few
            as do it are kept. A number, at least 0. None: derived from the mesh.
        oracle: How they are chosen. Magnitude: the largest, at once. Pursuit: those that explain most of what is left,
            with the best values for all of them; some 100 times slower, half the error.
        basis: Scaling functions and wavelets. Linear: continuous, of two triangles' reach. Quartic: curvature is
            continuous, too.
        levels: How many, at most; fewer on small grids. 0: down to about 4 by 4 points. A whole number, 0 to 16.
        selected: Change selected vertices and the vertices of selected faces only. The selection stays as it is. None:
            derived from the mesh.
        quality_mask: Scale the effect at each vertex by its quality: 0 is no change, 1 the full one, values outside are
            clamped.

    Raises:
        pymeshlab.PyMeshLabException: the mesh or a value will not do; it says why.

    See:
        Dreger, Gross, Schlegel, "Construction of Multiresolution Triangular B-Spline Surfaces using Hexagonal Filters",
            ETH Zürich 1999.
    """
    return apply(CompressGridAttributesReport, "apply_attributes_multires_grid_compress", **locals())


LIMITS: dict[str, dict[str, tuple[float, float]]] = {
    "Pyramid": {
        "presmooth": (0, 1), "sets_per_level": (1, 100), "level_ratio": (0, 0.99), "length_weight": (0, 1000),
        "normal_limit": (1, 180), "feature_angle": (0.01, 179.99),
    },
    "detail_to_quality": {
        "softness": (0, 10),
    },
    "details_by_scale": {
        "bands": (1, 16),
    },
    "select_features": {
        "strong": (1, 179), "weak": (1, 179), "shortest": (0, 1000),
    },
    "low_pass": {
        "softness": (0, 10),
    },
    "stop_band": {
        "softness": (0, 10),
    },
    "enhance": {
        "gain": (0, 10), "softness": (0, 10),
    },
    "equalizer": {
        "gain_1": (0, 4), "gain_2": (0, 4), "gain_3": (0, 4), "gain_4": (0, 4), "gain_5": (0, 4), "gain_6": (0, 4),
        "gain_7": (0, 4), "gain_8": (0, 4), "softness": (0, 10),
    },
    "unsharp": {
        "xi": (0, 10), "iterations": (1, 10000), "feature_angle": (0.01, 179.99),
    },
    "denoise": {
        "strength": (0, 4), "cycle_spins": (1, 64),
    },
    "transfer_edit": {
        "gain": (0, 4), "bands": (1, 8),
    },
    "watermark": {
        "strength": (0.001, 1),
    },
    "move_region": {
        "angle": (-180, 180), "scale": (0.01, 100),
    },
    "multiband_edit": {
        "gain_1": (0, 4), "gain_2": (0, 4), "gain_3": (0, 4), "gain_4": (0, 4), "gain_5": (0, 4), "gain_6": (0, 4),
        "gain_7": (0, 4), "bands": (2, 8),
    },
    "detail_from_layer": {
        "gain": (0, 4),
    },
    "relax_attributes": {
        "iterations": (1, 10000), "strength": (1e-06, 1), "corner_angle": (0, 180), "feature_angle": (0.01, 179.99),
    },
    "filter_attributes": {
        "gain": (0, 10), "softness": (0, 10),
    },
    "filter_custom_attributes": {
        "gain": (0, 10), "softness": (0, 10),
    },
    "denoise_attributes": {
        "strength": (0, 100),
    },
    "adaptive_reconstruction": {
        "band_gain": (-1000, 1000), "normal_limit": (1, 180), "feature_angle": (0.01, 179.99),
    },
    "grid": {
        "levels": (0, 16),
    },
    "grid_band": {
        "gain": (0, 10), "softness": (0, 10), "levels": (0, 16),
    },
    "grid_compress": {
        "share": (0, 100), "levels": (0, 16),
    },
    "grid_level": {
        "levels": (0, 16),
    },
    "grid_edit": {
        "levels": (0, 16),
    },
    "filter_grid_attributes": {
        "gain": (0, 10), "softness": (0, 10), "levels": (0, 16),
    },
    "compress_grid_attributes": {
        "share": (0, 100), "levels": (0, 16),
    },
}
"""Least and most of the numbers that have both, by function (or class) and parameter."""


FILTERS: dict[str, tuple[str, str]] = {
    "build_pyramid": ("compute_multires_pyramid", "Multiresolution: Build Pyramid"),
    "level_as_layer": ("generate_multires_level", "Multiresolution: Level as New Layer"),
    "detail_to_quality": ("compute_scalar_multires_detail_per_vertex", "Multiresolution: Detail to Vertex Quality"),
    "difference_to_layer": ("compute_scalar_multires_difference_per_vertex", "Multiresolution: Difference to Layer"),
    "roughness": ("compute_multires_roughness", "Multiresolution: Roughness"),
    "relief": ("compute_scalar_multires_relief_per_vertex", "Multiresolution: Relief"),
    "details_by_scale": ("compute_custom_multires_scales", "Multiresolution: Details by Scale"),
    "select_features": ("compute_selection_multires_features", "Multiresolution: Select Features"),
    "low_pass": ("apply_coord_multires_low_pass", "Multiresolution: Low Pass"),
    "stop_band": ("apply_coord_multires_stop_band", "Multiresolution: Stop Band"),
    "enhance": ("apply_coord_multires_enhance", "Multiresolution: Enhance Band"),
    "equalizer": ("apply_coord_multires_equalizer", "Multiresolution: Equalizer"),
    "unsharp": ("apply_coord_multires_unsharp", "Multiresolution: Unsharp (Single Level)"),
    "denoise": ("apply_coord_multires_denoise", "Multiresolution: Denoise"),
    "transfer_edit": ("apply_coord_multires_transfer_edit", "Multiresolution: Follow Edited Layer"),
    "watermark": ("apply_coord_multires_watermark", "Multiresolution: Watermark"),
    "read_watermark": ("compute_multires_watermark", "Multiresolution: Read Watermark"),
    "move_region": ("apply_coord_multires_displace", "Multiresolution: Move Region"),
    "falloff_to_quality": ("compute_scalar_multires_falloff_per_vertex", "Multiresolution: Falloff to Quality"),
    "smooth_base_as_layer": ("generate_multires_base", "Multiresolution: Smooth Base as Layer"),
    "multiband_edit": ("apply_coord_multires_bands", "Multiresolution: Multiband Edit"),
    "detail_from_layer": ("transfer_coord_multires_detail", "Multiresolution: Detail from Layer"),
    "relax_attributes": ("apply_attributes_multires_relaxation", "Multiresolution: Relax Attributes"),
    "filter_attributes": ("apply_attributes_multires_band", "Multiresolution: Filter Attributes by Band"),
    "filter_custom_attributes": ("apply_attributes_multires_band_custom", "Multiresolution: Filter Custom Attributes by Band"),
    "denoise_attributes": ("apply_attributes_multires_denoise", "Multiresolution: Denoise Attributes"),
    "generate_texcoord": ("generate_multires_texcoord", "Multiresolution: Generate Texture Coordinates"),
    "adaptive_reconstruction": ("generate_multires_adaptive_reconstruction", "Multiresolution: Adaptive Reconstruction"),
    "grid": ("compute_multires_grid", "Multiresolution: Compute Grid"),
    "grid_band": ("apply_coord_multires_grid_band", "Multiresolution: Grid Band"),
    "grid_compress": ("apply_coord_multires_grid_compress", "Multiresolution: Grid Compression"),
    "grid_level": ("generate_multires_grid_level", "Multiresolution: Grid Level as Layer"),
    "grid_edit": ("apply_coord_multires_grid_edit", "Multiresolution: Follow Edited Grid Level"),
    "filter_grid_attributes": ("apply_attributes_multires_grid_band", "Multiresolution: Filter Attributes by Grid Band"),
    "compress_grid_attributes": ("apply_attributes_multires_grid_compress", "Multiresolution: Compress Attributes on Grid"),
}
"""By function: the name of its filter in pymeshlab, and the one in MeshLab's menu."""
