#include "all_tables.h"
#include "shapes.h"

#include <iostream>
#include <sstream>
#include <stdexcept>
#include <utility>

// Prints all filters, their parameters and what they return as JSON, for tests of the hosts and tools/generate.py. The
// defaults are those for the mesh that make_meshes writes to irregular_sphere.ply; "derived" marks those that other
// meshes (none, one with a selection and a quality) have another value for.

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

class Printer final : public Parameters {
public:
    /// defaults_elsewhere: what Values found in other layers, in the order of the parameters.
    explicit Printer(std::vector<std::vector<std::string>> defaults_elsewhere)
        : others_(std::move(defaults_elsewhere)) {}

    void boolean(const char* name, bool& value, const Hint& hint) override {
        print(name, "boolean", value ? "true" : "false", hint);
    }
    void integer(const char* name, int& value, const Hint& hint) override {
        print(name, "integer", std::to_string(value), hint, range(hint));
    }
    void real(const char* name, double& value, const Hint& hint) override {
        print(name, "real", number(value), hint, range(hint));
    }
    void slider(const char* name, double& value, const Hint& hint) override {
        print(name, "slider", number(value), hint, range(hint));
    }
    void text(const char* name, std::string& value, const Hint& hint) override {
        print(name, "text", quoted(value), hint);
    }
    void choice(const char* name, int& value, const std::vector<std::string>& names, const Hint& hint) override {
        std::string list = ", \"names\": [";
        for (std::size_t i = 0; i < names.size(); ++i) list += (i ? ", " : "") + quoted(names[i]);
        print(name, "choice", number(value), hint, list + "]");
    }

    static std::string number(double value) {
        std::ostringstream out;
        out.precision(9);
        out << value;
        return out.str();
    }

private:
    void print(const char* name, const char* type, const std::string& value, const Hint& hint,
               const std::string& more = "") {
        bool derived = false;
        for (const auto& other : others_) derived = derived || other.at(count_) != value;
        std::cout << (count_++ ? "," : "") << "\n      {\"name\": " << quoted(name) << ", \"type\": " << quoted(type)
                  << ", \"value\": " << value << more << ", \"derived\": " << (derived ? "true" : "false")
                  << ", \"advanced\": " << (hint.advanced ? "true" : "false")
                  << ",\n       \"label\": " << quoted(hint.label) << ", \"tooltip\": " << quoted(hint.tooltip) << "}";
    }
    static std::string range(const Hint& hint) {
        std::string out;
        if (hint.least > -1e300) out += ", \"least\": " + number(hint.least);
        if (hint.most < 1e300) out += ", \"most\": " + number(hint.most);
        return out;
    }

    std::vector<std::vector<std::string>> others_;
    std::size_t count_ = 0;
};

/// Defaults as Printer prints them.
class Values final : public Parameters {
public:
    std::vector<std::string> values;

    void boolean(const char* /*name*/, bool& value, const Hint& /*hint*/) override {
        values.emplace_back(value ? "true" : "false");
    }
    void integer(const char* /*name*/, int& value, const Hint& /*hint*/) override {
        values.push_back(std::to_string(value));
    }
    void real(const char* /*name*/, double& value, const Hint& /*hint*/) override { add(value); }
    void slider(const char* /*name*/, double& value, const Hint& /*hint*/) override { add(value); }
    void text(const char* /*name*/, std::string& value, const Hint& /*hint*/) override {
        values.push_back(quoted(value));
    }
    void choice(const char* /*name*/, int& value, const std::vector<std::string>& /*names*/,
                const Hint& /*hint*/) override {
        add(value);
    }

private:
    void add(double value) { values.push_back(Printer::number(value)); }
};

std::vector<std::string> defaults(const Filter& filter, const multires::Layer* layer) {
    Values values;
    filter.parameters(values, layer);
    return values.values;
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
    multires::Layer other = layer;
    const std::size_t n = layer.mesh.positions.size();
    other.selected_vertex.assign(n, 1);
    other.attributes.push_back({multires::AttributeKind::quality, "", 1, std::vector<double>(n, 1.0)});
    std::cout << "[";
    const char* comma = "";
    for (const Plugin* plugin : all_tables())
        for (const Filter& filter : plugin->filters) {
            std::cout << comma << "\n  {\"plugin\": " << quoted(plugin->name) << ", \"name\": " << quoted(filter.name)
                      << ", \"python_name\": " << quoted(filter.python_name)
                      << ",\n    \"info\": " << quoted(filter.info) << ",\n    \"changes\": " << filter.changes
                      << ", \"parameters\": [";
            Printer printer({defaults(filter, nullptr), defaults(filter, &other)});
            filter.parameters(printer, &layer);
            std::cout << "],\n    \"returns\": [";
            print_returns(filter);
            std::cout << "]}";
            comma = ",";
        }
    std::cout << "\n]\n";
}
