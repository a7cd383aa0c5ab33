#pragma once

#include "shared/table.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

/// Filters without a host: parameters by name, as numbers.
namespace multires::plugin {

/// Values by name of the parameter. Numbers stand for booleans and the places of choices, too; what is not in the list
/// keeps its default.
using Given = std::map<std::string, double>;

/// Writes values to the fields, refusing what hosts refuse. Texts, points, directions and layers keep their defaults.
/// @throws InputError
inline void read(const Parameters& parameters, const Given& given) {
    for (const Parameter& p : parameters) {
        const auto at = given.find(p.name);
        if (at == given.end()) continue;
        const double value = at->second;
        const auto whole = [&](const auto&) {
            if (!(std::abs(value) <= 2147483647))
                throw InputError(p.name + " is not a whole number");  // hosts hold an int
            set(p, static_cast<int>(value));
        };
        std::visit(Overloaded{
                       [&](bool*) { set(p, value != 0); },
                       [&](int* field) { whole(field); },
                       [&](const Choice& field) { whole(field); },
                       [&](double*) { set(p, value); },
                       [&](const Angle&) { set(p, value); },
                       [](const auto&) {},
                   },
                   p.field);
    }
}

/// What stands for another layer of the document where a filter wants one: the mesh itself, swollen about its centroid.
inline Layer another_layer(const Layer& layer) {
    Layer other;
    other.mesh = layer.mesh;
    Vec3 centroid = Vec3::Zero();
    for (const Vec3& p : layer.mesh.positions) centroid += p / static_cast<double>(layer.mesh.positions.size());
    for (Vec3& p : other.mesh.positions) p = centroid + 1.01 * (p - centroid);
    return other;
}

/// Filters that refuse all meshes but triangular grids.
inline bool wants_grid(const Filter& filter) { return filter.python_name.find("multires_grid") != std::string::npos; }

/// Runs a filter on a layer, and on another_layer if it wants one.
inline Result run(const Filter& filter, const Layer& layer, Session& session, const Given& given = {}) {
    const Call call = filter.call(&layer);
    read(call.parameters, given);
    Layer other;
    Inputs inputs{layer};
    for (const Parameter& p : call.parameters)
        if (auto* const* ref = std::get_if<LayerRef*>(&p.field)) {
            if (inputs.others.empty()) other = another_layer(layer);
            (*ref)->place = inputs.others.size();
            inputs.others.push_back(&other);
        }
    return call.run(inputs, session);
}

/// One parameter of a filter that takes a number, or a text, as declared for a layer.
struct Declared {
    enum class Type { boolean, integer, real, choice, text } type;
    std::string name;
    double value, least, most;  ///< infinite where there is no limit
};

/// All such parameters of a filter.
inline std::vector<Declared> declared(const Filter& filter, const Layer* layer) {
    std::vector<Declared> list;
    const Call call = filter.call(layer);
    for (const Parameter& p : call.parameters) {
        const Range range = p.hint.range.value_or(Range());
        const auto add = [&](Declared::Type type, double value, Range r) {
            list.push_back({type, p.name, value, r.least, r.most});
        };
        std::visit(Overloaded{
                       [&](bool* v) {
                           add(Declared::Type::boolean, *v ? 1 : 0, {0, 1});
                       },
                       [&](int* v) { add(Declared::Type::integer, *v, range); },
                       [&](double* v) { add(Declared::Type::real, *v, range); },
                       [&](const Angle& v) { add(Declared::Type::real, *v.degrees, range); },
                       [&](const Choice& v) {
                           add(Declared::Type::choice, v.value(), {0, static_cast<double>(v.names.size()) - 1});
                       },
                       [&](const std::string*) {
                           add(Declared::Type::text, 0, {0, 0});
                       },
                       [](const auto&) {},  // points, directions, layers: tests of their own
                   },
                   p.field);
    }
    return list;
}

}  // namespace multires::plugin
