#include "base/free_memory.h"

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace multires {

void return_free_memory([[maybe_unused]] std::size_t much) {
#ifdef __GLIBC__
#if __GLIBC_PREREQ(2, 33)
    if (mallinfo2().fordblks < much) return;
#endif
    malloc_trim(0);
#endif
}

}  // namespace multires
