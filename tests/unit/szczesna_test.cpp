#include "schemes/ring_update.h"
#include "schemes/table.h"

#include "measure/measure.h"

#include "hierarchy_checks.h"
#include "operator_fixtures.h"
#include "scheme_fixtures.h"

#include <numeric>

namespace multires {

using namespace fixtures;
using ring_update::Batches;
using ring_update::Neighbours;
using ring_update::Part;

namespace {

/// Calls check(name, hierarchy) for every class of mesh, with and without features, in every grouping.
template <class Check>
void for_hierarchies(const Check& check) {
    for (const auto& [name, mesh] : every_class())
        for (const auto& [grouping, options] : groupings())
            for (const double angle : {0.0, 30.0}) {
                SCOPED_TRACE(name + ", " + grouping + ", features " + std::to_string(angle));
                check(hierarchy_of(mesh, options, angle));
            }
}

SchemeOptions szczesna(Operator op, Update update = Update::mean) {
    SchemeOptions options;
    options.row = scheme_named("Szczesna");
    options.op = op;
    options.update = update;
    return options;
}

/// A closed star of n around vertex n as a hierarchy of one level: its ring is 0, 1, ..., n-1.
Hierarchy star_hierarchy(Index n) {
    Hierarchy h;
    h.positions = planar_star(n, 7);
    for (Index j = 1; j <= n; ++j) {
        const double angle = 2 * std::acos(-1.0) * j / n;
        h.positions[j] = {std::cos(angle), std::sin(angle), 0};
    }
    std::rotate(h.positions.begin(), h.positions.begin() + 1, h.positions.end());
    h.order.resize(n + 1);
    std::iota(h.order.begin(), h.order.end(), 0);
    h.parent.assign(n + 1, -1);
    h.parent[n] = 0;
    h.size = {n + 1, n};
    Level level;
    level.fine = n + 1, level.coarse = n;
    level.odd = {0, 1};
    h.levels.push_back(level);
    h.odd.first = n;
    h.odd.offset = {0, n};
    h.odd.kind = {RingKind::closed};
    for (Index j = 0; j < n; ++j) h.odd.neighbor.push_back(j);
    h.base.offset.assign(n + 1, 0);
    h.base.kind.assign(n, RingKind::closed);
    return h;
}

}  // namespace

TEST(RingUpdate, KeepsTheMeanOfRingAndVertex) {
    Index updated = 0, curves = 0;
    for_hierarchies([&](const Hierarchy& h) {
        const Array<Part> part = ring_update::parts_of(h);
        shapes::Random random(3);
        Array<double> value(h.vertices());
        for (double& x : value) x = random.uniform(-1, 1);
        const auto at = [&](Index place) { return &value[place]; };
        for (Index r = h.odd.rows(); r-- > 0;) {
            const Neighbours ring(h.odd, r, part);
            const auto mean = [&] {
                double sum = 0;
                for (Index j = 0; j < ring.size; ++j) sum += value[ring.vertex[j]];
                return sum / ring.size;
            };
            const double v = value[h.odd.vertex(r)], expected = (ring.size * mean() + v) / (ring.size + 1);
            const Array<double> before = value;
            ring_update::update(h.odd, r, part, 1, false, at);
            if (ring.moving == 0) {
                EXPECT_EQ(value, before);
                continue;
            }
            EXPECT_NEAR(mean(), expected, 1e-15 * (2 + ring.size));
            const Array<double> after = value;
            ring_update::update(h.odd, r, part, 1, true, at);
            for (Index j = 0; j < ring.size; ++j)
                EXPECT_NEAR(value[ring.vertex[j]], before[ring.vertex[j]], 1e-15 * (2 + ring.size));
            value = after;
            ++updated, curves += ring.own == Part::curve;
        }
    });
    EXPECT_GT(updated, 10000);
    EXPECT_GT(curves, 500);
}

// Boundaries, creases and what has no ring: moved by vertices of their own kind only.
TEST(RingUpdate, CurvesAndCornersKeepToThemselves) {
    for_hierarchies([&](const Hierarchy& h) {
        const Array<Part> part = ring_update::parts_of(h);
        for (Index p = 0; p < h.size.back(); ++p) {
            const RingKind kind = h.base.kind[p];
            if (kind == RingKind::irregular || kind == RingKind::isolated) {
                EXPECT_EQ(part[p], Part::fixed);
            } else if (kind == RingKind::open) {
                EXPECT_NE(part[p], Part::surface);
            }
        }
        for (Index r = 0; r < h.odd.rows(); ++r) {
            EXPECT_EQ(part[h.odd.vertex(r)] == Part::curve,
                      h.odd.kind[r] == RingKind::open ||
                          (!h.odd.feature.empty() && std::count(h.odd.feature.begin() + h.odd.offset[r],
                                                                h.odd.feature.begin() + h.odd.offset[r + 1], 1) == 2));
            EXPECT_TRUE(part[h.odd.vertex(r)] != Part::fixed || Neighbours(h.odd, r, part).moving == 0);
        }
    });
}

TEST(RingUpdate, RowsOfABatchDoNotMeet) {
    for_hierarchies([&](const Hierarchy& h) {
        const Rings& odd = h.odd;
        for (std::size_t k = 0; k < h.levels.size(); ++k) {
            const Level& level = h.levels[k];
            const Batches batches = ring_update::batches_of(h, k);
            std::vector<Index> seen(level.odd.size(), 0);
            Array<Index> writer(level.fine, -1);
            ASSERT_EQ(batches.bounds.front(), 0);
            ASSERT_EQ(batches.bounds.back(), level.odd.size());
            std::size_t set = 0;
            for (std::size_t b = 0; b + 1 < batches.bounds.size(); ++b) {
                ASSERT_LT(batches.bounds[b], batches.bounds[b + 1]);
                while (level.set(set).end <= level.odd.begin + batches.bounds[b]) ++set;
                EXPECT_LE(level.odd.begin + batches.bounds[b + 1], level.set(set).end) << "batches are parts of sets";
                std::fill(writer.begin(), writer.end(), -1);
                const auto for_rows = [&](const auto& take) {
                    for (Index i = batches.bounds[b]; i < batches.bounds[b + 1]; ++i)
                        take(level.odd.begin + batches.row(i));
                };
                for_rows([&](Index r) {
                    ++seen[r - level.odd.begin];
                    EXPECT_TRUE(r >= level.set(set).begin && r < level.set(set).end);
                    for (Index k = odd.offset[r]; k < odd.offset[r + 1]; ++k) {
                        EXPECT_EQ(writer[odd.neighbor[k]], -1);
                        writer[odd.neighbor[k]] = r;
                    }
                });
                for_rows([&](Index r) {
                    EXPECT_EQ(writer[odd.vertex(r)], -1);
                    for (Index k = odd.offset[r]; k < odd.offset[r + 1]; ++k)
                        EXPECT_TRUE(writer[odd.flap[k]] == -1 || writer[odd.flap[k]] == r);
                });
            }
            EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), level.odd.size());
        }
    });
}

