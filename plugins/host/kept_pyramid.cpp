#include "host/kept_pyramid.h"

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

Kept& slot(CMeshO& mesh) {
    if (PyramidSlot* slot = find_slot(mesh)) return slot->kept;
    using Allocator = vcg::tri::Allocator<CMeshO>;
    Allocator::DeletePerMeshAttribute(mesh, attribute_name);  // of the wrong type: see the header
    return Allocator::AddPerMeshAttribute<PyramidSlot>(mesh, attribute_name)().kept;
}

}  // namespace multires::host
