#include "denoise/automatic.h"

#include "base/parallel.h"
#include "denoise/choice.h"
#include "denoise/found_noise.h"
#include "denoise/lattice.h"
#include "denoise/left_error.h"
#include "denoise/outliers.h"
#include "denoise/sample.h"
#include "denoise/smooth_regions.h"
#include "denoise/varying_noise.h"
#include "denoise/within_cells.h"
#include "measure/measure.h"

#include <algorithm>
#include <cmath>

namespace multires {
namespace {

constexpr double least_step = 0.03;  ///< edge lengths: a lattice that is finer makes no noise to speak of
constexpr double terraces = 0.7;  ///< rounding to steps as large as edges errs alike side by side: for it, as if more
constexpr double machined = 0.4;  ///< share of what keeps creases in the blend: the surface may consist of patches
constexpr Index patches = 12;     ///< that large meshes are chosen for on
/// What `fast` measures on, and how many of the former patches it chooses on.
constexpr Index fast_patches = 6, fast_size = 4000;

/// Factor for the deviation when choosing. On smooth shapes a blend keeps as much of the noise as the deviation is
/// underestimated, while a bit too much costs little elsewhere: so the estimate's own error is added where the noise is
/// strong enough to be told from the shape.
double allowance(double deviation_in_edges, Index vertices) {
    const double error = std::min(0.06, 0.02 + 1.5 / std::sqrt(static_cast<double>(vertices)));
    return 1 + error * std::clamp((deviation_in_edges - 0.03) / 0.03, 0.0, 1.0);
}

/// What of the shifts within the surface is made.
struct Shares {
    double smoothing = 1, turning = 1;
};

/// So much that the vertices do not get farther from the truth even if the shifts are wrong. The normal field turns
/// faces back itself, and better at creases.
Shares safe_shares(const WithinSurface& within, const Choice& choice) {
    Shares shares;
    if (sharp_share(choice.weights) > 0.9) shares.turning = 0;
    const double smoothed = mean_square(within.smoothing), turned = shares.turning * mean_square(within.turning);
    double allowed = (within.likely ? 0.8 : 0.25) * choice.gain;
    if (within.noisy) {
        shares.smoothing = choice.safe;
        shares.turning *= choice.safe;
        allowed += 0.9 * std::max(0.0, within.before * within.before - within.after * within.after);
        if (turned > allowed) shares.turning = std::min(shares.turning, std::sqrt(allowed / turned));
    } else if (smoothed + turned > allowed) {
        const double share = std::sqrt(allowed / (smoothed + turned));
        shares.smoothing *= share;
        shares.turning *= share;
    }
    return shares;
}

Positions shifted(const Positions& p, const WithinSurface& within, const Shares& shares) {
    Positions out = p;
    for (std::size_t i = 0; i < p.size(); ++i)
        out[i] += shares.smoothing * within.smoothing[i] + shares.turning * within.turning[i];
    return out;
}

/// Mean square error within the surface after the shifts, as far as it is known.
double error_within(const WithinSurface& within, const Shares& shares) {
    const double turned = shares.turning * shares.turning * mean_square(within.turning);
    if (within.noisy || within.likely) {
        const double left = (1 - shares.smoothing) * (1 - shares.smoothing);
        return within.after * within.after + left * (within.before * within.before - within.after * within.after) +
               turned;
    }
    return shares.smoothing * shares.smoothing * mean_square(within.smoothing) + turned;
}

/// Takes moves back that are longer than noise: thin sheets and single features may be drawn in.
/// @param deviation  #V: of the noise
void keep_within_noise(const Positions& from, const std::vector<double>& deviation, Positions& positions) {
    const double least = rms(deviation);
    for (std::size_t i = 0; i < from.size(); ++i) {
        const Vec3 move = positions[i] - from[i];
        const double length = move.norm(), most = farthest_by_noise * std::max(deviation[i], least);
        if (length > most) positions[i] = from[i] + most / length * move;
    }
}

/// Factor for an error that is estimated along normals that do not move: noise tilts them.
double tilted(double share, double deviation_in_edges) {
    return 1 + share * std::pow(std::min(deviation_in_edges, 0.3), 2);
}

/// The blends of the classes of noise or kinds of surface, by their shares in each vertex.
LocalWeights local_weights(const Choice& choice, const NoiseClasses& classes, const std::vector<double>& deviation) {
    std::vector<std::array<double, 3>> share = choice.kinds;
    for (std::size_t v = 0; choice.kinds.empty() && choice.of_class.size() > 1 && v < deviation.size(); ++v)
        share.push_back(classes.shares(deviation[v]));
    return {choice.of_class, std::move(share)};
}

Assumed assumed_of(const FoundNoise& found, double strength, double edge) {
    const double in_edges = strength * found.along_normals / edge;
    const Index count = static_cast<Index>(found.start.size());
    Assumed assumed;
    assumed.certain = found.certain;
    assumed.white = found.noise.white;
    assumed.stairs = found.voxels;
    assumed.large = count > whole_up_to;
    assumed.factor = allowance(in_edges, count) * (found.rounded ? 1 + terraces * in_edges : 1);
    assumed.normal_steps = normal_steps(in_edges);
    assumed.deviation = found.deviation;
    for (double& d : assumed.deviation) d *= strength * assumed.factor;
    return assumed;
}

void state(const FoundNoise& found, double strength, AutomaticStats& stats) {
    stats.deviation = strength * found.along_normals;
    const auto [least, most] = std::minmax_element(found.deviation.begin(), found.deviation.end());
    if (least != found.deviation.end()) {
        stats.least_deviation = strength * *least;
        stats.most_deviation = strength * *most;
    }
    stats.varies = found.varies;
    stats.voxels = found.voxels;
    stats.spikes = found.spikes;
    stats.axis = found.noise.axis.has_value();
    stats.by_edges = found.noise.by_edges;
}

/// What is to be done to a mesh, up to the choice.
struct Plan {
    FoundNoise found;
    WithinSurface within;
};

/// Of large meshes the blend that removes noise within the surface is found on patches; faces are turned back anywhere.
WithinSurface within_of(const Faces& faces, const Positions& positions, const Neighbours& near,
                        const SurfaceNoise& noise, double edge) {
    if (near.rows() <= whole_up_to) return relax_within_surface(faces, positions, near, noise, edge);
    const Sample sample = patches_of(faces, positions, near, fast_patches, fast_size);
    WithinSurface there = relax_within_surface(sample.faces, sample.positions, sample.near, noise, edge);
    there.turned = true;
    return relax_within_surface(faces, positions, near, noise, edge, &there);
}

/// No face is turned back where there are planes: places are known to half a step there, and thin faces turned at the
/// cost of those.
void stay_in_planes(const EvenPlaces& even, WithinSurface& within) {
    if (even.axes.empty()) return;
    keep_in_planes(even, within.smoothing);
    within.turned = false;
    std::fill(within.turning.begin(), within.turning.end(), Vec3(0, 0, 0));
}

Plan plan_of(const Faces& faces, const Positions& positions, const Incidence& at, const Neighbours& near,
             const std::optional<double>& step, double edge, const AutomaticOptions& options, const Tick& tick) {
    Plan plan{find_noise(faces, positions, at, near, step, options.deviation, edge, tick), {}};
    if (!plan.found.is_certain(edge)) return plan;
    tick(0.2, "Looking for noise within the surface");
    const FoundNoise& m = plan.found;
    plan.within = within_of(faces, m.start, near, m.within(options.strength), edge);
    stay_in_planes(m.even, plan.within);
    return plan;
}

/// The same, found on patches of the mesh.
Plan sampled_plan(const Faces& faces, const Positions& positions, const Incidence& at, const Neighbours& near,
                  const std::optional<double>& step, double edge, const AutomaticOptions& options, const Tick& tick) {
    const Sample sample = patches_of(faces, positions, near, fast_patches, fast_size);
    Plan plan = plan_of(sample.faces, sample.positions, sample.at, sample.near, step, edge, options, tick);
    FoundNoise& m = plan.found;
    m.start = m.spikes > 0 ? without_impulses(faces, positions, at, near, m.spikes) : positions;
    if (!m.is_certain(edge)) return plan;
    if (m.varies) {  // patches are not all of the surface
        m.deviation = varying_noise(faces, positions, at, near);
        m.varies = !m.deviation.empty();
    }
    if (!m.varies) m.deviation = deviations(faces, m.start, near, m.noise, edge);
    if (m.rounded) m.even = even_places(faces, positions, at, *step, edge);
    m.leave_even_places();
    plan.within = relax_within_surface(faces, m.start, near, m.within(options.strength), edge, &plan.within);
    stay_in_planes(m.even, plan.within);
    return plan;
}

/// #F: 1 where the blend says that the surface may consist of patches, outside of planes along the axes.
std::vector<std::uint8_t> machined_faces(const Faces& faces, const Choice& choice, const EvenPlaces& even) {
    const double everywhere = choice.kinds.empty() ? sharp_share(choice.weights) : 0;
    std::vector<double> of_class;
    for (std::size_t c = 0; !choice.kinds.empty() && c < choice.of_class.size(); ++c)
        of_class.push_back(sharp_share(choice.of_class[c]));
    const auto may_be = [&](Index v) {
        double share = everywhere;
        for (std::size_t c = 0; c < of_class.size(); ++c) share += choice.kinds[v][c] * of_class[c];
        return share > machined;
    };
    std::vector<std::uint8_t> asked(faces.size());
    parallel_for(static_cast<Index>(faces.size()), [&](Index f) {
        const auto& [a, b, c] = faces[f];
        const bool is_even = !even.axes.empty() && (even.axes[a] & even.axes[b] & even.axes[c]) != 0;
        asked[f] = !is_even && std::all_of(faces[f].begin(), faces[f].end(), may_be);
    });
    return asked;
}

/// Outliers are put back before anything is measured; creases come back to them.
Positions outliers_back(const Faces& faces, const Positions& positions, const Incidence& at, const Neighbours& near,
                        Index& count) {
    std::vector<std::uint8_t> moved;
    Positions after = without_outliers(faces, positions, at, near, moved);
    count = static_cast<Index>(std::count(moved.begin(), moved.end(), 1));
    return count > 0 ? with_creases(faces, after, at, moved) : after;
}

}  // namespace

Positions denoise_automatically(const Faces& faces, const Positions& given, const AutomaticOptions& options,
                                AutomaticStats& stats, const Tick& tick) {
    stats = AutomaticStats();
    tick(0, "Finding neighbours");
    const Index count = static_cast<Index>(given.size());
    const Incidence at = vertex_faces(faces, count);
    const Neighbours near = neighbours(faces, at);
    const Positions positions = outliers_back(faces, given, at, near, stats.outliers);
    const double edge = stats.edge = mean_edge_length(faces, positions);
    std::optional<double> step;
    if (!options.deviation) step = lattice_step(positions, least_step * edge);
    const bool fast = options.fast && count > whole_up_to;
    const Plan plan = (fast ? sampled_plan : plan_of)(faces, positions, at, near, step, edge, options, tick);
    const auto& [found, within] = plan;
    state(found, options.strength, stats);
    if (found.rounded) stats.step = *step;
    if (!found.is_certain(edge)) return found.start;

    tick(0.25, "Choosing");
    Assumed assumed = assumed_of(found, options.strength, edge);
    assumed.by_kind = !fast;
    assumed.within_surface = within.noisy;
    const NoiseClasses classes(found.varies ? assumed.deviation : std::vector<double>());
    const Choice choice = choose(faces, shifted(found.start, within, Shares()), at, near, assumed, classes,
                                 fast ? fast_patches : patches, [&](double f) { tick(0.25 + 0.4 * f, "Choosing"); });
    if (!(choice.safe > 0 && choice.weights.sum() > 0)) return found.start;
    const Shares shares = safe_shares(within, choice);
    const Positions relaxed = shifted(found.start, within, shares);
    const CandidateMaker maker(faces, relaxed, at, near, assumed.normal_steps, assumed.deviation);
    stats.weights = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(all_candidates().size()));
    stats.weights.head(choice.weights.size()) = choice.weights;
    stats.all_directions = within.noisy;
    stats.kinds = !choice.kinds.empty();
    // What keeps creases follows the normals.
    const double height = tilted(1 - sharp_share(choice.weights), stats.deviation / edge),
                 side = tilted(1.5, stats.deviation / edge);
    Positions after = maker.blend(local_weights(choice, classes, assumed.deviation),
                                  [&](double f) { tick(0.65 + 0.35 * f, "Denoising"); });
    keep_within_noise(relaxed, assumed.deviation, after);
    Sideways along_axis;
    if (found.noise.axis && !within.noisy) {
        AxisNoise axis = *found.noise.axis;
        axis.deviation *= options.strength;
        along_axis = move_along(axis, options.strength * found.noise.along_normals, choice.after, near, maker.normal(),
                                relaxed, after);
    }
    const bool around = within.noisy || within.likely;
    double heights = height * height * choice.after;
    const double sideways = around || found.noise.axis ? side * side * error_within(within, shares)
                                                       : moved_within(faces, found.start, after);
    const double variance = stats.deviation * stats.deviation;
    if (found.rounded) keep_within_cells(found.even, positions, found.voxels ? stats.step : stats.step / 2, after);
    if (!found.voxels) {
        const Positions& start = found.rounded ? positions : found.start;
        const PlaceErrors errors =
            found.rounded ? PlaceErrors::of_rounding(*step) : PlaceErrors::of_noise(found.deviation);
        const std::vector<std::uint8_t> asked = machined_faces(faces, choice, found.even);
        const double share = std::min(options.strength, 1.0);
        const SmoothRegions regions = smooth_regions(faces, at, asked, start, errors, after);
        const Positions before = after;
        move_into(regions, at, found.even, start, errors, share, after);
        heights = error_after_patches(heights, variance, faces, regions, before, after);
        if (found.rounded)
            smooth_within_cells(faces, at, maker.graph(), asked, found.even, positions, *step, share, after);
        stats.patches = static_cast<Index>(regions.patch.size());
    }
    const double held = mean_held(found.even) * variance;
    stats.rms_before =
        std::sqrt(choice.before + (around ? within.before * within.before : 0) + along_axis.before + held);
    stats.rms_after = std::sqrt(heights + sideways + along_axis.after + held);
    stats.edge = mean_edge_length(faces, after);
    return after;
}

}  // namespace multires
