#include "base/angles.h"
#include "hierarchy/collapse.h"
#include "hierarchy/fresh_costs.h"
#include "hierarchy/hierarchy.h"
#include "hierarchy/parts.h"

#include "hierarchy_checks.h"
#include "operator_fixtures.h"

#include <numeric>

namespace multires {

using namespace fixtures;

namespace {

/// A base of 8, or 60 where level 0 is larger than that and every collapse is checked.
class EveryHierarchy : public testing::TestWithParam<int> {};

bool same(const Rings& a, const Rings& b) {
    return a.offset == b.offset && a.neighbor == b.neighbor && a.flap == b.flap && a.feature == b.feature &&
           a.kind == b.kind && a.vertices == b.vertices && a.first == b.first;
}

void expect_same(const Hierarchy& a, const Hierarchy& b) {
    EXPECT_EQ(a.order, b.order);
    EXPECT_EQ(a.parent, b.parent);
    EXPECT_EQ(a.size, b.size);
    ASSERT_EQ(a.levels.size(), b.levels.size());
    for (std::size_t k = 0; k < a.levels.size(); ++k) {
        EXPECT_EQ(a.levels[k].cuts, b.levels[k].cuts) << "level " << k;
        EXPECT_TRUE(same(a.even[k], b.even[k])) << "level " << k;
    }
    EXPECT_TRUE(same(a.odd, b.odd));
    EXPECT_TRUE(same(a.base, b.base));
}

}  // namespace

TEST(Parts, AreWhatEdgesJoinByTheirLeastVertex) {
    std::vector<std::pair<std::string, Mesh>> meshes = every_class();
    shapes::Random random(1);
    Mesh scan = shapes::scan(3000);
    const std::vector<Index> name = permutation(static_cast<Index>(scan.positions.size()), random);
    for (Face& face : scan.faces)
        for (Index& v : face) v = name[v];
    meshes.emplace_back("a scan in random order", scan);
    for (const auto& [what, mesh] : meshes) {
        SCOPED_TRACE(what);
        const Rings rings = vertex_rings(mesh);
        std::vector<Index> least(rings.rows());
        std::iota(least.begin(), least.end(), 0);
        for (bool changed = true; changed;) {
            changed = false;
            for (Index v = 0; v < rings.rows(); ++v)
                for (Index j = 0; j < rings.size(v); ++j) {
                    Index &a = least[v], &b = least[rings.begin(v)[j]];
                    changed |= a != b;
                    a = b = std::min(a, b);
                }
        }
        for (const int threads : {1, 4}) {
            const Threads scope(threads);
            const Array<Index> part = parts_of(rings);
            EXPECT_TRUE(std::equal(part.begin(), part.end(), least.begin(), least.end()));
        }
    }
}

TEST_P(EveryHierarchy, KeepsRingsTopologyAndNormals) {
    const auto [grouping, options] = groupings()[GetParam()];
    for (const auto& [name, mesh] : every_class()) {
        SCOPED_TRACE(name + ", " + grouping);
        const Hierarchy h = hierarchy_of(mesh, options);
        expect_hierarchy(h, mesh, options, mesh.positions.size() > 300 ? 37 : 1);
    }
}

TEST_P(EveryHierarchy, KeepsRingsTopologyAndNormalsOfRandomMeshes) {
    auto [grouping, options] = groupings()[GetParam()];
    options.base_vertices = 4;
    for (std::uint64_t seed = 1; seed <= 400; ++seed) {
        const bool soup = seed % 2 == 0;
        SCOPED_TRACE((soup ? "random_soup(" : "damaged_mesh(") + std::to_string(seed) + "), " + grouping);
        const Mesh mesh = soup ? random_soup(seed) : damaged_mesh(seed);
        options.normal_limit_degrees = seed % 3 == 0 ? 180 : 60;
        options.length_weight = seed % 5 == 0 ? 0 : 0.1;
        options.split = seed % 4 < 2 ? Split::quadric : Split::regression_plane;
        expect_hierarchy(hierarchy_of(mesh, options), mesh, options, soup ? 1 : 17);
        if (HasFailure()) return;
    }
}

TEST_P(EveryHierarchy, KeepsTopologyWithFeatures) {
    auto [grouping, options] = groupings()[GetParam()];
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        SCOPED_TRACE("damaged_mesh(" + std::to_string(seed) + "), " + grouping);
        const Mesh mesh = damaged_mesh(seed);
        options.split = seed % 4 < 2 ? Split::quadric : Split::regression_plane;
        const Hierarchy h = hierarchy_of(mesh, options, 25);
        expect_numbering(h, mesh, options);
        expect_topology(h, mesh, 17);
        expect_marks_agree(h);
        if (HasFailure()) return;
    }
}

