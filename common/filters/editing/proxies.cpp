#include "filters/editing/proxies.h"

#include "base/number.h"
#include "editing/wrap.h"
#include "filters/editing/transfer_edit.h"
#include "filters/placement.h"
#include "hierarchy/hierarchy.h"
#include "measure/measure.h"
#include "mesh/validation.h"
#include "pyramid/pyramid.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace multires {
namespace {

std::string counts(const Mesh& mesh) {
    return std::to_string(mesh.positions.size()) + " vertices and " + std::to_string(mesh.faces.size()) + " faces";
}

std::string short_text(double x) { return number(x, 3); }

/// A face from its smallest index on.
Face turned(const Face& f) {
    const auto first = std::min_element(f.begin(), f.end()) - f.begin();
    return {f[first], f[(first + 1) % 3], f[(first + 2) % 3]};
}

/// The same faces, in any order and from any corner on: editors turn them.
bool same_faces(const Faces& a, const Faces& b) {
    if (a.size() != b.size()) return false;
    if (a == b) return true;
    const auto sorted = [](const Faces& faces) {
        Faces all(faces.size());
        std::transform(faces.begin(), faces.end(), all.begin(), turned);
        std::sort(all.begin(), all.end());
        return all;
    };
    return sorted(a) == sorted(b);
}

/// The layer's vertices that `level` was made of, if it says so.
std::optional<Array<Index>> source_vertices(const Layer& level, const Layer& layer) {
    for (const Attribute& a : level.attributes) {
        if (a.name != source_vertex_name || a.width != 1) continue;
        Array<Index> source(a.values.size());
        for (std::size_t i = 0; i < source.size(); ++i) {
            const double value = a.values[i];
            if (!(value >= 0 && value < static_cast<double>(layer.mesh.positions.size())) || value != std::floor(value))
                return std::nullopt;
            source[i] = static_cast<Index>(value);
        }
        return source;
    }
    return std::nullopt;
}

/// The places of the level of the pyramid that has the faces of `level`.
std::optional<Array<Index>> regenerated(const Layer& level, const Layer& layer, const Pyramid& pyramid) {
    const Hierarchy& h = pyramid.hierarchy();
    const auto count = static_cast<Index>(level.mesh.positions.size());
    if (count > h.vertices() || count < h.size.back()) return std::nullopt;
    if (!same_faces(prefix_mesh(h, layer.mesh.faces, count).faces, level.mesh.faces)) return std::nullopt;
    return Array<Index>(h.order.begin(), h.order.begin() + count);
}

FoundProxy of_level(const Layer& layer, const Array<Index>& source, FoundProxy found, std::string text) {
    found.way = FoundProxy::Way::level;
    found.text = std::move(text);
    found.before.resize(source.size());
    for (std::size_t i = 0; i < source.size(); ++i) found.before[i] = layer.mesh.positions[source[i]];
    return found;
}

/// The level with about as many vertices as the edited layer, wrapped onto it.
FoundProxy wrapped(const Layer& layer, const Pyramid& pyramid, FoundProxy found, const Progress& progress) {
    const Hierarchy& h = pyramid.hierarchy();
    const double size = bounding_box(layer.mesh.positions).diagonal();
    const double times = bounding_box(found.after).diagonal() / size;
    constexpr double most = 5;
    require(times < most && times > 1 / most,
            "edited: it is no level of the current layer, and too large or small to be wrapped onto: its box is " +
                short_text(times) + " times as large; choose the layer it was made from as before, or check the units");
    const std::size_t level = nearest_level(h, found.after.size());
    Mesh mesh;
    mesh.faces = level_mesh(h, layer.mesh.faces, level).faces;
    for (Index p = 0; p < h.size[level]; ++p) mesh.positions.push_back(layer.mesh.positions[h.order[p]]);
    Wrapped result = wrap(mesh, found.faces, found.after, progress);
    require(result.distance <= 0.05 * size,
            "edited: it is no level of the current layer, and too far from it to be wrapped onto it: levels stay " +
                short_text(100 * result.distance / size) +
                " % of the box away; choose the layer it was made from as before");
    found.way = FoundProxy::Way::wrapped;
    found.text = "a level of the current layer, wrapped onto the edited one";
    found.before = std::move(mesh.positions);
    found.faces = std::move(mesh.faces);
    found.after = std::move(result.positions);
    return found;
}

/// Words on an edit that makes the proxy far larger or smaller, or moves it far away, which files in other units do;
/// empty for others.
std::string far_text(const FoundProxy& found) {
    constexpr double most_times = 5, most_sizes = 2;
    const Box before = bounding_box(found.before), after = bounding_box(found.after);
    const double size = before.diagonal(), times = after.diagonal() / size;
    const double way = (after.center() - before.center()).norm();
    std::string text;
    if (!(times < most_times && times > 1 / most_times)) text = "is " + short_text(times) + " times as large as it was";
    if (!(way < most_sizes * std::max(size, after.diagonal())))
        text += std::string(text.empty() ? "" : " and ") + "lies " + short_text(way) + " from where it was";
    return text.empty() ? text : ". The edited proxy " + text + ": if that was not meant, check units and placement";
}

}  // namespace

