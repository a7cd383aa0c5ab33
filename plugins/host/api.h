#pragma once

#include "shared/table.h"

#if MULTIRES_MESHLAB_API == 2020
#include <common/interfaces.h>
#else
#include <common/plugins/interfaces/filter_plugin.h>
#endif

#include <algorithm>
#include <string>

/// The one place that knows how the filter APIs of MeshLab 2020.09 and of 2022.02 and later differ in the calls that
/// both have; what only one of them has is in host_2020.* and host_2022.*. MULTIRES_MESHLAB_API is 2020 or 2022, see
/// cmake/FindMeshLab.cmake.
namespace multires::host {

#if MULTIRES_MESHLAB_API == 2020

using Interface = MeshFilterInterface;
using RichPoint = RichPoint3f;
using RichVector = RichPoint3f;  ///< a direction

inline void update_box_and_normals(MeshModel& model) { model.UpdateBoxAndNormals(); }
inline void delete_layer(MeshDocument& document, MeshModel& model) { document.delMesh(&model); }
inline void enable_for_file(MeshModel& model, int mask) { model.Enable(mask); }

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

/// The host's own layer parameter, which is written to scripts as a position in the list of layers.
/// @param model  may be null in an empty document
inline RichMesh make_layer_parameter(const QString& name, const plugin::Hint& hint, const MeshModel* model,
                                     const MeshDocument& document) {
    return make_parameter<RichMesh>(name, hint, const_cast<MeshModel*>(model),
                                    model ? const_cast<MeshDocument*>(&document) : nullptr);
}

/// The layer that the parameter names; null if there is none (or no longer).
inline const MeshModel* find_layer(const RichParameterList& list, const QString& name, const MeshDocument& document) {
    const MeshModel* model = list.getMesh(name);
    return std::find(document.meshList.begin(), document.meshList.end(), model) == document.meshList.end() ? nullptr
                                                                                                           : model;
}

/// What the caller wrote to name a layer.
inline std::string layer_text(const RichParameterList& list, const QString& name) {
    return std::to_string(static_cast<const RichMesh&>(list.getParameterByName(name)).meshindex);
}

inline Point3m read_point(const RichParameterList& list, const QString& name) { return list.getPoint3m(name); }

#else

using Interface = FilterPlugin;
using RichPoint = RichPosition;
using RichVector = RichDirection;  ///< a direction

inline void update_box_and_normals(MeshModel& model) { model.updateBoxAndNormals(); }
inline void delete_layer(MeshDocument& document, MeshModel& model) { document.delMesh(model.id()); }
inline void enable_for_file(MeshModel& model, int mask) { model.enable(mask); }

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

/// The host's own layer parameter, by the layer's id.
/// @param model  may be null in an empty document
inline RichMesh make_layer_parameter(const QString& name, const plugin::Hint& hint, const MeshModel* model,
                                     const MeshDocument& document) {
    const MeshDocument* const where = &document;
    return make_parameter<RichMesh>(name, hint, static_cast<unsigned>(model ? model->id() : 0), where);
}

/// The layer that the parameter names; null if there is none (or no longer).
inline const MeshModel* find_layer(const RichParameterList& list, const QString& name, const MeshDocument& document) {
    return document.getMesh(list.getMeshId(name));
}

/// What the caller wrote to name a layer.
inline std::string layer_text(const RichParameterList& list, const QString& name) {
    return std::to_string(static_cast<int>(list.getMeshId(name)));
}

inline Point3m read_point(const RichParameterList& list, const QString& name) { return list.getPoint3m(name); }

#endif

/// True if the value is known to be just the declared default, and not one that the caller gave. Known since 2025.07:
/// pymeshlab marks what was passed; dialogs and scripts give every value that they show. Call it with 0.
template <class Rich>
auto is_default(const Rich& parameter, int /*preferred*/) -> decltype(parameter.isValueDefault()) {
    return parameter.isValueDefault();
}
template <class Rich>
bool is_default(const Rich& /*parameter*/, long /*otherwise*/) {
    return false;
}

}  // namespace multires::host
