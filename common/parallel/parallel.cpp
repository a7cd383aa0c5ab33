#include "parallel/parallel.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstdlib>
#include <exception>
#include <mutex>
#include <thread>

namespace multires {
namespace {

/// In a library that is opened at run time, as a plugin is, a thread's variables are allocated at its first access by
/// default, and glibc ends the process if that fails. initial-exec has them allocated with the thread.
[[gnu::tls_model("initial-exec")]] thread_local bool inside_loop = false;

/// Without overflow for any count > 0.
Index chunks_of(Index count, Index grain) { return (count - 1) / grain + 1; }

/// One loop: chunks are taken from a counter until none is left.
struct Job {
    const void* body;
    parallel_detail::Chunk chunk;
    Index count, grain;
    std::atomic<Index> next{0};
    int helpers = 0;  // guarded by the pool's mutex, as is:
    std::exception_ptr failure;

    void work(std::mutex& mutex) {
        inside_loop = true;
        const Index chunks = chunks_of(count, grain);
        for (Index c; (c = next.fetch_add(1, std::memory_order_relaxed)) < chunks;) {
            try {
                chunk(body, c * grain, c * grain + std::min(grain, count - c * grain));
            } catch (...) {
                const std::lock_guard<std::mutex> lock(mutex);
                if (!failure) failure = std::current_exception();
                next.store(chunks, std::memory_order_relaxed);
            }
        }
        inside_loop = false;
    }
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
            const std::lock_guard<std::mutex> lock(mutex_);
            if (job_) threads = 1;  // somebody else's loop has the helpers
            start(threads - 1);
            if (threads > 1) {
                job_ = &job;
                helpers_wanted_ = threads - 1;
                published_.fetch_add(1, std::memory_order_release);
            }
        }
        if (threads > 1) wake_.notify_all();
        job.work(mutex_);
        if (threads > 1) {
            std::unique_lock<std::mutex> lock(mutex_);
            job_ = nullptr;
            done_.wait(lock, [&] { return job.helpers == 0; });
        }
        if (job.failure) std::rethrow_exception(job.failure);
    }

private:
    void start(int helpers) {
        while (started_ < helpers) {
            try {
                std::thread([this] { help(); }).detach();
            } catch (const std::system_error&) {
                return;  // the machine has no thread to give; those there are will do
            }
            ++started_;
        }
    }

    void help() {
        unsigned seen = 0;
        for (;;) {
            // Loops come in quick succession: look for the next one for a while before going to sleep.
            for (int spin = 0; spin < 4000 && published_.load(std::memory_order_acquire) == seen; ++spin)
                std::atomic_signal_fence(std::memory_order_seq_cst);
            std::unique_lock<std::mutex> lock(mutex_);
            wake_.wait(lock, [&] { return published_.load(std::memory_order_relaxed) != seen; });
            seen = published_.load(std::memory_order_relaxed);
            Job* const job = job_;
            if (!job || job->helpers >= helpers_wanted_) continue;
            ++job->helpers;
            lock.unlock();
            job->work(mutex_);
            lock.lock();
            if (--job->helpers == 0) done_.notify_all();
        }
    }

    std::mutex mutex_;
    std::condition_variable wake_, done_;
    std::atomic<unsigned> published_{0};
    Job* job_ = nullptr;
    int helpers_wanted_ = 0, started_ = 0;
};

int default_threads() {
    if (const char* text = std::getenv("MULTIRES_THREADS"))
        if (const int n = std::atoi(text); n > 0) return std::min(n, 256);
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
    Job job;
    job.body = body, job.chunk = chunk, job.count = count, job.grain = grain;
    Pool::instance().run(job, threads);
}

}  // namespace multires
