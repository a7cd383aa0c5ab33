#include "normals/face_graph.h"

#include "base/parallel.h"

#include <algorithm>

namespace multires {

FaceGraph face_graph(const Faces& faces, const Incidence& at) {
    const Index count = static_cast<Index>(faces.size());
    constexpr Index chunk = 1024;
    const Index chunks = (count + chunk - 1) / chunk;
    std::vector<std::vector<Index>> neighbor(chunks);
    std::vector<std::vector<std::array<Index, 2>>> edges(chunks);
    FaceGraph graph;
    graph.offset.resize(count + 1);
    parallel_chunks(count, chunk, [&](Index begin, Index end) {
        std::vector<Index> around;
        for (Index f = begin; f < end; ++f) {
            around.clear();
            for (const Index v : faces[f]) around.insert(around.end(), at[v].begin(), at[v].end());
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
