#pragma once

#include "stream/bit_model.h"
#include "stream/regression.h"
#include "stream/star_mesh.h"

#include <array>
#include <vector>

namespace multires::stream {

/// Position on the grid of the present precision.
using Cell = std::array<std::int32_t, 3>;

/// A number coded as difference to a prediction: its sign, its order of magnitude and its leading bits by context.
class ResidualModel {
public:
    struct Contexts {
        int expected = 0;  ///< 0..63
        int spread = 0;    ///< 0..63 how far off it may be by the shape around it
        int memory = 0;    ///< 0..63 how far off others near it were
        int kind = 0;      ///< 0..15 valence and the like
        int other = 0;     ///< 0..63 what is known of the other coordinates
        int lean = 0;      ///< 0..63 where in its cell the prediction lies
    };
    ResidualModel();
    std::int32_t code(BitCoder& coder, std::int32_t value, const Contexts& contexts);

private:
    static constexpr int nodes = 160;
    bool bit(BitCoder& coder, bool value, int node, const Contexts& c);
    BitModel<7> model_;
};

/// Where a vertex that was just split off lies, given all that lies around it: a linear combination of points and
/// heights whose weights are learned, and the rest coded.
///
/// The two coordinates along which the surface extends most go first, then the third as a height over the surface at
/// that very place: so the rest lies along the normal, without a change of axes that integers would not survive.
class PlaceModel {
public:
    PlaceModel();

    /// @param mesh  with the vertex v and the points and normals of all others
    /// @param star  that of v
    /// @param cell  where v is
    /// @returns where v is
    Cell code(BitCoder& coder, const StarMesh& mesh, const Star& star, Index v, Index parent, const Cell& cell);

private:
    static constexpr int points = 6, heights = 5;

    void take(const StarMesh& mesh, Index parent);
    void find_normals(const StarMesh& mesh);
    void find_points(const StarMesh& mesh, Index parent);
    std::int32_t code_along(BitCoder& coder, int axis, std::int32_t value);
    std::int32_t code_height(BitCoder& coder, const StarMesh& mesh, Index parent, const Cell& cell);
    std::array<double, heights> height_features(const StarMesh& mesh, Index parent, const Cell& cell) const;

    const Star* star_ = nullptr;       ///< of the vertex that is being placed
    std::vector<Vec3> normal_, flap_;  ///< #spokes; flap: the vertex across the link edge, mirrored
    std::vector<std::uint8_t> has_flap_;
    Vec3 centre_, up_, predicted_, far_, skew_;
    std::array<Vec3, points> point_;
    double scale_ = 1, off_ = 0;
    Regression<1> slope_{{0.8}};
    std::array<int, 3> axes_{};  ///< the two along the surface, the one across
    Cell rest_{};
    double memory_along_ = 0, memory_across_ = 0;  ///< log2 of what to expect by the ring's vertices, cells
    bool remembers_ = false;
    double apart_along_ = 0, apart_across_ = 0;
    Regression<9> expect_along_{{0, 1, 0, 0, 0, 0, 0, 0, 0}}, expect_across_{{0, 0.5, 0, 0.5, 0, 0, 0, 0, 0}};
    std::vector<float> missed_along_, missed_across_;  ///< #V: by how much, over the scale; < 0: not known
    std::array<Regression<points>, 2> place_;
    std::array<Regression<heights>, 2> height_;
    std::array<ResidualModel, 2> along_, across_;
};

}  // namespace multires::stream
