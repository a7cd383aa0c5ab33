#include "allocation_faults.h"

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <limits>
#include <new>

// Nothing here may allocate.

namespace multires::faults {
namespace {

constexpr long never = std::numeric_limits<long>::max();
constexpr std::size_t large = std::size_t{1} << 19;

std::atomic<bool> armed{false}, large_only{false};
std::atomic<long> allocations{0};
std::atomic<long> failing{never};
std::atomic<bool> lasting{false};

}  // namespace

void fail_at(long index, Shortage shortage, Memory memory) {
    large_only = memory == Memory::large;
    allocations = 0;
    failing = index;
    lasting = shortage == Shortage::lasting;
    armed = true;
}

void count(Memory memory) { fail_at(never, Shortage::once, memory); }

long stop() {
    armed = false;
    return allocations;
}

/// Counts an allocation; true if it is to fail.
bool fails(std::size_t size) noexcept {
    if (!armed.load(std::memory_order_relaxed) || (large_only && size < large)) return false;
    const long index = allocations.fetch_add(1);
    return lasting ? index >= failing : index == failing;
}

}  // namespace multires::faults

#ifdef MULTIRES_SANITIZED

void* operator new(std::size_t size) {
    if (multires::faults::fails(size)) throw std::bad_alloc();
    if (void* p = std::malloc(size ? size : 1)) return p;
    throw std::bad_alloc();
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {  // of std::stable_partition() and its kin
    return multires::faults::fails(size) ? nullptr : std::malloc(size ? size : 1);
}
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, const std::nothrow_t&) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }

#else

// glibc's own names for them.
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* p, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

__attribute__((visibility("default"))) void* malloc(std::size_t size) noexcept {
    if (!multires::faults::fails(size)) return __libc_malloc(size);
    errno = ENOMEM;
    return nullptr;
}
__attribute__((visibility("default"))) void* calloc(std::size_t count, std::size_t size) noexcept {
    if (!multires::faults::fails(count * size)) return __libc_calloc(count, size);
    errno = ENOMEM;
    return nullptr;
}
__attribute__((visibility("default"))) void* realloc(void* p, std::size_t size) noexcept {
    if (!multires::faults::fails(size)) return __libc_realloc(p, size);
    errno = ENOMEM;
    return nullptr;
}
__attribute__((visibility("default"))) void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
    if (!multires::faults::fails(size)) return __libc_memalign(alignment, size);
    errno = ENOMEM;
    return nullptr;
}
__attribute__((visibility("default"))) int posix_memalign(void** p, std::size_t alignment, std::size_t size) noexcept {
    if (multires::faults::fails(size)) return ENOMEM;
    *p = __libc_memalign(alignment, size);
    return *p ? 0 : ENOMEM;
}
}

#endif
