#include "denoise/varying_noise.h"

#include "base/parallel.h"
#include "denoise/along_normals.h"
#include "denoise/local_noise.h"
#include "measure/vertex_normals.h"

namespace multires {

std::vector<double> varying_noise(const Faces& faces, const Positions& positions, const Incidence& at,
                                  const Neighbours& near) {
    constexpr int normal_steps = 8;
    constexpr double least_variation = 0.22;  // the same noise everywhere has at most 0.17
    const Positions smooth = taubin(near, positions, normal_steps);
    const AlongNormals surface(near, positions, vertex_normals(faces, smooth),
                               cotangent_weights(faces, at, near, smooth));
    std::vector<double> h(3 * positions.size(), 0);
    parallel_for(near.rows(), [&](Index v) {
        for (int c = 1; c < 3; ++c) h[3 * static_cast<std::size_t>(v) + c] = gaussian(v, 500 + c);
    });
    const std::vector<double> first = surface.detail(h);
    const NoiseByDifferences noise(near, first, surface.linear_detail(surface.linear_detail(first)));
    return noise.varying(positions, 0, least_variation);
}

}  // namespace multires
