#include "pyramid/options.h"

#include "base/hash.h"
#include "base/number.h"
#include "mesh/adjacency.h"

#include <array>
#include <cmath>
#include <stdexcept>

namespace multires {
namespace {

/// A copy in which what does not count has its default.
PyramidOptions effective(PyramidOptions o) {
    if (o.features.from != Features::angle) o.features.angle = FeatureOptions().angle;
    return o;
}

}  // namespace

std::string scheme_tooltip() {
    std::string text;
    for (const SchemeRow& row : schemes()) text += (text.empty() ? "" : " ") + row.name + ": " + row.summary + ".";
    return text;
}

std::vector<std::string> scheme_names() {
    std::vector<std::string> names;
    for (const SchemeRow& row : schemes()) names.push_back(row.name);
    return names;
}

PyramidOption pyramid_option(const std::string& name) {
    PyramidOption found;
    PyramidOptions options;
    visit_options(options, [&](const PyramidOption& option, const auto&) {
        if (option.name == name) found = option;
    });
    if (found.name.empty()) throw std::invalid_argument("no option " + name);
    return found;
}

void check(const PyramidOptions& options) {
    PyramidOptions o = effective(options);
    visit_options(o, [](const PyramidOption& option, const auto& field) {
        const double value = static_cast<double>(field);
        const std::string range = std::isfinite(option.most)
                                      ? "between " + number(option.least) + " and " + number(option.most)
                                      : "at least " + number(option.least);
        require(value >= option.least && value <= option.most, option.name + " must be " + range);
    });
}

void mark_features(Rings& rings, const Layer& layer, Features features, double angle) {
    const auto edges = [&](const std::vector<std::uint8_t>& bits, std::uint8_t flip, const char* what) {
        require(!bits.empty(), std::string("features: the mesh has no ") + what + " edges");
        std::vector<std::uint8_t> marked = bits;
        for (std::uint8_t& b : marked) b ^= flip;
        mark_features(rings, layer.mesh.faces, marked);
    };
    switch (features) {
    case Features::none:
        return;
    case Features::angle:
        require(angle > 0 && angle < 180, "feature_angle must be between 0 and 180 degrees");
        return mark_features_by_angle(rings, layer.mesh.positions, angle);
    case Features::non_faux_edges:
        return edges(layer.faux_edges, 7, "faux");
    case Features::selected_edges:
        return edges(layer.selected_edges, 0, "selected");
    }
}

ContentHash content_hash(const Layer& layer, const PyramidOptions& options) {
    Hash hash;
    PyramidOptions o = effective(options);
    visit_options(o, [&](const PyramidOption&, const auto& field) {
        hash.add(std::array<double, 1>{static_cast<double>(field)});
    });
    hash.add(shape_hash(layer.mesh.positions, layer.mesh.faces));
    if (o.features.from == Features::non_faux_edges) hash.add(layer.faux_edges);
    if (o.features.from == Features::selected_edges) hash.add(layer.selected_edges);
    return hash.bits128();
}

}  // namespace multires
