#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <new>
#include <utility>
#include <vector>

namespace pyroscene {

/// Memory for `bytes` bytes, uninitialised; from 4 MiB on in huge pages where Linux grants them (transparent huge pages "always"
/// or "madvise"): a large array otherwise costs more in page faults than in the arithmetic that fills it. Throws
/// std::bad_alloc. Give back with free_pages() and the same size.
void* allocate_pages(std::size_t bytes);
void free_pages(void* at, std::size_t bytes) noexcept;

/// Allocator of large arrays whose elements resize() leaves uninitialised.
template <class T>
struct PageAllocator {
    using value_type = T;

    PageAllocator() = default;
    template <class U>
    PageAllocator(const PageAllocator<U>&) noexcept {}

    T* allocate(std::size_t n) {
        if (n > std::numeric_limits<std::size_t>::max() / sizeof(T)) throw std::bad_array_new_length();
        return static_cast<T*>(allocate_pages(n * sizeof(T)));
    }
    void deallocate(T* at, std::size_t n) noexcept { free_pages(at, n * sizeof(T)); }

    template <class U>
    void construct(U* at) noexcept {
        ::new (static_cast<void*>(at)) U;
    }
    template <class U, class... Args>
    void construct(U* at, Args&&... args) {
        ::new (static_cast<void*>(at)) U(std::forward<Args>(args)...);
    }

    friend bool operator==(const PageAllocator&, const PageAllocator&) { return true; }
};

/// A vector for large arrays that several threads fill: resize(n) touches nothing, so that each page is first written, and
/// paid for, by the thread that fills it. Give a value (`resize(n, 0.0F)`) where not every element is written.
template <class T>
using Buffer = std::vector<T, PageAllocator<T>>;

}  // namespace pyroscene
