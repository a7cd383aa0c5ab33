#include "grids/lattice.h"

#include "base/buckets.h"
#include "base/disjoint_sets.h"
#include "base/error.h"

#include <algorithm>
#include <cstdint>
#include <deque>
#include <limits>
#include <string>
#include <utility>

namespace multires {
namespace {

struct Point {
    Index i = 0, j = 0;
    bool operator==(const Point& o) const { return i == o.i && j == o.j; }
    bool operator!=(const Point& o) const { return !(*this == o); }
};

[[noreturn]] void refuse(const std::string& why) { throw InputError("not a triangular grid: " + why); }

/// One way round a vertex: how many faces, and whether they close.
struct Umbrella {
    Index faces = 0;
    bool closed = false, manifold = true;
};

/// Places two vertices of a face share are found among the faces of one of them: no table of edges is needed.
class Walk {
public:
    Walk(const Faces& faces, Index vertices)
        : faces_(faces), around_(vertices,
                                 [&](const auto& put) {
                                     for (std::size_t f = 0; f < faces.size(); ++f)
                                         if (!repeats_an_index(faces[f]))
                                             for (const Index v : faces[f]) put(v, static_cast<Index>(f));
                                 }),
          at_(vertices), part_(vertices, -1), regular_(vertices, 0), state_(faces.size(), State::unseen) {
        look_at_vertices();
    }

    FoundGrids grids() {
        for (const bool core : {true, false})
            for (std::size_t f = 0; f < faces_.size(); ++f)
                if (state_[f] == State::unseen && is_core(f) == core && is_free(f)) walk_from(static_cast<Index>(f));
        return collect();
    }

private:
    enum class State : std::uint8_t { unseen, placed, off };
    struct Step {  // across an edge of a face
        Index from;
        int edge;
        Index next;
    };

    Umbrella umbrella(Index v, Array<Index>& neighbour) const {
        Umbrella u;
        neighbour.clear();
        u.faces = around_[v].size();
        for (const Index f : around_[v])
            for (const Index w : faces_[f])
                if (w != v) neighbour.push_back(w);
        std::sort(neighbour.begin(), neighbour.end());
        std::size_t distinct = 0;
        for (std::size_t k = 0; k < neighbour.size(); ++distinct) {
            std::size_t end = k;
            while (end < neighbour.size() && neighbour[end] == neighbour[k]) ++end;
            u.manifold = u.manifold && end - k <= 2;
            k = end;
        }
        u.closed = 2 * distinct == neighbour.size();
        return u;
    }

    /// Finds the regular vertices and refuses meshes that have too few of them.
    void look_at_vertices() {
        Index closed = 0, four_or_eight = 0, good = 0;
        bool manifold = true;
        Array<Index> neighbour;
        for (Index v = 0; v < static_cast<Index>(part_.size()); ++v) {
            if (around_[v].size() == 0) continue;
            const Umbrella u = umbrella(v, neighbour);
            manifold = manifold && u.manifold;
            if (!u.closed) continue;
            ++closed;
            regular_[v] = u.faces == 6;
            good += regular_[v];
            four_or_eight += u.faces == 4 || u.faces == 8;
        }
        if (!manifold) refuse("edges have more than two faces");
        if (four_or_eight > 0.9 * closed && closed > 1)
            refuse("its diagonals alternate, so that inner vertices have four and eight neighbours; "
                   "cut all quadrilaterals along the same diagonal");
        // The corners of holes in range maps have five or seven; a mesh that is none has some in every neighbourhood.
        if (closed - good > 0.05 * closed)
            refuse(std::to_string(closed - good) + " of " + std::to_string(closed) +
                   " inner vertices do not have six neighbours");
    }

    bool is_core(std::size_t f) const {
        const Face& c = faces_[f];
        return !repeats_an_index(c) && (regular_[c[0]] || regular_[c[1]] || regular_[c[2]]);
    }
    bool is_free(std::size_t f) const {
        const Face& c = faces_[f];
        return !repeats_an_index(c) && part_[c[0]] < 0 && part_[c[1]] < 0 && part_[c[2]] < 0;
    }

