#include "filters/editing/followed.h"

#include "base/hash.h"
#include "base/parallel.h"
#include "base/reduce.h"
#include "editing/gradient_domain.h"
#include "filters/editing/bases.h"
#include "pyramid/pyramid.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace multires {
namespace {

/// The distance that a tenth of the vertices keep within.
double nearest_tenth(const Array<Foot>& feet) {
    std::vector<double> squared(feet.size());
    for (std::size_t i = 0; i < feet.size(); ++i) squared[i] = feet[i].squared;
    const auto at = squared.begin() + static_cast<std::ptrdiff_t>(squared.size() / 10);
    std::nth_element(squared.begin(), at, squared.end());
    return std::sqrt(*at);
}

/// RMS distance to the proxy.
double distance_of(const Array<Foot>& feet) {
    return chunked_fold<Lengths>(feet.size(), [&](Lengths& part, std::size_t i) { part.add(feet[i].squared); }).rms();
}

/// Of a mesh with so many times more vertices than the proxy. Averages over a fifth of the proxy's edges; beyond 8
/// steps nothing is gained.
GradientDomainOptions gradient_options(double vertices, double proxy_vertices) {
    GradientDomainOptions options;
    options.smoothing = static_cast<int>(std::clamp(std::round(0.2 * vertices / proxy_vertices), 1.0, 8.0));
    return options;
}

/// One solve.
class Solver {
public:
    Solver(const Layer& layer, const TransferEditOptions& options, const FoundProxy& found, Session& session,
           Report& report, FollowedEdit& edit)
        : layer_(layer), options_(options), found_(found), session_(session), report_(report), edit_(edit) {}

    void solve() {
        const Progress whole = session_.progress;
        gradients_ = displacement_gradients(found_.proxy());
        feet_ = feet_of(layer_.mesh.positions, found_.faces, found_.before, whole.part(0.1, 0.4));
        require_near(layer_, found_, nearest_tenth(feet_));
        edit_.distance = distance_of(feet_);
        Motion motion = motion_at(layer_.mesh.positions, feet_, found_.proxy(), gradients_);
        session_.progress = whole.part(0.4, 1);
        if (options_.encoding == Encoding::gradient) by_gradients(motion);
        if (options_.encoding == Encoding::frames) by_frames();
        if (options_.encoding == Encoding::phong) options_.bands == 1 ? over_proxy() : over_bases();
        session_.progress = whole;
        edit_.gradient = std::move(motion.gradient);
    }

private:
    void by_gradients(Motion& motion) {
        const GradientDomainOptions how = gradient_options(static_cast<double>(layer_.mesh.positions.size()),
                                                           static_cast<double>(found_.before.size()));
        edit_.shape = gradient_domain(layer_.mesh, motion, how, session_.progress);
        parallel_for(static_cast<Index>(edit_.shape.size()), [&](Index i) {
            Vec3& x = edit_.shape[i];
            const Vec3& p = layer_.mesh.positions[i];
            x = x == Vec3::Zero() ? p : Vec3(p + x);
        });
    }

    void by_frames() {
        const auto pyramid = pyramid_of(layer_, options_.pyramid, session_, report_);
        const std::size_t level = nearest_level(pyramid->hierarchy(), found_.before.size());
        edit_.shape = carried(positions_of(pyramid->scheme().synthesise(pyramid->coefficients(), down_to(level))));
    }

    /// Where the motion of the proxy takes a shape of the layer.
    Positions carried(Positions shape) const {
        const Array<Foot> feet = feet_of(shape, found_.faces, found_.before, session_.progress.part(0.8, 0.9));
        const Motion motion = motion_at(shape, feet, found_.proxy(), gradients_);
        for (std::size_t i = 0; i < shape.size(); ++i) shape[i] += motion.displacement[i];
        return shape;
    }

