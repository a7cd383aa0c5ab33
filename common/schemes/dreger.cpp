#include "base/parallel.h"
#include "grids/affine.h"
#include "grids/grid_pyramid.h"
#include "schemes/lattice_hierarchy.h"
#include "schemes/table.h"

#include <algorithm>
#include <cassert>
#include <utility>

// Quartic box-spline wavelets on triangular grids (Dreger, Gross and Schlegel) as a scheme. Its hierarchy is that of
// the lattice, and what the transform has beyond one number a vertex fits into what schemes may store:
//
//     base       values of vertices in no grid; for each grid an affine function and the coefficients of the scaling
//                functions of its last level: more rows than there are places
//     level k    seven subbands, one for each type of wavelets; a row is a coefficient, and its place a vertex near it
//
// A level's values, synthesise(.., down_to(k)), are those of the surface without finer details at the vertices left,
// and not its control points, which swing about it. So they do not hold all of it, and no synthesis starts from them.

namespace multires {
namespace {

constexpr int types = subbands - 1;
constexpr SplineBasis basis = SplineBasis::quartic;

/// The grids whose points are places.
std::vector<Grid> grids_of(const Array<LatticePlace>& lattice) {
    std::vector<Grid> grids;
    for (const LatticePlace& p : lattice) {
        if (p.grid < 0) continue;
        grids.resize(std::max(grids.size(), static_cast<std::size_t>(p.grid) + 1));
        Grid& grid = grids[p.grid];
        grid.rows = std::max(grid.rows, p.i + 1), grid.columns = std::max(grid.columns, p.j + 1);
        ++grid.vertices;
    }
    for (Grid& grid : grids) grid.vertex.assign(static_cast<std::size_t>(grid.rows) * grid.columns, -1);
    for (std::size_t place = 0; place < lattice.size(); ++place)
        if (const LatticePlace& p = lattice[place]; p.grid >= 0) {
            Grid& grid = grids[p.grid];
            grid.vertex[static_cast<std::size_t>(p.i) * grid.columns + p.j] = static_cast<Index>(place);
        }
    return grids;
}

Array<Index> points_of(const Mask& mask) {
    Array<Index> points;
    for (std::size_t p = 0; p < mask.values.size(); ++p)
        if (mask.values[p]) points.push_back(static_cast<Index>(p));
    return points;
}

/// One grid, its vertices being places.
struct Part {
    Grid grid;
    GridPyramid pyramid;
    AffineFit fit;
    std::vector<Array<Index>> points;  ///< of each level m + 1: where the coefficients of level m lie in its raster

    Part(Grid g, int levels) : grid(std::move(g)), pyramid(grid, basis, levels), fit(pyramid.mask(0)) {
        for (int m = 0; m < pyramid.levels(); ++m) points.push_back(points_of(pyramid.mask(m + 1)));
    }

    Index rows(std::size_t level) const { return level < points.size() ? static_cast<Index>(points[level].size()) : 0; }
    Index base_rows() const { return 3 + static_cast<Index>(points.back().size()); }

    /// Visits the vertices: visit(raster place, i, j, place).
    template <class Visit>
    void each(const Visit& visit) const {
        parallel_for(
            grid.rows,
            [&](Index i) {
                for (Index j = 0; j < grid.columns; ++j) {
                    const std::size_t p = static_cast<std::size_t>(i) * grid.columns + j;
                    if (grid.vertex[p] >= 0) visit(p, i, j, grid.vertex[p]);
                }
            },
            64);
    }
};

/// The neighbours of a vertex, `step` points away, as many as follow one another around it.
std::vector<Index> ring_of(const Grid& grid, const LatticePlace& at, Index step) {
    std::vector<Index> longest;
    for (std::size_t first = 0; first < 6; ++first) {
        std::vector<Index> run;
        for (std::size_t k = first; k < first + 6; ++k) {
            const Index i = at.i + step * lattice_steps[k % 6][0], j = at.j + step * lattice_steps[k % 6][1];
            if (!grid.holds(i, j)) break;
            run.push_back(grid.vertex[static_cast<std::size_t>(i) * grid.columns + j]);
        }
        if (run.size() > longest.size()) longest = std::move(run);
    }
    return longest;
}

/// Of neighbours `step` points away, or nearer where there are not even two.
void add_ring(const Grid& grid, const LatticePlace& at, Index step, Rings& rings) {
    std::vector<Index> ring = ring_of(grid, at, step);
    while (ring.size() < 2 && step > 1) ring = ring_of(grid, at, step /= 2);
    if (ring.size() < 2) ring.clear();
    rings.kind.push_back(ring.empty() ? RingKind::isolated : ring.size() == 6 ? RingKind::closed : RingKind::open);
    rings.neighbor.insert(rings.neighbor.end(), ring.begin(), ring.end());
    rings.offset.push_back(static_cast<Index>(rings.neighbor.size()));
}

class Dreger final : public Scheme {
public:
    explicit Dreger(const Hierarchy& h) : Scheme(h) {
        for (Index place = 0; place < h.vertices(); ++place)
            if (h.lattice[place].grid < 0 || h.levels.empty()) kept_.push_back(place);
        const int levels = static_cast<int>(h.levels.size());
        if (levels > 0)
            for (Grid& grid : grids_of(h.lattice)) parts_.emplace_back(std::move(grid), levels);
        for (int k = 0; k < levels; ++k) rings_.push_back(rings_of(k));
    }

