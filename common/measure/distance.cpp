#include "measure/distance.h"

#include "base/parallel.h"
#include "base/radix_sort.h"
#include "base/reduce.h"
#include "measure/measure.h"

#include <algorithm>
#include <cmath>

namespace multires {
namespace {

constexpr Index leaf_faces = 4;

/// Spreads the low 10 bits so that two zeros follow each.
std::uint32_t spread(std::uint32_t x) {
    x = (x | x << 16) & 0x030000ff;
    x = (x | x << 8) & 0x0300f00f;
    x = (x | x << 4) & 0x030c30c3;
    return (x | x << 2) & 0x09249249;
}

/// Faces along a space-filling curve (Morton order of their centres).
std::vector<Index> curve_order(const Faces& faces, const Positions& positions, const Box& box) {
    const Vec3 extent = (box.high - box.low).cwiseMax(1e-300);
    const double longest = extent.maxCoeff();
    Array<std::uint32_t> key(faces.size());
    parallel_for(static_cast<Index>(faces.size()), [&](Index f) {
        const Vec3 centre = (positions[faces[f][0]] + positions[faces[f][1]] + positions[faces[f][2]]) / 3;
        std::uint32_t code = 0;
        for (int k = 0; k < 3; ++k) {
            const double cell = (centre[k] - box.low[k]) / longest * 1024;
            code |= spread(static_cast<std::uint32_t>(std::clamp(cell, 0.0, 1023.0))) << k;
        }
        key[f] = code;
    });
    return sorted_by_key(key, ~0U);
}

double squared_distance_to_box(const Eigen::Vector3f& low, const Eigen::Vector3f& high, const Vec3& p) {
    double sum = 0;
    for (int k = 0; k < 3; ++k) {
        const double outside = std::max(0.0, std::max(low[k] - p[k], p[k] - high[k]));
        sum += outside * outside;
    }
    return sum;
}

Vec3 closest_on_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
    const Vec3 d = b - a;
    const double length = d.squaredNorm();
    return length > 0 ? Vec3(a + std::clamp(d.dot(p - a) / length, 0.0, 1.0) * d) : a;
}

/// For triangles that are next to nothing but their sides.
Vec3 closest_on_sides(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    Vec3 best = closest_on_segment(p, a, b);
    for (const Vec3& other : {closest_on_segment(p, b, c), closest_on_segment(p, c, a)})
        if ((other - p).squaredNorm() < (best - p).squaredNorm()) best = other;
    return best;
}

double area(const Vec3& a, const Vec3& b, const Vec3& c) { return 0.5 * (b - a).cross(c - a).norm(); }

}  // namespace

Vec3 closest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 ab = b - a, ac = c - a, ap = p - a;
    const double ab_ab = ab.squaredNorm(), ab_ac = ab.dot(ac), ac_ac = ac.squaredNorm();
    if (ab_ab * ac_ac - ab_ac * ab_ac <= 1e-10 * ab_ab * ac_ac) return closest_on_sides(p, a, b, c);
    // By the region of the plane that the projection falls into, from dot products alone.
    const double ab_ap = ab.dot(ap), ac_ap = ac.dot(ap);
    if (ab_ap <= 0 && ac_ap <= 0) return a;
    const double ab_bp = ab_ap - ab_ab, ac_bp = ac_ap - ab_ac;
    if (ab_bp >= 0 && ac_bp <= ab_bp) return b;
    const double ab_cp = ab_ap - ab_ac, ac_cp = ac_ap - ac_ac;
    if (ac_cp >= 0 && ab_cp <= ac_cp) return c;
    const double wc = ab_ap * ac_bp - ab_bp * ac_ap;
    if (wc <= 0 && ab_ap >= 0 && ab_bp <= 0) return a + ab_ap / ab_ab * ab;
    const double wb = ab_cp * ac_ap - ab_ap * ac_cp;
    if (wb <= 0 && ac_ap >= 0 && ac_cp <= 0) return a + ac_ap / ac_ac * ac;
    const double wa = ab_bp * ac_cp - ab_cp * ac_bp;
    const double from_b = ac_bp - ab_bp, to_c = ab_cp - ac_cp;
    if (wa <= 0 && from_b >= 0 && to_c >= 0) return b + from_b / (from_b + to_c) * (c - b);
    const double sum = wa + wb + wc;
    if (!(sum > 0)) return closest_on_sides(p, a, b, c);
    return a + wb / sum * ab + wc / sum * ac;
}

