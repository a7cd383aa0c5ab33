#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace multires {

/// Allocator of Array: what resize() adds is not set to zero, because a pyramid is a few hundred large arrays that are
/// written once. 32 bytes more than wanted may be read (not used): loops that take a vector of numbers at a time need
/// not stop short of the end.
template <class T>
struct ArrayAllocator {
    using value_type = T;

    ArrayAllocator() = default;
    template <class U>
    ArrayAllocator(const ArrayAllocator<U>&) noexcept {}

    T* allocate(std::size_t n) {
        if (n > static_cast<std::size_t>(-1) / 2 / sizeof(T)) throw std::bad_array_new_length();
        return static_cast<T*>(::operator new(n * sizeof(T) + slack));
    }
    void deallocate(T* p, std::size_t) noexcept { ::operator delete(p); }

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

private:
    static constexpr std::size_t slack = 32;
};

/// std::vector for large arrays of plain numbers: Array<T> a(n) and a.resize(n) leave new elements unset, a(n, value)
/// and assign() set them.
template <class T>
using Array = std::vector<T, ArrayAllocator<T>>;

}  // namespace multires
