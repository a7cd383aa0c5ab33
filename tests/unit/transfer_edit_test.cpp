#include "filters/editing/transfer_edit.h"

#include "editing/gradient_domain.h"
#include "editing/soft_border.h"
#include "filter_fixtures.h"
#include "filters/layers/levels.h"
#include "measure/distance.h"
#include "measure/measure.h"
#include "random.h"

#include <Eigen/Dense>

#include <functional>

// Follow Edited Layer: the motion of a proxy, the gradient domain, what is the same and what is refused.

namespace multires {
namespace {

using fixtures::count;
using fixtures::largest_distance;
using fixtures::layer_of;
using Similarity = fixtures::Motion;
using fixtures::number;
using fixtures::refusal;

TransferEditOptions pair_options() {
    TransferEditOptions o;
    o.before.place = 0;
    o.edited.place = 1;
    return o;
}

Result follow(const Layer& layer, const Layer& before, const Layer& edited,
              const TransferEditOptions& options = pair_options()) {
    Session session;
    return transfer_edit({layer, {&before, &edited}}, options, session);
}

/// With the edited layer alone.
Result follow(const Layer& layer, const Layer& edited, const TransferEditOptions& options = pair_options()) {
    return follow(layer, edited, edited, options);
}

Mesh mapped(Mesh mesh, const std::function<Vec3(const Vec3&)>& map) {
    for (Vec3& p : mesh.positions) p = map(p);
    return mesh;
}

/// The level of a layer with about a share of its vertices, as a host would have it.
Layer level_of(const Layer& layer, double share, bool with_sources) {
    Session session;
    GenerateLevelOptions options;
    const auto pyramid = [&] {
        Report report;
        return pyramid_of(layer, options.pyramid, session, report);
    }();
    int level = 0;
    const auto& sizes = pyramid->hierarchy().size;
    while (level + 1 < static_cast<int>(sizes.size()) && sizes[level] > share * sizes[0]) ++level;
    options.level = level;
    const DerivedMesh derived = *generate_level(layer, options, session).layer;
    Layer out;
    out.mesh.faces = derived.faces;
    for (const Index v : derived.source_vertex) out.mesh.positions.push_back(layer.mesh.positions[v]);
    if (with_sources) {
        Attribute a{AttributeKind::scalar, source_vertex_name, 1, {}};
        a.values.assign(derived.source_vertex.begin(), derived.source_vertex.end());
        out.attributes.push_back(a);
    }
    return out;
}

Vec3 twisted(const Vec3& p) {
    const double angle = 0.4 * p.z();
    return {p.x() * std::cos(angle) - p.y() * std::sin(angle), p.x() * std::sin(angle) + p.y() * std::cos(angle),
            p.z()};
}

double rms_distance(const Positions& a, const Positions& b) { return displacement(a, b).rms; }

}  // namespace

TEST(DisplacementGradients, OfAffineMapsAreTheMapsAlongTheSurface) {
    const Mesh sphere = shapes::irregular_sphere(500);
    Mat3 map;
    map << 1.2, 0.1, -0.2, 0.05, 0.9, 0.1, 0, 0.3, 1.1;
    const Positions after = mapped(sphere, [&](const Vec3& p) { return Vec3(map * p + Vec3(1, 2, 3)); }).positions;
    // The length of normals is a guess for maps that are no similarities, so this is exact along the surface only.
    const auto gradients = displacement_gradients({sphere.faces, sphere.positions, after});
    double sum = 0;
    for (const Face& f : sphere.faces)
        for (int k = 0; k < 3; ++k) {
            const Vec3 edge = sphere.positions[f[(k + 1) % 3]] - sphere.positions[f[k]];
            const double error = (edge + gradients[f[k]] * edge - map * edge).norm() / edge.norm();
            EXPECT_LT(error, 0.1);
            sum += error / (3.0 * static_cast<double>(sphere.faces.size()));
        }
    EXPECT_LT(sum, 0.02);
    const Similarity similarity{Similarity().rotation, 1.7, {5, -3, 0.2}};
    const Positions turned = similarity(sphere).positions;
    for (const Mat3& g : displacement_gradients({sphere.faces, sphere.positions, turned}))
        EXPECT_LT((g + Mat3::Identity() - 1.7 * similarity.rotation).norm(), 1e-12);
}

TEST(DisplacementGradients, OfCurvedMotionsConverge) {
    const auto error = [](Index vertices) {
        const Mesh sphere = shapes::irregular_sphere(vertices);
        const auto twist = [](const Vec3& p) { return Vec3(Eigen::AngleAxisd(1.5 * p.z(), Vec3::UnitZ()) * p); };
        const auto gradients =
            displacement_gradients({sphere.faces, sphere.positions, mapped(sphere, twist).positions});
        double sum = 0;
        for (std::size_t v = 0; v < gradients.size(); ++v) {
            const Vec3& p = sphere.positions[v];
            Mat3 exact;
            constexpr double step = 1e-5;
            for (int d = 0; d < 3; ++d)
                exact.col(d) = (twist(p + step * Vec3::Unit(d)) - twist(p - step * Vec3::Unit(d))) / (2 * step);
            const Vec3 n = p.normalized();
            const Mat3 along = Mat3::Identity() - n * n.transpose();
            sum += ((Mat3::Identity() + gradients[v] - exact) * along).squaredNorm();
        }
        return std::sqrt(sum / static_cast<double>(gradients.size()));
    };
    const double coarse = error(500), fine = error(8000);  // edges of a quarter
    EXPECT_LT(fine, 0.022) << "0.029 without the gradients around";
    EXPECT_LT(coarse, 0.08) << "0.097 without";
}

TEST(DisplacementGradients, OfSimilaritiesAreExactOnEveryClassOfMesh) {
    for (const auto& [name, mesh] : fixtures::every_class()) {
        SCOPED_TRACE(name);
        const Similarity motion{Similarity().rotation, 0.3, {5, -3, 0.2}};
        const Positions after = motion(mesh).positions;
        const auto gradients = displacement_gradients({mesh.faces, mesh.positions, after});
        std::vector<int> used(mesh.positions.size(), 0);
        for (const Face& f : mesh.faces)
            if (!repeats_an_index(f))
                for (const Index v : f) used[v] = 1;
        for (std::size_t v = 0; v < used.size(); ++v) {
            const Mat3 expected = used[v] ? Mat3(0.3 * motion.rotation - Mat3::Identity()) : Mat3(Mat3::Zero());
            EXPECT_LT((gradients[v] - expected).norm(), 1e-6) << v;
        }
    }
}

TEST(Motion, QuadraticAlongTheSurfaceIsReproduced) {
    const Mesh grid = shapes::plane(8, {0, 0, 1});
    const auto quadratic = [](const Vec3& p) {
        return Vec3(p.x() + 0.3 * p.x() * p.y(), p.y() - 0.2 * p.x() * p.x(),
                    0.1 * p.y() * p.y() + 0.2 * p.x() * p.y());
    };
    const Positions after = mapped(grid, quadratic).positions;
    // Gradients as they are, so that the form alone is tested.
    Array<Mat3> gradients(grid.positions.size());
    for (std::size_t v = 0; v < gradients.size(); ++v) {
        const Vec3& p = grid.positions[v];
        gradients[v] << 0.3 * p.y(), 0.3 * p.x(), 0, -0.4 * p.x(), 0, 0, 0.2 * p.y(), 0.2 * (p.x() + p.y()), 0;
    }
    Positions points;
    shapes::Random random(1);
    for (int i = 0; i < 500; ++i) points.push_back({random.uniform(0, 1), random.uniform(0, 1), 0});
    const auto feet = feet_of(points, grid.faces, grid.positions, {});
    const auto motion = motion_at(points, feet, {grid.faces, grid.positions, after}, gradients);
    for (std::size_t i = 0; i < points.size(); ++i)
        EXPECT_LT((points[i] + motion.displacement[i] - quadratic(points[i])).norm(), 1e-14);
}

TEST(ClosestWeights, GiveTheClosestPointAlsoOfTrianglesWithoutArea) {
    shapes::Random random(3);
    for (int i = 0; i < 3000; ++i) {
        const Vec3 p = random.direction() * 2, a = random.direction(), b = random.direction();
        const Vec3 c = i % 3 == 0 ? Vec3(a + random.uniform(-1, 2) * (b - a)) : i % 3 == 1 ? a : random.direction();
        const Vec3 w = closest_weights(p, a, b, c);
        EXPECT_NEAR(w.sum(), 1, 1e-15);
        EXPECT_GE(w.minCoeff(), 0);
        EXPECT_NEAR((w[0] * a + w[1] * b + w[2] * c - p).norm(), (closest_on_triangle(p, a, b, c) - p).norm(), 1e-12);
    }
}

TEST(FollowEdit, WithoutAChangeIsTheSameBitForBitOnEveryClassOfMesh) {
    for (const auto& [name, mesh] : fixtures::every_class()) {
        SCOPED_TRACE(name);
        Layer layer = layer_of(mesh), proxy = layer_of(shapes::irregular_sphere(100));
        layer.to_world.topLeftCorner<3, 3>() = Similarity().rotation;
        proxy.to_world = layer.to_world;
        const Layer same = proxy;
        for (const auto encoding : {Encoding::gradient, Encoding::frames}) {
            TransferEditOptions options = pair_options();
            options.encoding = encoding;
            options.details = DetailsFollow::single;
            EXPECT_EQ(*follow(layer, proxy, same, options).positions, mesh.positions);
        }
    }
}

TEST(FollowEdit, SimilaritiesOfTheProxyAreThoseOfTheLayerOnEveryClassOfMesh) {
    for (const auto& [name, mesh] : fixtures::every_class()) {
        SCOPED_TRACE(name);
        for (const double scale : {1.0, 1000.0, 0.01}) {
            const Similarity motion{Similarity().rotation, scale, {0.3, -1.7, 2.2}};
            const Layer layer = layer_of(mesh);
            const Result r = follow(layer, layer_of(mesh), layer_of(motion(mesh)));
            EXPECT_LT(largest_distance(*r.positions, motion(mesh).positions),
                      1e-9 * (scale * bounding_box(mesh.positions).diagonal() + 3));
            EXPECT_EQ(count(r.report, "folded_faces"), 0);
            EXPECT_EQ(count(r.report, "way"), 2);
        }
    }
}

TEST(FollowEdit, FollowsATwistFarBetterThanInterpolatedCornersDo) {
    const Layer layer = layer_of(shapes::scan(20000, {0.2, 0.3, 5}));
    const Positions expected = mapped(layer.mesh, twisted).positions;
    for (const double share : {0.1, 0.03}) {
        Layer before = level_of(layer, share, false);
        const Layer edited = layer_of(mapped(before.mesh, twisted));
        const Proxy proxy{before.mesh.faces, before.mesh.positions, edited.mesh.positions};
        const auto feet = feet_of(layer.mesh.positions, proxy.faces, proxy.before, {});
        Positions chords(feet.size());
        const auto gradients = displacement_gradients(proxy);
        for (std::size_t i = 0; i < feet.size(); ++i) {
            chords[i] = layer.mesh.positions[i];
            Vec3 q = Vec3::Zero();
            Mat3 g = Mat3::Zero();
            for (int k = 0; k < 3; ++k) {
                const Index v = proxy.faces[feet[i].face][k];
                chords[i] += feet[i].weight[k] * (proxy.after[v] - proxy.before[v]);
                q += feet[i].weight[k] * proxy.before[v], g += feet[i].weight[k] * gradients[v];
            }
            chords[i] += g * (layer.mesh.positions[i] - q);
        }
        const Result r = follow(layer, before, edited);
        EXPECT_LT(rms_distance(*r.positions, expected), 0.7 * rms_distance(chords, expected));
        EXPECT_LT(mean_normal_angle(layer.mesh.faces, *r.positions, expected),
                  0.6 * mean_normal_angle(layer.mesh.faces, chords, expected));
        EXPECT_EQ(count(r.report, "folded_faces"), 0);
        EXPECT_EQ(compare(layer.mesh.faces, expected, *r.positions).flipped_faces, 0);
    }
}

TEST(FollowEdit, FindsTheLevelByItsSourceVerticesOrItsFaces) {
    const Layer layer = layer_of(shapes::scan(3000, {0.2, 0.3, 5}));
    for (const bool with_sources : {true, false}) {
        const Layer level = level_of(layer, 0.2, with_sources);
        EXPECT_EQ(*follow(layer, level).positions, layer.mesh.positions);
        Layer edited = level;
        edited.mesh = mapped(level.mesh, twisted);
        const Result alone = follow(layer, edited);
        EXPECT_EQ(count(alone.report, "way"), 1);
        EXPECT_EQ(*alone.positions, *follow(layer, level, edited).positions);
    }
    // A copy of the whole layer.
    const Result whole = follow(layer, layer_of(mapped(layer.mesh, twisted)));
    EXPECT_EQ(count(whole.report, "way"), 1);
    EXPECT_LT(rms_distance(*whole.positions, mapped(layer.mesh, twisted).positions), 1e-3);
}

TEST(FollowEdit, WrapsALevelOntoARemeshedLayer) {
    // The same smooth shape in other triangles, bent a little, and bumps on the layer alone.
    const auto bent = [](const Vec3& p) { return Vec3(p.x() + 0.15 * p.z() * p.z(), 0.9 * p.y(), p.z()); };
    Mesh fine = shapes::irregular_sphere(8000);
    const Positions sphere = fine.positions;
    const std::vector<double> bumps = shapes::harmonic(sphere, 40, 2);
    for (std::size_t v = 0; v < sphere.size(); ++v) fine.positions[v] *= 1 + 0.004 * bumps[v];
    const Layer layer = layer_of(fine), edited = layer_of(mapped(shapes::irregular_sphere(1500, {0.3, 0.4, 9}), bent));
    const Result r = follow(layer, edited);
    EXPECT_EQ(count(r.report, "way"), 3);
    const SurfaceTree tree(edited.mesh.faces, edited.mesh.positions);
    double off = 0, rough = 0;
    for (std::size_t v = 0; v < sphere.size(); ++v) {
        off += tree.closest((*r.positions)[v]).squared;
        rough += std::pow(0.004 * bumps[v], 2);
    }
    EXPECT_LT(off, 4 * rough);  // it was 0.1 away, and still has its bumps:
    EXPECT_GT(mean_normal_angle(layer.mesh.faces, *r.positions, mapped({sphere, fine.faces}, bent).positions), 3);
    EXPECT_EQ(count(r.report, "folded_faces"), 0);
    const Layer elsewhere = layer_of(Similarity{Mat3::Identity(), 0.01, {0, 0, 0}}(edited.mesh));
    EXPECT_NE(refusal([&] { follow(layer, elsewhere); }), "");
}

TEST(FollowEdit, LeavesVerticesOutOfReachOfALocalEditBitForBit) {
    const Layer layer = layer_of(shapes::scan(5000, {0.2, 0.3, 5})), before = level_of(layer, 0.2, false);
    Layer edited = before;
    Vec3& moved = edited.mesh.positions[7];
    const Vec3 place = moved;
    moved *= 1.2;
    const Positions after = *follow(layer, before, edited).positions;
    int same = 0, changed = 0;
    for (std::size_t v = 0; v < after.size(); ++v) {
        if ((layer.mesh.positions[v] - place).norm() > 1) {
            EXPECT_EQ(after[v], layer.mesh.positions[v]);
        }
        (after[v] == layer.mesh.positions[v] ? same : changed)++;
    }
    EXPECT_GT(same, 3000);
    EXPECT_GT(changed, 30);
}

TEST(FollowEdit, ActsOnTheSelectionWithASoftBorder) {
    Layer layer = layer_of(shapes::scan(5000, {0.2, 0.3, 5}));
    const Layer before = level_of(layer, 0.2, false);
    const Layer edited = layer_of(Similarity{Mat3::Identity(), 1, {1, 0, 0}}(before.mesh));
    TransferEditOptions options = pair_options();
    options.region.selected = true;
    EXPECT_NE(refusal([&] { follow(layer, before, edited, options); }), "");
    for (const Vec3& p : layer.mesh.positions) layer.selected_vertex.push_back(p.z() > 0);
    for (options.soft_border = 0; options.soft_border < 1; options.soft_border += 0.4) {
        const Positions after = *follow(layer, before, edited, options).positions;
        for (std::size_t v = 0; v < after.size(); ++v) {
            const Vec3& p = layer.mesh.positions[v];
            const double way = after[v].x() - p.x();
            if (p.z() <= 0) {
                EXPECT_EQ(after[v], p);
            }
            if (p.z() > 1.3 * options.soft_border + 0.2) {
                EXPECT_NEAR(way, 1, 1e-12);
            }
            EXPECT_GE(way, 0);
            if (p.z() < 0.5 * options.soft_border) {
                EXPECT_LT(way, 0.95);
            }
        }
    }
}

TEST(FollowEdit, HoldsBetweenLayersAsTheirTransformationsPlaceThem) {
    const Layer layer = layer_of(shapes::scan(3000, {0.2, 0.3, 5})), before = level_of(layer, 0.2, false);
    const Layer edited = layer_of(mapped(before.mesh, twisted));
    const Positions expected = *follow(layer, before, edited).positions;
    Eigen::Matrix4d place = Eigen::Matrix4d::Identity();
    place.topLeftCorner<3, 3>() = 2 * Similarity().rotation, place.topRightCorner<3, 1>() = Vec3(3, 4, 5);
    Layer elsewhere = layer, before_there = before, edited_there = edited;
    elsewhere.to_world = before_there.to_world = edited_there.to_world = place;
    EXPECT_EQ(*follow(elsewhere, before_there, edited_there).positions, expected);
    Layer baked = edited;  // its coordinates are those of the document
    for (Vec3& p : baked.mesh.positions) p = (place * p.homogeneous()).head<3>();
    EXPECT_LT(largest_distance(*follow(elsewhere, before_there, baked).positions, expected), 1e-9);
    // Moving a layer as a whole is an edit.
    Layer pushed = before;
    pushed.to_world.topRightCorner<3, 1>() = Vec3(0, 0, 7);
    const Positions after = *follow(layer, before, pushed).positions;
    for (std::size_t v = 0; v < after.size(); ++v)
        EXPECT_LT((after[v] - layer.mesh.positions[v] - Vec3(0, 0, 7)).norm(), 1e-9);
}

TEST(FollowEdit, DetailsTurnKeepTheirDirectionOrGo) {
    const Layer layer = layer_of(shapes::scan(8000, {0.2, 0.3, 5})), before = level_of(layer, 0.1, false);
    const Similarity turn{Eigen::AngleAxisd(1.5, Vec3::UnitZ()).toRotationMatrix(), 1, Vec3::Zero()};
    const Layer edited = layer_of(turn(before.mesh));
    for (const auto encoding : {Encoding::gradient, Encoding::frames}) {
        TransferEditOptions options = pair_options();
        options.encoding = encoding;
        const auto with = [&](DetailsFollow details, double gain) {
            options.details = details, options.gain = gain;
            return *follow(layer, before, edited, options).positions;
        };
        const Positions base = with(DetailsFollow::none, 1), turned = with(DetailsFollow::multiresolution, 1);
        const double tolerance = encoding == Encoding::gradient ? 1e-9 : 0.02;
        EXPECT_LT(largest_distance(turned, turn(layer.mesh).positions), tolerance);
        EXPECT_GT(rms_distance(base, turned), 1e-3);
        EXPECT_EQ(with(DetailsFollow::multiresolution, 0), base);
        const Positions twice = with(DetailsFollow::multiresolution, 2);
        const Positions single = with(DetailsFollow::single, 1);
        if (encoding == Encoding::frames) continue;  // there details are not linear in the gain
        for (std::size_t v = 0; v < base.size(); ++v) {
            EXPECT_LT((twice[v] - base[v] - 2 * (turned[v] - base[v])).norm(), 1e-9);
            EXPECT_LT((turn.rotation * (single[v] - base[v]) - (turned[v] - base[v])).norm(), 1e-9);
        }
    }
}

TEST(FollowEdit, DoesNotDependOnTheNumberOfThreads) {
    const Layer layer = layer_of(shapes::scan(20000, {0.2, 0.3, 5})), before = level_of(layer, 0.1, false);
    const Layer edited = layer_of(mapped(before.mesh, twisted));
    Positions first;
    for (const int threads : {1, 2, 5}) {
        const fixtures::Threads scope(threads);
        const Positions now = *follow(layer, before, edited).positions;
        if (first.empty()) first = now;
        EXPECT_EQ(now, first);
    }
}

TEST(FollowEdit, WorksWithProxiesOfEveryClass) {
    for (const auto& [name, mesh] : fixtures::every_class()) {
        SCOPED_TRACE(name);
        const Box box = bounding_box(mesh.positions);
        Mesh fine = shapes::scan(2000, {0.2, 0.3, 5});
        for (Vec3& p : fine.positions) p = box.center() + 0.5 * box.diagonal() * p;
        Layer edited = layer_of(mesh);
        shapes::Random random(4);
        for (Vec3& p : edited.mesh.positions) p += 0.1 * box.diagonal() * random.direction();
        std::string why;
        try {
            const Result r = follow(layer_of(fine), layer_of(mesh), edited);
            for (const Vec3& p : *r.positions) ASSERT_LT((p - box.center()).norm(), 30 * box.diagonal());
        } catch (const InputError& e) {
            why = e.what();
        }
        if (why.empty()) continue;
        EXPECT_NE(why.find("does not lie on the current layer"), std::string::npos) << why;
    }
}

TEST(FollowEdit, TakesProxiesOfTwelveVerticesAndOfMoreThanTheLayerHas) {
    const Layer layer = layer_of(shapes::scan(3000, {0.05, 0.3, 5}));
    const Positions truth = mapped(layer.mesh, twisted).positions;
    const double moved = rms_distance(layer.mesh.positions, truth);
    const auto error = [&](const Mesh& proxy) {
        const Result r = follow(layer, layer_of(proxy), layer_of(mapped(proxy, twisted)));
        EXPECT_EQ(count(r.report, "folded_faces"), 0);
        return rms_distance(*r.positions, truth) / moved;
    };
    EXPECT_LT(error(level_of(layer, 0.004, false).mesh), 0.25);
    EXPECT_LT(error(shapes::icosphere(1)), 0.25);
    EXPECT_LT(error(shapes::scan(12000, {0.05, 0.3, 5})), 0.01);
}

TEST(FollowEdit, SaysThatTheEditedProxyIsFarLargerOrFarAway) {
    const Layer layer = layer_of(shapes::scan(1000)), before = level_of(layer, 0.2, false);
    const auto words = [&](const Similarity& motion) {
        const Result r = follow(layer, before, layer_of(motion(before.mesh)));
        EXPECT_LT(largest_distance(*r.positions, motion(layer.mesh).positions), 1e-9 * motion.scale);
        return r.report.lines().at(0);
    };
    EXPECT_EQ(words({Similarity().rotation, 1.5, {1, 0, 0}}), "Following the change from one layer to the other.");
    EXPECT_NE(words({Mat3::Identity(), 1000, {0, 0, 0}}).find("is 1e+03 times as large"), std::string::npos);
    EXPECT_NE(words({Mat3::Identity(), 1e-3, {0, 0, 0}}).find("is 0.001 times as large"), std::string::npos);
    EXPECT_NE(words({Mat3::Identity(), 1, {500, 0, 0}}).find("lies 500 from where it was"), std::string::npos);
}

TEST(FollowEdit, SaysWhatDoesNotFit) {
    const Layer layer = layer_of(shapes::scan(3000, {0.2, 0.3, 5})), before = level_of(layer, 0.2, false);
    Layer edited = before, cloud = before;
    for (Vec3& p : edited.mesh.positions) p.x() *= 1.1;
    cloud.mesh.faces.clear();
    const auto why = [&](const Layer& b, const Layer& e) { return refusal([&] { follow(layer, b, e); }); };
    EXPECT_EQ(why(before, layer), "edited: it is the current layer itself; choose the edited proxy");
    EXPECT_EQ(why(before, cloud).find("edited: "), 0U);
    EXPECT_EQ(why(cloud, edited).find("before: "), 0U);
    EXPECT_EQ(why(layer_of(shapes::icosphere(5)), edited).find("before and edited do not fit together: before has 252"),
              0U);
    EXPECT_NE(refusal([&] { follow(layer, before, edited, {}); }), "");
    Layer far = before, far_edited = edited, large = before, large_edited = edited;
    for (Layer* l : {&far, &far_edited}) l->mesh = Similarity{Mat3::Identity(), 1, {100, 0, 0}}(l->mesh);
    EXPECT_NE(why(far, far_edited).find("lies 100 away"), std::string::npos) << why(far, far_edited);
    for (Layer* l : {&large, &large_edited}) l->mesh = Similarity{Mat3::Identity(), 1000, {0, 0, 0}}(l->mesh);
    EXPECT_NE(why(large, large_edited).find("its box is 996 times as large"), std::string::npos)
        << why(large, large_edited);
    TransferEditOptions options = pair_options();
    options.gain = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(refusal([&] { follow(layer, before, edited, options); }), "gain must be a number");
    options = pair_options();
    options.soft_border = -1;
    EXPECT_EQ(refusal([&] { follow(layer, before, edited, options); }), "soft_border must be a number, 0 or more");
}

TEST(SoftBorder, RisesFromTheBorderOfTheRegionSmoothly) {
    const Mesh grid = shapes::plane(40, {0, 0, 1});
    std::vector<double> weights;
    for (const Vec3& p : grid.positions) weights.push_back(p.x() > 0.25 ? 0.5 : 0);
    const std::vector<double> hard = weights;
    soften_border(grid, 0, weights);
    EXPECT_EQ(weights, hard);
    soften_border(grid, 0.5, weights);
    for (std::size_t v = 0; v < weights.size(); ++v) {
        const double s = std::clamp((grid.positions[v].x() - 0.25) / 0.5, 0.0, 1.0);
        EXPECT_NEAR(weights[v], 0.5 * s * s * (3 - 2 * s), 1e-12);
    }
    std::vector<double> all(grid.positions.size(), 1);
    soften_border(grid, 0.5, all);
    EXPECT_EQ(all, std::vector<double>(grid.positions.size(), 1));
}

}  // namespace multires
