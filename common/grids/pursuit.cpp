#include "grids/pursuit.h"

#include "base/reduce.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace multires {
namespace {

using Vectors = std::vector<Array<double>>;  // coefficients of each channel, times the norms of their functions
using Rasters = std::vector<Raster>;

double squared_norm(const Array<double>& v) {
    return chunked_fold<double>(v.size(), [&](double& sum, std::size_t i) { sum += v[i] * v[i]; });
}

/// One call of sparse().
class Pursuit {
public:
    Pursuit(const GridPyramid& pyramid, const Rasters& channels, const SparseOptions& options, const Progress& progress)
        : pyramid_(pyramid), channels_(channels), options_(options), progress_(progress),
          x_(channels.size(), Array<double>(pyramid.size(), 0)), left_(channels), chosen_(pyramid.size(), 0),
          norm_(pyramid.size(), 0) {
        for (int k = 0; k < pyramid.levels(); ++k)
            for (int type = k + 1 == pyramid.levels() ? 0 : 1; type < subbands; ++type)
                for (std::size_t p = 0; p < pyramid.band_size(k); ++p)
                    if (pyramid.mask(k + 1).values[p]) norm_[pyramid.offset(k, type) + p] = pyramid.norm(k, type);
        all_ = static_cast<std::size_t>(std::count_if(norm_.begin(), norm_.end(), [](double n) { return n > 0; }));
    }

    Sparse by_magnitude() {
        Vectors analysed;
        for (const Raster& channel : channels_) analysed.push_back(pyramid_.analyse(channel));
        for (Array<double>& v : analysed)
            for (std::size_t i = 0; i < v.size(); ++i) v[i] *= norm_[i];
        if (!options_.error) return with(analysed, options_.keep);
        std::size_t low = 0, high = all_;  // high will do, low will not
        while (high > low + std::max<std::size_t>(1, low / 100)) {
            progress_.report(0.5, "Choosing coefficients");
            const std::size_t half = low + (high - low) / 2;
            with(analysed, half);
            (largest_error() <= *options_.error ? high : low) = half;
        }
        return with(analysed, high);
    }

    Sparse by_pursuit() {
        constexpr int rounds = 12, growing = 7;
        const std::size_t keep = std::min(options_.keep, all_);
        Array<std::uint8_t> before;
        for (int round = 1; round <= rounds; ++round) {
            progress_.report(0.9 * round / (rounds + 1), "Choosing coefficients");
            const std::size_t target = keep * std::min(round, growing) / growing;
            add(std::max(target - std::min(target, count_), keep / 10));
            solve(4);
            if (count_ <= target) continue;
            choose(magnitudes(x_), target);
            solve(4);
            if (round > growing && chosen_ == before) break;
            before = chosen_;
        }
        solve(12);
        return result();
    }

    /// Adds until no sample is too far off.
    Sparse until_near() {
        std::size_t target = channels_[0].values.size() / 200 + 1;
        while (count_ < all_) {
            const double share = static_cast<double>(count_) / static_cast<double>(channels_[0].values.size());
            progress_.report(std::min(0.9, 2 * share), "Choosing coefficients");
            add(std::min(target, all_) - count_);
            solve(6);
            if (largest_error() <= *options_.error) return result();
            target += target / 6 + 1;
        }
        return by_magnitude();  // rounding, or a bound as small
    }

private:
    Sparse with(const Vectors& values, std::size_t keep) {
        std::fill(chosen_.begin(), chosen_.end(), 0);
        x_ = values;
        choose(magnitudes(values), std::min(keep, all_));
        left_ = residual();
        return result();
    }

    Sparse result() {
        Sparse s;
        s.kept = count_;
        s.coefficients = unscaled(x_);
        s.samples = channels_;
        for (std::size_t c = 0; c < channels_.size(); ++c)
            for (std::size_t p = 0; p < s.samples[c].values.size(); ++p) s.samples[c].values[p] -= left_[c].values[p];
        return s;
    }

    Vectors unscaled(Vectors x) const {
        for (Array<double>& v : x)
            for (std::size_t i = 0; i < v.size(); ++i) v[i] = norm_[i] > 0 ? v[i] / norm_[i] : 0;
        return x;
    }

    /// Squared, over the channels; -1 for coefficients that reach no sample.
    Array<double> magnitudes(const Vectors& v) const {
        Array<double> m(norm_.size(), 0);
        for (std::size_t i = 0; i < m.size(); ++i) {
            for (const Array<double>& channel : v) m[i] += channel[i] * channel[i];
            if (norm_[i] == 0) m[i] = -1;
        }
        return m;
    }

