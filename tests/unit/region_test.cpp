#include "filters/region.h"

#include "filter_fixtures.h"

#include <functional>

namespace multires {

using namespace fixtures;

namespace {

const Layer& layer() {
    static const Layer l = layer_of(shapes::scan(1000));
    return l;
}

/// Every filter that moves vertices, told where to act.
std::vector<std::pair<std::string, std::function<Positions(const Layer&, const Region&, Session&)>>> movers() {
    return {{"low pass",
             [](const Layer& l, const Region& region, Session& session) {
                 LowPassOptions o;
                 o.cutoff = default_cutoff(l, o.unit);
                 o.region = region;
                 return *low_pass(l, o, session).positions;
             }},
            {"band",
             [](const Layer& l, const Region& region, Session& session) {
                 BandOptions o;
                 o.band = default_band(l, Unit::wavelength);
                 o.gain = 2;
                 o.region = region;
                 return *scale_band(l, o, session).positions;
             }},
            {"equalizer",
             [](const Layer& l, const Region& region, Session& session) {
                 EqualizerOptions o;
                 o.gain[0] = o.gain[3] = 0;
                 o.region = region;
                 return *equalizer(l, o, session).positions;
             }},
            {"unsharp", [](const Layer& l, const Region& region, Session& session) {
                 UnsharpOptions o;
                 o.region = region;
                 return *unsharp(l, o, session).positions;
             }}};
}

Positions moved(const std::function<Positions(const Layer&, const Region&, Session&)>& filter, const Layer& l,
                const Region& region) {
    Session session;
    return filter(l, region, session);
}

}  // namespace

TEST(Region, LeavesUnselectedVerticesToTheLastBit) {
    Layer selected = layer();
    selected.selected_vertex.assign(layer().mesh.positions.size(), 0);
    for (std::size_t v = 0; v < selected.selected_vertex.size(); v += 3) selected.selected_vertex[v] = 1;
    selected.selected_face.assign(layer().mesh.faces.size(), 0);
    for (std::size_t f = 0; f < 40; ++f) selected.selected_face[f] = 1;
    std::vector<bool> inside(layer().mesh.positions.size());
    for (std::size_t v = 0; v < inside.size(); ++v) inside[v] = v % 3 == 0;
    for (std::size_t f = 0; f < 40; ++f)
        for (const Index v : layer().mesh.faces[f]) inside[v] = true;
    for (const auto& [name, filter] : movers()) {
        SCOPED_TRACE(name);
        const Positions all = moved(filter, selected, {}), part = moved(filter, selected, {true, false});
        EXPECT_GT(largest_distance(all, layer().mesh.positions), 1e-4);
        for (std::size_t v = 0; v < inside.size(); ++v)
            EXPECT_EQ(part[v], inside[v] ? all[v] : layer().mesh.positions[v]);
    }
}

TEST(Region, QualityScalesTheEffect) {
    const std::size_t n = layer().mesh.positions.size();
    const double values[] = {0, 1, 0.5, -3, 7};
    std::vector<double> quality(n);
    for (std::size_t v = 0; v < n; ++v) quality[v] = values[v % 5];
    const Layer masked = with_quality(layer(), quality);
    for (const auto& [name, filter] : movers()) {
        SCOPED_TRACE(name);
        const Positions all = moved(filter, masked, {}), part = moved(filter, masked, {false, true});
        for (std::size_t v = 0; v < n; ++v) {
            const Vec3& p = layer().mesh.positions[v];
            const double weight = std::clamp(quality[v], 0.0, 1.0);
            const Vec3 expected = weight == 0.5 ? Vec3((p + all[v]) / 2) : weight == 0 ? p : all[v];
            EXPECT_LE((part[v] - expected).norm(), weight == 0.5 ? 1e-15 : 0);
        }
    }
}

TEST(Region, SelectionAndQualityMultiply) {
    Layer both = with_quality(layer(), std::vector<double>(layer().mesh.positions.size(), 0.25));
    both.selected_vertex.assign(layer().mesh.positions.size(), 0);
    both.selected_vertex[4] = 1;
    const std::vector<double> weights = region_weights(both, {true, true});
    for (std::size_t v = 0; v < weights.size(); ++v) EXPECT_EQ(weights[v], v == 4 ? 0.25 : 0);
    EXPECT_TRUE(region_weights(both, {}).empty());
}

TEST(Region, RefusesWhatIsNotThere) {
    Layer broken = with_quality(layer(), std::vector<double>(layer().mesh.positions.size(), 1));
    broken.attributes[0].values[7] = std::numeric_limits<double>::quiet_NaN();
    for (const auto& [name, filter] : movers()) {
        SCOPED_TRACE(name);
        EXPECT_THROW(moved(filter, layer(), {true, false}), InputError);
        EXPECT_THROW(moved(filter, layer(), {false, true}), InputError);
        EXPECT_THROW(moved(filter, broken, {false, true}), InputError);
    }
}

TEST(Region, FiltersRefuseMeshesTheyCannotWorkOn) {
    const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
    Mesh flat = shapes::triangle(), points = shapes::scan(100);
    for (Vec3& p : flat.positions) p = Vec3(1, 2, 3);
    points.faces.clear();
    for (const Mesh& mesh : {Mesh(), points, flat, shapes::not_finite(nan), shapes::not_finite(inf),
                             Mesh{shapes::triangle().positions, {{0, 1, 1}, {2, 2, 2}}}})
        for (const auto& [name, filter] : movers()) {
            SCOPED_TRACE(name);
            EXPECT_THROW(moved(filter, layer_of(mesh), {}), InputError);
        }
}

TEST(Progress, EveryCancelStopsAndLeavesAUsefulSession) {
    for (const auto& [name, filter] : movers()) {
        SCOPED_TRACE(name);
        Session quiet;
        const Positions expected = filter(layer(), {}, quiet);
        std::vector<int> percents;
        Session counting;
        counting.progress = Progress([&](int percent, const char* what) {
            EXPECT_TRUE(what && *what);
            percents.push_back(percent);
            return true;
        });
        filter(layer(), {}, counting);
        EXPECT_TRUE(std::is_sorted(percents.begin(), percents.end()));
        EXPECT_TRUE(percents.front() >= 0 && percents.back() <= 100);
        ASSERT_GE(percents.size(), 3u);
        for (std::size_t stop = 0; stop < percents.size(); ++stop) {
            Session session;
            std::size_t calls = 0;
            session.progress = Progress([&](int, const char*) { return calls++ != stop; });
            EXPECT_THROW(filter(layer(), {}, session), Cancelled) << "call " << stop;
            EXPECT_EQ(calls, stop + 1) << "asked again after the cancel";
            session.progress = Progress();
            EXPECT_EQ(filter(layer(), {}, session), expected) << "after a cancel at call " << stop;
        }
    }
}

TEST(Progress, ACancelledBuildKeepsThePyramidsOfTheShape) {
    Session session;
    Report report;
    const auto old = pyramid_of(layer(), {}, session, report);
    session.progress = Progress([](int, const char*) { return false; });
    EXPECT_THROW(pyramid_of(layer(), fine_levels(), session, report), Cancelled);
    EXPECT_EQ(session.pyramids.all().front(), old);
}

}  // namespace multires
