#pragma once

#include "given.h"

namespace multires::plugin {

/// Parameters of one call, and what is special about them.
struct Variant {
    std::string name;
    std::map<std::string, double> values;
};

/// Calls that between them take every way through a filter on a small mesh: the defaults with a pyramid of several
/// levels, then every other value of every choice and boolean.
inline std::vector<Variant> variants(const Filter& filter, const Layer& layer) {
    const std::vector<Declared> all = declared(filter, &layer);
    std::map<std::string, double> base;
    for (const Declared& d : all) {
        if (d.name == "base_vertices") base[d.name] = 8;
        if (d.name == "level") base[d.name] = 1;
    }
    std::vector<Variant> out{{"defaults", base}};
    for (const Declared& d : all) {
        if (d.type != Declared::Type::boolean && d.type != Declared::Type::choice) continue;
        for (double value = d.least; value <= d.most; ++value) {
            if (value == d.value) continue;
            Variant v{d.name + "=" + std::to_string(static_cast<int>(value)), base};
            v.values[d.name] = value;
            out.push_back(std::move(v));
        }
    }
    return out;
}

}  // namespace multires::plugin
