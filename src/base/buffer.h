#pragma once

#include <memory>
#include <new>
#include <utility>
#include <vector>

namespace pyroscene {

/// std::allocator whose elements resize() leaves uninitialised.
template <class T>
struct UninitialisedAllocator : std::allocator<T> {
    UninitialisedAllocator() = default;
    template <class U>
    UninitialisedAllocator(const UninitialisedAllocator<U>&) noexcept {}
    template <class U>
    struct rebind {
        using other = UninitialisedAllocator<U>;
    };

    template <class U>
    void construct(U* at) noexcept {
        ::new (static_cast<void*>(at)) U;
    }
    template <class U, class... Args>
    void construct(U* at, Args&&... args) {
        ::new (static_cast<void*>(at)) U(std::forward<Args>(args)...);
    }
};

/// A vector for large arrays that several threads fill: resize(n) touches nothing, so that each page is first written, and
/// paid for, by the thread that fills it. Give a value (`resize(n, 0.0F)`) where not every element is written.
/// Pages stay small on purpose. Huge ones save 0.09 s of page faults on 300 MB that were in use a moment ago, but are taken from
/// memory that lay free for long, which a virtual machine may have given back to its host: then the first touch costs 0.2 to 0.6 s.
template <class T>
using Buffer = std::vector<T, UninitialisedAllocator<T>>;

}  // namespace pyroscene
