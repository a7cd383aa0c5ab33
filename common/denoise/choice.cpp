#include "denoise/choice.h"

#include "base/reduce.h"
#include "denoise/kinds.h"
#include "denoise/sample.h"
#include "denoise/white_share.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace multires {
namespace {

constexpr Index patch_size = 1500;
constexpr double mostly = 0.5;    ///< weight of the normal field that speaks for guided normals
constexpr double sharply = 0.65;  ///< weight of what keeps creases from which on it is alone
constexpr double small_weight = 0.04, small_weight_if_slow = 0.1;  ///< candidates with less are left out

/// Factor for what is certainly white if folded faces or the sampling speak for noise as well: rough terrain, whose
/// faces fold by nature, has nothing white.
constexpr double white_if_within = 3;

/// Turns of choosing for two kinds of surface, and vertices that each has at least.
constexpr int kind_turns = 2;
constexpr std::ptrdiff_t least_kind = 500;

std::ptrdiff_t counted(const std::vector<std::uint8_t>& core) { return std::count(core.begin(), core.end(), 1); }

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
    for (std::size_t k = 0; k < sharp.size(); ++k) sharp[k] = all[k].keeps_creases();
    return sharp;
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
    const double white = (noise.within_surface ? white_if_within : 1) * std::max(noise.white, removed);
    const double certain = noise.certain * std::min(1.0, white) / (noise.factor * noise.factor);
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

/// What is expected on the whole of choices for its parts.
/// @param share  of the parts
Choice together(const std::vector<Choice>& choices, const std::vector<double>& share) {
    Choice mean;
    mean.safe = 0;
    mean.weights = Eigen::VectorXd::Zero(choices[0].weights.size());
    for (std::size_t c = 0; c < choices.size(); ++c) {
        mean.weights += share[c] * choices[c].weights;
        mean.before += share[c] * choices[c].before;
        mean.after += share[c] * choices[c].after;
        mean.gain += share[c] * choices[c].gain;
        mean.safe += share[c] * choices[c].safe;
        mean.of_class.push_back(choices[c].weights);
    }
    return mean;
}

/// For each class of noise, and on the whole.
Choice choice_by_class(const Tried& tried, const Assumed& noise, const NoiseClasses& classes,
                       const std::vector<std::uint8_t>& core) {
    const double all = static_cast<double>(counted(core));
    std::vector<Choice> choices;
    std::vector<double> share;
    for (const auto& part : cores_of(classes, noise.deviation, core)) {
        choices.push_back(choice_of(tried, noise, part));
        share.push_back(static_cast<double>(counted(part)) / all);
    }
    return together(choices, share);
}

Blend blend_of(const std::vector<Response>& responses, const Eigen::VectorXd& t) {
    Blend blend{Response(responses[0].size(), 0), t.sum()};
    for (std::size_t k = 0; k < responses.size(); ++k) {
        const double weight = k < static_cast<std::size_t>(t.size()) ? t[static_cast<Eigen::Index>(k)] : 0;
        if (weight > 0)
            for (std::size_t i = 0; i < blend.response.size(); ++i) blend.response[i] += weight * responses[k][i];
    }
    return blend;
}

std::vector<std::array<double, 3>> kinds_of(const std::vector<double>& first) {
    std::vector<std::array<double, 3>> kinds(first.size());
    for (std::size_t i = 0; i < first.size(); ++i) kinds[i] = {first[i], 1 - first[i], 0};
    return kinds;
}

/// Two blends, and in turns where each is better: to begin with, the best of what keeps creases and of what does not.
/// None if that does not certainly gain.
std::optional<Choice> choice_by_kind(const Tried& tried, const Assumed& noise, const std::vector<std::uint8_t>& core,
                                     const Choice& one) {
    const auto blend = [&](const Eigen::VectorXd& t) { return blend_of(tried.responses, t); };
    const auto compare = [&](const Blend& a, const Blend& b) {
        return risk_difference(tried.near, a, b, noise.deviation, tried.probe, core);
    };
    const Risks r = risks(tried.near, tried.responses, noise.deviation, tried.probe, core);
    std::vector<std::uint8_t> allowed = sharp_candidates(r.edges.linear.size());
    Blend first = blend(least_risk_of(r.edges, allowed));
    for (std::uint8_t& a : allowed) a = !a;
    Blend second = blend(least_risk_of(r.edges, allowed));
    std::vector<Choice> choices;
    std::vector<double> share;
    std::array<std::vector<std::uint8_t>, 2> cores;
    for (int turn = 0;; ++turn) {
        share = shares_of_first(tried.near, compare(first, second));
        cores = {core, core};
        for (std::size_t i = 0; i < core.size(); ++i) cores[share[i] > 0.5 ? 1 : 0][i] = 0;
        if (counted(cores[0]) < least_kind || counted(cores[1]) < least_kind) return std::nullopt;
        if (turn == kind_turns) break;
        choices = {choice_of(tried, noise, cores[0]), choice_of(tried, noise, cores[1])};
        first = blend(choices[0].weights);
        second = blend(choices[1].weights);
    }
    const Blend alone = blend(one.weights);
    std::vector<double> gain = compare(first, alone);
    const std::vector<double> other = compare(second, alone);
    for (std::size_t i = 0; i < gain.size(); ++i) gain[i] = share[i] * gain[i] + (1 - share[i]) * other[i];
    if (!certainly_less(gain, core)) return std::nullopt;
    const double of_first = static_cast<double>(counted(cores[0])) / static_cast<double>(counted(core));
    Choice both = together(choices, {of_first, 1 - of_first});
    both.kinds = kinds_of(share);
    return both;
}

bool keeps_creases(const Choice& choice) {
    return std::any_of(choice.of_class.begin(), choice.of_class.end(),
                       [](const Eigen::VectorXd& t) { return sharp_share(t) > mostly; });
}

Choice choose_for(const Faces& faces, const Positions& positions, const Incidence& at, const Neighbours& near,
                  const Assumed& noise, const NoiseClasses& classes, const std::vector<std::uint8_t>& core,
                  const std::function<void(double)>& tick) {
    const CandidateMaker maker(faces, positions, at, near, noise.normal_steps, noise.deviation);
    CandidateMaker::Responses responses = maker.responses([&](double f) { tick(0.8 * f); });
    const AlongNormals surface(near, positions, maker.normal(), maker.weight());
    const Tried tried{surface, near, responses.all, maker.probe()};
    const auto add_guided = [&] { maker.add_guided(responses, [&](double f) { tick(0.8 + 0.2 * f); }); };
    Choice choice = choice_by_class(tried, noise, classes, core);
    const bool guided = keeps_creases(choice);
    if (guided) {
        add_guided();
        choice = choice_by_class(tried, noise, classes, core);
    }
    if (classes.count() > 1 || noise.stairs || !noise.by_kind) return choice;
    std::optional<Choice> by_kind = choice_by_kind(tried, noise, core, choice);
    if (by_kind && !guided && keeps_creases(*by_kind)) {
        add_guided();
        by_kind = choice_by_kind(tried, noise, core, choice);
    }
    return by_kind.value_or(choice);
}

/// Where each of two blends that were chosen on patches is better.
std::vector<std::array<double, 3>> kinds_everywhere(const Faces& faces, const Positions& positions, const Incidence& at,
                                                    const Neighbours& near, const Assumed& noise,
                                                    const std::vector<Eigen::VectorXd>& weights,
                                                    const std::function<void(double)>& tick) {
    const CandidateMaker maker(faces, positions, at, near, noise.normal_steps, noise.deviation);
    std::vector<Response> responses = maker.responses_like(weights, tick);
    const Blend first{std::move(responses[0]), weights[0].sum()}, second{std::move(responses[1]), weights[1].sum()};
    const std::vector<std::uint8_t> core(positions.size(), 1);
    return kinds_of(shares_of_first(near, risk_difference(near, first, second, noise.deviation, maker.probe(), core)));
}

}  // namespace

Choice choose(const Faces& faces, const Positions& positions, const Incidence& at, const Neighbours& near,
              const Assumed& noise, const NoiseClasses& classes, Index patches,
              const std::function<void(double)>& tick) {
    if (near.rows() <= whole_up_to)
        return choose_for(faces, positions, at, near, noise, classes, std::vector<std::uint8_t>(near.rows(), 1), tick);
    const Sample sample = patches_of(faces, positions, near, patches, patch_size);
    Assumed assumed = noise;
    assumed.deviation.resize(sample.vertex.size());
    for (std::size_t i = 0; i < sample.vertex.size(); ++i) assumed.deviation[i] = noise.deviation[sample.vertex[i]];
    Choice choice = choose_for(sample.faces, sample.positions, sample.at, sample.near, assumed, classes, sample.core,
                               [&](double f) { tick(0.5 * f); });
    if (!choice.kinds.empty())
        choice.kinds = kinds_everywhere(faces, positions, at, near, noise, choice.of_class,
                                        [&](double f) { tick(0.5 + 0.5 * f); });
    return choice;
}

}  // namespace multires
