#pragma once

#include "mesh/layer.h"

#include <cstdint>
#include <vector>

namespace multires {

/// Where a texture is cut: corners of one vertex have different places in it.
struct TextureSeams {
    std::vector<std::uint8_t> edges;  ///< #F, bit k: edge (k, k+1) is on a seam
    Index junctions = 0;              ///< vertices where more than two edges are
};

/// An edge is on a seam if the texture coordinates of a face there differ from those of all faces across. Faces that
/// are there twice, as front and back, are not across from each other.
/// @param layer  with texture coordinates of corners, see corner_texcoords()
/// Cost: O(#F log #F)
TextureSeams texture_seams(const Layer& layer);

/// Whether there is a texture with seams that may all be kept: at most a twentieth of the vertices, half as many as a
/// tenth of the faces has, are where seams meet and so cannot go. A texture of single triangles is none.
/// Cost: O(#F log #F) if there are texture coordinates of corners
bool can_keep_seams(const Layer& layer);

}  // namespace multires
