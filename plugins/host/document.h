#pragma once

#include "host/api.h"
#include "host/kept_pyramid.h"

#include "vcg/conversion.h"

namespace multires::host {

/// The model's mesh as the filter wants it.
/// @throws InputError  for a broken mesh, see to_layer
VcgLayer read_layer(const plugin::Filter& filter, const MeshModel& model);
/// Another layer that the filter takes: the same attributes, and the source vertices of a level.
VcgLayer read_other_layer(const plugin::Filter& filter, const MeshModel& model);

/// A result, computed from `flat`, on its way into the document. Making one does all that can fail and changes nothing
/// a user could see; commit() then writes everything. One that goes without a commit takes back what it prepared.
///
/// A new layer becomes the current one; it takes over from the model's all that build_derived copies, the texture
/// images, the transformation and the camera. Selections, layers and what the result does not hold stay as they are.
class PendingResult {
public:
    /// @param flat  of `model`; must outlive this
    /// @param to_keep  with the model's mesh
    /// @throws InputError, std::invalid_argument, std::bad_alloc
    PendingResult(MeshDocument& document, MeshModel& model, const VcgLayer& flat, Result result, Kept to_keep);
    ~PendingResult();
    PendingResult(const PendingResult&) = delete;
    PendingResult& operator=(const PendingResult&) = delete;

    const Report& report() const;
    void commit() noexcept;

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace multires::host
