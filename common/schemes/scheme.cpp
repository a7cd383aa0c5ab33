#include "schemes/scheme.h"

#include "base/parallel.h"
#include "schemes/frame.h"

#include <algorithm>

namespace multires {

void narrow(Subband& subband) {
    subband.single.assign(subband.values.values.begin(), subband.values.values.end());
    subband.values.values = Array<double>();
}

void widen(Subband& subband) {
    if (subband.single.empty()) return;
    Field& wide = subband.values;
    wide.values.resize(subband.single.size());
    parallel_for(wide.rows(), [&](Index r) {
        const std::size_t at = static_cast<std::size_t>(r) * wide.width;
        std::copy_n(subband.single.begin() + static_cast<std::ptrdiff_t>(at), wide.width, wide.row(r));
    });
    subband.single = Array<float>();
}

std::size_t bytes(const Coefficients& coefficients) {
    const auto of = [](const auto& values) { return values.capacity() * sizeof(values[0]); };
    std::size_t sum = of(coefficients.base.values) + of(coefficients.level);
    for (const std::vector<Subband>& level : coefficients.level) {
        sum += of(level);
        for (const Subband& band : level) sum += of(band.values.values) + of(band.single) + of(band.local);
    }
    return sum;
}

void Scheme::hand_over(const Coefficients& coefficients, const Take& take) const {
    const Field f = synthesise(coefficients);
    parallel_for(f.rows(), [&](Index place) { take(place, f.row(place)); });
}

Vec3 Scheme::normal(const Subband& subband, Index row, const Positions& positions) const {
    if (!subband.local.empty() && subband.local[row]) return {0, 0, 1};
    const Rings& rings = *subband.rings;
    row += subband.range.begin;
    const auto at = [&](Index place) { return positions[h_.order[place]]; };
    if (rings.size(row) == 0) return Vec3::Zero();  // irregular or isolated
    const bool open = rings.kind[row] == RingKind::open;
    return ring_normal(rings.begin(row), rings.size(row), at, open ? at(rings.vertex(row)) : at(rings.begin(row)[0]));
}

}  // namespace multires
