#pragma once

#include "shared/table.h"

/// What reports of filters hold, where several filters share it. For the parameter reference and typed callers; a host
/// test compares it with what filters do return.
namespace multires::plugin {

using Returns = std::vector<Returned>;
using Type = Returned::Type;

inline Returns operator+(Returns a, const Returns& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

/// Of every filter that moves vertices.
inline const Returns change_returns{
    {"largest_displacement", Type::real, "mesh units", "The longest way a vertex moved."},
    {"rms_displacement", Type::real, "mesh units", "Root of the mean square of the ways of all vertices."},
    {"volume_before", Type::real, "cubic mesh units", "Enclosed volume of the input; of no use if the mesh is open."},
    {"volume_after", Type::real, "cubic mesh units", "The same of the result."},
    {"area_before", Type::real, "square mesh units", "Surface area of the input."},
    {"area_after", Type::real, "square mesh units", "Surface area of the result."},
    {"centroid_shift", Type::real, "mesh units", "How far the centroid of the surface moved."},
    {"flipped_faces", Type::integer, "", "Faces whose normal turned by more than 90 degrees."},
};

/// Of every filter that uses a pyramid.
inline const Returns pyramid_returns{
    {"pyramid_reused", Type::boolean, "", "The pyramid kept with the mesh was used; otherwise one was built and kept."},
    {"locked_vertices", Type::integer, "",
     "Vertices at non-manifold edges or points, which are neither moved nor removed."},
    {"unreferenced_vertices", Type::integer, "", "Vertices without a face, which stay where they are."},
};

inline const Returns gains_returns{
    {"gains", Type::list, "", "The factor of each level's details, finest first."},
};

/// Those of a filter that are there with some parameters only.
inline Returns sometimes(Returns all) {
    for (Returned& r : all) r.always = false;
    return all;
}

/// Of every filter with the two methods of bands.
inline const Returns band_returns =
    sometimes(gains_returns + pyramid_returns +
              Returns{
                  {"solver_reused", Type::boolean, "",
                   "The solver kept with the mesh was used; otherwise one was set up and kept (spline)."},
                  {"measured_waves", Type::list, "mesh units", "Waves that were tested (measure)."},
                  {"measured_transmission", Type::list, "", "The share that was left of them."},
                  {"formula_transmission", Type::list, "", "The share that the formula leaves of them."},
              });

/// How vertices moved, by the spline method.
inline const Returns moved_returns = sometimes({
    {"normal_rms", Type::real, "mesh units",
     "Root of the mean square of the ways along the normals, by area (spline)."},
    {"tangential_rms", Type::real, "mesh units", "The same of the ways along the surface: drift (spline)."},
});

/// Of every filter of attributes; * stands for color, quality, texcoord or custom_NAME.
inline const Returns attribute_returns{
    {"*_largest_change", Type::real, "units of the attribute",
     "The largest change of a vertex's value; of colours 0 to 255.", false},
    {"*_rms_change", Type::real, "units of the attribute", "Root of the mean square of the changes.", false},
};

}  // namespace multires::plugin
