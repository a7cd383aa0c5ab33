#include "attribute_fixtures.h"
#include "mesh/wedge_charts.h"

#include <cmath>

// Relaxation of wedge texture coordinates, chart by chart.

namespace multires {

using namespace fixtures;

namespace {

/// A plane whose faces right of the middle column of edges are a chart of their own, turned by 90 degrees and moved;
/// noise on the coordinates of the vertices that are not on its outline.
Layer two_charts(double noise) {
    Layer layer;
    layer.mesh = shapes::plane(12, {0, 0, 1});
    for (const Face& f : layer.mesh.faces) {
        double x = 0;
        for (const Index v : f) x += layer.mesh.positions[v].x() / 3;
        for (const Index v : f) {
            const Vec3& p = layer.mesh.positions[v];
            const double du = noise * (random_value(v, 0) - 125) / 125, dv = noise * (random_value(v, 1) - 125) / 125;
            const double u = p.x() + du, w = p.y() + dv;
            layer.wedges.push_back(x < 0.5 ? Wedge{u, w, 0} : Wedge{10 - w, u, 1});
        }
    }
    return layer;
}

TEST(WedgeRelaxation, CutMeshHasANodeForEachCoordinate) {
    const Layer layer = two_charts(0);
    const CutMesh cut = cut_along_seams(layer.mesh, layer.wedges);
    EXPECT_EQ(cut.vertex.size(), layer.mesh.positions.size() + 13);
    EXPECT_EQ(cut.mesh.positions.size(), cut.vertex.size());
    for (std::size_t c = 0; c < layer.wedges.size(); ++c) {
        const Index n = cut.node[c], v = layer.mesh.faces[c / 3][c % 3];
        EXPECT_EQ(cut.vertex[n], v);
        EXPECT_EQ(cut.mesh.faces[c / 3][c % 3], n);
        EXPECT_EQ(cut.wedge[n].u, layer.wedges[c].u);
        EXPECT_TRUE(cut.nodes_of[v] <= n && n < cut.nodes_of[v + 1]);
    }
}

TEST(WedgeRelaxation, CornersThatWereTogetherStayTogether) {
    for (const auto& [name, mesh] : every_class()) {
        Layer layer = with_everything(mesh, random_value);
        for (std::size_t c = 0; c < layer.wedges.size(); ++c)  // a seam through the middle
            if (mesh.positions[mesh.faces[c / 3][0]].x() > 0) layer.wedges[c].u += 1000;
        const CutMesh cut = cut_along_seams(mesh, layer.wedges);
        for (const bool keep : {true, false}) {
            AttributeRelaxationOptions options;
            options.what.wedge_texcoord = true;
            options.keep_outline = keep;
            options.iterations = 3;
            const Result result = relax(layer, options);
            std::vector<const Wedge*> of_node(cut.vertex.size(), nullptr);
            for (std::size_t c = 0; c < cut.node.size(); ++c) {
                const Wedge& w = (*result.wedges)[c];
                const Wedge*& first = of_node[cut.node[c]];
                if (!first) first = &w;
                EXPECT_EQ(w.u, first->u) << name;
                EXPECT_EQ(w.v, first->v) << name;
                EXPECT_EQ(w.texture, layer.wedges[c].texture) << name;
                EXPECT_EQ(w.u > 500, layer.wedges[c].u > 500) << name << ": each chart in its own place";
            }
        }
    }
}

TEST(WedgeRelaxation, OutlinesAreKeptAndTheInsideBecomesSmooth) {
    const Layer noisy = two_charts(0.02), clean = two_charts(0);
    AttributeRelaxationOptions options;
    options.what.wedge_texcoord = true;
    options.iterations = 200;
    const Result result = relax(noisy, options);
    EXPECT_EQ(reported<int>(result, "seam_vertices"), 13);
    const auto rms = [&](const std::vector<Wedge>& wedges, bool outline) {
        double sum = 0;
        for (std::size_t c = 0; c < wedges.size(); ++c) {
            const Vec3& p = noisy.mesh.positions[noisy.mesh.faces[c / 3][c % 3]];
            const bool on = std::min({p.x(), p.y(), 1 - p.x(), 1 - p.y(), std::abs(p.x() - 0.5)}) < 1e-9;
            if (on == outline) sum += std::pow(wedges[c].u - clean.wedges[c].u, 2);
            if (on && outline) {
                EXPECT_EQ(wedges[c].u, noisy.wedges[c].u);
            }
        }
        return std::sqrt(sum);
    };
    EXPECT_LT(rms(*result.wedges, false), 0.5 * rms(noisy.wedges, false));
    rms(*result.wedges, true);
}

TEST(WedgeRelaxation, BothSidesOfASeamMoveAlikeIfOutlinesMay) {
    const Layer noisy = two_charts(0.02);
    AttributeRelaxationOptions options;
    options.what.wedge_texcoord = true;
    options.keep_outline = false;
    options.iterations = 5;
    const std::vector<Wedge> after = *relax(noisy, options).wedges;
    const CutMesh before = cut_along_seams(noisy.mesh, noisy.wedges);
    std::vector<Wedge> node(before.vertex.size());
    for (std::size_t c = 0; c < after.size(); ++c) node[before.node[c]] = after[c];
    int moved = 0;
    for (std::size_t v = 0; v + 1 < before.nodes_of.size(); ++v) {
        if (before.nodes_of[v + 1] - before.nodes_of[v] != 2) continue;
        Wedge a = node[before.nodes_of[v]], b = node[before.nodes_of[v] + 1];
        if (a.texture == 1) std::swap(a, b);
        EXPECT_NEAR(10 - a.v, b.u, 1e-12);
        EXPECT_NEAR(a.u, b.v, 1e-12);
        moved += a.u != before.wedge[before.nodes_of[v]].u && a.u != before.wedge[before.nodes_of[v] + 1].u;
    }
    EXPECT_EQ(moved, 11) << "all but the ends, where the seam meets the boundary";
}

}  // namespace
}  // namespace multires
