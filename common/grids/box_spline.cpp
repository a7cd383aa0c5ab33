#include "grids/box_spline.h"

#include "base/parallel.h"
#include "grids/extension.h"

#include <algorithm>
#include <cmath>

namespace multires {
namespace {

/// A one-dimensional filter: weights of the points first, first + 1, ...
struct Taps {
    int first = 0;
    std::vector<double> weight;

    int end() const { return first + static_cast<int>(weight.size()); }
    double operator[](int n) const { return n >= first && n < end() ? weight[n - first] : 0; }
};
using Pair = std::array<Taps, 2>;  // low and high pass

/// Both filters' points.
struct Span {
    int first, end;
    explicit Span(const Pair& p) : first(std::min(p[0].first, p[1].first)), end(std::max(p[0].end(), p[1].end())) {}
};

// Of 1 / (w + 4 + 1/w), which the duals of the quartic basis have in common: -pole (1 - pole w)^-1 (1 - pole / w)^-1.
const double pole = std::sqrt(3.0) - 2;

/// Functions by those of the finer level: the paper's p and q (appendix B).
const Pair& synthesis_pair(SplineBasis basis) {
    static const Pair linear{Taps{0, {1, 1}}, Taps{0, {1, -1}}};
    static const Pair quartic{Taps{-1, {0.5, 1, 0.5}}, Taps{-1, {1.0 / 12, -6.0 / 12, 10.0 / 12, -6.0 / 12, 1.0 / 12}}};
    return basis == SplineBasis::linear ? linear : quartic;
}

/// The duals a and b; of the quartic basis what is left of them when 1 / (w + 4 + 1/w), w two points, was applied, but
/// for its factor -pole. Exact, where the paper prints seven digits.
const Pair& analysis_pair(SplineBasis basis) {
    static const Pair linear{Taps{0, {0.5, 0.5}}, Taps{0, {0.5, -0.5}}};
    const double s = -pole;
    static const Pair quartic{Taps{-2, {0.25 * s, 1.5 * s, 2.5 * s, 1.5 * s, 0.25 * s}},
                              Taps{0, {-1.5 * s, 3 * s, -1.5 * s}}};
    return basis == SplineBasis::linear ? linear : quartic;
}

/// Points around the samples that analysis looks at. Quartic: 10 for the filters' own lengths; beyond, what a point is
/// given weighs 0.27 for every second one, 1e-13 at the end.
Index margin(SplineBasis basis) { return basis == SplineBasis::linear ? 4 : 54; }

/// Both passes of the recursion along lines, two points at a time; `step` places from a point to the next but one.
/// Lines are chunks of neighbours that run down the rows, `shift` columns to the right with every second row.
void recurse_down(Raster& r, Index shift) {
    const double start = 1 / (1 - pole);
    const Index lines = r.columns + (shift ? r.rows : 0);
    const auto clip = [&](Index line, Index i) { return std::clamp(shift ? line - r.rows + i : line, 0, r.columns); };
    parallel_chunks(lines, 128, [&](Index begin, Index end) {
        for (Index i = 0; i < r.rows; ++i) {
            const Index from = clip(begin, i), to = clip(end, i);
            double* const here = r.row(i);
            const double* const last = i >= 2 ? r.row(i - 2) - shift : nullptr;
            const Index inner = last ? std::max(from, std::min(to, shift)) : to;
            for (Index j = from; j < inner; ++j) here[j] *= start;
            for (Index j = inner; j < to; ++j) here[j] += pole * last[j];
        }
        for (Index i = r.rows; i-- > 0;) {
            const Index from = clip(begin, i), to = clip(end, i);
            double* const here = r.row(i);
            const double* const next = i + 2 < r.rows ? r.row(i + 2) + shift : nullptr;
            const Index inner = next ? std::min(to, std::max(from, r.columns - shift)) : from;
            for (Index j = from; j < inner; ++j) here[j] += pole * next[j];
            for (Index j = inner; j < to; ++j) here[j] *= start;
        }
    });
}

void recurse_along(Raster& r) {
    const double start = 1 / (1 - pole);
    parallel_for(
        r.rows,
        [&](Index i) {
            double* const x = r.row(i);
            for (Index j = 0; j < std::min(2, r.columns); ++j) x[j] *= start;
            for (Index j = 2; j < r.columns; ++j) x[j] += pole * x[j - 2];
            for (Index j = r.columns; j-- > 0;) x[j] = j + 2 < r.columns ? x[j] + pole * x[j + 2] : x[j] * start;
        },
        16);
}

/// Filters along the three directions and keeps every second point. Work of a row, one e3-step after another: rows are
/// added up along e1, then along e2, then every second place along e3.
std::array<Raster, subbands> filter_down(const Raster& f, Index around, const Pair& taps, const CoarseBox& box,
                                         double factor) {
    std::array<Raster, subbands> out;
    for (Raster& band : out) band = Raster(box.rows, box.columns, 0);
    const Span span(taps);
    const Index width = f.columns - (span.end - 1 - span.first), start = around + 2 * box.first;
    parallel_chunks(box.rows, 8, [&](Index begin, Index end) {
        Array<double> one(f.columns), two(f.columns);
        for (Index x = begin; x < end; ++x)
            for (int n3 = span.first; n3 < span.end; ++n3)
                for (int s = 0; s < 4; ++s) {
                    if (s % 2 == 0) {
                        const Taps& t = taps[s / 2];
                        std::fill(one.begin(), one.end(), 0.0);
                        for (int n1 = t.first; n1 < t.end(); ++n1) {
                            const double w = factor * t[n1], *const row = f.row(start + 2 * x + n1 - n3);
                            for (Index j = 0; j < f.columns; ++j) one[j] += w * row[j];
                        }
                    }
                    const Taps& t = taps[s % 2];
                    std::fill(two.begin(), two.end(), 0.0);  // two[j] is the sum at j - span.first
                    for (int n2 = t.first; n2 < t.end(); ++n2) {
                        const double w = t[n2], *const row = one.data() + n2 - span.first;
                        for (Index j = 0; j < width; ++j) two[j] += w * row[j];
                    }
                    const double* const from = two.data() + start + span.first - n3;
                    for (int s3 = 0; s3 < 2; ++s3) {
                        const double w = taps[s3][n3];
                        if (w == 0) continue;
                        double* const to = out[2 * s + s3].row(x);
                        for (Index y = 0; y < box.columns; ++y) to[y] += w * from[2 * y];
                    }
                }
    });
    return out;
}

/// One row of samples: for each e3-step and each filter along e2, the subbands' rows that reach it, added up.
void add_row(double* row, Index i, const std::array<const double*, subbands>& bands, const Pair& taps,
             const CoarseBox& box, Index columns, Array<double>& sum) {
    const Span span(taps);
    for (int n3 = span.first; n3 < span.end; ++n3)
        for (int s2 = 0; s2 < 2; ++s2) {
            bool any = false;
            std::fill(sum.begin(), sum.end(), 0.0);
            for (int s = 0; s < 4; ++s) {
                const double* const band = bands[4 * (s / 2) + 2 * s2 + s % 2];
                const double w3 = taps[s % 2][n3];
                if (!band || w3 == 0) continue;
                const Taps& t = taps[s / 2];
                for (int n1 = t.first; n1 < t.end(); ++n1) {
                    const Index twice = i - n1 + n3 - 2 * box.first, x = twice / 2;
                    if (twice % 2 || twice < 0 || x >= box.rows) continue;
                    const double w = 0.5 * t[n1] * w3, *const from = band + static_cast<std::size_t>(x) * box.columns;
                    for (Index y = 0; y < box.columns; ++y) sum[y] += w * from[y];
                    any = true;
                }
            }
            const Taps& t = taps[s2];
            for (int n2 = t.first; any && n2 < t.end(); ++n2) {
                const Index offset = 2 * box.first + n2 - n3;  // of coefficient 0's place in the row
                const Index y0 = offset < 0 ? (1 - offset) / 2 : 0;
                const Index y1 = std::min<Index>(box.columns, (columns - offset + 1) / 2);
                double* const to = row + offset;
                for (Index y = y0; y < y1; ++y) to[2 * y] += t[n2] * sum[y];
            }
        }
}

}  // namespace

Index reach(SplineBasis basis) { return basis == SplineBasis::linear ? 1 : 4; }

CoarseBox coarse_box(SplineBasis basis, Index rows, Index columns) {
    const Index r = reach(basis);
    CoarseBox box;
    box.first = -(r / 2);
    box.rows = (rows - 1 + r) / 2 - box.first + 1;
    box.columns = (columns - 1 + r) / 2 - box.first + 1;
    return box;
}

std::array<Raster, subbands> analyse(const Raster& samples, const Mask& mask, SplineBasis basis) {
    const Index around = margin(basis);
    Raster f = extended(samples, mask, around);
    if (basis == SplineBasis::quartic) {
        recurse_down(f, 0);
        recurse_along(f);
        recurse_down(f, 2);
    }
    return filter_down(f, around, analysis_pair(basis), coarse_box(basis, samples.rows, samples.columns), 1);
}

Raster synthesise(const std::array<const double*, subbands>& bands, SplineBasis basis, Index rows, Index columns) {
    const Pair& taps = synthesis_pair(basis);
    const CoarseBox box = coarse_box(basis, rows, columns);
    Raster out(rows, columns, 0);
    parallel_chunks(rows, 8, [&](Index begin, Index end) {
        Array<double> sum(box.columns);
        for (Index i = begin; i < end; ++i) add_row(out.row(i), i, bands, taps, box, columns, sum);
    });
    return out;
}

std::array<Raster, subbands> correlate(const Raster& samples, SplineBasis basis) {
    const Index around = 12;
    Raster f(samples.rows + 2 * around, samples.columns + 2 * around, 0);
    for (Index i = 0; i < samples.rows; ++i) std::copy_n(samples.row(i), samples.columns, f.row(i + around) + around);
    return filter_down(f, around, synthesis_pair(basis), coarse_box(basis, samples.rows, samples.columns), 0.5);
}

}  // namespace multires
