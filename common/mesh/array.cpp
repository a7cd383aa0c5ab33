#include "mesh/array.h"

#include <cstdint>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace multires::array_detail {
namespace {

constexpr std::size_t slack = 32;
constexpr std::size_t huge_page = std::size_t{2} << 20, least_mapped = 2 * huge_page;

#ifdef __linux__
std::size_t mapped_size(std::size_t bytes) { return (bytes + 4095) / 4096 * 4096; }

/// Whole pages from the system, aligned for huge ones; they go back to it at once when they are freed, which malloc
/// does not promise of blocks this size.
void* map(std::size_t bytes) {
    const std::size_t size = mapped_size(bytes), reserved = size + huge_page;
    void* const got = mmap(nullptr, reserved, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (got == MAP_FAILED) throw std::bad_alloc();
    char* const begin = static_cast<char*>(got);
    const std::size_t head = (huge_page - reinterpret_cast<std::uintptr_t>(begin) % huge_page) % huge_page;
    if (head > 0) munmap(begin, head);
    munmap(begin + head + size, reserved - head - size);
    madvise(begin + head, size / huge_page * huge_page, MADV_HUGEPAGE);  // a wish: no harm if it is not granted
    return begin + head;
}
#endif

}  // namespace

void* allocate(std::size_t bytes) {
    bytes += slack;
#ifdef __linux__
    if (bytes >= least_mapped) return map(bytes);
#endif
    return ::operator new(bytes);
}

void release(void* memory, std::size_t bytes) noexcept {
#ifdef __linux__
    if (bytes + slack >= least_mapped) {
        munmap(memory, mapped_size(bytes + slack));
        return;
    }
#endif
    ::operator delete(memory);
}

}  // namespace multires::array_detail
