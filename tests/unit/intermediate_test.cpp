#include "filters/intermediate.h"

#include "filter_fixtures.h"
#include "filters/editing/bands.h"
#include "filters/editing/move_region.h"
#include "filters/editing/transfer_edit.h"
#include "filters/layers/levels.h"

#include <functional>

// What filters keep with a layer for the next call: previews need not wait, and nothing stale is used.

namespace multires {
namespace {

using fixtures::layer_of;

/// Calls a filter with a session that goes on and with a new one: the results must be the same, bit for bit.
class Twice {
public:
    Positions operator()(const std::function<Result(Session&)>& call) {
        const auto newest = this->newest();
        Session fresh;
        const Positions expected = *call(fresh).positions, found = *call(going_on).positions;
        EXPECT_EQ(found, expected);
        reused = newest && newest == this->newest();
        std::size_t sum = 0, largest = 0;
        for (const auto& p : going_on.intermediates.all()) sum += p->bytes(), largest = std::max(largest, p->bytes());
        EXPECT_LE(sum, 2 * largest);
        return found;
    }

    Session going_on;
    bool reused = false;  ///< by the last call

private:
    std::shared_ptr<const Intermediate> newest() const {
        const auto& all = going_on.intermediates.all();
        return all.empty() ? nullptr : all.front();
    }
};

/// A scan, a proxy, and the proxy moved.
struct Edit {
    Layer layer = layer_of(shapes::scan(2000, {0.2, 0.3, 5}));
    Layer before = layer_of(shapes::irregular_sphere(300)), edited = before;
    TransferEditOptions options;

    Edit() {
        for (Vec3& p : edited.mesh.positions) p.x() += 0.3 * p.z() * p.z();
        options.before.place = 0, options.edited.place = 1;
    }
    Result operator()(Session& session) const { return transfer_edit({layer, {&before, &edited}}, options, session); }
};

}  // namespace

TEST(Intermediate, OfAFollowedEditServesEveryGainAndWhatBecomesOfDetails) {
    for (const auto& [encoding, bands] :
         {std::pair(Encoding::gradient, 5), {Encoding::frames, 5}, {Encoding::phong, 1}, {Encoding::phong, 3}}) {
        Edit edit;
        edit.options.encoding = encoding, edit.options.bands = bands;
        Twice twice;
        twice(std::cref(edit));
        EXPECT_FALSE(twice.reused);
        for (const auto details : {DetailsFollow::multiresolution, DetailsFollow::single, DetailsFollow::none})
            for (const double gain : {1.0, 2.0, 0.5}) {
                edit.options.details = details, edit.options.gain = gain;
                twice(std::cref(edit));
            }
        EXPECT_TRUE(twice.reused);
    }
}

TEST(Intermediate, OfAFollowedEditIsNotUsedAfterAnyChangeOfTheLayers) {
    Edit edit;
    Twice twice;
    Positions last = twice(std::cref(edit));
    const auto changed = [&](const char* what) {
        SCOPED_TRACE(what);
        const Positions now = twice(std::cref(edit));
        EXPECT_FALSE(twice.reused);
        EXPECT_NE(now, last);
        last = now;
        twice(std::cref(edit));
        EXPECT_TRUE(twice.reused);
    };
    edit.edited.mesh.positions[7].y() += 0.1;
    changed("a vertex of the edited proxy");
    edit.before.mesh.positions[7].y() += 0.1;
    changed("a vertex of the proxy before");
    edit.edited.to_world(0, 3) = 0.5;
    changed("the place of the edited proxy");
    edit.layer.to_world(1, 3) = 0.1, edit.before.to_world(1, 3) = 0.05;
    changed("the place of the layer");
    edit.layer.mesh.positions[11] *= 1.001;
    changed("a vertex of the layer");
    edit.options.encoding = Encoding::phong;
    changed("the encoding");
    edit.options.bands = 3;
    changed("the bands");
    edit.options.pyramid.hierarchy.sets_per_level = 1;
    changed("the pyramid");
}

TEST(Intermediate, OfALevelIsNotUsedAfterAChangeOfItsSourceVertices) {
    Edit edit;
    edit.layer = layer_of(shapes::irregular_sphere(500));
    edit.edited.mesh = edit.layer.mesh;
    for (Vec3& p : edit.edited.mesh.positions) p.x() += 0.3 * p.z() * p.z();
    edit.edited.mesh.faces.pop_back();  // not the connectivity of the layer
    edit.options.before = edit.options.edited;
    Attribute source{AttributeKind::scalar, source_vertex_name, 1, {}};
    for (std::size_t v = 0; v < edit.edited.mesh.positions.size(); ++v) source.values.push_back(static_cast<double>(v));
    edit.edited.attributes = {source};
    Twice twice;
    const Positions first = twice(std::cref(edit));
    EXPECT_NE(first, edit.layer.mesh.positions);
    std::swap(edit.edited.attributes[0].values[0], edit.edited.attributes[0].values[1]);
    EXPECT_NE(twice(std::cref(edit)), first);
    EXPECT_FALSE(twice.reused);
}

TEST(Intermediate, OfAMovedRegionServesEveryMotion) {
    Layer layer = layer_of(shapes::scan(3000, {0.2, 0.3, 5}));
    for (const Vec3& p : layer.mesh.positions) layer.selected_vertex.push_back(p.z() > 0.7);
    MoveRegionOptions options;
    options.between.falloff = 1;
    Twice twice;
    const auto call = [&](Session& session) { return move_region(layer, options, session); };
    Positions last = twice(call);
    for (const double angle : {10, 20, 30}) {
        options.angle = angle;
        const Positions now = twice(call);
        EXPECT_NE(now, last);
        EXPECT_EQ(twice.reused, angle > 10) << "details need not follow a motion that is none";
        last = now;
    }
    const auto changed = [&](const char* what) {
        SCOPED_TRACE(what);
        const Positions now = twice(call);
        EXPECT_FALSE(twice.reused);
        EXPECT_NE(now, last);
        last = now;
    };
    layer.selected_vertex[100] = !layer.selected_vertex[100];
    changed("the selection");
    options.between.falloff = 0.9;
    changed("the falloff");
    options.details_follow = false;
    changed("details");
    layer.mesh.positions[5] *= 1.01;
    changed("the shape");
}

TEST(Intermediate, OfBandsServesEveryGain) {
    const Layer layer = layer_of(shapes::scan(1500, {0.2, 0.3, 5}));
    BandsOptions options;
    options.bands = 3, options.vertices = 150;
    Twice twice;
    const auto call = [&](Session& session) { return apply_bands(layer, options, session); };
    Positions last = twice(call);
    for (const double gain : {0.5, 3.0}) {
        options.gain[0] = gain;
        const Positions now = twice(call);
        EXPECT_TRUE(twice.reused);
        EXPECT_NE(now, last);
        last = now;
    }
    options.vertices = 200;
    EXPECT_NE(twice(call), last);
    EXPECT_FALSE(twice.reused);
}

}  // namespace multires
