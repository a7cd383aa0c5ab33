#include "base/parallel.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <memory>
#include <mutex>
#include <new>
#include <thread>
#include <utility>

namespace multires {
namespace {

/// In a library that is opened at run time, as a plugin is, a thread's variables are allocated at its first access by
/// default, and glibc ends the process if that fails. initial-exec has them allocated with the thread.
[[gnu::tls_model("initial-exec")]] thread_local bool inside_loop = false;

/// Without overflow for any count > 0.
Index chunks_of(Index count, Index grain) { return (count - 1) / grain + 1; }

/// One loop. Each thread owns a contiguous range of chunks, so data stays in its cache from loop to loop; a thread that
/// is done steals chunks from the others.
class Job {
public:
    Job(Index count, Index grain, const void* body, parallel_detail::Chunk chunk, int threads)
        : body_(body), chunk_(chunk), count_(count), grain_(grain), ranges_(std::min(threads, most)) {
        const std::int64_t chunks = chunks_of(count, grain);
        for (int i = 0; i < ranges_; ++i) {
            range_[i].next.store(chunks * i / ranges_, std::memory_order_relaxed);
            range_[i].end = chunks * (i + 1) / ranges_;
        }
    }

    /// @param thread  0 for the caller, 1.. for its helpers
    void work(int thread, std::mutex& mutex) {
        inside_loop = true;
        for (int i = 0; i < ranges_; ++i) {
            Range& range = range_[(thread + i) % ranges_];
            for (std::int64_t c; !failed_.load(std::memory_order_relaxed) &&
                                 (c = range.next.fetch_add(1, std::memory_order_relaxed)) < range.end;) {
                try {
                    const Index begin = static_cast<Index>(c * grain_);
                    chunk_(body_, begin, begin + std::min(grain_, count_ - begin));
                } catch (...) {
                    const std::lock_guard<std::mutex> lock(mutex);
                    if (!failure) failure = std::current_exception();
                    failed_.store(true, std::memory_order_relaxed);
                }
            }
        }
        inside_loop = false;
    }

    std::atomic<int> helpers{0};  ///< working now; changes under the pool's mutex
    // Guarded by the pool's mutex:
    int joined = 0;  ///< helpers so far
    std::exception_ptr failure;

private:
    static constexpr int most = 64;
    struct alignas(64) Range {
        std::atomic<std::int64_t> next;  // runs past the end by one for each thread that looks
        std::int64_t end;
    };

    const void* body_;
    parallel_detail::Chunk chunk_;
    Index count_, grain_;
    int ranges_;
    std::atomic<bool> failed_{false};
    Range range_[most];
};

/// Threads that sleep until there is a job. Never destroyed: a plugin may be unloaded at exit while they sleep.
class Pool {
public:
    static Pool& instance() {
        static Pool* const pool = new Pool;
        return *pool;
    }

    void run(Job& job, int threads) {
        {
            std::unique_lock<std::mutex> lock(mutex_);
            if (!job_) start(threads - 1, lock);  // which may let others in meanwhile
            if (job_) threads = 1;                // another loop has the helpers
            if (threads > 1) {
                job_ = &job;
                helpers_wanted_ = threads - 1;
                published_.fetch_add(1, std::memory_order_release);
            }
        }
        if (threads > 1) wake_.notify_all();
        job.work(0, mutex_);
        if (threads > 1) {
            std::unique_lock<std::mutex> lock(mutex_);
            job_ = nullptr;
            if (job.helpers > 0) {  // for the rest of a chunk
                lock.unlock();
                wait_awake([&] { return job.helpers.load(std::memory_order_acquire) == 0; });
                lock.lock();
            }
            done_.wait(lock, [&] { return job.helpers == 0; });
        }
        if (job.failure) std::rethrow_exception(job.failure);
    }

private:
    /// What the C++ library allocates for exceptions at a thread's first access, with room for what malloc needs to.
    using Reserve = std::unique_ptr<char[]>;
    static constexpr std::size_t reserve_bytes = 1 << 16;

    /// Loops come in quick succession: looks for a while before the caller goes to sleep.
    template <class Happened>
    static void wait_awake(const Happened& happened) {
        for (int spin = 0; spin < 4000 && !happened(); ++spin) std::atomic_signal_fence(std::memory_order_seq_cst);
    }

    /// Waits for each to be ready: while it allocates, nobody else does. glibc ends the process if that fails.
    void start(int helpers, std::unique_lock<std::mutex>& lock) {
        while (started_ < helpers) {
            Reserve reserve(new (std::nothrow) char[reserve_bytes]);
            if (!reserve) return;
            try {
                std::thread([this, kept = std::move(reserve)]() mutable { help(std::move(kept)); }).detach();
            } catch (const std::system_error&) {
                return;  // no more threads to be had; go on with those there are
            }
            ++started_;
            done_.wait(lock, [&] { return ready_ == started_; });
        }
    }

    void help(Reserve reserve) {
        reserve.reset();
        [[maybe_unused]] const volatile int asked =
            std::uncaught_exceptions();  // allocates; volatile, or it is left out
        {
            const std::lock_guard<std::mutex> lock(mutex_);
            ++ready_;
        }
        done_.notify_all();
        unsigned seen = 0;
        for (;;) {
            wait_awake([&] { return published_.load(std::memory_order_acquire) != seen; });
            std::unique_lock<std::mutex> lock(mutex_);
            wake_.wait(lock, [&] { return published_.load(std::memory_order_relaxed) != seen; });
            seen = published_.load(std::memory_order_relaxed);
            Job* const job = job_;
            if (!job || job->helpers >= helpers_wanted_) continue;
            ++job->helpers;
            const int thread = ++job->joined;
            lock.unlock();
            job->work(thread, mutex_);
            lock.lock();
            if (--job->helpers == 0) done_.notify_all();
        }
    }

    std::mutex mutex_;
    std::condition_variable wake_, done_;
    std::atomic<unsigned> published_{0};
    Job* job_ = nullptr;
    int helpers_wanted_ = 0, started_ = 0, ready_ = 0;
};

int default_threads() {
    if (const char* text = std::getenv("MULTIRES_THREADS"))
        if (const long n = std::strtol(text, nullptr, 10); n > 0) return static_cast<int>(std::min(n, 256L));
    return std::max(1u, std::thread::hardware_concurrency());
}

std::atomic<int> wanted{0};

}  // namespace

int thread_count() {
    static const int machine = default_threads();
    const int n = wanted.load();
    return n > 0 ? n : machine;
}

void set_thread_count(int count) { wanted = std::clamp(count, 0, 256); }

void parallel_detail::run(Index count, Index grain, const void* body, Chunk chunk) {
    if (count <= 0) return;
    const int threads = inside_loop ? 1 : static_cast<int>(std::min<Index>(thread_count(), chunks_of(count, grain)));
    if (threads <= 1) {
        for (Index begin = 0; begin < count; begin += std::min(grain, count - begin))
            chunk(body, begin, begin + std::min(grain, count - begin));
        return;
    }
    Job job(count, grain, body, chunk, threads);
    Pool::instance().run(job, threads);
}

}  // namespace multires
