#include "grids/extension.h"

#include "base/parallel.h"
#include "grids/lattice.h"

#include <algorithm>
#include <array>

namespace multires {
namespace {

enum : std::uint8_t { unknown, queued, known };

// Four points: a slope of neighbours would carry their noise far out. Of baselines 1 to 8 and damping 0 to 0.97, this
// gave low passes of noise and of waves about the same error at rims as inside.
constexpr int baseline = 4;
constexpr double damping_of_ring = 0.9;

/// The frame that is being filled, with a border that is never filled.
struct Frame {
    Raster values;
    Mask state;
    std::array<std::ptrdiff_t, 6> step;  // to the neighbours, as places

    double at(std::size_t place, double damping) const {
        double slopes = 0, means = 0;
        int two = 0, one = 0;
        for (const std::ptrdiff_t s : step) {
            const std::size_t a = place + s;
            if (state.values[a] != known) continue;
            const double near = values.values[a];
            means += near, ++one;
            int length = 0;
            for (std::size_t b = a + s; length < baseline && state.values[b] == known; b += s) ++length;
            if (length > 0) slopes += near + damping / length * (near - values.values[a + length * s]), ++two;
        }
        return two > 0 ? slopes / two : means / one;
    }
};

Frame framed(const Raster& samples, const Mask& mask, Index around) {
    Frame frame;
    frame.values = Raster(samples.rows + 2 * around, samples.columns + 2 * around, 0);
    frame.state = Mask(frame.values.rows, frame.values.columns, unknown);
    for (std::size_t k = 0; k < frame.step.size(); ++k)
        frame.step[k] = std::ptrdiff_t{lattice_steps[k][0]} * frame.values.columns + lattice_steps[k][1];
    parallel_for(
        samples.rows,
        [&](Index i) {
            std::copy_n(samples.row(i), samples.columns, frame.values.row(i + around) + around);
            for (Index j = 0; j < samples.columns; ++j)
                frame.state.row(i + around)[j + around] = mask.row(i)[j] ? known : unknown;
        },
        64);
    return frame;
}

}  // namespace

Raster extended(const Raster& samples, const Mask& mask, Index margin) {
    constexpr Index border = baseline + 1;
    Frame frame = framed(samples, mask, margin + border);
    const Index rows = frame.values.rows, columns = frame.values.columns;
    const auto inside = [&](std::size_t place) {
        const auto i = static_cast<Index>(place / columns), j = static_cast<Index>(place % columns);
        return i >= border && i < rows - border && j >= border && j < columns - border;
    };
    Array<std::size_t> ring, next;
    const auto reach_from = [&](std::size_t place) {
        for (const std::ptrdiff_t s : frame.step)
            if (frame.state.values[place + s] == unknown && inside(place + s))
                frame.state.values[place + s] = queued, next.push_back(place + s);
    };
    for (Index i = border; i < rows - border; ++i)
        for (Index j = border; j < columns - border; ++j)
            if (frame.state.row(i)[j] == known) reach_from(static_cast<std::size_t>(i) * columns + j);
    for (double damping = damping_of_ring; !next.empty(); damping *= damping_of_ring) {
        ring.swap(next);
        next.clear();
        parallel_for(
            static_cast<Index>(ring.size()),
            [&](Index k) { frame.values.values[ring[k]] = frame.at(ring[k], damping); }, 512);
        for (const std::size_t place : ring) frame.state.values[place] = known;
        for (const std::size_t place : ring) reach_from(place);
    }
    Raster out;
    out.rows = rows - 2 * border, out.columns = columns - 2 * border;
    out.values.resize(static_cast<std::size_t>(out.rows) * out.columns);
    for (Index i = 0; i < out.rows; ++i) std::copy_n(frame.values.row(i + border) + border, out.columns, out.row(i));
    return out;
}

}  // namespace multires
