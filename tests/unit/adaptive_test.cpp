#include "filters/layers/adaptive.h"

#include "filters/layers/adaptive_search.h"
#include "filters/layers/texture_seams.h"
#include "hierarchy/simplify.h"
#include "hierarchy_checks.h"
#include "measure/distance.h"
#include "measure/measure.h"
#include "measure/vertex_normals.h"

#include <cmath>
#include <limits>

using namespace multires;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

Layer layer_of(const Mesh& mesh) {
    Layer layer;
    layer.mesh = mesh;
    return layer;
}

AdaptiveOptions with_threshold(double percent) {
    AdaptiveOptions o;
    o.geometry.threshold = percent;
    o.base_vertices = 8;
    o.measure = false;
    return o;
}

Result run(const Layer& layer, const AdaptiveOptions& o) {
    Session session;
    return adaptive_reconstruction(layer, o, session);
}

double value(const Result& r, const std::string& key) {
    for (const Report::Entry& e : r.report.entries())
        if (e.key == key)
            return std::holds_alternative<int>(e.value) ? std::get<int>(e.value) : std::get<double>(e.value);
    ADD_FAILURE() << "no " << key;
    return 0;
}

Mesh mesh_of(const DerivedMesh& d, const Mesh& input) {
    Mesh mesh;
    mesh.faces = d.faces;
    if (d.positions)
        mesh.positions = *d.positions;
    else
        for (const Index v : d.source_vertex) mesh.positions.push_back(input.positions[v]);
    return mesh;
}

std::set<Index> vertices_of(const Result& r) { return {r.layer->source_vertex.begin(), r.layer->source_vertex.end()}; }

/// Every face once: the surface without copies and backs of faces.
Mesh once(const Mesh& mesh) {
    Mesh out{mesh.positions, {}};
    std::set<Face> seen;
    std::vector<Face> kept;
    for (const Face& f : mesh.faces) {
        Face sorted = f;
        std::sort(sorted.begin(), sorted.end());
        if (seen.insert(sorted).second) kept.push_back(f);
    }
    out.faces = Faces(kept.begin(), kept.end());
    return out;
}

/// A mesh on vertices of the input, whose surface has the topology of the input's.
void expect_valid(const DerivedMesh& d, const Mesh& input_with_copies) {
    const Mesh mesh_with_copies = mesh_of(d, input_with_copies);
    ASSERT_EQ(d.faces.size(), d.source_face.size());
    ASSERT_TRUE(std::is_sorted(d.source_vertex.begin(), d.source_vertex.end()));
    EXPECT_LE(count_input(mesh_with_copies).duplicate_faces, count_input(input_with_copies).duplicate_faces);
    const Mesh mesh = once(mesh_with_copies), input = once(input_with_copies);
    const InputCounts before = count_input(input), after = count_input(mesh);
    EXPECT_EQ(fixtures::euler(mesh), fixtures::euler(input));
    EXPECT_EQ(after.components, before.components);
    EXPECT_EQ(after.boundary_loops, before.boundary_loops);
    EXPECT_EQ(after.non_manifold_edges, before.non_manifold_edges);
    EXPECT_EQ(after.non_manifold_vertices, before.non_manifold_vertices);
    EXPECT_EQ(after.non_orientable_components, before.non_orientable_components);
    EXPECT_LE(after.inconsistent_edges, before.inconsistent_edges);
    EXPECT_LE(after.zero_area_faces, before.zero_area_faces);
}

/// Executes the collapses of a closed set one by one: each must turn no face by more than the limit.
void expect_collapses_allowed(const Hierarchy& h, const Mesh& mesh, const std::vector<std::uint8_t>& in, double limit) {
    std::vector<std::uint8_t> now(h.vertices(), 1);
    LevelMesh before = mesh_of_set(h, mesh.faces, now);
    for (Index p = h.vertices() - 1; p >= 0; --p) {
        if (in[p]) continue;
        now[p] = 0;
        LevelMesh after = mesh_of_set(h, mesh.faces, now);
        for (std::size_t i = 0, j = 0; j < after.faces.size(); ++j) {
            while (before.source_face[i] != after.source_face[j]) ++i;
            const auto normal = [&](const Face& f) -> Vec3 {
                return (h.positions[f[1]] - h.positions[f[0]]).cross(h.positions[f[2]] - h.positions[f[0]]);
            };
            const Vec3 n = normal(before.faces[i]), m = normal(after.faces[j]);
            if (before.faces[i] == after.faces[j] || n.norm() < 1e-12) continue;
            ASSERT_LE(std::atan2(n.cross(m).norm(), n.dot(m)) * 180 / std::acos(-1.0), limit + 1e-6);
        }
        before = std::move(after);
    }
}

}  // namespace

// ---- closed sets
// -----------------------------------------------------------------------------------------------------

