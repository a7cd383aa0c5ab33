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
class Star {
public:
    Star(const Proxy& proxy, const Stars& stars, Index v) {
        const Vec3 &p = proxy.before[v], &p_after = proxy.after[v];
        for (Index k = stars.offset[v]; k < stars.offset[v + 1]; ++k) {
            const Index face = stars.corner[k] / 3, at = stars.corner[k] % 3;
            const Index i = proxy.faces[face][(at + 1) % 3], j = proxy.faces[face][(at + 2) % 3];
            const Vec3 e[2] = {proxy.before[i] - p, proxy.before[j] - p};
            const Vec3 e_after[2] = {proxy.after[i] - p_after, proxy.after[j] - p_after};
            for (int side = 0; side < 2; ++side) {
                const double length = e[side].squaredNorm();
                if (!(length > 0)) continue;
                const Vec3 change = e_after[side] - e[side];
                moves_ = moves_ || change != Vec3::Zero();
                edges_.add(e[side], change, 1 / length);
            }
            add_normal(e[0].cross(e[1]), e_after[0].cross(e_after[1]));
        }
    }

    bool moves() const { return moves_; }

    /// See displacement_gradients().
    Mat3 gradient(const Mat3& of_all) const {
        constexpr double least = 0.01, most = 1, trust = 0.1;
        constexpr int passes = 3;
        double weight = most;
        Mat3 g;
        for (int pass = 0;; ++pass) {
            Fit fit = edges_;
            fit.add(normals_, weight);
            g = fit.solve(of_all, 1e-9);
            if (pass == passes - 1) return g;
            const double stretch = anisotropy(Mat3::Identity() + g), misfit = edges_.misfit(g);
            weight = misfit < most / trust * stretch ? std::max(least, trust * misfit / stretch) : most;
        }
    }

private:
    void add_normal(const Vec3& normal, const Vec3& normal_after) {
        const double area = normal.norm(), area_after = normal_after.norm();
        if (!(area > 0 && area_after > 0)) return;
        const Vec3 n = normal / area, n_after = normal_after / std::sqrt(area * area_after);
        normals_.add(n, n_after - n, 1);
    }

    /// How far a map is from a similarity: the square of its relative stretches, about.
    static double anisotropy(const Mat3& map) {
        const Mat3 square = map.transpose() * map;
        const double mean = square.trace() / 3;
        return mean > 0 ? (square - mean * Mat3::Identity()).squaredNorm() / (4 * mean) : 0;
    }

    Fit edges_, normals_;
    bool moves_ = false;
};

}  // namespace

Array<Mat3> displacement_gradients(const Proxy& proxy) {
    const auto count = static_cast<Index>(proxy.before.size());
    const Stars stars(proxy.faces, proxy.before.size());
    const Mat3 of_all = gradient_of_all(proxy);
    Array<Mat3> gradient(count);
    parallel_for(count, [&](Index v) {
        const Star star(proxy, stars, v);
        gradient[v] = star.moves() ? star.gradient(of_all) : Mat3(Mat3::Zero());
    });
    return gradient;
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
