#pragma once

#include "base/parallel.h"
#include "hierarchy/hierarchy.h"

#include <atomic>
#include <utility>

namespace multires {

/// #V: the least vertex of each one's part, all that edges join it with. All threads join at once (Anderson and Woll
/// 1991, "Wait-free parallel algorithms for the union-find problem").
/// Cost: about linear, in parallel
inline Array<Index> parts_of(const Rings& rings) {
    const Index n = rings.rows();
    Array<std::atomic<Index>> up(n);  // towards the least vertex, which leads to itself; never away from it again
    parallel_for(n, [&](Index v) { up[v].store(v, std::memory_order_relaxed); });
    const auto least = [&](Index v) {
        for (;;) {
            const Index u = up[v].load(std::memory_order_relaxed), beyond = up[u].load(std::memory_order_relaxed);
            if (u == beyond) return u;
            up[v].store(beyond, std::memory_order_relaxed);  // halves the way for those who come later
            v = beyond;
        }
    };
    const auto join = [&](Index a, Index b) {
        for (;;) {
            a = least(a), b = least(b);
            if (a == b) return;
            if (a < b) std::swap(a, b);
            Index still = a;
            if (up[a].compare_exchange_strong(still, b, std::memory_order_relaxed)) return;
        }
    };
    parallel_for(n, [&](Index v) {
        for (Index e = rings.offset[v]; e < rings.offset[v + 1]; ++e)
            if (rings.neighbor[e] > v || rings.size(rings.neighbor[e]) == 0)  // irregular: no row of its own
                join(v, rings.neighbor[e]);
    });
    Array<Index> part(n);
    parallel_for(n, [&](Index v) { part[v] = least(v); });
    return part;
}

}  // namespace multires
