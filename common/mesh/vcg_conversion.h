#pragma once

#include "mesh/error.h"
#include "mesh/layer.h"
#include "mesh/wedge_charts.h"

#include <vcg/complex/complex.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

/// Between any vcg triangle mesh type M and flat layers: the only header of common/ that includes vcglib.
/// M may keep its components in plain vectors or in vector_ocf ones (MeshLab's CMeshO), in float or double.
namespace multires {

/// Which per-vertex attributes to_layer copies.
struct AttributeRequest {
    bool color = false, quality = false, texcoord = false;  ///< left out where the mesh does not have it
    std::vector<std::string> custom;                        ///< by name; see custom_attribute_names
};

/// A layer, and where its elements live in the vcg mesh it came from. Good until that mesh is next changed.
struct VcgLayer {
    Layer layer;
    std::vector<Index> host_vertex;  ///< #V, index into M::vert
    std::vector<Index> host_face;    ///< #F, index into M::face
};

/// New values for a mesh; null parts stay as they are. All by vertex of the VcgLayer they were computed from.
struct LayerChanges {
    const Positions* positions = nullptr;                ///< #V by 3, finite
    const std::vector<double>* quality = nullptr;        ///< #V, becomes the vertex quality
    const std::vector<Attribute>* attributes = nullptr;  ///< kinds and names as to_layer gave them
};

/// Names of the custom per-vertex attributes that to_layer can give: float, double, Point3f and Point3d ones.
template <class M>
std::vector<std::string> custom_attribute_names(const M& mesh);

/// Copies the elements of `mesh` that are not deleted, in their order.
/// @throws InputError  if a face refers to a vertex that is deleted or not in the mesh, if the mesh is too large for
///                     32-bit indices, or if a custom attribute asked for does not exist
/// Cost: linear.
template <class M>
VcgLayer to_layer(const M& mesh, const AttributeRequest& request = {});

/// Writes `changes` into the mesh `flat` was made from: all of them, or nothing if it throws. Nothing else of the mesh
/// changes: bounding box and normals are the caller's to update. Colours are rounded to the nearest integer and
/// clamped to 0..255, here and nowhere else; texture coordinates keep their texture index.
/// @throws std::invalid_argument  for wrong sizes, attributes the mesh does not have, positions that are not finite
///                                in the mesh's precision
/// Cost: linear.
template <class M>
void write(M& mesh, const VcgLayer& flat, const LayerChanges& changes);

/// Builds `derived` in the empty mesh `target`, from `source` and the layer `flat` of it.
///
/// All components that `source` has are enabled and copied by source_vertex and source_face, selections and texture
/// names included; so are the custom attributes of the types listed in CustomTypes. Faux bits stay on edges between
/// the vertices they were between, border bits are cleared, wedge texture coordinates follow WedgeCharts. The custom
/// attribute "source_vertex" holds for every vertex its index in the layer: in the mesh's scalar type, which hosts
/// can show and save, or as int if a float cannot count that far. Box and normals are the caller's to update, as is
/// what a class derived from vcg::tri::TriMesh adds.
/// @return names of the custom attributes that could not be copied
/// @throws std::invalid_argument  if `target` is not empty or `derived` has indices out of range or arrays of
///                                wrong size; `target` is unchanged then
/// Cost: linear.
template <class M>
std::vector<std::string> build_derived(M& target, const M& source, const VcgLayer& flat, const DerivedMesh& derived);

// ---------------------------------------------------------------------------------------------------------------------

namespace vcg_detail {

template <class... T>
struct Types {};

/// Types of custom attributes that travel to a layer.
using LayerTypes = Types<float, double, vcg::Point3f, vcg::Point3d>;

/// Types of custom attributes that are copied to a derived mesh.
using CustomTypes = Types<float, double, vcg::Point3f, vcg::Point3d, int, unsigned, short, unsigned short, char,
                          signed char, unsigned char, long, unsigned long, long long, unsigned long long, vcg::Point2f,
                          vcg::Point2d, vcg::Point3i, vcg::Color4b, std::string>;

/// Calls f with the typed data of a custom attribute; false if its type is not in the list.
template <class Container, class F, class... T>
bool visit(const vcg::PointerToAttribute& attribute, Types<T...>, F&& f) {
    const auto as = [&](auto* type) {
        using Data = vcg::SimpleTempData<Container, std::remove_pointer_t<decltype(type)>>;
        if (attribute._type != typeid(*type)) return false;
        f(static_cast<Data&>(*attribute._handle));
        return true;
    };
    return (as(static_cast<T*>(nullptr)) || ...);
}

template <class S>
double component(const S& scalar, int) {
    return scalar;
}
template <class S>
double component(const vcg::Point3<S>& point, int k) {
    return point[k];
}
template <class S>
void set_component(S& scalar, int, double value) {
    scalar = static_cast<S>(value);
}
template <class S>
void set_component(vcg::Point3<S>& point, int k, double value) {
    point[k] = static_cast<S>(value);
}
template <class S>
constexpr int width = 1;
template <class S>
constexpr int width<vcg::Point3<S>> = 3;

/// What a reference to vcg::SimpleTempData gives by index.
template <class Data>
using ValueOf = std::decay_t<decltype(std::declval<Data>()[std::size_t()])>;

inline unsigned char to_byte(double value) {
    return static_cast<unsigned char>(std::lround(value > 0 ? std::min(value, 255.0) : 0.0));
}

template <class M>
const vcg::PointerToAttribute* find_custom(const M& mesh, const std::string& name) {
    for (const vcg::PointerToAttribute& a : mesh.vert_attr)
        if (!name.empty() && a._name == name) return &a;
    return nullptr;
}

inline void require(bool condition, const char* message) {
    if (!condition) throw std::invalid_argument(message);
}

/// Index of `vertex` in the mesh's array, -1 if it does not point into it.
template <class M>
Index array_index(const M& mesh, const typename M::VertexType* vertex) {
    const auto* begin = mesh.vert.data();
    const std::less<const typename M::VertexType*> less;
    if (less(vertex, begin) || !less(vertex, begin + mesh.vert.size())) return -1;
    return static_cast<Index>(vertex - begin);
}

template <class M>
void copy_vertices(const M& mesh, VcgLayer& out, std::vector<Index>& flat_vertex) {
    out.layer.mesh.positions.reserve(mesh.vn);
    out.host_vertex.reserve(mesh.vn);
    std::vector<std::uint8_t> selected;
    selected.reserve(mesh.vn);
    bool any = false;
    for (std::size_t i = 0; i < mesh.vert.size(); ++i) {
        const auto& v = mesh.vert[i];
        if (v.IsD()) continue;
        flat_vertex[i] = static_cast<Index>(out.host_vertex.size());
        out.host_vertex.push_back(static_cast<Index>(i));
        out.layer.mesh.positions.emplace_back(v.cP()[0], v.cP()[1], v.cP()[2]);
        selected.push_back(v.IsS());
        any = any || v.IsS();
    }
    if (any) out.layer.selected_vertex = std::move(selected);
}

template <class M>
void copy_faces(const M& mesh, const std::vector<Index>& flat_vertex, VcgLayer& out) {
    out.layer.mesh.faces.reserve(mesh.fn);
    out.host_face.reserve(mesh.fn);
    std::vector<std::uint8_t> selected, faux;
    selected.reserve(mesh.fn);
    faux.reserve(mesh.fn);
    bool any_selected = false, any_faux = false;
    for (std::size_t i = 0; i < mesh.face.size(); ++i) {
        const auto& f = mesh.face[i];
        if (f.IsD()) continue;
        Face corners;
        int bits = 0;
        for (int k = 0; k < 3; ++k) {
            const Index at = array_index(mesh, f.cV(k));
            if (at < 0 || flat_vertex[at] < 0)
                throw InputError("Face " + std::to_string(i) + " refers to a vertex that " +
                                 (at < 0 ? "is not in the mesh." : "was deleted.") + " Nothing was changed.");
            corners[k] = flat_vertex[at];
            bits |= f.IsF(k) ? 1 << k : 0;
        }
        out.layer.mesh.faces.push_back(corners);
        out.host_face.push_back(static_cast<Index>(i));
        selected.push_back(f.IsS());
        faux.push_back(static_cast<std::uint8_t>(bits));
        any_selected = any_selected || f.IsS();
        any_faux = any_faux || bits != 0;
    }
    if (any_selected) out.layer.selected_face = std::move(selected);
    if (any_faux) out.layer.faux_edges = std::move(faux);
}

/// An attribute with `value(vertex, k)` at the host's vertices.
template <class F>
Attribute gather(AttributeKind kind, std::string name, int width, const std::vector<Index>& host_vertex, F value) {
    Attribute a{kind, std::move(name), width, {}};
    a.values.reserve(host_vertex.size() * width);
    for (Index i : host_vertex)
        for (int k = 0; k < width; ++k) a.values.push_back(value(i, k));
    return a;
}

template <class M>
void copy_attributes(const M& mesh, const AttributeRequest& request, VcgLayer& out) {
    const auto add = [&](AttributeKind kind, std::string name, int width, auto value) {
        out.layer.attributes.push_back(gather(kind, std::move(name), width, out.host_vertex, value));
    };
    if (request.color && vcg::tri::HasPerVertexColor(mesh))
        add(AttributeKind::color, "", 4, [&](Index i, int k) -> double { return mesh.vert[i].cC()[k]; });
    if (request.quality && vcg::tri::HasPerVertexQuality(mesh))
        add(AttributeKind::quality, "", 1, [&](Index i, int) -> double { return mesh.vert[i].cQ(); });
    if (request.texcoord && vcg::tri::HasPerVertexTexCoord(mesh))
        add(AttributeKind::texcoord, "", 2,
            [&](Index i, int k) -> double { return k == 0 ? mesh.vert[i].cT().U() : mesh.vert[i].cT().V(); });
    for (const std::string& name : request.custom) {
        const auto* custom = find_custom(mesh, name);
        const bool found = custom && visit<typename M::VertContainer>(*custom, LayerTypes(), [&](auto& data) {
                               constexpr int w = width<ValueOf<decltype(data)>>;
                               add(w == 1 ? AttributeKind::scalar : AttributeKind::point, name, w,
                                   [&](Index i, int k) { return component(data[i], k); });
                           });
        if (!found)
            throw InputError("The mesh has no custom vertex attribute \"" + name + "\" of a scalar or point type.");
    }
}

/// Throws unless `mesh` can take the attribute.
template <class M>
void check_attribute(const M& mesh, const VcgLayer& flat, const Attribute& a) {
    require(a.width > 0 && a.values.size() == flat.host_vertex.size() * a.width, "attribute of wrong size");
    switch (a.kind) {
    case AttributeKind::color:
        return require(vcg::tri::HasPerVertexColor(mesh) && a.width == 4, "no vertex colour");
    case AttributeKind::quality:
        return require(vcg::tri::HasPerVertexQuality(mesh) && a.width == 1, "no quality");
    case AttributeKind::texcoord:
        return require(vcg::tri::HasPerVertexTexCoord(mesh) && a.width == 2, "no vertex texture coordinates");
    case AttributeKind::scalar:
    case AttributeKind::point:
        break;
    }
    const auto* custom = find_custom(mesh, a.name);
    int expected = 0;
    if (custom)
        visit<typename M::VertContainer>(*custom, LayerTypes(),
                                         [&](auto& data) { expected = width<ValueOf<decltype(data)>>; });
    require(a.width == expected, "no such custom attribute");
}

template <class M>
void check_changes(const M& mesh, const VcgLayer& flat, const LayerChanges& changes) {
    using Scalar = typename M::ScalarType;
    const std::size_t n = flat.host_vertex.size();
    for (Index i : flat.host_vertex)
        require(i >= 0 && static_cast<std::size_t>(i) < mesh.vert.size(), "the mesh changed since it was read");
    if (changes.positions) {
        require(changes.positions->size() == n, "positions of wrong size");
        for (const Vec3& p : *changes.positions)
            require(p.template cast<Scalar>().allFinite(), "the result has coordinates that are not finite");
    }
    if (changes.quality)
        require(changes.quality->size() == n && vcg::tri::HasPerVertexQuality(mesh), "quality of wrong size");
    if (changes.attributes)
        for (const Attribute& a : *changes.attributes) check_attribute(mesh, flat, a);
}

template <class M>
void write_quality(M& mesh, const VcgLayer& flat, const std::vector<double>& values) noexcept {
    using Quality = typename M::VertexType::QualityType;
    for (std::size_t i = 0; i < values.size(); ++i)
        mesh.vert[flat.host_vertex[i]].Q() = static_cast<Quality>(values[i]);
}

template <class M>
void write_attribute(M& mesh, const VcgLayer& flat, const Attribute& a) noexcept {
    const double* value = a.values.data();
    const auto each = [&](auto assign) {
        for (Index i : flat.host_vertex)
            for (int k = 0; k < a.width; ++k) assign(i, k, *value++);
    };
    switch (a.kind) {
    case AttributeKind::quality:
        return write_quality(mesh, flat, a.values);
    case AttributeKind::color:
        return each([&](Index i, int k, double x) { mesh.vert[i].C()[k] = to_byte(x); });
    case AttributeKind::texcoord:
        return each([&](Index i, int k, double x) {
            auto& t = mesh.vert[i].T();
            (k == 0 ? t.U() : t.V()) = static_cast<std::decay_t<decltype(t.U())>>(x);
        });
    case AttributeKind::scalar:
    case AttributeKind::point:
        visit<typename M::VertContainer>(*find_custom(mesh, a.name), LayerTypes(), [&](auto& data) {
            each([&](Index i, int k, double x) { set_component(data[i], k, x); });
        });
    }
}

inline void check_derived(const Mesh& mesh, const DerivedMesh& derived) {
    const auto in = [](Index i, std::size_t n) { return i >= 0 && static_cast<std::size_t>(i) < n; };
    for (Index v : derived.source_vertex) require(in(v, mesh.positions.size()), "source vertex out of range");
    for (Index f : derived.source_face) require(in(f, mesh.faces.size()), "source face out of range");
    for (const Face& f : derived.faces)
        for (Index v : f) require(in(v, derived.source_vertex.size()), "face index out of range");
    require(derived.source_face.size() == derived.faces.size(), "as many source faces as faces are needed");
    require(!derived.positions || derived.positions->size() == derived.source_vertex.size(),
            "as many positions as vertices are needed");
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

/// A face of a derived mesh beside the one it comes from: corner k of the first took the place of corner
/// (k + turn) mod 3 of the second, with the turn that leaves most corners where they were.
struct FacePair {
    Face now;  ///< indices into the layer's vertices
    Face then;
    int turn = 0;

    FacePair(const DerivedMesh& derived, const Mesh& mesh, std::size_t face)
        : then(mesh.faces[derived.source_face[face]]) {
        for (int k = 0; k < 3; ++k) now[k] = derived.source_vertex[derived.faces[face][k]];
        int best = -1;
        for (int t = 0; t < 3; ++t) {
            const int same = (now[0] == then[t]) + (now[1] == then[(1 + t) % 3]) + (now[2] == then[(2 + t) % 3]);
            if (same > best) best = same, turn = t;
        }
    }
    int place(int k) const { return (k + turn) % 3; }
    bool moved(int k) const { return now[k] != then[place(k)]; }
};

template <class M>
void build_faces(M& target, const M& source, const VcgLayer& flat, const DerivedMesh& derived) {
    vcg::tri::Allocator<M>::AddFaces(target, derived.faces.size());
    for (std::size_t i = 0; i < derived.faces.size(); ++i) {
        auto& f = target.face[i];
        const auto& original = source.face[flat.host_face[derived.source_face[i]]];
        f.ImportData(original);
        f.ClearB(0), f.ClearB(1), f.ClearB(2);
        const FacePair pair(derived, flat.layer.mesh, i);
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
void build_wedges(M& target, const M& source, const VcgLayer& flat, const DerivedMesh& derived) {
    if (!vcg::tri::HasPerWedgeTexCoord(source)) return;
    std::vector<Wedge> corners;
    corners.reserve(3 * flat.host_face.size());
    for (Index f : flat.host_face)
        for (int k = 0; k < 3; ++k) {
            const auto t = source.face[f].cWT(k);
            corners.push_back({t.U(), t.V(), t.N()});
        }
    const Mesh& mesh = flat.layer.mesh;
    const WedgeCharts charts(static_cast<Index>(mesh.positions.size()), mesh.faces, std::move(corners));
    for (std::size_t i = 0; i < derived.faces.size(); ++i) {
        const FacePair pair(derived, mesh, i);
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

constexpr const char* source_vertex_name = "source_vertex";

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
    const auto hosts = [](const std::vector<Index>& host, std::vector<Index> rows) {
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
std::vector<std::string> custom_attribute_names(const M& mesh) {
    std::vector<std::string> names;
    for (const vcg::PointerToAttribute& a : mesh.vert_attr)
        if (!a._name.empty() &&
            vcg_detail::visit<typename M::VertContainer>(a, vcg_detail::LayerTypes(), [](const auto&) {}))
            names.push_back(a._name);
    return names;
}

template <class M>
VcgLayer to_layer(const M& mesh, const AttributeRequest& request) {
    constexpr std::size_t most = std::numeric_limits<Index>::max();
    if (mesh.vert.size() > most || mesh.face.size() > most / 3)
        throw InputError("The mesh is too large: at most 2,147,483,647 vertices and 715,827,882 faces are possible.");
    VcgLayer out;
    std::vector<Index> flat_vertex(mesh.vert.size(), -1);
    vcg_detail::copy_vertices(mesh, out, flat_vertex);
    vcg_detail::copy_faces(mesh, flat_vertex, out);
    vcg_detail::copy_attributes(mesh, request, out);
    return out;
}

template <class M>
void write(M& mesh, const VcgLayer& flat, const LayerChanges& changes) {
    using Scalar = typename M::ScalarType;
    vcg_detail::check_changes(mesh, flat, changes);
    // From here on nothing can fail.
    if (changes.positions)
        for (std::size_t i = 0; i < flat.host_vertex.size(); ++i)
            for (int k = 0; k < 3; ++k)
                mesh.vert[flat.host_vertex[i]].P()[k] = static_cast<Scalar>((*changes.positions)[i][k]);
    if (changes.quality) vcg_detail::write_quality(mesh, flat, *changes.quality);
    if (changes.attributes)
        for (const Attribute& a : *changes.attributes) vcg_detail::write_attribute(mesh, flat, a);
}

template <class M>
std::vector<std::string> build_derived(M& target, const M& source, const VcgLayer& flat, const DerivedMesh& derived) {
    vcg_detail::require(target.vert.empty() && target.face.empty(), "the mesh to be filled is not empty");
    vcg_detail::check_derived(flat.layer.mesh, derived);

    vcg_detail::enable_components(target, source);
    vcg_detail::build_vertices(target, source, flat, derived);
    vcg_detail::build_faces(target, source, flat, derived);
    vcg_detail::build_wedges(target, source, flat, derived);
    target.textures = source.textures;
    target.normalmaps = source.normalmaps;
    std::vector<std::string> left_out = vcg_detail::build_customs(target, source, flat, derived);

    const auto number = [&](auto type) {
        auto data = vcg::tri::Allocator<M>::template GetPerVertexAttribute<decltype(type)>(
            target, vcg_detail::source_vertex_name);
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
