#include "filters/shape/denoise.h"

#include "denoise_fixtures.h"

namespace multires {

using namespace fixtures;

namespace {

const double nan_value = std::numeric_limits<double>::quiet_NaN();

Mesh noisy(const Mesh& truth, double deviation, NoiseKind kind = NoiseKind::along_normals) {
    Mesh mesh = truth;
    mesh.positions = with_noise(truth, deviation, kind);
    return mesh;
}

Mesh waves(Index vertices) {
    shapes::BandedSphereOptions options;
    options.vertices = vertices;
    options.low_amplitude = 0.06;
    options.high_degree = 12;
    options.high_amplitude = 0.015;
    return shapes::banded_sphere(options).mesh;
}

Result run(const Layer& layer, const DenoiseOptions& options = {}) {
    Session session;
    return denoise(layer, options, session);
}

DenoiseOptions with(DenoiseMethod method) {
    DenoiseOptions options;
    options.method = method;
    options.pyramid.hierarchy.base_vertices = 30;
    return options;
}

constexpr DenoiseMethod all_methods[] = {DenoiseMethod::automatic, DenoiseMethod::normal_field,
                                         DenoiseMethod::soft_threshold, DenoiseMethod::hard_threshold};

/// By the normal field.
Positions smoothed(const Mesh& mesh) { return denoised(mesh, with(DenoiseMethod::normal_field)); }

double edge_of(const Mesh& mesh) { return mean_edge_length(mesh.faces, mesh.positions); }

/// What denoising a shape with noise of 0.1, 0.2 and 0.3 edge lengths may leave at most.
struct Limits {
    const char* name;
    Mesh mesh;
    std::array<double, 3> angle, rms;  ///< 1.3 times what was measured
};

}  // namespace

TEST(Denoise, CleanMeshesStay) {
    // Flat parts and creases not at all, round ones hardly.
    const Mesh plane = shapes::plane(30, {0.1, 0, 1});
    EXPECT_LE(largest_distance(denoised(plane), plane.positions), 1e-14);
    const Mesh block = shapes::block(8);
    EXPECT_EQ(denoised(block), block.positions);
    const Mesh sphere = shapes::icosphere(20);
    EXPECT_LE(largest_distance(denoised(sphere), sphere.positions), 0.03 * edge_of(sphere));
}

TEST(Denoise, GaussianNoiseGoesAtThreeLevels) {
    const Limits shapes_and_limits[] = {
        {"sphere", shapes::irregular_sphere(4000), {1.6, 2.3, 3.1}, {0.028, 0.051, 0.075}},
        {"block", shapes::block(13), {1.6, 4.1, 6.0}, {0.033, 0.078, 0.105}},
        {"waves", waves(10000), {2.8, 3.6, 4.2}, {0.049, 0.073, 0.093}},
    };
    for (const Limits& limits : shapes_and_limits)
        for (int level = 0; level < 3; ++level) {
            const double deviation = 0.1 * (level + 1);
            SCOPED_TRACE(std::string(limits.name) + ", noise " + std::to_string(deviation));
            const Mesh mesh = noisy(limits.mesh, deviation);
            const Error before = error_of(limits.mesh, mesh.positions), after = error_of(limits.mesh, smoothed(mesh));
            EXPECT_LE(after.angle, limits.angle[level]);
            EXPECT_LE(after.rms, limits.rms[level]);
            EXPECT_LE(std::abs(after.volume), 0.005);
            EXPECT_EQ(after.folded, 0);
            const Error other = best_taubin(limits.mesh, mesh.positions);
            EXPECT_LT(after.angle, other.angle);
            if (level > 0) {
                EXPECT_LT(after.rms, other.rms);
            }
            EXPECT_LT(after.angle, 0.22 * before.angle);
        }
}

TEST(Denoise, NoiseInAllDirectionsGoesAndFoldsWithIt) {
    for (const auto& [mesh, share] :
         {std::pair(shapes::irregular_sphere(4000), 0.11), std::pair(shapes::block(13), 0.2)})
        for (const double deviation : {0.1, 0.2, 0.3}) {
            const Mesh bad = noisy(mesh, deviation, NoiseKind::all_directions);
            const Error before = error_of(mesh, bad.positions), after = error_of(mesh, smoothed(bad));
            EXPECT_LE(after.angle, share * before.angle);
            EXPECT_LE(after.rms, 0.7 * before.rms);
            EXPECT_LE(std::abs(after.volume), 0.005);
            EXPECT_LE(after.folded, before.folded / 10);
            EXPECT_LT(after.angle, best_taubin(mesh, bad.positions).angle);
        }
}

TEST(Denoise, ImpulsiveNoiseGoes) {
    const Limits shapes_and_limits[] = {
        {"sphere", shapes::irregular_sphere(4000), {3.2, 3.7, 4.1}, {0.042, 0.053, 0.076}},
        {"block", shapes::block(13), {3.1, 4.6, 5.6}, {0.06, 0.093, 0.135}},
        {"waves", waves(10000), {3.6, 4.3, 4.4}, {0.049, 0.063, 0.08}},
    };
    for (const Limits& limits : shapes_and_limits)
        for (int level = 0; level < 3; ++level) {
            SCOPED_TRACE(std::string(limits.name) + ", level " + std::to_string(level));
            const Mesh mesh = noisy(limits.mesh, 0.2 * (level + 1), NoiseKind::impulsive);
            const Result result = run(layer_of(mesh), with(DenoiseMethod::normal_field));
            EXPECT_GT(count(result.report, "spikes_removed"), 0.05 * mesh.positions.size());
            const Error after = error_of(limits.mesh, *result.positions);
            EXPECT_LE(after.angle, limits.angle[level]);
            EXPECT_LE(after.rms, limits.rms[level]);
            EXPECT_LE(std::abs(after.volume), 0.005);
            EXPECT_LE(after.folded, error_of(limits.mesh, mesh.positions).folded);
        }
}

TEST(Denoise, DeviationOfTheNoiseIsFound) {
    for (const Mesh& mesh : {shapes::plane(40), shapes::irregular_sphere(4000), shapes::icosphere(20)})
        for (const double deviation : {0.05, 0.1, 0.15, 0.2}) {
            const double found = noise_deviation(noisy(mesh, deviation)) / edge_of(mesh);
            // Found: 0.93, where noise of a fifth of an edge turns normals, to 1.07, where a coarse sphere is curved.
            EXPECT_NEAR(found / deviation, 1, 0.08) << deviation;
        }
    EXPECT_EQ(noise_deviation(shapes::triangle()), 0);
    EXPECT_LE(noise_deviation(shapes::plane(20)), 1e-15);
}

TEST(Denoise, FollowsMotionsScaleAndMirrors) {
    const Mesh mesh = noisy(shapes::block(6), 0.2);
    Motion motion;
    motion.scale = 250;
    motion.offset *= 100;
    for (const DenoiseMethod method : all_methods) {
        const DenoiseOptions options = with(method);
        const Positions plain = denoised(mesh, options);
        EXPECT_GT(largest_distance(plain, mesh.positions), 0.1 * edge_of(mesh));
        const auto expect_follows = [&](Mesh other, const auto& map) {
            const Positions after = denoised(other, options);
            Positions expected = plain;
            for (Vec3& p : expected) p = map(p);
            EXPECT_LE(largest_distance(after, expected), 1e-9 * box_diagonal(layer_of(other)));
        };
        expect_follows(motion(mesh), motion);
        if (method != DenoiseMethod::normal_field) continue;  // hierarchies may break ties another way in a mirror
        const auto mirror = [](const Vec3& p) { return Vec3(p.x(), -p.y(), p.z()); };
        Mesh mirrored = mesh;
        for (Vec3& p : mirrored.positions) p = mirror(p);
        for (Face& f : mirrored.faces) std::swap(f[1], f[2]);
        expect_follows(mirrored, mirror);
    }
}

TEST(Denoise, GivesTheSameBitsWithAnyNumberOfThreads) {
    const Mesh mesh = noisy(shapes::irregular_sphere(5000), 0.2);
    for (const DenoiseMethod method : all_methods) {
        std::vector<Positions> results;
        for (const int threads : {1, 2, 2, 3}) {
            const Threads scope(threads);
            results.push_back(denoised(mesh, with(method)));
        }
        for (const Positions& p : results) EXPECT_EQ(p, results.front());
    }
}

TEST(Denoise, OnlyTheSelectionMoves) {
    Layer layer = layer_of(noisy(shapes::irregular_sphere(1000), 0.2));
    const Positions& before = layer.mesh.positions;
    for (const DenoiseMethod method : all_methods)
        for (const bool by_face : {false, true})
            for (const bool keep_volume : {false, true}) {
                layer.selected_vertex.clear();
                layer.selected_face.clear();
                std::vector<bool> selected(before.size());
                if (by_face) {
                    layer.selected_face.assign(layer.mesh.faces.size(), 0);
                    for (std::size_t f = 0; f < layer.mesh.faces.size(); f += 9) {
                        layer.selected_face[f] = 1;
                        for (const Index v : layer.mesh.faces[f]) selected[v] = true;
                    }
                } else {
                    layer.selected_vertex.assign(before.size(), 0);
                    for (std::size_t i = 0; i < before.size(); i += 3) layer.selected_vertex[i] = selected[i] = true;
                }
                DenoiseOptions options = with(method);
                options.region.selected = true;
                options.keep_volume = keep_volume;
                const Positions after = *run(layer, options).positions;
                std::size_t moved = 0;
                for (std::size_t i = 0; i < before.size(); ++i) {
                    EXPECT_TRUE(selected[i] || after[i] == before[i]);
                    moved += after[i] != before[i];
                }
                EXPECT_GT(moved, before.size() / 5);
            }
}

TEST(Denoise, QualityIsASoftMask) {
    const Mesh mesh = noisy(shapes::irregular_sphere(1000), 0.2);
    std::vector<double> quality(mesh.positions.size());
    for (std::size_t i = 0; i < quality.size(); ++i) quality[i] = i % 4 == 0 ? -2 : 0.5 * (i % 4);
    for (const DenoiseMethod method : all_methods) {
        DenoiseOptions options = with(method);
        const Positions all = denoised(mesh, options);
        options.region.quality_mask = true;
        const Positions part = *run(with_quality(layer_of(mesh), quality), options).positions;
        for (std::size_t i = 0; i < all.size(); ++i) {
            const Vec3& p = mesh.positions[i];
            if (quality[i] <= 0) {
                EXPECT_EQ(part[i], p);
            }
            EXPECT_LE((part[i] - p - std::clamp(quality[i], 0.0, 1.0) * (all[i] - p)).norm(), 1e-14);
        }
    }
}

TEST(Denoise, TrustedVerticesStay) {
    const Mesh mesh = noisy(shapes::irregular_sphere(1000), 0.2);
    std::vector<double> confidence(mesh.positions.size(), 0);
    for (std::size_t i = 0; i < confidence.size(); i += 2) confidence[i] = 1 + i % 3;
    DenoiseOptions options;
    const Positions all = denoised(mesh);
    options.confidence = true;
    const Positions part = *run(with_quality(layer_of(mesh), confidence), options).positions;
    for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(part[i], i % 2 == 0 ? mesh.positions[i] : all[i]);
    for (const DenoiseMethod method : all_methods) {
        options = with(method);
        const Positions plain = denoised(mesh, options);
        options.confidence = true;
        const auto at = [&](double everywhere) {
            std::vector<double> quality(mesh.positions.size(), everywhere);
            return *run(with_quality(layer_of(mesh), std::move(quality)), options).positions;
        };
        EXPECT_EQ(at(0), plain);
        EXPECT_LE(largest_distance(at(1), mesh.positions), 1e-12);
        const double half = largest_distance(at(0.5), mesh.positions);
        EXPECT_GT(half, 0.01 * edge_of(mesh));
        EXPECT_LT(half, largest_distance(plain, mesh.positions));
    }
}

TEST(Denoise, KeepsTheVolumeIfAsked) {
    Layer layer = layer_of(noisy(waves(2000), 0.3));
    for (const DenoiseMethod method : all_methods)
        for (const bool half : {false, true}) {
            DenoiseOptions options = with(method);
            options.keep_volume = true;
            options.region.selected = half;
            layer.selected_vertex.assign(layer.mesh.positions.size(), 0);
            for (std::size_t i = 0; i < layer.mesh.positions.size(); ++i)
                layer.selected_vertex[i] = layer.mesh.positions[i].x() > 0;
            const Report report = run(layer, options).report;
            EXPECT_NEAR(number(report, "volume_after") / number(report, "volume_before"), 1, 1e-6);
        }
}

TEST(Denoise, ReportSaysWhatWasFoundAndDone) {
    const Mesh mesh = noisy(shapes::irregular_sphere(2000), 0.2);
    const Result result = run(layer_of(mesh), with(DenoiseMethod::normal_field));
    EXPECT_EQ(number(result.report, "noise"), noise_deviation(mesh));
    EXPECT_LT(number(result.report, "normal_noise_after"), 0.3 * number(result.report, "normal_noise"));
    for (const char* key : {"detail_per_level", "noise_per_level", "share_removed"})
        EXPECT_EQ(series(result.report, key).size(), 4u) << key;
    const Displacement moved = displacement(mesh.positions, *result.positions);
    EXPECT_EQ(number(result.report, "largest_displacement"), moved.largest);
    EXPECT_EQ(number(result.report, "rms_displacement"), moved.rms);
    EXPECT_FALSE(result.quality || result.layer || !result.attributes.empty());
    // Thresholding: most of the noise is gone.
    const Report report = run(layer_of(mesh), with(DenoiseMethod::soft_threshold)).report;
    const auto noise = series(report, "noise_per_level"), threshold = series(report, "threshold_per_level"),
               zeroed = series(report, "share_zeroed");
    ASSERT_EQ(noise.size(), 5u);
    ASSERT_EQ(threshold.size(), 5u);
    EXPECT_NEAR(number(report, "noise") / edge_of(shapes::irregular_sphere(2000)), 0.2, 0.03);
    EXPECT_GT(threshold[0], 0.5 * noise[0]);
    EXPECT_GT(zeroed[0], 0.5);
}

TEST(Denoise, StrengthAndAGivenDeviationScaleTheEffect) {
    const Mesh mesh = noisy(waves(2000), 0.1);
    double last = 0;
    for (const double strength : {0.05, 0.3, 0.6, 1.0, 2.0}) {
        DenoiseOptions options;
        options.strength = strength;
        const double moved = displacement(mesh.positions, denoised(mesh, options)).rms;
        EXPECT_GT(moved, last);
        last = moved;
    }
    DenoiseOptions units, percent;
    units.unit = ThresholdUnit::length;
    units.threshold = 0.1 * edge_of(mesh);
    percent.unit = ThresholdUnit::percent;
    percent.threshold = 100 * units.threshold / box_diagonal(layer_of(mesh));
    for (const DenoiseMethod method : all_methods) {
        units.method = percent.method = method;
        EXPECT_LE(largest_distance(denoised(mesh, units), denoised(mesh, percent)), 1e-10);
    }
}

TEST(Denoise, RefusesWhatMakesNoSense) {
    const Layer layer = layer_of(shapes::icosphere(4));
    const auto refuses = [&](const auto& change, const Layer& on, const std::string& name) {
        DenoiseOptions options;
        change(options);
        try {
            run(on, options);
            ADD_FAILURE() << name << " was accepted";
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
        }
    };
    for (const double bad : {-1.0, nan_value, std::numeric_limits<double>::infinity()})
        refuses([&](DenoiseOptions& o) { o.threshold = bad; }, layer, "threshold");
    for (const double bad : {-1.0, nan_value, std::numeric_limits<double>::infinity()})
        refuses([&](DenoiseOptions& o) { o.strength = bad; }, layer, "strength");
    refuses([](DenoiseOptions& o) { o.finest_level = -1; }, layer, "finest_level");
    refuses([](DenoiseOptions& o) { o.finest_level = o.coarsest_level = 3; }, layer, "coarsest_level");
    for (const int bad : {0, 65, -3}) refuses([&](DenoiseOptions& o) { o.cycle_spins = bad; }, layer, "cycle_spins");
    refuses([](DenoiseOptions& o) { o.region.selected = true; }, layer, "selected");
    refuses([](DenoiseOptions& o) { o.region.quality_mask = true; }, layer, "quality");
    refuses([](DenoiseOptions& o) { o.confidence = true; }, layer, "quality");
    const Layer bad_quality = with_quality(layer, std::vector<double>(layer.mesh.positions.size(), nan_value));
    refuses([](DenoiseOptions& o) { o.confidence = true; }, bad_quality, "quality");
    Layer no_faces = layer;
    no_faces.mesh.faces.clear();
    refuses([](DenoiseOptions&) {}, no_faces, "face");
    EXPECT_THROW(run(layer_of(shapes::not_finite(nan_value))), InputError);
}

TEST(Denoise, WorksOnEveryClassOfMesh) {
    for (const auto& [name, clean] : every_class())
        for (const double noise : {0.0, 0.15})
            for (const DenoiseMethod method : all_methods) {
                SCOPED_TRACE(name);
                const Mesh mesh = noisy(clean, noise);
                const Result result = run(layer_of(mesh), with(method));
                ASSERT_EQ(result.positions->size(), mesh.positions.size());
                std::vector<bool> used(mesh.positions.size());
                for (const Face& f : mesh.faces)
                    for (const Index v : f) used[v] = true;
                for (std::size_t i = 0; i < used.size(); ++i) {
                    ASSERT_TRUE((*result.positions)[i].allFinite());
                    EXPECT_TRUE(used[i] || (*result.positions)[i] == mesh.positions[i]);
                }
                for (const auto& entry : result.report.entries())
                    if (const auto* value = std::get_if<double>(&entry.value)) {
                        EXPECT_TRUE(std::isfinite(*value)) << entry.key;
                    }
            }
}

TEST(Denoise, WorksOnSoupAndDamage) {
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        SCOPED_TRACE(seed);
        const Mesh mesh = seed % 2 ? random_soup(seed) : damaged_mesh(seed);
        for (const DenoiseMethod method : all_methods) try {
                for (const Vec3& p : denoised(mesh, with(method))) ASSERT_TRUE(p.allFinite());
            } catch (const InputError&) {
                // no face with an area
            }
    }
}

