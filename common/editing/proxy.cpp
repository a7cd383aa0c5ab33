#include "editing/proxy.h"

#include "base/blocks.h"
#include "base/parallel.h"
#include "measure/distance.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace multires {
namespace {

/// The corners of faces around each vertex, in order of the faces: 3 x face + corner.
struct Stars {
    Array<Index> offset, corner;

    Stars(const Faces& faces, std::size_t vertices) : offset(vertices + 1, 0) {
        for (const Face& f : faces)
            if (!repeats_an_index(f))
                for (const Index v : f) ++offset[v + 1];
        for (std::size_t v = 0; v < vertices; ++v) offset[v + 1] += offset[v];
        corner.resize(offset.back());
        Array<Index> next(offset.begin(), offset.end() - 1);
        for (std::size_t f = 0; f < faces.size(); ++f)
            if (!repeats_an_index(faces[f]))
                for (int k = 0; k < 3; ++k) corner[next[faces[f][k]]++] = static_cast<Index>(3 * f + k);
    }
};

/// Least squares G for pairs with b = G a: sums of b a', of a a' and of squares.
struct Fit {
    Mat3 ba = Mat3::Zero(), aa = Mat3::Zero();
    double bb = 0, weight = 0;

    void add(const Vec3& a, const Vec3& b, double w) {
        ba += w * b * a.transpose();
        aa += w * a * a.transpose();
        bb += w * b.squaredNorm();
        weight += w * a.squaredNorm();
    }
    void add(const Fit& other, double w) {
        ba += w * other.ba;
        aa += w * other.aa;
        bb += w * other.bb;
        weight += w * other.weight;
    }
    /// b - t c in place of b.
    /// @param c     the same pairs with c for b
    /// @param both  the sum of b c
    void subtract(const Fit& c, double t, double both) {
        ba -= t * c.ba;
        bb += t * (t * c.bb - 2 * both);
    }
    /// Mean of |b - G a|^2 / |a|^2.
    double misfit(const Mat3& g) const {
        if (!(weight > 0)) return 0;
        return std::max(0.0, bb - 2 * g.cwiseProduct(ba).sum() + (g * aa).cwiseProduct(g).sum()) / weight;
    }
    /// What the pairs leave open is taken from `otherwise`, and a little of it everywhere.
    Mat3 solve(const Mat3& otherwise, double little) const {
        const double ridge = little * aa.trace();
        if (!(ridge > 0)) return otherwise;
        const Mat3 known = aa + ridge * Mat3::Identity();
        return (ba + ridge * otherwise) * known.inverse();
    }
};

/// The gradient of the affine displacement that fits all vertices of faces best.
Mat3 gradient_of_all(const Proxy& proxy) {
    Vec3 before = Vec3::Zero(), moved = Vec3::Zero();
    double count = 0;
    for (const Face& f : proxy.faces)
        for (const Index v : f) before += proxy.before[v], moved += proxy.after[v] - proxy.before[v], ++count;
    before /= count, moved /= count;
    Fit fit;
    for (const Face& f : proxy.faces)
        for (const Index v : f) fit.add(proxy.before[v] - before, proxy.after[v] - proxy.before[v] - moved, 1);
    return fit.solve(Mat3::Zero(), 1e-15);
}

/// The edges around a vertex, and the normals of its faces.
///
/// The change of an edge to a neighbour is that by the mean of the gradients at both ends, to third order in its
/// length, and by the vertex's own to second order only. So what the gradients around differ from its own, halved, is
/// taken from the change ("curved"), in the measure that the edges fit best with it: fully where the motion is curved,
/// not at all where the edges agree already, as after a stretch, and the gradients around differ by what is wrong in
/// them. Likewise for normals, in the middle of faces.
class Star {
public:
    /// @param around  gradients of all vertices, averaged; empty: not known yet
    Star(const Proxy& proxy, const Stars& stars, Index v, const Array<Mat3>& around) {
        const Vec3 &p = proxy.before[v], &p_after = proxy.after[v];
        for (Index k = stars.offset[v]; k < stars.offset[v + 1]; ++k) {
            const Index face = stars.corner[k] / 3, at = stars.corner[k] % 3;
            Vec3 e[2], e_after[2];
            Mat3 more = Mat3::Zero();
            for (int side = 0; side < 2; ++side) {
                const Index i = proxy.faces[face][(at + 1 + side) % 3];
                e[side] = proxy.before[i] - p, e_after[side] = proxy.after[i] - p_after;
                const Mat3 differs = around.empty() ? Mat3(Mat3::Zero()) : Mat3(around[i] - around[v]);
                more += differs / 3;
                add_edge(e[side], e_after[side], 0.5 * (differs * e[side]));
            }
            add_normal(e[0].cross(e[1]), e_after[0].cross(e_after[1]), more);
        }
    }

