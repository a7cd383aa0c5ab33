#pragma once

#include "base/array.h"
#include "mesh/mesh.h"

#include <cstdint>
#include <vector>

/// The two matrices that all linear systems on a mesh are made of.
///
/// C is the cotangent stiffness: f' C f is the Dirichlet energy, the integral of |grad f|^2 over the surface for the
/// piecewise linear f. It is symmetric, positive semidefinite and its rows sum to 0; M is diagonal, the mass of a
/// vertex is a third of the area of its faces (mesh units squared). Sign: M^-1 C is minus the Laplacian of
/// operators/relaxation.h (up to that one's scale), so f - t M^-1 C f smooths and the eigenvalues of M^-1 C are squares
/// of wave numbers.
///
/// Both are sums over faces, so edges of one face, of three or more, and faces of any orientation need no rule of their
/// own. On an open boundary that gives natural conditions: nothing flows across the rim, and solutions meet it at a
/// right angle. For positions this pulls the rim inwards; fix it or filter it apart if that is not wanted.
///
/// Negative off-diagonal entries (obtuse angles) are kept: clamping them would destroy linear precision, and they do
/// not harm semidefiniteness. The matrix of one face is the Gram matrix of its edges divided by four times the area; an
/// area below `least_area` is replaced by it, which leaves a Gram matrix, whatever the rounding.
namespace multires {

struct StiffnessOptions {
    /// Faces with 2 area < this x (sum of squared edge lengths) count with this area. No unit; an equilateral triangle
    /// has 0.29. Bounds the condition of slivers.
    double least_area = 1e-7;
    /// Masses between neighbours as well, see Stiffness::mass_weight: waves of a few edges then keep their wave number.
    bool spread_mass = false;
    /// C and M of the intrinsic Delaunay triangulation of the surface (solvers/delaunay.h) in place of those of the
    /// faces.
    bool delaunay = false;
};

struct Stiffness {
    Array<Index> offset{0};  ///< #V+1
    Array<Index> column;     ///< #entries: the neighbours of each vertex, ascending, without itself
    Array<double> weight;    ///< #entries: -C_ij, exactly symmetric; C f_i = sum_j weight_ij (f_i - f_j)
    Array<double> mass;      ///< #V, mesh units squared: the sums of the rows of M
    /// #entries, exactly symmetric, or empty if M is diagonal: -M_ij is what is taken from the diagonal. A mean, face
    /// by face, of the diagonal masses and those of linear finite elements. With the share 3/8 sum cot_k e_k^4 / (area
    /// sum e_k^2) of the latter (angles, edges opposite to them; within [-2, 1]) the energy of plane waves, over all
    /// phases and directions, is right to fourth order in the edge, where either mass alone is to second order: expand
    /// 1 - J0(q e) = (q e)^2 / 4 - (q e)^4 / 64 in sum cot_k / 2 (1 - J0(q e_k)) = q^2 (wave's mass). Equilateral
    /// triangles have 1/2, right isosceles ones 3/8. On irregular triangles a part of that energy lies in shorter
    /// waves, which low passes do not see, and waves of 4 edges feel higher orders; so the share is the mean of this
    /// one and 0.62, which on irregular planes brought waves of 4 and 6 edges through low passes best. A quarter of the
    /// diagonal masses <= M.
    Array<double> mass_weight;
    /// What is too dense for entries (bending()): beside them, C is the sum over hubs of u u' - S. The vectors u have
    /// as many columns as the hub has neighbours, and one. S, the matrix with the entries -hub_star between the hub and
    /// them and rows that sum to 0, is of the size of u u' where u varies slowly; the entries hold it, so that they
    /// alone are definite, too. Hub h has hub_offset[h] to hub_offset[h + 1].
    Array<Index> hub;  ///< the vertices
    Array<Index> hub_offset{0};
    Array<Index> hub_column;   ///< ascending for each hub
    Array<double> hub_weight;  ///< u
    Array<double> hub_star;    ///< > 0; of the hub itself 0

    Index rows() const { return static_cast<Index>(mass.size()); }
};

/// @param mesh  indices in range. Faces that repeat an index, or have a corner that is not finite or an edge beyond
/// what
///              can be squared safely, count for nothing.
/// @param held  #V or empty: with `delaunay`, edges between two vertices with a 1 stay
/// Cost: linear, parallel; O(d log d) for a vertex of d faces. Same bits for any number of threads.
Stiffness stiffness(const Mesh& mesh, const StiffnessOptions& options = {}, const std::vector<std::uint8_t>& held = {});

/// out = C f for `width` interleaved channels. Constants give exactly 0.
/// @param f, out  #V by width, not the same
void apply_stiffness(const Stiffness& c, const double* f, int width, double* out);

/// The matrix of the bending energy, C M^-1 C, in the same form: symmetric, semidefinite, rows that sum to 0. f' C M^-1
/// C f is the integral of the squared Laplacian. In units of the mean mass, so that entries do not depend on scale: the
/// matrix times the mean mass. Masses below 1e-6 of the mean count as that. The Laplacian at vertices of more than 100
/// neighbours is kept as one of Stiffness::hub_weight: every pair of those would be an entry. About 19 entries a row.
/// Cost: linear, parallel; same bits for any number of threads.
Stiffness bending(const Stiffness& c);

/// out = M f, the same way.
void apply_mass(const Stiffness& c, const double* f, int width, double* out);

/// Number of the component of each vertex over the edges of C, from 0 in order of their first vertices; vertices
/// without a neighbour are components of their own.
struct Components {
    Array<Index> of;  ///< #V
    Index count = 0;
};
Components components(const Stiffness& c);

}  // namespace multires
