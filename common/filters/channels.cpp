#include "filters/channels.h"

#include "base/reduce.h"
#include "base/rows.h"
#include "mesh/validation.h"

#include <algorithm>
#include <cctype>
#include <cmath>

namespace multires {
namespace {

const char* parameter_of(AttributeKind kind) {
    switch (kind) {
    case AttributeKind::color:
        return "color";
    case AttributeKind::quality:
        return "quality";
    case AttributeKind::texcoord:
        return "texcoord";
    case AttributeKind::scalar:
    case AttributeKind::point:
        break;
    }
    return "custom";
}

bool is_custom(const Attribute& a) { return a.kind == AttributeKind::scalar || a.kind == AttributeKind::point; }

std::vector<std::string> split(const std::string& names) {
    std::vector<std::string> out;
    std::size_t begin = 0;
    while (begin <= names.size()) {
        const std::size_t end = std::min(names.find(',', begin), names.size());
        std::string name = names.substr(begin, end - begin);
        const auto blank = [](unsigned char c) { return std::isspace(c) != 0; };
        name.erase(name.begin(), std::find_if_not(name.begin(), name.end(), blank));
        name.erase(std::find_if_not(name.rbegin(), name.rend(), blank).base(), name.end());
        if (!name.empty()) out.push_back(std::move(name));
        begin = end + 1;
    }
    return out;
}

/// A name as part of a key: letters and digits, the rest becomes '_'.
std::string key_of(const std::string& name) {
    std::string key;
    for (const unsigned char c : name) key += static_cast<char>(std::isalnum(c) ? std::tolower(c) : '_');
    return key;
}

/// Indices of the custom attributes chosen.
std::vector<std::size_t> chosen_customs(const Layer& layer, const std::string& names) {
    std::vector<std::size_t> chosen;
    const std::vector<std::string> wanted = split(names);
    for (std::size_t i = 0; i < layer.attributes.size(); ++i)
        if (wanted.empty() && is_custom(layer.attributes[i]) && layer.attributes[i].name != "source_vertex")
            chosen.push_back(i);
    for (const std::string& name : wanted) {
        std::size_t i = 0;
        while (i < layer.attributes.size() && !(is_custom(layer.attributes[i]) && layer.attributes[i].name == name))
            ++i;
        if (i == layer.attributes.size())
            throw InputError("custom_names: the mesh has no custom vertex attribute \"" + name +
                             "\" of a scalar or point type");
        if (std::find(chosen.begin(), chosen.end(), i) == chosen.end()) chosen.push_back(i);
    }
    if (chosen.empty()) throw InputError("custom: the mesh has no custom vertex attributes of a scalar or point type");
    return chosen;
}

Channels channels_of(const Layer& layer, std::size_t index, bool linear_light) {
    const Attribute& a = layer.attributes[index];
    Channels c;
    c.label = parameter_of(a.kind);
    if (is_custom(a)) c.label += "_" + key_of(a.name);
    c.attribute = index;
    c.linear_light = linear_light && a.kind == AttributeKind::color;
    c.field.width = a.width;
    c.field.has_positions = false;
    c.field.values.assign(a.values.begin(), a.values.end());
    for (std::size_t i = 0; i < a.values.size(); ++i)
        if (!is_usable(a.values[i]))
            throw InputError(c.label + ": the value of vertex " + std::to_string(i / a.width) +
                             " is not a finite number, or beyond 1e70");
    if (c.linear_light)
        parallel_for(c.field.rows(), [&](Index r) {
            for (int k = 0; k < 3; ++k) c.field.row(r)[k] = decode_light(c.field.row(r)[k]);
        });
    return c;
}

/// False for what is the same at every vertex, as the colours are that hosts give a mesh when nobody else did.
bool varies(const Attribute& a) { return !rows_are_equal(a.values, a.width); }

/// @param has  whether the layer has an attribute of that kind
template <class Has>
AttributeChoice first_of(const Has& has, bool wedges) {
    AttributeChoice choice;
    bool* chosen = &choice.color;
    if (!has(AttributeKind::color)) {
        if (has(AttributeKind::quality))
            chosen = &choice.quality;
        else if (wedges)
            chosen = &choice.wedge_texcoord;
        else if (has(AttributeKind::texcoord))
            chosen = &choice.texcoord;
        else if (has(AttributeKind::scalar) || has(AttributeKind::point))
            chosen = &choice.custom;
    }
    *chosen = true;
    return choice;
}

struct Changes {
    double largest = 0, squares = 0;
    Changes& operator+=(const Changes& o) {
        largest = std::max(largest, o.largest);
        squares += o.squares;
        return *this;
    }
};

}  // namespace

AttributeChoice default_choice(const Layer* layer) {
    if (!layer) return first_of([](AttributeKind) { return false; }, false);
    const auto any = [&](const auto& suits) {
        return std::any_of(layer->attributes.begin(), layer->attributes.end(), suits);
    };
    const auto there = [&](AttributeKind kind) {
        return any([&](const Attribute& a) { return a.kind == kind && a.name != "source_vertex"; });
    };
    const auto varying = [&](AttributeKind kind) {
        return any([&](const Attribute& a) { return a.kind == kind && a.name != "source_vertex" && varies(a); });
    };
    const bool wedges = !layer->wedges.empty();
    const bool some = wedges || any([](const Attribute& a) { return a.name != "source_vertex" && varies(a); });
    return some ? first_of(varying, wedges) : first_of(there, wedges);
}

std::vector<std::size_t> chosen_attributes(const Layer& layer, const AttributeChoice& choice) {
    std::vector<std::size_t> all;
    const auto take = [&](bool wanted, AttributeKind kind, const char* missing) {
        if (!wanted) return;
        std::size_t i = 0;
        while (i < layer.attributes.size() && layer.attributes[i].kind != kind) ++i;
        if (i == layer.attributes.size()) throw InputError(std::string(parameter_of(kind)) + ": " + missing);
        all.push_back(i);
    };
    take(choice.color, AttributeKind::color, "the mesh has no vertex colours");
    take(choice.quality, AttributeKind::quality, "the mesh has no vertex quality");
    take(choice.texcoord, AttributeKind::texcoord, "the mesh has no vertex texture coordinates");
    if (choice.custom)
        for (const std::size_t i : chosen_customs(layer, choice.custom_names)) all.push_back(i);
    if (all.empty() && !choice.wedge_texcoord)
        throw InputError("no attribute is chosen: turn on color, quality or another one");
    return all;
}

std::vector<Channels> vertex_channels(const Layer& layer, const AttributeChoice& choice, bool linear_light) {
    std::vector<Channels> all;
    for (const std::size_t i : chosen_attributes(layer, choice)) all.push_back(channels_of(layer, i, linear_light));
    return all;
}

std::vector<Channels> usable_channels(const Layer& layer) {
    std::vector<Channels> all;
    for (std::size_t i = 0; i < layer.attributes.size(); ++i) {
        const Attribute& a = layer.attributes[i];
        if (a.kind == AttributeKind::texcoord || a.name == source_vertex_name) continue;
        if (std::all_of(a.values.begin(), a.values.end(), [](double x) { return is_usable(x); }))
            all.push_back(channels_of(layer, i, false));
    }
    return all;
}

double decode_light(double value) {
    const double x = value / 255;
    return 255 * (x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4));
}

