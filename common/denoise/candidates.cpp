#include "denoise/candidates.h"

#include "base/parallel.h"
#include "measure/vertex_normals.h"
#include "normals/guided_normals.h"
#include "normals/normal_field.h"

#include <algorithm>

namespace multires {
namespace {

/// Averaging steps that make the energy of each band local, and how many more of them for the noise's energy, which
/// varies with the sampling only.
constexpr std::array<int, 6> steps_of_level = {4, 6, 9, 15, 25, 40};
constexpr int noise_steps = 12;
/// Lengths of the pushes that measure how candidates answer that are not linear, in samples of the noise: guided
/// normals jump where another patch becomes the most consistent one.
constexpr double field_push = 0.1, guided_push = 0.4;
constexpr double normal_rounding = 1e-4;  ///< differences of normals that coordinates in single precision make
constexpr int fit_steps = 8;              ///< more would follow the normals further and lose volume

}  // namespace

std::vector<Candidate> all_candidates() {
    std::vector<Candidate> all;
    const auto add = [&](Family family, std::size_t count, Smoother smoother = Smoother::equal) {
        for (std::size_t i = 0; i < count; ++i) all.push_back({family, static_cast<int>(i), smoother});
    };
    for (const Smoother s : smoothers) add(Family::low_pass, low_pass_steps.size(), s);
    for (const Smoother s : smoothers) add(Family::wiener, wiener_severity.size(), s);
    add(Family::normal_field, field_strength.size());
    add(Family::guided_normals, guided_steps_after.size());
    return all;
}

double sharp_share(const Eigen::VectorXd& weights) {
    const std::vector<Candidate> all = all_candidates();
    double share = 0;
    for (Eigen::Index k = 0; k < weights.size(); ++k)
        if (all[static_cast<std::size_t>(k)].keeps_creases()) share += weights[k];
    return share;
}

LocalWeights::LocalWeights(const std::vector<Eigen::VectorXd>& of_class, std::vector<std::array<double, 3>> share)
    : share_(std::move(share)) {
    for (const Eigen::VectorXd& weights : of_class) {
        of_class_.emplace_back(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(all_candidates().size())));
        of_class_.back().head(weights.size()) = weights;
    }
}

bool LocalWeights::any(std::size_t candidate) const {
    return std::any_of(of_class_.begin(), of_class_.end(), [&](const Eigen::VectorXd& weights) {
        return weights[static_cast<Eigen::Index>(candidate)] > 0;
    });
}

CandidateMaker::CandidateMaker(const Faces& faces, const Positions& positions, const Incidence& at,
                               const Neighbours& near, int smoothing, const std::vector<double>& deviation)
    : faces_(faces), positions_(positions), at_(at), near_(near), deviation_(deviation), probe_(deviation.size()) {
    const Positions smooth = taubin(near, positions, smoothing);
    normal_ = vertex_normals(faces, smooth);
    weight_ = cotangent_weights(faces, at, near, smooth);
    parallel_for(near.rows(), [&](Index v) { probe_[v] = deviation[v] * gaussian(v, 7); });
}

Response CandidateMaker::of_low_pass(const std::vector<double>& low) const {
    const std::size_t count = probe_.size(), width = low.size() / count;
    Response out(2 * count, 0);
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t c = 0; moves(i) && c < (width == 3 ? 2 : 1); ++c) out[2 * i + c] = low[width * i + c];
    return out;
}

CandidateMaker::LowPasses CandidateMaker::low_passes(Smoother smoother, std::size_t levels, Channels channels) const {
    if (smoother != Smoother::spatial)
        return along_normals(smoother == Smoother::cotangent ? weight_ : std::vector<double>(), levels, channels);
    if (channels == Channels::surface) return spatial<1>(levels);
    return channels == Channels::surface_noise ? spatial<2>(levels) : spatial<3>(levels);
}

std::vector<double> CandidateMaker::samples(Channels channels) const {
    const std::size_t width = static_cast<std::size_t>(channels);
    std::vector<double> h(width * probe_.size(), 0);
    if (channels == Channels::surface) return h;
    parallel_for(near_.rows(), [&](Index v) {
        const std::size_t i = width * static_cast<std::size_t>(v);
        if (width == 3) h[i + 1] = probe_[v];
        h[i + width - 1] = deviation_[v] * gaussian(v, 8);
    });
    return h;
}

