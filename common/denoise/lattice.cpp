#include "denoise/lattice.h"

#include "base/disjoint_sets.h"
#include "base/parallel.h"
#include "measure/vertex_normals.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace multires {
namespace {

constexpr double coordinate_rounding = 1e-6;  ///< of the largest coordinate: single precision, with a margin
constexpr double off = 0.05;                  ///< how far a coordinate may be from the lattice, in steps

/// How far a plane along the axes goes around its inner vertices at least, in mean edges and in steps: terraces are
/// narrower.
constexpr double edges_around = 2, steps_around = 3;
constexpr double terrace = 3;         ///< times as wide as what is beside it, one step away: it may be one
constexpr double upright = 1e-6;      ///< cosine to the axis: risers of stairs
constexpr double least_share = 0.05;  ///< of the vertices within such planes: what is less are terraces, too

/// The different values of a coordinate, ascending.
std::vector<double> levels(const Positions& p, int axis, double tolerance) {
    std::vector<double> values(p.size());
    for (std::size_t i = 0; i < p.size(); ++i) values[i] = p[i][axis];
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end(), [&](double a, double b) { return b - a < tolerance; }),
                 values.end());
    return values;
}

/// Least-squares step if `step` is near it and all values lie on its lattice.
std::optional<double> fitted(const std::vector<double>& values, double step) {
    double product = 0, square = 0;
    for (const double x : values) {
        const double n = std::round((x - values[0]) / step);
        if (std::abs(x - values[0] - n * step) > off * step) return std::nullopt;
        product += n * (x - values[0]);
        square += n * n;
    }
    return square > 0 ? product / square : step;
}

/// #F: a bit for each coordinate that the corners have in common.
std::vector<std::uint8_t> axes_in_common(const Faces& faces, const Positions& positions, double step) {
    std::vector<std::uint8_t> axes(faces.size());
    parallel_for(static_cast<Index>(faces.size()), [&](Index f) {
        const auto& [a, b, c] = faces[f];
        const Vec3 &p = positions[a], &q = positions[b], &r = positions[c];
        const Vec3 width = p.cwiseMax(q).cwiseMax(r) - p.cwiseMin(q).cwiseMin(r);
        for (int axis = 0; axis < 3; ++axis)
            if (width[axis] < step / 2) axes[f] |= 1U << axis;
    });
    return axes;
}

/// #V: along edges, how far it is to faces that have none of some axes in common, at most `enough`.
/// @param any         the axes, a bit each
/// @param[out] rings  passes that it took
std::vector<double> distance_to_others(const Faces& faces, const Positions& positions, const Incidence& at,
                                       const std::vector<std::uint8_t>& axes, std::uint8_t any, double enough,
                                       int& rings) {
    std::vector<double> distance(positions.size());
    for (std::size_t v = 0; v < distance.size(); ++v) {
        const auto around = at[static_cast<Index>(v)];
        const bool inside = std::all_of(around.begin(), around.end(), [&](Index f) { return (axes[f] & any) != 0; });
        distance[v] = inside ? enough : 0;
    }
    rings = 0;
    for (bool changed = true; changed; ++rings) {
        changed = false;
        for (const Face& f : faces)
            for (int k = 0; k < 3; ++k) {
                const Index v = f[k], w = f[(k + 1) % 3];
                const double length = (positions[v] - positions[w]).norm(), least = std::min(distance[v], distance[w]);
                for (const Index u : {v, w})
                    if (distance[u] > least + length) distance[u] = least + length, changed = true;
            }
    }
    return distance;
}

/// Parts of the surface that are even across an axis, and what is beside them one step up and one down.
struct Levels {
    std::vector<Index> of;                     ///< #V: one of the vertices of the level; -1: none
    std::vector<double> width;                 ///< of each level, mesh units
    std::array<std::vector<Index>, 2> beside;  ///< of each level, the widest; -1: none

    /// Whether so many levels to one side are even over a good part of the width.
    bool go_on(Index level, int side, int count) const {
        Index next = level;
        for (int k = 0; k < count; ++k) {
            next = beside[side][next];
            if (next < 0 || terrace * width[next] < width[level]) return false;
        }
        return true;
    }
};

/// @param width  #V: see distance_to_others()
Levels levels_across(const Faces& faces, const Positions& p, int axis, double step,
                     const std::vector<std::uint8_t>& axes, const std::vector<double>& width) {
    const std::size_t count = p.size();
    DisjointSets sets(static_cast<Index>(count));
    Levels levels{std::vector<Index>(count, -1), std::vector<double>(count), {}};
    for (std::size_t f = 0; f < faces.size(); ++f)
        if (axes[f] >> axis & 1U)
            for (const Index v : faces[f]) sets.join(faces[f][0], v), levels.of[v] = v;
    for (Index& level : levels.of) {
        if (level < 0) continue;
        const Index v = level;
        level = sets.find(v).root;
        levels.width[level] = std::max(levels.width[level], width[v]);
    }
    levels.beside.fill(std::vector<Index>(count, -1));
    const auto put_beside = [&](Index from, Index to, bool up) {
        Index& next = levels.beside[up ? 0 : 1][from];
        if (next < 0 || levels.width[to] > levels.width[next]) next = to;
    };
    for (const Face& f : faces) {
        const Vec3 area = area_vector(f, p);
        if (!(std::abs(area[axis]) > upright * area.norm())) continue;
        for (int k = 0; k < 3; ++k) {
            const Index v = f[k], w = f[(k + 1) % 3];
            const double rise = p[w][axis] - p[v][axis];
            if (levels.of[v] < 0 || levels.of[w] < 0 || std::abs(std::abs(rise) - step) > off * step) continue;
            put_beside(levels.of[v], levels.of[w], rise > 0);
            put_beside(levels.of[w], levels.of[v], rise < 0);
        }
    }
    return levels;
}

