#pragma once

#include "mesh/mesh.h"

#include <optional>
#include <string>
#include <vector>

namespace multires {

/// What an attribute means; decides how a host stores it and whether frames rotate it.
enum class AttributeKind { color, quality, texcoord, scalar, point };

/// Per-vertex data that rides on the same pyramid as the positions.
struct Attribute {
    AttributeKind kind = AttributeKind::scalar;
    std::string name;            ///< the host's name of a custom attribute; empty for the built-in ones
    int width = 1;               ///< color 4 (r,g,b,a in 0..255), quality 1, texcoord 2, scalar 1, point 3
    std::vector<double> values;  ///< #V by width, row-major
};

/// Texture coordinate of one corner of a face.
struct Wedge {
    double u = 0, v = 0;
    int texture = 0;  ///< index of the texture image, -1 for none
};

/// One layer of a document, flat. Deleted elements of the host are left out, so vertex i here is the i-th one alive.
struct Layer {
    Mesh mesh;
    std::vector<Attribute> attributes;          ///< those the filter asked for
    std::vector<std::uint8_t> selected_vertex;  ///< #V, 0 or 1; empty if nothing is selected
    std::vector<std::uint8_t> selected_face;    ///< #F, 0 or 1; empty if nothing is selected
    std::vector<std::uint8_t> faux_edges;       ///< #F, bit k = edge (k, k+1) is faux; empty if none is
    std::vector<std::uint8_t> selected_edges;   ///< #F, bit k = edge (k, k+1) is selected; empty if none is
    std::vector<Wedge> wedges;  ///< 3 #F, corner k of face f at 3 f + k; empty if not asked for or not there
    /// 3 #F: the vertices' texture coordinates before these were joined along seams, where they may differ; or empty.
    std::vector<Wedge> cut_texcoord;
    /// Places the mesh in the document, where several layers meet; filters of one layer work in its own coordinates.
    Eigen::Matrix4d to_world = Eigen::Matrix4d::Identity();
};

/// Texture coordinates of the corners, 3 #F, where those of a vertex may differ; empty otherwise.
inline const std::vector<Wedge>& corner_texcoords(const Layer& layer) {
    return layer.wedges.empty() ? layer.cut_texcoord : layer.wedges;
}

/// The custom vertex attribute of layers made of a DerivedMesh that holds its source_vertex.
inline constexpr const char* source_vertex_name = "source_vertex";

/// A mesh made of vertices of another one; the host carries all attributes over by these indices.
struct DerivedMesh {
    std::string name;                    ///< label of the new layer
    std::vector<Index> source_vertex;    ///< #V' indices into the input's vertices
    Faces faces;                         ///< #F' by 3 indices into source_vertex
    std::vector<Index> source_face;      ///< #F' indices into the input's faces: where face attributes come from
    std::optional<Positions> positions;  ///< #V' by 3 where they differ from the source vertices'
    /// #V' by width, where they differ from the source vertices': of kinds and names that the layer has.
    std::vector<Attribute> attributes = {};
};

}  // namespace multires