    Coefficients analyse(Field f, Storage storage) const override {
        Coefficients out;
        out.base = Field::unset(base_rows(), f.width);
        out.base.has_positions = f.has_positions;
        for (const Rings& rings : rings_) {
            out.level.emplace_back(types);
            for (Subband& band : out.level.back()) {
                band.rings = &rings;
                band.range = {0, rings.rows()};
                band.values = Field::unset(rings.rows(), f.width);
                band.values.has_positions = f.has_positions;
            }
        }
        for (std::size_t r = 0; r < kept_.size(); ++r)
            std::copy_n(f.row(kept_[r]), f.width, out.base.row(static_cast<Index>(r)));
        Cursor at(*this);
        for (const Part& part : parts_) {
            for (int c = 0; c < f.width; ++c) analyse_channel(part, f, c, at, out);
            at.pass(part);
        }
        if (storage == Storage::single)
            for (std::vector<Subband>& level : out.level)
                for (Subband& band : level) narrow(band);
        return out;
    }

    Field synthesise(const Coefficients& coefficients, const Synthesis& how) const override {
        assert(!how.values && "starts_anywhere is false");
        const int width = coefficients.base.width;
        Field f = Field::unset(hierarchy().vertices(), width);
        f.has_positions = coefficients.base.has_positions;
        for (std::size_t r = 0; r < kept_.size(); ++r)
            std::copy_n(coefficients.base.row(static_cast<Index>(r)), width, f.row(kept_[r]));
        Cursor at(*this);
        for (const Part& part : parts_) {
            for (int c = 0; c < width; ++c) synthesise_channel(part, coefficients, how, c, at, f);
            at.pass(part);
        }
        f.values.resize(static_cast<std::size_t>(hierarchy().size[how.to]) * width);
        return f;
    }

    std::size_t bytes() const override {
        const auto of = [](const auto& values) { return values.capacity() * sizeof(values[0]); };
        std::size_t sum = of(kept_);
        for (const Rings& r : rings_) sum += of(r.offset) + of(r.neighbor) + of(r.kind) + of(r.vertices);
        for (const Part& part : parts_) {
            sum += of(part.grid.vertex);
            for (int m = 0; m <= part.pyramid.levels(); ++m)
                sum += of(part.pyramid.mask(m).values) + of(part.pyramid.source(m));
            for (const Array<Index>& points : part.points) sum += of(points);
        }
        return sum;
    }

private:
    /// Rows where the coefficients of a part begin.
    struct Cursor {
        Index base;
        std::vector<Index> level;

        explicit Cursor(const Dreger& d) : base(static_cast<Index>(d.kept_.size())), level(d.rings_.size(), 0) {}
        void pass(const Part& part) {
            base += part.base_rows();
            for (std::size_t k = 0; k < level.size(); ++k) level[k] += part.rows(k);
        }
    };

    Index base_rows() const {
        Index rows = static_cast<Index>(kept_.size());
        for (const Part& part : parts_) rows += part.base_rows();
        return rows;
    }