INSTANTIATE_TEST_SUITE_P(Groupings, EveryHierarchy, testing::Range(0, 4));

/// All costs of a vertex at once are those of its quadric, and the cheapest is the first of the least.
TEST(Hierarchy, FreshCostsAreThoseOfTheQuadric) {
    int taken = 0;
    for (const auto& [name, mesh] : fixtures::every_class()) {
        SCOPED_TRACE(name);
        const Rings rings = vertex_rings(mesh);
        for (Index v = 0; v < rings.rows(); ++v) {
            const collapse::Ring ring = collapse::ring_of(rings, v);
            if (!collapse::FreshCosts::takes(ring)) continue;
            ++taken;
            const Quadric q = collapse::vertex_quadric(v, ring, mesh.positions);
            const collapse::FreshCosts costs(v, ring, mesh.positions, 0.1);
            Index cheapest = 0;
            for (Index j = 0; j < ring.size; ++j) {
                const Vec3 d = mesh.positions[ring.vertex[j]] - mesh.positions[v];
                const double expected = collapse::cost(q, 0, d, 0.1);
                ASSERT_NEAR(costs[j], expected, 1e-14 * q.weight() * d.squaredNorm());
                if (costs[j] < costs[cheapest]) cheapest = j;
            }
            ASSERT_EQ(costs.cheapest(), cheapest);
        }
    }
    EXPECT_GT(taken, 1000);
}

TEST(Hierarchy, RegressionPlaneEmptiesFlatPartsFirst) {
    const Mesh mesh = shapes::block(16);
    const Rings rings = vertex_rings(mesh);
    std::vector<std::uint8_t> bent(mesh.positions.size());
    for (Index v = 0; v < rings.rows(); ++v) {
        const collapse::Ring ring = collapse::ring_of(rings, v);
        bent[v] = collapse::distance_from_ring(v, ring, collapse::Directions(ring), mesh.positions) > 1e-6;
    }
    const auto all = std::accumulate(bent.begin(), bent.end(), 0);
    ASSERT_LT(all, static_cast<int>(bent.size()) / 3);
    HierarchyOptions options;
    options.grouping = Grouping::sequential;
    options.split = Split::regression_plane;
    const Hierarchy h = hierarchy_of(mesh, options);
    int kept = 0;
    for (Index p = 0; p < all; ++p) kept += bent[h.order[p]];
    EXPECT_GT(kept, 0.9 * all) << "of " << all;
}

TEST(Hierarchy, RegressionPlaneTurnsFacesLeast) {
    // A ridge along x through the vertex 0: along it no face turns, across it all do.
    const ClosedStar star({{0, 0, 1}, {1, 0, 1}, {0.5, 1, 0}, {-0.5, 1, 0}, {-1, 0, 1}, {-0.5, -1, 0}, {0.5, -1, 0}});
    const collapse::Ring ring = collapse::ring_of(star.rings, 0);
    EXPECT_NEAR(collapse::sum_of_turns(0, 1, ring, star.positions), 0, 1e-15);
    EXPECT_NEAR(collapse::sum_of_turns(0, 4, ring, star.positions), 0, 1e-15);
    for (const Index u : {2, 3, 5, 6}) EXPECT_GT(collapse::sum_of_turns(0, u, ring, star.positions), 0.1);
    const collapse::Directions directions(ring);
    EXPECT_NEAR(collapse::distance_from_ring(0, ring, directions, star.positions), 2.0 / 3, 1e-12);
}