SurfaceTree::SurfaceTree(const Faces& faces, const Positions& positions) : faces_(faces), positions_(positions) {
    const Box box = bounding_box(positions);
    centre_ = box.center();
    order_ = curve_order(faces, positions, box);
    const Index leaves = (static_cast<Index>(order_.size()) + leaf_faces - 1) / leaf_faces;
    Index width = 1;
    while (width < leaves) width *= 2;
    first_leaf_ = width - 1;
    constexpr float inf = std::numeric_limits<float>::infinity();
    node_.assign(first_leaf_ + width, {Eigen::Vector3f::Constant(inf), Eigen::Vector3f::Constant(-inf)});
    parallel_for(leaves, [&](Index leaf) {
        Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
        const Index end = std::min(static_cast<Index>(order_.size()), (leaf + 1) * leaf_faces);
        for (Index i = leaf * leaf_faces; i < end; ++i)
            for (const Index v : faces_[order_[i]]) {
                low = low.cwiseMin(positions_[v] - centre_);
                high = high.cwiseMax(positions_[v] - centre_);
            }
        Node& node = node_[first_leaf_ + leaf];
        for (int k = 0; k < 3; ++k) {
            node.low[k] = std::nextafter(static_cast<float>(low[k]), -inf);
            node.high[k] = std::nextafter(static_cast<float>(high[k]), inf);
        }
    });
    for (Index i = first_leaf_ - 1; i >= 0; --i) {
        const Node &a = node_[2 * i + 1], &b = node_[2 * i + 2];
        node_[i] = {a.low.cwiseMin(b.low), a.high.cwiseMax(b.high)};
    }
}

void SurfaceTree::visit(Index face, const Vec3& p, Hit& hit) const {
    const Face& f = faces_[face];
    const Vec3 point = closest_on_triangle(p, positions_[f[0]], positions_[f[1]], positions_[f[2]]);
    const double squared = (point - p).squaredNorm();
    if (squared < hit.squared || hit.face < 0) hit = {squared, face, point};
}

SurfaceTree::Hit SurfaceTree::closest(const Vec3& p, Index hint) const {
    Hit hit;
    if (hint >= 0) visit(hint, p, hit);
    const Vec3 q = p - centre_;
    struct Entry {
        double squared;
        Index node;
    };
    std::array<Entry, 64> stack;
    int top = 0;
    stack[top++] = {squared_distance_to_box(node_[0].low, node_[0].high, q), 0};
    while (top > 0) {
        const Entry e = stack[--top];
        if (e.squared >= hit.squared) continue;
        if (e.node >= first_leaf_) {
            const Index begin = (e.node - first_leaf_) * leaf_faces;
            const Index end = std::min(static_cast<Index>(order_.size()), begin + leaf_faces);
            for (Index i = begin; i < end; ++i) visit(order_[i], p, hit);
            continue;
        }
        Entry near{0, 2 * e.node + 1}, far{0, 2 * e.node + 2};
        for (Entry* child : {&near, &far})
            child->squared = squared_distance_to_box(node_[child->node].low, node_[child->node].high, q);
        if (far.squared < near.squared) std::swap(near, far);
        if (far.squared < hit.squared) stack[top++] = far;
        if (near.squared < hit.squared) stack[top++] = near;
    }
    return hit;
}

/// The least |at| at which the line is in the box; infinite if nowhere.
double SurfaceTree::nearest_in_box(const Node& node, const Vec3& p, const Vec3& direction) const {
    constexpr double inf = std::numeric_limits<double>::infinity();
    double begin = -inf, end = inf;
    for (int k = 0; k < 3; ++k) {
        const double low = node.low[k] - p[k], high = node.high[k] - p[k];
        if (!(low <= high)) return inf;  // an empty leaf
        if (direction[k] == 0) {
            if (low > 0 || high < 0) return inf;
            continue;
        }
        const double a = low / direction[k], b = high / direction[k];
        begin = std::max(begin, std::min(a, b)), end = std::min(end, std::max(a, b));
    }
    if (begin > end) return inf;
    return begin <= 0 && end >= 0 ? 0 : std::min(std::abs(begin), std::abs(end));
}

