#include "filters/analysis/line_graph.h"

#include "base/disjoint_sets.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <queue>
#include <tuple>
#include <utility>

namespace multires {
namespace {

/// Edges of each vertex.
struct Star {
    std::vector<Index> offset, edge;

    Star(const std::vector<MeshEdge>& edges, Index vertices) : offset(vertices + 1, 0), edge(2 * edges.size()) {
        for (const MeshEdge& e : edges) ++offset[e.a + 1], ++offset[e.b + 1];
        for (Index v = 0; v < vertices; ++v) offset[v + 1] += offset[v];
        std::vector<Index> next(offset.begin(), offset.end() - 1);
        for (std::size_t i = 0; i < edges.size(); ++i)
            edge[next[edges[i].a]++] = edge[next[edges[i].b]++] = static_cast<Index>(i);
    }
};

class Lines {
public:
    Lines(const std::vector<MeshEdge>& edges, const std::vector<double>& weight, Index vertices, Index faces,
          const LineOptions& options)
        : edges_(edges), weight_(weight), options_(options), star_(edges, vertices), vertices_(vertices), faces_(faces),
          on_(edges.size(), 0) {}

    std::vector<std::uint8_t> make() {
        hysteresis();
        thin();
        close_gaps();
        prune();
        return std::move(on_);
    }

private:
    Index other(Index e, Index v) const { return edges_[e].a == v ? edges_[e].b : edges_[e].a; }

    template <class Do>
    void each_edge(Index v, const Do& with) const {
        for (Index i = star_.offset[v]; i < star_.offset[v + 1]; ++i) with(star_.edge[i]);
    }
    int degree(Index v) const {
        int count = 0;
        each_edge(v, [&](Index e) { count += on_[e]; });
        return count;
    }
    /// The edge of a line that goes on from v, other than `from`; -1 if there is none or a choice.
    Index next(Index v, Index from) const {
        Index found = -1;
        int count = 0;
        each_edge(v, [&](Index e) {
            if (on_[e] && e != from) found = e, ++count;
        });
        return count == 1 ? found : -1;
    }

    void hysteresis() {
        DisjointSets sets(vertices_);
        for (std::size_t e = 0; e < edges_.size(); ++e)
            if (weight_[e] >= options_.weak) sets.join(edges_[e].a, edges_[e].b);
        std::vector<std::uint8_t> strong(vertices_, 0);
        for (std::size_t e = 0; e < edges_.size(); ++e)
            if (weight_[e] >= options_.strong) strong[sets.find(edges_[e].a).root] = 1;
        for (std::size_t e = 0; e < edges_.size(); ++e)
            on_[e] = weight_[e] >= options_.weak && strong[sets.find(edges_[e].a).root];
    }

    void thin() {
        std::vector<std::array<Index, 3>> of(faces_, {-1, -1, -1});
        for (std::size_t e = 0; e < edges_.size(); ++e)
            for (int side = 0; side < 2; ++side)
                of[edges_[e].face[side]][edges_[e].corner[side]] = static_cast<Index>(e);
        for (const std::array<Index, 3>& f : of) {
            if (std::any_of(f.begin(), f.end(), [&](Index e) { return e < 0 || !on_[e]; })) continue;
            on_[*std::min_element(f.begin(), f.end(), [&](Index a, Index b) {
                return std::tie(weight_[a], a) < std::tie(weight_[b], b);
            })] = 0;
        }
    }

    /// Vertices of the line that ends at v, as far as a search could come back to it.
    std::vector<Index> own(Index v) const {
        std::vector<Index> line{v};
        Index e = next(v, -1);
        for (int i = 0; e >= 0 && i < 2 * reach() + 2; ++i) {
            line.push_back(v = other(e, v));
            e = next(v, e);
        }
        return line;
    }
    int reach() const { return options_.shortest / 2; }

