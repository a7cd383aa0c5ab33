#include "stream/progress.h"

#include "base/error.h"
#include "stream/bit_model.h"
#include "stream/geometry.h"

#include <algorithm>
#include <utility>

namespace multires::stream {
namespace {}  // namespace

void add_bulge(const StarMesh& mesh, const Positions& from, double share, Positions& to) {
    Star star;
    for (Index v = 0; v < mesh.vertices(); ++v) {
        if (!mesh.regular(v)) continue;
        mesh.star(v, star);
        if (!star.closed) continue;
        Vec3 sum(0, 0, 0), up(0, 0, 0);
        for (Index i = 0; i < star.faces(); ++i) {
            sum += from[star.spoke[i]];
            up += cross(from[star.spoke[i]] - from[v], from[star.spoke[i + 1]] - from[v]);
        }
        const double size = dot(up, up);
        if (size > 0) to[v] -= up * (share * dot(sum / star.faces() - from[v], up) / size);
    }
}

Progress::Progress(std::vector<Cell> cells, const Faces& faces, int bits, Index most, int version)
    : mesh_(static_cast<Index>(cells.size()), faces), cells_(std::move(cells)), parent_(cells_.size(), -1), bits_(bits),
      most_(most), first_models_(version < 3), fans_(first_models_), places_(!first_models_),
      is_split_({20 * 3, 64 * 3, 16 * 16, 32 * 20, 16 * 16}, 6, first_models_ ? Learning() : Learning{0.012, 0, 120}),
      finer_({64, 64, 64 * 16}, 1) {
    mesh_.set_points(points());
}

Positions Progress::points() const {
    Positions out;
    out.reserve(cells_.size());
    for (const Cell& c : cells_) out.emplace_back(c[0], c[1], c[2]);
    return out;
}

void Progress::begin_batch() {
    // Or a few bytes could ask for visits without end: the more often nothing happens, the less it costs.
    require(batch_ == 0 || mesh_.vertices() > before_batch_, "the stream is damaged: nothing is split in a batch");
    before_batch_ = mesh_.vertices();
    ++batch_;
    at_ = 0;
    prefetched_.fill(-1);
    std::vector<std::size_t> begin;  // of each valence, the highest first
    for (Index v = 0; v < mesh_.vertices(); ++v) {
        if (!mesh_.regular(v)) continue;
        const auto valence = static_cast<std::size_t>(mesh_.valence(v));
        if (begin.size() <= valence) begin.resize(valence + 1, 0);
        ++begin[valence];
    }
    std::size_t count = 0;
    for (std::size_t k = begin.size(); k-- > 0;) count += std::exchange(begin[k], count);
    order_.resize(count);
    for (Index v = 0; v < mesh_.vertices(); ++v)
        if (mesh_.regular(v)) order_[begin[mesh_.valence(v)]++] = v;
    require(!order_.empty(), "the stream is damaged: nothing can be split");
}

/// Takes the next step with the stars of the vertices that come next.
void Progress::look_ahead() {
    for (std::size_t i = 1; i <= ahead && at_ + i < order_.size(); ++i) {
        Index& last = prefetched_[(at_ + i) % ahead];
        last = mesh_.prefetch(order_[at_ + i], static_cast<int>(ahead - i), last);
    }
}

void Progress::visit(BitCoder& coder, Guide* guide) {
    if (at_ == order_.size()) begin_batch();
    look_ahead();
    const Index u = order_[at_++];
    for (int children = 0;; ++children) {
        shape_.take(mesh_, u, batch_);
        if (!shape_.has_fans()) break;
        const bool looks = first_models_ || may_split(children);
        if (looks) rank_fans(u);
        std::optional<NewVertex> wanted;
        if (guide) wanted = guide->next(u, shape_.star);
        if (!is_split(coder, wanted.has_value(), children, looks)) break;
        if (!looks) rank_fans(u);
        split(coder, u, wanted.value_or(NewVertex()));
        if (guide) guide->done(u, mesh_.vertices() - 1);
    }
}

/// False if little is left of the star: that its vertex is split is then so unlikely that looking at its fans takes
/// more time than it saves bits.
bool Progress::may_split(int children) const {
    const Index d = shape_.star.faces(), left = d - shape_.faces_taken;
    return children == 0 && left > (d > 5 ? 2 : 3);
}

void Progress::rank_fans(Index u) {
    shape_.measure(mesh_, u);
    fans_.rank(shape_);
}

/// @param looked  the star's fans are ranked
bool Progress::is_split(BitCoder& coder, bool yes, int children, bool looked) {
    const Index d = shape_.star.faces(), taken = shape_.faces_taken;
    const int more = std::min(children, 2), valence = clamp(d, 19);
    const int evidence = looked ? clamp(static_cast<int>((fans_.evidence() + 8) * 4), 63) : 0;
    const double mean = mean_area_ > 0 ? mean_area_ : 1;
    const int size = looked ? clamp(octave_steps(shape_.total / mean + 1e-9, 2) + 8, 15) : 0;
    const int density = clamp(static_cast<int>(density_ * 16), 15);
    const bool out = is_split_.code(coder, yes,
                                    {valence * 3 + more, evidence * 3 + more, clamp(taken, 15) * 16 + clamp(d, 15),
                                     (evidence / 2) * 20 + valence, size * 16 + density},
                                    looked ? more : 3 + more);
    if (children == 0) density_ += ((out ? 1 : 0) - density_) / 64;
    if (children == 0 && looked)
        mean_area_ = mean_area_ > 0 ? mean_area_ + (shape_.total - mean_area_) / 64 : shape_.total;
    return out;
}

void Progress::split(BitCoder& coder, Index u, const NewVertex& wanted) {
    require(mesh_.vertices() < most_, "the stream is damaged: it has more vertices than it says");
    mesh_.prefetch_faces_beside(shape_.star);
    const Fan fan = fans_.code(coder, shape_, wanted.fan);
    mesh_.prefetch_vertices_beside(shape_.star, fan);
    mesh_.split(u, shape_.star, fan);
    const Index v = mesh_.vertices() - 1;
    cells_.emplace_back();
    parent_.push_back(u);
    mesh_.star(v, star_);
    const Cell cell = places_.code(coder, mesh_, star_, v, u, wanted.cell);
    for (const std::int32_t x : cell)
        require(x >= 0 && x < std::int32_t{1} << bits_, "the stream is damaged: a place outside the box");
    cells_.back() = cell;
    mesh_.place(v, star_, Vec3(cell[0], cell[1], cell[2]));
    for (const Index h : star_.leaving) mesh_.set_mark(StarMesh::face_of(h), batch_);
}

/// Of the neighbours that were refined already and had the same coordinate: how many, up to 3, went up (times 4) and
/// down. In a plane across an axis all go the same way.
/// @param v  star_ is its star if it is regular
int Progress::alike_around(Index v, int axis) const {
    if (!mesh_.regular(v)) return 0;
    int up = 0, down = 0;
    for (std::size_t i = star_.closed ? 1 : 0; i < star_.spoke.size(); ++i) {
        const Index w = star_.spoke[i];
        const int known = static_cast<int>(w < v) & static_cast<int>(cells_[w][axis] >> 1 == cells_[v][axis]);
        up += known & cells_[w][axis], down += known & ~cells_[w][axis];
    }
    return clamp(up, 3) * 4 + clamp(down, 3);
}

void Progress::refine(BitCoder& coder, const Guide* guide) {
    const Positions before = points();
    Positions smooth = before;
    add_bulge(mesh_, before, -0.5, smooth);
    for (Index v = 0; v < mesh_.vertices(); ++v) {
        if (!first_models_ && mesh_.regular(v)) mesh_.star(v, star_);
        Cell finer = guide ? guide->cell(v) : Cell{};
        for (int axis = 0; axis < 3; ++axis) {
            const double off = smooth[v][axis] - before[v][axis];
            const int lean = clamp(static_cast<int>((std::min(std::max(off, -1.9), 1.9) + 2) * 16), 63);
            const int alike = first_models_ ? lean / 4 : alike_around(v, axis) * 64 + lean;
            const bool up = finer_.code(coder, finer[axis] & 1, {lean, 32 + axis, alike}, 0);
            finer[axis] = cells_[v][axis] * 2 + (up ? 1 : 0);
        }
        cells_[v] = finer;
    }
    ++bits_;
    mesh_.set_points(points());
}

}  // namespace multires::stream