    /// Faces at regular vertices come first: only those between others can be off the lattice.
    void walk_from(Index seed) {
        const auto part = static_cast<Index>(parts_++);
        Face f = faces_[seed];
        std::sort(f.begin(), f.end());  // faces that are turned over change nothing
        place(f[0], {0, 0}, part), place(f[1], {1, 0}, part), place(f[2], {1, 1}, part);
        std::deque<Step> core, rest;
        const auto go_on_from = [&](Index face) {
            state_[face] = State::placed;
            for (int k = 0; k < 3; ++k) {
                const Index next = across(face, k);
                if (next >= 0 && state_[next] == State::unseen)
                    (is_core(next) ? core : rest).push_back({face, k, next});
            }
        };
        go_on_from(seed);
        while (!core.empty() || !rest.empty()) {
            std::deque<Step>& queue = core.empty() ? rest : core;
            const Step step = queue.front();
            queue.pop_front();
            if (state_[step.next] == State::unseen && reach(step, part)) go_on_from(step.next);
        }
    }

    void place(Index v, Point p, Index part) { at_[v] = p, part_[v] = part; }

    /// The face across the edge (k, k+1), -1 if there is none.
    Index across(Index face, int k) const {
        const Index a = faces_[face][k], b = faces_[face][(k + 1) % 3];
        for (const Index other : around_[a]) {
            const Face& f = faces_[other];
            if (other != face && (f[0] == b || f[1] == b || f[2] == b)) return other;
        }
        return -1;
    }

    /// Places the far corner of a face; false if it lies elsewhere already.
    bool reach(const Step& step, Index part) {
        const auto [from, k, next] = step;
        const Index a = faces_[from][k], b = faces_[from][(k + 1) % 3], c = faces_[from][(k + 2) % 3];
        Index d = -1;
        for (const Index v : faces_[next])
            if (v != a && v != b) d = v;
        const Point there{at_[a].i + at_[b].i - at_[c].i, at_[a].j + at_[b].j - at_[c].j};
        if (part_[d] < 0) place(d, there, part);
        if (part_[d] == part && at_[d] == there) return true;
        if (part_[d] == part && is_core(from) && is_core(next))
            refuse("it closes on itself, or inner vertices do not have six neighbours");
        if (part_[d] == part) state_[next] = State::off;
        return false;
    }

    FoundGrids collect() {
        FoundGrids found;
        std::vector<std::vector<Index>> members(parts_);
        for (std::size_t v = 0; v < part_.size(); ++v) {
            if (part_[v] >= 0) members[part_[v]].push_back(static_cast<Index>(v));
            found.loose_vertices += part_[v] < 0 && around_[static_cast<Index>(v)].size() > 0;
        }
        std::size_t faces = 0;
        for (const State s : state_) found.off_lattice_faces += s == State::off;
        for (const auto& m : members) found.grids.push_back(grid_of(m));
        for (std::size_t f = 0; f < faces_.size(); ++f) {
            faces += !repeats_an_index(faces_[f]);
            if (state_[f] == State::placed) put_face(static_cast<Index>(f), found.grids[part_[faces_[f][0]]]);
        }
        if (static_cast<double>(found.off_lattice_faces) > 0.05 * static_cast<double>(faces))
            refuse(std::to_string(found.off_lattice_faces) + " faces do not join neighbours");
        std::stable_sort(found.grids.begin(), found.grids.end(),
                         [](const Grid& a, const Grid& b) { return a.vertices > b.vertices; });
        return found;
    }

    /// A third of a turn: e1, e2, e3 become e2, e3, e1.
    static Point turned(Point p) { return {-p.j, p.i - p.j}; }