TEST(Refinement, PrefixesOfTheOrderAreClosedAndNested) {
    shapes::Random random(11);
    for (const auto& [name, options] : fixtures::groupings()) {
        SCOPED_TRACE(name);
        const Mesh mesh = shapes::scan(600);
        const Hierarchy h = fixtures::hierarchy_of(mesh, options);
        std::vector<double> importance(h.vertices());
        for (double& x : importance) x = random.chance(0.2) ? 1 : random.uniform(0, 1);  // with ties
        const Insertion insertion = insertion_order(h, importance);
        std::vector<Index> rank(h.vertices());
        for (Index i = 0; i < h.vertices(); ++i) rank[insertion.order[i]] = i;
        for (Index r = 0; r < h.odd.rows(); ++r) {
            const Index p = h.odd.vertex(r);
            ASSERT_GE(insertion.key[p], importance[p]);
            for (Index j = 0; j < h.odd.size(r); ++j) ASSERT_LT(rank[h.odd.begin(r)[j]], rank[p]);
        }
        for (Index i = 1; i < h.vertices(); ++i)
            ASSERT_GE(insertion.key[insertion.order[i - 1]], insertion.key[insertion.order[i]]);
        EXPECT_EQ(insertion.count(0), h.vertices());
        EXPECT_EQ(insertion.count(infinity), h.size.back());
        EXPECT_EQ(insertion.count(2), h.size.back());
    }
}

/// Any importance at all gives valid meshes, whatever the class of mesh and the grouping.
TEST(Refinement, EveryClosedSetGivesTheTopologyOfTheInput) {
    shapes::Random random(12);
    for (const auto& [name, mesh] : fixtures::every_class())
        for (const auto& [grouping, options] : fixtures::groupings()) {
            SCOPED_TRACE(name + ", " + grouping);
            const Hierarchy h = fixtures::hierarchy_of(mesh, options);
            std::vector<double> importance(h.vertices());
            for (double& x : importance) x = random.uniform(0, 1);
            const Insertion insertion = insertion_order(h, importance);
            Index faces =
                static_cast<Index>(mesh_of_set(h, mesh.faces, inserted(insertion, h.size.back())).faces.size());
            Index count = h.size.back();
            for (const double share : {0.0, 0.1, 0.35, 0.7, 1.0}) {
                const Index next = h.size.back() + static_cast<Index>(share * (h.vertices() - h.size.back()));
                for (; count < next; ++count) faces += insertion.faces[insertion.order[count]];
                const LevelMesh got = mesh_of_set(h, mesh.faces, inserted(insertion, count));
                const Mesh now{h.positions, got.faces};
                const InputCounts before = count_input(mesh), after = count_input(now);
                if (before.degenerate_faces == 0) {
                    ASSERT_EQ(static_cast<Index>(got.faces.size()), faces);
                }
                ASSERT_EQ(fixtures::euler(now), fixtures::euler(mesh));
                ASSERT_EQ(after.components, before.components);
                ASSERT_EQ(after.boundary_loops, before.boundary_loops);
                ASSERT_EQ(after.non_manifold_edges, before.non_manifold_edges);
                ASSERT_EQ(after.non_manifold_vertices, before.non_manifold_vertices);
                ASSERT_EQ(after.duplicate_faces, before.duplicate_faces);
            }
        }
}

TEST(Refinement, CollapsesOutsideAClosedSetStayAllowed) {
    shapes::Random random(13);
    for (const auto& mesh : {shapes::irregular_sphere(300), shapes::plane(12), shapes::block(3)})
        for (const auto& [grouping, options] : fixtures::groupings()) {
            const Hierarchy h = fixtures::hierarchy_of(mesh, options);
            std::vector<double> importance(h.vertices());
            for (double& x : importance) x = random.uniform(0, 1);
            const Insertion insertion = insertion_order(h, importance);
            expect_collapses_allowed(h, mesh, inserted(insertion, h.vertices() / 3), options.normal_limit_degrees);
        }
}

TEST(Refinement, PrefixesOfLevelsAreTheLevels) {
    const Mesh mesh = shapes::scan(800);
    const Hierarchy h = fixtures::hierarchy_of(mesh);
    for (const Index size : h.size) {
        std::vector<std::uint8_t> in(h.vertices(), 0);
        std::fill_n(in.begin(), size, 1);
        EXPECT_EQ(mesh_of_set(h, mesh.faces, in).faces, prefix_mesh(h, mesh.faces, size).faces);
    }
}

/// Small sets and memoryless costs keep all that a hierarchy promises.
TEST(Refinement, AdaptiveHierarchiesAreHierarchies) {
    for (const auto& [name, mesh] : fixtures::every_class()) {
        SCOPED_TRACE(name);
        HierarchyOptions options;
        options.base_vertices = 8;
        options.length_weight = 0;
        options.set_share = 0.5;
        options.memoryless = true;
        options.boundary_weight = boundary_weight;
        fixtures::expect_hierarchy(fixtures::hierarchy_of(mesh, options), mesh, options, 7);
    }
}

