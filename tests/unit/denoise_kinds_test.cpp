#include "denoise/kinds.h"
#include "filters/shape/denoise.h"
#include "mesh/adjacency.h"

#include "denoise_fixtures.h"

namespace multires {

using namespace fixtures;

namespace {

/// Two bodies of the same edge length; the second's vertices come last.
Mesh side_by_side(const Mesh& first, Mesh second) {
    const auto edge = [](const Mesh& mesh) { return mean_edge_length(mesh.faces, mesh.positions); };
    const double scale = edge(first) / edge(second);
    for (Vec3& p : second.positions) p *= scale;
    return shapes::join(first, second, Vec3(10, 0, 0));
}

/// The bodies of such a mesh by themselves.
struct Bodies {
    Mesh first, second;

    Bodies(const Mesh& both, const Positions& p, Index shift) {
        first.positions.assign(p.begin(), p.begin() + shift);
        second.positions.assign(p.begin() + shift, p.end());
        for (const Face& f : both.faces)
            if (f[0] < shift)
                first.faces.push_back(f);
            else
                second.faces.push_back({f[0] - shift, f[1] - shift, f[2] - shift});
    }
};

/// In the mean of several noises: which patches of one are believed is chance.
void expect_each_as_good_as_alone(const Mesh& machined, const Mesh& organic, double deviation, std::uint64_t seeds) {
    const Mesh truth = side_by_side(machined, organic);
    const Index shift = static_cast<Index>(machined.positions.size());
    const Bodies clean(truth, truth.positions, shift);
    struct Sum {
        Error noise{}, alone{}, beside{};
    } first, second;
    const auto add = [](Error& sum, const Mesh& is, const Positions& p) {
        const Error error = error_of(is, p);
        sum.angle += error.angle;
        sum.rms += error.rms;
    };
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        Mesh mesh = truth;
        mesh.positions = with_noise(truth, deviation, NoiseKind::along_normals, seed);
        const Bodies noisy(truth, mesh.positions, shift), together(truth, denoised(mesh), shift);
        const auto add_body = [&](Sum& sum, Mesh Bodies::*body) {
            add(sum.noise, clean.*body, (noisy.*body).positions);
            add(sum.alone, clean.*body, denoised(noisy.*body));
            add(sum.beside, clean.*body, (together.*body).positions);
        };
        add_body(first, &Bodies::first);
        add_body(second, &Bodies::second);
    }
    for (const Sum& sum : {first, second}) {
        // Planes are left with hardly any.
        EXPECT_LT(sum.beside.angle, 1.1 * sum.alone.angle + 0.002 * sum.noise.angle);
        EXPECT_LT(sum.beside.rms, 1.1 * sum.alone.rms);
    }
}

}  // namespace

TEST(KindsOfSurface, AreDenoisedAsGoodAsAlone) {
    for (const double deviation : {0.05, 0.1})
        expect_each_as_good_as_alone(shapes::block(17), shapes::scan(3000), deviation, 3);
}

TEST(KindsOfSurface, AreDenoisedAsGoodAsAloneOnLargeMeshes) {
    expect_each_as_good_as_alone(shapes::block(45), shapes::scan(30000), 0.1, 1);
}

TEST(KindsOfSurface, GiveTheSameBitsWithAnyNumberOfThreads) {
    Mesh mesh = side_by_side(shapes::block(45), shapes::scan(20000));
    mesh.positions = with_noise(mesh, 0.1);
    Positions first;
    for (const int threads : {1, 3}) {
        const Threads scope(threads);
        const Positions p = denoised(mesh);
        if (threads == 1)
            first = p;
        else
            EXPECT_EQ(p, first);
    }
}

TEST(KindsOfSurface, PassIntoEachOtherWithoutASeam) {
    const Mesh mesh = shapes::irregular_sphere(12000);
    const Neighbours near = neighbours(mesh.faces, vertex_faces(mesh.faces, static_cast<Index>(mesh.positions.size())));
    std::vector<double> difference, none;
    for (Index v = 0; v < near.rows(); ++v) {
        none.push_back(0.5 * gaussian(v, 91));
        difference.push_back(none.back() + (mesh.positions[v].x() < 0 ? -0.2 : 0.2));
    }
    const std::vector<double> share = shares_of_first(near, difference), even = shares_of_first(near, none);
    double steepest = 0, certain = 0;
    for (Index v = 0; v < near.rows(); ++v) {
        const double x = mesh.positions[v].x();
        if (std::abs(x) > 0.3) {
            EXPECT_EQ(share[v], x < 0 ? 1 : 0);
        }
        for (Index k = near.offset[v]; k < near.offset[v + 1]; ++k)
            steepest = std::max(steepest, std::abs(share[v] - share[near.vertex[k]]));
        certain += even[v] == 0 || even[v] == 1;
    }
    EXPECT_LT(steepest, 0.25);
    EXPECT_LT(certain, 0.05 * near.rows());
    const std::vector<std::uint8_t> core(share.size(), 1);
    for (double& d : difference) d -= 0.03;
    EXPECT_TRUE(certainly_less(difference, core));
    EXPECT_FALSE(certainly_less(none, core));
}

}  // namespace multires
