#include "denoise/values.h"

#include "base/decompositions.h"
#include "base/parallel.h"
#include "base/rows.h"
#include "denoise/field_noise.h"
#include "denoise/sample.h"
#include "denoise/value_candidates.h"
#include "denoise/value_impulses.h"
#include "denoise/value_steps.h"
#include "denoise/white_share.h"
#include "measure/measure.h"
#include "measure/vertex_normals.h"
#include "mesh/adjacency.h"

#include <algorithm>
#include <cmath>

namespace multires {
namespace {

constexpr double most_correction = 1.2;   ///< of the variance of the noise
constexpr std::size_t most_rows = 30000;  ///< vertices whose risk is summed up
/// Blends for meshes of more than twice as many vertices as these hold are chosen on them: half the time. Many small
/// ones: twelve of 2,000 left up to 1.4 times the error.
constexpr Index patches = 24, patch_size = 1500;

/// The largest noise that the distribution of the values allows, if that is clearly less than what was found: white
/// noise of deviation s makes their density f so smooth that (log f)'' >= -1 / s^2 (what is left of Tweedie's formula,
/// the variance of the truth given a value, is not negative). So labels and checkers as fine as the triangles, which
/// differ as if by noise, are known by the few values there are.
double most_noise_of_values(const std::vector<double>& values, double found) {
    if (!(found > 0)) return found;
    constexpr double bins = 8;  // in a deviation
    constexpr std::size_t most_bins = 4096;
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    const double width = found / bins;
    if (!((*high - *low) / width < most_bins)) return found;
    std::vector<double> count(static_cast<std::size_t>((*high - *low) / width) + 1, 0);
    for (const double x : values)  // saturated ones have no noise
        if (x != *low && x != *high) ++count[static_cast<std::size_t>((x - *low) / width)];
    // Density at spacing of bins, smoothed by half a deviation.
    constexpr int reach = 16;
    constexpr double smoothing = 0.5;
    std::vector<double> density(count.size() + 2 * reach, 0);
    for (std::size_t i = 0; i < count.size(); ++i)
        for (int d = -reach; d <= reach; ++d)
            density[i + reach + d] += count[i] * std::exp(-0.5 * std::pow(d / (bins * smoothing), 2));
    const double peak = *std::max_element(density.begin(), density.end());
    double least = 1 + smoothing * smoothing;
    for (std::size_t i = 1; i + 1 < density.size(); ++i) {
        const double bend = (2 * density[i] - density[i - 1] - density[i + 1]) * bins * bins;
        const bool top = density[i] >= density[i - 1] && density[i] >= density[i + 1];
        if (top && density[i] > 0.5 * peak && bend > 0) least = std::min(least, density[i] / bend);
    }
    constexpr double clearly = 0.6;
    const double variance = std::max(0.0, least - smoothing * smoothing);
    return variance < clearly ? std::sqrt(variance) * found : found;
}

/// The values of the channels that have noise, in units of it.
struct Scaled {
    NoisyValues noisy;
    std::vector<int> channel;   ///< #noisy.width: of the values
    std::vector<double> scale;  ///< #noisy.width: deviations of the channels
};

/// @param local  #width of #V: deviations of the noise
Scaled scaled(const std::vector<double>& values, int width, const std::vector<std::vector<double>>& local) {
    Scaled s;
    for (int c = 0; c < width; ++c) {
        const double d = rms(local[c]);
        if (d > 0) s.channel.push_back(c), s.scale.push_back(d);
    }
    const std::size_t count = values.size() / width, active = s.channel.size();
    s.noisy.width = static_cast<int>(active);
    s.noisy.values.resize(count * active);
    s.noisy.probe.resize(count * active);
    if (active == 0) return s;
    s.noisy.deviation.resize(count);
    parallel_for(static_cast<Index>(count), [&](Index v) {
        double squares = 0;
        for (std::size_t a = 0; a < active; ++a) squares += std::pow(local[s.channel[a]][v] / s.scale[a], 2);
        const double deviation = std::sqrt(squares / static_cast<double>(active));
        s.noisy.deviation[v] = deviation;
        for (std::size_t a = 0; a < active; ++a) {
            const std::size_t i = active * v + a;
            s.noisy.values[i] =
                (values[static_cast<std::size_t>(width) * v + s.channel[a]] - values[s.channel[a]]) / s.scale[a];
            s.noisy.probe[i] = deviation * gaussian(v, 300 + a);
        }
    });
    return s;
}

/// The blends of least risk, channel by channel.
struct Blend {
    std::vector<Eigen::VectorXd> weights;         ///< #channels of #candidates
    std::vector<double> risk_before, risk_after;  ///< #channels
    std::vector<double> correction;               ///< #channels: of the variance of the noise
    /// #channels: mean square of the moves, and what they answer to the noise: the risk falls by 2 answer - moved.
    std::vector<double> moved, answer;

