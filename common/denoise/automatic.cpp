#include "denoise/automatic.h"

#include "base/median.h"
#include "base/parallel.h"
#include "base/reduce.h"
#include "denoise/lattice.h"
#include "denoise/noise_classes.h"
#include "denoise/sample.h"
#include "denoise/varying_noise.h"
#include "denoise/white_share.h"
#include "measure/measure.h"
#include "measure/vertex_normals.h"
#include "normals/guided_normals.h"
#include "normals/spikes.h"

#include <algorithm>
#include <cmath>

namespace multires {
namespace {

constexpr double rounding = 1e-4;    ///< edge lengths: less than this is no noise
constexpr double least_step = 0.03;  ///< edge lengths: a lattice that is finer makes no noise to speak of
constexpr double terraces = 0.7;  ///< rounding to steps as large as edges errs alike side by side: for it, as if more
constexpr int spike_steps = 3;    ///< of guided normals, for what impulses met: creases come back
constexpr double mostly = 0.5;    ///< weight of the normal field that speaks for guided normals
constexpr double sharply = 0.65;  ///< weight of what keeps creases from which on it is alone
constexpr double farthest = 4;    ///< deviations: Gaussian noise moves one vertex in 16,000 farther
constexpr double certain_if_varying = 0.8;                         ///< share of the square of noise that varies
constexpr double small_weight = 0.04, small_weight_if_slow = 0.1;  ///< candidates with less are left out

using Tick = std::function<void(double, const char*)>;

/// Steps of Taubin's low pass after which the normals serve as directions: the stronger the noise, the more.
int normal_steps(double deviation_in_edges) { return std::clamp(static_cast<int>(100 * deviation_in_edges), 3, 30); }

/// True if the vertices that moved stand out of the surface far more than what is left does: a rough surface has spikes
/// of the common kind.
bool stand_out(const Faces& faces, const Positions& before, const Positions& after, const Neighbours& near) {
    const Array<Vec3> normal = vertex_normals(faces, taubin(near, after, 3));
    const std::vector<double> zero(3 * before.size(), 0);
    const std::vector<double> detail = AlongNormals(near, before, normal, {}).detail(zero);
    const std::vector<double> left = AlongNormals(near, after, normal, {}).detail(zero);
    std::vector<double> moved, rest;
    for (std::size_t i = 0; i < before.size(); ++i) {
        if (before[i] != after[i]) moved.push_back(std::abs(detail[3 * i]));
        rest.push_back(std::abs(left[3 * i]));
    }
    return !moved.empty() && lower_quantile(moved, 0.5) > 1.3 * lower_quantile(rest, 0.8);
}

/// Of the noise along the normals, #V, mesh units.
std::vector<double> deviations(const Faces& faces, const Positions& positions, const Neighbours& near,
                               const SurfaceNoise& noise, double edge) {
    std::vector<double> out(positions.size(), noise.along_normals);
    if (!noise.axis) return out;
    const int steps = normal_steps(noise.axis->deviation / edge);
    const Array<Vec3> normal = vertex_normals(faces, taubin(near, positions, steps));
    for (std::size_t v = 0; v < out.size(); ++v) out[v] = noise.along(normal[v]);
    return out;
}

constexpr Index whole_up_to = 25000;  ///< vertices; larger meshes are chosen for on patches
constexpr Index patches = 12, patch_size = 1500;
/// What `fast` measures on, and how many of the former patches it chooses on.
constexpr Index fast_patches = 6, fast_size = 4000;

/// A surface with directions and weights for its candidates.
struct Prepared {
    Array<Vec3> normal;
    std::vector<double> weight;
};

Prepared prepared(const Faces& faces, const Positions& positions, const Incidence& at, const Neighbours& near,
                  int steps) {
    const Positions smooth = taubin(near, positions, steps);
    return {vertex_normals(faces, smooth), cotangent_weights(faces, at, near, smooth)};
}

/// Factor for the deviation when choosing. On smooth shapes a blend keeps as much of the noise as the deviation is
/// underestimated, while a bit too much costs little elsewhere: so the estimate's own error is added where the noise is
/// strong enough to be told from the shape.
double allowance(double deviation_in_edges, Index vertices) {
    const double error = std::min(0.06, 0.02 + 1.5 / std::sqrt(static_cast<double>(vertices)));
    return 1 + error * std::clamp((deviation_in_edges - 0.03) / 0.03, 0.0, 1.0);
}

/// The noise as it is assumed for the choice.
struct Assumed {
    std::vector<double> deviation;  ///< #V: along the normals, mesh units, times `factor`
    double factor = 1;              ///< see allowance()
    double certain = 1;             ///< share of the variance that there is at least
    double white = 1;               ///< see SurfaceNoise
    bool stairs = false;            ///< flat parts and creases are noise
    bool large = false;             ///< the mesh: see drop_small()
    int normal_steps = 3;           ///< see normal_steps()
};

struct Choice {
    Eigen::VectorXd weights;                ///< mean of those of the classes
    std::vector<Eigen::VectorXd> of_class;  ///< by noise: see NoiseClasses
    double before = 0, after = 0;           ///< mean square error of the heights
    double gain = 0;                        ///< what it falls by at least
    double safe = 1;  ///< share of the best move that gains even with as little noise as is certain
};

/// Weights so small that their candidates are not worth making go to the others.
/// @param large  the mesh: normal fields take most of the time
void drop_small(Eigen::VectorXd& t, bool large) {
    const std::vector<Candidate> all = all_candidates();
    const double before = t.sum();
    for (Eigen::Index k = 0; k < t.size(); ++k) {
        const bool slow = large && all[static_cast<std::size_t>(k)].family == Family::normal_field;
        if (t[k] < (slow ? small_weight_if_slow : small_weight)) t[k] = 0;
    }
    if (t.sum() > 0) t *= before / t.sum();
}

/// The weights of least risk without some of the candidates.
Eigen::VectorXd least_risk_of(const Risk& risk, const std::vector<std::uint8_t>& allowed) {
    std::vector<Eigen::Index> kept;
    for (std::size_t k = 0; k < allowed.size(); ++k)
        if (allowed[k]) kept.push_back(static_cast<Eigen::Index>(k));
    const Eigen::VectorXd t = least_risk({risk.constant, risk.linear(kept), risk.quadratic(kept, kept)});
    Eigen::VectorXd out = Eigen::VectorXd::Zero(risk.linear.size());
    for (std::size_t k = 0; k < kept.size(); ++k) out[kept[k]] = t[static_cast<Eigen::Index>(k)];
    return out;
}

/// The candidates that keep creases: the normal field, and guided normals after it.
std::vector<std::uint8_t> sharp_candidates(Eigen::Index count) {
    const std::vector<Candidate> all = all_candidates();
    std::vector<std::uint8_t> sharp(static_cast<std::size_t>(count));
    for (std::size_t k = 0; k < sharp.size(); ++k)
        sharp[k] = all[k].family == Family::normal_field || all[k].family == Family::guided_normals;
    return sharp;
}

double sharp_share(const Eigen::VectorXd& t) {
    const std::vector<std::uint8_t> sharp = sharp_candidates(t.size());
    double share = 0;
    for (Eigen::Index k = 0; k < t.size(); ++k)
        if (sharp[static_cast<std::size_t>(k)]) share += t[k];
    return share;
}

/// Least risk of the normals, as long as the distances gain, too: a third of the noise, or half of what they could.
/// Where most speaks for what keeps creases, nothing that rounds them is mixed in: squares make much of few vertices.
/// @param stairs  what keeps creases is no candidate
/// @param large   see drop_small()
Eigen::VectorXd weights_of(const Risks& r, bool stairs, bool large) {
    const double half = (r.heights.constant + r.heights.at(least_risk(r.heights))) / 2;
    const double limit = std::max(half, 0.7 * r.heights.constant);
    Eigen::VectorXd t;
    const std::vector<std::uint8_t> sharp = sharp_candidates(r.edges.linear.size()), all(sharp.size(), 1);
    std::vector<std::uint8_t> smooth = all;
    for (std::size_t k = 0; k < sharp.size(); ++k) smooth[k] = !sharp[k];
    for (const double heights : {0.0, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0}) {
        const double e = 1 / r.edges.constant, h = heights / r.heights.constant;
        const Risk both = {e * r.edges.constant + h * r.heights.constant, e * r.edges.linear + h * r.heights.linear,
                           e * r.edges.quadratic + h * r.heights.quadratic};
        t = least_risk_of(both, stairs ? smooth : all);
        if (sharp_share(t) > sharply) t = least_risk_of(both, sharp);
        drop_small(t, large);
        if (r.heights.at(t) <= limit) break;
    }
    return t;
}

/// The share of a blend that gains even if there is less noise than assumed: the cross term of the risk goes with the
/// variance of the noise.
/// @param certain  share of the variance that there is at least
double safe_share(const Risk& risk, const Eigen::VectorXd& t, double certain) {
    const double moved = t.dot(risk.quadratic * t), answer = -risk.linear.dot(t);
    return moved > 0 ? std::clamp(2 * certain * answer / moved, 0.0, 1.0) : 0;
}

/// Mean square of what a blend leaves of the probe.
double noise_left(const std::vector<Response>& responses, const std::vector<double>& probe, const Eigen::VectorXd& t,
                  const std::vector<std::uint8_t>& core) {
    const auto mean = chunked_fold<Mean>(core.size(), [&](Mean& part, std::size_t i) {
        if (!core[i]) return;
        double left = probe[i];
        for (std::size_t k = 0; k < responses.size(); ++k)
            left += t[static_cast<Eigen::Index>(k)] * responses[k][2 * i + 1];
        part.add(left * left);
    });
    return mean.value();
}

/// What a choice is made from.
struct Tried {
    const AlongNormals& surface;
    const Neighbours& near;
    const std::vector<Response>& responses;
    const std::vector<double>& probe;
};

/// For the vertices of a core.
Choice choice_of(const Tried& tried, const Assumed& noise, const std::vector<std::uint8_t>& core) {
    const Risks r = risks(tried.near, tried.responses, noise.deviation, tried.probe, core);
    Choice choice;
    choice.weights = weights_of(r, noise.stairs, noise.large);
    const double removed = white_share_removed(tried.surface, tried.near, tried.responses, choice.weights, core);
    const double certain = noise.certain * std::max(noise.white, removed) / (noise.factor * noise.factor);
    choice.safe = std::min(1.0, 2 * certain);
    choice.weights *=
        std::min(safe_share(r.edges, choice.weights, certain), safe_share(r.heights, choice.weights, certain));
    // What is expected goes with the deviation as it was found.
    Risk expected = r.heights;
    expected.constant /= noise.factor * noise.factor;
    expected.linear /= noise.factor * noise.factor;
    choice.before = expected.constant;
    choice.gain = std::max(0.0, -2 * certain * r.heights.linear.dot(choice.weights) -
                                    choice.weights.dot(r.heights.quadratic * choice.weights));
    // What the blend leaves of the noise is an error in any case.
    choice.after =
        std::max(expected.at(choice.weights),
                 noise_left(tried.responses, tried.probe, choice.weights, core) / (noise.factor * noise.factor));
    return choice;
}

/// The core's vertices by the class that most of their noise belongs to.
std::vector<std::vector<std::uint8_t>> cores_of(const NoiseClasses& classes, const std::vector<double>& deviation,
                                                const std::vector<std::uint8_t>& core) {
    std::vector<std::vector<std::uint8_t>> out(classes.count(), std::vector<std::uint8_t>(core.size(), 0));
    for (std::size_t i = 0; i < core.size(); ++i) {
        const std::array<double, 3> shares = classes.shares(deviation[i]);
        const auto most = std::max_element(shares.begin(), shares.end()) - shares.begin();
        out[static_cast<std::size_t>(most)][i] = core[i];
    }
    return out;
}

/// For each class of noise, and on the whole.
Choice choice_by_class(const Tried& tried, const Assumed& noise, const NoiseClasses& classes,
                       const std::vector<std::uint8_t>& core) {
    if (classes.count() == 1) {
        Choice choice = choice_of(tried, noise, core);
        choice.of_class = {choice.weights};
        return choice;
    }
    const double all = static_cast<double>(std::count(core.begin(), core.end(), 1));
    Choice mean;
    mean.safe = 0;
    mean.weights = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(tried.responses.size()));
    for (const auto& part : cores_of(classes, noise.deviation, core)) {
        const Choice choice = choice_of(tried, noise, part);
        const double share = static_cast<double>(std::count(part.begin(), part.end(), 1)) / all;
        mean.weights += share * choice.weights;
        mean.before += share * choice.before;
        mean.after += share * choice.after;
        mean.gain += share * choice.gain;
        mean.safe += share * choice.safe;
        mean.of_class.push_back(choice.weights);
    }
    return mean;
}

Choice choose(const Faces& faces, const Positions& positions, const Incidence& at, const Neighbours& near,
              const Assumed& noise, const NoiseClasses& classes, const std::vector<std::uint8_t>& core,
              const std::function<void(double)>& tick) {
    const Prepared p = prepared(faces, positions, at, near, noise.normal_steps);
    const CandidateMaker maker(faces, positions, at, near, p.normal, p.weight, noise.deviation);
    CandidateMaker::Responses responses = maker.responses([&](double f) { tick(0.8 * f); });
    const AlongNormals surface(near, positions, p.normal, p.weight);
    const Tried tried{surface, near, responses.all, maker.probe()};
    Choice choice = choice_by_class(tried, noise, classes, core);
    if (std::any_of(choice.of_class.begin(), choice.of_class.end(),
                    [](const Eigen::VectorXd& t) { return sharp_share(t) > mostly; })) {
        maker.add_guided(responses, [&](double f) { tick(0.8 + 0.2 * f); });
        choice = choice_by_class(tried, noise, classes, core);
    }
    return choice;
}

/// On so many patches if the mesh is large.
Choice choose_on_sample(const Faces& faces, const Positions& positions, const Incidence& at, const Neighbours& near,
                        const Assumed& noise, const NoiseClasses& classes, Index count,
                        const std::function<void(double)>& tick) {
    if (near.rows() <= whole_up_to)
        return choose(faces, positions, at, near, noise, classes, std::vector<std::uint8_t>(near.rows(), 1), tick);
    const Sample sample = patches_of(faces, positions, near, count, patch_size);
    const Incidence sample_at = vertex_faces(sample.faces, static_cast<Index>(sample.positions.size()));
    const Neighbours sample_near = neighbours(sample.faces, sample_at);
    Assumed assumed = noise;
    assumed.deviation.resize(sample.vertex.size());
    for (std::size_t i = 0; i < sample.vertex.size(); ++i) assumed.deviation[i] = noise.deviation[sample.vertex[i]];
    return choose(sample.faces, sample.positions, sample_at, sample_near, assumed, classes, sample.core, tick);
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
        const double length = move.norm(), most = farthest * std::max(deviation[i], least);
        if (length > most) positions[i] = from[i] + most / length * move;
    }
}

