#include "stream/plan.h"

#include "base/error.h"
#include "mesh/adjacency.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace multires::stream {
namespace {

/// Rings of the vertices that may be split off again: the others are irregular here and stay.
Rings removable(const Mesh& mesh) {
    Rings rings = vertex_rings(mesh);
    const StarMesh stars(static_cast<Index>(mesh.positions.size()), mesh.faces);
    Rings out;
    out.kind = rings.kind;
    for (Index v = 0; v < rings.rows(); ++v) {
        const bool regular = rings.kind[v] == RingKind::closed || rings.kind[v] == RingKind::open;
        if (regular && stars.regular(v))
            out.neighbor.insert(out.neighbor.end(), rings.begin(v), rings.begin(v) + rings.size(v));
        else if (regular)
            out.kind[v] = RingKind::irregular;
        out.offset.push_back(static_cast<Index>(out.neighbor.size()));
    }
    return out;
}

HierarchyOptions plain_sets() {
    HierarchyOptions o;
    o.memoryless = true;
    o.normal_limit_degrees = 80;
    o.flaps = o.even_rings = false;
    return o;
}

HierarchyOptions fine_sets(Index vertices) {
    HierarchyOptions o = plain_sets();
    o.length_weight = 0.03;
    o.base_vertices = std::max<Index>(4, static_cast<Index>(vertices * 0.44));
    return o;
}

HierarchyOptions coarse_sets() {
    HierarchyOptions o = plain_sets();
    o.length_weight = 0.003;
    o.set_share = 0.5;
    o.base_vertices = 4;
    return o;
}

}  // namespace

Plan::Plan(const Faces& faces, const std::vector<Cell>& cells, const Tick& tick) : faces_(faces), cells_(cells) {
    Mesh mesh{Positions(cells.size()), faces};
    for (std::size_t i = 0; i < cells.size(); ++i) mesh.positions[i] = Vec3(cells[i][0], cells[i][1], cells[i][2]);
    Hierarchy fine =
        build_hierarchy(removable(mesh), mesh.positions, fine_sets(static_cast<Index>(cells.size())), tick);
    const Positions left(fine.positions.begin(), fine.positions.begin() + fine.size.back());
    Hierarchy coarse = build_hierarchy(std::move(fine.base), left, coarse_sets(), tick);
    base_ = coarse.size.back();
    Positions positions = std::move(fine.positions);
    std::copy(coarse.positions.begin(), coarse.positions.end(), positions.begin());
    parent_ = std::move(coarse.parent);
    Array<Index> coarse_place(coarse.vertices());
    for (Index p = 0; p < coarse.vertices(); ++p) {
        coarse_place[coarse.order[p]] = p;
        order_.push_back(fine.order[coarse.order[p]]);
    }
    for (std::size_t k = coarse.levels.size(); k-- > 0;)
        batches_.push_back({coarse.levels[k].coarse, std::move(coarse.levels[k].odd)});
    add_fine(std::move(fine), coarse_place);
    estimate_errors(positions);
    place_.resize(base_);
    std::iota(place_.begin(), place_.end(), 0);
    vertex_.assign(order_.size(), -1);
    std::iota(vertex_.begin(), vertex_.begin() + base_, 0);
}

/// @param coarse_place  places of the fine hierarchy's base in the coarse one
void Plan::add_fine(Hierarchy fine, const Array<Index>& coarse_place) {
    const Index coarse = static_cast<Index>(coarse_place.size());
    const auto place = [&](Index p) { return p < coarse ? coarse_place[p] : p; };
    for (Index p = coarse; p < fine.vertices(); ++p) {
        order_.push_back(fine.order[p]);
        parent_.push_back(place(fine.parent[p]));
    }
    for (std::size_t k = fine.levels.size(); k-- > 0;) {
        batches_.push_back({fine.levels[k].coarse, std::move(fine.levels[k].odd)});
        for (Index& p : batches_.back().odd.neighbor) p = place(p);
    }
}