    /// Every vertex over its base point on the proxy.
    void over_proxy() {
        const PhongSurface before(found_.faces, found_.before), after(found_.faces, found_.after);
        Array<Index> starts(feet_.size());
        for (std::size_t i = 0; i < feet_.size(); ++i) starts[i] = feet_[i].face;
        const BasePoints found = base_points(before, layer_.mesh.positions, starts, session_.progress);
        edit_.border = found.border, edit_.nearest = found.nearest;
        for (Positions* p : {&edit_.shape, &edit_.detail, &edit_.turned}) p->resize(feet_.size());
        parallel_for(static_cast<Index>(feet_.size()), [&](Index i) {
            const BasePoint& b = found.points[i];
            edit_.shape[i] = after.base(b.face, b.weight);
            edit_.detail[i] = layer_.mesh.positions[i] - before.base(b.face, b.weight);
            edit_.turned[i] = after.place(b) - edit_.shape[i];
        });
    }

    /// How many vertices of the layer a base leaves where they are.
    Index kept_by(const Positions& base) const {
        Index count = 0;
        for (std::size_t i = 0; i < base.size(); ++i) count += base[i] == layer_.mesh.positions[i];
        return count;
    }

    /// A smooth base moves, and bands of detail follow.
    void over_bases() {
        const Progress whole = session_.progress;
        session_.progress = whole.part(0, 0.2);
        const auto pyramid = pyramid_of(layer_, options_.pyramid, session_, report_);
        session_.progress = whole;
        const Hierarchy& h = pyramid->hierarchy();
        // A smooth base of this layer has all its vertices: it is the coarsest one, and edited by hand.
        const bool own = found_.before.size() == layer_.mesh.positions.size() && found_.faces == layer_.mesh.faces;
        const auto coarsest = std::clamp(own ? kept_by(found_.before) : static_cast<Index>(found_.before.size()),
                                         h.size.back(), h.vertices());
        edit_.kept = kept_by_bases(*pyramid, BandLevels::ratio, options_.bands - 1, coarsest);
        edit_.bands =
            multiband_of(layer_.mesh, *pyramid, edit_.kept, own ? &found_.before : nullptr, whole.part(0.2, 0.8));
        edit_.shape = own ? found_.after : carried(edit_.bands->coarsest());
    }

    const Layer& layer_;
    const TransferEditOptions& options_;
    const FoundProxy& found_;
    Session& session_;
    Report& report_;
    FollowedEdit& edit_;
    Array<Mat3> gradients_;  // of the proxy
    Array<Foot> feet_;       // of the layer's vertices
};

}  // namespace

std::size_t FollowedEdit::bytes() const {
    return sizeof *this + text.capacity() + gradient.capacity() * sizeof(Mat3) + kept.capacity() * sizeof(Index) +
           (shape.capacity() + detail.capacity() + turned.capacity()) * sizeof(Vec3) + (bands ? bands->bytes() : 0);
}

ContentHash followed_hash(const Inputs& inputs, const TransferEditOptions& options) {
    const Layer& layer = inputs.current;
    const Layer& edited = inputs.other(options.edited, "edited");
    const Layer& before = inputs.other(options.before, "before");
    Hash hash;
    hash.add(std::array<int, 5>{static_cast<int>(IntermediateKind::followed_edit), static_cast<int>(options.encoding),
                                options.bands, &before == &edited, &before == &layer});
    hash.add(content_hash(layer, options.pyramid));
    hash.add(layer.to_world.data(), sizeof layer.to_world);
    for (const Layer* other : {&edited, &before}) {
        hash.add(shape_hash(other->mesh.positions, other->mesh.faces));
        hash.add(other->to_world.data(), sizeof other->to_world);
        for (const Attribute& a : other->attributes) {
            if (a.name != source_vertex_name) continue;
            hash.add(std::array<std::uint64_t, 2>{static_cast<std::uint64_t>(a.width), a.values.size()});
            hash.add(a.values);
        }
    }
    return hash.bits128();
}

std::shared_ptr<const FollowedEdit> solve_edit(const Layer& layer, const TransferEditOptions& options,
                                               const FoundProxy& found, const ContentHash& hash, Session& session,
                                               Report& report) {
    const ContentHash shape = shape_hash(layer.mesh.positions, layer.mesh.faces);
    session.intermediates.make_room(shape);
    const auto edit = std::make_shared<FollowedEdit>(hash, shape);
    edit->way = found.way;
    edit->text = found.text;
    edit->unchanged = found.unchanged;
    edit->proxy_vertices = found.before.size();
    Solver(layer, options, found, session, report, *edit).solve();
    session.intermediates.put(edit);
    return edit;
}

}  // namespace multires