/// Factor for an error that is estimated along normals that do not move: noise tilts them.
double tilted(double share, double deviation_in_edges) {
    return 1 + share * std::pow(std::min(deviation_in_edges, 0.3), 2);
}

/// Impulses are set back, unless the surface is rough everywhere.
Positions without_impulses(const Faces& faces, const Positions& positions, const Incidence& at, const Neighbours& near,
                           Index& spikes) {
    Positions start = without_spikes(faces, positions, at, spikes);
    if (spikes > 0 && !stand_out(faces, positions, start, near)) spikes = 0;
    if (spikes == 0) return positions;
    std::vector<std::uint8_t> moves(positions.size());
    for (std::size_t i = 0; i < moves.size(); ++i) moves[i] = start[i] != positions[i];
    return guided_steps(faces, start, at, face_graph(faces, at), spike_steps, moves);
}

/// The blends of the classes of noise, by their shares in each vertex.
LocalWeights local_weights(const Choice& choice, const NoiseClasses& classes, const std::vector<double>& deviation) {
    std::vector<std::array<double, 3>> share;
    for (std::size_t v = 0; choice.of_class.size() > 1 && v < deviation.size(); ++v)
        share.push_back(classes.shares(deviation[v]));
    return {choice.of_class, std::move(share)};
}

