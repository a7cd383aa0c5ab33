#include "filters/original.h"

#include <algorithm>

namespace multires {

Original::Original(const Mesh& mesh)
    : positions_(std::make_shared<const Positions>(mesh.positions)), shapes_{shape_hash(mesh.positions, mesh.faces)} {}

bool Original::includes(const Mesh& mesh) const {
    return std::find(shapes_.begin(), shapes_.end(), shape_hash(mesh.positions, mesh.faces)) != shapes_.end();
}

void Original::note(const Positions& result, const Faces& faces) {
    const ContentHash hash = shape_hash(result, faces);
    if (std::find(shapes_.begin(), shapes_.end(), hash) == shapes_.end()) shapes_.push_back(hash);
}

std::shared_ptr<const Original> original_after(const Original* kept, const Mesh& before, const Positions& after) {
    auto next = kept && kept->includes(before) ? std::make_shared<Original>(*kept) : std::make_shared<Original>(before);
    next->note(after, before.faces);
    return next;
}

Start::Start(const Layer& layer, RelativeTo relative_to, const Session& session, Report& report) : given_(layer) {
    if (relative_to == RelativeTo::current) return;
    if (!session.original) {
        report.say("No filter of this suite has moved this mesh yet: it is its own original.");
        return;
    }
    require(session.original->includes(layer.mesh),
            "relative_to: something else has changed this mesh since its original was kept, and going back would undo "
            "that too. Choose the current shape, which then becomes the new original.");
    copy_ = layer;
    copy_->mesh.positions = session.original->positions();
}

}  // namespace multires