TEST(Refinement, MemorylessCostsAndSmallSetsCostLess) {
    const Mesh mesh = shapes::scan(10000);
    const auto error = [&](double share, bool memoryless) {
        HierarchyOptions options;
        options.length_weight = 0;
        options.set_share = share;
        options.memoryless = memoryless;
        const Mesh coarse = fixtures::mesh_of_prefix(fixtures::hierarchy_of(mesh, options), mesh, 1000);
        return two_sided_distance(mesh.faces, mesh.positions, coarse.faces, coarse.positions).rms;
    };
    const double plain = error(1, false), small = error(0.5, false);
    EXPECT_LT(small, 0.9 * plain);
    EXPECT_LT(error(0.5, true), small);
}

// ---- thresholds
// ------------------------------------------------------------------------------------------------------

TEST(Adaptive, ThresholdZeroIsTheInputOnEveryClass) {
    for (const auto& [name, mesh] : fixtures::every_class()) {
        SCOPED_TRACE(name);
        const Result r = run(layer_of(mesh), with_threshold(0));
        EXPECT_EQ(r.layer->faces, mesh.faces);
        ASSERT_EQ(r.layer->source_vertex.size(), mesh.positions.size());
        for (std::size_t v = 0; v < mesh.positions.size(); ++v) ASSERT_EQ(r.layer->source_vertex[v], Index(v));
        for (std::size_t f = 0; f < mesh.faces.size(); ++f) ASSERT_EQ(r.layer->source_face[f], Index(f));
    }
}

TEST(Adaptive, ThresholdAboveEverythingIsTheBase) {
    for (const auto& [name, mesh] : fixtures::every_class()) {
        SCOPED_TRACE(name);
        const AdaptiveOptions o = with_threshold(1e9);
        const Result r = run(layer_of(mesh), o);
        const Hierarchy h = adaptive_hierarchy(layer_of(mesh), adaptive_rings(layer_of(mesh), o), o, Progress());
        EXPECT_EQ(vertices_of(r), std::set<Index>(h.order.begin(), h.order.begin() + h.size.back()));
        EXPECT_EQ(value(r, "vertices"), value(r, "base_vertices"));
        EXPECT_EQ(value(r, "faces"), value(r, "base_faces"));
    }
}

TEST(Adaptive, EveryThresholdGivesAValidMeshAndNestedVertices) {
    for (const auto& [name, mesh] : fixtures::every_class())
        for (const Criterion criterion : {Criterion::area_error, Criterion::local_error, Criterion::detail}) {
            SCOPED_TRACE(name + ", criterion " + std::to_string(static_cast<int>(criterion)));
            std::set<Index> finer;
            for (const double threshold : {0.0, 1e-4, 0.01, 0.1, 0.5, 2.0, 10.0, 1e9}) {
                AdaptiveOptions o = with_threshold(threshold);
                o.criterion = criterion;
                const Result r = run(layer_of(mesh), o);
                expect_valid(*r.layer, mesh);
                const std::set<Index> now = vertices_of(r);
                if (threshold > 0) {
                    EXPECT_TRUE(std::includes(finer.begin(), finer.end(), now.begin(), now.end()));
                }
                finer = now;
            }
        }
}

TEST(Adaptive, DamagedMeshesGiveValidMeshes) {
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        SCOPED_TRACE(seed);
        const Mesh mesh = seed % 3 ? fixtures::damaged_mesh(seed) : fixtures::random_soup(seed);
        for (const double threshold : {0.05, 1.0, 1e9}) {
            AdaptiveOptions o = with_threshold(threshold);
            o.base_vertices = 4;
            try {
                expect_valid(*run(layer_of(mesh), o).layer, mesh);
            } catch (const InputError&) {
            }
        }
    }
}

TEST(Adaptive, PlanesNeedNoVertices) {
    const Result r = run(layer_of(shapes::plane(20)), with_threshold(0.001));
    EXPECT_LE(value(r, "vertices"), 12);
}

TEST(Adaptive, DoesNotDependOnScalePlaceOrThreads) {
    const Mesh mesh = shapes::scan(2000);
    const Result here = run(layer_of(mesh), with_threshold(0.2));
    for (const double scale : {1e-20, 1.0, 1e20}) {
        fixtures::Motion motion;
        motion.rotation.setIdentity();
        motion.scale = scale;
        motion.offset *= scale;
        const fixtures::Threads threads(scale > 1 ? 1 : 3);
        const Result there = run(layer_of(motion(mesh)), with_threshold(0.2));
        EXPECT_NEAR(value(there, "vertices"), value(here, "vertices"), 0.02 * value(here, "vertices"));
    }
    const fixtures::Threads one(1);
    EXPECT_EQ(run(layer_of(mesh), with_threshold(0.2)).layer->faces, here.layer->faces);
}

TEST(Adaptive, MeshUnitsAndPercentAgree) {
    const Layer layer = layer_of(shapes::scan(1500));
    AdaptiveOptions o = with_threshold(0.3 / 100 * box_diagonal(layer));
    o.unit = LengthUnit::mesh;
    EXPECT_EQ(run(layer, o).layer->faces, run(layer, with_threshold(0.3)).layer->faces);
}

