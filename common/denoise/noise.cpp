#include "denoise/noise.h"

#include "base/parallel.h"
#include "denoise/edge_fit.h"
#include "denoise/energies.h"
#include "denoise/white_share.h"
#include "measure/vertex_normals.h"

#include <algorithm>
#include <cmath>

namespace multires {
namespace {

constexpr double spread = 3.5;         ///< see quiet_energy()
constexpr double leak = 0.3;           ///< share of the bends along edges that passes for noise in third differences
constexpr Index coarse_up_to = 25000;  ///< vertices; of larger meshes the edges are not asked, for time
constexpr int bend_steps = 3;          ///< Taubin's steps after which first differences show bends and hardly any noise

/// 1 for energies that shape could have, 0 for those of strong noise, beside which texture is nothing.
double weakness(double energy, double edge) { return std::clamp((0.1 - std::sqrt(energy) / edge) / 0.07, 0.0, 1.0); }

/// Of white noise that is everywhere: see surface_noise(). The spread that the sample of the mesh has by itself counts
/// for nothing.
double quiet_energy(const Energies& e, double edge) {
    const double low = e.quantile(0.1);
    if (!(low > 0)) return 0;
    const double by_chance = 0.05 + 3 / std::sqrt(static_cast<double>(e.field.size()));
    return low * std::max(0.0, 1 - weakness(low, edge) * spread * std::max(0.0, e.quantile(0.3) / low - 1 - by_chance));
}

struct Smoothed {
    Positions positions;
    Array<Vec3> normal;
};

Smoothed smoothed(const Faces& faces, const Positions& p, const Neighbours& near, int steps) {
    Smoothed s;
    s.positions = taubin(near, p, steps);
    s.normal = vertex_normals(faces, s.positions);
    return s;
}

/// Vertices that are not on a rim; if there are none, all that have neighbours.
/// @param silent  #V: vertices that tell nothing; empty: none
std::vector<Index> inner_vertices(const Neighbours& near, const std::vector<std::uint8_t>& silent = {}) {
    std::vector<Index> inner;
    for (const bool with_rim : {false, true}) {
        for (Index v = 0; v < near.rows(); ++v)
            if (near.size(v) > 0 && (!near.rim[v] || with_rim) && (silent.empty() || !silent[v])) inner.push_back(v);
        if (!inner.empty()) break;
    }
    return inner;
}

/// What the details say, all but the last squared mesh units.
struct Findings {
    double quiet_first = 0, quiet_third = 0;  ///< energies that are there everywhere; first details hold bends, too
    double without_bends = 0;                 ///< see energies.h
    double mean = 0, median = 0;              ///< of the third details
    double lower = 0, low = 0;                ///< what three tenths, and one tenth, of them stay below
    double peakedness = 0;                    ///< of the third details
    double quiet_peakedness = 0;              ///< of those of three tenths
    double low_fifth = 0;                     ///< what one tenth of the fifth details stay below
    double white = 1;                         ///< share of the third details: see white_share()
    std::optional<AxisNoise> axis;
    double peakedness_along_axis = 0;  ///< of the third details, beside noise along the axis
};

/// Sum of the squares of the details of the samples of noise.
double noise_energy(const std::vector<double>& detail, const std::vector<Index>& inner) {
    double sum = 0;
    for (const Index v : inner)
        for (int c = 1; c < 3; ++c) sum += detail[3 * v + c] * detail[3 * v + c];
    return sum;
}

/// How white third details are beside fifth ones, see white_share(), gathered over samples of noise.
struct Whiteness {
    std::array<double, 2> third{}, fifth{};  ///< energies that a tenth and half of the surface stay below
    double falls = 0;
    int samples = 0;

