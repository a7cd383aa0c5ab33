#include "filters/across_seams.h"

#include "filters/original.h"
#include "filters/reopened.h"
#include "measure/measure.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <utility>

namespace multires {
namespace {

/// The values at some places, one after the other: JoinedVertices::first gives those of the closed mesh,
/// JoinedVertices::joined takes them back to every vertex.
template <class Values>
Values at(const std::vector<Index>& places, const Values& all, std::size_t width = 1) {
    Values out(places.size() * width);
    for (std::size_t k = 0; k < places.size(); ++k)
        std::copy_n(all.begin() + static_cast<std::ptrdiff_t>(places[k] * width), width,
                    out.begin() + static_cast<std::ptrdiff_t>(k * width));
    return out;
}

template <class Values>
Values least(const JoinedVertices& seams, const Values& all) {
    Values out = at(seams.first, all);
    for (std::size_t v = 0; v < all.size(); ++v) out[seams.joined[v]] = std::min(out[seams.joined[v]], all[v]);
    return out;
}

/// Texture coordinates of the vertices as those of the corners.
std::vector<Wedge> by_corners(const Faces& faces, const Attribute& texcoord) {
    std::vector<Wedge> out;
    out.reserve(3 * faces.size());
    for (const Face& f : faces)
        for (const Index v : f)
            out.push_back({texcoord.values[2 * std::size_t(v)], texcoord.values[2 * std::size_t(v) + 1], 0});
    return out;
}

Layer closed(const JoinedVertices& seams, const Layer& layer) {
    Layer out = layer;
    out.mesh.positions = at(seams.first, layer.mesh.positions);
    for (Face& f : out.mesh.faces)
        for (Index& v : f) v = seams.joined[v];
    if (!layer.selected_vertex.empty()) out.selected_vertex = least(seams, layer.selected_vertex);
    for (const Attribute& a : layer.attributes)
        if (a.kind == AttributeKind::texcoord && layer.wedges.empty())
            out.cut_texcoord = by_corners(layer.mesh.faces, a);
    for (Attribute& a : out.attributes)
        a.values = a.kind == AttributeKind::quality ? least(seams, a.values) : at(seams.first, a.values, a.width);
    return out;
}

/// The original of the closed layer, if that of the layer is its own.
std::shared_ptr<const Original> closed_original(const JoinedVertices& seams, const Layer& layer, const Layer& joined,
                                                const std::shared_ptr<const Original>& original) {
    if (!original || !original->includes(layer.mesh)) return original;
    const auto out = std::make_shared<Original>(Mesh{at(seams.first, original->positions()), joined.mesh.faces});
    out->note(joined.mesh.positions, joined.mesh.faces);
    return out;
}

/// Another original for a session, until this ends.
class OwnOriginal {
public:
    OwnOriginal(Session& session, std::shared_ptr<const Original> other)
        : session_(session), own_(std::exchange(session.original, std::move(other))) {}
    ~OwnOriginal() { session_.original = std::move(own_); }
    OwnOriginal(const OwnOriginal&) = delete;
    OwnOriginal& operator=(const OwnOriginal&) = delete;

private:
    Session& session_;
    std::shared_ptr<const Original> own_;
};

/// The layers of a call, with the seams of the current one closed in all of them.
class ClosedInputs {
public:
    ClosedInputs(const Inputs& inputs, const ClosedLayer& closed) : closed_(closed), inputs_{closed.layer} {
        found_[&inputs.current] = &closed.layer;
        for (const Layer* other : inputs.others) {
            const Layer*& found = found_[other];
            if (!found) found = closed_one(*other, inputs.current);
            inputs_.others.push_back(found);
        }
    }
    const Inputs& inputs() const { return inputs_; }

private:
    const Layer* closed_one(const Layer& other, const Layer& current) {
        if (other.mesh.positions.size() == current.mesh.positions.size() && other.mesh.faces == current.mesh.faces)
            return &made_.emplace_back(closed(closed_.seams, other));
        const auto is_source = [](const Attribute& a) { return a.name == source_vertex_name && a.width == 1; };
        if (std::none_of(other.attributes.begin(), other.attributes.end(), is_source)) return &other;
        Layer& out = made_.emplace_back(other);
        for (Attribute& a : out.attributes)
            if (is_source(a))
                for (double& v : a.values)
                    if (v >= 0 && v < static_cast<double>(closed_.seams.joined.size()) && v == std::floor(v))
                        v = closed_.seams.joined[static_cast<std::size_t>(v)];
        return &out;
    }

