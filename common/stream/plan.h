#pragma once

#include "hierarchy/hierarchy.h"
#include "stream/progress.h"

#include <vector>

namespace multires::stream {

/// What an encoder is going to write: the mesh taken down to a base, and the batches of vertices that lead back.
///
/// Batches are the independent sets of a hierarchy, in two parts. Fine ones are as large as can be and keep triangles
/// even, which costs the fewest bits; coarse ones take the cheapest half of what they could and go by the quadric
/// almost alone, which gives the best prefixes.
///
/// A region that is to come first is left alone until all else has been taken down to a few vertices: so it is whole
/// before these are split again.
class Plan final : public Guide {
public:
    /// @param cells  #V of the input, at the finest precision
    /// @param first  #V: 1 in the region that is to come first; empty: there is none
    /// @param tick   see build_hierarchy()
    Plan(const Faces& faces, const std::vector<Cell>& cells, std::vector<std::uint8_t> first = {},
         const Tick& tick = {});

    Faces base_faces() const;
    Index base_vertices() const { return base_; }
    std::size_t batches() const { return batches_.size(); }
    /// Input vertex of vertex v of the stream.
    Index source(Index v) const { return order_[place_[v]]; }
    /// Estimate of the RMS distance, in cells, of the input's vertices from the mesh before a batch.
    double error(std::size_t batch) const { return error_[batch]; }
    /// The same for what the cells' precision should follow: only the region's vertices, while it is not whole.
    double error_of_first(std::size_t batch) const { return first_.empty() ? error_[batch] : error_of_first_[batch]; }

    /// Most of the input lies in planes, as machined parts do.
    bool planes() const { return planes_; }

    /// How many batches it takes until the region is whole; all without one.
    std::size_t batches_of_first() const { return batches_of_first_; }

    void begin_batch(std::size_t batch);
    std::optional<NewVertex> next(Index u, const Star& star) override;
    void done(Index u, Index v) override;
    Cell cell(Index v) const override;

    int bits_less = 0;  ///< by how much the cells are coarser at present

private:
    struct Batch {
        Index coarse = 0;  ///< vertices before it; its row r is that of place coarse + r
        std::size_t stage = 0;
        RowRange rows;  ///< of odd_[stage]
    };
    std::vector<Hierarchy> stages(const Mesh& mesh, const Rings& rings, const Tick& tick) const;
    void join(std::vector<Hierarchy> stages);
    void estimate_errors();
    double squared_height(const Batch& batch, Index row) const;
    Fan find_fan(Index row, Index parent, const Star& star) const;

    Faces faces_;
    std::vector<Cell> cells_;
    Index base_ = 0;
    Array<Index> order_, parent_;  ///< #V by place, as in Hierarchy
    std::vector<Rings> odd_;       ///< of each stage, at the moment of their removal, in places
    std::vector<Batch> batches_;   ///< in order of the stream
    std::vector<double> error_, error_of_first_;
    std::vector<std::uint8_t> first_;
    bool planes_ = false;
    std::size_t batches_of_first_ = 0;
    std::vector<Index> place_, vertex_;  ///< of vertices of the stream; and back, -1: not yet there
    const Batch* batch_ = nullptr;
    std::vector<Index> first_row_, next_row_;  ///< rows of each vertex's children in the batch; -1: none
    std::vector<Index> ring_;                  ///< the batch's rings, in vertices of the stream
    Index first_entry_ = 0;                    ///< of odd_, of ring_[0]
};

}  // namespace multires::stream
