#pragma once

#include "stream/fan_model.h"
#include "stream/place_model.h"
#include "stream/star_mesh.h"

#include <array>
#include <optional>
#include <vector>

namespace multires::stream {

/// A vertex that is to be split off: what an encoder knows and a decoder finds out.
struct NewVertex {
    Fan fan;
    Cell cell{};
};

/// What the encoder asks its own data while the decoder's mesh grows.
class Guide {
public:
    Guide() = default;
    Guide(const Guide&) = delete;
    Guide& operator=(const Guide&) = delete;
    virtual ~Guide() = default;
    /// The next vertex to split off u, none if there is no more in this batch.
    virtual std::optional<NewVertex> next(Index u, const Star& star) = 0;
    /// Called when it has been split off as vertex v.
    virtual void done(Index u, Index v) = 0;
    /// The coordinates of a vertex, at the present precision.
    virtual Cell cell(Index v) const = 0;
};

/// Moves vertices of closed stars along their normals, away from the mean of their rings.
/// @param share  of the distance from that mean along the normal
void add_bulge(const StarMesh& mesh, const Positions& from, double share, Positions& to);

/// The mesh as it is known so far, and all that encoder and decoder learned on the way to it.
///
/// A batch goes through all regular vertices there are at its begin and splits from each none, one or several vertices
/// that are not neighbours of each other; so the faces around a vertex that was split off are taken for the rest of the
/// batch.
class Progress {
public:
    /// @param cells      of the base's vertices, at `bits` bits
    /// @param most       vertices there will be at most
    /// @param version    of the file, which the models follow
    Progress(std::vector<Cell> cells, const Faces& faces, int bits, Index most, int version);

    /// Goes to the next vertex and codes what is split off it; begins a new batch after the last one.
    /// @param guide  null when decoding
    /// @throws InputError  if what is read makes no sense
    void visit(BitCoder& coder, Guide* guide);

    /// True when the next visit() begins a batch.
    bool at_end_of_batch() const { return at_ == order_.size(); }
    std::size_t batch_size() const { return order_.size(); }  ///< visits of the present batch

    /// Codes one more bit of all coordinates; only at the end of a batch.
    void refine(BitCoder& coder, const Guide* guide);

    const StarMesh& mesh() const { return mesh_; }
    const std::vector<Cell>& cells() const { return cells_; }
    const std::vector<Index>& parents() const { return parent_; }  ///< #V: what each was split off; -1 in the base
    int bits() const { return bits_; }

private:
    void begin_batch();
    void look_ahead();
    bool may_split(int children) const;
    void rank_fans(Index u);
    bool is_split(BitCoder& coder, bool yes, int children, bool looked);
    void split(BitCoder& coder, Index u, const NewVertex& wanted);
    int alike_around(Index v, int axis) const;
    Positions points() const;

    StarMesh mesh_;
    std::vector<Cell> cells_;
    std::vector<Index> parent_;
    int bits_;
    Index most_;
    bool first_models_;  ///< those of versions 1 and 2

    std::vector<Index> order_;  ///< of the batch
    std::size_t at_ = 0;
    static constexpr std::size_t ahead = 8;
    std::array<Index, ahead> prefetched_{};  ///< see StarMesh::prefetch(): of vertices ahead, by their index in order_
    Index before_batch_ = 0;                 ///< vertices
    Index batch_ = 0;                        ///< counted from 1; the mark of faces around vertices that are new in it
    double density_ = 0.3, mean_area_ = 0;
    StarShape shape_;
    Star star_;
    FanModel fans_;
    PlaceModel places_;
    BitModel<5> is_split_;
    BitModel<3> finer_;
};

}  // namespace multires::stream
