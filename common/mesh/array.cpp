#include "mesh/array.h"

#include <cstdlib>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace multires::array_detail {
namespace {

constexpr std::size_t huge_page = std::size_t{2} << 20, least_huge = 2 * huge_page;

}  // namespace

void* allocate(std::size_t bytes) {
#ifdef __linux__
    if (bytes >= least_huge) {
        const std::size_t whole = (bytes + huge_page - 1) / huge_page * huge_page;
        void* const memory = std::aligned_alloc(huge_page, whole);
        if (!memory) throw std::bad_alloc();
        madvise(memory, bytes / huge_page * huge_page, MADV_HUGEPAGE);  // a wish: no harm if it is not granted
        return memory;
    }
#endif
    return ::operator new(bytes);
}

void release(void* memory, std::size_t bytes) noexcept {
#ifdef __linux__
    if (bytes >= least_huge) return std::free(memory);
#endif
    ::operator delete(memory);
}

}  // namespace multires::array_detail
