#include "filters/filter.h"

#include "mesh/validation.h"

namespace multires {

std::shared_ptr<const Pyramid> pyramid_of(const Layer& layer, const PyramidOptions& options, PyramidCache& pyramids,
                                          const Progress& progress, Report& report,
                                          const std::function<void()>& layer_read) {
    require_usable(layer.mesh);
    check(options);
    std::shared_ptr<const Pyramid> pyramid = pyramids.find(content_hash(layer, options));
    report.add("pyramid_reused", pyramid != nullptr);
    if (!pyramid) {
        pyramids.make_room(shape_hash(layer.mesh.positions, layer.mesh.faces));
        pyramid = std::make_shared<const Pyramid>(layer, options, progress.part(0, 0.9), layer_read);
        pyramids.put(pyramid);
    }
    report.add("locked_vertices", static_cast<int>(pyramid->hierarchy().irregular));
    report.add("unreferenced_vertices", static_cast<int>(pyramid->hierarchy().isolated));
    return pyramid;
}

std::shared_ptr<const Pyramid> pyramid_of(const Layer& layer, const PyramidOptions& options, Session& session,
                                          Report& report) {
    return pyramid_of(layer, options, session.pyramids, session.progress, report);
}

}  // namespace multires
