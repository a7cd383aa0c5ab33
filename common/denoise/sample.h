#pragma once

#include "denoise/neighbours.h"

namespace multires {

constexpr Index whole_up_to = 25000;  ///< vertices; what is done to larger meshes is decided on patches of them

/// Patches of a large mesh, on which is decided what is done to the whole.
struct Sample {
    Faces faces;
    Positions positions;
    Incidence at;
    Neighbours near;
    std::vector<Index> vertex;       ///< #positions: of the mesh
    std::vector<std::uint8_t> core;  ///< #positions: vertices that count, not too near to where patches were cut out
};

/// Breadth-first balls around vertices that are spread over the indices.
/// @param count, size  at most so many patches of at most so many vertices
/// Cost: linear in the faces
Sample patches_of(const Faces& faces, const Positions& positions, const Neighbours& near, Index count, Index size);

}  // namespace multires
