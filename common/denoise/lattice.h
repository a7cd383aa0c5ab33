#pragma once

#include "mesh/incidence.h"

#include <optional>

namespace multires {

/// The step of the lattice along the axes of space that all coordinates lie on, as they do when they were rounded, mesh
/// units. Nothing if there is none, or none of at least `least`.
/// Cost: O(#V log #V)
std::optional<double> lattice_step(const Positions& positions, double least);

/// True if every vertex is on the middle of an edge of a cubic grid of two steps, as marching cubes put it on the
/// boundary of voxels that are only inside or outside: two coordinates are even multiples of the step, one is odd.
/// @param step  lattice_step()
bool between_voxels(const Positions& positions, double step);

/// Planes along the axes, and creases between them, are as even after rounding as they were. Empty without such planes.
struct EvenPlaces {
    std::vector<std::uint8_t> silent;  ///< #V: 1 where there is nothing else nearby: nothing is seen of the errors
    std::vector<std::uint8_t> axes;    ///< #V: a bit for each coordinate that is that of such a plane
};

/// Terraces of surfaces that run slowly across the lattice are not taken for planes: they are narrow and few, or others
/// as wide follow one step up or down.
/// @param edge  mean edge length
/// Cost: linear in the faces, times the edges that 9 steps are long
EvenPlaces even_places(const Faces& faces, const Positions& positions, const Incidence& at, double step, double edge);

/// Leaves out of moves of vertices what takes them out of the planes.
void keep_in_planes(const EvenPlaces& even, Positions& moves);

/// Moves each coordinate to within so much of where it was, for the truth that was rounded to it is there, and vertices
/// back into their planes.
void keep_within_cells(const EvenPlaces& even, const Positions& rounded, double farthest, Positions& positions);

}  // namespace multires
