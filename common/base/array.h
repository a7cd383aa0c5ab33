#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace multires {

namespace array_detail {
/// Memory for an array, and 32 bytes more that may be read (not used): loops that take a vector of numbers at a time
/// need not stop short of the end. Blocks of 4 megabytes and more are asked to be made of huge pages.
void* allocate(std::size_t bytes);  ///< throws std::bad_alloc
void release(void* memory, std::size_t bytes) noexcept;
}  // namespace array_detail

/// While one lives, large blocks that are freed are kept for the next that are wanted, and go back to the system when
/// it ends. The system would clear their pages each time it hands them out, and the levels of a pyramid free as much as
/// they take. No more memory is held than was in use at some time before. Counted for all threads; may be nested.
class BlockReuse {
public:
    BlockReuse() noexcept;
    ~BlockReuse();
    BlockReuse(const BlockReuse&) = delete;
    BlockReuse& operator=(const BlockReuse&) = delete;
};

/// Allocator of Array: what resize() adds is not set to zero, and large blocks lie in huge pages. A pyramid is a few
/// hundred large arrays that are written once: zeroing them, and faulting them in page by page, is work for nothing.
template <class T>
struct ArrayAllocator {
    using value_type = T;

    ArrayAllocator() = default;
    template <class U>
    ArrayAllocator(const ArrayAllocator<U>&) noexcept {}

    T* allocate(std::size_t n) {
        if (n > static_cast<std::size_t>(-1) / 2 / sizeof(T)) throw std::bad_array_new_length();
        return static_cast<T*>(array_detail::allocate(n * sizeof(T)));
    }
    void deallocate(T* p, std::size_t n) noexcept { array_detail::release(p, n * sizeof(T)); }

    template <class U>
    void construct(U* p) noexcept(std::is_nothrow_default_constructible_v<U>) {
        ::new (static_cast<void*>(p)) U;  // no parentheses: numbers stay as they are
    }
    template <class U, class... A>
    void construct(U* p, A&&... a) {
        ::new (static_cast<void*>(p)) U(std::forward<A>(a)...);
    }
    bool operator==(const ArrayAllocator&) const { return true; }
    bool operator!=(const ArrayAllocator&) const { return false; }
};

/// std::vector for large arrays of plain numbers: Array<T> a(n) and a.resize(n) leave new elements unset, a(n, value)
/// and assign() set them.
template <class T>
using Array = std::vector<T, ArrayAllocator<T>>;

}  // namespace multires
