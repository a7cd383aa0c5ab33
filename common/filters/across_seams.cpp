#include "filters/across_seams.h"

#include "filters/original.h"
#include "measure/measure.h"
#include "mesh/seams.h"

#include <algorithm>
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

Layer closed(const JoinedVertices& seams, const Layer& layer) {
    Layer out = layer;
    out.mesh.positions = at(seams.first, layer.mesh.positions);
    for (Face& f : out.mesh.faces)
        for (Index& v : f) v = seams.joined[v];
    if (!layer.selected_vertex.empty()) out.selected_vertex = least(seams, layer.selected_vertex);
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

/// The mean over the vertices, which the closed layer has fewer of.
Report with_mean_of_all(const Report& of_closed, const Positions& before, const Positions& after) {
    Report out;
    for (const std::string& line : of_closed.lines()) out.say(line);
    for (const Report::Entry& e : of_closed.entries()) {
        const bool mean = e.key == "rms_displacement";
        out.add(e.key, mean ? Report::Value(displacement(before, after).rms) : e.value, e.unit);
    }
    return out;
}

}  // namespace

std::optional<Layer> closed_layer(const Layer& layer) {
    const JoinedVertices seams = join_seams(layer.mesh);
    if (seams.first.empty()) return std::nullopt;
    return closed(seams, layer);
}

Result across_seams(const Layer& layer, Session& session, const std::function<Result(const Layer&)>& filter) {
    const JoinedVertices seams = join_seams(layer.mesh);
    if (seams.first.empty()) return filter(layer);
    const Layer joined = closed(seams, layer);
    Result result = [&] {
        const OwnOriginal meanwhile(session, closed_original(seams, layer, joined, session.original));
        return filter(joined);
    }();
    if (result.positions) {
        Positions all = at(seams.joined, *result.positions);
        for (std::size_t v = 0; v < all.size(); ++v)  // 0 and -0 are one place
            if (all[v] == layer.mesh.positions[v]) all[v] = layer.mesh.positions[v];
        result.report = with_mean_of_all(result.report, layer.mesh.positions, all);
        result.positions = std::move(all);
    }
    if (result.quality) result.quality = at(seams.joined, *result.quality);
    for (Attribute& a : result.attributes) a.values = at(seams.joined, a.values, a.width);
    if (result.selected_vertex) result.selected_vertex = at(seams.joined, *result.selected_vertex);
    result.report.say(std::to_string(layer.mesh.positions.size() - joined.mesh.positions.size()) +
                      " vertices along seams were taken for one with those at the same place.");
    return result;
}

}  // namespace multires