    /// Of the coefficients of a level, for the normals there: neighbours are as far away as the points of the level.
    Rings rings_of(int level) const {
        Rings rings;
        for (const Part& part : parts_) {
            if (level >= part.pyramid.levels()) continue;
            for (const Index p : part.points[level]) {
                const Index place = part.pyramid.source(level + 1)[p];
                rings.vertices.push_back(place);
                add_ring(part.grid, hierarchy().lattice[place], Index{1} << level, rings);
            }
        }
        return rings;
    }

    static void analyse_channel(const Part& part, const Field& f, int c, const Cursor& at, Coefficients& out) {
        const GridPyramid& pyramid = part.pyramid;
        Raster samples(part.grid.rows, part.grid.columns, 0);
        part.each([&](std::size_t p, Index, Index, Index place) { samples.values[p] = f.row(place)[c]; });
        const Affine affine = part.fit.of(pyramid.mask(0), samples);
        part.each([&](std::size_t p, Index i, Index j, Index) { samples.values[p] -= part.fit.at(affine, i, j); });
        const Array<double> x = pyramid.analyse(samples);
        out.base.row(at.base)[c] = affine.middle;
        out.base.row(at.base + 1)[c] = affine.along_i;
        out.base.row(at.base + 2)[c] = affine.along_j;
        const auto store = [&](int level, int type, Field& to, Index first) {
            const double* const from = x.data() + pyramid.offset(level, type);
            const Array<Index>& points = part.points[level];
            parallel_for(static_cast<Index>(points.size()), [&](Index r) { to.row(first + r)[c] = from[points[r]]; });
        };
        for (int m = 0; m < pyramid.levels(); ++m)
            for (int type = 1; type <= types; ++type) store(m, type, out.level[m][type - 1].values, at.level[m]);
        store(pyramid.levels() - 1, 0, out.base, at.base + 3);
    }

    static void synthesise_channel(const Part& part, const Coefficients& coefficients, const Synthesis& how, int c,
                                   const Cursor& at, Field& f) {
        const GridPyramid& pyramid = part.pyramid;
        Array<double> x(pyramid.size(), 0);
        const auto load = [&](int level, int type, double gain, const auto& from, Index first) {
            double* const to = x.data() + pyramid.offset(level, type);
            const Array<Index>& points = part.points[level];
            parallel_for(static_cast<Index>(points.size()), [&](Index r) {
                to[points[r]] = gain * from[static_cast<std::size_t>(first + r) * f.width + c];
            });
        };
        for (int m = static_cast<int>(how.to); m < pyramid.levels(); ++m)
            for (int type = 1; type <= types; ++type) {
                const Subband& band = coefficients.level[m][type - 1];
                const double gain = how.gain.empty() ? 1 : how.gain[m];
                if (band.single.empty())
                    load(m, type, gain, band.values.values, at.level[m]);
                else
                    load(m, type, gain, band.single, at.level[m]);
            }
        load(pyramid.levels() - 1, 0, 1, coefficients.base.values, at.base + 3);
        const Raster samples = pyramid.synthesise(x);
        const Affine affine{coefficients.base.row(at.base)[c], coefficients.base.row(at.base + 1)[c],
                            coefficients.base.row(at.base + 2)[c]};
        part.each([&](std::size_t p, Index i, Index j, Index place) {
            f.row(place)[c] = part.fit.at(affine, i, j) + samples.values[p];
        });
    }

    std::vector<Part> parts_;
    std::vector<Rings> rings_;  ///< of each level's subbands
    Array<Index> kept_;         ///< places whose values are base rows as they are
};

}  // namespace

SchemeRow dreger_scheme() {
    Capabilities can;
    can.starts_anywhere = false;
    can.even_rings = false;
    return {
        "Dreger",
        "box-spline wavelets, for triangular grids only (terrains, range maps); levels are octaves of the grid, and "
        "operator, presmoothing and how vertices are removed do not apply",
        "<i>Dreger, Gross, Schlegel</i>, <b>\"Construction of Multiresolution Triangular B-Spline Surfaces using "
        "Hexagonal Filters\"</b>, ETH Z&uuml;rich 1999",
        can,
        [](const Hierarchy& hierarchy, const SchemeOptions&) -> std::unique_ptr<Scheme> {
            return std::make_unique<Dreger>(hierarchy);
        },
        lattice_hierarchy};
}

}  // namespace multires