/// What is known before the choice.
struct Measured {
    SurfaceNoise noise;
    bool varies = false;   ///< clearly, from place to place
    bool rounded = false;  ///< it is that of rounding to the lattice
    bool voxels = false;   ///< and the lattice that of voxels
    Index spikes = 0;
    Positions start;                ///< without impulses
    std::vector<double> deviation;  ///< #V: of the noise along the normals, mesh units
    double along_normals = 0;       ///< root mean square of it
    double certain = 0;             ///< share of its square that there is at least

    bool is_certain(double edge) const { return certain * along_normals > rounding * edge; }
    /// The noise as it is assumed within the surface.
    SurfaceNoise within(double strength) const {
        SurfaceNoise out = noise;
        out.along_normals = strength * along_normals;
        return out;
    }
};

/// Noise that differs from place to place is white in most places, or it would not be found.
void set_varying(std::vector<double> deviation, Measured& m) {
    m.deviation = std::move(deviation);
    m.along_normals = rms(m.deviation);
    m.certain = certain_if_varying;
    m.noise.by_edges = 1;
    m.noise.along_normals = m.along_normals;
    m.noise.at_least = std::sqrt(m.certain) * m.along_normals;
}

/// @param step  of the lattice that all coordinates lie on
/// @param edge  mean edge length
Measured measured(const Faces& faces, const Positions& positions, const Incidence& at, const Neighbours& near,
                  const std::optional<double>& step, double edge, const AutomaticOptions& options, const Tick& tick) {
    Measured m;
    std::optional<SurfaceNoise> rounded;
    if (step) rounded = rounding_noise(faces, positions, at, near, *step, edge);
    m.rounded = rounded.has_value();
    m.voxels = rounded && between_voxels(positions, *step);
    if (m.voxels) {
        // Half a voxel to each side along an edge that the surface crosses, so mostly along its normal.
        rounded->along_normals = rounded->at_least = *step / std::sqrt(3.0);
        rounded->all_directions = false;
    }
    tick(0.05, "Looking for noise that varies");
    std::vector<double> varying;
    if (!rounded && !options.deviation) varying = varying_noise(faces, positions, at, near);
    if (!varying.empty()) m.noise = surface_noise(faces, positions, at, near, edge);
    m.varies = !varying.empty() && !m.noise.axis;
    if (m.varies) {
        m.start = positions;
        set_varying(std::move(varying), m);
        if (m.along_normals > 0) find_varying_within_surface(faces, positions, near, m.deviation, m.noise);
        return m;
    }
    tick(0.07, "Looking for impulsive noise");
    m.start = rounded ? positions : without_impulses(faces, positions, at, near, m.spikes);
    tick(0.1, "Measuring the noise");
    m.noise = rounded ? *rounded : surface_noise(faces, m.start, at, near, edge);
    if (options.deviation) {
        m.noise.along_normals = m.noise.at_least = *options.deviation;
        m.noise.white = m.noise.by_edges = 1;
        m.noise.axis.reset();
    }
    m.deviation = deviations(faces, m.start, near, m.noise, edge);
    m.along_normals = rms(m.deviation);
    m.certain = m.along_normals > 0 ? std::pow(m.noise.at_least / m.along_normals, 2) : 0;
    return m;
}