// ---- targets
// ---------------------------------------------------------------------------------------------------------

TEST(Adaptive, MeetsFaceAndVertexCounts) {
    for (const auto& mesh :
         {shapes::scan(3000), shapes::plane(40), shapes::block(8), shapes::unreferenced_vertices()}) {
        const Layer layer = layer_of(mesh);
        for (const auto& [share, fit] : {std::pair(0.9, false), {0.5, false}, {0.3, false}, {0.9, true}, {0.3, true}}) {
            AdaptiveOptions o = with_threshold(0);
            o.fit = fit;
            o.target = Target::faces;
            o.faces = static_cast<int>(share * static_cast<double>(mesh.faces.size()));
            const double faces = value(run(layer, o), "faces");
            EXPECT_LE(faces, o.faces);
            EXPECT_GE(faces, o.faces - 1);
            o.target = Target::vertices;
            o.vertices = static_cast<int>(share * static_cast<double>(mesh.positions.size()));
            const Result r = run(layer, o);
            EXPECT_EQ(value(r, "vertices") - value(r, "unreferenced_vertices"), o.vertices);
        }
        AdaptiveOptions o = with_threshold(0);
        o.target = Target::faces;
        o.faces = 0;
        const Result least = run(layer, o);
        EXPECT_EQ(value(least, "faces"), value(least, "base_faces"));
        o.faces = 1 << 30;
        EXPECT_EQ(run(layer, o).layer->faces, mesh.faces);
    }
}

TEST(Adaptive, TargetIsTheMeshOfTheThresholdItReports) {
    const Layer layer = layer_of(shapes::scan(2000));
    AdaptiveOptions o = with_threshold(7);
    o.target = Target::faces;
    o.faces = 600;
    const Result r = run(layer, o);
    const double threshold = value(r, "geometry_threshold_used");
    // The target may cut between vertices that matter equally.
    const auto at = [&](double factor) { return vertices_of(run(layer, with_threshold(threshold * factor))); };
    const std::set<Index> here = vertices_of(r), finer = at(1 - 1e-9), coarser = at(1 + 1e-9);
    EXPECT_TRUE(std::includes(finer.begin(), finer.end(), here.begin(), here.end()));
    EXPECT_TRUE(std::includes(here.begin(), here.end(), coarser.begin(), coarser.end()));
    EXPECT_LT(finer.size(), coarser.size() + 30);
}

TEST(Adaptive, HonoursErrorBounds) {
    const Layer layer = layer_of(shapes::scan(3000));
    for (const bool fit : {false, true})
        for (const double percent : {0.05, 0.3, 50.0}) {
            AdaptiveOptions o = with_threshold(1);
            o.error = percent;
            o.fit = fit;
            o.target = Target::largest_distance;
            const Result largest = run(layer, o);
            EXPECT_LE(value(largest, "largest_distance_percent"), percent);
            o.target = Target::rms_distance;
            const Result rms = run(layer, o);
            EXPECT_LE(value(rms, "rms_distance_percent"), percent);
            EXPECT_LE(value(rms, "faces"), value(largest, "faces"));
            if (percent == 50) {
                EXPECT_EQ(value(largest, "faces"), value(largest, "base_faces"));
            }
            // What is reported is what is there.
            const Mesh mesh = mesh_of(*rms.layer, layer.mesh);
            const Distance d = two_sided_distance(layer.mesh.faces, layer.mesh.positions, mesh.faces, mesh.positions);
            EXPECT_EQ(d.rms, value(rms, "rms_distance"));
            EXPECT_EQ(d.largest, value(rms, "largest_distance"));
        }
}

TEST(Adaptive, ErrorBoundsAreNotWasted) {
    const Layer layer = layer_of(shapes::scan(5000));
    AdaptiveOptions o = with_threshold(1);
    o.target = Target::rms_distance;
    o.error = 0.1;
    EXPECT_GE(value(run(layer, o), "rms_distance_percent"), 0.095);
}

// ---- criteria
// --------------------------------------------------------------------------------------------------------

TEST(Adaptive, IsBetterThanTheLevelsOfThePyramid) {
    const Layer layer = layer_of(shapes::scan(10000));
    AdaptiveOptions o = with_threshold(1);
    o.target = Target::faces;
    o.faces = 2000;
    o.measure = true;
    const double adaptive = value(run(layer, o), "rms_distance");
    const Hierarchy h = fixtures::hierarchy_of(layer.mesh);
    const Mesh level = fixtures::mesh_of_prefix(h, layer.mesh, 1002);
    const double uniform = two_sided_distance(layer.mesh.faces, layer.mesh.positions, level.faces, level.positions).rms;
    EXPECT_LT(adaptive, 0.7 * uniform);
    o.fit = true;
    EXPECT_LT(value(run(layer, o), "rms_distance"), 0.7 * adaptive);
}

