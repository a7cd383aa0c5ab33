#include "measure/vertex_normals.h"

#include "base/parallel.h"

namespace multires {

Array<Vec3> vertex_area_vectors(const Faces& faces, const Positions& positions) {
    Array<Vec3> sum(positions.size(), Vec3::Zero());
    for (const Face& f : faces) {
        const Vec3 n = area_vector(f, positions);
        for (const Index v : f) sum[v] += n;
    }
    return sum;
}

Array<Vec3> vertex_normals(const Faces& faces, const Positions& positions) {
    Array<Vec3> normal = vertex_area_vectors(faces, positions);
    parallel_for(static_cast<Index>(normal.size()), [&](Index v) {
        const double length = normal[v].norm();
        if (length > 0) normal[v] /= length;
    });
    return normal;
}

}  // namespace multires
