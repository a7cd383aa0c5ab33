#include "stream/plan.h"

#include "base/error.h"
#include "mesh/adjacency.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <stdexcept>

namespace multires::stream {
namespace {

constexpr std::size_t outside_stages = 2;  ///< of those of a plan with a region
constexpr double fine_share = 0.44;        ///< of the vertices that fine sets leave
constexpr double outside_share = 0.016;    ///< of those outside a region that are there when the region is whole
constexpr double least_batch = 0.01;       ///< of the vertices that are there

/// Which vertices are regular in a StarMesh: those whose faces are the triangles of their rings, all turning the same
/// way.
std::vector<std::uint8_t> turn_alike(const Faces& faces, const Rings& rings) {
    const std::size_t count = rings.kind.size();
    std::vector<Index> turns(count, 0), corners(count, 0);
    for (const Face& f : faces)
        for (int k = 0; k < 3; ++k) {
            const Index v = f[k], size = rings.size(v);
            ++corners[v];
            const Index* const ring = rings.begin(v);
            const Index j = static_cast<Index>(std::find(ring, ring + size, f[(k + 1) % 3]) - ring);
            if (j == size) continue;
            const bool closed = rings.kind[v] == RingKind::closed;
            const Index after = j + 1 < size ? ring[j + 1] : closed ? ring[0] : -1;
            const Index before = j > 0 ? ring[j - 1] : closed ? ring[size - 1] : -1;
            turns[v] += static_cast<int>(after == f[(k + 2) % 3]) - static_cast<int>(before == f[(k + 2) % 3]);
        }
    std::vector<std::uint8_t> out(count);
    for (std::size_t v = 0; v < count; ++v) {
        const Index triangles = rings.size(static_cast<Index>(v)) - (rings.kind[v] == RingKind::closed ? 0 : 1);
        out[v] = corners[v] == triangles && std::abs(turns[v]) == triangles;
    }
    return out;
}

/// Rings of the vertices that may be split off again: the others are irregular here and stay.
/// @param rings  of the mesh
/// @param stay   #V: 1 for others that stay; empty: none
Rings removable(const Mesh& mesh, const Rings& rings, const std::vector<std::uint8_t>& stay) {
    const std::vector<std::uint8_t> alike = turn_alike(mesh.faces, rings);
    Rings out;
    out.kind = rings.kind;
    for (Index v = 0; v < rings.rows(); ++v) {
        const bool regular = rings.kind[v] == RingKind::closed || rings.kind[v] == RingKind::open;
        if (regular && alike[v] && (stay.empty() || !stay[v]))
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

HierarchyOptions fine_sets(double base) {
    HierarchyOptions o = plain_sets();
    o.length_weight = 0.03;
    o.base_vertices = std::max<Index>(4, static_cast<Index>(base));
    return o;
}

HierarchyOptions coarse_sets(double base) {
    HierarchyOptions o = fine_sets(base);
    o.length_weight = 0.003;
    o.set_share = 0.5;
    return o;
}

/// Machined parts: what lies within a plane costs next to nothing to take away or to put back, so the fewer sets the
/// better, and what counts is that the corners' fans do not grow.
HierarchyOptions for_planes(HierarchyOptions o) {
    const bool coarse = o.set_share < 1;
    o.length_weight = coarse ? 0.001 : 0.005;
    if (coarse) o.set_share = 0.7, o.valence_power = 3;
    return o;
}

/// True if most edges do not bend: those of planes, in cells.
bool mostly_planes(const Rings& rings, const Positions& p) {
    constexpr double least = 0.65, square_of_cosine = 0.9997;  // of one degree
    std::size_t edges = 0, flat = 0;                           // each edge from its first vertex
    for (Index v = 0; v < rings.rows(); ++v) {
        const Index size = rings.size(v), inner = rings.kind[v] == RingKind::closed ? size : size - 1;
        const Index* const ring = rings.begin(v);
        if (size < 3) continue;
        const auto normal = [&](Index j) {
            return Vec3((p[ring[j]] - p[v]).cross(p[ring[j + 1 < size ? j + 1 : 0]] - p[v]));
        };
        Vec3 before = normal(inner == size ? size - 1 : 0);
        for (Index j = inner == size ? 0 : 1; j < inner; ++j) {
            const Vec3 after = normal(j);
            if (v < ring[j]) {
                const double cosine = before.dot(after);
                ++edges;
                flat += cosine > 0 && cosine * cosine >= square_of_cosine * before.squaredNorm() * after.squaredNorm();
            }
            before = after;
        }
    }
    return edges > 0 && static_cast<double>(flat) >= least * static_cast<double>(edges);
}

/// Leaves in the base what only went one by one: visiting all others for each takes its time.
void cut(Hierarchy& h) {
    while (!h.levels.empty() && h.levels.back().fine - h.levels.back().coarse < least_batch * h.levels.back().coarse) {
        h.levels.pop_back();
        h.size.pop_back();
    }
}

/// The mesh that a hierarchy leaves, in places of its base.
Mesh left(const Mesh& mesh, const Hierarchy& h) {
    const Index base = h.size.back();
    Array<Index> gone_to(h.vertices()), of_input(h.vertices());
    for (Index p = 0; p < h.vertices(); ++p) {
        gone_to[p] = p < base ? p : gone_to[h.parent[p]];
        of_input[h.order[p]] = gone_to[p];
    }
    Mesh out{Positions(h.positions.begin(), h.positions.begin() + base), {}};
    for (const Face& f : mesh.faces) {
        const Face g = {of_input[f[0]], of_input[f[1]], of_input[f[2]]};
        if (!repeats_an_index(g) || repeats_an_index(f)) out.faces.push_back(g);
    }
    return out;
}

}  // namespace

Plan::Plan(const Faces& faces, const std::vector<Cell>& cells, std::vector<std::uint8_t> first, const Tick& tick)
    : faces_(faces), cells_(cells), first_(std::move(first)) {
    Mesh mesh{Positions(cells.size()), faces};
    for (std::size_t i = 0; i < cells.size(); ++i) mesh.positions[i] = Vec3(cells[i][0], cells[i][1], cells[i][2]);
    if (std::find(first_.begin(), first_.end(), 1) == first_.end()) first_.clear();
    const Rings rings = vertex_rings(mesh);
    planes_ = mostly_planes(rings, mesh.positions);
    join(stages(mesh, rings, tick));
    estimate_errors();
    place_.resize(base_);
    std::iota(place_.begin(), place_.end(), 0);
    vertex_.assign(order_.size(), -1);
    std::iota(vertex_.begin(), vertex_.begin() + base_, 0);
}

/// Hierarchies, each of the mesh that the one before has left, the finest first.
std::vector<Hierarchy> Plan::stages(const Mesh& mesh, const Rings& whole, const Tick& tick) const {
    std::vector<Hierarchy> out;
    const auto add = [&](Rings rings, const Positions& positions, const HierarchyOptions& options) {
        out.push_back(build_hierarchy(std::move(rings), positions, planes_ ? for_planes(options) : options, tick));
        const Hierarchy& h = out.back();
        return Positions(h.positions.begin(), h.positions.begin() + h.size.back());
    };
    Mesh rest = mesh;
    if (!first_.empty()) {
        const auto kept = static_cast<double>(std::count(first_.begin(), first_.end(), 1));
        const double others = static_cast<double>(first_.size()) - kept;
        const Positions some =
            add(removable(mesh, whole, first_), mesh.positions, fine_sets(kept + fine_share * others));
        Rings rings = std::move(out[0].base);
        add(std::move(rings), some, coarse_sets(kept + outside_share * others));
        cut(out[1]);
        rest = left(left(mesh, out[0]), out[1]);
    }
    const Positions some = add(removable(rest, first_.empty() ? whole : vertex_rings(rest), {}), rest.positions,
                               fine_sets(fine_share * rest.positions.size()));
    Rings rings = std::move(out.back().base);
    add(std::move(rings), some, coarse_sets(4));
    return out;
}

/// Makes one order, one list of parents and one of batches out of them.
void Plan::join(std::vector<Hierarchy> stages) {
    // Places of the finest are those of the whole; the places of a base are the next stage's vertices.
    Array<Index> input(cells_.size());  // of each of the stage's vertices
    std::iota(input.begin(), input.end(), 0);
    std::vector<Array<Index>> inputs;
    for (const Hierarchy& h : stages) {
        Array<Index> of_place(h.vertices());
        for (Index p = 0; p < h.vertices(); ++p) of_place[p] = input[h.order[p]];
        input.assign(of_place.begin(), of_place.begin() + h.size.back());
        inputs.push_back(std::move(of_place));
    }
    base_ = stages.back().size.back();
    Array<Index> place(base_);  // in the whole, of the stage's base
    std::iota(place.begin(), place.end(), 0);
    order_.assign(inputs.back().begin(), inputs.back().begin() + base_);
    parent_.assign(base_, -1);
    for (std::size_t k = stages.size(); k-- > 0;) {
        Hierarchy& h = stages[k];
        for (Index p = static_cast<Index>(place.size()); p < h.vertices(); ++p) {
            place.push_back(p);
            order_.push_back(inputs[k][p]);
            parent_.push_back(place[h.parent[p]]);
        }
        for (std::size_t l = h.levels.size(); l-- > 0;)
            batches_.push_back({h.levels[l].coarse, odd_.size(), h.levels[l].odd});
        odd_.push_back(std::move(h.odd));
        for (Index& p : odd_.back().neighbor) p = place[p];
        Array<Index> of_vertex(h.vertices());
        for (Index p = 0; p < h.vertices(); ++p) of_vertex[h.order[p]] = place[p];
        place = std::move(of_vertex);
        if (first_.empty() || k == outside_stages) batches_of_first_ = batches();
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
void Plan::estimate_errors() {
    error_.assign(batches(), 0);
    error_of_first_.assign(batches(), 0);
    double sum = 0, sum_of_first = 0;
    auto left = std::count(first_.begin(), first_.end(), 1);  // of the region's vertices, with the batch
    for (std::size_t b = batches(); b-- > 0;) {
        const Batch& batch = batches_[b];
        double squares = 0, squares_of_first = 0;
        std::ptrdiff_t gone = 0;
        for (Index row = 0; row < batch.rows.size(); ++row) {
            const double square = squared_height(batch, row);
            squares += square;
            if (!first_.empty() && first_[order_[batch.coarse + row]]) squares_of_first += square, ++gone;
        }
        sum += squares / (batch.coarse + batch.rows.size());
        error_[b] = std::sqrt(sum);
        if (gone > 0) sum_of_first += squares_of_first / static_cast<double>(left);
        left -= gone;
        error_of_first_[b] = std::sqrt(sum_of_first);
    }
}

double Plan::squared_height(const Batch& batch, Index row) const {
    const auto point = [&](Index place) {
        const Cell& c = cells_[order_[place]];
        return Vec3(c[0], c[1], c[2]);
    };
    const Vec3 u = point(parent_[batch.coarse + row]), v = point(batch.coarse + row);
    double least = (v - u).squaredNorm();
    const Rings& odd = odd_[batch.stage];
    const Index* const ring = odd.begin(batch.rows.begin + row);
    for (Index j = 0; j + 1 < odd.size(batch.rows.begin + row); ++j) {
        const Vec3 n = (point(ring[j]) - u).cross(point(ring[j + 1]) - u);
        const double size = n.squaredNorm(), height = n.dot(v - u);
        if (size > 0) least = std::min(least, height * height / size);
    }
    return least;
}

void Plan::begin_batch(std::size_t batch) {
    batch_ = &batches_[batch];
    first_row_.assign(batch_->coarse, -1);
    next_row_.assign(batch_->rows.size(), -1);
    for (Index row = batch_->rows.size() - 1; row >= 0; --row) {
        const Index parent = vertex_[parent_[batch_->coarse + row]];
        next_row_[row] = first_row_[parent];
        first_row_[parent] = row;
    }
    ring_.clear();
    const Rings& odd = odd_[batch_->stage];
    first_entry_ = odd.offset[batch_->rows.begin];
    for (Index k = first_entry_; k < odd.offset[batch_->rows.end]; ++k) ring_.push_back(vertex_[odd.neighbor[k]]);
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
    const Rings& odd = odd_[batch_->stage];
    row += batch_->rows.begin;
    const Index k = odd.size(row), d = star.faces(), m = k - 2;
    const Index* const ring = &ring_[odd.offset[row] - first_entry_];
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
