#include "pyramid/band.h"

#include "base/error.h"
#include "measure/measure.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace multires {
namespace {

/// A limit as octaves of wavelength, finer = smaller, so that all units share one axis.
class Axis {
public:
    Axis(const std::vector<LevelInfo>& levels, Unit unit, double diagonal)
        : levels_(levels), unit_(unit), diagonal_(diagonal) {}

    double octave(double limit) const {
        switch (unit_) {
        case Unit::wavelength:
            return std::log2(limit);
        case Unit::wavelength_percent:
            return std::log2(limit / 100 * diagonal_);
        case Unit::level:
            return at_level(limit);
        case Unit::vertices:
            return at_level(level_with(limit));
        }
        return 0;
    }

    double at_level(double level) const {
        const double last = static_cast<double>(levels_.size() - 1);
        if (level <= 0) return of(0);
        if (level >= last) return of(levels_.size() - 1);
        const std::size_t k = static_cast<std::size_t>(level);
        return of(k) + (level - static_cast<double>(k)) * (of(k + 1) - of(k));
    }

private:
    double of(std::size_t k) const { return std::log2(std::max(levels_[k].wavelength, 1e-300)); }

    /// The level (with a fraction, in the logarithm) that has so many vertices.
    double level_with(double vertices) const {
        std::size_t k = 0;
        while (k + 1 < levels_.size() && levels_[k + 1].vertices >= vertices) ++k;
        if (vertices >= levels_[0].vertices) return 0;
        if (k + 1 == levels_.size()) return static_cast<double>(k);
        const double n = levels_[k].vertices, m = levels_[k + 1].vertices;
        return static_cast<double>(k) + std::log(n / vertices) / std::log(n / m);
    }

    const std::vector<LevelInfo>& levels_;
    Unit unit_;
    double diagonal_;
};

/// Integral from minus infinity to x of a smooth step of width `soft` around 0, from 0 to 1.
double ramp(double x, double soft) {
    if (soft <= 0) return std::max(0.0, x);
    const double t = x / soft + 0.5;
    if (t <= 0) return 0;
    if (t >= 1) return x;
    return soft * (t * t * t - t * t * t * t / 2);  // integral of 3t^2 - 2t^3
}

/// Mean over [a, b] of the step at `edge`.
double mean_step(double a, double b, double edge, double soft) {
    if (b - a < 1e-9) return a + b > 2 * edge ? 1 : a + b < 2 * edge ? 0 : 0.5;
    return (ramp(b - edge, soft) - ramp(a - edge, soft)) / (b - a);
}

/// The layer's finest wavelength in a unit of wavelength; others have no use for it.
double finest_wavelength(const Layer& layer, Unit unit) {
    if (unit != Unit::wavelength && unit != Unit::wavelength_percent) return 0;
    const double finest = 2 * mean_edge_length(layer.mesh.faces, layer.mesh.positions);
    if (unit == Unit::wavelength) return finest;
    const double diagonal = box_diagonal(layer);
    return diagonal > 0 ? 100 * finest / diagonal : 0;
}

/// A wavelength of `times` the layer's finest one in a unit. A set of an independent-set pyramid removes about a
/// quarter of the vertices, so an octave of wavelength (a quarter of the vertices left) is 4.8 levels.
double in_unit(const Layer& layer, double finest, double times, Unit unit) {
    switch (unit) {
    case Unit::wavelength:
    case Unit::wavelength_percent:
        return times * finest;
    case Unit::level:
        return std::round(2 * 4.8 / PyramidOptions().hierarchy.sets_per_level * std::log2(times)) / 2;
    case Unit::vertices:
        return std::round(static_cast<double>(layer.mesh.positions.size()) / (times * times));
    }
    return 0;
}

/// `most` times the finest wave, or less where a small mesh has no room for it: `share` of the octaves it has.
double times_finest(const Layer& layer, double most, double share) {
    const double vertices = static_cast<double>(layer.mesh.positions.size());
    const double room = std::sqrt(std::max(1.5, vertices / PyramidOptions().hierarchy.base_vertices));
    return std::min(most, std::pow(room, share));
}

}  // namespace

void check(const Band& band, double diagonal) {
    const bool vertices = band.unit == Unit::vertices;
    if (!(std::isfinite(band.finest) && std::isfinite(band.coarsest)))
        throw InputError("finest and coarsest must be numbers");
    if (!(band.softness >= 0 && std::isfinite(band.softness)))
        throw InputError("softness must be a number of octaves, 0 or more");
    if (band.finest < 0 || band.coarsest < 0) throw InputError("finest and coarsest must not be negative");
    if (vertices ? band.finest <= band.coarsest : band.finest >= band.coarsest)
        throw InputError(vertices ? "finest must be more vertices than coarsest"
                                  : "finest must be less than coarsest (level 0 and short waves are the finest)");
    if (band.unit == Unit::wavelength_percent && !(diagonal > 0)) throw InputError("the bounding box has no size");
}

double wavelength_of(const Pyramid& pyramid, Unit unit, double limit) {
    return std::exp2(Axis(pyramid.levels(), unit, 0).octave(limit));
}

Band default_band(const Layer& layer, Unit unit) {
    Band band;
    band.unit = unit;
    const double finest = finest_wavelength(layer, unit);
    band.finest = in_unit(layer, finest, times_finest(layer, 2, 0.25), unit);
    band.coarsest = in_unit(layer, finest, times_finest(layer, 8, 0.75), unit);
    return band;
}

double default_cutoff(const Layer& layer, Unit unit) {
    return in_unit(layer, finest_wavelength(layer, unit), times_finest(layer, 4, 0.5), unit);
}

std::vector<double> band_share(const std::vector<LevelInfo>& levels, const Band& band, double diagonal) {
    check(band, diagonal);
    const Axis axis(levels, band.unit, diagonal);
    const double none = -std::numeric_limits<double>::infinity();
    // Limits at or beyond the ends leave out nothing: 0 is "as fine as there is".
    const bool from_finest = band.unit == Unit::vertices ? band.finest >= levels[0].vertices : band.finest <= 0;
    const bool to_coarsest = (band.unit == Unit::vertices && band.coarsest <= levels.back().vertices) ||
                             (band.unit == Unit::level && band.coarsest >= static_cast<double>(levels.size() - 1));
    const double low = from_finest ? none : axis.octave(band.finest);
    const double high = to_coarsest ? -none : axis.octave(band.coarsest);
    const std::size_t count = levels.size() - 1;
    std::vector<double> share(count);
    for (std::size_t k = 0; k < count; ++k) {
        const double a = axis.at_level(static_cast<double>(k)), b = axis.at_level(static_cast<double>(k + 1));
        const double above_low = low == none ? 1 : mean_step(a, b, low, band.softness);
        const double above_high = high == -none ? 0 : mean_step(a, b, high, band.softness);
        share[k] = std::clamp(above_low - above_high, 0.0, 1.0);
    }
    return share;
}

std::vector<double> band_share(const Pyramid& pyramid, const Band& band, double diagonal) {
    return band_share(pyramid.levels(), band, diagonal);
}

std::vector<double> band_gains(const Pyramid& pyramid, const Band& band, double diagonal, double gain) {
    std::vector<double> gains = band_share(pyramid, band, diagonal);
    for (double& g : gains) g = 1 + g * (gain - 1);
    return gains;
}

double box_diagonal(const Layer& layer) { return bounding_box(layer.mesh.positions).diagonal(); }

}  // namespace multires
