#pragma once

#include "mesh/mesh.h"

#include <vector>

/// Forms that are taken off a surface before its texture is measured (ISO 25178-2, F-operation).
namespace multires {

enum class FormKind { none, plane, sphere, cylinder };

/// A fitted form. `none` is the plane z = 0, as for height maps.
struct Form {
    FormKind kind = FormKind::none;
    Vec3 point = Vec3::Zero();  ///< on the plane or on the axis; the sphere's centre
    Vec3 axis = Vec3(0, 0, 1);  ///< unit normal of the plane, unit axis of the cylinder
    double radius = 0;          ///< of sphere and cylinder, mesh units
    double outwards = 1;        ///< -1: faces look towards the centre
};

/// The nearest point of a form.
struct FormFoot {
    Vec3 at;
    Vec3 normal;    ///< unit, on the side the faces look to
    double height;  ///< mesh units along the normal
};
FormFoot foot(const Form& form, const Vec3& p);

/// Orthogonal least squares: planes by eigenvectors, the others by Levenberg and Marquardt's steps from algebraic fits,
/// cylinders from six directions of the axis (those of the positions' and of the normals' spread).
/// @param mesh    usable
/// @param weight  #V, the area around each vertex
/// @throws InputError  naming `form`, if none fits: flat, or more than a tenth of the area leans by more than 60
///                     degrees against the form
/// Cost: linear; some hundred passes over at most 4,000 vertices and twenty over all. Same bits for any number of
/// threads.
Form fit_form(FormKind kind, const Mesh& mesh, const std::vector<double>& weight);

}  // namespace multires
