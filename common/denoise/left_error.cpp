#include "denoise/left_error.h"

#include "base/reduce.h"
#include "measure/vertex_normals.h"

#include <algorithm>
#include <bitset>

namespace multires {

double moved_within(const Faces& faces, const Positions& from, const Positions& to) {
    const Array<Vec3> normal = vertex_normals(faces, to);
    return chunked_fold<Mean>(from.size(),
                              [&](Mean& part, std::size_t v) {
                                  const Vec3 move = to[v] - from[v];
                                  part.add((move - normal[v].dot(move) * normal[v]).squaredNorm());
                              })
        .value();
}

double error_after_patches(double error, double variance, const Faces& faces, const SmoothRegions& regions,
                           const Positions& before, const Positions& after) {
    if (regions.patch.empty()) return error;
    std::vector<std::uint8_t> outside(after.size(), 1);
    for (std::size_t f = 0; f < faces.size(); ++f)
        if (regions.of_face[f] >= 0)
            for (const Index v : faces[f]) outside[v] = 0;
    double terms = 0;
    for (const Patch& patch : regions.patch) terms += patch.terms();
    const Array<Vec3> normal = vertex_normals(faces, after);
    const auto moved = chunked_fold<Mean>(after.size(), [&](Mean& part, std::size_t v) {
        const double height = outside[v] != 0 ? 0 : normal[v].dot(after[v] - before[v]);
        part.add(height * height);
    });
    const double count = static_cast<double>(after.size());
    const double share = static_cast<double>(std::count(outside.begin(), outside.end(), 1)) / count;
    return std::max(error - moved.value(), share * error) + terms * variance / count;
}

double mean_held(const EvenPlaces& even) {
    double held = 0;
    for (const std::uint8_t axes : even.axes) held += static_cast<double>(std::bitset<3>(axes).count());
    return even.axes.empty() ? 0 : held / static_cast<double>(even.axes.size());
}

}  // namespace multires
