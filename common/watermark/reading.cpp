#include "watermark/reading.h"

#include "base/blocks.h"
#include "base/decompositions.h"
#include "base/error.h"
#include "base/median.h"
#include "base/random.h"
#include "measure/distance.h"
#include "measure/measure.h"
#include "measure/triangles.h"
#include "measure/vertex_normals.h"
#include "mesh/adjacency.h"
#include "watermark/placing.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <array>
#include <cmath>

namespace multires {
namespace {

constexpr int motions = 7, smoothings = 4, nuisances = motions + smoothings;
using NuisanceRow = Eigen::Matrix<double, nuisances, 1>;
using Moved = std::array<double, smoothings>;

/// A vertex of the mesh, seen from the original.
struct Sample {
    Vec3 foot = Vec3::Zero(), normal = Vec3::Zero();  ///< where it belongs on the original, and its direction
    double offset = 0, weight = 0;                    ///< along the normal; area, 0: not used
    NuisanceRow nuisance = NuisanceRow::Zero();
};

/// The original smoothed by 0, 1, 2, 4, ... half steps: every vertex moves half way to the mean of its neighbours.
constexpr std::array<int, 9> half_steps{0, 1, 2, 4, 8, 16, 32, 64, 128};
using Ladder = std::array<Positions, half_steps.size()>;

Ladder smoothed(const Mesh& mesh) {
    const Rings rings = vertex_rings(mesh);
    Ladder ladder;
    Positions now = mesh.positions, next = now;
    int step = 0;
    for (std::size_t k = 0; k < ladder.size(); ++k) {
        for (; step < half_steps[k]; ++step) {
            parallel_for(static_cast<Index>(now.size()), [&](Index i) {
                Vec3 sum = Vec3::Zero();
                for (Index j = 0; j < rings.size(i); ++j) sum += now[rings.begin(i)[j]];
                next[i] = rings.size(i) > 0 ? Vec3((now[i] + sum / rings.size(i)) / 2) : now[i];
            });
            now.swap(next);
        }
        ladder[k] = now;
    }
    return ladder;
}

/// What the mesh is compared with.
struct Reference {
    std::size_t rung = 0;
    Eigen::Affine3d placement = Eigen::Affine3d::Identity();  ///< of the mesh onto it
};

/// The rung that the mesh comes nearest to; a larger one must come nearer by a tenth.
Reference nearest_rung(const Mesh& mesh, const Mesh& original, const Ladder& ladder, const Progress& progress) {
    progress.report(0, "Laying the mesh onto the original");
    Reference best;
    const SurfaceTree tree(original.faces, original.positions);
    best.placement = similarity_onto(mesh, original, tree);
    constexpr Refinement quick{1000, 10};
    double least = refine_placement(mesh, original, tree, best.placement, quick);
    for (std::size_t k = 1; k < ladder.size(); ++k) {
        progress.report(0.4 + 0.6 * static_cast<double>(k) / ladder.size(), "Comparing with smoothed originals");
        const Mesh onto{ladder[k], original.faces};
        const SurfaceTree rung(onto.faces, onto.positions);
        Eigen::Affine3d placement = best.placement;
        const double left = refine_placement(mesh, onto, rung, placement, quick);
        if (left < 0.9 * least) least = left, best = {k, placement};
    }
    const Mesh onto{ladder[best.rung], original.faces};
    refine_placement(mesh, onto, SurfaceTree(onto.faces, onto.positions), best.placement);
    return best;
}

/// The four rungs next to one.
std::array<std::size_t, smoothings> next_to(std::size_t rung) {
    const std::size_t first = std::min(rung < 2 ? 0 : rung - 2, half_steps.size() - 1 - smoothings);
    std::array<std::size_t, smoothings> others{};
    for (std::size_t k = first, n = 0; n < smoothings; ++k)
        if (k != rung) others[n++] = k;
    return others;
}

class Sampler {
public:
    /// @param mesh  placed on the rung
    Sampler(const Mesh& mesh, const Mesh& original, const Ladder& ladder, std::size_t rung)
        : mesh_(mesh), original_(original), at_(ladder[rung]), tree_(original.faces, at_),
          normal_(vertex_normals(original.faces, at_)), moved_(at_.size()),
          area_(area_shares(mesh.faces, mesh.positions)) {
        const auto others = next_to(rung);
        for (std::size_t i = 0; i < at_.size(); ++i)
            for (int m = 0; m < smoothings; ++m) moved_[i][m] = normal_[i].dot(ladder[others[m]][i] - at_[i]);
        const Box box = bounding_box(original.positions);
        centre_ = box.center(), size_ = box.diagonal();
    }

