#include "filters/layers/levels.h"

#include "filter_fixtures.h"
#include "filters/region.h"
#include "measure/measure.h"
#include "mesh/validation.h"
#include "scheme_fixtures.h"
#include "schemes/table.h"

#include <algorithm>
#include <functional>
#include <set>

namespace multires {

using namespace fixtures;

namespace {

Layer small_layer() { return layer_of(shapes::scan(600)); }

std::shared_ptr<const Pyramid> kept_by(const Layer& layer, const PyramidOptions& options, Session& session) {
    Report report;
    const auto before = session.pyramids.all();
    const auto pyramid = pyramid_of(layer, options, session, report);
    EXPECT_EQ(pyramid, session.pyramids.all().front());
    EXPECT_EQ(value<bool>(report, "pyramid_reused"), std::count(before.begin(), before.end(), pyramid) == 1);
    return pyramid;
}

}  // namespace

TEST(KeptPyramid, IsReusedWhileNothingItDependsOnChanges) {
    Layer layer = small_layer();
    Session session;
    const auto first = kept_by(layer, {}, session);
    EXPECT_EQ(kept_by(layer, {}, session), first);
    // Attributes, selections and marks that are not used.
    layer = with_quality(std::move(layer), std::vector<double>(layer.mesh.positions.size(), 0.5));
    layer.selected_vertex.assign(layer.mesh.positions.size(), 1);
    layer.selected_face.assign(layer.mesh.faces.size(), 1);
    layer.faux_edges.assign(layer.mesh.faces.size(), 1);
    layer.selected_edges.assign(layer.mesh.faces.size(), 1);
    EXPECT_EQ(kept_by(layer, {}, session), first);
    // An angle that no feature is found by.
    PyramidOptions options;
    options.features.angle = 12;
    EXPECT_EQ(kept_by(layer, options, session), first);
    // A copy of the layer at another place in memory.
    const Layer copy = layer;
    EXPECT_EQ(kept_by(copy, {}, session), first);
}

TEST(KeptPyramid, IsNeverReusedAfterAChangeOfTheMesh) {
    const Layer original = small_layer();
    const std::vector<std::pair<std::string, std::function<void(Layer&)>>> changes{
        {"a coordinate by one bit",
         [](Layer& l) { l.mesh.positions[17].y() = std::nextafter(l.mesh.positions[17].y(), 10); }},
        {"a face turned",
         [](Layer& l) { std::rotate(l.mesh.faces[3].begin(), l.mesh.faces[3].begin() + 1, l.mesh.faces[3].end()); }},
        {"a face less", [](Layer& l) { l.mesh.faces.pop_back(); }},
        {"two faces exchanged", [](Layer& l) { std::swap(l.mesh.faces[5], l.mesh.faces[6]); }},
        {"a vertex more",
         [](Layer& l) {
             l.mesh.positions.push_back({0, 0, 0});
         }},
    };
    for (const auto& [what, change] : changes) {
        SCOPED_TRACE(what);
        Session session;
        const auto first = kept_by(original, {}, session);
        Layer layer = original;
        change(layer);
        EXPECT_NE(kept_by(layer, {}, session), first);
        EXPECT_NE(kept_by(original, {}, session), first);  // the old one is gone; this is a third
        EXPECT_EQ(session.pyramids.all().front()->hash(), first->hash());
    }
}

TEST(KeptPyramid, IsNeverReusedAfterAChangeOfItsOptions) {
    Layer layer = small_layer();
    layer.faux_edges.assign(layer.mesh.faces.size(), 7);
    layer.selected_edges.assign(layer.mesh.faces.size(), 0);
    // Every field there is, one by one: another value of its range.
    std::vector<PyramidOptions> changed;
    PyramidOptions defaults;
    int fields = 0;
    visit_options(defaults, [&](const PyramidOption& option, const auto&) {
        PyramidOptions other;
        visit_options(other, [&](const PyramidOption& o, auto& field) {
            using Value = std::decay_t<decltype(field)>;
            if (o.name != option.name) return;
            const double value = static_cast<double>(field);
            const bool whole = !std::is_same_v<Value, double>;
            field = static_cast<Value>(value < o.most ? (whole ? value + 1 : (value + std::min(o.most, value + 1)) / 2)
                                                      : (whole ? value - 1 : (value + o.least) / 2));
        });
        ++fields;
        if (option.name != "feature_angle") changed.push_back(other);  // which does not count by default
    });
    EXPECT_EQ(changed.size(), fields - 1u);
    for (const Features x : {Features::non_faux_edges, Features::selected_edges}) {
        changed.emplace_back();
        changed.back().features.from = x;
    }
    std::set<ContentHash> hashes{content_hash(layer, {})};
    for (const PyramidOptions& options : changed) {
        Session session;
        const auto first = kept_by(layer, {}, session);
        EXPECT_NE(kept_by(layer, options, session), first);
        EXPECT_TRUE(hashes.insert(session.pyramids.all().front()->hash()).second);
    }
    PyramidOptions options;
    options.features.from = Features::angle;
    options.features.angle = 41;
    EXPECT_TRUE(hashes.insert(content_hash(layer, options)).second);
    options.features.from = Features::selected_edges;
    layer.selected_edges[8] = 2;
    EXPECT_TRUE(hashes.insert(content_hash(layer, options)).second);
    options.features.from = Features::non_faux_edges;
    layer.faux_edges[8] = 2;
    EXPECT_TRUE(hashes.insert(content_hash(layer, options)).second);
}

TEST(KeptPyramid, RefusesOptionsOutOfRange) {
    const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
    std::vector<PyramidOptions> wrong;
    const auto add = [&](auto& (*field)(PyramidOptions&), auto bad) {
        wrong.emplace_back();
        field(wrong.back()) = bad;
    };
    for (const double x : {-0.1, 1.1, nan})
        add(
            +[](PyramidOptions& o) -> double& { return o.scheme.presmooth; }, x);
    for (const int x : {-1, static_cast<int>(schemes().size())})
        add(
            +[](PyramidOptions& o) -> int& { return o.scheme.row; }, x);
    for (const double x : {-0.1, 1.0, nan})
        add(
            +[](PyramidOptions& o) -> double& { return o.hierarchy.level_ratio; }, x);
    for (const double x : {-0.1, inf, nan})
        add(
            +[](PyramidOptions& o) -> double& { return o.hierarchy.length_weight; }, x);
    for (const double x : {0.0, -5.0, 180.5, nan})
        add(
            +[](PyramidOptions& o) -> double& { return o.hierarchy.normal_limit_degrees; }, x);
    for (const int x : {0, -1})
        add(
            +[](PyramidOptions& o) -> int& { return o.hierarchy.sets_per_level; }, x);
    for (const int x : {3, 0, -100})
        add(
            +[](PyramidOptions& o) -> Index& { return o.hierarchy.base_vertices; }, x);
    for (const Features x : {Features::non_faux_edges, Features::selected_edges})
        add(
            +[](PyramidOptions& o) -> Features& { return o.features.from; }, x);
    for (const double x : {0.0, 180.0, nan}) {
        add(
            +[](PyramidOptions& o) -> double& { return o.features.angle; }, x);
        wrong.back().features.from = Features::angle;
    }
    const Layer layer = small_layer();
    for (std::size_t i = 0; i < wrong.size(); ++i) {
        Session session;
        Report report;
        EXPECT_THROW(pyramid_of(layer, wrong[i], session, report), InputError) << "case " << i;
        EXPECT_TRUE(session.pyramids.all().empty());
    }
}

namespace {

Positions in_places(const Mesh& mesh, const Hierarchy& h) {
    Positions p;
    for (const Index v : h.order) p.push_back(mesh.positions[v]);
    return p;
}

}  // namespace

TEST(ComputePyramid, ItsTableIsThatOfTheLevels) {
    const std::vector<std::pair<std::string, Mesh>> regular{{"scan", shapes::scan(3000)},
                                                            {"sphere", shapes::irregular_sphere(2000)},
                                                            {"terrain", shapes::terrain(40).mesh}};
    for (const auto& [name, mesh] : regular) {
        SCOPED_TRACE(name);
        Session session;
        const Layer layer = layer_of(mesh);
        const Result result = compute_pyramid(layer, {}, session);
        EXPECT_FALSE(result.positions || result.quality || result.layer);
        const auto vertices = series(result.report, "vertices"), wavelength = series(result.report, "wavelength");
        const auto detail = series(result.report, "rms_detail");
        const std::size_t rows = count(result.report, "levels") + 1;
        ASSERT_EQ(vertices.size(), rows);
        ASSERT_EQ(wavelength.size(), rows);
        ASSERT_EQ(detail.size(), rows);
        const Hierarchy& h = session.pyramids.all().front()->hierarchy();
        for (std::size_t k = 0; k < rows; ++k) {
            EXPECT_EQ(vertices[k], h.size[k]);
            const double mean = mean_edge_length(level_mesh(h, mesh.faces, k).faces, in_places(mesh, h));
            EXPECT_NEAR(wavelength[k], 2 * mean,
                        (name == "terrain" ? 0.1 : 1e-12) * mean);  // boundary edges count half
            if (k == 0) continue;
            EXPECT_LT(vertices[k], vertices[k - 1]);
            EXPECT_GT(wavelength[k], wavelength[k - 1]);
            EXPECT_GT(detail[k - 1], 0);
        }
        EXPECT_LE(number(result.report, "reconstruction_error"), 1e-13);
    }
}

TEST(ComputePyramid, LetsTheMeshGoOnceItIsRead) {
    const Layer layer = layer_of(shapes::scan(3000));
    Session usual;
    const Report expected = compute_pyramid(layer, {}, usual).report;
    for (int call = 0; call < 2; ++call) {
        Layer in_hands = layer;
        int times = 0;
        Session session;
        if (call == 1) session.pyramids = usual.pyramids;  // the mesh stays: a kept pyramid takes no memory
        session.let_mesh_go = [&] { in_hands.mesh = Mesh(), ++times; };
        session.position = [&](Index v) { return layer.mesh.positions[v]; };
        const Report report = compute_pyramid(in_hands, {}, session).report;
        EXPECT_EQ(times, 1 - call);
        EXPECT_EQ(report.lines(), expected.lines());
        ASSERT_EQ(report.entries().size(), expected.entries().size());
        for (std::size_t i = 0; i < expected.entries().size(); ++i) {
            const Report::Entry& e = expected.entries()[i];
            EXPECT_TRUE(e.key == "pyramid_reused" || report.entries()[i].value == e.value) << e.key;
        }
    }
}

TEST(ComputePyramid, OneVertexPerLevelGivesAShortTable) {
    ComputePyramidOptions options;
    options.pyramid.hierarchy.grouping = Grouping::sequential;
    Session session;
    const Mesh mesh = shapes::scan(1500);
    const Result result = compute_pyramid(layer_of(mesh), options, session);
    EXPECT_EQ(count(result.report, "levels"), static_cast<int>(mesh.positions.size()) - 100);
    const auto vertices = series(result.report, "vertices");
    EXPECT_LE(vertices.size(), 130u);
    EXPECT_EQ(vertices.front(), mesh.positions.size());
    EXPECT_EQ(vertices.back(), 100);
    // Wavelengths between the measured levels follow the true ones.
    const auto& levels = session.pyramids.all().front()->levels();
    const Hierarchy& h = session.pyramids.all().front()->hierarchy();
    for (std::size_t k = 0; k < levels.size(); k += 50) {
        const double mean = mean_edge_length(level_mesh(h, mesh.faces, k).faces, in_places(mesh, h));
        EXPECT_NEAR(levels[k].wavelength, 2 * mean, 0.02 * mean) << "level " << k;
    }
}

TEST(ComputePyramid, CountsWhatIsUnusualOnEveryClass) {
    for (const auto& [name, mesh] : every_class()) {
        SCOPED_TRACE(name);
        Session session;
        const Result result = compute_pyramid(layer_of(mesh), {}, session);
        const InputCounts counts = count_input(mesh);
        EXPECT_EQ(count(result.report, "locked_vertices"), counts.non_manifold_vertices);
        EXPECT_EQ(count(result.report, "unreferenced_vertices"), counts.unreferenced_vertices);
        EXPECT_EQ(count(result.report, "duplicate_vertices"), counts.duplicate_vertices);
        EXPECT_EQ(count(result.report, "degenerate_faces"), counts.degenerate_faces + counts.zero_area_faces);
        EXPECT_EQ(count(result.report, "duplicate_faces"), counts.duplicate_faces);
        EXPECT_EQ(count(result.report, "non_manifold_edges"), counts.non_manifold_edges);
        EXPECT_EQ(count(result.report, "boundary_loops"), counts.boundary_loops);
        EXPECT_EQ(count(result.report, "components"), counts.components);
        EXPECT_LE(number(result.report, "reconstruction_error"), 1e-12 * bounding_box(mesh.positions).diagonal());
        for (const double w : series(result.report, "wavelength")) EXPECT_TRUE(std::isfinite(w));
    }
}

TEST(GenerateLevel, IsASubsetOfTheInput) {
    for (const auto& [name, mesh] : every_class()) {
        SCOPED_TRACE(name);
        const Layer layer = layer_of(mesh);
        Session session;
        GenerateLevelOptions options;
        options.pyramid.hierarchy.base_vertices = 10;
        Report ignored;
        const int last = static_cast<int>(pyramid_of(layer, options.pyramid, session, ignored)->levels().size()) - 1;
        for (int level = 0; level <= last; level += std::max(1, last / 3)) {
            options.level = level;
            const Result result = generate_level(layer, options, session);
            ASSERT_TRUE(result.layer && !result.positions);
            const DerivedMesh& derived = *result.layer;
            EXPECT_FALSE(derived.positions);
            const auto n = static_cast<Index>(derived.source_vertex.size());
            EXPECT_EQ(count(result.report, "vertices"), n);
            EXPECT_EQ(count(result.report, "faces"), static_cast<int>(derived.faces.size()));
            const std::set<Index> sources(derived.source_vertex.begin(), derived.source_vertex.end());
            EXPECT_EQ(static_cast<Index>(sources.size()), n);
            EXPECT_TRUE(*sources.begin() >= 0 && *sources.rbegin() < static_cast<Index>(mesh.positions.size()));
            ASSERT_EQ(derived.source_face.size(), derived.faces.size());
            for (std::size_t f = 0; f < derived.faces.size(); ++f) {
                EXPECT_LT(derived.source_face[f], static_cast<Index>(mesh.faces.size()));
                for (const Index v : derived.faces[f]) EXPECT_TRUE(v >= 0 && v < n);
            }
            options.smoothed = true;
            const Result smoothed = generate_level(layer, options, session);
            ASSERT_TRUE(smoothed.layer->positions);
            EXPECT_EQ(static_cast<Index>(smoothed.layer->positions->size()), n);
            EXPECT_EQ(smoothed.layer->faces, derived.faces);
            options.smoothed = false;
        }
        options.level = last + 1;
        EXPECT_THROW(generate_level(layer, options, session), InputError);
        options.level = -1;
        EXPECT_THROW(generate_level(layer, options, session), InputError);
    }
}

// F2: it was the base, a hundred vertices.
TEST(GenerateLevel, WithoutALevelHasAboutAQuarterOfTheVertices) {
    std::vector<std::pair<std::string, Mesh>> large{{"scan", shapes::scan(3000)},
                                                    {"sphere", shapes::irregular_sphere(9000)},
                                                    {"terrain", shapes::terrain(60).mesh},
                                                    {"plane", shapes::plane(50)},
                                                    {"block", shapes::block(24)},
                                                    {"torus", shapes::torus(80, 40)},
                                                    {"cylinder", shapes::open_cylinder(60, 50)}};
    for (const auto& [name, mesh] : large) {
        ASSERT_GT(mesh.positions.size(), 2000u) << name;
        for (const Grouping grouping : {Grouping::independent_sets, Grouping::sequential})
            for (const int sets : {1, 2, 3, 4, 7, 100}) {
                SCOPED_TRACE(name + ", " + std::to_string(sets) + " sets");
                GenerateLevelOptions options;
                options.pyramid.hierarchy.grouping = grouping;
                options.pyramid.hierarchy.sets_per_level = sets;
                options.pyramid.hierarchy.level_ratio = sets == 1 ? 0 : 1.0 / sets;
                Session session;
                const Result result = generate_level(layer_of(mesh), options, session);
                const double share = count(result.report, "vertices") / static_cast<double>(mesh.positions.size());
                EXPECT_GE(share, 0.2);
                EXPECT_LE(share, 1 / 3.0);
                EXPECT_EQ(result.layer->source_vertex.size(),
                          static_cast<std::size_t>(count(result.report, "vertices")));
                EXPECT_GT(number(result.report, "wavelength"), 0);
                if (sets > 2) continue;
                options.smoothed = true;  // levels are close enough here
                EXPECT_EQ(generate_level(layer_of(mesh), options, session).layer->faces, result.layer->faces);
                options.level = count(result.report, "level");
                options.smoothed = false;
                EXPECT_EQ(generate_level(layer_of(mesh), options, session).layer->faces, result.layer->faces);
            }
    }
}

namespace {

Mesh mesh_of(const DerivedMesh& derived, const Mesh& input) {
    Mesh mesh{{}, derived.faces};
    for (const Index v : derived.source_vertex) mesh.positions.push_back(input.positions[v]);
    return mesh;
}

/// Nothing is worse than in the input, and what lay in a plane without overlaps still does.
void expect_valid(const Mesh& mesh, const Mesh& input, bool height_field) {
    const InputCounts now = count_input(mesh), before = count_input(input);
    EXPECT_LE(now.unreferenced_vertices, before.unreferenced_vertices);
    EXPECT_LE(now.degenerate_faces, before.degenerate_faces);
    EXPECT_LE(now.zero_area_faces, before.zero_area_faces);
    EXPECT_LE(now.duplicate_faces, before.duplicate_faces);
    EXPECT_LE(now.non_manifold_edges, before.non_manifold_edges);
    EXPECT_LE(now.non_manifold_vertices, before.non_manifold_vertices);
    EXPECT_LE(now.inconsistent_edges, before.inconsistent_edges);
    EXPECT_EQ(now.boundary_loops, before.boundary_loops);
    EXPECT_EQ(now.components, before.components);
    if (!height_field) return;
    for (const Vec3& n : face_normals(mesh.faces, mesh.positions)) EXPECT_GT(n.z(), 0);
}

struct Input {
    std::string name;
    Mesh mesh;
    bool height_field = false;
};

std::vector<Input> level_inputs() {
    return {{"plane", shapes::plane(20), true},
            {"terrain", shapes::terrain(20).mesh, true},
            {"sphere", shapes::irregular_sphere(400)},
            {"scan", shapes::scan(500)}};
}

/// Every way of choosing what goes, by sets and vertex by vertex.
std::vector<PyramidOptions> level_pyramids() {
    std::vector<PyramidOptions> all;
    for (const char* scheme : {"Roy", "Szczesna"})
        for (const Grouping grouping : {Grouping::independent_sets, Grouping::sequential}) {
            PyramidOptions o;
            o.scheme.row = scheme_named(scheme);
            o.hierarchy.split = std::string(scheme) == "Roy" ? Split::quadric : Split::regression_plane;
            o.hierarchy.grouping = grouping;
            o.hierarchy.base_vertices = 20;
            all.push_back(o);
        }
    return all;
}

}  // namespace

TEST(GenerateLevel, HasExactlyAnyNumberOfVertices) {
    for (const auto& [name, mesh, height_field] : level_inputs())
        for (const PyramidOptions& pyramid : level_pyramids()) {
            SCOPED_TRACE(name);
            GenerateLevelOptions options;
            options.pyramid = pyramid;
            Session session;
            const Layer layer = layer_of(mesh);
            Report ignored;
            const Hierarchy& h = pyramid_of(layer, pyramid, session, ignored)->hierarchy();
            for (int n = h.size.back(); n <= h.vertices(); n += 1 + n / 40) {
                options.vertices = n;
                const Result result = generate_level(layer, options, session);
                ASSERT_EQ(count(result.report, "vertices"), n);
                expect_valid(mesh_of(*result.layer, mesh), mesh, height_field);
            }
            for (const int n : {h.size.back() - 1, h.vertices() + 1, -1}) {
                options.vertices = n;
                EXPECT_THROW(generate_level(layer, options, session), InputError);
            }
        }
}

TEST(GenerateLevel, KeepsARegionWholeAndGetsCoarserAroundIt) {
    for (const auto& [name, mesh, height_field] : level_inputs()) {
        SCOPED_TRACE(name);
        Layer layer = layer_of(mesh);
        const auto box = bounding_box(mesh.positions);
        GenerateLevelOptions options;
        options.pyramid.hierarchy.base_vertices = 20;
        options.level = 4;
        options.low = box.low, options.high = (box.low + box.high) / 2;
        options.centre = mesh.positions[0], options.radius = 0.2 * box.diagonal();
        layer.selected_face.assign(mesh.faces.size(), 0);
        std::fill_n(layer.selected_face.begin(), mesh.faces.size() / 8, 1);
        const auto inside = [&](Index v) {
            if (options.detail_in == DetailIn::box)
                return Eigen::AlignedBox3d(options.low, options.high).contains(layer.mesh.positions[v]);
            if (options.detail_in == DetailIn::sphere)
                return (layer.mesh.positions[v] - options.centre).norm() <= options.radius;
            return region_weights(layer, {true, false})[v] > 0;
        };
        for (const DetailIn region : {DetailIn::selection, DetailIn::box, DetailIn::sphere})
            for (const double growth : {0.05, 0.5}) {
                options.detail_in = region, options.growth = growth, options.vertices = 0;
                Session session;
                const Result result = generate_level(layer, options, session);
                const DerivedMesh& derived = *result.layer;
                expect_valid(mesh_of(derived, mesh), mesh, height_field);
                const std::set<Index> kept(derived.source_vertex.begin(), derived.source_vertex.end());
                std::size_t wanted = 0;
                for (Index v = 0; v < static_cast<Index>(mesh.positions.size()); ++v) {
                    if (!inside(v)) continue;
                    ++wanted;
                    EXPECT_EQ(kept.count(v), 1u) << v;
                }
                EXPECT_GT(wanted, 10u);
                EXPECT_LT(kept.size(), mesh.positions.size());

                options.vertices = count(result.report, "vertices") + 7;  // and exactly so many
                EXPECT_EQ(count(generate_level(layer, options, session).report, "vertices"), options.vertices);
                options.vertices = static_cast<int>(wanted) - 1;
                EXPECT_THROW(generate_level(layer, options, session), InputError);
            }
    }
}

TEST(GenerateLevel, OfALargerRegionOrSlowerGrowthHoldsThatOfASmallerOne) {
    const Layer layer = layer_of(shapes::terrain(30).mesh);
    GenerateLevelOptions options;
    options.pyramid.hierarchy.base_vertices = 20;
    options.level = 6, options.detail_in = DetailIn::sphere;
    options.centre = layer.mesh.positions[layer.mesh.positions.size() / 2];
    std::set<Index> before;
    for (const auto& [radius, growth] : {std::pair{0.0, 0.8}, {0.1, 0.8}, {0.1, 0.2}, {0.3, 0.2}, {0.3, 0.0}}) {
        options.radius = radius, options.growth = growth;
        Session session;
        const auto source = generate_level(layer, options, session).layer->source_vertex;
        const std::set<Index> now(source.begin(), source.end());
        EXPECT_GT(now.size(), before.size());
        EXPECT_TRUE(std::includes(now.begin(), now.end(), before.begin(), before.end()));
        before = now;
    }
    EXPECT_EQ(before.size(), layer.mesh.positions.size());  // without growth nothing may be coarser
}

TEST(GenerateLevel, RefusesRegionsThatAreNoneAndNamesTheParameter) {
    const Layer layer = layer_of(shapes::plane(10));
    const auto refusal = [&](const GenerateLevelOptions& options) {
        Session session;
        try {
            generate_level(layer, options, session);
        } catch (const InputError& e) {
            return std::string(e.what());
        }
        return std::string();
    };
    GenerateLevelOptions options;
    options.detail_in = DetailIn::selection;
    EXPECT_EQ(refusal(options).find("detail_in"), 0u);
    options.detail_in = DetailIn::box, options.low.x() = 1;
    EXPECT_EQ(refusal(options).find("high"), 0u);
    options.detail_in = DetailIn::sphere, options.radius = -1;
    EXPECT_EQ(refusal(options).find("radius"), 0u);
    options.radius = 1, options.growth = std::nan("");
    EXPECT_EQ(refusal(options).find("growth"), 0u);
    options.growth = 1, options.smoothed = true;
    EXPECT_EQ(refusal(options).find("smoothed"), 0u);
}

// ---- the cache
// --------------------------------------------------------------------------------------------------------

TEST(PyramidCache, FiltersUsedInTurnFindTheirs) {
    const Layer layer = small_layer();
    Session session;
    const auto coarse = kept_by(layer, {}, session), fine = kept_by(layer, fine_levels(), session);
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(kept_by(layer, {}, session), coarse);
        EXPECT_EQ(kept_by(layer, fine_levels(), session), fine);
    }
}

