#pragma once

#include <cstddef>

namespace multires {

/// Gives what the C library keeps of freed memory back to the system, if it is more than `much` bytes: glibc keeps
/// blocks of less than 32 MB, so that large arrays of another size leave holes. Where it is not glibc, does nothing.
/// Cost: about that of writing the memory once, when it is used again.
void return_free_memory(std::size_t much);

}  // namespace multires
