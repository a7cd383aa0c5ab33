#include "stream/star_mesh.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace multires::stream {

StarMesh::StarMesh(Index vertices, const Faces& faces) {
    origin_.reserve(3 * faces.size());
    for (const Face& f : faces) origin_.insert(origin_.end(), f.begin(), f.end());
    corner_.assign(vertices, -1);
    valence_.assign(vertices, 0);
    find_twins();
    find_corners();
}

void StarMesh::find_twins() {
    struct Edge {
        std::uint64_t key;
        Index half;
    };
    std::vector<Edge> edges;
    edges.reserve(origin_.size());
    for (Index h = 0; h < static_cast<Index>(origin_.size()); ++h) {
        if (repeats_an_index(face(h / 3))) continue;
        const auto a = static_cast<std::uint64_t>(origin(h)), b = static_cast<std::uint64_t>(target(h));
        edges.push_back({std::min(a, b) << 32 | std::max(a, b), h});
    }
    std::sort(edges.begin(), edges.end(),
              [](const Edge& a, const Edge& b) { return a.key != b.key ? a.key < b.key : a.half < b.half; });
    twin_.assign(origin_.size(), -1);
    for (std::size_t i = 0; i < edges.size();) {
        std::size_t end = i;
        while (end < edges.size() && edges[end].key == edges[i].key) ++end;
        if (end - i == 2 && origin(edges[i].half) != origin(edges[i + 1].half)) pair(edges[i].half, edges[i + 1].half);
        i = end;
    }
}

void StarMesh::find_corners() {
    std::vector<Index> some(corner_.size(), -1);
    std::vector<std::uint8_t> degenerate(corner_.size(), 0);
    for (Index h = 0; h < static_cast<Index>(origin_.size()); ++h) {
        ++valence_[origin(h)];
        some[origin(h)] = h;
        if (repeats_an_index(face(h / 3))) degenerate[origin(h)] = 1;
    }
    for (Index v = 0; v < vertices(); ++v)
        if (some[v] >= 0 && (degenerate[v] || !finds_corner(v, some[v]))) corner_[v] = -1;
}

bool StarMesh::finds_corner(Index v, Index some) {
    Index first = some;
    while (twin_[first] >= 0) {  // clockwise to the boundary, or once around
        first = next(twin_[first]);
        if (first == some) break;
    }
    const bool closed = twin_[first] >= 0;
    Index count = 0;
    for (Index h = first;;) {
        ++count;
        h = twin_[previous(h)];
        if (h < 0 || h == first) break;
    }
    corner_[v] = first;
    return count == valence_[v] && count >= (closed ? 3 : 1);
}

void StarMesh::pair(Index a, Index b) {
    if (a >= 0) twin_[a] = b;
    if (b >= 0) twin_[b] = a;
}

Index StarMesh::add_face(Index a, Index b, Index c) {
    origin_.insert(origin_.end(), {a, b, c});
    twin_.insert(twin_.end(), {-1, -1, -1});
    return static_cast<Index>(twin_.size()) - 3;
}

void StarMesh::star(Index u, Star& star) const {
    star.leaving.clear();
    star.spoke.clear();
    const Index first = corner_[u];
    star.closed = twin_[first] >= 0;
    for (Index h = first;;) {
        star.leaving.push_back(h);
        star.spoke.push_back(target(h));
        const Index back = previous(h);
        h = twin_[back];
        if (h >= 0 && h != first) continue;
        star.spoke.push_back(origin(back));
        return;
    }
}

bool StarMesh::allows(const Star& star, const Fan& fan) {
    const Index d = star.faces();
    if (fan.kind != Fan::inside) return !star.closed && fan.faces >= 0 && fan.faces <= d;
    if (fan.start < 0 || fan.start >= d || fan.faces < 1) return false;
    return star.closed ? fan.faces < d : fan.faces <= d - fan.start;
}

void StarMesh::split(Index u, const Star& star, const Fan& fan) {
    const Index v = vertices();
    corner_.push_back(0);
    valence_.push_back(0);
    const Index d = star.faces(), m = fan.faces;
    const Index from = fan.kind == Fan::inside ? fan.start : fan.kind == Fan::first ? 0 : d - m;
    for (Index i = from; i < from + m; ++i) {
        const Index h = star.leaving[i % d];
        origin_[h] = v;
    }
    if (fan.kind == Fan::inside) split_inside(u, star, fan, v);
    if (fan.kind == Fan::first) split_first(u, star, m, v);
    if (fan.kind == Fan::last) split_last(u, star, m, v);
}

void StarMesh::split_inside(Index u, const Star& star, const Fan& fan, Index v) {
    const Index d = star.faces(), m = fan.faces;
    const Index begin = star.leaving[fan.start], end = previous(star.leaving[(fan.start + m - 1) % d]);
    const Index left = star.spoke[fan.start], right = star.spoke[(fan.start + m - 1) % d + 1];
    const Index before = twin_[begin], after = twin_[end];
    const Index a = add_face(u, left, v), b = add_face(u, v, right);
    pair(a, before);
    pair(a + 1, begin);
    pair(a + 2, b);
    pair(b + 1, end);
    pair(b + 2, after);
    for (Index i = 0; i < m; ++i)
        if (corner_[u] == star.leaving[(fan.start + i) % d]) corner_[u] = a;
    corner_[v] = begin;
    if (after < 0) set_corner(right, b + 2);
    valence_[u] += 2 - m;
    valence_[v] = m + 2;
    ++valence_[left], ++valence_[right];
}

void StarMesh::split_first(Index u, const Star& star, Index m, Index v) {
    const Index right = star.spoke[m], a = add_face(u, v, right);
    if (m == 0) {
        pair(a + 2, star.leaving[0]);
        corner_[v] = a + 1;
    } else {
        const Index end = previous(star.leaving[m - 1]), after = twin_[end];
        pair(a + 1, end);
        pair(a + 2, after);
        if (after < 0) set_corner(right, a + 2);
        corner_[v] = star.leaving[0];
    }
    corner_[u] = a;
    valence_[u] += 1 - m;
    valence_[v] = m + 1;
    ++valence_[right];
}

void StarMesh::split_last(Index u, const Star& star, Index m, Index v) {
    const Index d = star.faces(), left = star.spoke[d - m], a = add_face(u, left, v);
    if (m == 0) {
        pair(a, previous(star.leaving[d - 1]));
        set_corner(left, a + 1);
    } else {
        const Index begin = star.leaving[d - m], before = twin_[begin];
        pair(a + 1, begin);
        pair(a, before);
        twin_[a] = before;
    }
    if (m == d) corner_[u] = a;
    corner_[v] = a + 2;
    valence_[u] += 1 - m;
    valence_[v] = m + 1;
    ++valence_[left];
}

}  // namespace multires::stream
