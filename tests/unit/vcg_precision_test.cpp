// Meshes in single and in double precision through the same filters: what a host stores, and when it is rounded.
#include "all_tables.h"
#include "suited.h"
#include "vcg/conversion.h"

#include <gtest/gtest.h>

namespace multires {
namespace {

using namespace plugin;

template <class S>
struct Types {
    class Vertex;
    class Face;
    struct Used : vcg::UsedTypes<vcg::Use<Vertex>::template AsVertexType, vcg::Use<Face>::template AsFaceType> {};
    template <class T>
    struct Coord : vcg::vertex::Coord<vcg::Point3<S>, T> {};
    class Vertex : public vcg::Vertex<Used, Coord, vcg::vertex::BitFlags, vcg::vertex::Normal3f, vcg::vertex::Qualityf,
                                      vcg::vertex::Color4b, vcg::vertex::TexCoord2f> {};
    class Face : public vcg::Face<Used, vcg::face::VertexRef, vcg::face::BitFlags, vcg::face::WedgeTexCoord2f> {};
    using VcgMesh = vcg::tri::TriMesh<std::vector<Vertex>, std::vector<Face>>;
};

/// A mesh whose coordinates are floats, in either precision.
template <class S>
void fill(typename Types<S>::VcgMesh& m, const Mesh& mesh) {
    using Allocator = vcg::tri::Allocator<typename Types<S>::VcgMesh>;
    Allocator::AddVertices(m, mesh.positions.size());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        for (int k = 0; k < 3; ++k) m.vert[i].P()[k] = static_cast<float>(mesh.positions[i][k]);
    Allocator::AddFaces(m, mesh.faces.size());
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
        for (int k = 0; k < 3; ++k) m.face[f].V(k) = &m.vert[mesh.faces[f][k]];
}

template <class M>
void apply(const Filter& filter, M& mesh) {
    const VcgLayer flat = to_layer(mesh);
    Session session;
    const Result result = run(filter, flat.layer, session);
    write(mesh, flat, {&*result.positions});
}

}  // namespace

TEST(Precision, ASinglePrecisionMeshGetsTheDoubleResultRoundedOnce) {
    int filters = 0;
    for (const Plugin* plugin : all_tables())
        for (const Filter& filter : plugin->filters) {
            if (!(filter.changes & vertex_positions)) continue;
            SCOPED_TRACE(filter.python_name);
            Types<float>::VcgMesh single;
            Types<double>::VcgMesh twofold;
            const Mesh mesh = suited(filter, shapes::scan(500, {}));
            fill<float>(single, mesh);
            fill<double>(twofold, mesh);
            apply(filter, single);
            apply(filter, twofold);
            for (std::size_t i = 0; i < single.vert.size(); ++i)
                for (int k = 0; k < 3; ++k)
                    ASSERT_EQ(single.vert[i].P()[k], static_cast<float>(twofold.vert[i].P()[k])) << "vertex " << i;
            ++filters;
        }
    EXPECT_GE(filters, 6);
}

}  // namespace multires
