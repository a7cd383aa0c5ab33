#pragma once

#include "mesh/seams.h"
#include "mesh/wedge_charts.h"
#include "vcg/layer.h"

#include <set>

namespace multires {

/// Builds `derived` in the empty mesh `target`, from `source` and the layer `flat` of it.
///
/// All components that `source` has are enabled and copied by source_vertex and source_face, selections and texture
/// names included; so are the custom attributes of the types listed in CustomTypes. Faux bits stay on edges between
/// the vertices they were between, border bits are cleared, wedge texture coordinates follow WedgeCharts; vertices
/// along seams (mesh/seams.h) count as one for both. The custom attribute "source_vertex" holds for every vertex its
/// index in the layer: in the mesh's scalar type, which hosts can show and save, or as int if a float cannot count that
/// far. DerivedMesh::attributes take the place of the source's. Box and normals are the caller's to update, as is what
/// a class derived from vcg::tri::TriMesh adds.
/// @return names of the custom attributes that could not be copied
/// @throws std::invalid_argument  if `target` is not empty or `derived` has indices out of range or arrays of
///                                wrong size; `target` is unchanged then, as it is after
/// @throws InputError             for positions that are not finite in the mesh's precision
/// Cost: linear.
template <class M>
std::vector<std::string> build_derived(M& target, const M& source, const VcgLayer& flat, const DerivedMesh& derived);

// ---------------------------------------------------------------------------------------------------------------------

namespace vcg_detail {

template <class Scalar>
void check_derived(const Mesh& mesh, const DerivedMesh& derived) {
    const auto in = [](Index i, std::size_t n) { return i >= 0 && static_cast<std::size_t>(i) < n; };
    for (Index v : derived.source_vertex) require(in(v, mesh.positions.size()), "source vertex out of range");
    for (Index f : derived.source_face) require(in(f, mesh.faces.size()), "source face out of range");
    for (const Face& f : derived.faces)
        for (Index v : f) require(in(v, derived.source_vertex.size()), "face index out of range");
    require(derived.source_face.size() == derived.faces.size(), "as many source faces as faces are needed");
    require(!derived.positions || derived.positions->size() == derived.source_vertex.size(),
            "as many positions as vertices are needed");
    if (derived.positions) require_finite_as<Scalar>(*derived.positions);
}

// vector_ocf containers have a switch per optional component, plain vectors have none.
template <class Container, class = void>
struct IsOcf : std::false_type {};
template <class Container>
struct IsOcf<Container, std::void_t<decltype(std::declval<Container&>().EnableColor())>> : std::true_type {};

/// Enables in `target` the optional components enabled in `source`, but adjacencies and marks, which are no data.
template <class M>
void enable_components(M& target, const M& source) {
    if constexpr (IsOcf<typename M::VertContainer>::value) {
        auto& t = target.vert;
        const auto& s = source.vert;
        if (s.IsColorEnabled()) t.EnableColor();
        if (s.IsCurvatureEnabled()) t.EnableCurvature();
        if (s.IsCurvatureDirEnabled()) t.EnableCurvatureDir();
        if (s.IsNormalEnabled()) t.EnableNormal();
        if (s.IsQualityEnabled()) t.EnableQuality();
        if (s.IsRadiusEnabled()) t.EnableRadius();
        if (s.IsTexCoordEnabled()) t.EnableTexCoord();
    }
    if constexpr (IsOcf<typename M::FaceContainer>::value) {
        auto& t = target.face;
        const auto& s = source.face;
        if (s.IsColorEnabled()) t.EnableColor();
        if (s.IsCurvatureDirEnabled()) t.EnableCurvatureDir();
        if (s.IsNormalEnabled()) t.EnableNormal();
        if (s.IsQualityEnabled()) t.EnableQuality();
        if (s.IsWedgeColorEnabled()) t.EnableWedgeColor();
        if (s.IsWedgeNormalEnabled()) t.EnableWedgeNormal();
        if (s.IsWedgeTexCoordEnabled()) t.EnableWedgeTexCoord();
    }
}

template <class M>
void build_vertices(M& target, const M& source, const VcgLayer& flat, const DerivedMesh& derived) {
    using Scalar = typename M::ScalarType;
    vcg::tri::Allocator<M>::AddVertices(target, derived.source_vertex.size());
    for (std::size_t i = 0; i < derived.source_vertex.size(); ++i) {
        auto& v = target.vert[i];
        v.ImportData(source.vert[flat.host_vertex[derived.source_vertex[i]]]);
        v.ClearB();
        if (!derived.positions) continue;
        const Vec3& p = (*derived.positions)[i];
        for (int k = 0; k < 3; ++k) v.P()[k] = static_cast<Scalar>(p[k]);
    }
}

/// A face of a derived mesh and the one it comes from, in vertices of the mesh with its seams closed.
inline FacePair pair_of(const DerivedMesh& derived, const Mesh& mesh, const JoinedVertices& seams, std::size_t face) {
    Face now;
    for (int k = 0; k < 3; ++k) now[k] = derived.source_vertex[derived.faces[face][k]];
    return {seams.of(now), seams.of(mesh.faces[derived.source_face[face]])};
}

template <class M>
void build_faces(M& target, const M& source, const VcgLayer& flat, const DerivedMesh& derived,
                 const JoinedVertices& seams) {
    vcg::tri::Allocator<M>::AddFaces(target, derived.faces.size());
    for (std::size_t i = 0; i < derived.faces.size(); ++i) {
        auto& f = target.face[i];
        const auto& original = source.face[flat.host_face[derived.source_face[i]]];
        f.ImportData(original);
        f.ClearB(0), f.ClearB(1), f.ClearB(2);
        const FacePair pair = pair_of(derived, flat.layer.mesh, seams, i);
        for (int k = 0; k < 3; ++k) {
            f.V(k) = &target.vert[derived.faces[i][k]];
            const bool kept = !pair.moved(k) && !pair.moved((k + 1) % 3);
            if (kept && original.IsF(pair.place(k)))
                f.SetF(k);
            else
                f.ClearF(k);
        }
    }
}

template <class M>
void build_wedges(M& target, const M& source, const VcgLayer& flat, const DerivedMesh& derived,
                  const JoinedVertices& seams) {
    if (!vcg::tri::HasPerWedgeTexCoord(source)) return;
    const Mesh& mesh = flat.layer.mesh;
    Faces closed = mesh.faces;
    for (Face& f : closed) f = seams.of(f);
    const WedgeCharts charts(static_cast<Index>(mesh.positions.size()), closed, gather_wedges(source, flat.host_face));
    for (std::size_t i = 0; i < derived.faces.size(); ++i) {
        const FacePair pair = pair_of(derived, mesh, seams, i);
        const auto& original = source.face[flat.host_face[derived.source_face[i]]];
        for (int k = 0; k < 3; ++k) {
            auto& t = target.face[i].WT(k);
            t = original.cWT(pair.place(k));
            if (!pair.moved(k)) continue;
            const Wedge& w = charts.wedge(pair.now[k], derived.source_face[i], pair.place(k));
            t.U() = static_cast<std::decay_t<decltype(t.U())>>(w.u);
            t.V() = static_cast<std::decay_t<decltype(t.V())>>(w.v);
        }
    }
}

/// Copies the named attributes in `from` by `rows`; `make(name, type pointer)` creates the one to be filled.
template <class Container, class Make>
void build_custom(const std::set<vcg::PointerToAttribute>& from, const std::vector<Index>& rows, Make make,
                  std::vector<std::string>& left_out) {
    for (const vcg::PointerToAttribute& a : from) {
        if (a._name.empty() || a._name == source_vertex_name) continue;
        const bool known = visit<Container>(a, CustomTypes(), [&](auto& data) {
            auto made = make(a._name, static_cast<ValueOf<decltype(data)>*>(nullptr));
            for (std::size_t i = 0; i < rows.size(); ++i) made[i] = data[rows[i]];
        });
        if (!known) left_out.push_back(a._name);
    }
}

template <class M>
std::vector<std::string> build_customs(M& target, const M& source, const VcgLayer& flat, const DerivedMesh& derived) {
    std::vector<std::string> left_out;
    const auto hosts = [](const HostIndices& host, std::vector<Index> rows) {
        for (Index& i : rows) i = host[i];
        return rows;
    };
    build_custom<typename M::VertContainer>(
        source.vert_attr, hosts(flat.host_vertex, derived.source_vertex),
        [&](const std::string& name, auto* type) {
            using T = std::remove_pointer_t<decltype(type)>;
            return vcg::tri::Allocator<M>::template GetPerVertexAttribute<T>(target, name);
        },
        left_out);
    build_custom<typename M::FaceContainer>(
        source.face_attr, hosts(flat.host_face, derived.source_face),
        [&](const std::string& name, auto* type) {
            using T = std::remove_pointer_t<decltype(type)>;
            return vcg::tri::Allocator<M>::template GetPerFaceAttribute<T>(target, name);
        },
        left_out);
    return left_out;
}

}  // namespace vcg_detail

template <class M>
std::vector<std::string> build_derived(M& target, const M& source, const VcgLayer& flat, const DerivedMesh& derived) {
    vcg_detail::require(target.vert.empty() && target.face.empty(), "the mesh to be filled is not empty");
    vcg_detail::check_derived<typename M::ScalarType>(flat.layer.mesh, derived);
    VcgLayer all;  // the vertices of the target
    all.host_vertex = HostIndices(derived.source_vertex.size());
    for (const Attribute& a : derived.attributes) vcg_detail::check_attribute(source, all, a);

    vcg_detail::enable_components(target, source);
    vcg_detail::build_vertices(target, source, flat, derived);
    const JoinedVertices seams = join_seams(flat.layer.mesh);
    vcg_detail::build_faces(target, source, flat, derived, seams);
    vcg_detail::build_wedges(target, source, flat, derived, seams);
    target.textures = source.textures;
    target.normalmaps = source.normalmaps;
    std::vector<std::string> left_out = vcg_detail::build_customs(target, source, flat, derived);
    for (const Attribute& a : derived.attributes) vcg_detail::write_attribute(target, all, a);

    const auto number = [&](auto type) {
        auto data = vcg::tri::Allocator<M>::template GetPerVertexAttribute<decltype(type)>(target, source_vertex_name);
        for (std::size_t i = 0; i < derived.source_vertex.size(); ++i)
            data[i] = static_cast<decltype(type)>(derived.source_vertex[i]);
    };
    using Scalar = typename M::ScalarType;
    if (flat.host_vertex.size() <= std::size_t(1) << std::min(31, std::numeric_limits<Scalar>::digits))
        number(Scalar());
    else
        number(int());
    return left_out;
}

}  // namespace multires
