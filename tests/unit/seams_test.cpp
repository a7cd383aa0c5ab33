// Meshes that are cut along seams, as exporters leave them, and filters across the cuts.
#include "filters/across_seams.h"

#include "all_tables.h"
#include "attribute_fixtures.h"
#include "filters/editing/transfer_edit.h"
#include "filters/original.h"
#include "filters/result_hash.h"
#include "filters/shape/band_filters.h"
#include "given.h"
#include "measure/measure.h"
#include "mesh/seams.h"
#include "mesh/validation.h"

#include "filter_fixtures.h"

#include <cmath>

namespace multires {

using namespace fixtures;

namespace {

/// A mesh whose vertices between two sets of faces are there twice; the copies come last.
Mesh cut(const Mesh& mesh, bool (*on_other_side)(const Vec3&)) {
    Mesh out = mesh;
    std::vector<Index> copy(mesh.positions.size(), -1);
    std::vector<std::uint8_t> kept(mesh.positions.size(), 0);
    const auto other = [&](const Face& f) {
        return on_other_side(mesh.positions[f[0]] + mesh.positions[f[1]] + mesh.positions[f[2]]);
    };
    for (const Face& f : mesh.faces)
        if (!other(f))
            for (const Index v : f) kept[v] = 1;
    for (Face& f : out.faces)
        if (other(f))
            for (Index& v : f) {
                if (!kept[v]) continue;
                if (copy[v] < 0)
                    copy[v] = static_cast<Index>(out.positions.size()), out.positions.push_back(mesh.positions[v]);
                v = copy[v];
            }
    return out;
}

bool right(const Vec3& p) { return p.x() > 0; }

bool names_layers(const plugin::Filter& filter) {
    const plugin::Call call = filter.call(nullptr);
    return std::any_of(call.parameters.begin(), call.parameters.end(),
                       [](const plugin::Parameter& p) { return std::holds_alternative<LayerRef*>(p.field); });
}

/// Filters of one layer that close seams.
std::vector<const plugin::Filter*> closing() {
    std::vector<const plugin::Filter*> all;
    for (const plugin::Filter* f : plugin::all_filters())
        if (f->needs & plugin::closed_seams && !names_layers(*f)) all.push_back(f);
    return all;
}

const plugin::Filter& filter_named(const std::string& name) {
    for (const plugin::Filter* f : plugin::all_filters())
        if (f->python_name == name) return *f;
    throw std::logic_error(name);
}

Result low_pass_across(const Layer& layer, const LowPassOptions& options, Session& session) {
    return across_seams({layer}, close_seams(layer).get(), session,
                        [&](const Inputs& all) { return low_pass(all.current, options, session); });
}

Result wedges_of(const Result& result) {
    Result out;
    out.wedges = result.wedges;
    return out;
}

/// Where each vertex of a new layer is.
Positions places(const DerivedMesh& mesh, const Mesh& input) {
    if (mesh.positions) return *mesh.positions;
    Positions out;
    for (const Index v : mesh.source_vertex) out.push_back(input.positions[v]);
    return out;
}

/// Of a mesh that was cut and of the whole one. That of the cut one has its seams closed, unless it has all vertices.
void expect_same_layer(const DerivedMesh& found, const Mesh& cut, const DerivedMesh& expected, const Mesh& whole) {
    ASSERT_EQ(found.source_face, expected.source_face);
    Mesh mesh{places(found, cut), found.faces};
    if (found.source_vertex.size() == cut.positions.size()) {
        const JoinedVertices seams = join_seams(mesh);
        ASSERT_EQ(seams.first.size(), expected.source_vertex.size());
        for (Face& f : mesh.faces) f = seams.of(f);
        mesh.positions.resize(seams.first.size());  // copies come last
    } else {
        ASSERT_EQ(found.source_vertex, expected.source_vertex);
    }
    ASSERT_EQ(mesh.faces, expected.faces);
    ASSERT_EQ(mesh.positions, places(expected, whole));
}

}  // namespace

TEST(Seams, AreClosedWhereTheMeshWasCut) {
    const Mesh whole = shapes::scan(2000), two = cut(whole, right);
    ASSERT_GT(two.positions.size(), whole.positions.size() + 50);
    const JoinedVertices seams = join_seams(two);
    ASSERT_EQ(seams.first.size(), whole.positions.size());
    for (std::size_t v = 0; v < two.positions.size(); ++v)
        EXPECT_EQ(two.positions[v], whole.positions[seams.joined[v]]);
    Faces faces = two.faces;
    for (Face& f : faces)
        for (Index& v : f) v = seams.joined[v];
    EXPECT_EQ(faces, whole.faces);
}

TEST(Seams, OfFacesThatShareNoVerticesMakeASurface) {
    const Mesh soup = shapes::duplicate_vertices();
    const JoinedVertices seams = join_seams(soup);
    Mesh joined;
    for (const Index v : seams.first) joined.positions.push_back(soup.positions[v]);
    for (const Face& f : soup.faces)
        joined.faces.push_back({seams.joined[f[0]], seams.joined[f[1]], seams.joined[f[2]]});
    const InputCounts counts = count_input(joined);
    EXPECT_EQ(counts.boundary_edges, 0);
    EXPECT_EQ(counts.non_manifold_vertices, 0);
    EXPECT_EQ(counts.vertices, counts.faces / 2 + 2);
}

TEST(Seams, AreNotSeenWhereThereAreNone) {
    for (const auto& [name, mesh] : every_class()) {
        if (name == "duplicate_vertices") continue;
        EXPECT_TRUE(join_seams(mesh).first.empty()) << name;
    }
    Mesh twice = shapes::plane(8);  // one on the other, and back to back with it
    for (const bool turned : {false, true}) {
        Mesh both = twice;
        const Index n = static_cast<Index>(twice.positions.size());
        for (const Vec3& p : twice.positions) both.positions.push_back(p);
        for (const Face& f : twice.faces)
            both.faces.push_back(turned ? Face{n + f[0], n + f[2], n + f[1]} : Face{n + f[0], n + f[1], n + f[2]});
        EXPECT_TRUE(join_seams(both).first.empty()) << turned;
    }
    // Three sheets at one edge, and two triangles that touch at a vertex.
    EXPECT_TRUE(
        join_seams(
            {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {0, 0, 0}, {1, 0, 0}, {0, -1, 0}},
             {{0, 1, 2}, {4, 3, 5}, {7, 6, 8}}})
            .first.empty());
    EXPECT_TRUE(
        join_seams({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {-1, 0, 0}, {0, -1, 0}}, {{0, 1, 2}, {3, 4, 5}}})
            .first.empty());
    const double nan = std::nan("");
    EXPECT_TRUE(
        join_seams({{{nan, 0, 0}, {1, 0, 0}, {0, 1, 0}, {nan, 0, 0}, {1, 0, 0}, {0, 0, 1}}, {{0, 1, 2}, {4, 3, 5}}})
            .first.empty());
}

