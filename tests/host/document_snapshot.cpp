#include "document_snapshot.h"

#include "host/kept_pyramid.h"
#include "vcg/custom.h"

#include <cstring>

namespace multires::host_tests {
namespace {

class Bytes {
public:
    template <class T>
    void value(const T& v) {
        static_assert(std::is_trivially_copyable_v<T>);
        text_.append(reinterpret_cast<const char*>(&v), sizeof v);
    }
    template <class T>
    void point(const T& p) {
        for (int k = 0; k < 3; ++k) value(p[k]);
    }
    void text(const std::string& s) {
        value(s.size());
        text_ += s;
    }
    std::string take() { return std::move(text_); }

private:
    std::string text_;
};

void vertices(const CMeshO& m, Bytes& out) {
    const auto& all = m.vert;
    out.value(all.size());
    for (const bool on : {all.IsTexCoordEnabled(), all.IsCurvatureDirEnabled(), all.IsRadiusEnabled(),
                          all.IsMarkEnabled(), all.IsVFAdjacencyEnabled()})
        out.value(on);
    for (const auto& v : all) {
        out.point(v.cP()), out.point(v.cN()), out.value(v.cFlags()), out.value(v.cQ());
        for (int k = 0; k < 4; ++k) out.value(v.cC()[k]);
        if (all.IsTexCoordEnabled()) out.value(v.cT().U()), out.value(v.cT().V()), out.value(v.cT().N());
        if (all.IsRadiusEnabled()) out.value(v.cR());
        if (all.IsCurvatureDirEnabled()) out.point(v.cPD1()), out.point(v.cPD2()), out.value(v.cK1());
    }
}

void faces(const CMeshO& m, Bytes& out) {
    const auto& all = m.face;
    out.value(all.size());
    for (const bool on :
         {all.IsColorEnabled(), all.IsQualityEnabled(), all.IsWedgeTexCoordEnabled(), all.IsCurvatureDirEnabled(),
          all.IsFFAdjacencyEnabled(), all.IsVFAdjacencyEnabled(), all.IsMarkEnabled()})
        out.value(on);
    for (const auto& f : all) {
        for (int k = 0; k < 3; ++k) out.value(f.cV(k) - m.vert.data());
        out.point(f.cN()), out.value(f.cFlags());
        if (all.IsQualityEnabled()) out.value(f.cQ());
        for (int k = 0; all.IsColorEnabled() && k < 4; ++k) out.value(f.cC()[k]);
        for (int k = 0; all.IsWedgeTexCoordEnabled() && k < 3; ++k)
            out.value(f.cWT(k).U()), out.value(f.cWT(k).V()), out.value(f.cWT(k).N());
    }
}

template <class Container>
void attributes(const std::set<vcg::PointerToAttribute>& set, std::size_t elements, Bytes& out) {
    for (const vcg::PointerToAttribute& a : set) {
        out.text(a._name), out.text(a._type.name());
        vcg_detail::visit<Container>(a, vcg_detail::LayerTypes(), [&](auto& data) {
            for (std::size_t i = 0; i < elements; ++i)
                for (int k = 0; k < vcg_detail::width<vcg_detail::ValueOf<decltype(data)>>; ++k)
                    out.value(vcg_detail::component(data[i], k));
        });
    }
}

void mesh(const CMeshO& m, Snapshot& s, Bytes& out) {
    for (const int number : {m.vn, m.fn, m.en, m.sfn, m.svn}) out.value(number);
    vertices(m, out);
    faces(m, out);
    attributes<CMeshO::VertContainer>(m.vert_attr, m.vert.size(), out);
    attributes<CMeshO::FaceContainer>(m.face_attr, m.face.size(), out);
    for (const std::string& name : m.textures) out.text(name);
    for (int i = 0; i < 16; ++i) out.value(m.Tr.V()[i]);
    out.point(m.bbox.min), out.point(m.bbox.max);
    for (int i = 0; i < 16; ++i) out.value(m.shot.Extrinsics.Rot().V()[i]);
    out.value(m.shot.Intrinsics.FocalMm);
    s.storage.push_back(m.vert.data()), s.storage.push_back(m.face.data());
    for (const vcg::PointerToAttribute& a : m.mesh_attr) s.storage.push_back(a._handle);
    const host::Kept kept = host::kept(m);
    s.storage.push_back(kept.original.get());
    s.cached.push_back(kept.spline.get());
    for (const auto& pyramid : kept.pyramids.all()) s.cached.push_back(pyramid.get());
    for (const auto& other : kept.intermediates.all()) s.cached.push_back(other.get());
    s.caches.push_back(kept.spline || !kept.pyramids.all().empty() || !kept.intermediates.all().empty());
}

}  // namespace

Snapshot snapshot(const MeshDocument& document) {
    Snapshot s;
    Bytes out;
    for (const MeshModel& model : document.meshIterator()) {
        s.ids.push_back(model.id());
        out.value(document.mm() == &model), out.value(model.dataMask()), out.value(model.isVisible());
        out.text(model.label().toStdString());
        mesh(model.cm, s, out);
    }
    s.document = out.take();
    return s;
}

}  // namespace multires::host_tests
