#pragma once

#include "base/array.h"
#include "mesh/mesh.h"

#include <cstdint>
#include <vector>

/// Edges of a mesh as a graph of lines.
namespace multires {

/// An edge between two faces.
struct MeshEdge {
    Index a, b;     ///< vertices, a < b
    Index face[2];  ///< of the faces
    int corner[2];  ///< edge k of each: (k, k + 1)
};

/// The edges with exactly two faces, ascending by (a, b). Cost: O(n log n).
std::vector<MeshEdge> edges_of_two_faces(const Faces& faces);

struct LineOptions {
    double strong = 0, weak = 0;  ///< of weights
    int shortest = 0;             ///< edges
};

/// Lines of edges, cleaned:
/// - edges of at least the weak weight that hang together with one of at least the strong;
/// - of a face with three of them, the weakest is left out;
/// - loose ends go on along the heaviest edges to another line, if one is within half of `shortest`;
/// - branches and lines with a loose end and fewer edges than `shortest` are left out.
/// @param edges   of a mesh of `vertices` vertices and `faces` faces
/// @param weight  #edges
/// @returns  #edges, 1 for those of a line. Serial.
std::vector<std::uint8_t> clean_lines(const std::vector<MeshEdge>& edges, const std::vector<double>& weight,
                                      Index vertices, Index faces, const LineOptions& options);

}  // namespace multires