    /// Shortest way, where light edges are long, from a loose end to a vertex of another line.
    void close_gap(Index end) {
        struct Place {
            double cost;
            int steps;
            Index vertex, by;  ///< the edge that led there
            bool operator>(const Place& o) const { return std::tie(cost, vertex) > std::tie(o.cost, o.vertex); }
        };
        const std::vector<Index> mine = own(end);
        std::priority_queue<Place, std::vector<Place>, std::greater<>> queue;
        std::vector<std::pair<Index, Index>> came;  // vertex, edge
        queue.push({0, 0, end, -1});
        const auto reached = [&](Index v) {
            return std::any_of(came.begin(), came.end(), [&](const auto& c) { return c.first == v; });
        };
        while (!queue.empty()) {
            const Place now = queue.top();
            queue.pop();
            if (reached(now.vertex)) continue;
            came.emplace_back(now.vertex, now.by);
            const bool foreign = std::find(mine.begin(), mine.end(), now.vertex) == mine.end();
            if (foreign && degree(now.vertex) > 0) return mark(came, end);
            if (now.steps == reach() || (now.vertex != end && !foreign)) continue;
            each_edge(now.vertex, [&](Index e) {
                if (on_[e] || weight_[e] < options_.weak / 2) return;
                queue.push({now.cost + options_.weak / weight_[e], now.steps + 1, other(e, now.vertex), e});
            });
        }
    }
    void mark(const std::vector<std::pair<Index, Index>>& came, Index end) {
        for (Index v = came.back().first; v != end;) {
            const auto at = std::find_if(came.begin(), came.end(), [&](const auto& c) { return c.first == v; });
            on_[at->second] = 1;
            v = other(at->second, v);
        }
    }
    void close_gaps() {
        for (Index v = 0; v < vertices_; ++v)
            if (degree(v) == 1) close_gap(v);
    }

    /// Takes away what is short and loose, the shortest first; what was a junction may then be the middle of a line.
    void prune() {
        for (int length = 1; length < options_.shortest; ++length)
            for (Index v = 0; v < vertices_; ++v)
                if (degree(v) == 1) prune(v, length);
    }
    void prune(Index end, int length) {
        std::vector<Index> line;
        Index v = end, e = next(v, -1);
        while (e >= 0 && static_cast<int>(line.size()) <= length) {
            line.push_back(e);
            v = other(e, v);
            e = next(v, e);
        }
        if (static_cast<int>(line.size()) <= length)
            for (const Index gone : line) on_[gone] = 0;
    }

    const std::vector<MeshEdge>& edges_;
    const std::vector<double>& weight_;
    const LineOptions& options_;
    Star star_;
    Index vertices_, faces_;
    std::vector<std::uint8_t> on_;
};

}  // namespace

std::vector<MeshEdge> edges_of_two_faces(const Faces& faces) {
    struct Half {
        Index a, b, face;
        int corner;
        bool operator<(const Half& o) const {
            return std::tie(a, b, face, corner) < std::tie(o.a, o.b, o.face, o.corner);
        }
    };
    std::vector<Half> halves;
    halves.reserve(3 * faces.size());
    for (std::size_t f = 0; f < faces.size(); ++f) {
        if (repeats_an_index(faces[f])) continue;
        for (int k = 0; k < 3; ++k) {
            const auto [a, b] = std::minmax(faces[f][k], faces[f][(k + 1) % 3]);
            halves.push_back({a, b, static_cast<Index>(f), k});
        }
    }
    std::sort(halves.begin(), halves.end());
    std::vector<MeshEdge> edges;
    for (std::size_t i = 0, j = 0; i < halves.size(); i = j) {
        while (j < halves.size() && halves[j].a == halves[i].a && halves[j].b == halves[i].b) ++j;
        if (j - i != 2) continue;
        const Half &p = halves[i], &q = halves[i + 1];
        edges.push_back({p.a, p.b, {p.face, q.face}, {p.corner, q.corner}});
    }
    return edges;
}

std::vector<std::uint8_t> clean_lines(const std::vector<MeshEdge>& edges, const std::vector<double>& weight,
                                      Index vertices, Index faces, const LineOptions& options) {
    return Lines(edges, weight, vertices, faces, options).make();
}

}  // namespace multires