TEST(Hierarchy, LevelZeroIsTheInput) {
    for (const auto& [name, mesh] : every_class()) {
        SCOPED_TRACE(name);
        const Hierarchy h = hierarchy_of(mesh);
        const LevelMesh level = level_mesh(h, mesh.faces, 0);
        ASSERT_EQ(level.faces.size(), mesh.faces.size());
        for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
            EXPECT_EQ(level.source_face[f], static_cast<Index>(f));
            for (int k = 0; k < 3; ++k) EXPECT_EQ(h.order[level.faces[f][k]], mesh.faces[f][k]);
        }
    }
}

TEST(Hierarchy, FacesOfALevelComeFromFacesThatLedThere) {
    const Mesh mesh = shapes::scan(800);
    const Hierarchy h = hierarchy_of(mesh);
    std::vector<Index> place(h.vertices());
    for (Index p = 0; p < h.vertices(); ++p) place[h.order[p]] = p;
    for (std::size_t k = 0; k < h.size.size(); ++k) {
        const LevelMesh level = level_mesh(h, mesh.faces, k);
        ASSERT_EQ(level.faces.size(), level.source_face.size());
        for (std::size_t f = 0; f < level.faces.size(); ++f)
            for (int c = 0; c < 3; ++c) {
                Index p = place[mesh.faces[level.source_face[f]][c]];
                while (p >= h.size[k]) p = h.parent[p];
                EXPECT_EQ(p, level.faces[f][c]);
            }
    }
}

TEST(Hierarchy, MoreSetsPerLevelGroupTheSameCollapses) {
    const Mesh mesh = shapes::scan(1500);
    HierarchyOptions options;
    const Hierarchy one = hierarchy_of(mesh, options);
    options.sets_per_level = 3;
    const Hierarchy three = hierarchy_of(mesh, options);
    EXPECT_EQ(one.order, three.order);
    EXPECT_EQ(one.parent, three.parent);
    for (std::size_t k = 0; k < three.size.size(); ++k)
        EXPECT_EQ(three.size[k], one.size[std::min(3 * k, one.size.size() - 1)]);
    EXPECT_EQ(three.levels[0].sets(), 3U);
}

TEST(Hierarchy, SequentialGroupingsCutOneSequence) {
    const Mesh mesh = shapes::scan(700);
    HierarchyOptions options;
    options.grouping = Grouping::sequential;
    const Hierarchy single = hierarchy_of(mesh, options);
    options.level_ratio = 0.8;
    const Hierarchy ratio = hierarchy_of(mesh, options);
    EXPECT_EQ(single.order, ratio.order);
    EXPECT_EQ(single.parent, ratio.parent);
    EXPECT_EQ(single.levels.size(), static_cast<std::size_t>(single.vertices() - single.size.back()));
    for (std::size_t k = 0; k + 2 < ratio.size.size(); ++k) EXPECT_NEAR(ratio.size[k + 1], 0.8 * ratio.size[k], 1);
    EXPECT_EQ(ratio.size.back(), options.base_vertices);
}

TEST(Hierarchy, ValencePowerKeepsHubs) {
    const Mesh mesh = shapes::irregular_sphere(3000);
    const auto mean_valence = [&](int power) {  // of the vertices the first level takes
        HierarchyOptions options;
        options.set_share = 0.5;
        options.valence_power = power;
        const Hierarchy h = hierarchy_of(mesh, options);
        const RowRange rows = h.levels[0].odd;
        double sum = 0;
        for (Index r = rows.begin; r < rows.end; ++r) sum += h.odd.size(r);
        return sum / rows.size();
    };
    EXPECT_LT(mean_valence(3), mean_valence(0) - 0.1);
}

