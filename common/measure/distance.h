#pragma once

#include "mesh/mesh.h"

#include <cstdint>
#include <limits>
#include <vector>

/// How far apart two surfaces are. All results are the same, to the last bit, for any number of threads.
namespace multires {

/// Finds the closest point of a triangle surface. Refers to the faces and positions, which must outlive it.
class SurfaceTree {
public:
    /// @param faces      at least one; indices in range; faces without an area count as segments or points
    /// @param positions  #V by 3, finite
    /// Cost: O(#F log #F), mostly a linear sort.
    SurfaceTree(const Faces& faces, const Positions& positions);

    struct Hit {
        double squared = std::numeric_limits<double>::infinity();  ///< squared distance, square mesh units
        Index face = -1;                                           ///< a face at that distance
        Vec3 point = Vec3::Zero();
    };

    /// @param hint  a face that may be near, which only makes the search faster; -1: none
    /// Cost: O(log #F) for points near the surface, far less with a good hint.
    Hit closest(const Vec3& p, Index hint = -1) const;

    /// Where a line through p meets the surface.
    struct Crossing {
        double at = std::numeric_limits<double>::infinity();  ///< p + at x direction
        Index face = -1;                                      ///< -1: nowhere
    };

    /// The crossing nearest to p with a face whose normal points along the direction, not against it.
    /// @param direction  of length 1
    /// @param within     the most that |at| may be, mesh units
    /// Cost: O(log #F), and as many faces as the line passes closer to p than the crossing.
    Crossing nearest_crossing(const Vec3& p, const Vec3& direction, double within) const;

private:
    struct Node {
        Eigen::Vector3f low, high;  ///< rounded outwards
    };
    void visit(Index face, const Vec3& p, Hit& hit) const;
    double nearest_in_box(const Node& node, const Vec3& p, const Vec3& direction) const;

    const Faces& faces_;
    const Positions& positions_;
    Vec3 centre_;
    std::vector<Index> order_;  // #F, in order of a space-filling curve
    Index first_leaf_ = 0;      // the nodes are a complete binary tree, children of i at 2i+1 and 2i+2
    std::vector<Node> node_;
};

/// The closest point of the triangle a, b, c.
Vec3 closest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

/// Points spread over a surface, each with its share of the area.
struct SurfaceSamples {
    Positions points;
    std::vector<double> weights;  ///< square mesh units; they sum to the area
    std::vector<Index> face;      ///< a face the point lies on
};

/// All vertices of faces, and the centroids of the triangles that faces are cut into: k^2 for a face whose longest edge
/// is at most k x spacing (k at most 32). With k = 1 the weights integrate quadratic functions exactly.
SurfaceSamples sample_surface(const Faces& faces, const Positions& positions, double spacing);

/// Distance from the points of one surface to another, mesh units.
struct Distance {
    double largest = 0;
    double rms = 0;  ///< sqrt(integral of the squared distance / area)
};
Distance distance_to(const SurfaceSamples& samples, const SurfaceTree& tree);

/// Both ways: `largest` is that of the worse way (Hausdorff), `rms` the root of the mean of the two mean squares.
/// Samples are as dense as the vertices of the finer mesh.
Distance two_sided_distance(const Faces& a_faces, const Positions& a_positions, const Faces& b_faces,
                            const Positions& b_positions);

}  // namespace multires
