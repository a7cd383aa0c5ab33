#pragma once

#include "shared/parameters.h"

#include "filters/across_seams.h"
#include "filters/channels.h"
#include "filters/filter.h"
#include "filters/result_hash.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

/// The tables that declare filters. A filter is one row: its names, its info, what it needs and changes, its
/// parameters bound to the fields of an options struct, and its function. No host header is needed to write one.
namespace multires::plugin {

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
    vertex_selection = 256,
    edge_selection = 512,
    closed_seams = 1024,  ///< pre: vertices along seams count as one (filters/across_seams.h), not that there are any
    vertex_attributes = vertex_quality | vertex_color | vertex_texcoord | custom_attributes,
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

/// One call of a filter, before it runs: the parameters point into its options, which it holds.
struct Call {
    Parameters parameters;
    std::function<Result(const Inputs&, Session&)> run;  ///< with the values that are then in the fields
};

/// One filter.
struct Filter {
    std::string name;         ///< "Multiresolution: Low Pass", as in the menu
    std::string python_name;  ///< "apply_coord_multires_low_pass"
    std::string info;         ///< HTML, ends with the citation
    MenuClass menu_class;
    std::uint32_t needs;                 ///< Parts the mesh must have
    std::uint32_t reads;                 ///< attributes to be put into the Layer (vertex_quality, vertex_color, ...)
    std::uint32_t changes;               ///< Parts the filter may change
    std::vector<Returned> returns = {};  ///< what the report holds

    /// Begins a call; defaults are derived from the layer (null: there is no mesh, fixed ones). If the call is run with
    /// this very layer, it has to be as it was. Made by filter() below.
    std::function<Call(const Layer*)> call = nullptr;
};

template <class Options, class = void>
struct HasChoice : std::false_type {};
template <class Options>
struct HasChoice<Options, std::void_t<decltype(Options::what)>> : std::true_type {};

/// The attributes that a filter changes: seams stay open where the two sides have different values of these. Options
/// without an AttributeChoice may have a function of this name in their own header.
template <class Options>
std::vector<std::size_t> kept_apart(const Layer& layer, const Options& options) {
    if constexpr (HasChoice<Options>::value)
        return chosen_attributes(layer, options.what);
    else
        return {};
}

/// Completes a row: `defaults` derives an options struct from a layer, `bind` lists its fields as parameters, `apply`
/// does it: Result apply(layer, options, session), where layer is a Layer, or Inputs for a filter of several layers.
/// The report of a filter that changes anything ends with a hash of what.
template <class Options, class Given>
Filter filter(Filter row, Options (*defaults)(const Layer*), void (*bind)(Parameters&, Options&),
              Result (*apply)(const Given&, const Options&, Session&)) {
    const bool changes = row.changes != none, seams = (row.needs & closed_seams) != 0;
    row.call = [=](const Layer* layer) {
        const auto closed = seams && layer ? close_seams(*layer) : nullptr;
        const auto options = std::make_shared<Options>(defaults(closed ? &closed->layer : layer));
        Call call;
        bind(call.parameters, *options);
        call.run = [=](const Inputs& inputs, Session& session) {
            const auto run = [&](const Inputs& all) {
                if constexpr (std::is_same_v<Given, Inputs>)
                    return apply(all, *options, session);
                else
                    return apply(all.current, *options, session);
            };
            auto found = !seams ? nullptr : &inputs.current == layer ? closed : close_seams(inputs.current);
            if (found) found = open_where_values_differ(inputs.current, found, kept_apart(inputs.current, *options));
            Result result = across_seams(inputs, found.get(), session, run);
            if (changes) result.report.add("result_hash", result_hash(result));
            return result;
        };
        return call;
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