/// Takes the axis from faces of terraces: one step up and one down, or two to one side, the surface is as even over a
/// good part of the width. Where a plane ends it is not, ledges have two levels, and stairs are upright between them.
/// @param enough  width that is not told from more
void leave_terraces(const Faces& faces, const Positions& p, const Incidence& at, int axis, double step, double enough,
                    std::vector<std::uint8_t>& axes) {
    const auto bit = static_cast<std::uint8_t>(1U << axis);
    int rings = 0;
    const std::vector<double> width = distance_to_others(faces, p, at, axes, bit, enough, rings);
    const Levels levels = levels_across(faces, p, axis, step, axes, width);
    for (std::size_t f = 0; f < faces.size(); ++f) {
        if (!(axes[f] & bit)) continue;
        const Index level = levels.of[faces[f][0]];
        const bool between = levels.go_on(level, 0, 1) && levels.go_on(level, 1, 1);
        const bool goes_on = between || levels.go_on(level, 0, 2) || levels.go_on(level, 1, 2);
        if (levels.width[level] > 0 && goes_on) axes[f] &= static_cast<std::uint8_t>(~bit);
    }
}

}  // namespace

std::optional<double> lattice_step(const Positions& p, double least) {
    double largest = 0;
    for (const Vec3& v : p) largest = std::max(largest, v.cwiseAbs().maxCoeff());
    const double tolerance = coordinate_rounding * largest;
    if (!(least > 10 * tolerance)) return std::nullopt;
    std::array<std::vector<double>, 3> values;
    double step = 2 * largest;
    for (int axis = 0; axis < 3; ++axis) {
        values[axis] = levels(p, axis, tolerance);
        for (std::size_t i = 1; i < values[axis].size(); ++i)
            step = std::min(step, values[axis][i] - values[axis][i - 1]);
        if (step < least) return std::nullopt;
    }
    for (int round = 0; round < 2; ++round)
        for (const auto& v : values) {
            const std::optional<double> better = fitted(v, step);
            if (!better) return std::nullopt;
            if (v.size() > 2) step = *better;
        }
    return step;
}

bool between_voxels(const Positions& positions, double step) {
    if (positions.empty()) return false;
    // Which multiples are even cannot be seen at one vertex: every way to count them is tried.
    std::array<bool, 8> may_be;
    may_be.fill(true);
    for (const Vec3& p : positions) {
        std::array<unsigned, 3> odd;
        for (int c = 0; c < 3; ++c)
            odd[c] = std::fmod(std::abs(std::round((p[c] - positions[0][c]) / step)), 2) != 0 ? 1 : 0;
        for (unsigned way = 0; way < may_be.size(); ++way) {
            unsigned count = 0;
            for (unsigned c = 0; c < 3; ++c) count += odd[c] ^ (way >> c & 1U);
            may_be[way] = may_be[way] && count == 1;
        }
    }
    return std::find(may_be.begin(), may_be.end(), true) != may_be.end();
}

EvenPlaces even_places(const Faces& faces, const Positions& positions, const Incidence& at, double step, double edge) {
    std::vector<std::uint8_t> axes = axes_in_common(faces, positions, step);
    const double enough = std::max(edges_around * edge, steps_around * step);
    int rings = 0;
    for (int axis = 0; axis < 3; ++axis) leave_terraces(faces, positions, at, axis, step, terrace * enough, axes);
    const std::vector<double> distance = distance_to_others(faces, positions, at, axes, 7, enough, rings);
    EvenPlaces even{std::vector<std::uint8_t>(positions.size()), std::vector<std::uint8_t>(positions.size())};
    for (std::size_t v = 0; v < distance.size(); ++v) even.silent[v] = distance[v] >= enough;
    if (std::count(even.silent.begin(), even.silent.end(), 1) < least_share * static_cast<double>(positions.size()))
        return {};
    std::vector<std::uint8_t> inside(faces.size());
    for (std::size_t f = 0; f < faces.size(); ++f)
        if (std::any_of(faces[f].begin(), faces[f].end(), [&](Index v) { return even.silent[v] != 0; }))
            inside[f] = axes[f];
    // From there each plane goes on as far as its faces do.
    for (int ring = 0; ring <= rings; ++ring) {
        for (std::size_t f = 0; f < faces.size(); ++f)
            for (const Index v : faces[f]) even.axes[v] |= inside[f];
        parallel_for(static_cast<Index>(faces.size()), [&](Index f) {
            for (const Index v : faces[f]) inside[f] |= axes[f] & even.axes[v];
        });
    }
    return even;
}

void keep_in_planes(const EvenPlaces& even, Positions& moves) {
    for (std::size_t v = 0; v < even.axes.size(); ++v)
        for (int axis = 0; axis < 3; ++axis)
            if (even.axes[v] >> axis & 1U) moves[v][axis] = 0;
}

void keep_within_cells(const EvenPlaces& even, const Positions& rounded, double farthest, Positions& positions) {
    parallel_for(static_cast<Index>(positions.size()), [&](Index v) {
        Vec3 most = Vec3::Constant(farthest);
        for (int axis = 0; axis < 3 && !even.axes.empty(); ++axis)
            if (even.axes[v] >> axis & 1U) most[axis] = 0;
        positions[v] = positions[v].cwiseMax(rounded[v] - most).cwiseMin(rounded[v] + most);
    });
}

}  // namespace multires