    bool moves() const { return moves_; }

    /// See displacement_gradients().
    Mat3 gradient(const Mat3& of_all) const {
        constexpr double least = 0.01, most = 1, trust = 0.1;
        constexpr int passes = 3;
        const double t = share_of_curved();
        Fit edges = edges_, normals = normals_;
        edges.subtract(curved_edges_, t, edges_by_curved_);
        normals.subtract(curved_normals_, t, 0);
        double weight = most;
        Mat3 g;
        for (int pass = 0;; ++pass) {
            Fit fit = edges;
            fit.add(normals, weight);
            g = fit.solve(of_all, little);
            if (pass == passes - 1) return g;
            const double stretch = anisotropy(Mat3::Identity() + g), misfit = edges.misfit(g);
            weight = misfit < most / trust * stretch ? std::max(least, trust * misfit / stretch) : most;
        }
    }

private:
    static constexpr double little = 1e-9;

    void add_edge(const Vec3& e, const Vec3& e_after, const Vec3& curved) {
        const double square = e.squaredNorm();
        if (!(square > 0)) return;
        const Vec3 change = e_after - e;
        moves_ = moves_ || change != Vec3::Zero();
        edges_.add(e, change, 1 / square);
        curved_edges_.add(e, curved, 1 / square);
        edges_by_curved_ += change.dot(curved) / square;
    }

    void add_normal(const Vec3& normal, const Vec3& normal_after, const Mat3& more) {
        const double area = normal.norm(), area_after = normal_after.norm();
        if (!(area > 0 && area_after > 0)) return;
        const Vec3 n = normal / area, n_after = normal_after / std::sqrt(area * area_after);
        normals_.add(n, n_after - n, 1);
        curved_normals_.add(n, more * n, 1);
    }

    /// Of the edges' misfit without that of a linear map, as a function of the share: its minimum, in [0, 1].
    double share_of_curved() const {
        const double ridge = little * edges_.aa.trace();
        if (!(ridge > 0)) return 0;
        const Mat3 known = edges_.aa + ridge * Mat3::Identity();
        const Mat3 map = curved_edges_.ba * known.inverse();
        const double square = curved_edges_.bb - map.cwiseProduct(curved_edges_.ba).sum();
        const double product = edges_by_curved_ - map.cwiseProduct(edges_.ba).sum();
        constexpr double rounding = 1e-12;
        return square > rounding * edges_.bb ? std::clamp(product / square, 0.0, 1.0) : 0;
    }

    /// How far a map is from a similarity: the square of its relative stretches, about.
    static double anisotropy(const Mat3& map) {
        const Mat3 square = map.transpose() * map;
        const double mean = square.trace() / 3;
        return mean > 0 ? (square - mean * Mat3::Identity()).squaredNorm() / (4 * mean) : 0;
    }

    Fit edges_, normals_, curved_edges_, curved_normals_;
    double edges_by_curved_ = 0;
    bool moves_ = false;
};

/// Each gradient and the mean of its neighbours', half and half: without the alternating errors that corrections by
/// the differences of neighbours would amplify.
Array<Mat3> averaged(const Array<Mat3>& gradient, const Faces& faces, const Stars& stars) {
    Array<Mat3> mean(gradient.size());
    parallel_for(static_cast<Index>(gradient.size()), [&](Index v) {
        const Index begin = stars.offset[v], end = stars.offset[v + 1];
        mean[v] = gradient[v];
        if (begin == end) return;
        Mat3 sum = Mat3::Zero();
        for (Index k = begin; k < end; ++k) {
            const Face& f = faces[stars.corner[k] / 3];
            const Index at = stars.corner[k] % 3;
            sum += gradient[f[(at + 1) % 3]] + gradient[f[(at + 2) % 3]];
        }
        mean[v] = 0.5 * (gradient[v] + sum / (2 * (end - begin)));
    });
    return mean;
}

}  // namespace

