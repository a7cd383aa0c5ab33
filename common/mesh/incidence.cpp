#include "mesh/incidence.h"

namespace multires {

Incidence vertex_faces(const Faces& faces, Index vertices) {
    return {vertices, [&](const auto& put) {
                for (std::size_t f = 0; f < faces.size(); ++f)
                    for (const Index v : faces[f]) put(v, static_cast<Index>(f));
            }};
}

}  // namespace multires
