#pragma once

#include "bands/transmission.h"
#include "base/progress.h"
#include "mesh/mesh.h"
#include "mesh/shape_hash.h"
#include "solvers/system.h"

#include <cstdint>
#include <string>
#include <vector>

/// The calibrated filter: a low pass with a transmission by formula on any mesh, for positions and for attributes.
///
/// C u = q^2 M u are the waves of a surface, q their wave numbers (solvers/stiffness.h). With the
/// intrinsic Delaunay triangulation and the masses of Stiffness::mass_weight q is right to 1 % for waves of four mean
/// edges and more, and the low pass
/// (System::rational) multiplies each wave by transmission(order, cutoff, 2 pi / q).
namespace multires {

struct Cutoff {
    LowPassOrder order = LowPassOrder::second;
    double wavelength = 0;  ///< mesh units, of the wave that is halved
};

/// @throws InputError  naming `parameter` unless the wavelength is finite and at least two mean edges
void require_carried(double wavelength, const std::string& parameter, double mean_edge);

/// The systems of a mesh, set up once for all cutoffs and orders. Immutable.
/// Memory: about 350 bytes a vertex, and 300 more while it filters.
class Spline {
public:
    /// @param held  #V or empty: 1 for vertices that keep their values, and that nothing is smoothed across
    Spline(const Mesh& mesh, const std::vector<std::uint8_t>& held, const Progress& progress);

    const ContentHash& hash() const { return hash_; }
    double mean_edge() const { return mean_edge_; }
    const System& solver() const { return system_; }

    /// Low pass of any channels. Constants stay exactly; vertices without faces and held ones keep their values.
    /// @param f, out  #V by width, not the same
    /// @throws InputError  naming `parameter` unless the cutoff is finite and at least two mean edges. Cutoffs beyond a
    ///                     thousand sizes of the mesh count as that: no wave passes.
    void low_pass(const Cutoff& cutoff, ConstRows f, Rows out, const char* parameter, const Progress& progress) const;

    /// Low pass of the shape. Vertices move along the normals of the low-passed surface only: moving all the way, which
    /// evens out the triangles and draws open rims inwards, is no part of the shape. Where that would fold faces (more
    /// than 45 degrees off the low-passed surface: tips that a long cutoff takes away whole), vertices go all the way.
    /// @param mesh  the one given to the constructor
    Positions low_pass(const Mesh& mesh, const Cutoff& cutoff, const char* parameter, const Progress& progress) const;

private:
    /// 1 / k^2.
    double stiffness_of(const Cutoff& cutoff, const char* parameter) const;

    ContentHash hash_;
    double mean_edge_ = 0, size_ = 0;
    System system_;
};

/// What Spline::hash() would be.
ContentHash spline_hash(const Mesh& mesh, const std::vector<std::uint8_t>& held);

/// Transmission as measured on a mesh: test waves through the same solve.
struct MeasuredTransmission {
    double wave = 0;      ///< mesh units, along the surface
    double measured = 0;  ///< mean over the places that run along the wave
    double formula = 0;
};

/// Plane waves of a length along the three axes, filtered, and compared with themselves where the surface runs nearly
/// along the axis (the formula is that of the mean wavelength there). Empty if it does so nowhere.
std::vector<MeasuredTransmission> measure_transmission(const Spline& spline, const Mesh& mesh, const Cutoff& cutoff,
                                                       const std::vector<double>& waves, const Progress& progress);

/// How a displacement lies to the surface it leads to.
struct Drift {
    double normal_rms = 0, tangential_rms = 0;  ///< mesh units, over the vertices with faces, by area
};
Drift drift(const Faces& faces, const Positions& before, const Positions& after);

}  // namespace multires