/// What is to be done to a mesh, up to the choice.
struct Plan {
    Measured measured;
    WithinSurface within;
};

/// Of large meshes the blend that removes noise within the surface is found on patches; faces are turned back anywhere.
WithinSurface within_of(const Faces& faces, const Positions& positions, const Neighbours& near,
                        const SurfaceNoise& noise, double edge) {
    if (near.rows() <= whole_up_to) return relax_within_surface(faces, positions, near, noise, edge);
    const Sample sample = patches_of(faces, positions, near, fast_patches, fast_size);
    const Neighbours sample_near =
        neighbours(sample.faces, vertex_faces(sample.faces, static_cast<Index>(sample.positions.size())));
    WithinSurface there = relax_within_surface(sample.faces, sample.positions, sample_near, noise, edge);
    there.turned = true;
    return relax_within_surface(faces, positions, near, noise, edge, &there);
}

Plan plan_of(const Faces& faces, const Positions& positions, const Incidence& at, const Neighbours& near,
             const std::optional<double>& step, double edge, const AutomaticOptions& options, const Tick& tick) {
    Plan plan{measured(faces, positions, at, near, step, edge, options, tick), {}};
    if (!plan.measured.is_certain(edge)) return plan;
    tick(0.2, "Looking for noise within the surface");
    const Measured& m = plan.measured;
    plan.within = within_of(faces, m.start, near, m.within(options.strength), edge);
    return plan;
}