template <int channels>
CandidateMaker::LowPasses CandidateMaker::spatial(std::size_t levels) const {
    const std::vector<double> height = samples(static_cast<Channels>(channels));
    Array<Columns<channels>> start(probe_.size());
    parallel_for(near_.rows(), [&](Index v) {
        start[v].col(0) = positions_[v];
        for (int c = 1; c < channels; ++c)
            start[v].col(c) = height[channels * static_cast<std::size_t>(v) + c] * normal_[v];
    });
    Array<Columns<channels>> p = start;
    LowPasses low(levels, std::vector<double>(channels * probe_.size()));
    int done = 0;
    for (std::size_t level = 0; level < levels; ++level) {
        p = smoothed_fields<channels>(near_, std::move(p), low_pass_steps[level] - done);
        done = low_pass_steps[level];
        parallel_for(near_.rows(), [&](Index v) {
            for (int c = 0; c < channels; ++c)
                low[level][channels * static_cast<std::size_t>(v) + c] = normal_[v].dot(p[v].col(c) - start[v].col(c));
        });
    }
    return low;
}

CandidateMaker::LowPasses CandidateMaker::along_normals(const std::vector<double>& weight, std::size_t levels,
                                                        Channels channels) const {
    const AlongNormals surface(near_, positions_, normal_, weight);
    LowPasses low;
    const std::vector<double> start = samples(channels);
    std::vector<double> h = start;
    int done = 0;
    for (std::size_t level = 0; level < levels; ++level) {
        surface.smooth(h, low_pass_steps[level] - done);
        done = low_pass_steps[level];
        low.emplace_back(h.size());
        for (std::size_t i = 0; i < h.size(); ++i) low.back()[i] = h[i] - start[i];
    }
    return low;
}

std::vector<CandidateMaker::Band> CandidateMaker::bands(const LowPasses& low) const {
    const std::size_t count = probe_.size(), width = low[0].size() / count;
    std::vector<Band> all(low.size());
    for (std::size_t level = 0; level < low.size(); ++level) {
        Band& band = all[level];
        band.detail.resize(width * count);
        band.energy.resize(width * count);
        band.noise.resize(count);
        parallel_for(near_.rows(), [&](Index v) {
            const std::size_t i = width * static_cast<std::size_t>(v), noise = i + width - 1;
            for (std::size_t c = i; c <= noise; ++c)
                band.detail[c] = (level > 0 ? low[level - 1][c] : 0) - low[level][c];
            const double d = band.detail[i], other = band.detail[noise];
            band.energy[i] = d * d;
            if (width == 3) band.energy[i + 1] = d * band.detail[i + 1];
            band.energy[noise] = other * other;  // not the probe's, or the gains would know it
        });
        average(near_, band.energy, static_cast<int>(width), steps_of_level[level]);
        parallel_for(near_.rows(),
                     [&](Index v) { band.noise[v] = band.energy[width * static_cast<std::size_t>(v) + width - 1]; });
        average(near_, band.noise, 1, noise_steps);
    }
    return all;
}

Response CandidateMaker::wiener(const LowPasses& low, const std::vector<Band>& bands, double severity) const {
    const std::size_t width = low[0].size() / probe_.size();
    Response out = of_low_pass(low.back());
    parallel_for(near_.rows(), [&](Index v) {
        if (!moves(static_cast<std::size_t>(v))) return;
        for (const Band& band : bands) {
            // The gain 1 - noise / energy, and how it answers the probe: energy answers with twice the mean of d b.
            const double* detail = band.detail.data() + width * static_cast<std::size_t>(v);
            const double* mean = band.energy.data() + width * static_cast<std::size_t>(v);
            const double energy = mean[0], noise = severity * band.noise[v];
            if (!(energy > noise)) continue;
            const double gain = 1 - noise / energy;
            out[2 * v] += gain * detail[0];
            if (width < 3) continue;
            const double answer = 2 * noise * mean[1] / (energy * energy);
            out[2 * v + 1] += gain * detail[1] + answer * detail[0];
        }
    });
    return out;
}

