#pragma once

#include "base/index.h"

#include <type_traits>

/// Loops on all cores. The work is cut into fixed chunks, so results do not depend on the number of threads. The caller
/// never waits for a helper that has not started, so a busy machine costs no more than it must (a fork-join runtime
/// waits for its whole team at the end of every loop).
namespace multires {

/// Threads a loop uses: as many as the machine runs at once, or the environment variable MULTIRES_THREADS, or the
/// last set_thread_count() (0: back to the default).
int thread_count();
void set_thread_count(int count);

namespace parallel_detail {
using Chunk = void (*)(const void* body, Index begin, Index end);
void run(Index count, Index grain, const void* body, Chunk chunk);
}  // namespace parallel_detail

/// Calls body(begin, end) for the chunks [0, grain), [grain, 2 grain), ... of [0, count), in any order, some at once.
/// The first exception a chunk throws is thrown on when the others have ended. Loops inside loops run on one thread.
template <class Body>
void parallel_chunks(Index count, Index grain, const Body& body) {
    parallel_detail::run(count, grain, &body,
                         [](const void* b, Index begin, Index end) { (*static_cast<const Body*>(b))(begin, end); });
}

/// Calls body(i) for all i of [0, count), in chunks.
template <class Body>
void parallel_for(Index count, const Body& body, Index grain) {
    parallel_chunks(count, grain, [&](Index begin, Index end) {
        for (Index i = begin; i < end; ++i) body(i);
    });
}

/// The same in chunks that are soon done, so that no thread waits long for the last one; few on one thread.
template <class Body>
void parallel_for(Index count, const Body& body) {
    constexpr Index few = 1024;
    parallel_for(count, body, count <= few ? few : few / 4);
}

}  // namespace multires