Faces Plan::base_faces() const {
    Array<Index> gone_to(order_.size());  // parents come before their children
    for (Index p = 0; p < static_cast<Index>(order_.size()); ++p) gone_to[p] = p < base_ ? p : gone_to[parent_[p]];
    Array<Index> of_input(order_.size());
    for (std::size_t p = 0; p < order_.size(); ++p) of_input[order_[p]] = gone_to[p];
    Faces out;
    for (const Face& f : faces_) {
        const Face g = {of_input[f[0]], of_input[f[1]], of_input[f[2]]};
        if (!repeats_an_index(g) || repeats_an_index(f)) out.push_back(g);
    }
    return out;
}

/// What each batch adds is the distance of its vertices from the planes of the faces they leave behind; batches add
/// like independent noise.
void Plan::estimate_errors(const Positions& p) {
    error_.assign(batches(), 0);
    double sum = 0;
    for (std::size_t b = batches(); b-- > 0;) {
        const Batch& batch = batches_[b];
        double squares = 0;
        for (Index row = 0; row < batch.odd.rows(); ++row) {
            const Vec3& v = p[batch.coarse + row];
            const Vec3& u = p[parent_[batch.coarse + row]];
            double least = (v - u).squaredNorm();
            for (Index j = 0; j + 1 < batch.odd.size(row); ++j) {
                const Vec3 n = (p[batch.odd.begin(row)[j]] - u).cross(p[batch.odd.begin(row)[j + 1]] - u);
                const double size = n.squaredNorm(), height = n.dot(v - u);
                if (size > 0) least = std::min(least, height * height / size);
            }
            squares += least;
        }
        sum += squares / (batch.coarse + batch.odd.rows());
        error_[b] = std::sqrt(sum);
    }
}

void Plan::begin_batch(std::size_t batch) {
    batch_ = &batches_[batch];
    first_row_.assign(batch_->coarse, -1);
    next_row_.assign(batch_->odd.rows(), -1);
    for (Index row = batch_->odd.rows() - 1; row >= 0; --row) {
        const Index parent = vertex_[parent_[batch_->coarse + row]];
        next_row_[row] = first_row_[parent];
        first_row_[parent] = row;
    }
    ring_.clear();
    for (const Index place : batch_->odd.neighbor) ring_.push_back(vertex_[place]);
}

std::optional<NewVertex> Plan::next(Index u, const Star& star) {
    const Index row = first_row_[u];
    if (row < 0) return std::nullopt;
    NewVertex out{find_fan(row, u, star), cells_[order_[batch_->coarse + row]]};
    for (std::int32_t& x : out.cell) x >>= bits_less;
    return out;
}

void Plan::done(Index u, Index v) {
    const Index row = first_row_[u];
    first_row_[u] = next_row_[row];
    place_.push_back(batch_->coarse + row);
    vertex_[batch_->coarse + row] = v;
}

Cell Plan::cell(Index v) const {
    Cell out = cells_[source(v)];
    for (std::int32_t& x : out) x >>= bits_less;
    return out;
}

Fan Plan::find_fan(Index row, Index parent, const Star& star) const {
    const Rings& odd = batch_->odd;
    const Index k = odd.size(row), d = star.faces(), m = k - 2;
    const Index* const ring = &ring_[odd.offset[row]];
    Index t = 0;
    while (ring[t] != parent) ++t;
    const auto vertex = [&](Index i) { return ring[i < 0 ? i + k : i < k ? i : i - k]; };
    if (odd.kind[row] == RingKind::open) {
        if (star.spoke[0] == vertex(t == 0 ? k - 1 : 0)) return {Fan::first, 0, m};
        return {Fan::last, d - m, m};
    }
    for (Index i = 0; i < d; ++i) {
        const bool forward = star.spoke[i] == vertex(t + 1) && star.spoke[i + 1] == vertex(t + 2);
        const bool back = star.spoke[i] == vertex(t - 1) && star.spoke[i + 1] == vertex(t - 2);
        if (forward || back) return {Fan::inside, i, m};
    }
    throw std::logic_error("a fan was not found");
}

}  // namespace multires::stream