    Sample at(Index vertex, Index& hint) const {
        Sample s;
        if (!(area_[vertex] > 0)) return s;
        const Vec3& p = mesh_.positions[vertex];
        const SurfaceTree::Hit hit = tree_.closest(p, hint);
        hint = hit.face;
        if (hit.squared > 4e-4 * size_ * size_) return s;
        const Face& f = original_.faces[hit.face];
        const Vec3 w = barycentric(hit.point, at_[f[0]], at_[f[1]], at_[f[2]]);
        for (int k = 0; k < 3; ++k) {
            s.foot += w[k] * original_.positions[f[k]];
            s.normal += w[k] * normal_[f[k]];
            for (int m = 0; m < smoothings; ++m) s.nuisance[motions + m] += w[k] * moved_[f[k]][m];
        }
        s.normal.normalize();
        s.offset = s.normal.dot(p - hit.point), s.weight = area_[vertex];
        const Vec3 arm = (hit.point - centre_) / size_;
        s.nuisance.head<motions>() << s.normal, arm.cross(s.normal), arm.dot(s.normal);
        return s;
    }

private:
    const Mesh &mesh_, &original_;
    const Positions& at_;
    SurfaceTree tree_;
    Array<Vec3> normal_;
    std::vector<Moved> moved_;
    std::vector<double> area_;
    Vec3 centre_;
    double size_ = 1;
};

/// Takes off the part of the offsets that the nuisances explain.
void remove_nuisances(std::vector<Sample>& samples) {
    Eigen::Matrix<double, nuisances, nuisances> a = Eigen::Matrix<double, nuisances, nuisances>::Zero();
    NuisanceRow b = NuisanceRow::Zero();
    for (const Sample& s : samples) {
        a += s.weight * s.nuisance * s.nuisance.transpose();
        b += s.weight * s.offset * s.nuisance;
    }
    NuisanceRow unit = a.diagonal().cwiseSqrt();
    for (int k = 0; k < nuisances; ++k) unit[k] = unit[k] > 0 ? 1 / unit[k] : 0;
    a = unit.asDiagonal() * a * unit.asDiagonal();
    a.diagonal().array() += 1e-9;
    const NuisanceRow part = unit.asDiagonal() * solve_symmetric(a, unit.asDiagonal() * b);
    for (Sample& s : samples) s.offset -= part.dot(s.nuisance);
}

/// Offsets beyond three deviations become that; of a normal distribution the deviation is 1.48 medians.
void cut_outliers(std::vector<Sample>& samples) {
    std::vector<double> size(samples.size());
    std::transform(samples.begin(), samples.end(), size.begin(), [](const Sample& s) { return std::abs(s.offset); });
    const double most = 3 * 1.4826 * upper_median(size);
    for (Sample& s : samples) s.offset = std::clamp(s.offset, -most, most);
}

/// The noise is taken for a tenth of the signal, which is right for none and harms none: what matters is that carriers
/// with little to read are not blown up.
constexpr double assumed_noise = 0.1;

void estimate(const std::vector<Sample>& samples, const Carriers& carriers, CarrierValues& result) {
    const Index n = carriers.size();
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n, n);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(n);
    std::vector<std::pair<Index, double>> row;
    for (const Sample& s : samples) {
        row.clear();
        carriers.visit(
            s.foot, [&](Index c, double value) { row.emplace_back(c, value * carriers.direction(c).dot(s.normal)); });
        for (const auto& [c, value] : row) {
            b[c] += s.weight * s.offset * value;
            for (const auto& [d, other] : row) a(d, c) += s.weight * value * other;
        }
    }
    const double noise = assumed_noise * a.trace() / n;
    result.value.assign(n, 0), result.share.assign(n, 0);
    if (!(noise > 0)) return;  // a sheet with two sides has no normals
    a.diagonal().array() += noise;
    const Eigen::LLT<Eigen::MatrixXd> llt(a);
    const Eigen::VectorXd x = llt.solve(b);
    const Eigen::MatrixXd inverse = llt.solve(Eigen::MatrixXd::Identity(n, n));
    Index seen = 0;
    for (Index c = 0; c < n; ++c) {
        const double share = std::clamp(1 - noise * inverse(c, c), 0.0, 1 - 1e-9);
        result.value[c] = x[c], result.share[c] = share;
        if (share > 0.3) ++seen;
    }
    result.seen = static_cast<double>(seen) / n;
}

/// The values of the carriers of each bit of the code, weighted by how sure they are; twice these over the ratio of
/// noise to signal are log odds.
CodeValues gathered(const CarrierValues& values, const Assignment& key) {
    CodeValues sum{};
    for (std::size_t c = 0; c < values.value.size(); ++c)
        sum[key.bit[c]] += key.sign[c] * values.value[c] / (1 - values.share[c]);
    return sum;
}

/// What wrong keys would give.
struct Chance {
    double mean = 0, deviation = 0;