TEST(Hierarchy, ASetRemovesAFifthToAThird) {
    for (const Mesh& mesh : {shapes::scan(5000), shapes::irregular_sphere(3000), shapes::plane(50),
                             shapes::terrain(50).mesh, shapes::block(20)}) {
        const Hierarchy h = hierarchy_of(mesh);
        ASSERT_EQ(h.size.back(), 100);
        for (std::size_t k = 0; k + 2 < h.size.size(); ++k) {  // the last set stops at the base
            if (h.size[k] < 400) break;                        // small levels have few vertices to choose from
            const double share = 1 - static_cast<double>(h.size[k + 1]) / h.size[k];
            EXPECT_GT(share, 0.15) << "level " << k << " of " << h.size[0];
            EXPECT_LT(share, 0.30) << "level " << k << " of " << h.size[0];
        }
    }
}

TEST(Hierarchy, StopsAtTheBaseAndBelowItStaysWhole) {
    const Mesh mesh = shapes::scan(600);
    for (auto [grouping, options] : groupings(77)) {
        EXPECT_EQ(hierarchy_of(mesh, options).size.back(), 77) << grouping;
        options.base_vertices = 600000;
        const Hierarchy h = hierarchy_of(mesh, options);
        EXPECT_TRUE(h.levels.empty()) << grouping;
        EXPECT_EQ(h.base.rows(), h.vertices());
    }
}

TEST(Hierarchy, BoundaryVerticesStayOnTheBoundary) {
    for (const Mesh& mesh : {shapes::plane(16), shapes::open_cylinder(24, 12), shapes::moebius_band(30, 6)})
        for (const auto& [grouping, options] : groupings(12)) {
            SCOPED_TRACE(grouping);
            const Rings input = vertex_rings(mesh);
            const Hierarchy h = hierarchy_of(mesh, options);
            for (Index p = h.size.back(); p < h.vertices(); ++p) {
                const Index v = h.order[p], parent = h.order[h.parent[p]];
                EXPECT_TRUE(input.kind[v] == RingKind::closed || input.kind[parent] == RingKind::open);
            }
            const Rings base = vertex_rings(mesh_of_prefix(h, mesh, h.size.back()));
            for (Index p = 0; p < h.size.back(); ++p) EXPECT_EQ(base.kind[p], input.kind[h.order[p]]);
        }
}

TEST(Hierarchy, CreaseVerticesGoAlongCreasesAndCornersStay) {
    const Mesh mesh = shapes::block(8);
    const Rings rings = marked_rings(mesh, 30);
    const auto creases_at = [&](Index v) {
        const Row row = row_of(rings, v);
        return std::count_if(row.feature.begin(), row.feature.end(), [](const auto& f) { return f.second; });
    };
    for (const auto& [grouping, options] : groupings(40)) {
        SCOPED_TRACE(grouping);
        const Hierarchy h = hierarchy_of(mesh, options, 30);
        Index removed_from_creases = 0;
        for (Index p = h.size.back(); p < h.vertices(); ++p) {
            const Index v = h.order[p], parent = h.order[h.parent[p]];
            EXPECT_TRUE(creases_at(v) == 0 || creases_at(v) == 2) << "corner " << v << " was removed";
            EXPECT_TRUE(creases_at(v) == 0 || creases_at(parent) >= 2) << v << " left its crease";
            removed_from_creases += creases_at(v) == 2;
        }
        EXPECT_GT(removed_from_creases, 50);
        expect_marks_agree(h);
        // The creases of the base run between vertices of creases, and as many meet in each as did.
        for (Index p = 0; p < h.size.back(); ++p) {
            const Row row = row_of(h.base, p);
            Index creases = 0;
            for (const auto& [w, marked] : row.feature) {
                creases += marked;
                EXPECT_TRUE(!marked || creases_at(h.order[w]) > 0);
            }
            EXPECT_EQ(creases, creases_at(h.order[p]));
        }
    }
}

TEST(Hierarchy, DoesNotDependOnThreads) {
    const Mesh mesh = shapes::scan(6000);
    for (const auto& [grouping, options] : groupings(100)) {
        SCOPED_TRACE(grouping);
        Hierarchy one, two;
        {
            const Threads threads(1);
            one = hierarchy_of(mesh, options, 20);
        }
        {
            const Threads threads(2);
            two = hierarchy_of(mesh, options, 20);
        }
        expect_same(one, two);
    }
}

