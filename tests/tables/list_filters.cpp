#include "all_tables.h"
#include "shapes.h"

#include <cmath>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <utility>

// Prints all filters, their parameters and what they return as JSON, for tests of the hosts and tools/generate.py. The
// defaults are those for the mesh that make_meshes writes to irregular_sphere.ply; "derived" marks those that are
// derived from the mesh.

using namespace multires::plugin;

namespace {

std::string quoted(const std::string& text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') out += '\\';
        if (c == '\n')
            out += "\\n";
        else
            out += c;
    }
    return out + '"';
}

std::string number(double value) {
    std::ostringstream out;
    out.precision(9);
    out << value;
    return out.str();
}

const char* truth(bool value) { return value ? "true" : "false"; }

std::string list(const multires::Vec3& v) {
    return "[" + number(v.x()) + ", " + number(v.y()) + ", " + number(v.z()) + "]";
}

/// Type and default of a parameter. That of a layer is null: the first one that is not the current one.
std::string type_and_value(const Parameter& p) {
    const auto both = [](const char* type, const std::string& value) {
        return "\"type\": " + quoted(type) + ", \"value\": " + value;
    };
    return std::visit(Overloaded{
                          [&](const bool* v) { return both("boolean", truth(*v)); },
                          [&](const int* v) { return both("integer", std::to_string(*v)); },
                          [&](const double* v) { return both(p.hint.slider ? "slider" : "real", number(*v)); },
                          [&](const std::string* v) { return both("text", quoted(*v)); },
                          [&](const Choice& v) { return both("choice", std::to_string(v.value())); },
                          [&](const Angle& v) { return both("angle", number(*v.degrees)); },
                          [&](const Point& v) { return both("point", list(*v.at)); },
                          [&](const Direction& v) { return both("direction", list(*v.unit)); },
                          [&](const multires::LayerRef*) { return both("layer", "null"); },
                      },
                      p.field);
}

std::string names_or_range(const Parameter& p) {
    std::string out;
    if (const auto* choice = std::get_if<Choice>(&p.field)) {
        for (const std::string& name : choice->names) out += (out.empty() ? "" : ", ") + quoted(name);
        return ", \"names\": [" + out + "]";
    }
    if (!p.hint.range) return out;
    if (std::isfinite(p.hint.range->least)) out += ", \"least\": " + number(p.hint.range->least);
    if (std::isfinite(p.hint.range->most)) out += ", \"most\": " + number(p.hint.range->most);
    return out;
}

void print_parameters(const Filter& filter, const multires::Layer& layer) {
    const char* comma = "";
    const Call call = filter.call(&layer);
    for (const Parameter& p : call.parameters) {
        std::cout << comma << "\n      {\"name\": " << quoted(p.name) << ", " << type_and_value(p) << names_or_range(p)
                  << ", \"derived\": " << truth(p.hint.derived) << ", \"advanced\": " << truth(p.hint.advanced)
                  << ", \"group\": " << quoted(p.hint.group) << ",\n       \"label\": " << quoted(p.hint.label)
                  << ", \"tooltip\": " << quoted(p.hint.tooltip) << "}";
        comma = ",";
    }
}

void print_returns(const Filter& filter) {
    const char* const types[] = {"boolean", "integer", "real", "list"};
    const char* comma = "";
    for (const Returned& r : filter.returns) {
        std::cout << comma << "\n      {\"key\": " << quoted(r.key)
                  << ", \"type\": " << quoted(types[static_cast<int>(r.type)]) << ", \"unit\": " << quoted(r.unit)
                  << ", \"always\": " << (r.always ? "true" : "false") << ", \"meaning\": " << quoted(r.meaning) << "}";
        comma = ",";
    }
}

multires::Layer sphere() {
    multires::Layer layer;
    for (auto& [name, mesh] : multires::shapes::every_class())
        if (name == "irregular_sphere") layer.mesh = std::move(mesh);
    if (layer.mesh.positions.empty()) throw std::logic_error("irregular_sphere is gone");
    return layer;
}

}  // namespace

int main() {
    const multires::Layer layer = sphere();
    std::cout << "[";
    const char* comma = "";
    for (const Plugin* plugin : all_tables())
        for (const Filter& filter : plugin->filters) {
            std::cout << comma << "\n  {\"plugin\": " << quoted(plugin->name) << ", \"name\": " << quoted(filter.name)
                      << ", \"python_name\": " << quoted(filter.python_name)
                      << ",\n    \"info\": " << quoted(filter.info) << ",\n    \"needs\": " << filter.needs
                      << ", \"changes\": " << filter.changes << ", \"parameters\": [";
            print_parameters(filter, layer);
            std::cout << "],\n    \"returns\": [";
            print_returns(filter);
            std::cout << "]}";
            comma = ",";
        }
    std::cout << "\n]\n";
}