// Enhance tore a doll that was cut in two apart by seven edges.
TEST(Seams, DoNotChangeWhatFiltersDo) {
    const Mesh whole = shapes::scan(1500), two = cut(whole, right);
    const JoinedVertices seams = join_seams(two);
    ASSERT_GE(closing().size(), 20u);
    for (const plugin::Filter* filter : closing()) {
        SCOPED_TRACE(filter->python_name);
        const auto layer = [&](const Mesh& mesh) {
            Layer out = with_everything(mesh, [&](Index v, int k) { return 100 + 50 * mesh.positions[v][k % 3]; });
            for (const Vec3& p : mesh.positions) out.selected_vertex.push_back(p.z() > 0.3);
            return out;
        };
        Session one, other;
        const Layer expected_of = layer(whole), given = layer(two);
        const Result expected = plugin::run(*filter, expected_of, one, {}),
                     found = plugin::run(*filter, given, other, {});
        for (std::size_t v = 0; v < two.positions.size(); ++v) {
            const std::size_t w = static_cast<std::size_t>(seams.joined[v]);
            if (expected.positions) {
                ASSERT_EQ((*found.positions)[v], (*expected.positions)[w]);
            }
            if (expected.quality) {
                ASSERT_EQ((*found.quality)[v], (*expected.quality)[w]);
            }
            if (expected.selected_vertex) {
                ASSERT_EQ((*found.selected_vertex)[v], (*expected.selected_vertex)[w]);
            }
        }
        ASSERT_EQ(found.attributes.size(), expected.attributes.size());
        for (std::size_t a = 0; a < found.attributes.size(); ++a) {
            const Attribute &f = found.attributes[a], &e = expected.attributes[a];
            for (std::size_t v = 0; v < two.positions.size(); ++v)
                for (int c = 0; c < e.width; ++c)
                    ASSERT_EQ(f.values[v * e.width + c], e.values[seams.joined[v] * e.width + c]);
        }
        if (expected.wedges) {
            ASSERT_EQ(result_hash(wedges_of(found)), result_hash(wedges_of(expected)));
        }
        ASSERT_EQ(found.layer.has_value(), expected.layer.has_value());
        if (expected.layer) expect_same_layer(*found.layer, two, *expected.layer, whole);
    }
}

