#include "operators/row_sums.h"

#include "random.h"

#include <gtest/gtest.h>

namespace multires {

namespace {

/// Rows of 0 to 12 entries over 500 vertices, with flaps; enough of them for all ways the loops take.
struct Table {
    Rings rings;
    Array<double> ring, flap;
    Array<float> ring_single, flap_single;
    static constexpr Index vertices = 500;

    Table() {
        shapes::Random random(3);
        const auto vertex = [&] { return static_cast<Index>(random.uniform(0, vertices)); };
        for (int r = 0; r < 900; ++r) {
            const int size = r % 3 == 0 ? static_cast<int>(random.uniform(0, 13)) : 5 + r % 3;
            for (int j = 0; j < size; ++j) {
                rings.neighbor.push_back(vertex());
                rings.flap.push_back(vertex());
                for (auto* weight : {&ring, &flap}) weight->push_back(random.uniform(-1, 1));
            }
            rings.offset.push_back(static_cast<Index>(rings.neighbor.size()));
            rings.kind.push_back(size > 0 ? RingKind::closed : RingKind::isolated);
        }
        ring_single.assign(ring.begin(), ring.end());
        flap_single.assign(flap.begin(), flap.end());
    }
};

/// One row and channel, from the definition.
template <class Weight>
double plain_sum(const Table& t, const Array<Weight>& ring, const Array<Weight>* flap, Index r, const double* f,
                 int width) {
    const Index begin = t.rings.offset[r], end = t.rings.offset[r + 1];
    if (begin == end) return 0;
    const double base = sizeof(Weight) == 4 ? f[t.rings.neighbor[begin] * width] : 0;
    double sum = 0;
    for (Index k = begin; k < end; ++k) sum += ring[k] * (f[t.rings.neighbor[k] * width] - base);
    for (Index k = begin; flap && k < end; ++k) sum += (*flap)[k] * (f[t.rings.flap[k] * width] - base);
    return sum + base;
}

}  // namespace

TEST(RowSums, AreThoseOfTheDefinitionToTheLastBit) {
    const Table t;
    shapes::Random random(4);
    for (const int width : {1, 2, 3, 4, 7}) {
        Array<double> f(static_cast<std::size_t>(Table::vertices) * width);
        for (double& x : f) x = random.uniform(-10, 10);
        for (const bool flaps : {false, true})
            for (const bool single : {false, true}) {
                RowWeights rows;
                rows.rings = &t.rings;
                if (single)
                    rows.ring_single = t.ring_single.data(), rows.flap_single = flaps ? t.flap_single.data() : nullptr;
                else
                    rows.ring = t.ring.data(), rows.flap = flaps ? t.flap.data() : nullptr;
                const Index begin = 7, end = t.rings.rows();
                std::vector<double> sums(static_cast<std::size_t>(end - begin) * width, 1e30);
                row_sums(rows, begin, end, f.data(), width, sums.data());
                for (Index r = begin; r < end; ++r)
                    for (int c = 0; c < width; ++c) {
                        const double expected =
                            single
                                ? plain_sum(t, t.ring_single, flaps ? &t.flap_single : nullptr, r, f.data() + c, width)
                                : plain_sum(t, t.ring, flaps ? &t.flap : nullptr, r, f.data() + c, width);
                        ASSERT_EQ(sums[(r - begin) * width + c], expected) << "width " << width << " row " << r;
                    }
            }
    }
}

}  // namespace multires
