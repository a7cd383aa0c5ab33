#include "normals/face_graph.h"

#include "base/parallel.h"

#include <algorithm>
#include <iterator>
#include <map>

namespace multires {
namespace {

constexpr Index many = 64;         // faces at a vertex
constexpr Index many_at_edge = 8;  // faces
constexpr int steps_at_many = 16;  // from face to face around it

/// The faces at a vertex by their other vertices: {other vertex, face}, ascending.
using Spokes = std::vector<std::array<Index, 2>>;

/// Of every vertex with many faces.
std::map<Index, Spokes> spokes_of_hubs(const Faces& faces, const Incidence& at) {
    std::map<Index, Spokes> found;
    for (Index v = 0; v < at.size(); ++v) {
        if (at[v].size() <= many) continue;
        Spokes& spokes = found[v];
        for (const Index f : at[v])
            for (const Index w : faces[f])
                if (w != v) spokes.push_back({w, f});
        std::sort(spokes.begin(), spokes.end());
    }
    return found;
}

/// The face and those that a few steps over edges at v reach, ascending.
std::vector<Index> reached_around(Index v, Index face, const Faces& faces, const Spokes& spokes) {
    std::vector<Index> reached{face}, front{face}, next, all;
    for (int step = 0; step < steps_at_many && !front.empty(); ++step) {
        next.clear();
        for (const Index f : front)
            for (const Index w : faces[f]) {
                if (w == v) continue;
                const auto first = std::lower_bound(spokes.begin(), spokes.end(), std::array<Index, 2>{w, 0});
                const auto last = std::lower_bound(first, spokes.end(), std::array<Index, 2>{w + 1, 0});
                if (last - first > many_at_edge) continue;
                for (auto s = first; s != last; ++s) next.push_back((*s)[1]);
            }
        std::sort(next.begin(), next.end());
        next.erase(std::unique(next.begin(), next.end()), next.end());
        front.clear(), all.clear();
        std::set_difference(next.begin(), next.end(), reached.begin(), reached.end(), std::back_inserter(front));
        std::set_union(reached.begin(), reached.end(), front.begin(), front.end(), std::back_inserter(all));
        reached.swap(all);
    }
    return reached;
}

}  // namespace

FaceGraph face_graph(const Faces& faces, const Incidence& at) {
    const Index count = static_cast<Index>(faces.size());
    constexpr Index chunk = 1024;
    const Index chunks = (count + chunk - 1) / chunk;
    const std::map<Index, Spokes> hubs = spokes_of_hubs(faces, at);
    std::vector<std::vector<Index>> neighbor(chunks);
    std::vector<std::vector<std::array<Index, 2>>> edges(chunks);
    FaceGraph graph;
    graph.offset.resize(count + 1);
    parallel_chunks(count, chunk, [&](Index begin, Index end) {
        std::vector<Index> around;
        for (Index f = begin; f < end; ++f) {
            around.clear();
            for (const Index v : faces[f]) {
                if (at[v].size() <= many) {
                    around.insert(around.end(), at[v].begin(), at[v].end());
                } else {
                    const std::vector<Index> near = reached_around(v, f, faces, hubs.at(v));
                    around.insert(around.end(), near.begin(), near.end());
                }
            }
            std::sort(around.begin(), around.end());
            // A face met at two of the three vertices shares an edge.
            Index written = 0;
            for (std::size_t i = 0; i < around.size();) {
                std::size_t j = i;
                while (j < around.size() && around[j] == around[i]) ++j;
                if (around[i] != f) {
                    neighbor[begin / chunk].push_back(around[i]);
                    ++written;
                    if (j - i >= 2 && f < around[i]) edges[begin / chunk].push_back({f, around[i]});
                }
                i = j;
            }
            graph.offset[f + 1] = written;
        }
    });
    for (Index f = 0; f < count; ++f) graph.offset[f + 1] += graph.offset[f];
    graph.neighbor.reserve(graph.offset[count]);
    for (Index c = 0; c < chunks; ++c) {
        graph.neighbor.insert(graph.neighbor.end(), neighbor[c].begin(), neighbor[c].end());
        graph.edges.insert(graph.edges.end(), edges[c].begin(), edges[c].end());
    }
    return graph;
}

}  // namespace multires