/// The faces' corners in space.
Positions corners(const DerivedMesh& mesh, const Mesh& input) {
    const Positions all = places(mesh, input);
    Positions out;
    for (const Face& f : mesh.faces)
        for (const Index v : f) out.push_back(all[v]);
    return out;
}

/// Texture coordinates that jump by 10 where a mesh was cut.
Layer in_two_charts(const Mesh& mesh) {
    Layer layer = layer_of(mesh);
    std::vector<std::uint8_t> other(mesh.positions.size(), 0);
    for (const Face& f : mesh.faces)
        for (const Index v : f) other[v] |= right(mesh.positions[f[0]] + mesh.positions[f[1]] + mesh.positions[f[2]]);
    layer.attributes = {attribute(mesh, AttributeKind::texcoord, 2,
                                  [&](Index v, int k) { return mesh.positions[v][k + 1] + 10.0 * other[v]; })};
    return layer;
}

TEST(Seams, LevelsHaveTheirChartsAndNoCracks) {
    const Mesh whole = shapes::scan(3000), two = cut(whole, right);
    const Layer layer = in_two_charts(two);
    for (const auto& [name, values] : std::vector<std::pair<const char*, plugin::Given>>{
             {"generate_multires_level", {}},
             {"generate_multires_adaptive_reconstruction",
              {{"target", 2}, {"vertices", 800}, {"use_texcoord", false}}}}) {
        SCOPED_TRACE(name);
        Session one, other;
        const Result expected = plugin::run(filter_named(name), layer_of(whole), one, values),
                     found = plugin::run(filter_named(name), layer, other, values);
        const DerivedMesh& mesh = *found.layer;
        EXPECT_LT(mesh.source_vertex.size(), two.positions.size() / 2);
        EXPECT_EQ(corners(mesh, two), corners(*expected.layer, whole));
        EXPECT_GT(mesh.source_vertex.size(), expected.layer->source_vertex.size() + 10);
        EXPECT_EQ(count(found.report, "vertices"), static_cast<int>(mesh.source_vertex.size()));
        const std::vector<double>& old = layer.attributes[0].values;
        std::size_t kept = 0;
        for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
            const bool there = old[2 * two.faces[mesh.source_face[f]][0]] > 5;
            for (const Index v : mesh.faces[f]) {
                const Index source = mesh.source_vertex[v];
                const double u = mesh.attributes.empty() ? old[2 * source] : mesh.attributes[0].values[2 * v];
                EXPECT_EQ(u > 5, there);
                kept += u == old[2 * source];
            }
        }
        EXPECT_GT(static_cast<double>(kept), 0.95 * 3 * static_cast<double>(mesh.faces.size()));
    }
}

// Whichever way the host holds a texture: no face of a reconstruction straddles its seams.
TEST(Seams, OfTexturesOfVerticesAreThoseOfWedges) {
    const Mesh whole = shapes::scan(3000), two = cut(whole, right);
    const Layer cut_layer = in_two_charts(two);
    ASSERT_EQ(two.faces.size(), whole.faces.size());
    Layer wedged = layer_of(whole);
    const std::vector<double>& texcoord = cut_layer.attributes[0].values;
    for (const Face& f : two.faces)
        for (const Index v : f) wedged.wedges.push_back({texcoord[2 * v], texcoord[2 * v + 1], 0});
    const plugin::Filter& filter = filter_named("generate_multires_adaptive_reconstruction");
    Session one, other, third;
    const plugin::Given vertices = {{"target", 2}, {"vertices", 300}};
    const Result expected = plugin::run(filter, wedged, one, vertices),
                 found = plugin::run(filter, cut_layer, other, vertices);
    EXPECT_EQ(corners(*found.layer, two), corners(*expected.layer, whole));
    const auto straddling = [&](const DerivedMesh& mesh) {
        std::size_t faces = 0;
        for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
            const auto chart = [&](Index v) { return texcoord[2 * v] > 5; };
            const Face& source = two.faces[mesh.source_face[f]];
            // A corner of the chart, or one on the seam, which is in both.
            const auto in_chart = [&](Index v) {
                for (Index w = 0; w < static_cast<Index>(two.positions.size()); ++w)
                    if (two.positions[w] == two.positions[v] && chart(w) == chart(source[0])) return true;
                return false;
            };
            for (const Index v : mesh.faces[f]) faces += !in_chart(mesh.source_vertex[v]);
        }
        return faces;
    };
    EXPECT_EQ(straddling(*found.layer), 0);
    const Result torn =
        plugin::run(filter, cut_layer, third, {{"target", 2}, {"vertices", 300}, {"use_texcoord", false}});
    EXPECT_GT(straddling(*torn.layer), 10);
}

