#include "host/kept_pyramid.h"

#include <algorithm>
#include <utility>

namespace multires::host {

/// What the attribute holds. A type of its own, and a named one: typeid tells it from anything else of that name and
/// size, also across plugins.
struct PyramidSlot {
    Kept kept;
};

namespace {

// Change the number with the layout of KeptPyramid, Original or anything they hold: plugins of different builds may
// meet.
constexpr const char* attribute_name = "multires_pyramid_2";

PyramidSlot* find_slot(const CMeshO& mesh) {
    for (const vcg::PointerToAttribute& a : mesh.mesh_attr)
        if (a._name == attribute_name && a._type == typeid(PyramidSlot))
            return static_cast<PyramidSlot*>(a._handle->DataBegin());
    return nullptr;
}

}  // namespace

Kept kept(const CMeshO& mesh) {
    const PyramidSlot* slot = find_slot(mesh);
    return slot ? slot->kept : Kept();
}

Keeper::Keeper(CMeshO& mesh) : mesh_(mesh) {
    if (PyramidSlot* slot = find_slot(mesh)) {
        slot_ = &slot->kept;
        return;
    }
    vcg::PointerToAttribute name;
    name._name = attribute_name;
    other_ = mesh.mesh_attr.extract(name);
    try {
        slot_ = &vcg::tri::Allocator<CMeshO>::AddPerMeshAttribute<PyramidSlot>(mesh, attribute_name)().kept;
        made_ = true;
    } catch (...) {
        if (other_) mesh.mesh_attr.insert(std::move(other_));
        throw;
    }
}

Keeper::~Keeper() {
    if (made_) {
        const auto at = std::find_if(mesh_.mesh_attr.begin(), mesh_.mesh_attr.end(),
                                     [](const auto& a) { return a._name == attribute_name; });
        delete at->_handle;
        mesh_.mesh_attr.erase(at);
    }
    if (other_) mesh_.mesh_attr.insert(std::move(other_));
}

void Keeper::keep(Kept what) noexcept {
    *slot_ = std::move(what);
    made_ = false;
    if (!other_) return;
    delete other_.value()._handle;
    other_ = {};
}

}  // namespace multires::host
