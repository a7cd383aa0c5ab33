#pragma once

#include "shared/table.h"

#if MULTIRES_MESHLAB_API == 2020
#include <common/interfaces.h>
#else
#include <common/plugins/interfaces/filter_plugin.h>
#endif

/// The one place that knows how the filter APIs of MeshLab 2020.09 and of 2022.02 and later differ in the calls that
/// both have; what only one of them has is in host_2020.* and host_2022.*. MULTIRES_MESHLAB_API is 2020 or 2022, see
/// cmake/FindMeshLab.cmake.
namespace multires::host {

#if MULTIRES_MESHLAB_API == 2020

using Interface = MeshFilterInterface;

inline void update_box_and_normals(MeshModel& model) { model.UpdateBoxAndNormals(); }
inline void delete_layer(MeshDocument& document, MeshModel& model) { document.delMesh(&model); }

template <class Visit>
void for_each_mesh(const MeshDocument& document, const Visit& visit) {
    for (const MeshModel* model : document.meshList) visit(*model);
}

/// 2020.09 knows textures by file name only, and those are part of the vcg mesh.
inline void copy_texture_images(MeshModel& /*to*/, const MeshModel& /*from*/) {}

/// A parameter of the host; `value` stands for its default, and its range or names where the type has them.
template <class Rich, class... Value>
Rich make_parameter(const QString& name, const plugin::Hint& hint, const Value&... value) {
    return Rich(name, value..., QString::fromStdString(hint.label), QString::fromStdString(hint.tooltip));
}

#else

using Interface = FilterPlugin;

inline void update_box_and_normals(MeshModel& model) { model.updateBoxAndNormals(); }
inline void delete_layer(MeshDocument& document, MeshModel& model) { document.delMesh(model.id()); }

template <class Visit>
void for_each_mesh(const MeshDocument& document, const Visit& visit) {
    for (const MeshModel& model : document.meshIterator()) visit(model);
}

inline void copy_texture_images(MeshModel& to, const MeshModel& from) {
    for (const auto& [name, image] : from.getTextures()) to.addTexture(name, image);
}

/// A parameter of the host; `value` stands for its default, and its range or names where the type has them.
template <class Rich, class... Value>
Rich make_parameter(const QString& name, const plugin::Hint& hint, const Value&... value) {
    return Rich(name, value..., QString::fromStdString(hint.label), QString::fromStdString(hint.tooltip), hint.advanced,
                QString::fromStdString(hint.group));
}

#endif

}  // namespace multires::host