TEST(RingUpdate, BatchesAreFew) {
    const Hierarchy h = hierarchy_of(shapes::scan(20000));
    EXPECT_LE(ring_update::batches_of(h, 0).bounds.size(), 16U);
    // The hub of a fan is in every ring: one row after the other.
    HierarchyOptions options;
    options.base_vertices = 4;
    const Hierarchy fan = hierarchy_of(shapes::fan(300), options);
    for (std::size_t k = 0; k < fan.levels.size(); ++k)
        EXPECT_EQ(ring_update::batches_of(fan, k).bounds.size(),
                  static_cast<std::size_t>(fan.levels[k].odd.size()) + 1);
}

// docs/wavelets.md: rings and weights are in tables of all levels, so that a level for each vertex is affordable.
TEST(Szczesna, ALevelForEachVertexTakesFewBytes) {
    HierarchyOptions options;
    options.grouping = Grouping::sequential;
    options.even_rings = false;
    const Hierarchy h = hierarchy_of(shapes::scan(5000), options);
    ASSERT_GT(h.levels.size(), 4000U);
    const auto scheme = make_scheme(h, szczesna(Operator::second_difference_flaps));
    const std::size_t details = bytes(scheme->analyse(field_of(h.positions)));
    EXPECT_LT(bytes(h) / h.vertices(), 150U);
    EXPECT_LT((bytes(h) + scheme->bytes() + details) / h.vertices(), 420U);
}