const FaceGraph& CandidateMaker::graph() const {
    if (!graph_) graph_ = face_graph(faces_, at_);
    return *graph_;
}

std::vector<std::uint8_t> CandidateMaker::faces_without_noise() const {
    std::vector<std::uint8_t> silent(faces_.size());
    bool any = false;
    for (std::size_t f = 0; f < silent.size(); ++f) {
        silent[f] = std::all_of(faces_[f].begin(), faces_[f].end(), [&](Index v) { return !(deviation_[v] > 0); });
        any |= silent[f] != 0;
    }
    return any ? silent : std::vector<std::uint8_t>();
}

Positions CandidateMaker::field(const Positions& from, double strength, const std::function<void(double)>& tick) const {
    NormalFieldOptions options;
    options.strength = strength;
    options.statistics = false;
    options.silent = faces_without_noise();
    NormalFieldStats stats;
    const Array<Vec3> normals = denoise_normals(faces_, from, graph(), options, stats, tick);
    return stats.noise > normal_rounding ? fit_vertices(faces_, from, at_, normals, fit_steps) : from;
}

double CandidateMaker::side() const {
    // The field does not answer a push and its opposite alike, so the side must not depend on the
    // winding of the faces, as the normals do.
    double side = 0;
    for (std::size_t i = 0; i < probe_.size(); ++i) side += normal_[i].dot(positions_[i] - positions_[0]);
    return side < 0 ? -1 : 1;
}

Positions CandidateMaker::pushed(double length) const {
    Positions out = positions_;
    for (std::size_t i = 0; i < probe_.size(); ++i) out[i] += length * probe_[i] * normal_[i];
    return out;
}

Response CandidateMaker::response_of(const Positions& after, const Positions& after_push, double length) const {
    Response out(2 * probe_.size());
    for (std::size_t i = 0; i < probe_.size(); ++i) {
        if (!moves(i)) continue;
        out[2 * i] = normal_[i].dot(after[i] - positions_[i]);
        out[2 * i + 1] = normal_[i].dot(after_push[i] - after[i]) / length - probe_[i];
    }
    return out;
}

CandidateMaker::Responses CandidateMaker::responses(const std::function<void(double)>& tick) const {
    Responses out;
    std::vector<Response>& all = out.all;
    std::vector<Response> wieners;
    for (const Smoother smoother : smoothers) {
        const LowPasses low = low_passes(smoother, low_pass_steps.size(), Channels::surface_probe_noise);
        tick(0.05 + 0.1 * static_cast<double>(smoother));
        const std::vector<Band> split = bands(low);
        for (const double severity : wiener_severity) wieners.push_back(wiener(low, split, severity));
        tick(0.1 + 0.1 * static_cast<double>(smoother));
        for (const auto& l : low) all.push_back(of_low_pass(l));
    }
    std::move(wieners.begin(), wieners.end(), std::back_inserter(all));
    const double push = field_push * side();
    const Positions other = pushed(push);
    for (std::size_t k = 0; k < field_strength.size(); ++k) {
        const auto part = [&](double f) { tick(0.3 + 0.7 * (static_cast<double>(k) + f) / field_strength.size()); };
        out.field = field(positions_, field_strength[k], [&](double f) { part(f / 2); });
        const Positions after_push = field(other, field_strength[k], [&](double f) { part(0.5 + f / 2); });
        all.push_back(response_of(out.field, after_push, push));
    }
    return out;
}

void CandidateMaker::add_guided(Responses& responses, const std::function<void(double)>& tick) const {
    const double push = guided_push * side();
    Positions own = responses.field;
    Positions other = field(pushed(push), field_strength.back(), [&](double f) { tick(0.3 * f); });
    int done = 0;
    for (const int steps : guided_steps_after) {
        own = guided_steps(faces_, own, at_, graph(), steps - done);
        other = guided_steps(faces_, other, at_, graph(), steps - done);
        responses.all.push_back(response_of(own, other, push));
        done = steps;
        tick(0.3 + 0.7 * done / guided_steps_after.back());
    }
}

