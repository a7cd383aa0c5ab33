#include "all_tables.h"
#include "shapes.h"

#include <iostream>
#include <stdexcept>

// Prints all filters and their parameters as JSON, for tests of the hosts. The defaults are those for the mesh that
// make_meshes writes to irregular_sphere.ply.

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
    void boolean(const char* name, bool& value, const Hint&) override {
        begin(name, "boolean") << (value ? "true" : "false") << "}";
    }
    void integer(const char* name, int& value, const Hint& hint) override {
        begin(name, "integer") << value << range(hint) << "}";
    }
    void real(const char* name, double& value, const Hint& hint) override {
        begin(name, "real") << value << range(hint) << "}";
    }
    void slider(const char* name, double& value, const Hint& hint) override {
        begin(name, "slider") << value << range(hint) << "}";
    }
    void text(const char* name, std::string& value, const Hint&) override {
        begin(name, "text") << quoted(value) << "}";
    }
    void choice(const char* name, int& value, const std::vector<std::string>& names, const Hint&) override {
        begin(name, "choice") << value << ", \"names\": [";
        for (std::size_t i = 0; i < names.size(); ++i) std::cout << (i ? ", " : "") << quoted(names[i]);
        std::cout << "]}";
    }

private:
    std::ostream& begin(const char* name, const char* type) {
        std::cout << (first_ ? "" : ",") << "\n      {\"name\": " << quoted(name) << ", \"type\": " << quoted(type)
                  << ", \"value\": ";
        first_ = false;
        return std::cout;
    }
    static std::string range(const Hint& hint) {
        std::string out;
        if (hint.least > -1e300) out += ", \"least\": " + std::to_string(hint.least);
        if (hint.most < 1e300) out += ", \"most\": " + std::to_string(hint.most);
        return out;
    }
    bool first_ = true;
};

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
    std::cout.precision(9);
    std::cout << "[";
    const char* comma = "";
    for (const Plugin* plugin : all_tables())
        for (const Filter& filter : plugin->filters) {
            std::cout << comma << "\n  {\"plugin\": " << quoted(plugin->name) << ", \"name\": " << quoted(filter.name)
                      << ", \"python_name\": " << quoted(filter.python_name) << ",\n    \"changes\": " << filter.changes
                      << ", \"parameters\": [";
            Printer printer;
            filter.parameters(printer, &layer);
            std::cout << "]}";
            comma = ",";
        }
    std::cout << "\n]\n";
}
