#include "denoise/smooth_regions.h"

#include "base/parallel.h"
#include "denoise_fixtures.h"

namespace multires {

using namespace fixtures;

// Seeds that grow at the same time must not know of each other, and those that grew ahead of a region not be used.
TEST(SmoothRegions, AreTheSameForAnyNumberOfThreads) {
    // Planes that meet at creases, where regions want the same faces, beside a part that is flattest, so
    // that it is asked first, and has more noise than is said.
    Mesh truth = shapes::plane(60);
    const double edge = mean_edge_length(truth.faces, truth.positions), noise = 0.1 * edge;
    for (Vec3& p : truth.positions) p.z() = 0.4 * std::abs(p.x() - std::round(3 * p.x()) / 3);
    const Incidence at = vertex_faces(truth.faces, static_cast<Index>(truth.positions.size()));
    Positions given = truth.positions, positions = truth.positions;
    shapes::Random random(5);
    for (std::size_t v = 0; v < given.size(); ++v) {
        const bool vain = truth.positions[v].y() > 0.7;
        given[v].z() += (vain ? 10 : 1) * noise * gaussian(random);
        if (!vain) positions[v].z() += 0.1 * noise * gaussian(random);
    }
    const PlaceErrors errors = PlaceErrors::of_noise(std::vector<double>(given.size(), noise));
    const std::vector<std::uint8_t> asked(truth.faces.size(), 1);
    std::vector<Index> first;
    for (const int threads : {1, 2, 3}) {
        const Threads scope(threads);
        const SmoothRegions regions = smooth_regions(truth.faces, at, asked, given, errors, positions);
        EXPECT_GE(regions.patch.size(), 4U);
        if (threads == 1) first = regions.of_face;
        EXPECT_EQ(regions.of_face, first);
    }
}

// A region whose patch is certain only at the size up to which that is waited for must go on growing.
TEST(SmoothRegions, GrowOnWhereTheyBecomeCertainLate) {
    const Mesh truth = shapes::plane(60);
    const double edge = mean_edge_length(truth.faces, truth.positions), noise = 0.2 * edge;
    const Incidence at = vertex_faces(truth.faces, static_cast<Index>(truth.positions.size()));
    Positions given = truth.positions, positions = truth.positions;
    shapes::Random random(5);
    for (std::size_t v = 0; v < given.size(); ++v) {
        given[v].z() += noise * gaussian(random);
        positions[v].z() += 0.04 * noise * gaussian(random);
    }
    const PlaceErrors errors = PlaceErrors::of_noise(std::vector<double>(given.size(), noise));
    const std::vector<std::uint8_t> asked(truth.faces.size(), 1);
    const SmoothRegions regions = smooth_regions(truth.faces, at, asked, given, errors, positions);
    EXPECT_EQ(regions.patch.size(), 1U);
    EXPECT_EQ(std::count(regions.of_face.begin(), regions.of_face.end(), 0), static_cast<int>(truth.faces.size()));
}

}  // namespace multires