    void add(const AlongNormals& surface, const Neighbours& near, const std::vector<Index>& inner,
             const std::vector<double>& second, const std::vector<double>& thirds, const Energies& energy) {
        const std::vector<double> fourth = surface.linear_detail(thirds), fifths = surface.linear_detail(fourth);
        const Energies fine = local_energies(near, local_squares(near, fifths), inner);
        constexpr std::array<double, 2> share = {0.1, 0.5};
        for (std::size_t q = 0; q < share.size(); ++q) {
            third[q] += energy.quantile(share[q]);
            fifth[q] += fine.quantile(share[q]);
        }
        falls += noise_energy(fourth, inner) / noise_energy(fifths, inner) * noise_energy(thirds, inner) /
                 noise_energy(second, inner);
        ++samples;
    }
    double share() const {
        return std::max(white_share(third[0], fifth[0], falls / samples),
                        white_share(third[1], fifth[1], falls / samples));
    }
};

/// Small meshes are compared with several samples of noise.
/// @param steps  that smooth the normals
Findings findings(const Faces& faces, const Positions& p, const Incidence& at, const Neighbours& near, double edge,
                  int steps, const std::vector<std::uint8_t>& silent = {}) {
    const Smoothed base = smoothed(faces, p, near, steps);
    const AlongNormals surface(near, p, base.normal, cotangent_weights(faces, at, near, base.positions));
    const std::vector<Index> inner = inner_vertices(near, silent);
    const int repeats = std::clamp(20000 / std::max(1, near.rows()), 1, 8);
    Findings mean;
    Whiteness whiteness;
    for (int repeat = 0; repeat < repeats; ++repeat) {
        std::vector<double> h(3 * near.rows(), 0);
        parallel_for(near.rows(), [&](Index v) {
            for (int c = 1; c < 3; ++c) h[3 * v + c] = gaussian(v, 100 + 2 * repeat + c);
        });
        const std::vector<double> first = surface.detail(h);
        const std::vector<double> second = surface.linear_detail(first), third = surface.linear_detail(second);
        surface.smooth(h, bend_steps);
        const std::vector<double> squares = local_squares(near, third);
        const Energies energy = local_energies(near, squares, inner);
        mean.quiet_first += quiet_energy(local_energies(near, local_squares(near, first), inner), edge) / repeats;
        mean.quiet_third += quiet_energy(energy, edge) / repeats;
        whiteness.add(surface, near, inner, second, third, energy);
        const Energies bends = local_energies(near, local_squares(near, surface.detail(h)), inner);
        mean.without_bends += without_bends(energy, bends) / repeats;
        if (repeat == 0) mean.axis = axis_noise(near, p, base.normal, inner);
        mean.mean += energy.mean() / repeats;
        mean.median += energy.quantile(0.5) / repeats;
        mean.lower += energy.quantile(0.3) / repeats;
        mean.low += energy.quantile(0.1) / repeats;
        mean.peakedness += peakedness(third, squares, inner) / repeats;
        mean.quiet_peakedness += peakedness(third, squares, inner, energy, 0.3) / repeats;
    }
    mean.low_fifth = whiteness.fifth[0] / repeats;
    mean.white = whiteness.share();
    if (mean.axis) {
        std::vector<double> h(3 * near.rows(), 0);
        parallel_for(near.rows(), [&](Index v) {
            for (int c = 1; c < 3; ++c) h[3 * v + c] = gaussian(v, 100 + c) * base.normal[v].dot(mean.axis->axis);
        });
        const std::vector<double> third = surface.linear_detail(surface.linear_detail(surface.detail(h)));
        mean.peakedness_along_axis = peakedness(third, local_squares(near, third), inner);
    }
    return mean;
}

/// Deviation by the quietest places.
double quiet_deviation(const Findings& f, Index vertices, double edge) {
    const double bends = weakness(f.quiet_third, edge) * leak * leak * std::max(0.0, f.quiet_first - f.quiet_third);
    double deviation = std::sqrt(std::max(0.0, f.quiet_third - bends));
    deviation *= 1 + 0.12 * std::min(0.5, deviation / edge);  // noise tilts the normals that it is measured along
    // Weak noise is taken for less where few vertices speak for it: too much would harm more than too little.
    const double few = std::min(0.3, 4 / std::sqrt(static_cast<double>(vertices)));
    return deviation * (1 - few * std::max(0.0, 1 - deviation / (0.07 * edge)));
}

/// 1 up to a tenth of the edges, 0 from two tenths on.
double weak(double deviation, double edge) { return std::clamp(2 - deviation / (0.1 * edge), 0.0, 1.0); }

/// From the quietest places' to that of all vertices, as far as they agree, otherwise the smaller; but tenths of few
/// vertices do not tell much of strong noise.
double agreed(double quiet, double all, Index vertices, double edge) {
    if (all > quiet) return quiet + (all - quiet) * std::clamp((quiet / all - 0.8) / 0.1, 0.0, 1.0);
    return quiet + (all - quiet) * std::max(weak(quiet, edge), std::min(1.0, vertices / 4000.0));
}

/// Fifth details have less of the shape than third ones and as much of the noise: what falls between them says how much
/// is left. That errs for other reasons than the deviation found so far, so weak noise is the mean of both, but not
/// less: at creases, and by chance on few vertices, more may fall. Meshes that are hardly wider than the ten edges that
/// fifth details are have nothing to say.
/// @param most  that third details say
double with_fifth(double deviation, double most, const Findings& f, Index vertices, double edge) {
    constexpr double left_by_fallen = 2.2;
    constexpr Index enough = 500;
    if (vertices < enough) return deviation;
    const double fallen = std::max(0.0, f.low - f.low_fifth), square = deviation * deviation;
    const double by_fifth = std::min(f.low_fifth - left_by_fallen * fallen, most * most);
    return deviation > 0 ? std::sqrt(square + weak(deviation, edge) / 2 * std::max(0.0, by_fifth - square)) : 0;
}

/// Certainty that details are noise: shape has peaks.
double like_noise(double peakedness) {
    constexpr double gaussian_up_to = 1.04, not_from = 1.075;
    return std::clamp((not_from - peakedness) / (not_from - gaussian_up_to), 0.0, 1.0);
}

/// Least square of the deviation. Details elsewhere may be creases, which noise of some strength cannot be taken for:
/// then three tenths of the surface tell enough.
double least_square(double square, const Findings& f, Index vertices, double edge) {
    constexpr double elsewhere = 0.5;
    const double by_chance = std::max(0.5, 1 - 6 / std::sqrt(static_cast<double>(vertices)));
    const double weak = std::clamp((0.05 - std::sqrt(square) / edge) / 0.01, 0.0, 1.0);
    const double others = f.lower + weak * (f.mean - f.lower);
    const double like = std::max(like_noise(f.peakedness), (1 - weak) * like_noise(f.quiet_peakedness));
    return like * std::max(0.0, by_chance * square - elsewhere * std::max(0.0, others - square));
}

/// Details that are not white are those of creases, of which more must speak for an axis, or of terrain, which is rough
/// along an axis by nature.
bool by_nature(const Findings& f) {
    constexpr double least_white = 0.1, certain_share = 0.2, terrain = 0.5;
    return f.white < least_white && (f.axis->one_side > terrain || std::abs(f.axis->share - 1) > certain_share);
}

/// Noise along an axis is as certain as the kind of the energies.
void add_axis(const Findings& f, const Array<Vec3>& normal, SurfaceNoise& noise) {
    constexpr double certain = 0.7;
    if (!f.axis || !(f.axis->deviation > noise.along_normals) || by_nature(f)) return;
    noise.axis = f.axis;
    noise.along_normals = std::min(noise.along_normals, f.axis->across);
    // What is across beyond the noise is shape's, which is not along the axis alone.
    const double shape = std::pow(f.axis->across, 2) - std::pow(noise.along_normals, 2);
    noise.axis->deviation = std::sqrt(std::pow(f.axis->deviation, 2) - shape);
    double square = 0;
    for (const Vec3& n : normal) square += std::pow(noise.along(n), 2) / static_cast<double>(normal.size());
    noise.at_least = std::max(noise.at_least, std::sqrt(certain * like_noise(f.peakedness_along_axis) * square));
}

/// Leaves out what the edges know of. The less there is left the less certain it is.
void leave_shape(const Faces& faces, const Positions& positions, const Neighbours& near, const Array<Vec3>& normal,
                 SurfaceNoise& noise) {
    if (!(noise.along_normals > 0 || noise.axis)) return;
    std::vector<double> deviation(normal.size());
    for (std::size_t v = 0; v < deviation.size(); ++v) deviation[v] = noise.along(normal[v]);
    noise.by_edges = share_of_noise_by_edges(faces, positions, near, deviation);
    const double factor = std::sqrt(noise.by_edges);
    noise.along_normals *= factor;
    noise.at_least *= noise.by_edges * factor;
    if (noise.axis) noise.axis->deviation *= factor, noise.axis->across *= factor;
}

/// Energies of the parts of details within the surface, beside those of noise.
Energies energies_within(const Positions& detail, const Positions& noise, const Neighbours& near,
                         const Array<Vec3>& normal) {
    std::vector<double> sizes(3 * near.rows());
    parallel_for(near.rows(), [&](Index v) {
        const double along = normal[v].dot(detail[v]);
        sizes[3 * v] = std::sqrt(std::max(0.0, (detail[v].squaredNorm() - along * along) / 2));
        sizes[3 * v + 1] = noise[v].x();
        sizes[3 * v + 2] = noise[v].y();
    });
    return local_energies(near, local_squares(near, sizes), inner_vertices(near));
}

/// What third details within the surface tell of noise there. If they have just the energy of the noise along the
/// normals, from the quietest tenth to the middle of the surface, they are likely to be noise: a sampling that is
/// irregular by nature is mostly so by another amount, and not by the same everywhere. If that is so up to the loudest
/// tenth there is hardly a doubt, but for few vertices, of which tenths are smaller than what energies are means of.
/// Where they have more, the rest is the sampling's: a rest that varies more over the surface than samplings do says
/// that there is no such noise.
/// @param relative  of the noise at each vertex, by along_normals; empty: 1
void find_within_surface(const Positions& p, const Neighbours& near, const Array<Vec3>& normal,
                         const std::vector<double>& relative, SurfaceNoise& found) {
    constexpr double least = 0.93, most = 1.15, even = 1.09;
    constexpr double variation = 3, by_chance = 0.12;  // of the rests' squares
    constexpr Index many = 1000;
    Positions noise(p.size());
    parallel_for(near.rows(), [&](Index v) {
        noise[v] = (relative.empty() ? 1 : relative[v]) * Vec3(gaussian(v, 3), gaussian(v, 4), 0);
    });
    Positions detail = p;
    for (int order = 0; order < 3; ++order) {
        detail = detail_of(near, detail);
        noise = detail_of(near, noise);
    }
    const Energies third = energies_within(detail, noise, near, normal);
    found.within_surface = std::sqrt(third.quantile(0.1));
    found.maybe_all = found.axis.has_value();  // it is known to cross the surface
    if (found.axis || !(found.along_normals > 0)) return;
    const double square = found.along_normals * found.along_normals;
    const double low = third.quantile(0.1) / square, middle = third.quantile(0.5) / square;
    found.likely_all = low > least * least && low < most * most && middle < even * even * low;
    found.surely_all = found.likely_all && near.rows() >= many && third.quantile(0.9) < even * even * low * square;
    found.maybe_all = low > least * least && middle - 1 < variation * std::max(0.0, low - 1) + by_chance;
}

}  // namespace

double SurfaceNoise::along(const Vec3& normal) const {
    const double own = along_normals * along_normals;
    if (!axis) return along_normals;
    const double across = normal.dot(axis->axis);
    return std::sqrt(own + std::max(0.0, axis->deviation * axis->deviation - own) * across * across);
}

SurfaceNoise surface_noise(const Faces& faces, const Positions& positions, const Incidence& at, const Neighbours& near,
                           double edge) {
    SurfaceNoise noise;
    if (near.rows() == 0 || faces.empty() || !(edge > 0)) return noise;
    Findings found = findings(faces, positions, at, near, edge, 3);
    // Strong noise needs smoother normals.
    if (std::sqrt(found.mean) > 0.12 * edge) found = findings(faces, positions, at, near, edge, 8);
    const double quiet = quiet_deviation(found, near.rows(), edge), all = std::sqrt(found.without_bends);
    const double of_third = agreed(quiet, all, near.rows(), edge);
    const double deviation = with_fifth(of_third, std::max({of_third, quiet, all}), found, near.rows(), edge);
    noise.along_normals = deviation;
    noise.at_least = std::sqrt(least_square(deviation * deviation, found, near.rows(), edge));
    const Array<Vec3> normal = smoothed(faces, positions, near, 3).normal;
    noise.white = std::max(0.0, found.white - error_of_white_share(near.rows()));
    add_axis(found, normal, noise);
    find_within_surface(positions, near, normal, {}, noise);
    if (near.rows() <= coarse_up_to) leave_shape(faces, positions, near, normal, noise);
    return noise;
}

void find_varying_within_surface(const Faces& faces, const Positions& positions, const Neighbours& near,
                                 const std::vector<double>& deviation, SurfaceNoise& noise) {
    std::vector<double> relative = deviation;
    for (double& d : relative) d /= noise.along_normals;
    find_within_surface(positions, near, smoothed(faces, positions, near, 3).normal, relative, noise);
}

std::optional<SurfaceNoise> rounding_noise(const Faces& faces, const Positions& positions, const Incidence& at,
                                           const Neighbours& near, const std::vector<std::uint8_t>& even, double step,
                                           double edge) {
    constexpr double least = 0.2, most = 6;
    SurfaceNoise noise;
    noise.along_normals = noise.at_least = noise.within_surface = step / std::sqrt(12.0);
    noise.all_directions = true;
    const Findings found = findings(faces, positions, at, near, edge, noise.along_normals > 0.12 * edge ? 8 : 3, even);
    const double square = noise.along_normals * noise.along_normals;
    // Steps as large as the edges make terraces, which are even; small ones do not.
    const double nearly_everywhere = std::max(0.02, 0.5 - 2.5 * noise.along_normals / edge);
    if (!(found.median > least * square && found.lower < most * square)) return std::nullopt;
    if (!(found.low > nearly_everywhere * square)) return std::nullopt;
    return noise;
}

}  // namespace multires
