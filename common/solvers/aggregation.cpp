#include "solvers/aggregation.h"

#include "base/parallel.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace multires {
namespace {

/// An entry is strong if |c_ij| > this x sqrt(c_ii c_jj).
constexpr float strong_share = 0.1F;

bool is_strong(const Multigrid::Level& level, Index i, Index k) {
    const float c = level.stiffness[k];
    return c * c >
           strong_share * strong_share * level.stiffness_diagonal[i] * level.stiffness_diagonal[level.column[k]];
}

/// A few (column, value) pairs with equal columns joined: a row of a product.
class SparseRow {
public:
    explicit SparseRow(Index columns) : at_(columns, -1) {}

    void add(Index column, double c, double m) {
        Index& at = at_[column];
        if (at < 0) {
            at = static_cast<Index>(column_.size());
            column_.push_back(column);
            c_.push_back(c);
            m_.push_back(m);
        } else {
            c_[at] += c;
            m_[at] += m;
        }
    }
    Index size() const { return static_cast<Index>(column_.size()); }
    Index column(Index k) const { return column_[k]; }
    double c(Index k) const { return c_[k]; }
    double m(Index k) const { return m_[k]; }
    void clear() {
        for (const Index c : column_) at_[c] = -1;
        column_.clear(), c_.clear(), m_.clear();
    }

private:
    Array<Index> at_;
    std::vector<Index> column_;
    std::vector<double> c_, m_;
};

/// Joins rows made chunk by chunk into one table.
struct Piece {
    Index begin = 0;
    std::vector<Index> size, column;
    std::vector<float> c, m;
};

Array<Index> offsets_of(const std::vector<Piece>& pieces, Index rows) {
    Array<Index> offset(static_cast<std::size_t>(rows) + 1);
    offset[0] = 0;
    for (const Piece& piece : pieces)
        for (std::size_t i = 0; i < piece.size.size(); ++i)
            offset[piece.begin + i + 1] = offset[piece.begin + i] + piece.size[i];
    return offset;
}

void transpose(Multigrid::Level& level, Index coarse) {
    level.r_offset.assign(static_cast<std::size_t>(coarse) + 1, 0);
    for (const Index c : level.p_column) ++level.r_offset[c + 1];
    for (Index c = 0; c < coarse; ++c) level.r_offset[c + 1] += level.r_offset[c];
    level.r_column.resize(level.p_column.size());
    level.r.resize(level.p.size());
    Array<Index> next(level.r_offset.begin(), level.r_offset.end() - 1);
    for (Index i = 0; i < level.rows; ++i)
        for (Index k = level.p_offset[i]; k < level.p_offset[i + 1]; ++k) {
            const Index to = next[level.p_column[k]]++;
            level.r_column[to] = i;
            level.r[to] = level.p[k];
        }
}

}  // namespace

Groups group_rows(const Multigrid::Level& level) {
    Groups groups;
    groups.of.assign(level.rows, -1);
    const auto takes_part = [&](Index i) { return level.stiffness_diagonal[i] > 0 || level.mass_diagonal[i] > 0; };
    for (Index i = 0; i < level.rows; ++i) {
        if (groups.of[i] >= 0 || !takes_part(i)) continue;
        bool free = true;
        for (Index k = level.offset[i]; k < level.offset[i + 1] && free; ++k)
            free = !is_strong(level, i, k) || groups.of[level.column[k]] < 0;
        if (!free) continue;
        groups.of[i] = groups.count;
        for (Index k = level.offset[i]; k < level.offset[i + 1]; ++k)
            if (is_strong(level, i, k)) groups.of[level.column[k]] = groups.count;
        ++groups.count;
    }
    Array<Index> joined(groups.of);
    for (Index i = 0; i < level.rows; ++i) {
        if (groups.of[i] >= 0 || !takes_part(i)) continue;
        float strongest = 0;
        for (Index k = level.offset[i]; k < level.offset[i + 1]; ++k)
            if (groups.of[level.column[k]] >= 0 && is_strong(level, i, k) && std::abs(level.stiffness[k]) > strongest)
                strongest = std::abs(level.stiffness[k]), joined[i] = groups.of[level.column[k]];
        if (joined[i] < 0) joined[i] = groups.count++;
    }
    groups.of.swap(joined);
    return groups;
}