    /// Marks the `count` largest, the first ones where they are equal, and sets the others' values to 0.
    void choose(const Array<double>& magnitude, std::size_t count) {
        std::fill(chosen_.begin(), chosen_.end(), 0);
        mark(magnitude, count);
        for (Array<double>& v : x_)
            for (std::size_t i = 0; i < v.size(); ++i)
                if (!chosen_[i]) v[i] = 0;
    }

    void mark(const Array<double>& magnitude, std::size_t count) {
        count_ = static_cast<std::size_t>(std::count(chosen_.begin(), chosen_.end(), 1)) + count;
        if (count == 0) return;
        Array<double> sorted(magnitude);
        std::nth_element(sorted.begin(), sorted.end() - static_cast<std::ptrdiff_t>(count), sorted.end());
        const double least = sorted[sorted.size() - count];
        for (std::size_t i = 0; i < magnitude.size(); ++i)
            if (magnitude[i] > least) chosen_[i] = 1, --count;
        for (std::size_t i = 0; count > 0; ++i)
            if (magnitude[i] == least) chosen_[i] = 1, --count;
    }

    void add(std::size_t count) {
        Array<double> common = magnitudes(correlated(left_, false));
        for (std::size_t i = 0; i < common.size(); ++i)
            if (chosen_[i]) common[i] = -1;
        mark(common, std::min(count, all_ - count_));
    }

    Rasters synthesised(const Vectors& x) const {
        Rasters out;
        for (const Array<double>& v : unscaled(x)) {
            out.push_back(pyramid_.synthesise(v));
            clear_outside(pyramid_.mask(0), out.back());
        }
        return out;
    }

    Vectors correlated(const Rasters& r, bool of_chosen) const {
        Vectors out;
        for (const Raster& channel : r) out.push_back(pyramid_.correlate(channel));
        for (Array<double>& v : out)
            for (std::size_t i = 0; i < v.size(); ++i)
                v[i] = norm_[i] > 0 && (chosen_[i] || !of_chosen) ? v[i] / norm_[i] : 0;
        return out;
    }

    Rasters residual() const {
        Rasters left = channels_;
        const Rasters now = synthesised(x_);
        for (std::size_t c = 0; c < left.size(); ++c)
            for (std::size_t p = 0; p < left[c].values.size(); ++p) left[c].values[p] -= now[c].values[p];
        return left;
    }

    /// Conjugate gradients for the least squares of what is left; channels have nothing to do with each other.
    void solve(int steps) {
        left_ = residual();
        Vectors gradient = correlated(left_, true), along = gradient;
        std::vector<double> square;
        for (const Array<double>& g : gradient) square.push_back(squared_norm(g));
        for (int step = 0; step < steps; ++step) {
            progress_.report(0.9 * std::min(1.0, static_cast<double>(count_) / static_cast<double>(all_)),
                             "Choosing coefficients");
            const Rasters way = synthesised(along);
            for (std::size_t c = 0; c < way.size(); ++c) {
                const double length = squared_norm(way[c].values);
                const double t = length > 0 ? square[c] / length : 0;
                for (std::size_t i = 0; i < along[c].size(); ++i) x_[c][i] += t * along[c][i];
                for (std::size_t p = 0; p < way[c].values.size(); ++p) left_[c].values[p] -= t * way[c].values[p];
            }
            gradient = correlated(left_, true);
            for (std::size_t c = 0; c < way.size(); ++c) {
                const double now = squared_norm(gradient[c]), turn = square[c] > 0 ? now / square[c] : 0;
                for (std::size_t i = 0; i < along[c].size(); ++i) along[c][i] = gradient[c][i] + turn * along[c][i];
                square[c] = now;
            }
        }
    }

    double largest_error() const {
        double largest = 0;
        for (std::size_t p = 0; p < left_[0].values.size(); ++p) {
            double square = 0;
            for (const Raster& channel : left_) square += channel.values[p] * channel.values[p];
            largest = std::max(largest, square);
        }
        return std::sqrt(largest);
    }

    const GridPyramid& pyramid_;
    const Rasters& channels_;
    const SparseOptions& options_;
    const Progress& progress_;
    Vectors x_;
    Rasters left_;  // the samples without what x_ gives
    Array<std::uint8_t> chosen_;
    Array<double> norm_;  // of each coefficient's function; 0 if it reaches no sample
    std::size_t count_ = 0, all_ = 0;
};

}  // namespace

Sparse sparse(const GridPyramid& pyramid, const std::vector<Raster>& channels, const SparseOptions& options,
              const Progress& progress) {
    Pursuit pursuit(pyramid, channels, options, progress);
    if (options.oracle == Oracle::magnitude) return pursuit.by_magnitude();
    return options.error ? pursuit.until_near() : pursuit.by_pursuit();
}

}  // namespace multires
