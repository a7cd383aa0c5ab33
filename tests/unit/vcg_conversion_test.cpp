// Conversion between vcg meshes and flat layers, for plain and optional components, in float and double.
#include "vcg/conversion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <type_traits>

namespace multires {
namespace {

// vcg meshes do not free their custom attributes.
template <class M>
struct Owning : M {
    ~Owning() { this->ClearAttributes(); }
};

template <class S>
struct PlainTypes {
    class Vertex;
    class Face;
    struct Used : vcg::UsedTypes<vcg::Use<Vertex>::template AsVertexType, vcg::Use<Face>::template AsFaceType> {};
    template <class T>
    struct Coord : vcg::vertex::Coord<vcg::Point3<S>, T> {};
    template <class T>
    struct Quality : vcg::vertex::Quality<S, T> {};
    class Vertex : public vcg::Vertex<Used, Coord, vcg::vertex::BitFlags, vcg::vertex::Normal3f, Quality,
                                      vcg::vertex::Color4b, vcg::vertex::TexCoord2f> {};
    class Face : public vcg::Face<Used, vcg::face::VertexRef, vcg::face::BitFlags, vcg::face::WedgeTexCoord2f,
                                  vcg::face::Color4b> {};
    using Mesh = Owning<vcg::tri::TriMesh<std::vector<Vertex>, std::vector<Face>>>;
};

template <class S>
struct OcfTypes {
    class Vertex;
    class Face;
    struct Used : vcg::UsedTypes<vcg::Use<Vertex>::template AsVertexType, vcg::Use<Face>::template AsFaceType> {};
    template <class T>
    struct Coord : vcg::vertex::Coord<vcg::Point3<S>, T> {};
    class Vertex : public vcg::Vertex<Used, vcg::vertex::InfoOcf, Coord, vcg::vertex::BitFlags, vcg::vertex::Normal3f,
                                      vcg::vertex::Qualityf, vcg::vertex::Color4b, vcg::vertex::VFAdjOcf,
                                      vcg::vertex::MarkOcf, vcg::vertex::TexCoordfOcf> {};
    class Face : public vcg::Face<Used, vcg::face::InfoOcf, vcg::face::VertexRef, vcg::face::BitFlags,
                                  vcg::face::Color4bOcf, vcg::face::QualityfOcf, vcg::face::WedgeTexCoordfOcf> {};
    using Mesh = Owning<vcg::tri::TriMesh<vcg::vertex::vector_ocf<Vertex>, vcg::face::vector_ocf<Face>>>;
};

template <class M>
using Allocator = vcg::tri::Allocator<M>;

// A strip of six vertices and four faces; coordinates that no short decimal fraction represents.
//   3---4---5
//   | \ | \ |
//   0---1---2
template <class M>
void fill(M& mesh) {
    using Scalar = typename M::ScalarType;
    if constexpr (vcg_detail::IsOcf<typename M::VertContainer>::value) {
        mesh.vert.EnableTexCoord();
        mesh.face.EnableWedgeTexCoord();
        mesh.face.EnableColor();
    }
    Allocator<M>::AddVertices(mesh, 6);
    for (int i = 0; i < 6; ++i) {
        auto& v = mesh.vert[i];
        for (int k = 0; k < 3; ++k) v.P()[k] = std::sqrt(Scalar(2 + 3 * i + k));
        v.Q() = static_cast<std::decay_t<decltype(v.Q())>>(Scalar(1) / Scalar(3 + i));
        v.C() = vcg::Color4b(10 * i, 255 - i, i, 200 + i);
        v.T().U() = 0.1F * static_cast<float>(i);
        v.T().V() = 0.7F;
        v.T().N() = 0;
    }
    const int faces[4][3] = {{0, 1, 3}, {1, 4, 3}, {1, 2, 4}, {2, 5, 4}};
    Allocator<M>::AddFaces(mesh, 4);
    for (int i = 0; i < 4; ++i)
        for (int k = 0; k < 3; ++k) mesh.face[i].V(k) = &mesh.vert[faces[i][k]];
}

template <class M>
class VcgConversion : public testing::Test {
protected:
    VcgConversion() { fill(mesh); }
    M mesh;
};

using Meshes =
    testing::Types<PlainTypes<float>::Mesh, PlainTypes<double>::Mesh, OcfTypes<float>::Mesh, OcfTypes<double>::Mesh>;
TYPED_TEST_SUITE(VcgConversion, Meshes, );

AttributeRequest everything() { return {true, true, true, {}}; }

TYPED_TEST(VcgConversion, RoundTripIsExact) {
    VcgLayer flat = to_layer(this->mesh, everything());
    ASSERT_EQ(flat.layer.mesh.positions.size(), 6u);
    ASSERT_EQ(flat.layer.mesh.faces.size(), 4u);
    EXPECT_EQ(flat.layer.mesh.faces[2], (Face{1, 2, 4}));
    ASSERT_EQ(flat.layer.attributes.size(), 3u);
    EXPECT_TRUE(flat.layer.selected_vertex.empty());
    EXPECT_TRUE(flat.layer.selected_face.empty());
    EXPECT_TRUE(flat.layer.faux_edges.empty());
    EXPECT_TRUE(flat.layer.selected_edges.empty());

    TypeParam expected;
    fill(expected);
    for (auto& v : this->mesh.vert) {
        v.P() = typename TypeParam::CoordType(0, 0, 0);
        v.Q() = 0;
        v.C() = vcg::Color4b(0, 0, 0, 0);
        v.T().U() = v.T().V() = 0;
    }
    write(this->mesh, flat, {&flat.layer.mesh.positions, nullptr, &flat.layer.attributes});
    for (int i = 0; i < 6; ++i) {
        EXPECT_EQ(this->mesh.vert[i].P(), expected.vert[i].P());
        EXPECT_EQ(this->mesh.vert[i].Q(), expected.vert[i].Q());
        EXPECT_EQ(this->mesh.vert[i].C(), expected.vert[i].C());
        EXPECT_EQ(this->mesh.vert[i].T().U(), expected.vert[i].T().U());
        EXPECT_EQ(this->mesh.vert[i].T().V(), expected.vert[i].T().V());
    }
}

TYPED_TEST(VcgConversion, DeletedElementsAreSkippedAndLeftAlone) {
    Allocator<TypeParam>::DeleteFace(this->mesh, this->mesh.face[0]);
    Allocator<TypeParam>::DeleteVertex(this->mesh, this->mesh.vert[0]);
    const auto deleted = this->mesh.vert[0].P();
    VcgLayer flat = to_layer(this->mesh);
    std::vector<Index> vertices, faces;
    flat.host_vertex.each([&](Index i) { vertices.push_back(i); });
    flat.host_face.each([&](Index i) { faces.push_back(i); });
    EXPECT_EQ(vertices, (std::vector<Index>{1, 2, 3, 4, 5}));
    EXPECT_EQ(faces, (std::vector<Index>{1, 2, 3}));
    EXPECT_EQ(flat.layer.mesh.faces, (Faces{{0, 3, 2}, {0, 1, 3}, {1, 4, 3}}));

    const Positions moved(5, Vec3(1, 2, 3));
    write(this->mesh, flat, {&moved});
    EXPECT_EQ(this->mesh.vert[0].P(), deleted);
    EXPECT_EQ(this->mesh.vert[5].P(), typename TypeParam::CoordType(1, 2, 3));
}

TYPED_TEST(VcgConversion, FaceOfDeletedOrForeignVertexIsAnError) {
    this->mesh.vert[5].SetD();
    --this->mesh.vn;
    EXPECT_THROW(to_layer(this->mesh), InputError);
    this->mesh.vert[5].ClearD();
    ++this->mesh.vn;
    EXPECT_NO_THROW(to_layer(this->mesh));
    typename TypeParam::VertexType elsewhere;
    this->mesh.face[3].V(1) = &elsewhere;
    EXPECT_THROW(to_layer(this->mesh), InputError);
    this->mesh.face[3].V(1) = nullptr;
    EXPECT_THROW(to_layer(this->mesh), InputError);
}

TYPED_TEST(VcgConversion, SelectionFauxAndSelectedEdgesAreRead) {
    this->mesh.vert[2].SetS();
    this->mesh.face[1].SetS();
    this->mesh.face[3].SetF(0);
    this->mesh.face[3].SetF(2);
    this->mesh.face[2].SetFaceEdgeS(1);
    const Layer layer = to_layer(this->mesh).layer;
    EXPECT_EQ(layer.selected_vertex, (std::vector<std::uint8_t>{0, 0, 1, 0, 0, 0}));
    EXPECT_EQ(layer.selected_face, (std::vector<std::uint8_t>{0, 1, 0, 0}));
    EXPECT_EQ(layer.faux_edges, (std::vector<std::uint8_t>{0, 0, 0, 5}));
    EXPECT_EQ(layer.selected_edges, (std::vector<std::uint8_t>{0, 0, 2, 0}));
}

TYPED_TEST(VcgConversion, ColorsAreRoundedOnceAndClamped) {
    VcgLayer flat = to_layer(this->mesh, {true, false, false, {}});
    Attribute& color = flat.layer.attributes.at(0);
    color.values[0] = 99.5;
    color.values[1] = -3;
    color.values[2] = 300;
    color.values[3] = std::numeric_limits<double>::quiet_NaN();
    write(this->mesh, flat, {nullptr, nullptr, &flat.layer.attributes});
    EXPECT_EQ(this->mesh.vert[0].C(), vcg::Color4b(100, 0, 255, 0));
    EXPECT_EQ(this->mesh.vert[1].C(), vcg::Color4b(10, 254, 1, 201));
}

TYPED_TEST(VcgConversion, CustomAttributesByName) {
    auto scalar = Allocator<TypeParam>::template AddPerVertexAttribute<double>(this->mesh, "height");
    auto point = Allocator<TypeParam>::template AddPerVertexAttribute<vcg::Point3f>(this->mesh, "flow");
    Allocator<TypeParam>::template AddPerVertexAttribute<std::string>(this->mesh, "label");
    for (int i = 0; i < 6; ++i) {
        scalar[i] = i / 3.0;
        point[i] = vcg::Point3f(i, 2 * i, 0.1F);
    }
    EXPECT_EQ(custom_attribute_names(this->mesh), (std::vector<std::string>{"flow", "height"}));
    AttributeRequest request;
    request.custom = {"height", "flow"};
    VcgLayer flat = to_layer(this->mesh, request);
    ASSERT_EQ(flat.layer.attributes.size(), 2u);
    EXPECT_EQ(flat.layer.attributes[0].kind, AttributeKind::scalar);
    EXPECT_EQ(flat.layer.attributes[1].kind, AttributeKind::point);
    EXPECT_EQ(flat.layer.attributes[1].width, 3);
    EXPECT_EQ(flat.layer.attributes[0].values[4], 4 / 3.0);
    EXPECT_EQ(flat.layer.attributes[1].values[3 * 4 + 1], 8.0);

    for (double& x : flat.layer.attributes[0].values) x *= 2;
    write(this->mesh, flat, {nullptr, nullptr, &flat.layer.attributes});
    EXPECT_EQ(scalar[4], 8 / 3.0);
    EXPECT_EQ(point[5], vcg::Point3f(5, 10, 0.1F));

    request.custom = {"label"};
    EXPECT_THROW(to_layer(this->mesh, request), InputError);
    request.custom = {"absent"};
    EXPECT_THROW(to_layer(this->mesh, request), InputError);
}

TYPED_TEST(VcgConversion, WedgesAreReadAndWrittenExactly) {
    int i = 0;
    for (auto& f : this->mesh.face)
        for (int k = 0; k < 3; ++k, ++i) {
            f.WT(k).U() = 0.1F * static_cast<float>(i);
            f.WT(k).V() = -0.3F;
            f.WT(k).N() = static_cast<short>(i % 2);
        }
    Allocator<TypeParam>::DeleteFace(this->mesh, this->mesh.face[0]);
    AttributeRequest request;
    EXPECT_TRUE(to_layer(this->mesh, request).layer.wedges.empty());
    request.wedges = true;
    const VcgLayer flat = to_layer(this->mesh, request);
    ASSERT_EQ(flat.layer.wedges.size(), 9u);
    EXPECT_EQ(flat.layer.wedges[4].u, 0.1F * 7);
    EXPECT_EQ(flat.layer.wedges[4].texture, 1);

    std::vector<Wedge> wedges = flat.layer.wedges;
    wedges[4] = {0.25, 0.75, 0};
    LayerChanges changes;
    changes.wedges = &wedges;
    write(this->mesh, flat, changes);
    EXPECT_EQ(this->mesh.face[2].WT(1).U(), 0.25F);
    EXPECT_EQ(this->mesh.face[2].WT(1).V(), 0.75F);
    EXPECT_EQ(this->mesh.face[2].WT(1).N(), 0);
    EXPECT_EQ(this->mesh.face[2].WT(2).U(), 0.1F * 8);
    EXPECT_EQ(this->mesh.face[0].WT(1).U(), 0.1F);
    wedges.pop_back();
    EXPECT_THROW(write(this->mesh, flat, changes), std::invalid_argument);
}

TYPED_TEST(VcgConversion, WriteIsAllOrNothing) {
    const VcgLayer flat = to_layer(this->mesh);
    const auto before = this->mesh.vert[1].P();
    Positions moved(6, Vec3(1, 2, 3));
    const std::vector<double> short_quality(5, 1.0);
    EXPECT_THROW(write(this->mesh, flat, {&moved, &short_quality}), std::invalid_argument);
    const std::vector<Attribute> unknown{{AttributeKind::scalar, "absent", 1, std::vector<double>(6, 1.0)}};
    EXPECT_THROW(write(this->mesh, flat, {&moved, nullptr, &unknown}), std::invalid_argument);
    moved[5].x() = std::numeric_limits<double>::infinity();
    EXPECT_THROW(write(this->mesh, flat, {&moved}), InputError);
    EXPECT_EQ(this->mesh.vert[1].P(), before);
    EXPECT_NE(this->mesh.vert[1].Q(), 1);
}

TYPED_TEST(VcgConversion, EmptyMeshGivesEmptyLayer) {
    TypeParam empty;
    Allocator<TypeParam>::template AddPerVertexAttribute<double>(empty, "height");
    AttributeRequest request = everything();
    request.custom = {"height"};
    VcgLayer flat = to_layer(empty, request);
    EXPECT_TRUE(flat.layer.mesh.positions.empty());
    EXPECT_TRUE(flat.layer.mesh.faces.empty());
    EXPECT_NO_THROW(write(empty, flat, {&flat.layer.mesh.positions, nullptr, &flat.layer.attributes}));
    TypeParam target;
    EXPECT_NO_THROW(build_derived(target, empty, flat, {}));
}

// Vertex 4 of the strip collapses into vertex 1: faces 0 and 3 stay, face 3 with a new corner.
DerivedMesh collapsed() {
    DerivedMesh derived;
    derived.source_vertex = {0, 1, 2, 3, 5};
    derived.faces = {{0, 1, 3}, {2, 4, 1}};
    derived.source_face = {0, 3};
    return derived;
}

TYPED_TEST(VcgConversion, DerivedMeshCarriesEverything) {
    TypeParam& mesh = this->mesh;
    mesh.vert[2].SetS();
    mesh.face[3].SetS();
    mesh.face[3].SetF(0);  // 2-5: its vertices stay
    mesh.face[3].SetF(1);  // 5-4: 4 goes
    for (int i = 0; i < 4; ++i) mesh.face[i].C() = vcg::Color4b(i, i, i, 255);
    mesh.textures = {"checker.png"};
    auto height = Allocator<TypeParam>::template AddPerVertexAttribute<double>(mesh, "height");
    auto label = Allocator<TypeParam>::template AddPerVertexAttribute<std::string>(mesh, "label");
    auto group = Allocator<TypeParam>::template AddPerFaceAttribute<int>(mesh, "group");
    Allocator<TypeParam>::template AddPerVertexAttribute<std::vector<int>>(mesh, "odd");
    for (int i = 0; i < 6; ++i) height[i] = 10 + i, label[i] = std::string(i, 'x');
    for (int i = 0; i < 4; ++i) group[i] = 100 + i;

    const VcgLayer flat = to_layer(mesh);
    DerivedMesh derived = collapsed();
    derived.positions = Positions(5, Vec3(0.5, 0.25, 0.125));
    TypeParam target;
    EXPECT_EQ(build_derived(target, mesh, flat, derived), (std::vector<std::string>{"odd"}));

    ASSERT_EQ(target.VN(), 5);
    ASSERT_EQ(target.FN(), 2);
    auto height2 = Allocator<TypeParam>::template FindPerVertexAttribute<double>(target, "height");
    auto label2 = Allocator<TypeParam>::template FindPerVertexAttribute<std::string>(target, "label");
    auto group2 = Allocator<TypeParam>::template FindPerFaceAttribute<int>(target, "group");
    auto source =
        Allocator<TypeParam>::template FindPerVertexAttribute<typename TypeParam::ScalarType>(target, "source_vertex");
    for (int i = 0; i < 5; ++i) {
        const int from = derived.source_vertex[i];
        EXPECT_EQ(target.vert[i].P(), typename TypeParam::CoordType(0.5, 0.25, 0.125));
        EXPECT_EQ(target.vert[i].C(), mesh.vert[from].C());
        EXPECT_EQ(target.vert[i].Q(), mesh.vert[from].Q());
        EXPECT_EQ(target.vert[i].T().U(), mesh.vert[from].T().U());
        EXPECT_EQ(target.vert[i].IsS(), from == 2);
        EXPECT_EQ(height2[i], 10 + from);
        EXPECT_EQ(label2[i].size(), static_cast<std::size_t>(from));
        EXPECT_EQ(source[i], from);
    }
    EXPECT_EQ(group2[1], 103);
    EXPECT_EQ(target.face[1].C(), mesh.face[3].C());
    EXPECT_EQ(target.face[1].V(1), &target.vert[4]);
    EXPECT_TRUE(target.face[1].IsS());
    EXPECT_TRUE(target.face[1].IsF(0));
    EXPECT_FALSE(target.face[1].IsF(1));
    EXPECT_FALSE(target.face[1].IsF(2));
    EXPECT_EQ(target.textures, mesh.textures);
}

TYPED_TEST(VcgConversion, DerivedOfDerivedNumbersVerticesOfItsOwnSource) {
    const VcgLayer flat = to_layer(this->mesh);
    TypeParam first, second;
    build_derived(first, this->mesh, flat, collapsed());
    DerivedMesh last;
    last.source_vertex = {4};
    EXPECT_TRUE(build_derived(second, first, to_layer(first), last).empty());
    auto source =
        Allocator<TypeParam>::template FindPerVertexAttribute<typename TypeParam::ScalarType>(second, "source_vertex");
    EXPECT_EQ(source[0], 4);
}

TYPED_TEST(VcgConversion, WrongDerivedMeshLeavesTheTargetEmpty) {
    const VcgLayer flat = to_layer(this->mesh);
    TypeParam target;
    DerivedMesh derived = collapsed();
    derived.source_vertex[0] = 6;
    EXPECT_THROW(build_derived(target, this->mesh, flat, derived), std::invalid_argument);
    derived = collapsed();
    derived.source_face.pop_back();
    EXPECT_THROW(build_derived(target, this->mesh, flat, derived), std::invalid_argument);
    derived = collapsed();
    derived.faces[0][2] = 5;
    EXPECT_THROW(build_derived(target, this->mesh, flat, derived), std::invalid_argument);
    EXPECT_EQ(target.vert.size(), 0u);
    EXPECT_EQ(target.vert_attr.size(), 0u);
}

// The strip has a seam along 1-4: faces 0, 1 lie in one chart, faces 2, 3 in another one.
template <class M>
void set_seam(M& mesh) {
    for (int f = 0; f < 4; ++f)
        for (int k = 0; k < 3; ++k) {
            const auto i = mesh.face[f].V(k) - &mesh.vert[0];
            auto& t = mesh.face[f].WT(k);
            t.U() = static_cast<float>(i % 3) + (f < 2 ? 0.0F : 10.0F);
            t.V() = static_cast<float>(i / 3);
            t.N() = 2;
        }
}

TYPED_TEST(VcgConversion, WedgesOfMovedCornersStayInTheirChart) {
    set_seam(this->mesh);
    const VcgLayer flat = to_layer(this->mesh);
    TypeParam target;
    build_derived(target, this->mesh, flat, collapsed());
    for (int k = 0; k < 3; ++k) EXPECT_EQ(target.face[0].WT(k).U(), this->mesh.face[0].WT(k).U());
    const auto& moved = target.face[1].WT(2);  // vertex 1, which has u = 1 and u = 11
    EXPECT_EQ(moved.U(), 11.0F);
    EXPECT_EQ(moved.V(), 0.0F);
    EXPECT_EQ(moved.N(), 2);
}

TYPED_TEST(VcgConversion, WedgesOfTurnedFacesFollowTheirVertices) {
    set_seam(this->mesh);
    DerivedMesh turned = collapsed();
    turned.faces[1] = {1, 2, 4};
    TypeParam target;
    build_derived(target, this->mesh, to_layer(this->mesh), turned);
    EXPECT_EQ(target.face[1].WT(0).U(), 11.0F);
    EXPECT_EQ(target.face[1].WT(1).U(), 12.0F);
    EXPECT_EQ(target.face[1].WT(2).V(), 1.0F);
}

TEST(WedgeCharts, VertexOutsideTheChartKeepsTheOldWedge) {
    const Faces faces{{0, 1, 2}, {3, 4, 5}};
    const std::vector<Wedge> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
    const WedgeCharts charts(6, faces, corners);
    EXPECT_EQ(charts.wedge(3, 0, 1).u, 1);
    EXPECT_EQ(charts.wedge(3, 0, 1).texture, 0);
    EXPECT_EQ(charts.wedge(2, 0, 1).v, 1);
}

TEST(WedgeCharts, OfTwoWedgesInOneChartTheNearestIsTaken) {
    // A closed band of three quads cut open along 0-3: u runs from 0 to 3, vertices 0 and 3 have both.
    const Faces faces{{0, 1, 3}, {1, 4, 3}, {1, 2, 4}, {2, 5, 4}, {2, 0, 5}, {0, 3, 5}};
    const std::vector<Wedge> corners{{0, 0}, {1, 0}, {0, 1}, {1, 0}, {1, 1}, {0, 1}, {1, 0}, {2, 0}, {1, 1},
                                     {2, 0}, {2, 1}, {1, 1}, {2, 0}, {3, 0}, {2, 1}, {3, 0}, {3, 1}, {2, 1}};
    const WedgeCharts charts(6, faces, corners);
    EXPECT_EQ(charts.wedge(0, 1, 0).u, 0);  // from vertex 1 at u = 1
    EXPECT_EQ(charts.wedge(0, 3, 0).u, 3);  // from vertex 2 at u = 2
}

}  // namespace
}  // namespace multires