TEST(Adaptive, ColourKeepsVerticesWhereColourChanges) {
    Layer layer = layer_of(shapes::plane(30));
    Attribute color{AttributeKind::color, "", 4, {}};
    for (const Vec3& p : layer.mesh.positions) {
        const double value = p.x() < 0.5 ? 0 : 255;
        for (const double c : {value, value, value, 255.0}) color.values.push_back(c);
    }
    layer.attributes.push_back(color);
    AdaptiveOptions o = with_threshold(0.01);
    const double without = value(run(layer, o), "vertices");
    o.color.use = true;
    const Result r = run(layer, o);
    EXPECT_GT(value(r, "vertices"), without + 40);
    expect_valid(*r.layer, layer.mesh);
    // No face of the result holds both colours but those at the edge.
    const Mesh mesh = mesh_of(*r.layer, layer.mesh);
    double wrong = 0;
    for (const Face& f : mesh.faces) {
        double low = 1, high = 0;
        for (const Index v : f)
            low = std::min(low, mesh.positions[v].x()), high = std::max(high, mesh.positions[v].x());
        if (low < 0.5 && high >= 0.5) wrong = std::max(wrong, high - low);
    }
    EXPECT_LT(wrong, 0.15);
}

TEST(Adaptive, QualityTexcoordAndNormalKeepVertices) {
    Layer layer = layer_of(shapes::plane(30));
    Attribute quality{AttributeKind::quality, "", 1, {}}, texcoord{AttributeKind::texcoord, "", 2, {}};
    for (const Vec3& p : layer.mesh.positions) {
        quality.values.push_back(std::sin(20 * p.x()));
        texcoord.values.insert(texcoord.values.end(), {p.x(), p.y() + 0.1 * std::sin(20 * p.y())});
    }
    layer.attributes = {quality, texcoord};
    AdaptiveOptions o = with_threshold(0.01);
    const double without = value(run(layer, o), "vertices");
    o.quality = {true, 0.1};
    EXPECT_GT(value(run(layer, o), "vertices"), without + 20);
    o.quality.use = false;
    o.texcoord = {true, 0.01};
    EXPECT_GT(value(run(layer, o), "vertices"), without + 20);
    o.texcoord.use = false;
    o.normal = {true, 5};
    EXPECT_EQ(value(run(layer, o), "vertices"), without);
    Layer block = layer_of(shapes::block(10));
    const double plain = value(run(block, with_threshold(2)), "vertices");
    o = with_threshold(2);
    o.normal = {true, 10};
    EXPECT_GT(value(run(block, o), "vertices"), plain + 10);
}

TEST(Adaptive, SeamsOfWedgesStaySeams) {
    // A plane whose left and right halves are two charts that meet at x = 0.5.
    Layer layer = layer_of(shapes::plane(20, {0, 0, 1}));
    for (const Face& f : layer.mesh.faces) {
        double centre = 0;
        for (const Index v : f) centre += layer.mesh.positions[v].x() / 3;
        for (const Index v : f)
            layer.wedges.push_back({layer.mesh.positions[v].x() + (centre < 0.5 ? 0 : 3), layer.mesh.positions[v].y()});
    }
    AdaptiveOptions o = with_threshold(0.001);
    o.texcoord = {true, 0.001};
    const Result r = run(layer, o);
    EXPECT_LE(value(r, "vertices"), 20) << "linear texture coordinates need no vertices";
    const Mesh mesh = mesh_of(*r.layer, layer.mesh);
    for (const Face& f : mesh.faces) {
        double low = 1, high = 0;
        for (const Index v : f)
            low = std::min(low, mesh.positions[v].x()), high = std::max(high, mesh.positions[v].x());
        EXPECT_FALSE(low < 0.5 - 1e-9 && high > 0.5 + 1e-9) << "a face crosses the seam";
    }
}

TEST(Adaptive, TexturesOfManyChartsAreNotKept) {
    Layer layer = layer_of(shapes::plane(20, {0, 0, 1}));
    EXPECT_FALSE(can_keep_seams(layer));
    const auto charts = [&](double width) {
        layer.wedges.clear();
        for (const Face& f : layer.mesh.faces) {
            const Vec3 centre =
                (layer.mesh.positions[f[0]] + layer.mesh.positions[f[1]] + layer.mesh.positions[f[2]]) / 3;
            for (const Index v : f)
                layer.wedges.push_back({layer.mesh.positions[v].x() + 3 * std::floor(centre.x() / width),
                                        layer.mesh.positions[v].y() + 3 * std::floor(centre.y() / width)});
        }
    };
    charts(0.5);
    EXPECT_TRUE(can_keep_seams(layer));
    charts(0.05);
    EXPECT_FALSE(can_keep_seams(layer)) << "each square by itself";
}

