#pragma once

#include "stream/regression.h"
#include "stream/residual_model.h"
#include "stream/star_mesh.h"

#include <array>
#include <vector>

namespace multires::stream {

/// Position on the grid of the present precision.
using Cell = std::array<std::int32_t, 3>;

/// Where a vertex that was just split off lies, given all that lies around it: a linear combination of points and
/// heights whose weights are learned, and the rest coded.
///
/// The two coordinates along which the surface extends most go first, then the third as a height over the surface at
/// that very place: so the rest lies along the normal, without a change of axes that integers would not survive.
class PlaceModel {
public:
    /// @param with_experts  from version 3 of the file on
    explicit PlaceModel(bool with_experts);

    /// @param mesh  with the vertex v and the points and normals of all others
    /// @param star  that of v
    /// @param cell  where v is
    /// @returns where v is
    Cell code(BitCoder& coder, const StarMesh& mesh, const Star& star, Index v, Index parent, const Cell& cell);

private:
    static constexpr int points = 6, heights = 5;
    /// What tells how far off the experts may be.
    using Clues = std::array<Two, 8>;
    /// How far off they are, log2 of cells.
    using Widths = Regression<8, Two>;

    void take(const StarMesh& mesh, Index parent);
    void find_normals(const StarMesh& mesh);
    void find_points(const StarMesh& mesh, Index parent);
    void find_mode(const StarMesh& mesh);
    void add_candidates(const StarMesh& mesh);
    std::int32_t code_with_experts(BitCoder& coder, std::int32_t rest, ResidualModel& model,
                                   ResidualModel::Contexts& contexts, const Clues& clues, Widths& widths);
    std::int32_t code_along(BitCoder& coder, int axis, std::int32_t value);
    std::int32_t code_height(BitCoder& coder, const StarMesh& mesh, Index parent, const Cell& cell);
    std::array<double, heights> height_features(const StarMesh& mesh, Index parent, const Cell& cell) const;

    const Star* star_ = nullptr;       ///< of the vertex that is being placed
    std::vector<Vec3> normal_, flap_;  ///< #spokes; flap: the vertex across the link edge, mirrored
    std::vector<std::uint8_t> has_flap_;
    Vec3 centre_, up_, predicted_, far_, skew_;
    std::array<Vec3, points> point_;
    bool with_experts_;
    std::vector<Vec3> candidate_;  ///< for the mode
    Vec3 mode_{0, 0, 0};
    double support_ = 0;  ///< how many candidates agree
    double apart_mode_ = 0, log_support_ = 0;
    Two mean_, missed_;  ///< of what is coded now; logarithm of the last miss, cells
    Widths widths_along_{{0, 1}}, widths_across_{{0, 0.5, 0, 0.5}};
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
    std::array<ResidualModel, 2> along_, across_;  ///< closed and open stars
};

}  // namespace multires::stream
