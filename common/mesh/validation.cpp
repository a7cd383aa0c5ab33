#include "mesh/validation.h"

#include "base/buckets.h"
#include "base/disjoint_sets.h"
#include "base/parallel.h"
#include "mesh/adjacency.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <functional>
#include <string>
#include <utility>

namespace multires {

namespace {

constexpr double degenerate_tolerance = 1e-10;  // as in operators/ and measure/
constexpr double least_diagonal = 1e-70, most_diagonal = 1e70;

bool has_area(const Face& f, const Positions& p) {
    const Vec3 a = p[f[1]] - p[f[0]], b = p[f[2]] - p[f[1]], c = p[f[0]] - p[f[2]];
    return a.cross(b).norm() > degenerate_tolerance * (a.squaredNorm() + b.squaredNorm() + c.squaredNorm());
}

/// The indices of a face in ascending order.
Face ascending(Face f) {
    std::sort(f.begin(), f.end());
    return f;
}

Index count_duplicate_vertices(const Positions& positions) {
    const auto n = static_cast<Index>(positions.size());
    if (n == 0) return 0;
    const auto bucket_of = [&](Index i) {
        std::uint64_t hash = 0;
        for (int k = 0; k < 3; ++k) {
            const double x = positions[i][k] + 0.0;  // one zero, not two
            std::uint64_t bits = 0;
            std::memcpy(&bits, &x, sizeof bits);
            hash = (hash ^ bits) * 0x9E3779B97F4A7C15U;
            hash ^= hash >> 32;
        }
        return static_cast<Index>(hash % static_cast<std::uint64_t>(n));
    };
    Buckets<Index> buckets(n, n, bucket_of);
    const auto less = [&](Index i, Index j) {
        const Vec3 &a = positions[i], &b = positions[j];
        return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
    };
    Index count = 0;
    for (Index b = 0; b < n; ++b) {
        const auto same_hash = buckets[b];
        std::sort(same_hash.begin(), same_hash.end(), less);
        for (Index i = 1; i < same_hash.size(); ++i) count += positions[same_hash[i - 1]] == positions[same_hash[i]];
    }
    return count;
}

Index count_duplicate_faces(Index vertices, const Faces& faces) {
    const auto smallest = [&](Index f) { return std::min({faces[f][0], faces[f][1], faces[f][2]}); };
    const Buckets<Index> buckets(vertices, static_cast<Index>(faces.size()), smallest);
    std::vector<Face> of_vertex;
    Index count = 0;
    for (Index v = 0; v < vertices; ++v) {
        of_vertex.clear();
        for (const Index f : buckets[v])
            if (!repeats_an_index(faces[f])) of_vertex.push_back(ascending(faces[f]));
        std::sort(of_vertex.begin(), of_vertex.end());
        for (std::size_t i = 1; i < of_vertex.size(); ++i) count += of_vertex[i - 1] == of_vertex[i];
    }
    return count;
}

void count_vertices(const Mesh& mesh, InputCounts& counts) {
    const std::vector<std::uint8_t> used = vertices_in_faces(mesh);
    counts.unreferenced_vertices = static_cast<Index>(std::count(used.begin(), used.end(), 0));
    counts.duplicate_vertices = count_duplicate_vertices(mesh.positions);
}

void count_faces(const Mesh& mesh, InputCounts& counts) {
    for (const Face& f : mesh.faces) {
        if (repeats_an_index(f))
            ++counts.degenerate_faces;
        else
            counts.zero_area_faces += !has_area(f, mesh.positions);
    }
    counts.duplicate_faces = count_duplicate_faces(counts.vertices, mesh.faces);
}

/// One side of a face, as seen from its smaller vertex.
struct FaceSide {
    Index other;  // the larger vertex
    Index face;
    bool upward;  // passed from the smaller to the larger one
};

/// Calls visit(smaller vertex, first side, last side) for every edge of the faces that count.
template <class Visit>
void for_each_edge(const Mesh& mesh, Visit visit) {
    const Faces& faces = mesh.faces;
    const auto smaller = [&](Index c) { return std::min(faces[c / 3][c % 3], faces[c / 3][(c + 1) % 3]); };
    const auto larger = [&](Index c) { return std::max(faces[c / 3][c % 3], faces[c / 3][(c + 1) % 3]); };
    const Buckets<Index> buckets(static_cast<Index>(mesh.positions.size()), static_cast<Index>(3 * faces.size()),
                                 smaller);
    std::vector<FaceSide> sides;
    for (Index v = 0; v < buckets.size(); ++v) {
        sides.clear();
        for (const Index c : buckets[v])
            if (!repeats_an_index(faces[c / 3])) sides.push_back({larger(c), c / 3, faces[c / 3][c % 3] == v});
        std::sort(sides.begin(), sides.end(), [](const FaceSide& a, const FaceSide& b) {
            return std::make_pair(a.other, a.face) < std::make_pair(b.other, b.face);
        });
        for (std::size_t i = 0, j = 0; i < sides.size(); i = j) {
            while (j < sides.size() && sides[j].other == sides[i].other) ++j;
            visit(v, sides.data() + i, sides.data() + j);
        }
    }
}

void count_edges(const Mesh& mesh, InputCounts& counts) {
    std::vector<std::pair<Index, Index>> boundary;
    for_each_edge(mesh, [&](Index v, const FaceSide* begin, const FaceSide* end) {
        if (end - begin == 1) boundary.emplace_back(v, begin->other);
        counts.non_manifold_edges += end - begin > 2;
        counts.inconsistent_edges += end - begin == 2 && begin[0].upward == begin[1].upward;
    });
    counts.boundary_edges = static_cast<Index>(boundary.size());
    if (boundary.empty()) return;
    DisjointSets loops(static_cast<Index>(mesh.positions.size()));
    std::vector<std::uint8_t> root(mesh.positions.size(), 0);
    for (const auto& [a, b] : boundary) loops.join(a, b);
    for (const auto& [a, b] : boundary) root[loops.find(a).root] = 1;
    counts.boundary_loops = static_cast<Index>(std::count(root.begin(), root.end(), 1));
}

Index count_components(const Mesh& mesh) {
    DisjointSets sets(static_cast<Index>(mesh.positions.size()));
    std::vector<std::uint8_t> root(mesh.positions.size(), 0);
    for (const Face& f : mesh.faces)
        if (!repeats_an_index(f)) sets.join(f[0], f[1]), sets.join(f[0], f[2]);
    for (const Face& f : mesh.faces)
        if (!repeats_an_index(f)) root[sets.find(f[0]).root] = 1;
    return static_cast<Index>(std::count(root.begin(), root.end(), 1));
}

Index count_non_orientable(const Mesh& mesh) {
    DisjointSets sets(static_cast<Index>(mesh.faces.size()));
    std::vector<Index> contradictions;
    for_each_edge(mesh, [&](Index, const FaceSide* begin, const FaceSide* end) {
        if (end - begin != 2) return;
        if (!sets.join(begin[0].face, begin[1].face, begin[0].upward == begin[1].upward))
            contradictions.push_back(begin[0].face);
    });
    for (Index& f : contradictions) f = sets.find(f).root;
    std::sort(contradictions.begin(), contradictions.end());
    return static_cast<Index>(std::unique(contradictions.begin(), contradictions.end()) - contradictions.begin());
}

void require_finite(const Positions& positions) {
    std::size_t count = 0, first = 0;
    for (std::size_t i = 0; i < positions.size(); ++i) {
        if (positions[i].allFinite()) continue;
        if (count++ == 0) first = i;
    }
    if (count == 0) return;
    throw InputError(std::to_string(count) + (count == 1 ? " vertex has" : " vertices have") +
                     " a coordinate that is not a number or infinite (the first is vertex " + std::to_string(first) +
                     "). Delete " + (count == 1 ? "it" : "them") + " first.");
}

void require_extent(const Positions& positions) {
    Vec3 low = positions[0], high = positions[0];
    for (const Vec3& p : positions) low = low.cwiseMin(p), high = high.cwiseMax(p);
    const double diagonal = (high - low).stableNorm();
    if (diagonal == 0) throw InputError("All vertices of the mesh are at the same point.");
    if (!(diagonal > least_diagonal && diagonal < most_diagonal))
        throw InputError(std::string("The mesh is too ") + (diagonal < 1 ? "small" : "large") +
                         " to compute with: scale it to an ordinary size first.");
}

}  // namespace

std::vector<std::uint8_t> vertices_in_faces(const Mesh& mesh) {
    std::vector<std::uint8_t> used(mesh.positions.size(), 0);
    for (const Face& f : mesh.faces)
        for (const Index v : f) used[v] = 1;
    return used;
}

InputCounts count_input(const Mesh& mesh, Index irregular) {
    InputCounts counts;
    counts.vertices = static_cast<Index>(mesh.positions.size());
    counts.faces = static_cast<Index>(mesh.faces.size());
    counts.non_manifold_vertices = irregular;
    const std::array<std::function<void()>, 4> parts = {
        [&] { count_edges(mesh, counts); },
        [&] { count_vertices(mesh, counts); },
        [&] { count_faces(mesh, counts); },
        [&] { counts.components = count_components(mesh); },
    };
    parallel_for(
        4, [&](Index i) { parts[i](); }, 1);
    if (counts.inconsistent_edges > 0) counts.non_orientable_components = count_non_orientable(mesh);
    return counts;
}

InputCounts count_input(const Mesh& mesh) {
    const Rings rings = surface_rings(mesh);
    return count_input(mesh, static_cast<Index>(std::count(rings.kind.begin(), rings.kind.end(), RingKind::irregular)));
}

void require_usable(const Mesh& mesh) {
    if (mesh.positions.empty()) throw InputError("The mesh is empty: it has no vertices.");
    if (mesh.faces.empty()) throw InputError("The mesh has no faces: a point cloud has to be meshed first.");
    require_finite(mesh.positions);
    require_extent(mesh.positions);
    if (std::none_of(mesh.faces.begin(), mesh.faces.end(),
                     [&](const Face& f) { return !repeats_an_index(f) && has_area(f, mesh.positions); }))
        throw InputError("None of the " + std::to_string(mesh.faces.size()) +
                         " faces has an area: they are all degenerate.");
}

}  // namespace multires