TEST(Adaptive, RegionOfInterestStaysInFull) {
    Layer layer = layer_of(shapes::scan(2000));
    layer.selected_face.assign(layer.mesh.faces.size(), 0);
    Index selected = 0;
    for (std::size_t f = 0; f < layer.mesh.faces.size(); ++f)
        if (layer.mesh.positions[layer.mesh.faces[f][0]].x() > 0.6) layer.selected_face[f] = 1, ++selected;
    ASSERT_GT(selected, 50);
    for (const bool fit : {false, true}) {
        AdaptiveOptions o = with_threshold(1e9);
        o.region_of_interest = true;
        o.fit = fit;
        const Result r = run(layer, o);
        expect_valid(*r.layer, layer.mesh);
        const std::set<Index> faces(r.layer->source_face.begin(), r.layer->source_face.end());
        const Mesh mesh = mesh_of(*r.layer, layer.mesh);
        for (std::size_t i = 0; i < r.layer->faces.size(); ++i) {
            const Index f = r.layer->source_face[i];
            if (!layer.selected_face[f]) continue;
            for (int k = 0; k < 3; ++k) {
                ASSERT_EQ(r.layer->source_vertex[r.layer->faces[i][k]], layer.mesh.faces[f][k]);
                ASSERT_EQ(mesh.positions[r.layer->faces[i][k]], layer.mesh.positions[layer.mesh.faces[f][k]]);
            }
        }
        for (std::size_t f = 0; f < layer.mesh.faces.size(); ++f)
            if (layer.selected_face[f]) {
                EXPECT_TRUE(faces.count(static_cast<Index>(f)));
            }
        EXPECT_LT(r.layer->faces.size(), layer.mesh.faces.size());
    }
}

// ---- positions
// -------------------------------------------------------------------------------------------------------

TEST(Adaptive, FitFlipsNothingAndKeepsTheBoundaryOnEveryClass) {
    for (const auto& [name, mesh] : fixtures::every_class())
        for (const double threshold : {0.05, 1.0, 1e9}) {
            SCOPED_TRACE(name);
            AdaptiveOptions o = with_threshold(threshold);
            const Result plain = run(layer_of(mesh), o);
            o.fit = true;
            const Result r = run(layer_of(mesh), o);
            EXPECT_EQ(r.layer->faces, plain.layer->faces);
            const Mesh before = mesh_of(*plain.layer, mesh), after = mesh_of(*r.layer, mesh);
            EXPECT_EQ(compare(before.faces, before.positions, after.positions).flipped_faces, 0);
            expect_valid(*r.layer, mesh);
            const Rings rings = surface_rings(before);
            for (Index v = 0; v < rings.rows(); ++v)
                if (rings.kind[v] != RingKind::closed) {
                    ASSERT_EQ(before.positions[v], after.positions[v]);
                }
        }
}

TEST(Adaptive, FittedSphereHasTheSphereBetween) {
    const Mesh sphere = shapes::irregular_sphere(4000);
    AdaptiveOptions o = with_threshold(1);
    o.target = Target::faces;
    o.faces = 500;
    o.measure = true;
    const Result plain = run(layer_of(sphere), o);
    o.fit = true;
    const Result r = run(layer_of(sphere), o);
    // Chords of vertices on a sphere lie inside it; a fit has errors on both sides: about half as large.
    EXPECT_LT(value(r, "rms_distance"), 0.6 * value(plain, "rms_distance"));
    const Mesh mesh = mesh_of(*r.layer, sphere);
    EXPECT_NEAR(surface(mesh.faces, mesh.positions).volume, surface(sphere.faces, sphere.positions).volume, 0.01);
}

AdaptiveOptions moving(Target target, double share, const Mesh& mesh) {
    AdaptiveOptions o = with_threshold(1);
    o.fit = true;
    o.target = target;
    o.faces = static_cast<int>(share * static_cast<double>(mesh.faces.size()));
    o.vertices = static_cast<int>(share * static_cast<double>(mesh.positions.size()));
    return o;
}

TEST(Adaptive, MovingOnTheWayKeepsTopologyAndBoundaryOnEveryClass) {
    for (const auto& [name, mesh] : fixtures::every_class())
        for (const Target target : {Target::faces, Target::vertices})
            for (const double share : {0.5, 0.1}) {
                SCOPED_TRACE(name + ", " + std::to_string(share));
                const Result r = run(layer_of(mesh), moving(target, share, mesh));
                expect_valid(*r.layer, mesh);
                const Mesh after = mesh_of(*r.layer, mesh);
                const Rings rings = vertex_rings(after);
                for (Index v = 0; v < rings.rows(); ++v) {
                    ASSERT_TRUE(after.positions[v].allFinite());
                    if (rings.kind[v] != RingKind::closed) {
                        ASSERT_EQ(after.positions[v], mesh.positions[r.layer->source_vertex[v]]);
                    }
                }
            }
}

