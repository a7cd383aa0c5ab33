#include "measure/vertex_normals.h"

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
    for (Vec3& n : normal) {
        const double length = n.norm();
        if (length > 0) n /= length;
    }
    return normal;
}

}  // namespace multires