    /// Only a share of a channel's moves.
    void keep(int channel, double share) {
        weights[channel] *= share;
        const double gain = 2 * answer[channel] - moved[channel];
        risk_after[channel] += gain - share * (2 * answer[channel] - share * moved[channel]);
    }
};

/// What is summed up of each candidate: some of the vertices, one channel.
struct Rows {
    std::vector<Index> vertex;
    std::vector<std::vector<Response>> responses;  ///< #channels of #candidates
};

/// The variance of the noise, in units of the one found: what low passes with cotangents take out of the values has no
/// less energy than what they take out of noise. 1 if none of them takes out about what it should: they see texture.
double noise_of_residual(const std::vector<Response>& responses) {
    double least = most_correction;
    for (std::size_t k = 0; k < value_low_pass_steps.size(); ++k) {
        double move = 0, response = 0;
        for (std::size_t i = 0; i < responses[k].size(); i += 2) {
            move += responses[k][i] * responses[k][i];
            response += responses[k][i + 1] * responses[k][i + 1];
        }
        if (response > 0) least = std::min(least, move / response);
    }
    if (!(least < most_correction)) return 1;
    return least < 1 ? least : std::sqrt(least);  // more may be shape, too
}

/// Mean square of the noise that a blend lets pass, by the probe.
double passed_noise(const std::vector<Response>& responses, const Eigen::VectorXd& weights,
                    const std::vector<double>& probe) {
    double squares = 0;
    for (std::size_t i = 0; i < probe.size(); ++i) {
        double left = probe[i];
        for (std::size_t k = 0; k < responses.size(); ++k)
            left += weights[static_cast<Eigen::Index>(k)] * responses[k][2 * i + 1];
        squares += left * left;
    }
    return probe.empty() ? 0 : squares / static_cast<double>(probe.size());
}

/// Weights of least risk to rounding, of those that are not next to nothing.
/// @param weights  nearly of least risk
Eigen::VectorXd polished(const Risk& risk, const Eigen::VectorXd& weights) {
    constexpr double least = 1e-3;
    const Eigen::Index input = weights.size();  // its weight is what the others leave
    Eigen::VectorXd t(input + 1);
    t << weights, 1 - weights.sum();
    Eigen::Index most = input;
    const auto steep = [&](Eigen::Index j, Eigen::Index k) {
        return j < input && k < input ? risk.quadratic(j, k) : 0.0;
    };
    for (Eigen::Index round = 0; round <= input; ++round) {
        t = (t.array() < least).select(0, t);
        t.maxCoeff(&most);  // the others' ways from it are free
        std::vector<Eigen::Index> active;
        for (Eigen::Index k = 0; k <= input; ++k)
            if (k != most && t[k] > 0) active.push_back(k);
        const auto count = static_cast<Eigen::Index>(active.size());
        Eigen::MatrixXd a(count, count);
        Eigen::VectorXd b(count);
        const auto slope = [&](Eigen::Index k) { return (k < input ? risk.linear[k] : 0.0) + steep(k, most); };
        for (Eigen::Index j = 0; j < count; ++j) {
            b[j] = slope(most) - slope(active[j]);
            for (Eigen::Index k = 0; k < count; ++k)
                a(j, k) =
                    steep(active[j], active[k]) - steep(active[j], most) - steep(most, active[k]) + steep(most, most);
        }
        const Eigen::VectorXd x = count > 0 ? solve_symmetric(a, b) : Eigen::VectorXd();
        if (!x.allFinite()) return weights;
        for (Eigen::Index j = 0; j < count; ++j) t[active[j]] = x[j];
        t[most] = 1 - x.sum();
        if (t.minCoeff() >= 0 && (t.array() == 0 || t.array() >= least).all()) return t.head(input);
    }
    return weights;
}

Blend blend_of(const NoisyValues& noisy, const Rows& rows) {
    Neighbours alone;  // no differences along edges: the error of the values counts
    alone.rim.assign(rows.vertex.size(), 0);
    alone.offset.assign(rows.vertex.size() + 1, 0);
    const std::vector<std::uint8_t> core(rows.vertex.size(), 1);
    Blend blend;
    for (int c = 0; c < noisy.width; ++c) {
        std::vector<double> deviation, probe;
        for (const Index v : rows.vertex) {
            deviation.push_back(noisy.deviation[v]);
            probe.push_back(noisy.probe[static_cast<std::size_t>(v) * noisy.width + c]);
        }
        Risk risk = risks(alone, rows.responses[c], deviation, probe, core).heights;
        const double correction = noise_of_residual(rows.responses[c]);
        risk.constant *= correction;
        risk.linear *= correction;
        // Candidates that do nearly the same would share their weight by rounding.
        risk.quadratic.diagonal().array() += 1e-6 * risk.quadratic.trace();
        Eigen::VectorXd weights = polished(risk, least_risk(risk));
        // Not clearly better: the sums scatter, and so does the noise found.
        const double most = 0.93 - 3 / std::sqrt(static_cast<double>(rows.vertex.size()));
        if (!(risk.at(weights) < most * risk.constant)) weights.setZero();
        blend.correction.push_back(correction);
        blend.moved.push_back(weights.dot(risk.quadratic * weights));
        blend.answer.push_back(-risk.linear.dot(weights));
        blend.risk_before.push_back(risk.constant);
        const double passed = correction * passed_noise(rows.responses[c], weights, probe);
        blend.risk_after.push_back(std::max(passed, risk.at(weights)));
        blend.weights.push_back(std::move(weights));
    }
    return blend;
}

/// Vertices to sum up: all but those left out, or some thousands of them.
std::vector<Index> rows_of(const std::vector<std::uint8_t>& left_out) {
    std::vector<Index> all;
    for (std::size_t i = 0; i < left_out.size(); ++i)
        if (!left_out[i]) all.push_back(static_cast<Index>(i));
    const std::size_t stride = (all.size() + most_rows - 1) / most_rows;
    if (stride > 1) {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < all.size(); i += stride) all[kept++] = all[i];
        all.resize(kept);
    }
    return all;
}

Blend chosen(const ValueCandidateMaker& maker, const NoisyValues& noisy, const std::vector<std::uint8_t>& left_out,
             const std::function<void(double)>& tick) {
    Rows rows{rows_of(left_out), std::vector<std::vector<Response>>(noisy.width)};
    const std::size_t count = value_candidates().size();
    maker.make(noisy, std::vector<std::uint8_t>(count, 1), [&](std::size_t k, const ValueMoves& moves) {
        for (int c = 0; c < noisy.width; ++c) {
            Response r;
            r.reserve(2 * rows.vertex.size());
            for (const Index v : rows.vertex) {
                const std::size_t i = static_cast<std::size_t>(v) * noisy.width + c;
                r.push_back(moves.move[i]);
                r.push_back(moves.response[i]);
            }
            rows.responses[c].push_back(std::move(r));
        }
        tick(static_cast<double>(k + 1) / static_cast<double>(count));
    });
    return blend_of(noisy, rows);
}

NoisyValues part_of(const NoisyValues& noisy, const std::vector<Index>& vertex) {
    NoisyValues part{noisy.width, {}, {}, {}};
    for (const Index v : vertex) {
        part.deviation.push_back(noisy.deviation[v]);
        for (int c = 0; c < noisy.width; ++c) {
            const std::size_t i = static_cast<std::size_t>(v) * noisy.width + c;
            part.values.push_back(noisy.values[i]);
            part.probe.push_back(noisy.probe[i]);
        }
    }
    return part;
}

Blend chosen_on_patches(const ValueSurface& surface, const NoisyValues& noisy, const std::vector<std::uint8_t>& impulse,
                        const std::function<void(double)>& tick) {
    const Sample sample = patches_of(surface.faces, surface.positions, surface.near, patches, patch_size);
    const std::vector<double> weight = cotangent_weights(sample.faces, sample.at, sample.near, sample.positions);
    const TotalVariation variation(sample.near);
    std::vector<std::uint8_t> left_out(sample.core.size());
    for (std::size_t i = 0; i < left_out.size(); ++i) left_out[i] = !sample.core[i] || impulse[sample.vertex[i]];
    return chosen({sample.near, weight, variation}, part_of(noisy, sample.vertex), left_out, tick);
}

/// A blend's moves of one channel, and their response to the probe: #V by 3, the last is not used.
std::vector<double> channel_moves(const ValueMoves& all, int channel, int width) {
    std::vector<double> h(all.move.size() / width * 3, 0);
    for (std::size_t v = 0; v < h.size() / 3; ++v) {
        h[3 * v] = all.move[v * width + channel];
        h[3 * v + 1] = all.response[v * width + channel];
    }
    return h;
}

/// Moves the values, as far as they come nearer to the truth even if only what is white of what is taken out was noise:
/// a rough signal has details everywhere, too. The answer goes with the variance of the noise.
void apply(const ValueSurface& surface, const ValueCandidateMaker& maker, const Scaled& s,
           const std::vector<std::uint8_t>& impulse, int width, Blend& blend, std::vector<double>& values) {
    const std::size_t count = value_candidates().size();
    std::vector<std::uint8_t> wanted(count, 0), core(impulse.size());
    for (const Eigen::VectorXd& w : blend.weights)
        for (std::size_t k = 0; k < count; ++k) wanted[k] |= w[static_cast<Eigen::Index>(k)] > 0;
    if (std::count(wanted.begin(), wanted.end(), 1) == 0) return;
    ValueMoves all{std::vector<double>(s.noisy.values.size(), 0), std::vector<double>(s.noisy.values.size(), 0)};
    maker.make(s.noisy, wanted, [&](std::size_t k, const ValueMoves& moves) {
        parallel_for(static_cast<Index>(impulse.size()), [&](Index v) {
            for (int a = 0; a < s.noisy.width; ++a) {
                const double weight = blend.weights[a][static_cast<Eigen::Index>(k)];
                const std::size_t i = static_cast<std::size_t>(v) * s.noisy.width + a;
                all.move[i] += weight * moves.move[i];
                all.response[i] += weight * moves.response[i];
            }
        });
    });
    for (std::size_t i = 0; i < core.size(); ++i) core[i] = !impulse[i];
    const auto detail = [&](const std::vector<double>& h) { return field_details(surface.near, surface.weight, h); };
    for (int a = 0; a < s.noisy.width; ++a) {
        if (!(blend.moved[a] > 0)) continue;
        const double white = white_share_removed(detail, surface.near, channel_moves(all, a, s.noisy.width), core);
        const double safe = std::clamp(2 * white * blend.answer[a] / blend.moved[a], 0.0, 1.0);
        blend.keep(a, safe);
        for (std::size_t v = 0; v < core.size(); ++v)
            values[v * width + s.channel[a]] += safe * s.scale[a] * all.move[v * s.noisy.width + a];
    }
}

void report_blend(const Scaled& s, const Blend& blend, int width, DenoisedValues& out) {
    const std::vector<ValueCandidate> all = value_candidates();
    double before = 0, after = 0;
    for (int a = 0; a < s.noisy.width; ++a) {
        before += blend.risk_before[a] * s.scale[a] * s.scale[a] / width;
        after += blend.risk_after[a] * s.scale[a] * s.scale[a] / width;
        for (std::size_t k = 0; k < all.size(); ++k) {
            double& share = all[k].family == ValueFamily::low_pass || all[k].family == ValueFamily::average
                                ? out.low_pass
                            : all[k].family == ValueFamily::wiener ? out.wiener
                                                                   : out.total_variation;
            share += blend.weights[a][static_cast<Eigen::Index>(k)] / s.noisy.width;
        }
    }
    for (int a = 0; a < s.noisy.width; ++a) out.noise[s.channel[a]] *= std::sqrt(blend.correction[a]);
    out.rms_before = std::hypot(out.rms_before, std::sqrt(before));
    out.rms_after = std::hypot(out.rms_after, std::sqrt(after));
}

/// Of values that were rounded, whose noise is known.
void smooth_steps(const ValueSurface& surface, const std::vector<double>& channel, double step, int c, int width,
                  DenoisedValues& out) {
    const std::vector<double> smooth = within_steps(surface.near, channel, step);
    for (std::size_t v = 0; v < channel.size(); ++v) out.values[v * width + c] += smooth[v] - channel[v];
    out.noise[c] = step / std::sqrt(12.0);
    out.step = std::max(out.step, step);
    // What is left of it is not known; no value leaves the step that the truth lies in.
    const double squares = out.noise[c] * out.noise[c] / width;
    out.rms_before = std::hypot(out.rms_before, std::sqrt(squares));
    out.rms_after = std::hypot(out.rms_after, std::sqrt(squares));
}

/// @param deviation  #V: of the noise where it is not rounding, in units of its root mean square; may be empty
void report_range(const std::vector<double>& deviation, DenoisedValues& out) {
    out.smallest_noise = out.largest_noise = rms(out.noise);
    if (deviation.empty()) return;
    const auto [least, most] = std::minmax_element(deviation.begin(), deviation.end());
    out.smallest_noise *= *least;
    out.largest_noise *= *most;
}

}  // namespace