void make_prolongation(Multigrid::Level& level, const Groups& groups) {
    const double omega = 4.0 / 3 / level.largest_stiffness;
    constexpr Index grain = 8192;
    std::vector<Piece> pieces((level.rows + grain - 1) / grain);
    parallel_chunks(level.rows, grain, [&](Index begin, Index end) {
        Piece& piece = pieces[begin / grain];
        piece.begin = begin;
        for (Index i = begin; i < end; ++i) {
            const std::size_t from = piece.column.size();
            if (groups.of[i] >= 0) {
                const auto add = [&](Index column, double value) {
                    for (std::size_t k = from; k < piece.column.size(); ++k)
                        if (piece.column[k] == column) {
                            piece.c[k] += static_cast<float>(value);
                            return;
                        }
                    piece.column.push_back(column);
                    piece.c.push_back(static_cast<float>(value));
                };
                const double step = level.stiffness_jacobi[i] > 0 ? omega / level.stiffness_jacobi[i] : 0;
                double diagonal = level.stiffness_diagonal[i];
                for (Index k = level.offset[i]; k < level.offset[i + 1]; ++k)
                    if (!is_strong(level, i, k)) diagonal += level.stiffness[k];
                add(groups.of[i], 1 - step * diagonal);
                for (Index k = level.offset[i]; k < level.offset[i + 1]; ++k)
                    if (is_strong(level, i, k) && groups.of[level.column[k]] >= 0)
                        add(groups.of[level.column[k]], -step * level.stiffness[k]);
            }
            piece.size.push_back(static_cast<Index>(piece.column.size() - from));
        }
    });
    level.p_offset = offsets_of(pieces, level.rows);
    level.p_column.resize(level.p_offset.back());
    level.p.resize(level.p_offset.back());
    for (const Piece& piece : pieces) {
        std::copy(piece.column.begin(), piece.column.end(), level.p_column.begin() + level.p_offset[piece.begin]);
        std::copy(piece.c.begin(), piece.c.end(), level.p.begin() + level.p_offset[piece.begin]);
    }
    transpose(level, groups.count);
}

Multigrid::Level coarse_level(const Multigrid::Level& fine, Index rows) {
    Multigrid::Level coarse;
    coarse.rows = rows;
    coarse.stiffness_diagonal.resize(rows);
    coarse.mass_diagonal.resize(rows);
    const Index grain = std::max<Index>(512, rows / 16 + 1);
    std::vector<Piece> pieces((rows + grain - 1) / grain);
    parallel_chunks(rows, grain, [&](Index begin, Index end) {
        Piece& piece = pieces[begin / grain];
        piece.begin = begin;
        SparseRow row(rows);
        const bool diagonal_mass = fine.mass.empty();
        for (Index a = begin; a < end; ++a) {
            row.clear();
            const auto add_row = [&](Index j, double c, double m) {  // row j of P
                for (Index l = fine.p_offset[j]; l < fine.p_offset[j + 1]; ++l)
                    row.add(fine.p_column[l], c * fine.p[l], m * fine.p[l]);
            };
            for (Index k = fine.r_offset[a]; k < fine.r_offset[a + 1]; ++k) {
                const Index i = fine.r_column[k];
                const double p = fine.r[k];
                add_row(i, p * fine.stiffness_diagonal[i], p * fine.mass_diagonal[i]);
                for (Index l = fine.offset[i]; l < fine.offset[i + 1]; ++l)
                    add_row(fine.column[l], p * fine.stiffness[l], diagonal_mass ? 0 : p * fine.mass[l]);
            }
            Index size = 0;
            coarse.stiffness_diagonal[a] = coarse.mass_diagonal[a] = 0;
            for (Index k = 0; k < row.size(); ++k) {
                if (row.column(k) == a) {
                    coarse.stiffness_diagonal[a] = static_cast<float>(row.c(k));
                    coarse.mass_diagonal[a] = static_cast<float>(row.m(k));
                    continue;
                }
                piece.column.push_back(row.column(k));
                piece.c.push_back(static_cast<float>(row.c(k)));
                piece.m.push_back(static_cast<float>(row.m(k)));
                ++size;
            }
            piece.size.push_back(size);
        }
    });
    coarse.offset = offsets_of(pieces, rows);
    coarse.column.resize(coarse.offset.back());
    coarse.stiffness.resize(coarse.offset.back());
    coarse.mass.resize(coarse.offset.back());
    for (const Piece& piece : pieces) {
        const auto at = coarse.offset[piece.begin];
        std::copy(piece.column.begin(), piece.column.end(), coarse.column.begin() + at);
        std::copy(piece.c.begin(), piece.c.end(), coarse.stiffness.begin() + at);
        std::copy(piece.m.begin(), piece.m.end(), coarse.mass.begin() + at);
    }
    return coarse;
}

}  // namespace multires
