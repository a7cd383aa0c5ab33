#include "base/parallel.h"

#include "fixtures.h"

#include <atomic>
#include <limits>
#include <stdexcept>
#include <thread>

namespace multires {

using fixtures::Threads;

TEST(Parallel, ChunksCoverTheRangeOnceWhateverTheThreads) {
    for (const int threads : {1, 2, 3, 8})
        for (const Index count : {0, 1, 7, 1000, 1024, 1025, 5000})
            for (const Index grain : {1, 64, 1024, 100000}) {
                const Threads scope(threads);
                std::vector<std::atomic<int>> visits(count);
                parallel_chunks(count, grain, [&](Index begin, Index end) {
                    EXPECT_EQ(begin % grain, 0);
                    EXPECT_EQ(end, std::min(count, begin + grain));
                    for (Index i = begin; i < end; ++i) ++visits[i];
                });
                for (const auto& v : visits) ASSERT_EQ(v, 1);
            }
}

TEST(Parallel, RangesEndAtTheLargestIndex) {
    const Index most = std::numeric_limits<Index>::max();
    for (const int threads : {1, 2}) {
        const Threads scope(threads);
        std::atomic<std::int64_t> sum{0};
        parallel_chunks(most, 1 << 28, [&](Index begin, Index end) { sum += end - begin; });
        EXPECT_EQ(sum, most);
    }
}

TEST(Parallel, PassesOnTheFirstFailureAndWorksAfterwards) {
    const Threads scope(4);
    for (int round = 0; round < 200; ++round) {
        EXPECT_THROW(parallel_for(
                         1000,
                         [&](Index i) {
                             if (i == 617) throw std::runtime_error("617");
                         },
                         10),
                     std::runtime_error);
        std::atomic<Index> sum{0};
        parallel_for(
            1000, [&](Index i) { sum += i; }, 10);
        EXPECT_EQ(sum, 499500);
    }
}

TEST(Parallel, LoopsInsideLoopsAndFromSeveralThreadsEnd) {
    const Threads scope(3);
    std::atomic<Index> sum{0};
    const auto nested = [&] {
        for (int round = 0; round < 50; ++round)
            parallel_for(
                40,
                [&](Index) {
                    parallel_for(
                        30, [&](Index i) { sum += i; }, 4);
                },
                1);
    };
    std::thread a(nested), b(nested);
    nested();
    a.join();
    b.join();
    EXPECT_EQ(sum, 3 * 50 * 40 * 435);
}

}  // namespace multires