double encode_light(double light) {
    const double x = light / 255;
    return 255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055);
}

Attribute changed_attribute(const Layer& layer, const Channels& before, const Field& after,
                            const std::vector<double>& weights, Report& report) {
    const Attribute& old = layer.attributes[before.attribute];
    const int width = old.width;
    const bool color = old.kind == AttributeKind::color;
    Attribute out = old;
    const auto one = [&](Index i, Changes& changes) {
        const double weight = weights.empty() ? 1 : weights[i];
        const double *a = before.field.row(i), *b = after.row(i);
        if (weight <= 0 || std::equal(a, a + width, b)) return;
        double* to = out.values.data() + static_cast<std::size_t>(i) * width;
        double square = 0;
        for (int k = 0; k < width; ++k) {
            double x = weight < 1 ? a[k] + weight * (b[k] - a[k]) : b[k];
            if (before.linear_light && k < 3) x = encode_light(x);
            if (color) x = std::clamp(x, 0.0, 255.0);
            square += (x - to[k]) * (x - to[k]);
            to[k] = x;
        }
        changes.largest = std::max(changes.largest, std::sqrt(square));
        changes.squares += square;
    };
    const Index rows = after.rows();
    const Changes sum = chunked_reduce<Changes>(rows, [&](std::size_t begin, std::size_t end) {
        Changes changes;
        for (std::size_t i = begin; i < end; ++i) one(static_cast<Index>(i), changes);
        return changes;
    });
    const char* unit = color ? "of 255" : "";
    report.add(before.label + "_largest_change", sum.largest, unit);
    report.add(before.label + "_rms_change", rows ? std::sqrt(sum.squares / rows) : 0.0, unit);
    return out;
}

}  // namespace multires