TEST(Hierarchy, MovesWithTheMesh) {
    const Mesh mesh = shapes::scan(1500);
    for (const auto& [grouping, options] : groupings(50)) {
        SCOPED_TRACE(grouping);
        const Hierarchy h = hierarchy_of(mesh, options);
        Motion motion;
        for (const double scale : {1.0, 1e-3, 1e20}) {
            motion.scale = scale;
            motion.offset *= scale;
            expect_same(hierarchy_of(motion(mesh), options), h);
        }
    }
}

TEST(Hierarchy, TicksRiseAndMayStopTheBuild) {
    const Mesh mesh = shapes::scan(5000);
    struct Stop {};
    for (const auto& [grouping, options] : groupings(50)) {
        SCOPED_TRACE(grouping);
        std::vector<double> ticks;
        build_hierarchy(vertex_rings(mesh), mesh.positions, options, [&](double f) { ticks.push_back(f); });
        EXPECT_GE(ticks.size(), 4u);
        EXPECT_TRUE(std::is_sorted(ticks.begin(), ticks.end()));
        EXPECT_GE(ticks.front(), 0);
        EXPECT_LE(ticks.back(), 1);
        EXPECT_THROW(build_hierarchy(vertex_rings(mesh), mesh.positions, options, [](double) { throw Stop(); }), Stop);
    }
}

TEST(Hierarchy, BoundaryThatIsCoarserThanTheSurfaceWaits) {
    Mesh mesh = shapes::open_cylinder(64, 20);
    std::vector<Index> rim;
    for (Index v = 0; v < static_cast<Index>(mesh.positions.size()); ++v)
        if (mesh.positions[v].z() < -0.999) rim.push_back(v);
    ASSERT_EQ(rim.size(), 64u);
    const auto angle = [&](Index v) { return std::atan2(mesh.positions[v].y(), mesh.positions[v].x()); };
    std::sort(rim.begin(), rim.end(), [&](Index a, Index b) { return angle(a) < angle(b); });
    std::vector<Index> to(mesh.positions.size());
    std::iota(to.begin(), to.end(), 0);
    for (std::size_t i = 0; i < rim.size(); ++i) to[rim[i]] = rim[i - i % 4];  // edges of four times the length
    Faces faces;
    for (const Face& f : mesh.faces) {
        const Face g{to[f[0]], to[f[1]], to[f[2]]};
        if (g[0] != g[1] && g[1] != g[2] && g[2] != g[0]) faces.push_back(g);
    }
    mesh.faces = faces;
    const auto left = [&](double length_weight) {
        HierarchyOptions options;
        options.length_weight = length_weight;
        options.sets_per_level = 3;
        const Hierarchy h = hierarchy_of(mesh, options);
        int count = 0;
        for (Index place = 0; place < h.size[1]; ++place)
            count +=
                to[h.order[place]] == h.order[place] && std::find(rim.begin(), rim.end(), h.order[place]) != rim.end();
        return count;
    };
    EXPECT_EQ(left(0.1), 16);
    EXPECT_LT(left(0), 16);
}

TEST(Hierarchy, ThinTrianglesAreTakenLikeOthers) {
    const auto sizes = [](double aspect) {
        constexpr Index around = 100, along = 30;
        HierarchyOptions options;
        options.base_vertices = 100;
        const double height = aspect * 2 * pi / around * along;
        return hierarchy_of(shapes::open_cylinder(around, along, 1, height), options).size;
    };
    const auto even = sizes(2);
    for (const double aspect : {30.0, 80.0, 300.0}) {
        SCOPED_TRACE(aspect);
        const auto thin = sizes(aspect);
        EXPECT_LE(thin.back(), even.back() + 10);
        EXPECT_LE(thin.size(), even.size() + 1);
    }
}

}  // namespace multires
