#include "filters/original.h"

#include "filter_fixtures.h"
#include "filters/shape/denoise.h"

namespace multires {

using namespace fixtures;

namespace {

/// A layer in a host that keeps what a session leaves.
class Document {
public:
    explicit Document(Layer start) : layer(std::move(start)) {}

    template <class Options>
    Result run(Result (*filter)(const Layer&, const Options&, Session&), const Options& options) {
        Session session;
        session.pyramids = pyramids_;
        session.original = original_;
        Result result = filter(layer, options, session);
        pyramids_ = session.pyramids;
        original_ = original_after(original_.get(), layer.mesh, *result.positions);
        layer.mesh.positions = *result.positions;
        return result;
    }

    Layer layer;

private:
    PyramidCache pyramids_;
    std::shared_ptr<const Original> original_;
};

Layer scan() { return layer_of(shapes::scan(2000)); }

LowPassOptions some_low_pass(RelativeTo relative_to = RelativeTo::current) {
    LowPassOptions o;
    o.unit = Unit::level;
    o.cutoff = 6;
    o.relative_to = relative_to;
    return o;
}

EqualizerOptions equal(double gain, RelativeTo relative_to = RelativeTo::original) {
    EqualizerOptions o;
    o.gain.fill(gain);
    o.relative_to = relative_to;
    return o;
}

/// Changes of every kind that moves vertices.
void change_in_many_ways(Document& document) {
    document.run(low_pass, some_low_pass());
    document.run(equalizer, equal(1.5, RelativeTo::current));
    BandOptions band;
    band.band = {Unit::level, 2, 8, 0.5};
    band.gain = 3;
    document.run(scale_band, band);
    document.run(unsharp, UnsharpOptions());
    document.run(denoise, DenoiseOptions());
    document.run(equalizer, equal(0.5));
}

}  // namespace

TEST(Original, GainsOfOneBringItBackBitForBitAfterManyChanges) {
    Document document(scan());
    const Positions before = document.layer.mesh.positions;
    change_in_many_ways(document);
    ASSERT_NE(document.layer.mesh.positions, before);
    const Result back = document.run(equalizer, equal(1));
    EXPECT_EQ(*back.positions, before);
    EXPECT_GT(number(back.report, "largest_displacement"), 0) << "this call moved the vertices back";

    change_in_many_ways(document);
    BandOptions band;
    band.band = {Unit::level, 0, 5, 0};
    band.gain = 1;
    band.relative_to = RelativeTo::original;
    EXPECT_EQ(*document.run(scale_band, band).positions, before);

    change_in_many_ways(document);
    UnsharpOptions nothing;
    nothing.xi = 1;
    nothing.relative_to = RelativeTo::original;
    EXPECT_EQ(*document.run(unsharp, nothing).positions, before);

    for (const DenoiseMethod method :
         {DenoiseMethod::normal_field, DenoiseMethod::soft_threshold, DenoiseMethod::hard_threshold}) {
        change_in_many_ways(document);
        DenoiseOptions none;
        none.method = method;
        none.strength = 0;
        none.keep_volume = true;
        none.relative_to = RelativeTo::original;
        EXPECT_EQ(*document.run(denoise, none).positions, before);
    }
}

TEST(Original, AFilterRelativeToItIsThatFilterOnIt) {
    const Layer layer = scan();
    Session session;
    DenoiseOptions threshold;
    threshold.method = DenoiseMethod::soft_threshold;
    threshold.keep_volume = true;
    LowPassOptions percent;
    percent.unit = Unit::wavelength_percent;
    percent.cutoff = 9;
    EqualizerOptions bands;
    bands.gain = {0, 2, 1, 1, 0.5, 1, 1, 3};
    const auto check = [&](auto filter, auto options) {
        Document document(layer);
        change_in_many_ways(document);
        options.relative_to = RelativeTo::original;
        EXPECT_EQ(*document.run(filter, options).positions, *filter(layer, options, session).positions);
    };
    check(low_pass, percent);
    check(equalizer, bands);
    check(scale_band, [] {
        BandOptions o;
        o.band = {Unit::vertices, 1500, 300, 0};
        return o;
    }());
    check(unsharp, UnsharpOptions());
    check(denoise, DenoiseOptions());
    check(denoise, threshold);
}

TEST(Original, AMeshThatNoFilterMovedIsItsOwn) {
    Document document(scan());
    const Positions before = document.layer.mesh.positions;
    const Result result = document.run(low_pass, some_low_pass(RelativeTo::original));
    Session session;
    EXPECT_EQ(*result.positions,
              *low_pass(layer_of({before, document.layer.mesh.faces}), some_low_pass(), session).positions);
    ASSERT_EQ(result.report.lines().size(), 1u);
    EXPECT_NE(result.report.lines()[0].find("its own original"), std::string::npos);
    EXPECT_EQ(*document.run(equalizer, equal(1)).positions, before) << "and it stays the original";
}

TEST(Original, ThePyramidOfTheOriginalIsUsedAgain) {
    Document document(scan());
    document.run(low_pass, some_low_pass());
    for (const double gain : {0.5, 2.0, 1.0})
        EXPECT_TRUE(value<bool>(document.run(equalizer, equal(gain)).report, "pyramid_reused"));
    document.run(equalizer, equal(2));
    EXPECT_FALSE(value<bool>(document.run(low_pass, some_low_pass()).report, "pyramid_reused"));
}

TEST(Original, OnlyTheRegionGoesBackToIt) {
    Document document(scan());
    const Positions before = document.layer.mesh.positions;
    change_in_many_ways(document);
    const Positions changed = document.layer.mesh.positions;
    std::vector<double> quality(before.size());
    document.layer.selected_vertex.assign(before.size(), 0);
    for (std::size_t i = 0; i < before.size(); ++i) {
        document.layer.selected_vertex[i] = before[i].x() > 0;
        quality[i] = i % 2 ? 1 : 0.25;
    }
    EqualizerOptions o = equal(1);
    o.region.selected = true;
    const Positions selected = *document.run(equalizer, o).positions;
    for (std::size_t i = 0; i < before.size(); ++i) EXPECT_EQ(selected[i], before[i].x() > 0 ? before[i] : changed[i]);

    document.layer.mesh.positions = changed;
    document.layer = with_quality(document.layer, quality);
    o.region.quality_mask = true;
    const Positions masked = *document.run(equalizer, o).positions;
    for (std::size_t i = 0; i < before.size(); ++i) {
        const double w = before[i].x() > 0 ? quality[i] : 0;
        EXPECT_LE((masked[i] - (changed[i] + w * (before[i] - changed[i]))).norm(), 1e-15);
        if (w == 0) {
            EXPECT_EQ(masked[i], changed[i]);
        }
    }
    // The original is still the whole of it.
    document.layer.selected_vertex.clear();
    EXPECT_EQ(*document.run(equalizer, equal(1)).positions, before);
}

TEST(Original, IsGoneWhenSomethingElseChangesTheMesh) {
    const auto changes = {
        +[](Mesh& m) { m.positions[7].z() += 1e-9; },  // another filter
        +[](Mesh& m) {
            for (Vec3& p : m.positions) p *= 2;
        },                                                    // a transformation
        +[](Mesh& m) { m.faces.pop_back(); },                 // a hole
        +[](Mesh& m) { m.positions.emplace_back(0, 0, 0); },  // a vertex more
        +[](Mesh& m) { std::swap(m.faces[0][0], m.faces[0][1]); },
    };
    for (const auto change : changes) {
        Document document(scan());
        document.run(low_pass, some_low_pass());
        const Mesh before = document.layer.mesh;
        change(document.layer.mesh);
        const Mesh changed = document.layer.mesh;
        try {
            document.run(equalizer, equal(1));
            FAIL() << "the change is lost";
        } catch (const InputError& e) {
            EXPECT_NE(std::string(e.what()).find("relative_to"), std::string::npos);
        }
        // Taken back, it does not count.
        document.layer.mesh = before;
        EXPECT_NO_THROW(document.run(equalizer, equal(2)));
        // Filtered as it is, the changed mesh is the new original.
        document.layer.mesh = changed;
        document.run(low_pass, some_low_pass());
        EXPECT_EQ(*document.run(equalizer, equal(1)).positions, changed.positions);
    }
}

// A preview computes again and again from the same shape, and a cancel brings that back.
TEST(Original, StaysThroughPreviews) {
    Document document(scan());
    const Positions before = document.layer.mesh.positions;
    document.run(low_pass, some_low_pass());
    const Positions applied = document.layer.mesh.positions;
    for (const double gain : {0.2, 0.4, 0.6}) {
        document.run(equalizer, equal(gain, RelativeTo::current));
        document.layer.mesh.positions = applied;
    }
    EXPECT_EQ(*document.run(equalizer, equal(1)).positions, before);
}

}  // namespace multires
