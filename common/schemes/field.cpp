#include "schemes/field.h"

#include "base/parallel.h"

#include <algorithm>

namespace multires {

Field to_places(const Hierarchy& hierarchy, const Field& input) {
    Field out = Field::unset(input.rows(), input.width);
    out.has_positions = input.has_positions;
    parallel_for(out.rows(), [&](Index p) { std::copy_n(input.row(hierarchy.order[p]), input.width, out.row(p)); });
    return out;
}

Field to_input(const Hierarchy& hierarchy, const Field& places) {
    Field out = Field::unset(places.rows(), places.width);
    out.has_positions = places.has_positions;
    parallel_for(out.rows(), [&](Index p) { std::copy_n(places.row(p), places.width, out.row(hierarchy.order[p])); });
    return out;
}

Field field_of(const Positions& positions) {
    Field f = Field::unset(static_cast<Index>(positions.size()), 3);
    parallel_for(f.rows(), [&](Index i) { std::copy_n(positions[i].data(), 3, f.row(i)); });
    return f;
}

Positions positions_in_input(const Hierarchy& hierarchy, const Field& places) {
    Positions out(places.rows());
    parallel_for(places.rows(), [&](Index p) { out[hierarchy.order[p]] = Vec3(places.row(p)); });
    return out;
}

Positions positions_of(const Field& field) {
    Positions p(field.rows());
    parallel_for(field.rows(), [&](Index i) { p[i] = Vec3(field.row(i)[0], field.row(i)[1], field.row(i)[2]); });
    return p;
}

}  // namespace multires