void CandidateMaker::add_heights(const LocalWeights& weights, Smoother smoother, bool probed, const Add& add) const {
    const std::vector<Candidate> all = all_candidates();
    std::size_t levels = 0;
    bool shrunk = false;
    for (std::size_t k = 0; k < all.size(); ++k) {
        if (weights.any(k) && all[k].is(Family::low_pass, smoother))
            levels = std::max<std::size_t>(levels, all[k].index + 1);
        shrunk |= weights.any(k) && all[k].is(Family::wiener, smoother);
    }
    if (shrunk) levels = low_pass_steps.size();
    if (levels == 0) return;
    const Channels unprobed = shrunk ? Channels::surface_noise : Channels::surface;
    const LowPasses low = low_passes(smoother, levels, probed ? Channels::surface_probe_noise : unprobed);
    const std::vector<Band> split = shrunk ? bands(low) : std::vector<Band>();
    for (std::size_t k = 0; k < all.size(); ++k) {
        if (!weights.any(k)) continue;
        if (all[k].is(Family::low_pass, smoother)) add(k, of_low_pass(low[all[k].index]));
        if (all[k].is(Family::wiener, smoother)) add(k, wiener(low, split, wiener_severity[all[k].index]));
    }
}

std::vector<Response> CandidateMaker::responses_like(const std::vector<Eigen::VectorXd>& blends,
                                                     const std::function<void(double)>& tick) const {
    const LocalWeights weights(blends, {});
    std::vector<Response> out(blends.size(), Response(2 * probe_.size(), 0));
    const auto add_to = [&](Response& to, double weight, const Response& own) {
        for (std::size_t i = 0; weight > 0 && i < to.size(); ++i) to[i] += weight * own[i];
    };
    for (const Smoother smoother : smoothers) {
        add_heights(weights, smoother, true, [&](std::size_t k, const Response& own) {
            for (std::size_t b = 0; b < blends.size(); ++b)
                add_to(out[b], blends[b][static_cast<Eigen::Index>(k)], own);
        });
        tick(0.1 * (1 + static_cast<double>(smoother)));
    }
    const double push = field_push * side();
    const Positions after = field(positions_, field_strength.back(), [&](double f) { tick(0.3 + 0.35 * f); });
    const Positions other = field(pushed(push), field_strength.back(), [&](double f) { tick(0.65 + 0.35 * f); });
    const Response own = response_of(after, other, push);
    for (std::size_t b = 0; b < blends.size(); ++b) add_to(out[b], sharp_share(blends[b]), own);
    return out;
}

Positions CandidateMaker::blend(const LocalWeights& weights, const std::function<void(double)>& tick) const {
    const std::vector<Candidate> all = all_candidates();
    std::vector<double> height(probe_.size(), 0);
    for (const Smoother smoother : smoothers) {
        add_heights(weights, smoother, false, [&](std::size_t k, const Response& moves) {
            for (std::size_t v = 0; v < height.size(); ++v) height[v] += weights.at(k, v) * moves[2 * v];
        });
        tick(0.15 + 0.12 * static_cast<double>(smoother));
    }
    Positions out = positions_;
    for (std::size_t i = 0; i < out.size(); ++i)
        if (moves(i)) out[i] += height[i] * normal_[i];
    Positions after;
    const auto add = [&](std::size_t k) {
        for (std::size_t i = 0; i < out.size(); ++i)
            if (moves(i)) out[i] += weights.at(k, i) * (after[i] - positions_[i]);
    };
    bool guided = false;
    for (std::size_t k = 0; k < all.size(); ++k) guided |= all[k].family == Family::guided_normals && weights.any(k);
    for (std::size_t k = 0; k < all.size(); ++k) {
        const bool last = all[k].index + 1 == field_strength.size();
        if (all[k].family != Family::normal_field || !(weights.any(k) || (guided && last))) continue;
        after =
            field(positions_, field_strength[all[k].index], [&](double f) { tick(0.4 + 0.2 * (all[k].index + f)); });
        add(k);
    }
    int done = 0;
    for (std::size_t k = 0; k < all.size() && guided; ++k) {
        if (all[k].family != Family::guided_normals) continue;
        after = guided_steps(faces_, after, at_, graph(), guided_steps_after[all[k].index] - done);
        done = guided_steps_after[all[k].index];
        add(k);
        tick(0.8 + 0.2 * done / guided_steps_after.back());
    }
    return out;
}

}  // namespace multires