TEST(Seams, AreThereStillIfNoVertexIsRemoved) {
    const Layer layer = layer_of(cut(shapes::scan(1500), right));
    for (const auto& [name, values] : std::vector<std::pair<const char*, plugin::Given>>{
             {"generate_multires_level", {{"level", 0}}}, {"generate_multires_base", {{"vertices", 200}}}}) {
        SCOPED_TRACE(name);
        Session session;
        const DerivedMesh mesh = *plugin::run(filter_named(name), layer, session, values).layer;
        ASSERT_EQ(mesh.source_vertex.size(), layer.mesh.positions.size());
        Faces faces = mesh.faces;
        for (Face& f : faces)
            for (Index& v : f) v = mesh.source_vertex[v];
        EXPECT_EQ(faces, layer.mesh.faces);
    }
}

// A colour that jumps along half of a seam stays on its side; along the other half the sides stay equal.
TEST(Seams, OfValuesStayOpenWhereTheyJump) {
    const Mesh whole = shapes::scan(1500), two = cut(whole, right);
    Layer layer = in_two_charts(two);
    std::vector<double> jump = layer.attributes[0].values;
    layer.attributes = {attribute(two, AttributeKind::quality, 1, [&](Index v, int) {
        return 100 + two.positions[v].z() + (two.positions[v].y() > 0 && jump[2 * v] > 5 ? 50 : 0);
    })};
    const std::vector<double>& before = layer.attributes[0].values;
    for (const auto& [name, values] : std::vector<std::pair<const char*, plugin::Given>>{
             {"apply_attributes_multires_relaxation", {{"iterations", 20}}}, {"apply_attributes_multires_band", {}}}) {
        SCOPED_TRACE(name);
        Session session;
        const Result result = plugin::run(filter_named(name), layer, session, values);
        const std::vector<double>& after = result.attributes[0].values;
        EXPECT_NE(after, before);
        const JoinedVertices seams = join_seams(two);
        for (std::size_t v = whole.positions.size(); v < two.positions.size(); ++v) {
            const Index twin = seams.first[seams.joined[v]];
            if (before[v] == before[twin]) {
                EXPECT_EQ(after[v], after[twin]);
            } else if (two.positions[v].y() > 0.5) {  // elsewhere the two sides meet round the end of the jump
                EXPECT_GT(after[v] - after[twin], 40);
            }
        }
    }
}

/// Bent about an axis.
Layer bent(Layer layer) {
    for (Vec3& p : layer.mesh.positions) p = Eigen::AngleAxisd(0.8 * p.y(), Vec3::UnitY()) * p;
    return layer;
}

TEST(Seams, StayClosedWhenALayerFollowsItsLevel) {
    const Mesh whole = shapes::scan(1500), two = cut(whole, right);
    const JoinedVertices seams = join_seams(two);
    for (const Encoding encoding : {Encoding::gradient, Encoding::frames, Encoding::phong})
        for (const bool base : {false, true}) {
            SCOPED_TRACE(std::to_string(static_cast<int>(encoding)) + (base ? ", base" : ", level"));
            const auto followed = [&](const Mesh& mesh) {
                const Layer layer = layer_of(mesh);
                Session session;
                const DerivedMesh made =
                    *plugin::run(filter_named(base ? "generate_multires_base" : "generate_multires_level"), layer,
                                 session, {{"vertices", 300}})
                         .layer;
                Layer level = layer_of({places(made, mesh), made.faces});
                level.attributes = {{AttributeKind::scalar,
                                     source_vertex_name,
                                     1,
                                     {made.source_vertex.begin(), made.source_vertex.end()}}};
                const Layer edited = bent(level);
                const plugin::Call call = filter_named("apply_coord_multires_transfer_edit").call(&layer);
                read(call.parameters, {{"encoding", static_cast<double>(encoding)}});
                std::size_t place = 0;
                for (const plugin::Parameter& p : call.parameters)
                    if (LayerRef* const* ref = std::get_if<LayerRef*>(&p.field)) (*ref)->place = place++;
                return *call.run({layer, {&edited, base ? &level : &layer}}, session).positions;
            };
            const Positions expected = followed(whole), found = followed(two);
            EXPECT_GT(largest_distance(expected, whole.positions), 0.1);
            for (std::size_t v = 0; v < found.size(); ++v) ASSERT_EQ(found[v], expected[seams.joined[v]]);
        }
}

