#pragma once

#include "mesh/mesh.h"

#include <vector>

/// What filters report of a mesh and of a change: sizes, displacements, flips, angles.
///
/// All functions are one parallel pass and give the same result, to the last bit, for any number of threads. Face
/// indices must be in range and positions finite. Faces that repeat an index have no area and do no harm.
namespace multires {

/// The axis-aligned box of all positions, referenced or not; both corners are 0 without positions.
struct Box {
    Vec3 low = Vec3::Zero(), high = Vec3::Zero();
    Vec3 center() const { return 0.5 * (low + high); }
    double diagonal() const { return (high - low).norm(); }
};

Box bounding_box(const Positions& positions);

/// Mean length over the faces' sides (an edge with two faces counts twice, a boundary edge once); 0 without faces.
double mean_edge_length(const Faces& faces, const Positions& positions);

/// Mean square over square of the mean of the same lengths, at least 1: how much the edges differ. 1 without faces.
double edge_spread(const Faces& faces, const Positions& positions);

/// Integrals over a surface.
struct Surface {
    double area = 0;               ///< square mesh units
    double volume = 0;             ///< cubic mesh units; see surface()
    Vec3 centroid = Vec3::Zero();  ///< of the area, mesh units; the origin if the area is 0
};

/// Area, volume and centroid.
///
/// The volume is the sum of the signed tetrahedra between each face and `apex`: the enclosed volume of a closed mesh
/// whose faces are oriented outwards, wherever the apex is. For other meshes it depends on the apex and the
/// orientation; compare such numbers only for one apex. An apex near the mesh keeps digits, so the default is the box
/// centre.
Surface surface(const Faces& faces, const Positions& positions, const Vec3& apex);
Surface surface(const Faces& faces, const Positions& positions);

/// How far vertices moved, mesh units.
struct Displacement {
    double largest = 0;
    double rms = 0;
};

/// @param before, after  #V by 3
Displacement displacement(const Positions& before, const Positions& after);

/// What a filter did to the positions of a mesh; the report of every filter that moves vertices.
struct Change {
    Surface before, after;  ///< volumes about the same apex, the centre of the box before
    Displacement displacement;
    Index flipped_faces = 0;  ///< normals that turned by more than 90 degrees; faces degenerate before do not count
};

/// One pass over the faces and one over the vertices.
/// @param before, after  #V by 3
/// A face is degenerate if 2 area <= 1e-10 x (sum of its squared edge lengths), as in operators/.
Change compare(const Faces& faces, const Positions& before, const Positions& after);

/// Unit normals by the right-hand rule; zero for faces that are degenerate as above.
/// @returns  #F by 3
Array<Vec3> face_normals(const Faces& faces, const Positions& positions);

/// Mean angle between the normals of corresponding faces, degrees; faces degenerate in either mesh do not count: the
/// usual error measure of denoising.
/// @param a, b  #V by 3
double mean_normal_angle(const Faces& faces, const Positions& a, const Positions& b);

/// Shape of triangles, 4 sqrt(3) area / (sum of squared edge lengths): 1 equilateral, 0 degenerate.
struct TriangleQuality {
    double mean = 0;   ///< 0 without faces
    double least = 1;  ///< 1 without faces
};

TriangleQuality triangle_quality(const Faces& faces, const Positions& positions);

/// sqrt(mean of squares); 0 for no values.
double rms(const std::vector<double>& values);

}  // namespace multires
