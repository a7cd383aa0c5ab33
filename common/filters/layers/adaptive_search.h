#pragma once

#include "base/progress.h"
#include "filters/layers/adaptive.h"
#include "measure/distance.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace multires {

/// A reconstruction: how many vertices were asked for, the mesh, and its distance to the input, if that was measured.
struct Reconstruction {
    Index count = 0;
    DerivedMesh mesh;
    Positions positions;
    std::optional<Distance> distance;
};

/// The reconstruction of the fewest vertices found, by bisection, whose distance is within a bound.
/// @param make   Reconstruction(Index count, const Progress&), measured; that of `most` is the input
template <class Make>
Reconstruction fewest_within(const Make& make, Index least, Index most, Target target, double bound,
                             const Progress& progress) {
    double low = least, high = most, next = std::max<double>(least, most / 10.0);
    std::optional<Reconstruction> best;
    constexpr int steps = 14;
    for (int i = 0; i < steps && low < high; ++i) {
        const Progress step = progress.part(static_cast<double>(i) / steps, (i + 1.0) / steps);
        step.report(0, "Searching the threshold");
        Reconstruction r = make(static_cast<Index>(next), step);
        const double off = target == Target::rms_distance ? r.distance->rms : r.distance->largest;
        if (off <= bound) {
            high = r.count;
            best = std::move(r);
        } else {
            low = r.count + 1;
        }
        if (high < 1.005 * low && (best || low >= high)) break;
        // Distances fall about as the number of vertices grows; else half way in the logarithm.
        next = off > 0 ? std::floor(next * off / bound * (off <= bound ? 1.01 : 0.99)) : low;
        if (i > 5 || next <= low * 1.002 || next >= high * 0.998) next = std::floor(std::sqrt(low * high));
        next = std::clamp(next, low, high);
        if (next >= high && best) next = std::max(low, high - 1);
    }
    return best ? std::move(*best) : make(most, progress.part(1, 1));
}

/// Whether vertices are moved while others are removed, in place of moving those that are left: AdaptiveOptions::fit
/// for a number or a distance, where geometry alone decides.
bool moves_on_the_way(const AdaptiveOptions& options);

/// The filter in that case. Sets of vertices of different targets are not nested.
/// @return none if simplify() does not get there: the mesh bars too many cheap collapses
std::optional<Result> moving_reconstruction(const Layer& layer, const AdaptiveOptions& options,
                                            const Progress& progress);

/// The layer of a reconstruction, and what the report says of it.
/// @param with_positions  they are not the input's
Result result_of(Reconstruction r, const Layer& layer, bool with_positions, Report report);

/// #V, 1: selected, or a corner of a selected face.
std::vector<std::uint8_t> selected_region(const Layer& layer);

/// How collapses are chosen.
HierarchyOptions adaptive_collapses(const AdaptiveOptions& options);

}  // namespace multires