// One level, a ring of valence 4 or 6: what the columns of analysis and synthesis are (eq. 17 to 22).
TEST(Szczesna, ScalingFunctionsAndWavelets) {
    for (const Index n : {4, 6})
        for (const Operator op : {Operator::natural_neighbours, Operator::thin_plate})
            for (const Update update : {Update::mean, Update::none}) {
                const Hierarchy h = star_hierarchy(n);
                const auto scheme = make_scheme(h, szczesna(op, update));
                Field zero(h.vertices(), 1);
                zero.has_positions = false;
                Coefficients c = scheme->analyse(zero);
                // The wavelet: 1 at the vertex; with the update, means are zero.
                *c.level[0][0].values.row(0) = 1;
                const Field wavelet = scheme->synthesise(c);
                EXPECT_NEAR(*wavelet.row(n), 1, 1e-15);
                for (Index j = 0; j < n; ++j)
                    EXPECT_NEAR(*wavelet.row(j), update == Update::mean ? -1.0 / n : 0, 1e-15);
                // The scaling function of a neighbour: what predicts the vertex.
                *c.level[0][0].values.row(0) = 0;
                *c.base.row(0) = 1;
                const Field scaling = scheme->synthesise(c);
                EXPECT_NEAR(*scaling.row(n), 1.0 / n, 1e-12);
                for (Index j = 0; j < n; ++j) EXPECT_NEAR(*scaling.row(j), j == 0 ? 1 : 0, 1e-12);
                // The dual: a delta at the vertex goes into the means and comes back.
                Field delta = zero;
                *delta.row(n) = 1;
                const Coefficients d = scheme->analyse(delta);
                const double to_ring = update == Update::mean ? 1.0 / (n + 1) : 0;
                EXPECT_NEAR(*d.base.row(0), to_ring, 1e-15);
                EXPECT_NEAR(*d.level[0][0].values.row(0), 1 - to_ring, 1e-12);
            }
}

TEST(Szczesna, WithoutUpdateItIsLazyWithoutFrames) {
    const Hierarchy h = hierarchy_of(shapes::scan(1500));
    Field f = field_of(h.positions);
    f.has_positions = false;
    SchemeOptions options = szczesna(Operator::second_difference_flaps, Update::none);
    const Coefficients c = make_scheme(h, options)->analyse(f);
    options.row = scheme_named("Lazy");
    const Coefficients lazy = make_scheme(h, options)->analyse(f);
    EXPECT_EQ(c.base.values, lazy.base.values);
    for (std::size_t k = 0; k < h.levels.size(); ++k)
        EXPECT_EQ(c.level[k][0].values.values, lazy.level[k][0].values.values);
}

TEST(Szczesna, InvertsEveryClassWithFeaturesAndWithoutUpdate) {
    for_hierarchies([&](const Hierarchy& h) {
        for (const Operator op : {Operator::natural_neighbours, Operator::thin_plate_flaps})
            for (const Update update : {Update::mean, Update::none}) {
                const auto scheme = make_scheme(h, szczesna(op, update));
                const Field f = field_of(h.positions), back = scheme->synthesise(scheme->analyse(f));
                double largest = 0;
                for (std::size_t i = 0; i < f.values.size(); ++i)
                    largest = std::max(largest, std::abs(back.values[i] - f.values[i]));
                EXPECT_LE(largest, 1e-12 * bounding_box(h.positions).diagonal());
            }
    });
}

// What the update is for: less of fine noise is left in coarse levels.
TEST(Szczesna, CoarseLevelsHoldLessNoise) {
    HierarchyOptions options;
    options.base_vertices = 300;
    const Hierarchy h = hierarchy_of(shapes::scan(6000), options);
    Field noise(h.vertices(), 1);
    noise.has_positions = false;
    shapes::Random random(1);
    for (double& x : noise.values) x = random.uniform(-1, 1);
    const auto left = [&](Update update) {
        const auto scheme = make_scheme(h, szczesna(Operator::second_difference_flaps, update));
        Field low = scheme->synthesise(scheme->analyse(noise), with_gain(std::vector<double>(h.levels.size(), 0)));
        return std::sqrt(std::inner_product(low.values.begin(), low.values.end(), low.values.begin(), 0.0) /
                         h.vertices());
    };
    EXPECT_LT(left(Update::mean), 0.5 * left(Update::none));
}

// The normals of a level keep to what the mesh has: nothing folds on the way down.
TEST(Szczesna, LowPassOfASphereIsASphere) {
    const Mesh mesh = shapes::icosphere(20);
    const Hierarchy h = hierarchy_of(mesh);
    for (const Operator op : {Operator::natural_neighbours, Operator::thin_plate, Operator::thin_plate_flaps,
                              Operator::second_difference_flaps, Operator::cotangent}) {
        const auto scheme = make_scheme(h, szczesna(op));
        const Coefficients c = scheme->analyse(field_of(h.positions));
        std::vector<double> gain(h.levels.size(), 1);
        std::fill(gain.begin(), gain.begin() + static_cast<std::ptrdiff_t>(gain.size() / 2), 0);
        for (const Vec3& p : positions_of(scheme->synthesise(c, with_gain(gain))))
            EXPECT_NEAR(p.norm(), 1, 0.1) << static_cast<int>(op);
    }
}

}  // namespace multires
