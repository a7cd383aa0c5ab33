#pragma once

#include "base/error.h"
#include "mesh/layer.h"
#include "vcg/custom.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <vector>

namespace multires {

/// Which attributes to_layer copies.
struct AttributeRequest {
    bool color = false, quality = false, texcoord = false;  ///< left out where the mesh does not have it
    std::vector<std::string> custom;                        ///< per vertex, by name; see custom_attribute_names
    bool wedges = false;                                    ///< texture coordinates of the faces' corners
};

/// Ascending indices. Takes memory only if one is left out.
class HostIndices {
public:
    explicit HostIndices(std::size_t count = 0) : count_(count) {}  ///< 0..count-1

    std::size_t size() const { return count_; }
    Index operator[](std::size_t i) const { return list_.empty() ? static_cast<Index>(i) : list_[i]; }
    void push_back(Index index) {
        if (list_.empty() && static_cast<std::size_t>(index) == count_) {
            ++count_;
            return;
        }
        if (list_.empty()) {
            list_.resize(count_);
            std::iota(list_.begin(), list_.end(), 0);
        }
        list_.push_back(index);
        ++count_;
    }

    /// Calls use(Index) for all of them.
    template <class Use>
    void each(const Use& use) const {
        for (std::size_t i = 0; i < count_; ++i) use((*this)[i]);
    }

private:
    std::size_t count_;
    std::vector<Index> list_;  ///< empty: i is at i
};

/// A layer, and where its elements live in the vcg mesh it came from. Good until that mesh is next changed.
struct VcgLayer {
    Layer layer;
    HostIndices host_vertex;  ///< #V, index into M::vert
    HostIndices host_face;    ///< #F, index into M::face
};

/// New values for a mesh; null parts stay as they are. All by vertex of the VcgLayer they were computed from.
struct LayerChanges {
    const Positions* positions = nullptr;                        ///< #V by 3, finite
    const std::vector<double>* quality = nullptr;                ///< #V, becomes the vertex quality
    const std::vector<Attribute>* attributes = nullptr;          ///< kinds and names as to_layer gave them
    const std::vector<Wedge>* wedges = nullptr;                  ///< 3 #F, with the indices of their textures
    const std::vector<std::uint8_t>* selected_vertex = nullptr;  ///< #V, 0 or 1
    const std::vector<std::uint8_t>* selected_edges = nullptr;   ///< #F, as in Layer
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

/// Makes the custom scalars and points among `attributes` that the mesh does not have, in its own scalar type.
/// @return  their names, for remove_custom_attributes(); if it throws, nothing was made
/// @throws InputError  if the mesh has one of another type by that name
template <class M>
std::vector<std::string> make_custom_attributes(M& mesh, const std::vector<Attribute>& attributes);

template <class M>
void remove_custom_attributes(M& mesh, const std::vector<std::string>& names) noexcept;

/// Checks that `changes` can be written to `mesh`: write() then cannot fail.
/// @throws InputError             for positions that are not finite in the mesh's precision
/// @throws std::invalid_argument  for wrong sizes, or attributes the mesh does not have
/// Cost: linear.
template <class M>
void check_changes(const M& mesh, const VcgLayer& flat, const LayerChanges& changes);

/// Writes `changes` into the mesh `flat` was made from: all of them, or nothing if it throws. Nothing else of the mesh
/// changes: bounding box and normals are the caller's to update. Colours are rounded to the nearest integer and
/// clamped to 0..255, here and nowhere else; texture coordinates of vertices keep their texture index.
/// @throws as check_changes
/// Cost: linear.
template <class M>
void write(M& mesh, const VcgLayer& flat, const LayerChanges& changes);

// ---------------------------------------------------------------------------------------------------------------------

namespace vcg_detail {

inline unsigned char to_byte(double value) {
    return static_cast<unsigned char>(std::lround(value > 0 ? std::min(value, 255.0) : 0.0));
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
    std::vector<std::uint8_t> selected, faux, selected_edges;
    for (auto* bits : {&selected, &faux, &selected_edges}) bits->reserve(mesh.fn);
    for (std::size_t i = 0; i < mesh.face.size(); ++i) {
        const auto& f = mesh.face[i];
        if (f.IsD()) continue;
        Face corners;
        int faux_bits = 0, edge_bits = 0;
        for (int k = 0; k < 3; ++k) {
            const Index at = array_index(mesh, f.cV(k));
            if (at < 0 || flat_vertex[at] < 0)
                throw InputError("Face " + std::to_string(i) + " refers to a vertex that " +
                                 (at < 0 ? "is not in the mesh." : "was deleted.") + " Nothing was changed.");
            corners[k] = flat_vertex[at];
            faux_bits |= f.IsF(k) ? 1 << k : 0;
            edge_bits |= f.IsFaceEdgeS(k) ? 1 << k : 0;
        }
        out.layer.mesh.faces.push_back(corners);
        out.host_face.push_back(static_cast<Index>(i));
        selected.push_back(f.IsS());
        faux.push_back(static_cast<std::uint8_t>(faux_bits));
        selected_edges.push_back(static_cast<std::uint8_t>(edge_bits));
    }
    const auto any = [](const std::vector<std::uint8_t>& bits) {
        return std::any_of(bits.begin(), bits.end(), [](std::uint8_t b) { return b != 0; });
    };
    if (any(selected)) out.layer.selected_face = std::move(selected);
    if (any(faux)) out.layer.faux_edges = std::move(faux);
    if (any(selected_edges)) out.layer.selected_edges = std::move(selected_edges);
}

/// An attribute with `value(vertex, k)` at the host's vertices.
template <class F>
Attribute gather(AttributeKind kind, std::string name, int width, const HostIndices& host_vertex, F value) {
    Attribute a{kind, std::move(name), width, {}};
    a.values.reserve(host_vertex.size() * width);
    host_vertex.each([&](Index i) {
        for (int k = 0; k < width; ++k) a.values.push_back(value(i, k));
    });
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

inline bool is_custom(const Attribute& a) { return a.kind == AttributeKind::scalar || a.kind == AttributeKind::point; }

/// How many numbers a vertex has in a custom attribute; 0 if that is of a type that is no use to a layer.
template <class M>
int custom_width(const vcg::PointerToAttribute& custom) {
    int found = 0;
    visit<typename M::VertContainer>(custom, LayerTypes(), [&](auto& data) { found = width<ValueOf<decltype(data)>>; });
    return found;
}

/// Throws unless the positions are finite in the precision they are to be written in.
template <class Scalar>
void require_finite_as(const Positions& positions) {
    for (const Vec3& p : positions)
        if (!p.template cast<Scalar>().allFinite())
            throw InputError("The result would have coordinates that are not finite: nothing was changed.");
}

/// Texture coordinates of all corners of the host's faces, 3 #F.
template <class M>
std::vector<Wedge> gather_wedges(const M& mesh, const HostIndices& host_face) {
    std::vector<Wedge> corners;
    corners.reserve(3 * host_face.size());
    host_face.each([&](Index f) {
        for (int k = 0; k < 3; ++k) {
            const auto t = mesh.face[f].cWT(k);
            corners.push_back({t.U(), t.V(), t.N()});
        }
    });
    return corners;
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
    require(custom && a.width == custom_width<M>(*custom), "no such custom attribute");
}

template <class M>
void write_wedges(M& mesh, const VcgLayer& flat, const std::vector<Wedge>& wedges) noexcept {
    const Wedge* w = wedges.data();
    flat.host_face.each([&](Index f) {
        for (int k = 0; k < 3; ++k, ++w) {
            auto& t = mesh.face[f].WT(k);
            t.U() = static_cast<std::decay_t<decltype(t.U())>>(w->u);
            t.V() = static_cast<std::decay_t<decltype(t.V())>>(w->v);
            t.N() = static_cast<std::decay_t<decltype(t.N())>>(w->texture);
        }
    });
}

template <class M>
void write_selections(M& mesh, const VcgLayer& flat, const LayerChanges& changes) noexcept {
    if (changes.selected_vertex)
        for (std::size_t i = 0; i < flat.host_vertex.size(); ++i) {
            auto& v = mesh.vert[flat.host_vertex[i]];
            (*changes.selected_vertex)[i] ? v.SetS() : v.ClearS();
        }
    if (changes.selected_edges)
        for (std::size_t i = 0; i < flat.host_face.size(); ++i)
            for (int k = 0; k < 3; ++k) {
                auto& f = mesh.face[flat.host_face[i]];
                (*changes.selected_edges)[i] >> k & 1 ? f.SetFaceEdgeS(k) : f.ClearFaceEdgeS(k);
            }
}

template <class M>
void write_quality(M& mesh, const VcgLayer& flat, const std::vector<double>& values) noexcept {
    using Quality = typename M::VertexType::QualityType;
    for (std::size_t i = 0; i < values.size(); ++i)
        mesh.vert[flat.host_vertex[i]].Q() = static_cast<Quality>(values[i]);
}

template <int n>
using Components = std::integral_constant<int, n>;

template <class M>
void write_attribute(M& mesh, const VcgLayer& flat, const Attribute& a) noexcept {
    const double* value = a.values.data();
    const auto each = [&](auto components, auto assign) {  // a.width is `components`, checked before
        flat.host_vertex.each([&](Index i) {
            for (int k = 0; k < components; ++k) assign(i, k, *value++);
        });
    };
    switch (a.kind) {
    case AttributeKind::quality:
        return write_quality(mesh, flat, a.values);
    case AttributeKind::color:
        return each(Components<4>(), [&](Index i, int k, double x) { mesh.vert[i].C()[k] = to_byte(x); });
    case AttributeKind::texcoord:
        return each(Components<2>(), [&](Index i, int k, double x) {
            auto& t = mesh.vert[i].T();
            (k == 0 ? t.U() : t.V()) = static_cast<std::decay_t<decltype(t.U())>>(x);
        });
    case AttributeKind::scalar:
    case AttributeKind::point:
        visit<typename M::VertContainer>(*find_custom(mesh, a.name), LayerTypes(), [&](auto& data) {
            constexpr int components = width<ValueOf<decltype(data)>>;
            each(Components<components>(), [&](Index i, int k, double x) { set_component(data[i], k, x); });
        });
    }
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
    if (request.wedges && vcg::tri::HasPerWedgeTexCoord(mesh))
        out.layer.wedges = vcg_detail::gather_wedges(mesh, out.host_face);
    return out;
}

template <class M>
std::vector<std::string> make_custom_attributes(M& mesh, const std::vector<Attribute>& attributes) {
    using Scalar = typename M::ScalarType;
    std::vector<std::string> names, made;
    for (const Attribute& a : attributes) {
        if (!vcg_detail::is_custom(a)) continue;
        const auto* custom = vcg_detail::find_custom(mesh, a.name);
        if (custom && vcg_detail::custom_width<M>(*custom) != a.width)
            throw InputError("The mesh has a custom attribute \"" + a.name + "\" of another type: choose another one.");
        if (!custom) names.push_back(a.name);
    }
    made.reserve(names.size());
    try {
        for (const Attribute& a : attributes) {
            if (!vcg_detail::is_custom(a) || vcg_detail::find_custom(mesh, a.name)) continue;
            if (a.kind == AttributeKind::scalar)
                vcg::tri::Allocator<M>::template AddPerVertexAttribute<Scalar>(mesh, a.name);
            else
                vcg::tri::Allocator<M>::template AddPerVertexAttribute<vcg::Point3<Scalar>>(mesh, a.name);
            made.push_back(std::move(names[made.size()]));  // needs no memory
        }
    } catch (...) {
        remove_custom_attributes(mesh, made);
        throw;
    }
    return made;
}

template <class M>
void remove_custom_attributes(M& mesh, const std::vector<std::string>& names) noexcept {
    for (const std::string& name : names)  // not by vcg's own function, which allocates
        for (auto at = mesh.vert_attr.begin(); at != mesh.vert_attr.end(); ++at)
            if (at->_name == name) {
                delete static_cast<vcg::SimpleTempDataBase*>(at->_handle);
                mesh.vert_attr.erase(at);
                break;
            }
}

template <class M>
void check_changes(const M& mesh, const VcgLayer& flat, const LayerChanges& changes) {
    using vcg_detail::require;
    const std::size_t n = flat.host_vertex.size();
    flat.host_vertex.each([&](Index i) {
        require(i >= 0 && static_cast<std::size_t>(i) < mesh.vert.size(), "the mesh changed since it was read");
    });
    flat.host_face.each([&](Index i) {
        require(i >= 0 && static_cast<std::size_t>(i) < mesh.face.size(), "the mesh changed since it was read");
    });
    if (changes.positions) {
        require(changes.positions->size() == n, "positions of wrong size");
        vcg_detail::require_finite_as<typename M::ScalarType>(*changes.positions);
    }
    if (changes.quality)
        require(changes.quality->size() == n && vcg::tri::HasPerVertexQuality(mesh), "quality of wrong size");
    if (changes.attributes)
        for (const Attribute& a : *changes.attributes) vcg_detail::check_attribute(mesh, flat, a);
    if (changes.wedges)
        require(changes.wedges->size() == 3 * flat.host_face.size() && vcg::tri::HasPerWedgeTexCoord(mesh),
                "wedge texture coordinates of wrong size");
    require(!changes.selected_vertex || changes.selected_vertex->size() == n, "vertex selection of wrong size");
    require(!changes.selected_edges || changes.selected_edges->size() == flat.host_face.size(),
            "edge selection of wrong size");
}

template <class M>
void write(M& mesh, const VcgLayer& flat, const LayerChanges& changes) {
    using Scalar = typename M::ScalarType;
    check_changes(mesh, flat, changes);
    // From here on nothing can fail.
    if (changes.positions)
        for (std::size_t i = 0; i < flat.host_vertex.size(); ++i)
            for (int k = 0; k < 3; ++k)
                mesh.vert[flat.host_vertex[i]].P()[k] = static_cast<Scalar>((*changes.positions)[i][k]);
    if (changes.quality) vcg_detail::write_quality(mesh, flat, *changes.quality);
    if (changes.attributes)
        for (const Attribute& a : *changes.attributes) vcg_detail::write_attribute(mesh, flat, a);
    if (changes.wedges) vcg_detail::write_wedges(mesh, flat, *changes.wedges);
    vcg_detail::write_selections(mesh, flat, changes);
}

}  // namespace multires
