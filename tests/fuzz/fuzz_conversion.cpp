#include "bytes.h"

#include "vcg/conversion.h"

#include <cmath>

// The boundary to the host's data: a vcg mesh whose faces point anywhere, with elements deleted and components on or
// off. It must become a flat layer with all indices in range, or be refused; a layer must be written back, and a mesh
// derived from it, or be refused when its indices are wrong.

namespace multires::fuzz {
namespace {

class Vertex;
class FaceType;
struct Used : vcg::UsedTypes<vcg::Use<Vertex>::AsVertexType, vcg::Use<FaceType>::AsFaceType> {};
class Vertex : public vcg::Vertex<Used, vcg::vertex::InfoOcf, vcg::vertex::Coord3f, vcg::vertex::BitFlags,
                                  vcg::vertex::Normal3f, vcg::vertex::Qualityf, vcg::vertex::Color4b,
                                  vcg::vertex::VFAdjOcf, vcg::vertex::MarkOcf, vcg::vertex::TexCoordfOcf> {};
class FaceType : public vcg::Face<Used, vcg::face::InfoOcf, vcg::face::VertexRef, vcg::face::BitFlags,
                                  vcg::face::Color4bOcf, vcg::face::QualityfOcf, vcg::face::WedgeTexCoordfOcf> {};
struct VcgMesh : vcg::tri::TriMesh<vcg::vertex::vector_ocf<Vertex>, vcg::face::vector_ocf<FaceType>> {
    ~VcgMesh() { ClearAttributes(); }
};
using Allocator = vcg::tri::Allocator<VcgMesh>;

Vertex* vertex_pointer(VcgMesh& mesh, Bytes& in) {
    const int i = in.byte();
    const auto n = static_cast<int>(mesh.vert.size());
    const auto base = reinterpret_cast<std::uintptr_t>(mesh.vert.data());
    if (i == 255) return nullptr;
    if (i >= 250) return reinterpret_cast<Vertex*>(base + sizeof(Vertex) * (n + i - 250));  // past the end
    if (i >= 248) return reinterpret_cast<Vertex*>(base - sizeof(Vertex) * (i - 247));
    return n ? &mesh.vert[i % n] : nullptr;
}

void fill(VcgMesh& mesh, Bytes& in) {
    const int vertices = in.below(32), faces = in.below(48), components = in.byte();
    if (vertices) Allocator::AddVertices(mesh, vertices);
    if (faces) Allocator::AddFaces(mesh, faces);
    if (components & 1) mesh.vert.EnableTexCoord();
    if (components & 2) mesh.face.EnableWedgeTexCoord();
    if (components & 4) mesh.face.EnableColor();
    for (auto& v : mesh.vert) {
        for (int k = 0; k < 3; ++k) v.P()[k] = static_cast<float>(in.number());
        v.Q() = 0, v.C() = vcg::Color4b(1, 2, 3, 4);
        if (components & 1) v.T() = {0, 0};
    }
    for (auto& f : mesh.face) {
        for (int k = 0; k < 3; ++k) f.V(k) = vertex_pointer(mesh, in);
        const int flags = in.byte();
        if (flags & 1) f.SetS();
        if (flags & 2) f.SetF(1);
        if (flags & 4) Allocator::DeleteFace(mesh, f);
    }
    if (components & 8)
        for (auto& v : mesh.vert)
            if (in.below(8) == 7) Allocator::DeleteVertex(mesh, v);
    if (components & 16) Allocator::AddPerVertexAttribute<double>(mesh, "heat");
    if (components & 32) Allocator::AddPerVertexAttribute<vcg::Point3f>(mesh, "flow");
    if (components & 64) Allocator::AddPerVertexAttribute<std::string>(mesh, "words");
    if (components & 128) Allocator::AddPerFaceAttribute<int>(mesh, "number");
}

void check(const VcgMesh& mesh, const Layer& layer) {
    FUZZ_REQUIRE(static_cast<int>(layer.mesh.positions.size()) == mesh.vn);
    FUZZ_REQUIRE(static_cast<int>(layer.mesh.faces.size()) == mesh.fn);
    for (const Face& f : layer.mesh.faces)
        for (const Index v : f) FUZZ_REQUIRE(v >= 0 && v < mesh.vn);
}

DerivedMesh derived_from(const Layer& layer, Bytes& in) {
    DerivedMesh d;
    const auto n = static_cast<int>(layer.mesh.positions.size()), m = static_cast<int>(layer.mesh.faces.size());
    const int vertices = in.below(16), faces = in.below(16);
    for (int i = 0; i < vertices; ++i) {
        const int source = n ? in.below(n + 1) : 0;
        d.source_vertex.push_back(n && in.byte() == 77 ? source - 1 : source);
    }
    for (int i = 0; i < faces; ++i) {
        d.source_face.push_back(m ? in.below(m + 1) : 0);
        d.faces.push_back({in.below(vertices + 1), in.below(vertices + 1), in.below(vertices + 1)});
    }
    if (in.byte() & 1) d.positions.emplace(in.below(16), Vec3(1, 2, in.number()));
    return d;
}

void convert(VcgMesh& mesh, Bytes& in) {
    AttributeRequest request{true, true, true, custom_attribute_names(mesh), true};
    const VcgLayer flat = to_layer(mesh, request);
    check(mesh, flat.layer);

    Positions moved = flat.layer.mesh.positions;
    if (!moved.empty()) moved[in.below(static_cast<int>(moved.size()))].x() = in.number();
    LayerChanges changes;
    changes.positions = &moved;
    changes.attributes = &flat.layer.attributes;
    if (mesh.face.IsWedgeTexCoordEnabled()) changes.wedges = &flat.layer.wedges;
    try {
        write(mesh, flat, changes);
    } catch (const InputError&) {  // not finite
    }

    VcgMesh target;
    const DerivedMesh derived = derived_from(flat.layer, in);
    try {
        build_derived(target, mesh, flat, derived);
    } catch (const std::invalid_argument&) {
        FUZZ_REQUIRE(target.vert.empty() && target.face.empty());
    } catch (const InputError&) {
        FUZZ_REQUIRE(target.vert.empty() && target.face.empty());
    }
}

}  // namespace
}  // namespace multires::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    multires::fuzz::Bytes in(data, size);
    multires::fuzz::VcgMesh mesh;
    multires::fuzz::fill(mesh, in);
    try {
        multires::fuzz::convert(mesh, in);
        ++multires::fuzz::worked;
    } catch (const multires::InputError&) {
    }
    return 0;
}
