#include "base/buffer.h"

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace pyroscene {
namespace {

constexpr std::size_t kHugePage = std::size_t{1} << 21, kLeast = 2 * kHugePage;
constexpr std::align_val_t kAlignment{kHugePage};

}  // namespace

void* allocate_pages(std::size_t bytes) {
    if (bytes < kLeast) return ::operator new(bytes);
    void* at = ::operator new(bytes, kAlignment);
#ifdef __linux__
    madvise(at, bytes / kHugePage * kHugePage, MADV_HUGEPAGE);  // a wish: its refusal costs only time
#endif
    return at;
}

void free_pages(void* at, std::size_t bytes) noexcept {
    if (bytes < kLeast)
        ::operator delete(at);
    else
        ::operator delete(at, kAlignment);
}

}  // namespace pyroscene