TEST(Denoise, DuplicatedFacesChangeLittle) {
    const Mesh truth = shapes::irregular_sphere(2000);
    Mesh mesh = noisy(truth, 0.2);
    const Error expected = error_of(truth, denoised(mesh));
    mesh.faces.insert(mesh.faces.end(), truth.faces.begin(), truth.faces.begin() + 500);
    EXPECT_LE(error_of(truth, denoised(mesh)).angle, 1.3 * expected.angle);
}

TEST(Denoise, CanBeCancelledAtEveryReport) {
    const Layer layer = layer_of(noisy(shapes::icosphere(6), 0.2));
    for (const DenoiseMethod method : all_methods) {
        DenoiseOptions options = with(method);
        options.cycle_spins = 2;
        int calls = 0, last = 0;
        Session session;
        session.progress = Progress([&](int percent, const char*) {
            ++calls;
            EXPECT_GE(percent, last);
            last = percent;
            return percent >= 0 && percent <= 100;
        });
        denoise(layer, options, session);
        EXPECT_GE(calls, 5);
        for (int stop = 0; stop < calls; ++stop) {
            int left = stop;
            Session stopped;
            stopped.progress = Progress([&](int, const char*) { return left-- > 0; });
            EXPECT_THROW(denoise(layer, options, stopped), Cancelled);
            EXPECT_EQ(left, -1) << "asked again after it was stopped";
        }
    }
}

}  // namespace multires