Array<Mat3> displacement_gradients(const Proxy& proxy) {
    const auto count = static_cast<Index>(proxy.before.size());
    const Stars stars(proxy.faces, proxy.before.size());
    const Mat3 of_all = gradient_of_all(proxy);
    constexpr int corrections = 2;  // more gain little where proxies are coarse, and lose a little where they are fine
    Array<Mat3> gradient(count), around;
    for (int pass = 0;; ++pass) {
        parallel_for(count, [&](Index v) {
            const Star star(proxy, stars, v, around);
            gradient[v] = star.moves() ? star.gradient(of_all) : Mat3(Mat3::Zero());
        });
        if (pass == corrections) return gradient;
        around = averaged(gradient, proxy.faces, stars);
    }
}

Vec3 closest_weights(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 q = closest_on_triangle(p, a, b, c), ab = b - a, ac = c - a, aq = q - a;
    const double ab_ab = ab.squaredNorm(), ab_ac = ab.dot(ac), ac_ac = ac.squaredNorm();
    const double area = ab_ab * ac_ac - ab_ac * ab_ac;
    Vec3 w(1, 0, 0);
    if (area > 1e-10 * ab_ab * ac_ac) {
        w[1] = std::max(0.0, (ac_ac * ab.dot(aq) - ab_ac * ac.dot(aq)) / area);
        w[2] = std::max(0.0, (ab_ab * ac.dot(aq) - ab_ac * ab.dot(aq)) / area);
        w[0] = std::max(0.0, 1 - w[1] - w[2]);
        return w / w.sum();
    }
    // On the longest side, which the two others all but cover.
    const Vec3* const corner[3] = {&a, &b, &c};
    int first = 0;
    double longest = -1;
    for (int k = 0; k < 3; ++k) {
        const double length = (*corner[(k + 1) % 3] - *corner[k]).squaredNorm();
        if (length > longest) longest = length, first = k;
    }
    const int second = (first + 1) % 3;
    const Vec3 side = *corner[second] - *corner[first];
    const double t = longest > 0 ? std::clamp((q - *corner[first]).dot(side) / longest, 0.0, 1.0) : 0;
    w.setZero();
    w[first] = 1 - t, w[second] = t;
    return w;
}

Array<Foot> feet_of(const Positions& points, const Faces& faces, const Positions& positions, const Progress& progress) {
    progress.report(0, "Sorting the faces of the proxy");
    const SurfaceTree tree(faces, positions);
    const auto count = static_cast<Index>(points.size());
    Array<Foot> feet(count);
    parallel_blocks(count, progress.part(0.1, 1), "Binding vertices to the proxy", [&](Index begin, Index end) {
        Index hint = -1;
        for (Index i = begin; i < end; ++i) {
            const SurfaceTree::Hit hit = tree.closest(points[i], hint);
            const Face& f = faces[hit.face];
            feet[i] = {hit.face, closest_weights(points[i], positions[f[0]], positions[f[1]], positions[f[2]]),
                       hit.squared};
            hint = hit.face;
        }
    });
    return feet;
}

Motion motion_at(const Positions& points, const Array<Foot>& feet, const Proxy& proxy, const Array<Mat3>& gradients) {
    Motion motion{Positions(points.size()), Array<Mat3>(points.size())};
    parallel_for(static_cast<Index>(points.size()), [&](Index i) {
        const Foot& foot = feet[i];
        const Face& f = proxy.faces[foot.face];
        Vec3 q = Vec3::Zero(), u = Vec3::Zero();
        Mat3 g = Mat3::Zero();
        for (int k = 0; k < 3; ++k) {
            q += foot.weight[k] * proxy.before[f[k]];
            u += foot.weight[k] * (proxy.after[f[k]] - proxy.before[f[k]]);
            g += foot.weight[k] * gradients[f[k]];
        }
        for (int k = 0; k < 3; ++k) u += 0.5 * foot.weight[k] * (gradients[f[k]] * (q - proxy.before[f[k]]));
        motion.displacement[i] = u + g * (points[i] - q);
        motion.gradient[i] = g;
    });
    return motion;
}

}  // namespace multires
