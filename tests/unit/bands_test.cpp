#include "filters/editing/bands.h"

#include "base/reduce.h"
#include "filter_fixtures.h"
#include "filters/editing/smooth_base.h"
#include "filters/editing/transfer_edit.h"
#include "measure/distance.h"
#include "measure/measure.h"

#include <functional>

// Multiband Edit, and the multi-band encoding of Follow Edited Layer.

namespace multires {
namespace {

using fixtures::largest_distance;
using fixtures::layer_of;
using fixtures::series;

Result split(const Layer& layer, const BandsOptions& options) {
    Session session;
    return apply_bands(layer, options, session);
}

/// A square of side 2 with a mushroom in its middle: a ball on a neck that is thinner, so that no normal of the square
/// reaches all of it from outside.
Mesh mushroom(int cells) {
    Mesh mesh = shapes::plane(cells, {0, 0, 1});
    for (Vec3& p : mesh.positions) {
        const Vec3 q = 2 * (p - Vec3(0.5, 0.5, 0));
        const double r = q.norm(), reach = 0.6, ball = 0.22, top = 0.42;
        const Vec3 out = r > 0 ? Vec3(q / r) : Vec3::Zero();
        p = q;
        if (r >= reach) continue;
        const double s = r / reach;  // 0 at the top of the ball
        const double turn = 2.6;     // radians of the ball, to the neck
        const double neck_r = ball * std::sin(turn), neck_z = top + ball * std::cos(turn);
        if (s < 0.6) {
            p = ball * std::sin(turn * s / 0.6) * out + Vec3(0, 0, top + ball * std::cos(turn * s / 0.6));
        } else {
            const double t = (s - 0.6) / 0.4;
            p = (neck_r + t * t * (reach - neck_r)) * out + Vec3(0, 0, neck_z * (1 - t) * (1 - t));
        }
    }
    return mesh;
}

/// A dune beside the mushroom, under the rim of its ball.
Positions with_dune(Positions shape, double at) {
    for (Vec3& p : shape) p.z() += 0.05 * std::exp(-(p - Vec3(at, 0, 0)).squaredNorm() / (0.15 * 0.15));
    return shape;
}

/// Root mean square of the relative changes of length of the edges of the ball.
double stretch_of_ball(const Mesh& mushroom, const Positions& after) {
    Mean mean;
    for (const Face& f : mushroom.faces)
        for (int k = 0; k < 3; ++k) {
            const Index a = f[k], b = f[(k + 1) % 3];
            const double length = (mushroom.positions[a] - mushroom.positions[b]).norm();
            if (mushroom.positions[a].z() > 0.35) mean.add(std::pow((after[a] - after[b]).norm() / length - 1, 2));
        }
    return std::sqrt(mean.value());
}

}  // namespace

TEST(Bands, PutBackTogetherGiveTheMeshOnEveryClassOfMesh) {
    for (const auto& [name, mesh] : fixtures::every_class()) {
        SCOPED_TRACE(name);
        const double size = bounding_box(mesh.positions).diagonal();
        Session session;
        Report report;
        const Layer layer = layer_of(mesh);
        const auto pyramid = pyramid_of(layer, {}, session, report);
        const Index coarsest = std::max<Index>(pyramid->hierarchy().size.back(), 1);
        const auto kept = kept_by_bases(*pyramid, BandLevels::ratio, 3, coarsest);
        const Multiband bands = multiband_of(mesh, *pyramid, kept, nullptr, {});
        EXPECT_LT(largest_distance(bands.reconstruct(mesh.faces, bands.coarsest(), {1, 1, 1}), mesh.positions),
                  1e-12 * size);
        BandsOptions options;
        options.vertices = 1;
        EXPECT_EQ(*split(layer, options).positions, mesh.positions);
    }
}

TEST(Bands, KeepFewerAndFewerVertices) {
    const Layer layer = layer_of(shapes::scan(8000, {0.2, 0.3, 5}));
    const auto all = static_cast<Index>(layer.mesh.positions.size());
    Session session;
    Report report;
    const auto pyramid = pyramid_of(layer, {}, session, report);
    for (const auto levels : {BandLevels::ratio, BandLevels::edge_length, BandLevels::equal_detail})
        for (const int count : {1, 2, 4, 7}) {
            const auto kept = kept_by_bases(*pyramid, levels, count, 300);
            ASSERT_EQ(kept.size(), static_cast<std::size_t>(count));
            EXPECT_EQ(kept.back(), 300);
            for (int k = 0; k + 1 < count; ++k) {
                EXPECT_GT(kept[k], kept[k + 1]);
                EXPECT_LT(kept[k], all);
                if (levels == BandLevels::ratio) {
                    EXPECT_NEAR(kept[k], all * std::pow(300.0 / all, (k + 1.0) / count), 2);
                }
            }
        }
    // By the mean edge lengths of the meshes that are left.
    const Hierarchy& h = pyramid->hierarchy();
    const auto kept = kept_by_bases(*pyramid, BandLevels::edge_length, 4, 300);
    const auto edge = [&](Index k) {
        return mean_edge_length(prefix_mesh(h, layer.mesh.faces, k).faces, [&] {
            Positions p;
            for (Index i = 0; i < k; ++i) p.push_back(layer.mesh.positions[h.order[i]]);
            return p;
        }());
    };
    for (int k = 0; k + 1 < 4; ++k) EXPECT_NEAR(edge(kept[k + 1]) / edge(kept[k]), edge(kept[0]) / edge(all), 0.15);
}

TEST(Bands, OfEqualDetailAreMoreEqualThanThoseOfARatio) {
    const Layer layer = layer_of(shapes::scan(8000, {0.2, 0.3, 5}));
    const auto spread = [&](BandLevels levels) {
        BandsOptions options;
        options.levels = levels;
        options.vertices = 300;
        const std::vector<double> detail = series(split(layer, options).report, "band_detail");
        return *std::max_element(detail.begin(), detail.end()) / *std::min_element(detail.begin(), detail.end());
    };
    EXPECT_LT(spread(BandLevels::equal_detail), 0.7 * spread(BandLevels::ratio));
}

TEST(Bands, GainsActOnTheirBandAndOnTheSelection) {
    Layer layer = layer_of(shapes::scan(4000, {0.2, 0.3, 5}));
    BandsOptions options;
    options.vertices = 300;
    options.gain[0] = 2;
    const Result finest = split(layer, options);
    const double detail = series(finest.report, "band_detail")[0];
    EXPECT_NEAR(fixtures::number(finest.report, "rms_displacement"), detail, 1e-9);
    options.gain = {0, 0, 0, 0, 1, 1, 1};
    Session session;
    SmoothBaseOptions base;
    base.vertices = 300;
    const Positions smooth = *generate_base(layer, base, session).layer->positions;
    const Positions left = *split(layer, options).positions;  // on the base, but not at its vertices
    const SurfaceTree surface(layer.mesh.faces, smooth);
    double square = 0;
    for (const Vec3& p : left) square += surface.closest(p).squared / static_cast<double>(left.size());
    EXPECT_LT(std::sqrt(square), 0.02 * displacement(layer.mesh.positions, smooth).rms);
    for (const Vec3& p : layer.mesh.positions) layer.selected_vertex.push_back(p.z() > 0);
    options.region.selected = true;
    const Positions some = *split(layer, options).positions;
    for (std::size_t v = 0; v < some.size(); ++v)
        EXPECT_EQ(some[v], layer.selected_vertex[v] ? left[v] : layer.mesh.positions[v]);
}

// Vorsatz and Kobbelt, Figures 3 and 4: what cannot be projected onto the coarsest level.
// Vorsatz and Kobbelt, Figures 3 and 4. The ball cannot be projected onto the square, but every shape between them onto
// the next: over the square it follows what lies under it, over the shapes between what it stands on.
TEST(Multiband, OfFiveBandsKeepsAMushroomBesideADuneWhereTwoBandsTearIt) {
    const Mesh whole = mushroom(60), square = shapes::plane(60, {0, 0, 1});
    const auto between = [&](double t) {
        Positions shape = whole.positions;
        for (std::size_t v = 0; v < shape.size(); ++v)
            shape[v] = t * shape[v] + (1 - t) * 2 * (square.positions[v] - Vec3(0.5, 0.5, 0));
        return shape;
    };
    const Multiband two(whole, {between(0)}, {}),
        five(whole, {between(0.8), between(0.6), between(0.4), between(0)}, {});
    Index flips_of_two = 0, flips_of_five = 0;
    for (const double at : {0.15, 0.2, 0.25}) {
        const auto after = [&](const Multiband& bands) {
            return bands.reconstruct(whole.faces, with_dune(bands.coarsest(), at),
                                     std::vector<double>(bands.bands(), 1));
        };
        EXPECT_LT(stretch_of_ball(whole, after(five)), 0.4 * stretch_of_ball(whole, after(two)));
        flips_of_two += compare(whole.faces, whole.positions, after(two)).flipped_faces;
        flips_of_five += compare(whole.faces, whole.positions, after(five)).flipped_faces;
    }
    EXPECT_GT(flips_of_two, 12);
    EXPECT_LT(flips_of_five, 4);
}

TEST(FollowEdit, WithPhongWithoutAChangeOfTheProxyGivesTheDetailItsGain) {
    const Layer layer = layer_of(shapes::scan(1500, {0.2, 0.3, 5}));
    Layer proxy = layer_of(shapes::irregular_sphere(300)), turned = proxy;
    const fixtures::Motion motion;
    turned.mesh = motion(turned.mesh);
    TransferEditOptions options;
    options.before.place = 0, options.edited.place = 1;
    options.encoding = Encoding::phong;
    Session session;
    for (options.bands = 1; options.bands <= 5; options.bands += 2) {
        const auto followed = [&](DetailsFollow details, double gain) {
            options.details = details, options.gain = gain;
            return *transfer_edit({layer, {&proxy, &turned}}, options, session).positions;
        };
        EXPECT_LT(largest_distance(followed(DetailsFollow::multiresolution, 1), motion(layer.mesh).positions), 1e-9);
        EXPECT_EQ(followed(DetailsFollow::multiresolution, 0), followed(DetailsFollow::none, 1));
        const Positions base = followed(DetailsFollow::single, 0), once = followed(DetailsFollow::single, 1),
                        twice = followed(DetailsFollow::single, 2);
        for (std::size_t v = 0; v < base.size(); ++v)
            EXPECT_LT((motion.rotation * (twice[v] - once[v]) - (motion(layer.mesh.positions[v]) - base[v])).norm(),
                      1e-9);
    }
}

TEST(Bands, RefuseWhatIsOutOfRange) {
    const Layer layer = layer_of(shapes::scan(500));
    const auto refused = [&](const std::function<void(BandsOptions&)>& change) {
        BandsOptions options;
        change(options);
        EXPECT_THROW(split(layer, options), InputError);
    };
    refused([](auto& o) { o.bands = 1; });
    refused([](auto& o) { o.bands = 9; });
    refused([](auto& o) { o.vertices = 0; });
    refused([](auto& o) { o.vertices = 501; });
    refused([](auto& o) { o.gain[6] = NAN; });
}

}  // namespace multires
