#pragma once

#include "given.h"

#include <algorithm>
#include <set>

namespace multires::plugin {

/// Parameters of one call, and what is special about them.
struct Variant {
    std::string name;
    std::map<std::string, double> values;
    std::string changed = "";  ///< the parameter that is not at its default; empty: none, or several
};

/// Calls that between them take every way through a filter on a small mesh: the defaults with a pyramid of several
/// levels, then every other value of every choice and boolean.
inline std::vector<Variant> variants(const Filter& filter, const Layer& layer) {
    const std::vector<Declared> all = declared(filter, &layer);
    std::map<std::string, double> base;
    for (const Declared& d : all) {
        if (d.name == "base_vertices") base[d.name] = 8;
        if (d.name == "level") base[d.name] = 1;
        if (d.name == "oracle") base[d.name] = 0;  // the quick one
    }
    std::vector<Variant> out{{"defaults", base}};
    for (const Declared& d : all) {
        if (d.type != Declared::Type::boolean && d.type != Declared::Type::choice) continue;
        for (double value = d.least; value <= d.most; ++value) {
            if (value == d.value) continue;
            Variant v{d.name + "=" + std::to_string(static_cast<int>(value)), base};
            v.values[d.name] = value;
            v.changed = d.name;
            out.push_back(std::move(v));
        }
    }
    return out;
}

/// Those, and every other value of a choice that switches a filter between ways of working (so that with the default,
/// some other parameters do nothing) with every other value of every other choice and boolean. Not with sanitizers,
/// which take their time and find on the ways themselves what there is to be found.
inline std::vector<Variant> crossed_variants(const Filter& filter, const Layer& layer) {
    const std::vector<Variant> single = variants(filter, layer);
#ifdef MULTIRES_SANITIZED
    return single;
#else
    const std::set<std::string> switches = {"method", "mode", "target", "scheme"};
    const bool has_rule =
        std::any_of(single.begin(), single.end(), [](const Variant& v) { return v.changed == "rule"; });
    std::vector<Variant> out = single;
    for (const Variant& a : single)
        for (const Variant& b : single) {
            if (switches.count(a.changed) == 0 || b.changed.empty() || a.changed == b.changed) continue;
            if (switches.count(b.changed) && b.changed < a.changed) continue;  // once is enough
            Variant both{a.name + ", " + b.name, a.values};
            both.values[b.changed] = b.values.at(b.changed);
            if (has_rule) both.values.emplace("rule", 0);  // soft: the default, automatic, reads no pyramid
            out.push_back(std::move(both));
        }
    return out;
#endif
}

}  // namespace multires::plugin
