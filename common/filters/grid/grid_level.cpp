#include "filters/grid/grid_level.h"

#include "filters/channels.h"
#include "filters/grid/level_values.h"
#include "filters/placement.h"
#include "mesh/validation.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace multires {
namespace {

/// Positions, and the attributes if they follow.
std::vector<Field> fields_of(const Layer& layer, const std::vector<Channels>& attributes) {
    std::vector<Field> fields{field_of(layer.mesh.positions)};
    for (const Channels& c : attributes) fields.push_back(c.field);
    return fields;
}

std::vector<Channels> following(const Layer& layer, bool attributes) {
    return attributes ? usable_channels(layer) : std::vector<Channels>();
}

/// An attribute of the layer with the values of a level.
Attribute of_level(const Attribute& attribute, const Field& values) {
    Attribute out = attribute;
    out.values.assign(values.values.begin(), values.values.end());
    if (out.kind == AttributeKind::color)
        for (double& x : out.values) x = std::clamp(x, 0.0, 255.0);
    return out;
}

/// As hosts keep a value.
double stored(double value, AttributeKind kind) {
    return kind == AttributeKind::color ? std::round(std::clamp(value, 0.0, 255.0)) : static_cast<float>(value);
}

/// What the edit moved each control point by; nothing if single precision cannot tell any of them.
Field ways_of(const Field& before, const Positions& after) {
    const Positions old = positions_of(before);
    const auto same = [](const Vec3& a, const Vec3& b) { return a.cast<float>() == b.cast<float>(); };
    Field way(before.rows(), 3);
    if (!std::equal(old.begin(), old.end(), after.begin(), same))
        for (Index v = 0; v < way.rows(); ++v)
            for (int c = 0; c < 3; ++c) way.row(v)[c] = after[v][c] - old[v][c];
    return way;
}

/// What it changed an attribute by; nothing if the edited layer does not have it.
Field ways_of(const Field& before, const Attribute& attribute, const Layer& edited) {
    Field way(before.rows(), before.width);
    for (const Attribute& a : edited.attributes) {
        if (a.kind != attribute.kind || a.name != attribute.name || a.width != before.width) continue;
        for (std::size_t i = 0; i < way.values.size(); ++i) {
            require(is_usable(a.values[i]), "edited: values of an attribute are not finite, or beyond 1e70");
            way.values[i] = stored(a.values[i], a.kind) - stored(before.values[i], a.kind);
        }
    }
    return way;
}

}  // namespace

Result generate_grid_level(const Layer& layer, const GridLevelOptions& options, Session& session) {
    session.progress.report(0, "Finding the grid");
    const FoundGrids found = grids_of(layer, options.grid);
    const std::vector<GridPyramid> pyramids = pyramids_of(found, options.grid);
    const int last = pyramids[0].levels();
    require(options.level >= 0 && options.level <= last,
            "level must be between 0 and " + std::to_string(last) + ", the number of levels of this mesh");
    require(options.refine >= 0 && options.refine <= options.level + 3,
            "refine must be between 0 and " + std::to_string(options.level + 3) + ", three more than the level");
    session.progress.report(0.2, "Transforming");
    const std::vector<Channels> attributes = following(layer, options.attributes);
    GridLevelMesh made = level_of(found, pyramids, fields_of(layer, attributes), layer.mesh.faces, options.level,
                                  options.level - options.refine);
    DerivedMesh derived = std::move(made.mesh);
    derived.positions = positions_of(made.values[0]);
    for (std::size_t a = 0; a < attributes.size(); ++a)
        derived.attributes.push_back(of_level(layer.attributes[attributes[a].attribute], made.values[a + 1]));
    derived.name = options.refine == 0 ? "control mesh " + std::to_string(options.level)
                                       : "surface of level " + std::to_string(options.level);
    Result result;
    result.report.add("vertices", static_cast<int>(derived.source_vertex.size()));
    result.report.add("faces", static_cast<int>(derived.faces.size()));
    result.layer = std::move(derived);
    return result;
}

Result grid_edit(const Inputs& inputs, const GridEditOptions& options, Session& session) {
    const Layer& layer = inputs.current;
    Result result;
    session.progress.report(0, "Finding the grid");
    const FoundGrids found = grids_of(layer, options.grid);
    const Layer& edited = inputs.other(options.edited, "edited");
    const std::vector<double> weights = region_weights(layer, options.region);
    require(std::all_of(edited.mesh.positions.begin(), edited.mesh.positions.end(),
                        [](const Vec3& p) { return p.allFinite(); }),
            "edited: coordinates are not numbers or infinite");
    const std::vector<GridPyramid> pyramids = pyramids_of(found, options.grid);
    const int level = matching_level(found, pyramids, layer.mesh, edited.mesh, session.progress);
    const std::vector<Channels> attributes = following(layer, options.attributes);
    std::vector<Field> fields = fields_of(layer, attributes);
    const GridLevelMesh before = level_of(found, pyramids, fields, layer.mesh.faces, level, level);
    session.progress.report(0.8, "Following");
    const Faces& faces = layer.mesh.faces;
    follow(found, pyramids, faces, level, ways_of(before.values[0], in_layer(edited, layer, "edited")), fields[0]);
    Positions after = positions_of(fields[0]);
    blend(layer.mesh.positions, weights, after);
    result.report.add("level", level);
    for (std::size_t a = 0; a < attributes.size(); ++a) {
        const Attribute& attribute = layer.attributes[attributes[a].attribute];
        follow(found, pyramids, faces, level, ways_of(before.values[a + 1], attribute, edited), fields[a + 1]);
        result.attributes.push_back(changed_attribute(layer, attributes[a], fields[a + 1], weights, result.report));
    }
    report_change(layer, after, result.report);
    result.positions = std::move(after);
    return result;
}

}  // namespace multires