TEST(Adaptive, FitIsNoWorseThanVerticesOfTheInputOnAnyClass) {
    for (const auto& [name, mesh] : fixtures::every_class())
        for (const double share : {0.5, 0.2}) {
            SCOPED_TRACE(name + ", " + std::to_string(share));
            AdaptiveOptions o = moving(Target::faces, share, mesh);
            o.measure = true;
            const Result fit = run(layer_of(mesh), o);
            o.fit = false;
            const Result plain = run(layer_of(mesh), o);
            const double diagonal = box_diagonal(layer_of(mesh));
            EXPECT_LE(value(fit, "rms_distance"), value(plain, "rms_distance") + 1e-6 * diagonal);
            EXPECT_LE(value(fit, "faces"), std::max<double>(o.faces, value(plain, "faces")));
        }
}

TEST(Adaptive, VerticesThatMovedOnTheWayFitTheWholeInputInTheEnd) {
    for (const Mesh& mesh : {shapes::scan(8000), shapes::irregular_sphere(8000)}) {
        AdaptiveOptions o = moving(Target::faces, 0.1, mesh);
        o.measure = true;
        HierarchyOptions how = adaptive_collapses(o);
        how.set_share = 0.25;
        const Layer layer = layer_of(mesh);
        const Simplified s = simplify(mesh, adaptive_rings(layer, o), how, {o.base_vertices, o.faces}, {});
        for (std::size_t v = 0; v < s.source_vertex.size(); ++v) EXPECT_EQ(s.into[s.source_vertex[v]], v);
        const double before = two_sided_distance(mesh.faces, mesh.positions, s.faces, s.positions).rms;
        EXPECT_LT(value(run(layer, o), "rms_distance"), 0.95 * before);
    }
}

// Modelling programs write backs of faces as faces: what is asked for is the number of all.
TEST(Adaptive, DoubleSidedMeshesAreReconstructedLikeSingleSided) {
    const Mesh single = shapes::irregular_sphere(3000);
    Mesh both = single;
    std::vector<Face> faces(single.faces.begin(), single.faces.end());
    for (const Face& f : single.faces) faces.push_back({f[0], f[2], f[1]});
    both.faces = Faces(faces.begin(), faces.end());
    for (const bool fit : {false, true}) {
        SCOPED_TRACE(fit);
        AdaptiveOptions o = with_threshold(0.1);
        o.target = Target::faces;
        o.fit = fit;
        o.measure = true;
        o.faces = 1200;
        const Result of_both = run(layer_of(both), o);
        o.faces = 600;
        const Result of_single = run(layer_of(single), o);
        EXPECT_EQ(value(of_both, "faces"), 2 * value(of_single, "faces"));
        EXPECT_LT(value(of_both, "rms_distance"), 1.3 * value(of_single, "rms_distance"));
        expect_valid(*of_both.layer, both);
        EXPECT_EQ(count_input(mesh_of(*of_both.layer, both)).duplicate_faces, value(of_single, "faces"));
    }
    // Front and back have other places in the texture: no edge is a seam for that.
    Layer textured = layer_of(both);
    for (std::size_t f = 0; f < both.faces.size(); ++f)
        for (const Index v : both.faces[f])
            textured.wedges.push_back(
                {both.positions[v].x() + (f < single.faces.size() ? 0 : 5), both.positions[v].y(), 0});
    AdaptiveOptions o = with_threshold(1000);
    o.texcoord = {true, 1000};
    EXPECT_LT(value(run(textured, o), "faces"), 100);
}

TEST(Adaptive, MovingOnTheWayLeavesDamagedMeshesValid) {
    for (std::uint64_t seed = 1; seed <= 30; ++seed) {
        SCOPED_TRACE(seed);
        const Mesh mesh = seed % 3 ? fixtures::damaged_mesh(seed) : fixtures::random_soup(seed);
        try {
            expect_valid(*run(layer_of(mesh), moving(Target::faces, 0.2, mesh)).layer, mesh);
        } catch (const InputError&) {
        }
    }
}

TEST(Adaptive, MovingOnTheWayTurnsNothingOver) {
    const Mesh sphere = shapes::irregular_sphere(4000);
    for (const double share : {0.5, 0.1, 0.02}) {
        const Result r = run(layer_of(sphere), moving(Target::faces, share, sphere));
        const Mesh after = mesh_of(*r.layer, sphere);
        for (const Face& f : after.faces) {
            const Vec3 centre = (after.positions[f[0]] + after.positions[f[1]] + after.positions[f[2]]) / 3;
            ASSERT_GT(area_vector(f, after.positions).dot(centre), 0);
        }
    }
}

