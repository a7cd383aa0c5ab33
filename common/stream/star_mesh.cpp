#include "stream/star_mesh.h"

#include "stream/geometry.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>

namespace multires::stream {

StarMesh::StarMesh(Index vertices, const Faces& faces) {
    half_.resize(faces.size());
    for (std::size_t f = 0; f < faces.size(); ++f) half_[f].origin = faces[f];
    vertex_.resize(vertices);
    find_twins();
    find_corners();
}

void StarMesh::find_twins() {
    struct Edge {
        Index end, half;
    };
    // The half-edges of a vertex are those of edges whose other end has a higher index; sorted by that end.
    std::vector<std::size_t> begin(vertex_.size() + 1, 0);
    const auto for_edges = [&](const auto& take) {
        for (Index f = 0; f < faces(); ++f) {
            if (repeats_an_index(face(f))) continue;
            for (Index h = 4 * f; h < 4 * f + 3; ++h)
                take(std::min(origin(h), target(h)), std::max(origin(h), target(h)), h);
        }
    };
    for_edges([&](Index low, Index, Index) { ++begin[low + 1]; });
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    std::vector<Edge> edges(begin.back());
    std::vector<std::size_t> at(begin.begin(), begin.end() - 1);
    for_edges([&](Index low, Index high, Index h) { edges[at[low]++] = {high, h}; });
    for (std::size_t v = 0; v < vertex_.size(); ++v) {
        std::sort(edges.begin() + begin[v], edges.begin() + begin[v + 1],
                  [](const Edge& a, const Edge& b) { return a.end != b.end ? a.end < b.end : a.half < b.half; });
        for (std::size_t i = begin[v]; i < begin[v + 1];) {
            std::size_t end = i;
            while (end < begin[v + 1] && edges[end].end == edges[i].end) ++end;
            if (end - i == 2 && origin(edges[i].half) != origin(edges[i + 1].half))
                pair(edges[i].half, edges[i + 1].half);
            i = end;
        }
    }
}

void StarMesh::find_corners() {
    std::vector<Index> some(vertex_.size(), -1);
    std::vector<std::uint8_t> degenerate(vertex_.size(), 0);
    for (Index f = 0; f < faces(); ++f)
        for (int k = 0; k < 3; ++k) {
            const Index v = face(f)[k];
            ++vertex_[v].valence;
            some[v] = 4 * f + k;
            if (repeats_an_index(face(f))) degenerate[v] = 1;
        }
    for (Index v = 0; v < vertices(); ++v)
        if (some[v] >= 0 && (degenerate[v] || !finds_corner(v, some[v]))) vertex_[v].corner = -1;
}

bool StarMesh::finds_corner(Index v, Index some) {
    Index first = some;
    while (twin(first) >= 0) {  // clockwise to the boundary, or once around
        first = next(twin(first));
        if (first == some) break;
    }
    const bool closed = twin(first) >= 0;
    Index count = 0;
    for (Index h = first;;) {
        ++count;
        h = twin(previous(h));
        if (h < 0 || h == first) break;
    }
    vertex_[v].corner = first;
    return count == vertex_[v].valence && count >= (closed ? 3 : 1);
}

void StarMesh::pair(Index a, Index b) {
    if (a >= 0) set_twin(a, b);
    if (b >= 0) set_twin(b, a);
}

Index StarMesh::add_face(Index a, Index b, Index c) {
    half_.emplace_back().origin = {a, b, c};
    return 4 * (faces() - 1);
}

void StarMesh::star(Index u, Star& star) const {
    const Index first = vertex_[u].corner, d = vertex_[u].valence;
    star.leaving.resize(d);
    star.spoke.resize(d + 1);
    star.closed = twin(first) >= 0;
    Index h = first;
    star.spoke[0] = target(h);
    for (Index i = 0; i < d; ++i) {
        star.leaving[i] = h;
        const Index back = previous(h);
        star.spoke[i + 1] = origin(back);
        h = twin(back);
    }
}

Index StarMesh::prefetch(Index u, int step, Index last) const {
    if (step == 0) {
        __builtin_prefetch(&vertex_[u]);
        return -1;
    }
    Index h = last;
    if (step == 1) {
        h = vertex_[u].corner;
    } else {
        if (h < 0) return -1;
        __builtin_prefetch(&vertex_[target(h)]);
        h = twin(previous(h));
    }
    if (h >= 0) __builtin_prefetch(&half_[face_of(h)]);
    return h;
}

void StarMesh::prefetch_faces_beside(const Star& star) const {
    for (const Index h : star.leaving) {
        const Index across = twin(next(h));
        if (across >= 0) __builtin_prefetch(&half_[face_of(across)]);
    }
}

void StarMesh::prefetch_vertices_beside(const Star& star, const Fan& fan) const {
    const Index d = star.faces(), from = fan.kind == Fan::last ? d - fan.faces : fan.start;
    for (Index i = from; i < from + fan.faces; ++i) {
        const Index across = twin(next(star.leaving[i < d ? i : i - d]));
        if (across >= 0) __builtin_prefetch(&vertex_[origin(previous(across))]);
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
    vertex_.emplace_back().corner = 0;
    const Index d = star.faces(), m = fan.faces;
    const Index from = fan.kind == Fan::inside ? fan.start : fan.kind == Fan::first ? 0 : d - m;
    add_normals(u, star, from, m, -1);
    for (Index i = from; i < from + m; ++i) {
        const Index h = star.leaving[i % d];
        set_origin(h, v);
    }
    if (fan.kind == Fan::inside) split_inside(u, star, fan, v);
    if (fan.kind == Fan::first) split_first(u, star, m, v);
    if (fan.kind == Fan::last) split_last(u, star, m, v);
}

void StarMesh::place(Index v, const Star& star, const Vec3& point) {
    vertex_[v].point = point;
    add_normals(v, star, 0, star.faces(), 1);
}

/// Adds faces of a star to the normals around them.
void StarMesh::add_normals(Index u, const Star& star, Index from, Index count, double sign) {
    const Index d = star.faces();
    const Vec3& centre = vertex_[u].point;
    for (Index k = from; k < from + count; ++k) {
        const Index i = k < d ? k : k - d;
        Vertex &a = vertex_[star.spoke[i]], &b = vertex_[star.spoke[i + 1]];
        const Vec3 n = sign * cross(a.point - centre, b.point - centre);
        vertex_[u].normal += n, a.normal += n, b.normal += n;
    }
}

void StarMesh::set_points(const Positions& points) {
    for (Index v = 0; v < vertices(); ++v) vertex_[v].point = points[v], vertex_[v].normal = Vec3(0, 0, 0);
    for (Index f = 0; f < faces(); ++f) {
        const auto [a, b, c] = face(f);
        const Vec3 n = cross(point(b) - point(a), point(c) - point(a));
        for (const Index v : {a, b, c}) vertex_[v].normal += n;
    }
}

void StarMesh::split_inside(Index u, const Star& star, const Fan& fan, Index v) {
    const Index d = star.faces(), m = fan.faces;
    const Index begin = star.leaving[fan.start], end = previous(star.leaving[(fan.start + m - 1) % d]);
    const Index left = star.spoke[fan.start], right = star.spoke[(fan.start + m - 1) % d + 1];
    const Index before = twin(begin), after = twin(end);
    const Index a = add_face(u, left, v), b = add_face(u, v, right);
    pair(a, before);
    pair(a + 1, begin);
    pair(a + 2, b);
    pair(b + 1, end);
    pair(b + 2, after);
    for (Index i = 0; i < m; ++i)
        if (vertex_[u].corner == star.leaving[(fan.start + i) % d]) vertex_[u].corner = a;
    vertex_[v].corner = begin;
    if (after < 0) set_corner(right, b + 2);
    vertex_[u].valence += 2 - m;
    vertex_[v].valence = m + 2;
    ++vertex_[left].valence, ++vertex_[right].valence;
}

void StarMesh::split_first(Index u, const Star& star, Index m, Index v) {
    const Index right = star.spoke[m], a = add_face(u, v, right);
    if (m == 0) {
        pair(a + 2, star.leaving[0]);
        vertex_[v].corner = a + 1;
    } else {
        const Index end = previous(star.leaving[m - 1]), after = twin(end);
        pair(a + 1, end);
        pair(a + 2, after);
        if (after < 0) set_corner(right, a + 2);
        vertex_[v].corner = star.leaving[0];
    }
    vertex_[u].corner = a;
    vertex_[u].valence += 1 - m;
    vertex_[v].valence = m + 1;
    ++vertex_[right].valence;
}

void StarMesh::split_last(Index u, const Star& star, Index m, Index v) {
    const Index d = star.faces(), left = star.spoke[d - m], a = add_face(u, left, v);
    if (m == 0) {
        pair(a, previous(star.leaving[d - 1]));
        set_corner(left, a + 1);
    } else {
        const Index begin = star.leaving[d - m], before = twin(begin);
        pair(a + 1, begin);
        pair(a, before);
        set_twin(a, before);
    }
    if (m == d) vertex_[u].corner = a;
    vertex_[v].corner = a + 2;
    vertex_[u].valence += 1 - m;
    vertex_[v].valence = m + 1;
    ++vertex_[left].valence;
}

}  // namespace multires::stream
