#pragma once

#include "mesh/mesh.h"
#include "watermark/code.h"

#include <cstdint>
#include <string>
#include <vector>

/// What carries a watermark: smooth displacements of a middle band of wavelengths, spread over the surface.
namespace multires {

/// 280 places on a surface (half as many as there are vertices, if that is less), as far from each other as they can
/// be, each with a direction (the mean normal around it) and a smooth function of the distance in space: Wendland's of
/// smoothness C2 (H. Wendland, Adv. Comput. Math. 4, 1995), 0 from `radius` on, twice the spacing of the places. A sum
/// of them with coefficients of any signs has waves of about two spacings and longer.
///
/// The coefficients move space, not vertices: whatever lies at one place, such as both sides of a crack or of a thin
/// sheet, moves together, and since the functions are so much longer than high, nothing can fold.
///
/// The places depend on the shape alone and are the same for any order of the vertices (but for ties). They come as
/// a chain of neighbours, so that every part of the surface holds runs of them.
class Carriers {
public:
    static constexpr Index most = 2 * code_bits;

    /// @param mesh  usable (mesh/validation.h)
    /// @throws InputError  if no vertex has a normal
    /// Cost: 280 passes over the vertices; parallel.
    explicit Carriers(const Mesh& mesh);

    Index size() const { return static_cast<Index>(place_.size()); }
    double spacing() const { return spacing_; }  ///< mesh units; no point of the mesh is farther from all places
    double radius() const { return 2 * spacing_; }

    /// Calls each(carrier, value) for those whose function is not 0 at a point.
    template <class Each>
    void visit(const Vec3& point, const Each& each) const {
        for (Index c = 0; c < size(); ++c) {
            const double squared = (point - place_[c]).squaredNorm() / (radius() * radius());
            if (squared < 1) each(c, value(squared));
        }
    }
    const Vec3& direction(Index carrier) const { return direction_[carrier]; }

    /// The sum of coefficient x function x direction.
    /// @param points  #P by 3
    Array<Vec3> displacement(const std::vector<double>& coefficients, const Positions& points) const;

private:
    static double value(double squared_ratio);

    Array<Vec3> place_, direction_;
    double spacing_ = 0;
};

/// Which bit of the code each carrier holds, and with which sign: every half of the carriers holds each bit once, in an
/// order that the key decides.
struct Assignment {
    std::vector<Index> bit;
    std::vector<std::int8_t> sign;  ///< 1 or -1
};
Assignment assignment(const std::string& key);
/// That of another key, for the statistics of wrong keys.
Assignment random_assignment(std::uint64_t seed);

}  // namespace multires
