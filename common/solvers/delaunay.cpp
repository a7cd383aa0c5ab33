#include "solvers/delaunay.h"

#include "base/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace multires {
namespace {

/// Of the sum of two cotangents. So that rounding does not decide where four vertices lie on a circle.
constexpr double least_sum = -1e-6;

constexpr Index none = -1;

Index next(Index h) { return h % 3 == 2 ? h - 2 : h + 1; }

/// The half-edge of the other face at each half-edge 3 f + k, from corner k to k + 1; none at rims, where more than two
/// faces meet, and where the faces run the same way.
Array<Index> twins(const Mesh& mesh, const Array<std::uint8_t>& usable) {
    const Index n = static_cast<Index>(mesh.positions.size()), halves = static_cast<Index>(3 * mesh.faces.size());
    Array<Index> offset(static_cast<std::size_t>(n) + 1, 0), half(halves);
    const auto from = [&](Index h) { return mesh.faces[h / 3][h % 3]; };
    for (Index h = 0; h < halves; ++h) offset[from(h) + 1] += usable[h / 3];
    for (Index v = 0; v < n; ++v) offset[v + 1] += offset[v];
    Array<Index> at(offset.begin(), offset.end() - 1), to(halves);
    for (Index h = 0; h < halves; ++h)
        if (usable[h / 3]) half[at[from(h)]] = h, to[at[from(h)]++] = from(next(h));
    Array<Index> twin(halves, none);
    parallel_for(n, [&](Index a) {
        for (Index i = offset[a]; i < offset[a + 1]; ++i) {
            const Index b = to[i];
            if (b < a) continue;
            Index found = none, same = 0, opposite = 0;
            for (Index k = offset[a]; k < offset[a + 1]; ++k) same += to[k] == b;
            for (Index k = offset[b]; k < offset[b + 1]; ++k)
                if (to[k] == a) found = half[k], ++opposite;
            if (same == 1 && opposite == 1) twin[half[i]] = found, twin[found] = half[i];
        }
    });
    return twin;
}

class Turner {
public:
    Turner(const Mesh& mesh, Array<Index> twin, const std::vector<std::uint8_t>& held)
        : twin_(std::move(twin)), held_(held) {
        mesh_.faces = mesh.faces;
        mesh_.length.resize(mesh.faces.size());
        mesh_.changed.assign(mesh.faces.size(), 0);
        parallel_for(static_cast<Index>(mesh.faces.size()), [&](Index f) {
            for (int k = 0; k < 3; ++k)
                mesh_.length[f][k] =
                    (mesh.positions[mesh.faces[f][(k + 1) % 3]] - mesh.positions[mesh.faces[f][k]]).norm();
        });
    }

    void turn_all(std::vector<Index> queue) {
        const std::size_t most = 10 * twin_.size() + queue.size();  // it ends by itself, but for rounding
        for (std::size_t at = 0; at < queue.size() && queue.size() < most; ++at) turn(queue[at], queue);
    }
    IntrinsicMesh take() { return std::move(mesh_); }

private:
    Index corner(Index h) const { return mesh_.faces[h / 3][h % 3]; }
    double& length(Index h) { return mesh_.length[h / 3][h % 3]; }

    /// The point opposite to the half-edge h from (0, 0) to (length, 0), above it.
    std::array<double, 2> apex(Index h) {
        const double l = length(h), right = length(next(h)), left = length(next(next(h)));
        const double x = (l * l + (left - right) * (left + right)) / (2 * l);
        return {x, std::sqrt(std::max(0.0, (left - x) * (left + x)))};
    }

    void turn(Index h, std::vector<Index>& queue) {
        const Index t = twin_[h];
        if (t == none) return;
        const Index f = h / 3, g = t / 3, bc = next(h), ca = next(bc), ad = next(t), db = next(ad);
        const Index a = corner(h), b = corner(bc), c = corner(ca), d = corner(db);
        if (c == d || f == g || (!held_.empty() && held_[a] && held_[b])) return;
        const double l = length(h);
        const auto [cx, cy] = apex(h);
        const auto [from_b, dy] = apex(t);
        const double dx = l - from_b;
        // Sum of cotangents < least_sum, times cy dy.
        if (!((cx * (cx - l) + cy * cy) * dy + (dx * (dx - l) + dy * dy) * cy < least_sum * l * cy * dy)) return;
        const double across = std::hypot(cx - dx, cy + dy);
        const std::array<Index, 4> old = {twin_[db], twin_[bc], twin_[ca], twin_[ad]};
        for (const Index o : old)
            if (o != none && (o / 3 == f || o / 3 == g)) return;
        if (!(across > 0 && std::isfinite(across))) return;
        const std::array<double, 4> sides = {length(db), length(bc), length(ca), length(ad)};
        mesh_.faces[f] = {c, d, b};
        mesh_.faces[g] = {d, c, a};
        mesh_.length[f] = {across, sides[0], sides[1]};
        mesh_.length[g] = {across, sides[2], sides[3]};
        mesh_.changed[f] = mesh_.changed[g] = 1;
        const std::array<Index, 4> place = {3 * f + 1, 3 * f + 2, 3 * g + 1, 3 * g + 2};
        twin_[3 * f] = 3 * g, twin_[3 * g] = 3 * f;
        for (int k = 0; k < 4; ++k) {
            twin_[place[k]] = old[k];
            if (old[k] != none) twin_[old[k]] = place[k];
            queue.push_back(place[k]);
        }
    }

    IntrinsicMesh mesh_;
    Array<Index> twin_;
    const std::vector<std::uint8_t>& held_;
};

}  // namespace

IntrinsicMesh intrinsic_delaunay(const Mesh& mesh, const Array<std::array<double, 3>>& cotangent,
                                 const Array<std::uint8_t>& usable, const std::vector<std::uint8_t>& held) {
    Array<Index> twin = twins(mesh, usable);
    std::vector<Index> bad;
    for (Index h = 0; h < static_cast<Index>(twin.size()); ++h) {
        const Index t = twin[h];
        if (t > h && cotangent[h / 3][h % 3] + cotangent[t / 3][t % 3] < least_sum) bad.push_back(h);
    }
    if (bad.empty()) return {mesh.faces, {}, {}};
    Turner turner(mesh, std::move(twin), held);
    turner.turn_all(std::move(bad));
    return turner.take();
}

}  // namespace multires