SurfaceTree::Crossing SurfaceTree::nearest_crossing(const Vec3& p, const Vec3& direction, double within) const {
    Crossing best;
    double most = within;
    const Vec3 q = p - centre_;
    const auto meet = [&](Index face) {
        constexpr double rounding = -1e-9;  // of barycentric weights: neighbours overlap rather than gape
        const Face& f = faces_[face];
        const Vec3 a = positions_[f[0]] - p, ab = positions_[f[1]] - positions_[f[0]],
                   ac = positions_[f[2]] - positions_[f[0]];
        const Vec3 n = ab.cross(ac);
        const double along = n.dot(direction);
        if (!(along > 1e-6 * n.norm())) return;
        const Vec3 across = direction.cross(a);
        const double u = -ac.dot(across) / along, v = ab.dot(across) / along, at = n.dot(a) / along;
        if (u < rounding || v < rounding || u + v > 1 - rounding || !(std::abs(at) <= most)) return;
        if (best.face >= 0 && std::abs(at) == most) return;
        best = {at, face};
        most = std::abs(at);
    };
    std::array<Index, 64> stack;
    int top = 0;
    stack[top++] = 0;
    while (top > 0) {
        const Index node = stack[--top];
        if (nearest_in_box(node_[node], q, direction) > most) continue;
        if (node < first_leaf_) {
            stack[top++] = 2 * node + 2, stack[top++] = 2 * node + 1;
            continue;
        }
        const Index begin = (node - first_leaf_) * leaf_faces;
        const Index end = std::min(static_cast<Index>(order_.size()), begin + leaf_faces);
        for (Index i = begin; i < end; ++i) meet(order_[i]);
    }
    return best;
}

SurfaceSamples sample_surface(const Faces& faces, const Positions& positions, double spacing) {
    SurfaceSamples s;
    std::vector<double> vertex_weight(positions.size(), 0);
    std::vector<Index> vertex_face(positions.size(), -1);
    for (std::size_t f = 0; f < faces.size(); ++f) {
        const Vec3 corner[3] = {positions[faces[f][0]], positions[faces[f][1]], positions[faces[f][2]]};
        double longest = 0;
        for (int k = 0; k < 3; ++k) longest = std::max(longest, (corner[(k + 1) % 3] - corner[k]).norm());
        const int k = spacing > 0 ? static_cast<int>(std::clamp(std::ceil(longest / spacing), 1.0, 32.0)) : 1;
        const double part = area(corner[0], corner[1], corner[2]) / (k * k);
        for (const Index v : faces[f]) {
            vertex_weight[v] += part / 12;
            vertex_face[v] = static_cast<Index>(f);
        }
        const double weight = part - 3 * part / 12 / (k * k);
        const auto add = [&](double i, double j) {  // the point at i, j of k steps along the two edges
            const double u = i / k, v = j / k;
            s.points.push_back((1 - u - v) * corner[0] + u * corner[1] + v * corner[2]);
            s.weights.push_back(weight);
            s.face.push_back(static_cast<Index>(f));
        };
        for (int i = 0; i < k; ++i)
            for (int j = 0; i + j < k; ++j) {
                add(i + 1 / 3.0, j + 1 / 3.0);
                if (i + j + 1 < k) add(i + 2 / 3.0, j + 2 / 3.0);
            }
    }
    for (std::size_t v = 0; v < positions.size(); ++v) {
        if (vertex_face[v] < 0) continue;
        s.points.push_back(positions[v]);
        s.weights.push_back(vertex_weight[v]);
        s.face.push_back(vertex_face[v]);
    }
    return s;
}

Distance distance_to(const SurfaceSamples& samples, const SurfaceTree& tree) {
    const auto found = chunked_reduce<Lengths>(samples.points.size(), [&](std::size_t begin, std::size_t end) {
        Lengths part;
        Index hint = -1;
        for (std::size_t i = begin; i < end; ++i) {
            const SurfaceTree::Hit hit = tree.closest(samples.points[i], hint);
            hint = hit.face;
            part.add(hit.squared, samples.weights[i]);
        }
        return part;
    });
    return {found.largest(), found.rms()};
}

Distance two_sided_distance(const Faces& a_faces, const Positions& a_positions, const Faces& b_faces,
                            const Positions& b_positions) {
    // Twice the mean edge length keeps nearly all faces of the finer mesh in one piece.
    const double spacing = 2 * std::min(mean_edge_length(a_faces, a_positions), mean_edge_length(b_faces, b_positions));
    const Distance ab = distance_to(sample_surface(a_faces, a_positions, spacing), SurfaceTree(b_faces, b_positions));
    const Distance ba = distance_to(sample_surface(b_faces, b_positions, spacing), SurfaceTree(a_faces, a_positions));
    return {std::max(ab.largest, ba.largest), std::sqrt((ab.rms * ab.rms + ba.rms * ba.rms) / 2)};
}

}  // namespace multires