    explicit Chance(const CarrierValues& values) {
        constexpr int keys = 500;
        double sum = 0, squares = 0;
        for (int k = 0; k < keys; ++k) {
            const double best = best_correlation(gathered(values, random_assignment(random_bits(k))));
            sum += best, squares += best * best;
        }
        mean = sum / keys;
        deviation = std::sqrt(std::max(0.0, squares / keys - mean * mean));
    }
    double of_more_than(double best) const {
        return deviation > 0 ? std::erfc((best - mean) / (deviation * std::sqrt(2.0))) / 2 : 1;
    }
};

Message signs(const std::array<double, message_bits>& odds) {
    Message m;
    for (int i = 0; i < message_bits; ++i) m[i] = odds[i] < 0 ? 1 : 0;
    return m;
}

/// Factor that makes gathered() log odds: signal and noise are those that a code word leaves.
double odds_factor(const CarrierValues& values, const Assignment& key, const CodeWord& word) {
    double signal = 0, information = 0, squares = 0, information_squared = 0;
    for (std::size_t c = 0; c < values.value.size(); ++c) {
        const double z = key.sign[c] * values.value[c] / (1 - values.share[c]);
        const double i = values.share[c] / (1 - values.share[c]);  // z has the mean i x signal, and variance ~ i
        signal += word[key.bit[c]] * z;
        information += i;
        information_squared += i * i;
        squares += z * z;
    }
    if (!(information > 0)) return 0;
    signal /= information;
    const double left = (squares - signal * signal * information_squared) / information;
    const double noise = std::max(left, 1e-3 * signal * signal);
    return noise > 0 ? 2 * signal / noise : 0;
}

}  // namespace

CarrierValues read_carriers(const Mesh& mesh, const Mesh& original, const Carriers& carriers,
                            const Progress& progress) {
    const Ladder ladder = smoothed(original);
    const Reference reference = nearest_rung(mesh, original, ladder, progress.part(0, 0.7));
    Mesh placed = mesh;
    for (Vec3& p : placed.positions) p = reference.placement * p;
    const Sampler sampler(placed, original, ladder, reference.rung);
    std::vector<Sample> samples(mesh.positions.size());
    parallel_blocks(static_cast<Index>(samples.size()), progress.part(0.7, 0.9), "Measuring offsets",
                    [&](Index begin, Index end) {
                        Index hint = -1;
                        for (Index i = begin; i < end; ++i) samples[i] = sampler.at(i, hint);
                    });
    samples.erase(std::remove_if(samples.begin(), samples.end(), [](const Sample& s) { return !(s.weight > 0); }),
                  samples.end());
    require(!samples.empty(), "original: the mesh is nowhere near it");
    CarrierValues result;
    result.scale = std::cbrt(std::abs(reference.placement.linear().determinant()));
    result.smoothing = half_steps[reference.rung] / 2.0;
    remove_nuisances(samples);
    double squares = 0, weight = 0;
    for (const Sample& s : samples) squares += s.weight * s.offset * s.offset, weight += s.weight;
    result.rms_offset = std::sqrt(squares / weight);
    cut_outliers(samples);
    progress.report(0.9, "Fitting the carriers");
    estimate(samples, carriers, result);
    return result;
}

Reading decode(const CarrierValues& values, const Assignment& key) {
    Reading reading;
    const CodeValues sum = gathered(values, key);
    const Chance chance(values);
    reading.probability_unmarked = chance.of_more_than(best_correlation(sum));

    // A first guess with odds of a usual size, then twice with those that the guess leaves.
    double squares = 0;
    for (const double s : sum) squares += s * s;
    double factor = squares > 0 ? 2 / std::sqrt(squares / code_bits) : 0;
    std::array<double, message_bits> odds{};
    for (int round = 0; round < 3; ++round) {
        CodeValues log_odds;
        for (int i = 0; i < code_bits; ++i) log_odds[i] = std::clamp(factor * sum[i], -50.0, 50.0);
        odds = decoded(log_odds);
        reading.message = signs(odds);
        factor = std::max(odds_factor(values, key, encoded(reading.message)), 0.0);
    }
    // The odds that there is a mark are at most -1 / (e p log p) (Sellke, Bayarri and Berger 2001); without one, a bit
    // is right as often as not.
    const double p = std::max(reading.probability_unmarked, 1e-300);
    const double against = p < std::exp(-1.0) ? -std::exp(1.0) * p * std::log(p) : 1;
    const double none = p < std::exp(-1.0) ? against / (1 + against) : 1;
    for (const double o : odds) {
        const double right = 1 / (1 + std::exp(-std::abs(o)));
        reading.confidence.push_back((1 - none) * right + none / 2);
    }
    return reading;
}

}  // namespace multires
