#pragma once

#include "operators/relaxation.h"
#include "schemes/field.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace multires {

/// How weights and details are kept: as double, or as float in half the memory. Float weights are no less exact ways
/// to predict, so inversion stays exact to rounding; float details invert to 6e-8 of their length.
enum class Storage { wide, single };

/// What a lifting scheme does to the vertices that stay before it predicts those that go.
enum class Update {
    mean,  ///< they take over what goes, so that means stay: coarse levels are means
    none,  ///< nothing: coarse levels are subsets of the values
};

/// Details of one kind of vertices of one level: those that go, those that stay, ... Filters treat all subbands alike;
/// what a scheme puts into which is its own business. Within a level they come in the same order on all levels.
struct Subband {
    /// Row r belongs to row range.begin + r of these rings of the hierarchy (or of the scheme), which outlive the
    /// subband: the ring is that of the mesh the details are seen against.
    const Rings* rings = nullptr;
    RowRange range;
    Field values;         ///< #rows by width; no rows where `single` holds the values: see widen()
    Array<float> single;  ///< Storage::single: #rows by width, instead of `values`
    /// #rows, 1 where channels 0..2 are in a local frame whose third axis is the surface's normal; empty: nowhere.
    std::vector<std::uint8_t> local;

    Index rows() const { return range.size(); }
    Index place(Index row) const { return rings->vertex(range.begin + row); }
};

/// Storage::single: moves the values to `single`, and back to `values` (which does nothing where they are there).
void narrow(Subband& subband);
void widen(Subband& subband);

/// A field as a scheme stores it: the coarsest values, and the details lost from level to level.
struct Coefficients {
    Field base;                               ///< at places 0..size.back()-1
    std::vector<std::vector<Subband>> level;  ///< level[k] leads from size[k+1] to size[k] vertices; 0 is the finest
};

/// Memory coefficients hold, in bytes.
std::size_t bytes(const Coefficients& coefficients);

/// What of a synthesis is not as usual: by default it leads from the base to the input's level and changes no detail.
struct Synthesis {
    std::size_t from = 0, to = 0;   ///< levels; 0 is the input's. `from` is that of `values`
    const Field* values = nullptr;  ///< size[from] rows in order of places, to start from instead of the base
    std::vector<double> gain;       ///< #levels, factors of the details, finest first; empty: all 1
};
inline Synthesis with_gain(std::vector<double> gain) { return {0, 0, nullptr, std::move(gain)}; }
inline Synthesis down_to(std::size_t level) { return {0, level, nullptr, {}}; }
inline Synthesis starting_at(std::size_t level, const Field& values) { return {level, 0, &values, {}}; }

/// What a scheme can do.
struct Capabilities {
    bool local_frames = false;        ///< details of positions turn with the coarser surface; without, it is linear
    bool critically_sampled = false;  ///< as many coefficients as values, no details of vertices that stay
    bool linear_precision = true;     ///< linear functions on planes have no details inside if the operator says so
    bool starts_anywhere = true;      ///< takes Synthesis::from and values
    bool even_rings = true;           ///< reads Hierarchy::even: the hierarchy must hold it
};

/// Options of all schemes; each uses those that apply to it.
struct SchemeOptions {
    int row = 1;                                 ///< of schemes() in schemes/table.h: which one
    Operator op = Operator::cotangent_delaunay;  ///< predicts vertices from their rings
    /// Presmoothing before subsampling (Burt and Adelson): even values move by this share of the way to their relaxed
    /// place, in [0, 1]. 0: none, as in both papers; 1 keeps fine bands from aliasing into coarse ones.
    double presmooth = 0;
    Storage storage = Storage::wide;  ///< of weights
    Update update = Update::mean;     ///< of schemes that have one
};

/// Splits any channels into a coarse part and details over a hierarchy, and puts them together again.
///
/// Schemes differ in how they predict; all are exact: synthesise(analyse(f)) gives f back up to rounding. A scheme
/// refers to its hierarchy, which must outlive it, and needs the hierarchy's positions only while it is made. The
/// result does not depend on the number of threads.
class Scheme {
public:
    explicit Scheme(const Hierarchy& hierarchy) : h_(hierarchy) {}
    virtual ~Scheme() = default;
    Scheme(const Scheme&) = delete;
    Scheme& operator=(const Scheme&) = delete;

    /// @param f  #V rows in order of places; see Field::has_positions
    /// @param storage  of the details
    virtual Coefficients analyse(Field f, Storage storage) const = 0;
    Coefficients analyse(Field f) const { return analyse(std::move(f), Storage::wide); }

    /// @param coefficients  of this scheme and hierarchy, or none at all: all details are zero then, and what comes out
    ///                      is the scheme's subdivision of the values to start from
    /// @returns  size[to] rows in order of places
    virtual Field synthesise(const Coefficients& coefficients, const Synthesis& how) const = 0;
    Field synthesise(const Coefficients& coefficients) const { return synthesise(coefficients, Synthesis()); }

    using Take = std::function<void(Index place, const double* values)>;
    /// Hands over the rows of synthesise(coefficients) one by one, in any order, some at once. Schemes that can do so
    /// never hold all of them, but only what they are predicted from.
    virtual void hand_over(const Coefficients& coefficients, const Take& take) const;

    /// The surface's normal at a row of a subband of positions, in the axes that the row is stored in: (0, 0, 1) in a
    /// local frame, otherwise that of the ring, in the world's axes. Zero if the ring has no area: no part of a detail
    /// is along the normal then.
    /// @param positions  #V by 3 in order of the input: those the hierarchy was built from
    virtual Vec3 normal(const Subband& subband, Index row, const Positions& positions) const;

    /// Memory it holds, in bytes, not counting the hierarchy.
    virtual std::size_t bytes() const = 0;

protected:
    const Hierarchy& hierarchy() const { return h_; }

private:
    const Hierarchy& h_;
};

}  // namespace multires
