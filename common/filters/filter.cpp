#include "filters/filter.h"

#include "mesh/validation.h"

namespace multires {

std::shared_ptr<const Pyramid> pyramid_of(const Layer& layer, const PyramidOptions& options, Session& session,
                                          Report& report) {
    require_usable(layer.mesh);
    check(options);
    const bool reused = session.pyramid && session.pyramid->hash() == content_hash(layer, options);
    if (!reused) session.pyramid = std::make_shared<const Pyramid>(layer, options, session.progress.part(0, 0.9));
    report.add("pyramid_reused", reused);
    report.add("locked_vertices", static_cast<int>(session.pyramid->hierarchy().irregular));
    report.add("unreferenced_vertices", static_cast<int>(session.pyramid->hierarchy().isolated));
    return session.pyramid;
}

}  // namespace multires