TEST(Adaptive, MovingOnTheWayKeepsVolumeAndDoesNotDependOnThreads) {
    const Mesh sphere = shapes::irregular_sphere(20000);
    const AdaptiveOptions o = moving(Target::faces, 0.1, sphere);
    const fixtures::Threads three(3);
    const Result r = run(layer_of(sphere), o);
    const Mesh after = mesh_of(*r.layer, sphere);
    // As many faces on vertices of the input lie inside the sphere; the volume is kept step by step, first order in
    // moves.
    AdaptiveOptions plain = o;
    plain.fit = false;
    const Mesh inside = mesh_of(*run(layer_of(sphere), plain).layer, sphere);
    const double volume = surface(sphere.faces, sphere.positions).volume;
    const double lost = volume - surface(inside.faces, inside.positions).volume;
    EXPECT_LT(std::abs(surface(after.faces, after.positions).volume - volume), 0.1 * lost);
    const fixtures::Threads one(1);
    const Result again = run(layer_of(sphere), o);
    EXPECT_EQ(again.layer->faces, r.layer->faces);
    EXPECT_EQ(again.layer->positions, r.layer->positions);
}

TEST(Adaptive, FeaturesStayInPlaceWhereVerticesMove) {
    const Layer block = layer_of(shapes::block(12));
    AdaptiveOptions o = moving(Target::faces, 0.05, block.mesh);
    o.features = Features::angle;
    const Result r = run(block, o);
    const Mesh after = mesh_of(*r.layer, block.mesh);
    Rings rings = vertex_rings(block.mesh);
    mark_features(rings, block, o.features, o.feature_angle);
    int creases = 0, moved = 0;
    for (std::size_t v = 0; v < after.positions.size(); ++v) {
        const Index source = r.layer->source_vertex[v];
        const auto begin = rings.feature.begin() + rings.offset[source], end = begin + rings.size(source);
        const bool still = after.positions[v] == block.mesh.positions[source];
        moved += !still;
        if (std::none_of(begin, end, [](std::uint8_t mark) { return mark != 0; })) continue;
        ++creases;
        ASSERT_TRUE(still);
    }
    EXPECT_GT(creases, 20);
    EXPECT_GT(moved, 5);
}

TEST(Adaptive, BandGainActsFirst) {
    const Layer layer = layer_of(shapes::scan(2000));
    AdaptiveOptions o = with_threshold(0);
    o.band = default_band(layer, Unit::wavelength);
    o.band.finest = 0;
    o.band_gain = 0;
    const Result r = run(layer, o);
    ASSERT_TRUE(r.layer->positions);
    EXPECT_EQ(r.layer->faces, layer.mesh.faces);
    EXPECT_GT(displacement(layer.mesh.positions, *r.layer->positions).rms, 0);
    o.geometry.threshold = 0.05;
    const double smooth = value(run(layer, o), "faces");
    EXPECT_LT(smooth, value(run(layer, with_threshold(0.05)), "faces"));
}

// ---- bad input
// -------------------------------------------------------------------------------------------------------

TEST(Adaptive, BadInputIsNamed) {
    const Layer layer = layer_of(shapes::icosphere(4));
    const auto message = [&](const AdaptiveOptions& o) -> std::string {
        try {
            run(layer, o);
        } catch (const InputError& e) {
            return e.what();
        }
        return "accepted";
    };
    const auto expect = [&](const std::string& name, const AdaptiveOptions& o) {
        EXPECT_NE(message(o).find(name), std::string::npos) << message(o);
    };
    for (const double bad : {-1.0, std::nan("")}) {
        expect("geometry_threshold", with_threshold(bad));
        AdaptiveOptions o = with_threshold(1);
        o.normal = {true, bad};
        expect("normal_threshold", o);
        o = with_threshold(1);
        o.target = Target::rms_distance;
        o.error = bad;
        expect("error", o);
        o = with_threshold(1);
        o.normal_limit = bad;
        expect("normal_limit", o);
    }
    AdaptiveOptions o = with_threshold(1);
    o.color.use = true;
    expect("use_color", o);
    o = with_threshold(1);
    o.quality.use = true;
    expect("use_quality", o);
    o = with_threshold(1);
    o.texcoord.use = true;
    expect("use_texcoord", o);
    o = with_threshold(1);
    o.geometry.use = false;
    expect("use_geometry", o);
    o = with_threshold(1);
    o.region_of_interest = true;
    expect("region_of_interest", o);
    o = with_threshold(1);
    o.target = Target::faces;
    o.faces = -1;
    expect("faces", o);
    o = with_threshold(1);
    o.band_gain = infinity;
    expect("band_gain", o);
    o = with_threshold(1);
    o.base_vertices = 3;
    expect("base_vertices", o);
    EXPECT_THROW(run(layer_of(shapes::not_finite(infinity)), with_threshold(1)), InputError);
    EXPECT_THROW(run(Layer(), with_threshold(1)), InputError);
}

TEST(Adaptive, CanBeCancelledAtEveryReport) {
    const Layer layer = layer_of(shapes::scan(1000));
    for (int stop = 0; stop < 20; ++stop) {
        int calls = 0;
        Session session;
        session.progress = Progress([&](int, const char*) { return calls++ < stop; });
        AdaptiveOptions o = with_threshold(1);
        try {
            adaptive_reconstruction(layer, o, session);
            EXPECT_LE(calls, stop);
        } catch (const Cancelled&) {
            EXPECT_EQ(calls, stop + 1);
        }
    }
}
