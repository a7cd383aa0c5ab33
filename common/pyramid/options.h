#pragma once

#include "base/error.h"
#include "hierarchy/hierarchy.h"
#include "mesh/layer.h"
#include "mesh/shape_hash.h"
#include "schemes/table.h"

#include <limits>
#include <string>
#include <type_traits>
#include <vector>

namespace multires {

/// Where feature edges come from; they are not smoothed across.
enum class Features {
    none,
    angle,           ///< edges where the faces' normals differ by more than an angle
    non_faux_edges,  ///< edges that are not faux, as MeshLab's crease filter leaves them
    selected_edges,  ///< edges selected on their faces
};

struct FeatureOptions {
    Features from = Features::none;
    double angle = 40;  ///< degrees, in (0, 180), for Features::angle
};

/// How a pyramid is built. The defaults give the sharpest bands. What a hierarchy must hold for the scheme (flaps, even
/// rings, mean edges) is up to the scheme, whatever the options say.
struct PyramidOptions {
    HierarchyOptions hierarchy = [] {
        HierarchyOptions o;
        o.sets_per_level = 2;
        return o;
    }();
    SchemeOptions scheme = [] {
        SchemeOptions o;
        o.op = Operator::second_difference_flaps;
        o.presmooth = 0.5;
        return o;
    }();
    FeatureOptions features;
};

/// With one set per level, for thresholding: more levels see more of the noise, and 5 to 12 % less of it is left.
inline PyramidOptions fine_levels() {
    PyramidOptions options;
    options.hierarchy.sets_per_level = 1;
    return options;
}

/// What dialogs, scripts and checks need of one option.
struct PyramidOption {
    std::string name;                       ///< snake_case, unique
    std::string label = "";                 ///< for people; empty: not for them
    std::string tooltip = "";               ///< what a value does, and in which unit
    double least = 0, most = 1;             ///< range, inclusive
    std::vector<std::string> choices = {};  ///< names of the values 0, 1, ... of a choice
    std::string group = "Pyramid";          ///< heading in dialogs
    bool degrees = false;                   ///< it is an angle
};

inline PyramidOption in_degrees(PyramidOption option) {
    option.degrees = true;
    return option;
}

/// The tooltip of the choice of schemes, from their table.
std::string scheme_tooltip();
std::vector<std::string> scheme_names();

/// Calls visit(option, field) for every field of the options, in the order in which dialogs show them. Checks, hashes
/// and dialogs all come from here: a new option is a field and a line of this function, which does not compile without.
template <class Visit>
void visit_options(PyramidOptions& o, const Visit& visit) {  // NOLINT(readability-function-size): a table
    auto& [row, op, presmooth, storage, update] = o.scheme;
    auto& [grouping, sets, set_share, valence_power, memoryless, boundary_weight, level_ratio, base_vertices,
           normal_limit, length_weight, split, seed, flaps, even_rings, mean_edges] = o.hierarchy;
    auto& [features, feature_angle] = o.features;
    using Option = PyramidOption;
    const std::vector<std::string> names = scheme_names();
    visit(Option{"scheme", "Scheme", scheme_tooltip(), 0, static_cast<double>(names.size() - 1), names}, row);
    visit(
        Option{"operator",
               "Operator",
               "Relaxation operator: how a vertex is predicted from its neighbours. Second differences keep shape "
               "best; cotangent weights are faster and shrink; the umbrella ignores geometry and lets vertices drift; "
               "natural neighbours and thin plates interpolate above the vertex's foot in the plane of its neighbours "
               "(Szczesna).",
               0,
               8,
               {"umbrella", "cotangent", "cotangent clamped", "cotangent Delaunay", "second difference",
                "second difference with flaps", "natural neighbours", "thin plate 1-ring", "thin plate 2-ring"}},
        op);
    visit(Option{"presmooth", "Presmoothing",
                 "Share of a relaxation step taken before vertices are removed, 0 to 1. It keeps fine noise out of "
                 "coarse levels; 0 is what the papers do. Only Roy and Guskov have it."},
          presmooth);
    visit(Option{"update",
                 "Update",
                 "Szczesna's scheme only. Mean: before a vertex goes, its neighbours take over its share of the mean, "
                 "so that coarse levels are means. None: coarse levels are subsets of the vertices, as in Lazy.",
                 0,
                 1,
                 {"mean", "none"}},
          update);
    visit(
        Option{"grouping",
               "Levels",
               "Independent sets: each level removes sets of vertices that are not neighbours, about a quarter of the "
               "vertices a set (Roy). Sequential: one vertex after the other, cheapest first (Guskov).",
               0,
               1,
               {"independent sets", "sequential"}},
        grouping);
    visit(Option{"storage",
                 "Storage",
                 "How the pyramid keeps weights and details. Float takes half the memory, for meshes of many millions "
                 "of vertices; unchanged bands then come back to about 1e-8 of the mesh's size instead of 1e-15.",
                 0,
                 1,
                 {"double", "float"}},
          storage);
    visit(Option{"sets_per_level", "Sets per level",
                 "Independent sets only: how many sets, a quarter of the vertices each, a level removes. 2 separates "
                 "bands best; 1 sees most of the noise.",
                 1, 100},
          sets);
    visit(Option{"level_ratio", "Level ratio",
                 "Sequential only: share of its vertices that a level keeps, for example 0.8; 0 makes every vertex a "
                 "level of its own.",
                 0, 0.99},
          level_ratio);
    visit(Option{"base_vertices", "Base vertices", "Vertices at which the pyramid stops.", 4,
                 std::numeric_limits<double>::infinity()},
          base_vertices);
    visit(Option{"length_weight", "Even spacing",
                 "Weight of edge length against the quadric error when vertices are chosen: 0 keeps vertices where the "
                 "surface bends, 1 keeps them evenly spaced.",
                 0, 1000},
          length_weight);
    visit(Option{"split",
                 "Order of vertices",
                 "Which vertices go first, and where to. Quadric: those that change the surface least, spaced evenly. "
                 "Regression plane: those nearest to the plane of their neighbours, into the neighbour that turns the "
                 "faces least (Szczesna); flat parts empty first, and even spacing does not apply.",
                 0,
                 1,
                 {"quadric", "regression plane"}},
          split);
    visit(in_degrees(
              {"normal_limit", "Normal limit", "Degrees by which removing a vertex may turn a face at most.", 1, 180}),
          normal_limit);
    visit(Option{"features",
                 "Sharp edges",
                 "Edges that are not smoothed across: none; those where the normals of the two faces differ by more "
                 "than the feature angle; those not marked as faux; those selected on their faces.",
                 0,
                 3,
                 {"none", "by angle", "edges not faux", "selected edges"},
                 "Features"},
          features);
    visit(in_degrees({"feature_angle",
                      "Feature angle",
                      "Degrees between the normals of two faces above which their edge is sharp.",
                      0.01,
                      179.99,
                      {},
                      "Features"}),
          feature_angle);
    // Not for people: other hierarchies for averaging, and what adaptive reconstruction does differently.
    visit(Option{"seed", "", "", -2147483648.0, 2147483647.0}, seed);
    visit(Option{"set_share"}, set_share);
    visit(Option{"valence_power", "", "", 0, 16}, valence_power);
    visit(Option{"memoryless"}, memoryless);
    visit(Option{"boundary_weight", "", "", 0, 1e30}, boundary_weight);
    visit(Option{"flaps"}, flaps);
    visit(Option{"even_rings"}, even_rings);
    visit(Option{"mean_edges"}, mean_edges);
}

/// The description of one option.
/// @throws std::invalid_argument if there is none of that name
PyramidOption pyramid_option(const std::string& name);

/// @throws InputError naming the option that is out of range
void check(const PyramidOptions& options);

/// Hash of all a pyramid depends on: positions, faces, options, and the edges that are features.
ContentHash content_hash(const Layer& layer, const PyramidOptions& options);

/// Marks the feature edges of a layer in its rings.
/// @throws InputError if the layer has none of the marks asked for, or the angle is out of range
void mark_features(Rings& rings, const Layer& layer, Features features, double angle);

}  // namespace multires