ValueSurface::ValueSurface(const Mesh& mesh)
    : ValueSurface(mesh, vertex_faces(mesh.faces, static_cast<Index>(mesh.positions.size()))) {}

ValueSurface::ValueSurface(const Mesh& mesh, const Incidence& at)
    : faces(mesh.faces), positions(mesh.positions), near(neighbours(mesh.faces, at)), variation(near) {
    weight = cotangent_weights(mesh.faces, at, near, mesh.positions);
    normal = vertex_normals(mesh.faces, mesh.positions);
    bend.assign(mesh.positions.size(), 0);
    parallel_for(near.rows(), [&](Index v) {
        Vec3 sum = Vec3::Zero();
        for (Index k = near.offset[v]; k < near.offset[v + 1]; ++k)
            sum += weight[k] * (mesh.positions[near.vertex[k]] - mesh.positions[v]);
        bend[v] = std::abs(sum.dot(normal[v]));
    });
}

DenoisedValues denoise_values(const ValueSurface& surface, const std::vector<double>& values, int width,
                              double strength, double rounding, const std::function<void(double)>& tick) {
    DenoisedValues out;
    out.values = values;
    out.noise.assign(width, 0);
    if (!(strength > 0) || rows_are_equal(values, width)) return out;
    const ValueImpulses repaired = without_impulses(surface, values, width);
    out.impulses = repaired.count;
    out.values = repaired.values;
    tick(0.1);
    std::vector<std::vector<double>> local(width);
    std::vector<double> channel(values.size() / width), moved(values.size());
    for (std::size_t i = 0; i < moved.size(); ++i) moved[i] = out.values[i] - values[i];
    out.rms_before = rms(moved);
    for (int c = 0; c < width; ++c) {
        for (std::size_t v = 0; v < channel.size(); ++v) channel[v] = out.values[v * width + c] - out.values[c];
        const double step = rounding_step(surface.near, channel);
        if (step > 2 * rounding) {
            smooth_steps(surface, channel, step, c, width, out);
            local[c].assign(channel.size(), 0);
            continue;
        }
        local[c] = local_field_noise(surface.near, surface.weight, surface.positions, channel);
        if (!(rms(local[c]) > rounding)) local[c].assign(channel.size(), 0);
        const double found = rms(local[c]), most = most_noise_of_values(channel, found);
        if (most < found)
            for (double& d : local[c]) d *= most / found;
        out.noise[c] = rms(local[c]);
        for (double& d : local[c]) d *= strength;
    }
    tick(0.2);
    const Scaled s = scaled(out.values, width, local);
    report_range(s.noisy.deviation, out);
    if (s.noisy.width == 0) return out;
    const ValueCandidateMaker maker(surface.near, surface.weight, surface.variation);
    const auto choosing = [&](double f) { tick(0.2 + 0.6 * f); };
    Blend blend = surface.near.rows() > 2 * patches * patch_size
                      ? chosen_on_patches(surface, s.noisy, repaired.impulse, choosing)
                      : chosen(maker, s.noisy, repaired.impulse, choosing);
    apply(surface, maker, s, repaired.impulse, width, blend, out.values);
    report_blend(s, blend, width, out);
    report_range(s.noisy.deviation, out);
    return out;
}

}  // namespace multires