TEST(Seams, StayClosedBesideOtherLayers) {
    const Mesh whole = shapes::scan(1500), two = cut(whole, right);
    const JoinedVertices seams = join_seams(two);
    const Layer other = plugin::another_layer(layer_of(shapes::scan(2500)));
    for (const auto& [name, values] : std::vector<std::pair<const char*, plugin::Given>>{
             {"compute_scalar_multires_difference_per_vertex", {{"wavelength", 0.3}}},
             {"transfer_coord_multires_detail", {{"gain", 1.5}}}}) {
        SCOPED_TRACE(name);
        const plugin::Filter& filter = filter_named(name);
        const plugin::Given& given = values;
        const auto run = [&](const Layer& layer) {
            const plugin::Call call = filter.call(&layer);
            read(call.parameters, given);
            for (const plugin::Parameter& p : call.parameters)
                if (LayerRef* const* ref = std::get_if<LayerRef*>(&p.field)) (*ref)->place = 0;
            Session session;
            return call.run({layer, {&other}}, session);
        };
        const Result expected = run(layer_of(whole)), found = run(layer_of(two));
        for (std::size_t v = 0; v < two.positions.size(); ++v) {
            if (expected.positions) {
                ASSERT_EQ((*found.positions)[v], (*expected.positions)[seams.joined[v]]);
            } else {
                ASSERT_EQ((*found.quality)[v], (*expected.quality)[seams.joined[v]]);
            }
        }
    }
}

TEST(Seams, MoveOnlyWhereAllTheirVerticesAreSelected) {
    const Mesh whole = shapes::scan(1500);
    Layer layer = layer_of(cut(whole, right));
    const std::size_t before = whole.positions.size();
    layer.selected_vertex.assign(layer.mesh.positions.size(), 0);
    std::fill_n(layer.selected_vertex.begin(), before, 1);
    LowPassOptions options;
    options.cutoff = 5 * mean_edge_length(whole.faces, whole.positions);
    options.region.selected = true;
    Session session;
    const Result result = low_pass_across(layer, options, session);
    const JoinedVertices seams = join_seams(layer.mesh);
    for (std::size_t v = before; v < layer.mesh.positions.size(); ++v) {
        EXPECT_EQ((*result.positions)[v], layer.mesh.positions[v]);
        EXPECT_EQ((*result.positions)[seams.first[seams.joined[v]]], layer.mesh.positions[v]);
    }
    EXPECT_GT(largest_distance(*result.positions, layer.mesh.positions), 0);
    EXPECT_EQ(number(result.report, "rms_displacement"), displacement(layer.mesh.positions, *result.positions).rms);
}

TEST(Seams, KeepTheOriginalTheyCameFrom) {
    const Mesh whole = shapes::scan(1500);
    Layer layer = layer_of(cut(whole, right));
    LowPassOptions options;
    options.cutoff = 5 * mean_edge_length(whole.faces, whole.positions);
    const auto call = [&](std::shared_ptr<const Original> original) {
        Session session;
        session.original = std::move(original);
        const std::shared_ptr<const Original> given = session.original;
        Result result = low_pass_across(layer, options, session);
        EXPECT_EQ(session.original, given);
        return std::pair(std::move(result), original_after(given.get(), layer.mesh, *result.positions));
    };
    const auto first = call(nullptr);
    layer.mesh.positions = *first.first.positions;
    options.relative_to = RelativeTo::original;
    const auto second = call(first.second);
    EXPECT_LE(largest_distance(*second.first.positions, *first.first.positions), 1e-12);
    const std::shared_ptr<const Original> same = second.second;
    layer.mesh.positions[0].x() += 0.1;
    EXPECT_NE(refusal([&] { call(same); }).find("relative_to"), std::string::npos);
    layer.mesh.positions[0].x() -= 0.1;
    options.cutoff = -1;
    Session session;
    session.original = same;
    EXPECT_NE(refusal([&] { low_pass_across(layer, options, session); }), "");
    EXPECT_EQ(session.original, same);
}

}  // namespace multires
