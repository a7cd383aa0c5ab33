#include "solvers/stiffness.h"

#include "base/parallel.h"
#include "solvers/delaunay.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace multires {
namespace {

/// What a face gives to its three edges (edge k is opposite to corner k), and its area.
struct FaceWeights {
    std::array<double, 3> cotangent;  ///< halved
    double third;                     ///< of the area; negative: the face does not count
    double spread;                    ///< mass between two of its corners
};

/// Of the linear elements' masses in those of a face, see Stiffness::mass_weight. Slivers have no limit themselves.
constexpr double least_share = -2, most_share = 1;
/// Chosen on jittered, flipped and graded planes, so that waves of 4 and of 6 edges are off by as little either way.
constexpr double usual_share = 0.62;

/// See bending().
constexpr Index most_bending_neighbours = 100;

constexpr FaceWeights no_face{{0, 0, 0}, -1, 0};

bool can_be_squared(double square) { return square > 1e-280 && square < 1e280; }  // false for what is not a number

/// @param dot     products of the edges at each corner, from it, divided by `unit`, the square of a length
/// @param square  of the edges opposite to them, the same
/// @param twice   the area, the same
FaceWeights weights_of(const std::array<double, 3>& dot, const std::array<double, 3>& square, double twice, double unit,
                       double least_area) {
    const double sum = square[0] + square[1] + square[2], safe = std::max(twice, least_area * sum), scale = 0.5 / safe;
    FaceWeights face{{}, twice * unit / 6, 0};
    double fourth = 0;
    for (int k = 0; k < 3; ++k) {
        face.cotangent[k] = dot[k] * scale;
        fourth += face.cotangent[k] * square[k] * square[k];
    }
    const double share = 1.5 * fourth / (safe * sum);
    face.spread = (std::clamp(share, least_share, most_share) + usual_share) / 2 * face.third / 4;
    return face;
}

FaceWeights face_weights(const Mesh& mesh, const Face& f, double least_area) {
    if (f[0] == f[1] || f[1] == f[2] || f[2] == f[0]) return no_face;
    const Vec3 &a = mesh.positions[f[0]], &b = mesh.positions[f[1]], &c = mesh.positions[f[2]];
    const Vec3 ab = b - a, bc = c - b, ca = a - c;
    const double longest = std::max({ab.squaredNorm(), bc.squaredNorm(), ca.squaredNorm()});
    if (!can_be_squared(longest)) return no_face;
    const double s = 1 / std::sqrt(longest);  // so that products of lengths neither overflow nor vanish
    const Vec3 u = ab * s, v = bc * s, w = ca * s;
    return weights_of({-w.dot(u), -u.dot(v), -v.dot(w)}, {v.squaredNorm(), w.squaredNorm(), u.squaredNorm()},
                      u.cross(w).norm(), longest, least_area);
}

/// @param length  of the edges (0, 1), (1, 2), (2, 0)
FaceWeights face_weights(const std::array<double, 3>& length, double least_area) {
    const double longest = *std::max_element(length.begin(), length.end());
    if (!can_be_squared(longest * longest)) return no_face;
    const double c = length[0] / longest, a = length[1] / longest, b = length[2] / longest;
    std::array<double, 3> sorted = {a, b, c};
    std::sort(sorted.begin(), sorted.end());
    const auto [x, y, z] = sorted;  // Heron's formula as Kahan has it
    const double twice = std::sqrt(std::max(0.0, (z + (y + x)) * (x - (z - y)) * (x + (z - y)) * (z + (y - x)))) / 2;
    const double aa = a * a, bb = b * b, cc = c * c;
    return weights_of({(bb + cc - aa) / 2, (cc + aa - bb) / 2, (aa + bb - cc) / 2}, {aa, bb, cc}, twice,
                      longest * longest, least_area);
}

/// The faces to sum over, and what they give.
struct WeightedFaces {
    Faces turned;  ///< empty: those of the mesh
    Array<FaceWeights> weights;
};

WeightedFaces weighted_faces(const Mesh& mesh, const StiffnessOptions& options, const std::vector<std::uint8_t>& held) {
    const Index n = static_cast<Index>(mesh.faces.size());
    WeightedFaces all;
    all.weights.resize(n);
    parallel_for(n, [&](Index f) { all.weights[f] = face_weights(mesh, mesh.faces[f], options.least_area); });
    if (!options.delaunay) return all;
    Array<std::array<double, 3>> cotangent(n);
    Array<std::uint8_t> usable(n);
    parallel_for(n, [&](Index f) {
        for (int k = 0; k < 3; ++k) cotangent[f][k] = 2 * all.weights[f].cotangent[(k + 2) % 3];
        usable[f] = all.weights[f].third >= 0;
    });
    IntrinsicMesh intrinsic = intrinsic_delaunay(mesh, cotangent, usable, held);
    if (intrinsic.changed.empty()) return all;
    parallel_for(n, [&](Index f) {
        if (intrinsic.changed[f]) all.weights[f] = face_weights(intrinsic.length[f], options.least_area);
    });
    all.turned = std::move(intrinsic.faces);
    return all;
}

/// The faces around each vertex that count, in order: 3 x face + corner.
struct Corners {
    Array<Index> offset, corner;
};

Corners corners_of(const Faces& faces, Index vertices, const Array<FaceWeights>& weights) {
    Corners c;
    c.offset.assign(static_cast<std::size_t>(vertices) + 1, 0);
    for (std::size_t f = 0; f < faces.size(); ++f)
        if (weights[f].third >= 0)
            for (const Index v : faces[f]) ++c.offset[v + 1];
    for (Index v = 0; v < vertices; ++v) c.offset[v + 1] += c.offset[v];
    c.corner.resize(c.offset.back());
    Array<Index> next(c.offset.begin(), c.offset.end() - 1);
    for (std::size_t f = 0; f < faces.size(); ++f)
        if (weights[f].third >= 0)
            for (int k = 0; k < 3; ++k) c.corner[next[faces[f][k]]++] = static_cast<Index>(3 * f + k);
    return c;
}

/// The entries of one row with the two edges of each of its faces, in order of the faces, equal columns joined.
class RowMaker {
public:
    struct Entry {
        Index column;
        double weight, mass;
    };

