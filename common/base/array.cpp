#include "base/array.h"

#include <cstdint>
#include <limits>
#include <mutex>

#ifdef __linux__
#include <sys/mman.h>
#endif
#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace multires {
namespace {

constexpr std::size_t slack = 32;
constexpr std::size_t huge_page = std::size_t{2} << 20, least_mapped = 2 * huge_page;

#ifdef __linux__
std::size_t rounded_up(std::size_t bytes, std::size_t unit) { return (bytes + unit - 1) / unit * unit; }
std::size_t mapped_size(std::size_t bytes) { return rounded_up(bytes, 4096); }

/// Whole pages from the system, aligned for huge ones; they go back to it at once when they are freed, which malloc
/// does not promise of blocks this size. Null if there are none.
char* map(std::size_t size) {
    const std::size_t reserved = size + huge_page;
    void* const got = mmap(nullptr, reserved, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (got == MAP_FAILED) return nullptr;
    char* const begin = static_cast<char*>(got);
    const std::size_t head = (huge_page - reinterpret_cast<std::uintptr_t>(begin) % huge_page) % huge_page;
    if (head > 0) munmap(begin, head);
    munmap(begin + head + size, reserved - head - size);
    madvise(begin + head, size / huge_page * huge_page, MADV_HUGEPAGE);  // a wish: no harm if it is not granted
    return begin + head;
}

/// Freed blocks; needs no memory of its own, for it is asked when there may be none.
class Pool {
public:
    void begin() {
        const std::lock_guard<std::mutex> lock(mutex_);
        ++users_;
    }

    void end() {
        const std::lock_guard<std::mutex> lock(mutex_);
        give_back(std::numeric_limits<std::size_t>::max());
        if (--users_ > 0 || !used_) return;
        used_ = false;
#ifdef __GLIBC__
        malloc_trim(0);
#endif
    }

    /// The smallest block that is large enough, cut to size; or a new one, for which as much as there is in smaller
    /// ones goes back.
    char* take(std::size_t size) {
        const std::lock_guard<std::mutex> lock(mutex_);
        Block* best = nullptr;
        for (Block* b = blocks_; b != blocks_ + count_; ++b)
            if (b->size >= size && (!best || b->size < best->size)) best = b;
        if (!best) {
            give_back(size);
            char* const mapped = map(size);
            if (mapped || count_ == 0) return mapped;
            give_back(std::numeric_limits<std::size_t>::max());
            return map(size);
        }
        const Block found = *best;
        const std::size_t rest = rounded_up(size, huge_page);
        if (found.size >= rest + least_mapped) {
            *best = {found.begin + rest, found.size - rest};
            if (rest > size) munmap(found.begin + size, rest - size);
        } else {
            *best = blocks_[--count_];
            if (found.size > size) munmap(found.begin + size, found.size - size);
        }
        return found.begin;
    }

    void release(char* begin, std::size_t size) {
        const std::lock_guard<std::mutex> lock(mutex_);
        if (users_ == 0 || count_ == most) {
            munmap(begin, size);
            return;
        }
        blocks_[count_++] = {begin, size};
        used_ = true;
    }

private:
    struct Block {
        char* begin;
        std::size_t size;
    };

    /// Unmaps blocks until they were this large together, or none is left.
    void give_back(std::size_t size) {
        for (std::size_t gone = 0; count_ > 0 && gone < size;) {
            const Block& b = blocks_[--count_];
            munmap(b.begin, b.size);
            gone += b.size;
        }
    }

    static constexpr int most = 64;
    std::mutex mutex_;
    Block blocks_[most];
    int count_ = 0, users_ = 0;
    bool used_ = false;  ///< there was a large block since there were users
};

Pool& pool() {
    static Pool made;
    return made;
}
#endif

}  // namespace

#ifdef __linux__
BlockReuse::BlockReuse() noexcept { pool().begin(); }
BlockReuse::~BlockReuse() { pool().end(); }
#else
BlockReuse::BlockReuse() noexcept {}
BlockReuse::~BlockReuse() {}
#endif

namespace array_detail {

void* allocate(std::size_t bytes) {
    bytes += slack;
#ifdef __linux__
    if (bytes >= least_mapped) {
        if (void* const block = pool().take(mapped_size(bytes))) return block;
        throw std::bad_alloc();
    }
#endif
    return ::operator new(bytes);
}

void release(void* memory, std::size_t bytes) noexcept {
    bytes += slack;
#ifdef __linux__
    if (bytes >= least_mapped) {
        pool().release(static_cast<char*>(memory), mapped_size(bytes));
        return;
    }
#endif
    ::operator delete(memory);
}

}  // namespace array_detail
}  // namespace multires