TEST(PyramidCache, KeepsNoMoreThanTwiceTheLargestAndTheNewest) {
    const Layer layer = small_layer();
    Session session;
    shapes::Random random(3);
    for (int i = 0; i < 40; ++i) {
        PyramidOptions options;
        options.hierarchy.sets_per_level = 1 + static_cast<int>(random.bits() % 4);
        options.scheme.storage = random.chance(0.5) ? Storage::single : Storage::wide;
        options.scheme.row = fixtures::every_scheme()[random.bits() % fixtures::every_scheme().size()];
        const auto pyramid = kept_by(layer, options, session);
        std::size_t sum = 0, largest = 0;
        for (const auto& p : session.pyramids.all()) sum += p->bytes(), largest = std::max(largest, p->bytes());
        EXPECT_LE(sum, 2 * largest);
        EXPECT_EQ(session.pyramids.bytes(), sum);
        EXPECT_EQ(session.pyramids.all().front(), pyramid);
    }
    EXPECT_GT(session.pyramids.all().size(), 1u);
}

TEST(PyramidCache, LetsGoOfOtherShapesBeforeItBuilds) {
    Layer layer = small_layer();
    Session session;
    std::weak_ptr<const Pyramid> first = kept_by(layer, {}, session);
    layer.mesh.positions[0] *= 1.01;
    bool gone = false;
    session.progress = Progress([&](int, const char*) {
        gone = first.expired();
        return true;
    });
    Report report;
    pyramid_of(layer, {}, session, report);
    EXPECT_TRUE(gone);
    EXPECT_EQ(session.pyramids.all().size(), 1u);
}

TEST(PyramidCache, LazyAndFloatTakeLess) {
    const Layer layer = layer_of(shapes::scan(5000));
    const auto bytes = [&](int scheme, Storage storage) {
        PyramidOptions options;
        options.scheme.row = scheme;
        options.scheme.storage = storage;
        return Pyramid(layer, options, Progress()).bytes();
    };
    const int guskov = PyramidOptions().scheme.row, lazy = scheme_named("Lazy");
    EXPECT_LT(bytes(lazy, Storage::wide), 0.6 * bytes(guskov, Storage::wide));
    EXPECT_LT(bytes(guskov, Storage::single), 0.8 * bytes(guskov, Storage::wide));
}

}  // namespace multires