    RowMaker(const Faces& faces, const Array<FaceWeights>& weights, const Corners& corners)
        : faces_(faces), weights_(weights), corners_(corners) {}

    const std::vector<Entry>& row(Index v) {
        entries_.clear();
        for (Index k = corners_.offset[v]; k < corners_.offset[v + 1]; ++k) {
            const Index face = corners_.corner[k] / 3, at = corners_.corner[k] % 3;
            const Index next = (at + 1) % 3, last = (at + 2) % 3;
            const double mass = weights_[face].spread;
            entries_.push_back({faces_[face][next], weights_[face].cotangent[last], mass});
            entries_.push_back({faces_[face][last], weights_[face].cotangent[next], mass});
        }
        // Stable, so that both rows of an edge add up its faces in the same order.
        const auto less = [](const auto& a, const auto& b) { return a.column < b.column; };
        if (entries_.size() < 64) {
            insertion_sort();
        } else {
            std::stable_sort(entries_.begin(), entries_.end(), less);
        }
        std::size_t kept = 0;
        for (std::size_t k = 0; k < entries_.size(); ++k) {
            if (kept > 0 && entries_[kept - 1].column == entries_[k].column) {
                entries_[kept - 1].weight += entries_[k].weight;
                entries_[kept - 1].mass += entries_[k].mass;
            } else {
                entries_[kept++] = entries_[k];
            }
        }
        entries_.resize(kept);
        return entries_;
    }

private:
    void insertion_sort() {
        for (std::size_t k = 1; k < entries_.size(); ++k) {
            const Entry e = entries_[k];
            std::size_t at = k;
            for (; at > 0 && entries_[at - 1].column > e.column; --at) entries_[at] = entries_[at - 1];
            entries_[at] = e;
        }
    }

    const Faces& faces_;
    const Array<FaceWeights>& weights_;
    const Corners& corners_;
    std::vector<Entry> entries_;
};

}  // namespace