/// The same, found on patches of the mesh.
Plan sampled_plan(const Faces& faces, const Positions& positions, const Incidence& at, const Neighbours& near,
                  const std::optional<double>& step, double edge, const AutomaticOptions& options, const Tick& tick) {
    const Sample sample = patches_of(faces, positions, near, fast_patches, fast_size);
    const Incidence sample_at = vertex_faces(sample.faces, static_cast<Index>(sample.positions.size()));
    const Neighbours sample_near = neighbours(sample.faces, sample_at);
    Plan plan = plan_of(sample.faces, sample.positions, sample_at, sample_near, step, edge, options, tick);
    Measured& m = plan.measured;
    m.start = m.spikes > 0 ? without_impulses(faces, positions, at, near, m.spikes) : positions;
    if (!m.is_certain(edge)) return plan;
    if (m.varies) {  // patches are not all of the surface
        m.deviation = varying_noise(faces, positions, at, near);
        m.varies = !m.deviation.empty();
    }
    if (!m.varies) m.deviation = deviations(faces, m.start, near, m.noise, edge);
    plan.within = relax_within_surface(faces, m.start, near, m.within(options.strength), edge, &plan.within);
    return plan;
}

}  // namespace

Positions denoise_automatically(const Faces& faces, const Positions& positions, const AutomaticOptions& options,
                                AutomaticStats& stats, const Tick& tick) {
    stats = AutomaticStats();
    tick(0, "Finding neighbours");
    const Index count = static_cast<Index>(positions.size());
    const Incidence at = vertex_faces(faces, count);
    const Neighbours near = neighbours(faces, at);
    const double edge = stats.edge = mean_edge_length(faces, positions);
    std::optional<double> step;
    if (!options.deviation) step = lattice_step(positions, least_step * edge);
    const bool fast = options.fast && count > whole_up_to;
    const Plan plan = (fast ? sampled_plan : plan_of)(faces, positions, at, near, step, edge, options, tick);
    const auto& [found, within] = plan;
    const double deviation = stats.deviation = options.strength * found.along_normals;
    const auto [least, most] = std::minmax_element(plan.measured.deviation.begin(), plan.measured.deviation.end());
    if (least != found.deviation.end()) {
        stats.least_deviation = options.strength * *least;
        stats.most_deviation = options.strength * *most;
    }
    stats.varies = found.varies;
    if (found.rounded) stats.step = *step;
    stats.voxels = found.voxels;
    stats.spikes = found.spikes;
    stats.axis = found.noise.axis.has_value();
    stats.by_edges = found.noise.by_edges;
    if (!found.is_certain(edge)) return found.start;

    tick(0.25, "Choosing");
    Assumed assumed;
    assumed.certain = found.certain;
    assumed.white = found.noise.white;
    assumed.stairs = found.voxels;
    assumed.large = count > whole_up_to;
    assumed.factor = allowance(deviation / edge, count) * (found.rounded ? 1 + terraces * deviation / edge : 1);
    assumed.normal_steps = normal_steps(deviation / edge);
    assumed.deviation = found.deviation;
    for (double& d : assumed.deviation) d *= options.strength * assumed.factor;
    const NoiseClasses classes(found.varies ? assumed.deviation : std::vector<double>());
    const Choice choice =
        choose_on_sample(faces, shifted(found.start, within, Shares()), at, near, assumed, classes,
                         fast ? fast_patches : patches, [&](double f) { tick(0.25 + 0.4 * f, "Choosing"); });
    if (!(choice.safe > 0)) return found.start;
    const Shares shares = safe_shares(within, choice);
    const Positions relaxed = shifted(found.start, within, shares);
    const Prepared p = prepared(faces, relaxed, at, near, assumed.normal_steps);
    const CandidateMaker maker(faces, relaxed, at, near, p.normal, p.weight, assumed.deviation);
    stats.weights = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(all_candidates().size()));
    stats.weights.head(choice.weights.size()) = choice.weights;
    stats.all_directions = within.noisy;
    // What keeps creases follows the normals.
    const double height = tilted(1 - sharp_share(choice.weights), deviation / edge),
                 side = tilted(1.5, deviation / edge);
    const bool around = within.noisy || within.likely;
    stats.rms_before = std::sqrt(choice.before + (around ? within.before * within.before : 0));
    stats.rms_after = std::sqrt(height * height * choice.after + side * side * error_within(within, shares));
    Positions after = maker.blend(local_weights(choice, classes, assumed.deviation),
                                  [&](double f) { tick(0.65 + 0.35 * f, "Denoising"); });
    keep_within_noise(relaxed, assumed.deviation, after);
    if (found.rounded) keep_within_cells(positions, found.voxels ? stats.step : stats.step / 2, after);
    stats.edge = mean_edge_length(faces, after);
    return after;
}

}  // namespace multires