    Grid grid_of(const std::vector<Index>& members) {
        double least = std::numeric_limits<double>::infinity();
        int best = 0;
        Point low, size;
        for (int turn = 0; turn < 3; ++turn) {
            Point a = at_[members[0]], b = a;
            for (const Index v : members) {
                a = {std::min(a.i, at_[v].i), std::min(a.j, at_[v].j)};
                b = {std::max(b.i, at_[v].i), std::max(b.j, at_[v].j)};
            }
            const double area = (b.i - a.i + 1.0) * (b.j - a.j + 1.0);
            if (area < least) least = area, best = turn, low = a, size = {b.i - a.i + 1, b.j - a.j + 1};
            for (const Index v : members) at_[v] = turned(at_[v]);
        }
        if (least > 64.0 * static_cast<double>(members.size()) + 1e5) refuse("its outline is too long and winding");
        for (const Index v : members) {
            for (int turn = 0; turn < best; ++turn) at_[v] = turned(at_[v]);
            at_[v] = {at_[v].i - low.i, at_[v].j - low.j};
        }
        Grid grid;
        grid.rows = size.i, grid.columns = size.j;
        grid.vertices = static_cast<Index>(members.size());
        const std::size_t places = static_cast<std::size_t>(grid.rows) * grid.columns;
        grid.vertex.assign(places, -1);
        grid.face.assign(2 * places, -1);
        for (const Index v : members) {
            Index& there = grid.vertex[static_cast<std::size_t>(at_[v].i) * grid.columns + at_[v].j];
            if (there >= 0) refuse("it overlaps itself");
            there = v;
        }
        return grid;
    }

    /// The corner whose sum of coordinates is least is the place's; of the others, one is (1, 1) further.
    void put_face(Index f, Grid& grid) const {
        Point low = at_[faces_[f][0]], sum;
        for (const Index v : faces_[f]) {
            low = {std::min(low.i, at_[v].i), std::min(low.j, at_[v].j)};
            sum = {sum.i + at_[v].i, sum.j + at_[v].j};
        }
        const bool second = sum.j - 3 * low.j == 2;
        grid.face[2 * (static_cast<std::size_t>(low.i) * grid.columns + low.j) + second] = f;
    }

    const Faces& faces_;
    Buckets<Index> around_;        // the faces of each vertex
    std::vector<Point> at_;        // #V
    Array<Index> part_;            // #V: the walk that placed it, -1 for none
    Array<std::uint8_t> regular_;  // #V: closed, with six neighbours
    std::vector<State> state_;     // #F
    Index parts_ = 0;
};

}  // namespace

std::array<std::size_t, 3> corners_of(std::size_t at, Index columns) {
    const std::size_t p = at / 2, diagonal = p + columns + 1;
    if (at % 2) return {p, diagonal, p + 1};
    return {p, p + columns, diagonal};
}

FoundGrids find_grids(const Faces& faces, Index vertices) {
    FoundGrids found = Walk(faces, vertices).grids();
    if (found.grids.empty()) refuse("it has no faces");
    return found;
}

Index count_holes(const Grid& grid) {
    // Triangles of the box and a rim of one around it; those without a face are joined across edges.
    const Index rows = grid.rows + 2, columns = grid.columns + 2;
    const auto place = [&](Index i, Index j, int k) { return 2 * (i * columns + j) + k; };
    const auto empty = [&](Index i, Index j, int k) {
        const bool inside = i > 0 && j > 0 && i <= grid.rows && j <= grid.columns;
        return !inside || grid.face[2 * (static_cast<std::size_t>(i - 1) * grid.columns + (j - 1)) + k] < 0;
    };
    DisjointSets sets(2 * rows * columns);
    for (Index i = 0; i < rows; ++i)
        for (Index j = 0; j < columns; ++j) {
            if (empty(i, j, 0) && empty(i, j, 1)) sets.join(place(i, j, 0), place(i, j, 1));
            if (j > 0 && empty(i, j, 0) && empty(i, j - 1, 1)) sets.join(place(i, j, 0), place(i, j - 1, 1));
            if (i + 1 < rows && empty(i, j, 0) && empty(i + 1, j, 1)) sets.join(place(i, j, 0), place(i + 1, j, 1));
        }
    const Index outside = sets.find(0).root;
    Index holes = 0;
    for (Index i = 0; i < rows; ++i)
        for (Index j = 0; j < columns; ++j)
            for (int k = 0; k < 2; ++k) {
                const Index p = place(i, j, k), root = sets.find(p).root;
                holes += empty(i, j, k) && root == p && root != outside;
            }
    return holes;
}

}  // namespace multires