Stiffness stiffness(const Mesh& mesh, const StiffnessOptions& options, const std::vector<std::uint8_t>& held) {
    const Index n = static_cast<Index>(mesh.positions.size());
    const WeightedFaces all = weighted_faces(mesh, options, held);
    const Array<FaceWeights>& weights = all.weights;
    const Faces& faces = all.turned.empty() ? mesh.faces : all.turned;
    const Corners corners = corners_of(faces, n, weights);
    Stiffness c;
    c.mass.resize(n);
    c.offset.resize(static_cast<std::size_t>(n) + 1);
    // Rows are written with a stride of two entries a corner first, an upper bound, and moved together.
    Array<Index> column(2 * corners.corner.size());
    Array<double> weight(2 * corners.corner.size());
    Array<double> mass_weight(options.spread_mass ? weight.size() : 0);
    parallel_chunks(n, 4096, [&](Index begin, Index end) {
        RowMaker maker(faces, weights, corners);
        for (Index v = begin; v < end; ++v) {
            double mass = 0;
            for (Index k = corners.offset[v]; k < corners.offset[v + 1]; ++k)
                mass += weights[corners.corner[k] / 3].third;
            c.mass[v] = mass;
            std::size_t at = 2 * static_cast<std::size_t>(corners.offset[v]);
            for (const RowMaker::Entry& e : maker.row(v)) {
                if (options.spread_mass) mass_weight[at] = e.mass;
                column[at] = e.column, weight[at++] = e.weight;
            }
            c.offset[v + 1] = static_cast<Index>(at - 2 * static_cast<std::size_t>(corners.offset[v]));
        }
    });
    c.offset[0] = 0;
    for (Index v = 0; v < n; ++v) c.offset[v + 1] += c.offset[v];
    c.column.resize(c.offset[n]);
    c.weight.resize(c.offset[n]);
    c.mass_weight.resize(options.spread_mass ? c.offset[n] : 0);
    parallel_for(n, [&](Index v) {
        const std::size_t from = 2 * static_cast<std::size_t>(corners.offset[v]);
        const Index size = c.offset[v + 1] - c.offset[v];
        std::copy_n(column.begin() + static_cast<std::ptrdiff_t>(from), size, c.column.begin() + c.offset[v]);
        std::copy_n(weight.begin() + static_cast<std::ptrdiff_t>(from), size, c.weight.begin() + c.offset[v]);
        if (options.spread_mass)
            std::copy_n(mass_weight.begin() + static_cast<std::ptrdiff_t>(from), size,
                        c.mass_weight.begin() + c.offset[v]);
    });
    return c;
}

namespace {

/// @tparam W  channels if they are known while this is compiled, else 0: loops of a known length take half of the time
template <int W>
void apply_stiffness(const Stiffness& c, const double* f, int channels, double* out) {
    const int width = W > 0 ? W : channels;
    parallel_for(c.rows(), [&](Index i) {
        const double* const own = f + static_cast<std::size_t>(i) * width;
        double* const to = out + static_cast<std::size_t>(i) * width;
        std::fill_n(to, width, 0.0);
        for (Index k = c.offset[i]; k < c.offset[i + 1]; ++k) {
            const double* const other = f + static_cast<std::size_t>(c.column[k]) * width;
            for (int w = 0; w < width; ++w) to[w] += c.weight[k] * (own[w] - other[w]);
        }
    });
    std::vector<double> sum(width);
    const auto at = [&](auto* values, Index row) { return values + static_cast<std::size_t>(row) * width; };
    for (std::size_t h = 0; h < c.hub.size(); ++h) {
        const double* const centre = at(f, c.hub[h]);
        double* const to_centre = at(out, c.hub[h]);
        std::fill(sum.begin(), sum.end(), 0.0);
        for (Index k = c.hub_offset[h]; k < c.hub_offset[h + 1]; ++k)  // differences: constants give exactly 0
            for (int w = 0; w < width; ++w) sum[w] += c.hub_weight[k] * (at(f, c.hub_column[k])[w] - centre[w]);
        for (Index k = c.hub_offset[h]; k < c.hub_offset[h + 1]; ++k)
            for (int w = 0; w < width; ++w) {
                const double star = c.hub_star[k] * (at(f, c.hub_column[k])[w] - centre[w]);
                at(out, c.hub_column[k])[w] += c.hub_weight[k] * sum[w] - star;
                to_centre[w] += star;
            }
    }
}

}  // namespace

void apply_stiffness(const Stiffness& c, const double* f, int width, double* out) {
    return width == 3 ? apply_stiffness<3>(c, f, width, out) : apply_stiffness<0>(c, f, width, out);
}