    const ClosedLayer& closed_;
    std::deque<Layer> made_;
    std::map<const Layer*, const Layer*> found_;  ///< a layer that is named twice is one
    Inputs inputs_;
};

/// Where the vertices of the layer are after the filter; null if it does not say so of all.
const Positions* places_after(const Layer& layer, const Result& result) {
    if (result.positions) return &*result.positions;
    const bool all =
        result.layer && result.layer->positions && result.layer->positions->size() == layer.mesh.positions.size();
    return all ? &*result.layer->positions : nullptr;
}

/// The report on the closed layer as one on the layer itself, which has more vertices.
/// @param more  vertices that it has
Report with_all_vertices(const Layer& layer, int more, const Result& result) {
    Report out;
    for (const std::string& line : result.report.lines()) out.say(line);
    const Positions* const after = places_after(layer, result);
    for (Report::Entry e : result.report.entries()) {
        if (e.key == "rms_displacement" && after) e.value = displacement(layer.mesh.positions, *after).rms;
        if (e.key == "duplicate_vertices") e.value = std::get<int>(e.value) + more;
        if (e.key == "vertices" && result.layer) e.value = static_cast<int>(result.layer->source_vertex.size());
        out.add(e.key, e.value, e.unit);
    }
    out.say(std::to_string(more) + " vertices along seams were taken for one with those at the same place.");
    return out;
}

std::shared_ptr<const ClosedLayer> closed_by(JoinedVertices seams, const Layer& layer) {
    if (seams.first.empty()) return nullptr;
    auto out = std::make_shared<ClosedLayer>();
    out->layer = closed(seams, layer);
    out->seams = std::move(seams);
    return out;
}

}  // namespace

std::shared_ptr<const ClosedLayer> close_seams(const Layer& layer) { return closed_by(join_seams(layer.mesh), layer); }

std::shared_ptr<const ClosedLayer> open_where_values_differ(const Layer& layer,
                                                            const std::shared_ptr<const ClosedLayer>& closed,
                                                            const std::vector<std::size_t>& attributes) {
    if (!closed) return nullptr;
    JoinedVertices alike = join_seams_where_alike(layer, closed->seams, attributes);
    return alike.first.size() == closed->seams.first.size() ? closed : closed_by(std::move(alike), layer);
}

Result across_seams(const Inputs& inputs, const ClosedLayer* closed, Session& session,
                    const std::function<Result(const Inputs&)>& filter) {
    if (!closed) return filter(inputs);
    const Layer& layer = inputs.current;
    const JoinedVertices& seams = closed->seams;
    Result result = [&] {
        const OwnOriginal meanwhile(session, closed_original(seams, layer, closed->layer, session.original));
        return filter(ClosedInputs(inputs, *closed).inputs());
    }();
    if (result.positions) {
        Positions all = at(seams.joined, *result.positions);
        for (std::size_t v = 0; v < all.size(); ++v)  // 0 and -0 are one place
            if (all[v] == layer.mesh.positions[v]) all[v] = layer.mesh.positions[v];
        result.positions = std::move(all);
    }
    if (result.quality) result.quality = at(seams.joined, *result.quality);
    for (Attribute& a : result.attributes) a.values = at(seams.joined, a.values, a.width);
    if (result.selected_vertex) result.selected_vertex = at(seams.joined, *result.selected_vertex);
    if (result.layer) result.layer = reopened(layer, *closed, std::move(*result.layer));
    const auto more = static_cast<int>(seams.joined.size() - seams.first.size());
    result.report = with_all_vertices(layer, more, result);
    return result;
}

}  // namespace multires
