#pragma once

#include "base/parallel.h"
#include "base/progress.h"

#include <algorithm>

namespace multires {

/// parallel_chunks() for loops that take long: reports after every few chunks, which may throw to stop.
template <class Body>
void parallel_blocks(Index count, const Progress& progress, const char* what, const Body& body) {
    constexpr Index grain = 1024, block = 16 * grain;
    for (Index first = 0; first < count; first += block) {
        progress.report(static_cast<double>(first) / count, what);
        parallel_chunks(std::min(block, count - first), grain,
                        [&](Index begin, Index end) { body(first + begin, first + end); });
    }
}

}  // namespace multires