Stiffness bending(const Stiffness& c) {
    const Index n = c.rows();
    double mean = 0;
    for (const double m : c.mass) mean += m / n;
    Array<double> diagonal(n), inverse(n), star(n);  // star: what |weights| of a hub are multiplied by, see hub_star
    parallel_for(n, [&](Index i) {
        const Index neighbours = c.offset[i + 1] - c.offset[i];
        diagonal[i] = 0;
        double sum = 0;
        for (Index k = c.offset[i]; k < c.offset[i + 1]; ++k) diagonal[i] += c.weight[k], sum += std::abs(c.weight[k]);
        inverse[i] = mean > 0 ? 1 / std::max(c.mass[i] / mean, 1e-6) : 1;
        star[i] = neighbours > most_bending_neighbours ? sum * inverse[i] / neighbours : 0;
    });
    constexpr Index grain = 4096;
    std::vector<std::vector<std::pair<Index, double>>> pieces((n + grain - 1) / grain);
    Stiffness square;
    square.mass = c.mass;
    square.offset.resize(static_cast<std::size_t>(n) + 1);
    // Calls visit(column, entry of C) for a row in order of columns, itself among them: then both entries of a pair of
    // rows are the same sums of the same products.
    const auto visit_row = [&](Index i, const auto& visit) {
        Index k = c.offset[i];
        for (; k < c.offset[i + 1] && c.column[k] < i; ++k) visit(c.column[k], -c.weight[k]);
        visit(i, diagonal[i]);
        for (; k < c.offset[i + 1]; ++k) visit(c.column[k], -c.weight[k]);
    };
    parallel_chunks(n, grain, [&](Index begin, Index end) {
        std::vector<std::pair<Index, double>>& piece = pieces[begin / grain];
        std::vector<std::pair<Index, double>> row;
        for (Index i = begin; i < end; ++i) {
            row.clear();
            visit_row(i, [&](Index k, double a) {
                if (star[k] == 0)
                    return visit_row(k, [&](Index j, double b) { row.emplace_back(j, a * b * inverse[k]); });
                if (k != i) row.emplace_back(k, -std::abs(a) * star[k]);
                if (k == i) visit_row(i, [&](Index j, double b) { row.emplace_back(j, -std::abs(b) * star[i]); });
            });
            std::stable_sort(row.begin(), row.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
            const std::size_t from = piece.size();
            for (const auto& [j, value] : row) {
                if (j == i) continue;
                if (piece.size() > from && piece.back().first == j) {
                    piece.back().second -= value;
                } else {
                    piece.emplace_back(j, -value);
                }
            }
            square.offset[i + 1] = static_cast<Index>(piece.size() - from);
        }
    });
    square.offset[0] = 0;
    for (Index i = 0; i < n; ++i) square.offset[i + 1] += square.offset[i];
    square.column.resize(square.offset[n]);
    square.weight.resize(square.offset[n]);
    parallel_for(
        static_cast<Index>(pieces.size()),
        [&](Index p) {
            Index at = square.offset[p * grain];
            for (const auto& [j, w] : pieces[p]) square.column[at] = j, square.weight[at++] = w;
        },
        1);
    for (Index i = 0; i < n; ++i) {
        if (star[i] == 0) continue;
        square.hub.push_back(i);
        visit_row(i, [&](Index j, double a) {
            square.hub_column.push_back(j);
            square.hub_weight.push_back(std::sqrt(inverse[i]) * a);
            square.hub_star.push_back(j == i ? 0 : std::abs(a) * star[i]);
        });
        square.hub_offset.push_back(static_cast<Index>(square.hub_column.size()));
    }
    return square;
}

void apply_mass(const Stiffness& c, const double* f, int width, double* out) {
    parallel_for(c.rows(), [&](Index i) {
        const double* const own = f + static_cast<std::size_t>(i) * width;
        double* const to = out + static_cast<std::size_t>(i) * width;
        for (int w = 0; w < width; ++w) to[w] = c.mass[i] * own[w];
        for (Index k = c.offset[i]; k < c.offset[i + 1] && !c.mass_weight.empty(); ++k) {
            const double* const other = f + static_cast<std::size_t>(c.column[k]) * width;
            for (int w = 0; w < width; ++w) to[w] -= c.mass_weight[k] * (own[w] - other[w]);
        }
    });
}

Components components(const Stiffness& c) {
    Components found;
    found.of.assign(c.rows(), -1);
    Array<Index> queue(c.rows());
    for (Index first = 0; first < c.rows(); ++first) {
        if (found.of[first] >= 0) continue;
        std::size_t end = 0;
        queue[end++] = first;
        found.of[first] = found.count;
        for (std::size_t at = 0; at < end; ++at)
            for (Index k = c.offset[queue[at]]; k < c.offset[queue[at] + 1]; ++k) {
                Index& other = found.of[c.column[k]];
                if (other < 0) other = found.count, queue[end++] = c.column[k];
            }
        ++found.count;
    }
    return found;
}

}  // namespace multires
