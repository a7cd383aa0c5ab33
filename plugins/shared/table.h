#pragma once

#include "filters/filter.h"
#include "filters/result_hash.h"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

/// The tables that declare filters. A filter is one row: its names, its info, what it needs and changes, its
/// parameters bound to the fields of an options struct, and its function. No host header is needed to write one.
namespace multires::plugin {

/// Text and range of one parameter.
struct Hint {
    std::string label;
    std::string tooltip;    ///< what a value does, and in which unit
    double least = -1e300;  ///< smallest and largest sensible value, inclusive
    double most = 1e300;
    bool advanced = false;   ///< folded away in the dialog where the host can
    std::string group = "";  ///< heading in the dialog where the host has headings
};

/// Visits the parameters of a filter: one call a parameter, used both to declare it (the default is the value found
/// in the field) and to read it back (the field is overwritten).
class Parameters {
public:
    virtual ~Parameters() = default;
    virtual void boolean(const char* name, bool& value, const Hint& hint) = 0;
    virtual void integer(const char* name, int& value, const Hint& hint) = 0;
    virtual void real(const char* name, double& value, const Hint& hint) = 0;
    /// A real with a slider between hint.least and hint.most, live in hosts that preview.
    virtual void slider(const char* name, double& value, const Hint& hint) = 0;
    virtual void choice(const char* name, int& value, const std::vector<std::string>& names, const Hint& hint) = 0;
    virtual void text(const char* name, std::string& value, const Hint& hint) = 0;

    /// A choice bound to an enum whose values are 0, 1, ... in the order of the names.
    template <class Enum>
    void choice(const char* name, Enum& value, const std::vector<std::string>& names, const Hint& hint) {
        int i = static_cast<int>(value);
        choice(name, i, names, hint);
        value = static_cast<Enum>(i);
    }
};

/// Sets of mesh parts, for preconditions and postconditions.
enum Parts : std::uint32_t {
    none = 0,
    faces = 1,  ///< pre: the mesh has faces; post: number of faces changes
    vertex_positions = 2,
    vertex_quality = 4,
    vertex_color = 8,
    vertex_texcoord = 16,
    wedge_texcoord = 32,
    new_layer = 64,
    custom_attributes = 128,  ///< of vertices, all that a Layer can hold
};

/// Where the filter appears in the host's menu.
enum class MenuClass { smoothing, remeshing, quality, layer, measure, texture };

/// One number of a filter's report, for people and programs that read it.
struct Returned {
    enum class Type { boolean, integer, real, list };
    std::string key;  ///< as in Report; a leading * stands for the label of any attribute
    Type type;
    std::string unit;  ///< "" if it has none
    std::string meaning;
    bool always = true;  ///< false: only with some parameters or meshes
};

/// One filter.
struct Filter {
    std::string name;         ///< "Multiresolution: Low Pass", as in the menu
    std::string python_name;  ///< "apply_coord_multires_low_pass"
    std::string info;         ///< HTML, ends with the citation
    MenuClass menu_class;
    std::uint32_t needs;    ///< Parts the mesh must have
    std::uint32_t reads;    ///< attributes to be put into the Layer (vertex_quality, vertex_color, ...)
    std::uint32_t changes;  ///< Parts the filter may change

    /// Declares or reads the parameters; the defaults are derived from the layer (null: no mesh, use fixed ones).
    std::function<void(Parameters&, const Layer*)> parameters;
    /// Runs the filter with the parameters read from the host.
    std::function<Result(Parameters&, const Layer&, Session&)> run;

    std::vector<Returned> returns = {};  ///< what the report holds
};

/// Makes a row from an options struct: `defaults` derives it from a layer, `bind` visits its fields, `apply` does it.
/// The report of a filter that changes anything ends with a hash of what.
template <class Options>
Filter filter(Filter row, Options (*defaults)(const Layer*), void (*bind)(Parameters&, Options&),
              Result (*apply)(const Layer&, const Options&, Session&)) {
    const bool changes = row.changes != none;
    row.parameters = [=](Parameters& p, const Layer* layer) {
        Options o = defaults(layer);
        bind(p, o);
    };
    row.run = [=](Parameters& p, const Layer& layer, Session& session) {
        Options o = defaults(&layer);
        bind(p, o);
        Result result = apply(layer, o, session);
        if (changes) result.report.add("result_hash", result_hash(result));
        return result;
    };
    if (changes)
        row.returns.push_back({"result_hash", Returned::Type::real, "",
                               "Hash of all that was computed: the same if, and in practice only if, the result is"});
    return row;
}

/// A plugin: its name, and its filters.
struct Plugin {
    std::string name;  ///< "FilterMultiresBand"
    std::vector<Filter> filters;
};

/// The table of a plugin; each plugin's source defines it.
const Plugin& table();

}  // namespace multires::plugin