void require_layer(const Layer& layer, const char* which) {
    try {
        require_usable(layer.mesh);
    } catch (const InputError& e) {
        throw InputError(std::string(which) + ": " + e.what());
    }
}

bool same_connectivity(const Mesh& a, const Mesh& b) {
    return a.positions.size() == b.positions.size() && same_faces(a.faces, b.faces);
}

std::size_t nearest_level(const Hierarchy& h, std::size_t vertices) {
    std::size_t best = 0;
    const auto off = [&](std::size_t k) {
        return std::abs(std::log(static_cast<double>(h.size[k]) / static_cast<double>(vertices)));
    };
    for (std::size_t k = 1; k < h.size.size(); ++k)
        if (off(k) < off(best)) best = k;
    return best;
}

FoundProxy find_proxy(const Inputs& inputs, const TransferEditOptions& options, Session& session, Report& report) {
    const Layer& layer = inputs.current;
    const Layer& edited = inputs.other(options.edited, "edited");
    const Layer& before = inputs.other(options.before, "before");
    require(&edited != &layer, "edited: it is the current layer itself; choose the edited proxy");
    require_layer(edited, "edited");
    FoundProxy found;
    found.faces = edited.mesh.faces;
    found.after = in_layer(edited, layer, "the edited layer");
    if (&before != &edited && &before != &layer) {
        require_layer(before, "before");
        require(same_connectivity(before.mesh, edited.mesh),
                "before and edited do not fit together: before has " + counts(before.mesh) + ", edited has " +
                    counts(edited.mesh) +
                    ", and they must be the same, in the same order. If the proxy was remeshed, choose the same layer "
                    "for both");
        found.before = in_layer(before, layer, "the layer before the edit");
        found.text = "the change from one layer to the other";
    } else if (same_connectivity(edited.mesh, layer.mesh)) {
        found.way = FoundProxy::Way::level;
        found.before = layer.mesh.positions;
        found.text = "the edited layer has the vertices and faces of the current one";
    } else if (const auto source = source_vertices(edited, layer)) {
        found = of_level(layer, *source, std::move(found), "a level of the current layer, by its source vertices");
    } else {
        const auto pyramid = pyramid_of(layer, options.pyramid, session, report);
        const auto places = regenerated(edited, layer, *pyramid);
        if (places)
            found = of_level(layer, *places, std::move(found), "a level of the current layer, by its faces");
        else
            found = wrapped(layer, *pyramid, std::move(found), session.progress);
    }
    found.unchanged = found.before == found.after;
    found.text += far_text(found);
    return found;
}

void require_near(const Layer& layer, const FoundProxy& found, double distance_of_nearest) {
    const Box own = bounding_box(layer.mesh.positions), proxy = bounding_box(found.before);
    if (distance_of_nearest <= 0.05 * own.diagonal()) return;
    throw InputError(
        "The proxy before the edit does not lie on the current layer: nine tenths of the layer are farther from "
        "it than " +
        short_text(distance_of_nearest) + ", its box is " + short_text(proxy.diagonal() / own.diagonal()) +
        " times as large and lies " + short_text((proxy.center() - own.center()).norm()) +
        " away. Move or scale it to where it fits, or check the units");
}

}  // namespace multires
